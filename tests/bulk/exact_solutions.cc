// Bodies whose exact solutions are known.
#include "block_mesh.h"

#include <gmock/gmock.h>

#include <numbers>

namespace amontons
{
namespace
{
BoundaryOptions pressure_on(const std::string &region, const std::string &value)
{
  BoundaryOptions entry;
  entry.region = region;
  entry.pressure = Expression{value, {}};
  return entry;
}

BoundaryOptions traction_on(const std::string &region, const std::map<int, Expression> &value)
{
  BoundaryOptions entry;
  entry.region = region;
  entry.traction = value;
  return entry;
}

double largest(const std::vector<double> &values)
{
  double out = 0;
  for (const double v : values)
    out = std::max(out, std::abs(v));
  return out;
}

// ---- Thick tube, 1 <= R <= 2, under internal pressure -------------------------------------------------------------

constexpr double inner = 1, outer = 2;

/// Radial displacement (Lame 1852), plane strain.
double lame_tube(double R, double young, double poisson, double pressure)
{
  const double a2 = inner * inner, b2 = outer * outer;
  return (1 + poisson) / young * pressure * a2 / (b2 - a2) * ((1 - 2 * poisson) * R + b2 / R);
}

/// Half-open wall in axisymmetry: x radius, y axis, ends held.
BlockMesh ring(CellShape shape, int n)
{
  BlockMesh block{shape, {n, 2, 1}};
  block.map = [](const Eigen::Vector3d &x) { return Eigen::Vector3d(inner + (outer - inner) * x[0], 0.5 * x[1], 0); };
  return block;
}

/// A quarter of the section: x along the radius, y the angle.
BlockMesh quarter(CellShape shape, int n)
{
  BlockMesh block{shape, {n, 2 * n, 1}};
  block.map = [](const Eigen::Vector3d &x)
  {
    const double R = inner + (outer - inner) * x[0], angle = std::numbers::pi / 2 * x[1];
    return Eigen::Vector3d(R * std::cos(angle), R * std::sin(angle), 0);
  };
  return block;
}

/// Largest error of the radial displacement relative to its largest value.
double tube_error(const Mesh &mesh, const std::vector<double> &u, bool axisymmetric,
                  const std::function<double(double)> &exact)
{
  double error = 0, scale = 0;
  for (Index node = 0; node < mesh.n_nodes(); ++node)
  {
    const Eigen::Vector3d X = point_of(mesh.points, 2, node), v = point_of(u, 2, node);
    const double R = axisymmetric ? X[0] : X.norm();
    const double radial = axisymmetric ? v[0] : v.dot(X) / R;
    error = std::max(error, std::abs(radial - exact(R)));
    scale = std::max(scale, std::abs(exact(R)));
  }
  return error / scale;
}

struct TubeCase
{
  CellShape shape;
  Kinematics kinematics;
};

double tube(const TubeCase &tube, int n, Strain strain, double poisson, std::optional<bool> mean_dilatation,
            double pressure, const std::function<double(double)> &exact)
{
  const bool axisymmetric = tube.kinematics == Kinematics::axisymmetric;
  const Mesh mesh = (axisymmetric ? ring(tube.shape, n) : quarter(tube.shape, n)).make();
  BodyAssembly assembly(mesh, tube.kinematics, strain,
                        {elastic_body(MaterialLaw::neo_hookean, 1.0, poisson, mean_dilatation)},
                        {pressure_on("left", "t*" + std::to_string(pressure))});
  std::vector<bool> held = hold(mesh, {1}, [&](const auto &X) { return axisymmetric || X[1] < 1e-9; });
  if (!axisymmetric)
  {
    const auto other = hold(mesh, {0}, [](const auto &X) { return X[0] < 1e-9; });
    std::transform(held.begin(), held.end(), other.begin(), held.begin(), std::logical_or<>());
  }
  std::vector<double> u(mesh.points.size(), 0);
  for (int step = 1; step <= (strain == Strain::small ? 1 : 5); ++step)
    if (solve(mesh, assembly, held, strain == Strain::small ? 1 : step / 5.0, u) < 0)
      return 1e9;
  return tube_error(mesh, u, axisymmetric, exact);
}

class Tube : public testing::TestWithParam<TubeCase>
{
};

/// Near incompressibility, where linear triangles lock.
class SoftTube : public Tube
{
};

TEST_P(Tube, SmallStrainConvergesToLame)
{
  const auto exact = [](double R) { return lame_tube(R, 1, 0.3, 1e-3); };
  const double coarse = tube(GetParam(), 8, Strain::small, 0.3, std::nullopt, 1e-3, exact);
  const double fine = tube(GetParam(), 16, Strain::small, 0.3, std::nullopt, 1e-3, exact);
  EXPECT_LT(fine, 4e-3);
  EXPECT_GT(coarse / fine, 3.4); // second order
}

/// Incompressible neo-Hooke: r^2 = R^2 + c, and the pressure is shear (ln(B/A) - ln(b/a) + c/2 (1/a^2 - 1/b^2)) with
/// A, B the radii before and a, b after (equilibrium of sigma_rr - sigma_tt = shear (R^2/r^2 - r^2/R^2)).
TEST_P(SoftTube, FiniteStrainFollowsTheIncompressibleSolution)
{
  const double c = 0.8, a = std::sqrt(inner * inner + c), b = std::sqrt(outer * outer + c), shear = 1 / 3.0;
  const double pressure = shear * (std::log(outer / inner) - std::log(b / a) + c / 2 * (1 / (a * a) - 1 / (b * b)));
  const auto exact = [&](double R) { return std::sqrt(R * R + c) - R; };
  const double coarse = tube(GetParam(), 8, Strain::finite, 0.49999, std::nullopt, pressure, exact);
  const double fine = tube(GetParam(), 16, Strain::finite, 0.49999, std::nullopt, pressure, exact);
  EXPECT_LT(fine, 1e-3);
  EXPECT_GT(coarse / fine, 3.4);
}

TEST_P(SoftTube, MeanDilatationDoesNotLock)
{
  const auto exact = [](double R) { return lame_tube(R, 1, 0.4999, 1e-3); };
  EXPECT_LT(tube(GetParam(), 8, Strain::small, 0.4999, std::nullopt, 1e-3, exact), 4e-3);
  EXPECT_GT(tube(GetParam(), 8, Strain::small, 0.4999, false, 1e-3, exact), 0.4);
}

INSTANTIATE_TEST_SUITE_P(All, Tube,
                         testing::Values(TubeCase{CellShape::triangle, Kinematics::plane_strain},
                                         TubeCase{CellShape::quadrilateral, Kinematics::plane_strain},
                                         TubeCase{CellShape::triangle, Kinematics::axisymmetric},
                                         TubeCase{CellShape::quadrilateral, Kinematics::axisymmetric}));
INSTANTIATE_TEST_SUITE_P(All, SoftTube,
                         testing::Values(TubeCase{CellShape::quadrilateral, Kinematics::plane_strain},
                                         TubeCase{CellShape::quadrilateral, Kinematics::axisymmetric}));

// ---- Bending ------------------------------------------------------------------------------------------------------

/// Tip deflection of a beam 10 x 1 in plane strain under a bending moment at its end, over the exact value
/// M L^2 / (2 E' I), E' = E / (1 - nu^2).
double bending(double poisson, bool mean_dilatation)
{
  BlockMesh block{CellShape::quadrilateral, {80, 8, 1}};
  block.map = [](const Eigen::Vector3d &x) { return Eigen::Vector3d(10 * x[0], x[1] - 0.5, 0); };
  const Mesh mesh = block.make();
  BodyAssembly assembly(mesh, Kinematics::plane_strain, Strain::small,
                        {elastic_body(MaterialLaw::linear_elastic, 1e3, poisson, mean_dilatation)},
                        {traction_on("right", {{0, {"y", {}}}})});
  std::vector<bool> held = hold(mesh, {0}, [](const auto &X) { return X[0] < 1e-9; });
  const auto middle = hold(mesh, {1}, [](const auto &X) { return X[0] < 1e-9 && std::abs(X[1]) < 1e-9; });
  std::transform(held.begin(), held.end(), middle.begin(), held.begin(), std::logical_or<>());
  std::vector<double> u(mesh.points.size(), 0);
  EXPECT_GT(solve(mesh, assembly, held, 0, u), 0);
  for (Index node = 0; node < mesh.n_nodes(); ++node)
    if ((point_of(mesh.points, 2, node) - Eigen::Vector3d(10, 0, 0)).norm() < 1e-9)
      return u[2 * node + 1] / (-(1 - poisson * poisson) / 1e3 * 10 * 10 / 2);
  return 0;
}

TEST(Bending, NearlyIncompressibleBeamsBendAsTheyShould)
{
  EXPECT_NEAR(bending(0.3, true), 1, 0.02);
  EXPECT_NEAR(bending(0.4999, true), 1, 0.02);
  EXPECT_LT(bending(0.4999, false), 0.7) << "full integration should lock, or the test shows nothing";
}

// ---- Uniaxial tension ---------------------------------------------------------------------------------------------

std::vector<bool> symmetry_planes(const Mesh &mesh)
{
  std::vector<bool> held(mesh.points.size(), false);
  for (Index node = 0; node < mesh.n_nodes(); ++node)
    for (int d = 0; d < mesh.dim; ++d)
      held[node * mesh.dim + d] = point_of(mesh.points, mesh.dim, node)[d] < 1e-9;
  return held;
}

std::vector<double> tension(CellShape shape, Kinematics kinematics, Strain strain, double traction,
                            std::vector<double> *stress)
{
  const Mesh mesh = BlockMesh{shape, {3, 3, 3}, 0.2}.make();
  BodyAssembly assembly(mesh, kinematics, strain, {elastic_body(MaterialLaw::neo_hookean, 2.0, 0.35)},
                        {traction_on("right", {{0, {std::to_string(traction) + "*t", {}}}})});
  std::vector<double> u(mesh.points.size(), 0);
  for (int step = 1; step <= 4; ++step)
    EXPECT_GT(solve(mesh, assembly, symmetry_planes(mesh), step / 4.0, u), 0);
  *stress = assembly.stress(u);
  const auto last = u.end() - mesh.dim;
  return {last, u.end()};
}

TEST(Tension, SmallPlaneStress)
{
  for (const CellShape shape : {CellShape::triangle, CellShape::quadrilateral})
  {
    std::vector<double> stress;
    const auto corner = tension(shape, Kinematics::plane_stress, Strain::small, 0.25, &stress);
    EXPECT_NEAR(corner[0], 0.25 / 2, 1e-13);
    EXPECT_NEAR(corner[1], -0.35 * 0.25 / 2, 1e-13);
    for (std::size_t c = 0; c < stress.size(); c += 6)
    {
      EXPECT_NEAR(stress[c], 0.25, 1e-13);
      for (int i = 1; i < 6; ++i)
        EXPECT_NEAR(stress[c + i], 0, 1e-13);
    }
  }
}

/// Nominal stress of neo-Hooke in uniaxial tension, from W(stretches) by difference quotients; the lateral stretch by
/// bisection.
double uniaxial_nominal_stress(double stretch, double *lateral)
{
  const double shear = 2 / (2 * 1.35), bulk = 2 / (3 * 0.3);
  const auto W = [&](double a, double b, double c)
  {
    const double J = a * b * c;
    return shear / 2 * (std::pow(J, -2.0 / 3) * (a * a + b * b + c * c) - 3) +
           bulk / 2 * ((J * J - 1) / 2 - std::log(J));
  };
  const double h = 1e-5;
  double low = 0.3, high = 2;
  for (int i = 0; i < 60; ++i)
  {
    *lateral = (low + high) / 2;
    (W(stretch, *lateral + h, *lateral) < W(stretch, *lateral - h, *lateral) ? low : high) = *lateral;
  }
  return (W(stretch + h, *lateral, *lateral) - W(stretch - h, *lateral, *lateral)) / (2 * h);
}

TEST(Tension, FinitePlaneStressAndSolidFollowTheLaw)
{
  double lateral = 0;
  const double stretch = 1.6;
  const double nominal = uniaxial_nominal_stress(stretch, &lateral);
  const std::vector<std::pair<CellShape, Kinematics>> cases{{CellShape::triangle, Kinematics::plane_stress},
                                                            {CellShape::quadrilateral, Kinematics::plane_stress},
                                                            {CellShape::tetrahedron, Kinematics::three_dimensional},
                                                            {CellShape::hexahedron, Kinematics::three_dimensional}};
  for (const auto &[shape, kinematics] : cases)
  {
    std::vector<double> stress;
    const auto corner = tension(shape, kinematics, Strain::finite, nominal, &stress);
    EXPECT_NEAR(corner[0], stretch - 1, 2e-6); // to_string keeps six digits of the traction
    EXPECT_NEAR(corner[1], lateral - 1, 2e-6);
    EXPECT_NEAR(stress[0], nominal / (lateral * lateral), 1e-5);
    EXPECT_NEAR(std::max(std::abs(stress[1]), std::abs(stress[2])), 0, 1e-12);
  }
}

/// A tube of revolution under the same pressure inside and outside and at its ends shrinks uniformly.
TEST(Tension, HydrostaticPressureGivesHydrostaticStress)
{
  for (const Strain strain : {Strain::small, Strain::finite})
  {
    const Mesh mesh = ring(CellShape::quadrilateral, 3).make();
    BodyAssembly assembly(mesh, Kinematics::axisymmetric, strain, {elastic_body(MaterialLaw::neo_hookean, 2.0, 0.3)},
                          {pressure_on("boundary", "0.2")});
    std::vector<double> u(mesh.points.size(), 0);
    ASSERT_GT(solve(mesh, assembly, hold(mesh, {1}, [](const auto &X) { return X[1] < 1e-9 && X[0] < 1.01; }), 0, u),
              0);
    const auto stress = assembly.stress(u);
    for (std::size_t c = 0; c < stress.size(); c += 6)
    {
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(stress[c + i], -0.2, 1e-12);
      EXPECT_NEAR(stress[c + 3], 0, 1e-12);
    }
    EXPECT_GT(largest(u), 0.01);
  }
}
} // namespace
} // namespace amontons
