// Loads: totals, tangents and what is refused.
#include "amontons/bulk/loads_pressure.h"
#include "block_mesh.h"

#include <gmock/gmock.h>

#include <complex>
#include <numbers>

namespace amontons
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;

struct Forces
{
  std::vector<double> internal, external;
};

Forces forces(const BodyAssembly &assembly, const std::vector<double> &u, double time = 0)
{
  Forces f{std::vector<double>(u.size()), std::vector<double>(u.size())};
  EXPECT_TRUE(assembly.forces(u, time, f.internal, f.external));
  return f;
}

Eigen::Vector3d total(const std::vector<double> &force, int dim)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < force.size(); ++i)
    sum[static_cast<Eigen::Index>(i) % dim] += force[i];
  return sum;
}

BoundaryOptions entry(const std::string &region)
{
  BoundaryOptions out;
  out.region = region;
  out.where = {"deck.yaml", 30, 3};
  return out;
}

Expression expression(const std::string &text)
{
  return {text, {}};
}

Mesh mesh_of(CellShape shape, const Eigen::Vector3d &origin = {0.5, 0, 0})
{
  BlockMesh block{shape, {3, 2, 2}, 0.2};
  block.map = [origin](const Eigen::Vector3d &x)
  { return Eigen::Vector3d(x.cwiseProduct(Eigen::Vector3d(2, 1, 1.5)) + origin); };
  return block.make();
}

std::vector<double> some_displacement(const Mesh &mesh)
{
  return nodal_field(mesh,
                     [](const Eigen::Vector3d &X)
                     {
                       return Eigen::Vector3d(0.1 * X[0] + 0.05 * X[1] * X[1], 0.07 * X[1] - 0.06 * X[0] * X[1],
                                              0.04 * X[2] * X[0] + 0.03 * X[1]);
                     });
}

const std::vector<std::pair<CellShape, Kinematics>> all_kinds{
    {CellShape::triangle, Kinematics::plane_strain},         {CellShape::triangle, Kinematics::plane_stress},
    {CellShape::triangle, Kinematics::axisymmetric},         {CellShape::quadrilateral, Kinematics::plane_strain},
    {CellShape::quadrilateral, Kinematics::plane_stress},    {CellShape::quadrilateral, Kinematics::axisymmetric},
    {CellShape::tetrahedron, Kinematics::three_dimensional}, {CellShape::hexahedron, Kinematics::three_dimensional}};

BodyAssembly loaded(const Mesh &mesh, Kinematics kinematics, Strain strain, const BoundaryOptions &load)
{
  return BodyAssembly(mesh, kinematics, strain, {elastic_body(MaterialLaw::neo_hookean, 2, 0.3)}, {load});
}

TEST(Loads, TractionHasItsTotal)
{
  for (const auto &[shape, kinematics] : all_kinds)
  {
    const Mesh mesh = mesh_of(shape);
    BoundaryOptions load = entry("right");
    load.traction = {{0, expression("t*(1 + y)")}, {1, expression("-x")}};
    const auto assembly = loaded(mesh, kinematics, Strain::finite, load);
    const auto f = total(forces(assembly, some_displacement(mesh), 2).external, mesh.dim);
    const double width = kinematics == Kinematics::axisymmetric ? 2 * std::numbers::pi * 2.5 : mesh.dim == 3 ? 1.5 : 1;
    EXPECT_NEAR(f[0], 2 * 1.5 * width, 1e-12);
    EXPECT_NEAR(f[1], -2.5 * width, 1e-12);
  }
}

TEST(Loads, BodyForceHasItsTotal)
{
  for (const auto &[shape, kinematics] : all_kinds)
    for (const std::string region : {"block", "body"})
    {
      const Mesh mesh = mesh_of(shape);
      BoundaryOptions load = entry(region);
      load.body_force = {{1, expression("-3 + y")}};
      const auto assembly = loaded(mesh, kinematics, Strain::small, load);
      const auto f = total(forces(assembly, some_displacement(mesh)).external, mesh.dim);
      const double volume = kinematics == Kinematics::axisymmetric ? std::numbers::pi * (2.5 * 2.5 - 0.5 * 0.5)
                            : mesh.dim == 3                        ? 3
                                                                   : 2;
      EXPECT_NEAR(f[0], 0, 1e-12);
      EXPECT_NEAR(f[1], -2.5 * volume, 1e-11);
    }
}

TEST(Loads, PointForceIsPerNode)
{
  const Mesh mesh = mesh_of(CellShape::quadrilateral);
  BoundaryOptions load = entry("corner");
  load.force = {{1, expression("3*t + x")}};
  const auto f =
      forces(loaded(mesh, Kinematics::axisymmetric, Strain::small, load), some_displacement(mesh), 2).external;
  EXPECT_DOUBLE_EQ(f[1], 6.5);
  EXPECT_DOUBLE_EQ(total(f, 2).norm(), 6.5);
}

TEST(Loads, DeadPressurePushesInwardsWhateverTheFacetsOrientation)
{
  for (const auto &[shape, kinematics] : all_kinds)
  {
    const Mesh mesh = mesh_of(shape);
    BoundaryOptions load = entry("right");
    load.pressure = expression("2");
    const auto f =
        total(forces(loaded(mesh, kinematics, Strain::small, load), some_displacement(mesh)).external, mesh.dim);
    const double area = kinematics == Kinematics::axisymmetric ? 2 * std::numbers::pi * 2.5 : mesh.dim == 3 ? 1.5 : 1;
    EXPECT_NEAR(f[0], -2 * area, 1e-12);
    EXPECT_NEAR(f[1], 0, 1e-12);
  }
}

/// On a closed surface a following pressure has no resultant (in axisymmetry: along the axis), and works on a
/// dilatation x -> s x with - p d(volume)/ds.
TEST(Loads, FollowingPressureOnAClosedSurfaceHasNoResultant)
{
  for (const auto &[shape, kinematics] : all_kinds)
  {
    const Mesh mesh = mesh_of(shape);
    BoundaryOptions load = entry("boundary");
    load.pressure = expression("2");
    const auto u = some_displacement(mesh);
    const auto f = forces(loaded(mesh, kinematics, Strain::finite, load), u).external;
    const auto sum = total(f, mesh.dim);
    EXPECT_NEAR(sum[1], 0, 1e-12);
    if (kinematics != Kinematics::axisymmetric)
      EXPECT_NEAR(sum.norm(), 0, 1e-12);
    double work = 0;
    for (std::size_t i = 0; i < f.size(); ++i)
      work += f[i] * (mesh.points[i] + u[i]);
    // Volume of the moved body, cell by cell, by the divergence theorem on its own facets.
    const int power = mesh.dim == 3 || kinematics == Kinematics::axisymmetric ? 3 : 2;
    double volume = 0;
    if (mesh.dim == 2)
      for (Index c = 0; c < mesh.cells.size(); ++c)
        for (std::size_t a = 0; a < mesh.cells[c].size(); ++a)
        {
          const Index i = mesh.cells[c][a], j = mesh.cells[c][(a + 1) % mesh.cells[c].size()];
          const Eigen::Vector3d x = point_of(mesh.points, 2, i) + point_of(u, 2, i);
          const Eigen::Vector3d y = point_of(mesh.points, 2, j) + point_of(u, 2, j);
          volume += kinematics == Kinematics::axisymmetric // of the ring: pi r^2 dz
                        ? std::numbers::pi * (y[1] - x[1]) * (x[0] * x[0] + x[0] * y[0] + y[0] * y[0]) / 3
                        : 0.5 * (x[0] * y[1] - x[1] * y[0]);
        }
    else if (shape == CellShape::tetrahedron)
      for (Index c = 0; c < mesh.cells.size(); ++c)
      {
        const auto at = [&](int a)
        { return Eigen::Vector3d(point_of(mesh.points, 3, mesh.cells[c][a]) + point_of(u, 3, mesh.cells[c][a])); };
        volume += (at(1) - at(0)).cross(at(2) - at(0)).dot(at(3) - at(0)) / 6;
      }
    else
      continue;
    EXPECT_NEAR(work, -2 * power * volume, 1e-11);
  }
}

template<class Facet>
void check_pressure_kernel()
{
  using Complex = std::complex<double>;
  const PressureKernel<Facet> kernel;
  typename Facet::template NodalValues<double> x = Facet::template NodalValues<double>::Random();
  x.row(0).array() += 2;
  typename PressureKernel<Facet>::Pressures pressures;
  for (int q = 0; q < Facet::points; ++q)
    pressures[q] = 1 + 0.3 * q;
  const auto derivative = kernel.derivative(x, pressures);
  for (int i = 0; i < Facet::unknowns; ++i)
  {
    typename Facet::template NodalValues<Complex> step = x.template cast<Complex>();
    step(i % Facet::dim, i / Facet::dim) += Complex(0, 1e-40);
    const typename Facet::template Vector<double> column =
        kernel.template force<Complex>(step, pressures).imag() / 1e-40;
    EXPECT_LT((derivative.col(i) - column).norm(), 1e-14 * derivative.norm());
  }
}

TEST(Loads, TangentOfPressureIsTheComplexStep)
{
  check_pressure_kernel<FacetType<CellShape::segment>>();
  check_pressure_kernel<FacetType<CellShape::segment, true>>();
  check_pressure_kernel<FacetType<CellShape::triangle>>();
  check_pressure_kernel<FacetType<CellShape::quadrilateral>>();
}

/// Springs: a rigid shift gives k A u, the energy is symmetric, and only the components named react.
TEST(Loads, SpringsPullBack)
{
  for (const auto &[shape, kinematics] : all_kinds)
    for (const Strain strain : {Strain::small, Strain::finite})
    {
      const Mesh mesh = mesh_of(shape);
      BoundaryOptions load = entry("right");
      load.spring = {{1, expression("4*t")}};
      const auto assembly = loaded(mesh, kinematics, strain, load);
      EXPECT_FALSE(assembly.tangent_is_constant()) << "its stiffness depends on time";
      const auto shift = nodal_field(mesh, [](const auto &) { return Eigen::Vector3d(0, 0.1, 0); });
      const auto f = forces(assembly, shift, 2);
      const double area = kinematics == Kinematics::axisymmetric ? 2 * std::numbers::pi * 2.5 : mesh.dim == 3 ? 1.5 : 1;
      EXPECT_NEAR(total(f.internal, mesh.dim)[1], 8 * 0.1 * area, 1e-12);
      EXPECT_NEAR(total(f.internal, mesh.dim)[0], 0, 1e-12);
      EXPECT_EQ(total(f.external, mesh.dim).norm(), 0);
    }
}

/// d(internal - external)/du as assembled against central differences of fourth order, steps of 1e-3: the error left is
/// of the order 1e-10 of the largest entry.
TEST(Loads, AssembledTangentIsTheDerivativeOfTheForces)
{
  for (const auto &[shape, kinematics] : all_kinds)
    for (const Strain strain : {Strain::small, Strain::finite})
    {
      const Mesh mesh = mesh_of(shape);
      BoundaryOptions pressure = entry("top"), spring = entry("right"), traction = entry("left");
      pressure.pressure = expression("0.4*(1+x)");
      spring.spring = {{0, expression("1.5")}, {1, expression("0.5*y")}};
      traction.traction = {{0, expression("1")}};
      std::vector<Index> halves;
      for (Index c = 0; c < mesh.cells.size(); ++c)
        halves.push_back(c % 2);
      BodyAssembly assembly(mesh, kinematics, strain, {elastic_body(MaterialLaw::neo_hookean, 2, 0.3)},
                            {pressure, spring, traction}, halves);
      auto u = some_displacement(mesh);
      const auto residual = [&]
      {
        const Forces f = forces(assembly, u);
        Eigen::VectorXd r(static_cast<Eigen::Index>(u.size()));
        for (std::size_t i = 0; i < u.size(); ++i)
          r[static_cast<Eigen::Index>(i)] = f.internal[i] - f.external[i];
        return r;
      };
      // Column by column before the tangent is assembled, so that small strain does not multiply by what it tests.
      Eigen::MatrixXd expected(u.size(), u.size());
      const double h = 1e-3;
      for (std::size_t i = 0; i < u.size(); ++i)
      {
        const double start = u[i];
        const auto at = [&](double step)
        {
          u[i] = start + step;
          return residual();
        };
        expected.col(static_cast<Eigen::Index>(i)) = (8.0 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
        u[i] = start;
      }
      const auto before = residual();
      ASSERT_TRUE(assembly.assemble_tangent(u, 0));
      const Eigen::MatrixXd K = global_matrix(mesh, assembly);
      EXPECT_LT((K - expected).lpNorm<Eigen::Infinity>(), 2e-9 * K.lpNorm<Eigen::Infinity>());
      EXPECT_EQ(assembly.tangent_is_constant(), strain == Strain::small);
      EXPECT_LT((residual() - before).lpNorm<Eigen::Infinity>(), 1e-13) << "forces from the stored stiffness";
    }
}

std::string refusal(const BoundaryOptions &load, const std::vector<BodyOptions> &more = {})
{
  const Mesh mesh = mesh_of(CellShape::quadrilateral);
  std::vector<BodyOptions> bodies{elastic_body(MaterialLaw::linear_elastic, 2, 0.3)};
  bodies.insert(bodies.end(), more.begin(), more.end());
  try
  {
    BodyAssembly assembly(mesh, Kinematics::plane_strain, Strain::small, bodies, {load});
  }
  catch (const UserError &error)
  {
    return error.what();
  }
  return "no error";
}

TEST(Loads, RefusalsNameThePlaceAndTheReason)
{
  BoundaryOptions load = entry("rigth");
  load.traction = {{0, expression("1")}};
  EXPECT_THAT(refusal(load), AllOf(HasSubstr("deck.yaml:30:3"), HasSubstr("rigth"), HasSubstr("right")));
  load = entry("block");
  load.pressure = expression("1");
  EXPECT_THAT(refusal(load), AllOf(HasSubstr("deck.yaml:30:3"), HasSubstr("is a body"), HasSubstr("curves")));
  load = entry("body");
  load.traction = {{0, expression("1")}};
  EXPECT_THAT(refusal(load), HasSubstr("'body' is one of"));
  load = entry("blok");
  load.body_force = {{0, expression("1")}};
  EXPECT_THAT(refusal(load), AllOf(HasSubstr("neither a body"), HasSubstr("block")));
  load = entry("block");
  load.force = {{0, expression("1")}};
  EXPECT_THAT(refusal(load), HasSubstr("deformable body"));
  load = entry("right");
  load.traction = {{2, expression("1")}};
  EXPECT_THAT(refusal(load), AllOf(HasSubstr("deck.yaml:30:3"), HasSubstr("component z")));
}

TEST(Loads, SupportsAndRigidBodiesAreLeftToOthers)
{
  BoundaryOptions support = entry("nowhere");
  support.fix = {0};
  EXPECT_EQ(refusal(support), "no error");
  BodyOptions disc;
  disc.name = "disc";
  disc.material.law = MaterialLaw::rigid;
  disc.shape = Shape{};
  BoundaryOptions pushed = entry("disc");
  pushed.force = {{1, expression("-1")}};
  EXPECT_EQ(refusal(pushed, {disc}), "no error");
}

/// A pressure has no side on a facet between two cells; a traction acts there once.
TEST(Loads, FacetsBetweenTwoCells)
{
  Mesh mesh = BlockMesh{CellShape::quadrilateral, {2, 1, 1}}.make();
  Group &middle = mesh.groups["middle"];
  middle.dim = 1;
  middle.entities.push_back(std::vector<Index>{1, 4});
  BoundaryOptions load = entry("middle");
  load.traction = {{0, expression("3")}};
  const BodyAssembly assembly(mesh, Kinematics::plane_strain, Strain::small,
                              {elastic_body(MaterialLaw::linear_elastic, 2, 0.3)}, {load}, std::vector<Index>{0, 1});
  EXPECT_NEAR(total(forces(assembly, std::vector<double>(12, 0)).external, 2)[0], 3, 1e-13);
  load.traction.clear();
  load.pressure = expression("1");
  EXPECT_THROW(BodyAssembly(mesh, Kinematics::plane_strain, Strain::small,
                            {elastic_body(MaterialLaw::linear_elastic, 2, 0.3)}, {load}),
               UserError);
}
} // namespace
} // namespace amontons
