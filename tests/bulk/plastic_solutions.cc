// Bodies of von Mises' law whose exact solutions are known.
#include "block_mesh.h"

#include <gmock/gmock.h>

#include <numbers>

namespace amontons
{
namespace
{
constexpr double young = 1, poisson = 0.3, yield = 1e-3;

BodyOptions plastic_body(double isotropic = 0, double kinematic = 0, double nu = poisson)
{
  BodyOptions body = elastic_body(MaterialLaw::von_mises, young, nu);
  body.material.yield_stress = yield;
  body.material.isotropic_hardening = isotropic;
  body.material.kinematic_hardening = kinematic;
  return body;
}

/// A bar in one dimension, piece by piece, exact: elastic until the stress is the yield stress away from the back
/// stress, then at the slope E h / (E + h) with h the sum of both hardenings.
struct Bar
{
  double isotropic, kinematic;
  double stress = 0, strain = 0, back = 0, plastic = 0; ///< plastic: equivalent

  void pull_to(double next)
  {
    const double sign = next > strain ? 1 : -1, radius = yield + isotropic * plastic;
    const double to_yield = (back + sign * radius - stress) / young; // of strain, signed
    const double elastic = sign * std::min(sign * (next - strain), sign * to_yield);
    const double rest = next - strain - elastic, h = isotropic + kinematic;
    stress += young * elastic + young * h / (young + h) * rest;
    const double flow = young / (young + h) * rest;
    back += kinematic * flow;
    plastic += std::abs(flow);
    strain = next;
  }
};

struct BlockCase
{
  CellShape shape;
  Kinematics kinematics;
};

std::vector<BlockCase> bars()
{
  return {{CellShape::triangle, Kinematics::axisymmetric},
          {CellShape::quadrilateral, Kinematics::axisymmetric},
          {CellShape::tetrahedron, Kinematics::three_dimensional},
          {CellShape::hexahedron, Kinematics::three_dimensional}};
}

const std::vector<double> cycle{0.5 * yield, 3 * yield, 8 * yield, 7 * yield, -6 * yield, -6.5 * yield, 9 * yield};

TEST(PlasticBar, CyclesOfTensionAndCompressionArePiecewiseLinear)
{
  for (const auto &[shape, kinematics] : bars())
    for (const auto &[isotropic, kinematic] : {std::pair{0.0, 0.0}, {0.1, 0.0}, {0.0, 0.15}, {0.05, 0.2}})
    {
      const Mesh mesh = BlockMesh{shape, {2, 2, 2}, 0.1}.make();
      BodyAssembly assembly(mesh, kinematics, Strain::small, {plastic_body(isotropic, kinematic)}, {});
      // The axial motion is given at all nodes: a perfectly plastic bar may neck anywhere.
      std::vector<bool> held = hold(mesh, {1}, [](const auto &) { return true; });
      for (const int c : {0, 2})
        if (c < mesh.dim)
        {
          const auto plane = hold(mesh, {c}, [c](const auto &X) { return X[c] < 1e-9; });
          std::transform(held.begin(), held.end(), plane.begin(), held.begin(), std::logical_or<>());
        }
      std::vector<double> u(mesh.points.size(), 0);
      Bar bar{isotropic, kinematic};
      for (const double strain : cycle)
      {
        for (Index node = 0; node < mesh.n_nodes(); ++node)
          u[node * mesh.dim + 1] = strain * point_of(mesh.points, mesh.dim, node)[1];
        ASSERT_GT(solve(mesh, assembly, held, 0, u), 0);
        const std::vector<double> stress = assembly.stress(u);
        assembly.commit(u);
        bar.pull_to(strain);
        const std::vector<double> plastic = assembly.plastic_strain();
        for (std::size_t c = 0; c < plastic.size(); ++c)
        {
          EXPECT_NEAR(stress[6 * c + 1], bar.stress, 1e-11 * yield);
          EXPECT_NEAR(std::max(std::abs(stress[6 * c]), std::abs(stress[6 * c + 2])), 0, 1e-11 * yield);
          EXPECT_NEAR(plastic[c], bar.plastic, 1e-11 * yield);
        }
      }
    }
}

/// The reversed yield comes at twice the first yield stress below the summit (Bauschinger), however far the bar went.
TEST(PlasticBar, KinematicHardeningKeepsTheElasticRange)
{
  Bar kinematic{0, 0.2}, isotropic{0.2, 0};
  for (Bar *bar : {&kinematic, &isotropic})
    bar->pull_to(20 * yield);
  const double summit = kinematic.stress;
  EXPECT_EQ(isotropic.stress, summit);
  const Mesh mesh = BlockMesh{CellShape::hexahedron, {1, 1, 1}}.make();
  for (const double unload : {1.99, 2.01})
  {
    BodyAssembly assembly(mesh, Kinematics::three_dimensional, Strain::small, {plastic_body(0, 0.2)}, {});
    const auto stretch = [&](double axial, double lateral)
    {
      return nodal_field(mesh,
                         [=](const auto &X) { return Eigen::Vector3d(lateral * X[0], axial * X[1], lateral * X[2]); });
    };
    // Plastic flow keeps the volume, so lateral strains follow from the stress.
    const auto lateral = [&](double stress, double strain)
    { return -poisson * stress / young - (strain - stress / young) / 2; };
    assembly.commit(stretch(20 * yield, lateral(summit, 20 * yield)));
    const double before = assembly.plastic_strain()[0];
    const double change = -unload * yield / young;
    assembly.commit(stretch(20 * yield + change, lateral(summit, 20 * yield) - poisson * change));
    if (unload < 2)
      EXPECT_EQ(assembly.plastic_strain()[0], before);
    else
      EXPECT_GT(assembly.plastic_strain()[0], before + 1e-3 * yield);
  }
}

TEST(PlasticBar, VocesHardeningIsThatOfItsFormula)
{
  BodyOptions body = plastic_body(0.02);
  body.material.saturation_gain = 2 * yield;
  body.material.saturation_rate = 300;
  const Mesh mesh = BlockMesh{CellShape::quadrilateral, {2, 2, 1}}.make();
  BodyAssembly assembly(mesh, Kinematics::axisymmetric, Strain::small, {body}, {});
  const auto held = hold(mesh, {1}, [](const auto &X) { return X[1] < 1e-9 || X[1] > 1 - 1e-9; });
  std::vector<double> u(mesh.points.size(), 0);
  for (const double strain : {2 * yield, 5 * yield, 20 * yield})
  {
    for (Index node = 0; node < mesh.n_nodes(); ++node)
      u[node * 2 + 1] = strain * point_of(mesh.points, 2, node)[1];
    ASSERT_GT(solve(mesh, assembly, held, 0, u), 0);
    const double stress = assembly.stress(u)[1], plastic = strain - stress / young;
    assembly.commit(u);
    EXPECT_NEAR(assembly.plastic_strain()[0], plastic, 1e-11 * yield);
    EXPECT_NEAR(stress, yield + 0.02 * plastic + 2 * yield * (1 - std::exp(-300 * plastic)), 1e-11 * yield);
  }
}

/// tau sqrt(3) = yield + h p and gamma = tau / G + sqrt(3) p; back and forth with both hardenings as for a bar of
/// modulus 3 G, stress sqrt(3) tau and strain gamma / sqrt(3).
TEST(PlasticShear, SimpleShearIsPiecewiseLinear)
{
  const double shear = young / (2 * (1 + poisson)), h = 0.3, root = std::sqrt(3.0);
  for (const CellShape shape :
       {CellShape::triangle, CellShape::quadrilateral, CellShape::tetrahedron, CellShape::hexahedron})
  {
    const Mesh mesh = BlockMesh{shape, {3, 3, 3}, 0.2}.make();
    BodyAssembly assembly(mesh, mesh.dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional, Strain::small,
                          {plastic_body(h)}, {});
    const std::vector<bool> held = boundary_nodes(mesh);
    std::vector<double> u(mesh.points.size(), 0);
    for (const double gamma : {1.0 * yield, 4.0 * yield, 10.0 * yield})
    {
      const auto exact = nodal_field(mesh, [&](const auto &X) { return Eigen::Vector3d(gamma * X[1], 0, 0); });
      for (std::size_t i = 0; i < u.size(); ++i)
        if (held[i])
          u[i] = exact[i];
      ASSERT_GT(solve(mesh, assembly, held, 0, u), 0);
      const double p = std::max(0.0, (root * shear * gamma - yield) / (3 * shear + h));
      const std::vector<double> stress = assembly.stress(u);
      assembly.commit(u);
      const std::vector<double> plastic = assembly.plastic_strain();
      for (std::size_t c = 0; c < plastic.size(); ++c)
      {
        EXPECT_NEAR(stress[6 * c + 3], shear * (gamma - root * p), 1e-11 * yield);
        EXPECT_NEAR(plastic[c], p, 1e-11 * yield);
        EXPECT_NEAR(stress[6 * c], 0, 1e-11 * yield);
      }
    }
  }
}

// ---- Thick tube, 1 <= R <= 2, perfectly plastic, incompressible (Hill 1950, chapter V) ----------------------------

constexpr double inner = 1, outer = 2, incompressible = 0.49999;

struct Tube
{
  Mesh mesh;
  std::unique_ptr<BodyAssembly> assembly;
  std::vector<bool> held;
  std::vector<double> u;
  bool axisymmetric;

  Tube(bool axisymmetric_, int n)
    : axisymmetric(axisymmetric_)
  {
    BlockMesh block{CellShape::quadrilateral, {n, axisymmetric ? 2 : n, 1}};
    block.map = [this](const Eigen::Vector3d &x)
    {
      const double R = inner + (outer - inner) * x[0], angle = std::numbers::pi / 2 * x[1];
      return axisymmetric ? Eigen::Vector3d(R, 0.2 * x[1], 0)
                          : Eigen::Vector3d(R * std::cos(angle), R * std::sin(angle), 0);
    };
    mesh = block.make();
    BoundaryOptions pressure;
    pressure.region = "left";
    pressure.pressure = Expression{"t", {}};
    assembly = std::make_unique<BodyAssembly>(
        mesh, axisymmetric ? Kinematics::axisymmetric : Kinematics::plane_strain, Strain::small,
        std::vector<BodyOptions>{plastic_body(0, 0, incompressible)}, std::vector<BoundaryOptions>{pressure});
    held = hold(mesh, {1}, [this](const auto &X) { return axisymmetric || X[1] < 1e-9; });
    if (!axisymmetric)
    {
      const auto other = hold(mesh, {0}, [](const auto &X) { return X[0] < 1e-9; });
      std::transform(held.begin(), held.end(), other.begin(), held.begin(), std::logical_or<>());
    }
    u.assign(mesh.points.size(), 0);
  }

  /// @return Newton's iterations, or -1
  int load(double pressure)
  {
    const int n = solve(mesh, *assembly, held, pressure, u);
    assembly->commit(u);
    return n;
  }
};

const double shear_yield = yield / std::sqrt(3.0);

/// Pressure at which the plastic front is at c.
double hill_pressure(double c)
{
  return shear_yield * (1 - c * c / (outer * outer) + 2 * std::log(c / inner));
}

/// u = 3/2 k c^2 / (E R), in the elastic and in the plastic part. @return largest error over the largest value
double tube_error(Tube &tube, double c)
{
  for (const double front : {0.5 * (inner + c), c})
    EXPECT_GT(tube.load(hill_pressure(front)), 0);
  double error = 0;
  for (Index node = 0; node < tube.mesh.n_nodes(); ++node)
  {
    const Eigen::Vector3d X = point_of(tube.mesh.points, 2, node), v = point_of(tube.u, 2, node);
    const double R = tube.axisymmetric ? X[0] : X.norm();
    const double radial = tube.axisymmetric ? v[0] : v.dot(X) / R;
    error = std::max(error, std::abs(radial / (1.5 * shear_yield * c * c / young) - 1 / R));
  }
  return error;
}

TEST(PlasticTube, FollowsHillsSolution)
{
  const double c = 1.5;
  for (const bool axisymmetric : {true, false})
  {
    Tube coarse(axisymmetric, 16), fine(axisymmetric, 32);
    const double first = tube_error(coarse, c), second = tube_error(fine, c);
    EXPECT_LT(second, 2e-3);
    EXPECT_LT(second, first / 2.5);
    // The front lies within a cell of c; stresses are Hill's: sigma_rr = -k (1 - c^2/b^2 + 2 ln(c/R)) inside.
    const std::vector<double> plastic = fine.assembly->plastic_strain(), stress = fine.assembly->stress(fine.u);
    for (Index cell = 0; cell < fine.mesh.cells.size(); ++cell)
    {
      double R = 0;
      for (const Index node : fine.mesh.cells[cell])
        R += 0.25 * (axisymmetric ? fine.mesh.points[2 * node] : point_of(fine.mesh.points, 2, node).norm());
      EXPECT_TRUE(std::abs(R - c) < 1.5 / 32 || (plastic[cell] > 0) == (R < c)) << R;
      if (axisymmetric && R < c)
      {
        EXPECT_NEAR(stress[6 * cell], -shear_yield * (1 - c * c / 4 + 2 * std::log(c / R)), 0.01 * shear_yield);
        EXPECT_NEAR(stress[6 * cell + 2] - stress[6 * cell], 2 * shear_yield, 1e-4 * shear_yield);
      }
    }
  }
}

/// Beyond 2 k ln(b/a) nothing holds the tube.
TEST(PlasticTube, BearsHillsLimitAndNoMore)
{
  const double limit = 2 * shear_yield * std::log(outer / inner);
  Tube tube(true, 32);
  for (const double share : {0.5, 0.8, 0.9, 0.95, 0.99})
    EXPECT_GT(tube.load(share * limit), 0) << share;
  EXPECT_EQ(solve(tube.mesh, *tube.assembly, tube.held, 1.01 * limit, tube.u), -1);
}

// ---- History and assembly ------------------------------------------------------------------------------------------

TEST(PlasticHistory, OnlyCommittedDisplacementsLeaveATrace)
{
  const Mesh mesh = BlockMesh{CellShape::quadrilateral, {3, 3, 1}, 0.2}.make();
  BodyAssembly tried(mesh, Kinematics::plane_strain, Strain::small, {plastic_body(0.1, 0.1)}, {});
  BodyAssembly clean(mesh, Kinematics::plane_strain, Strain::small, {plastic_body(0.1, 0.1)}, {});
  const auto field = [&](double size)
  { return nodal_field(mesh, [=](const auto &X) { return Eigen::Vector3d(size * X[1], size * X[0] * X[1], 0); }); };
  std::vector<double> internal(mesh.points.size()), external(internal), of_clean(internal);
  for (BodyAssembly *assembly : {&tried, &clean})
    assembly->commit(field(5 * yield));
  ASSERT_TRUE(tried.assemble_tangent(field(-20 * yield), 0) &&
              tried.forces(field(30 * yield), 0, internal, external)); // an attempt that failed
  ASSERT_TRUE(tried.assemble_tangent(field(8 * yield), 0) && clean.assemble_tangent(field(8 * yield), 0));
  ASSERT_TRUE(tried.forces(field(8 * yield), 0, internal, external) &&
              clean.forces(field(8 * yield), 0, of_clean, external));
  EXPECT_EQ(internal, of_clean);
  EXPECT_EQ(global_matrix(mesh, tried).toDense(), global_matrix(mesh, clean).toDense());
  for (BodyAssembly *assembly : {&tried, &clean})
    assembly->commit(field(8 * yield));
  EXPECT_EQ(tried.plastic_strain(), clean.plastic_strain());
}

/// Left half elastic, right half plastic: the sum of what they are alone, however often it is assembled.
TEST(PlasticHistory, AnElasticBodyBesideAPlasticOneIsKept)
{
  Mesh mesh = BlockMesh{CellShape::hexahedron, {4, 2, 2}, 0.2}.make();
  for (const std::string name : {"west", "east"})
  {
    Group &group = mesh.groups[name];
    group.dim = 3;
    for (Index c = 0; c < mesh.cells.size(); ++c)
      if ((point_of(mesh.points, 3, mesh.cells[c][0])[0] < 0.4) == (name == "west"))
      {
        group.entities.push_back(mesh.cells[c]);
        group.cells.push_back(c);
      }
  }
  const auto body = [&](const std::string &name, MaterialLaw law)
  {
    BodyOptions out = plastic_body(0.1);
    out.name = out.region = name;
    out.material.law = law;
    return out;
  };
  constexpr auto solid = Kinematics::three_dimensional;
  BodyAssembly mixed(mesh, solid, Strain::small,
                     {body("west", MaterialLaw::linear_elastic), body("east", MaterialLaw::von_mises)}, {});
  EXPECT_FALSE(mixed.tangent_is_constant());
  const auto field = [&](double size)
  { return nodal_field(mesh, [=](const auto &X) { return Eigen::Vector3d(size * X[1] * X[2], size * X[0], 0); }); };
  for (const double size : {0.1 * yield, 20 * yield, -10 * yield})
  {
    BodyAssembly fresh(mesh, solid, Strain::small,
                       {body("west", MaterialLaw::linear_elastic), body("east", MaterialLaw::von_mises)}, {});
    ASSERT_TRUE(mixed.assemble_tangent(field(size), 0) && fresh.assemble_tangent(field(size), 0));
    EXPECT_EQ(global_matrix(mesh, mixed).toDense(), global_matrix(mesh, fresh).toDense());
    std::vector<double> internal(mesh.points.size()), by_cells(internal), external(internal);
    const BodyAssembly never_assembled(
        mesh, solid, Strain::small, {body("west", MaterialLaw::linear_elastic), body("east", MaterialLaw::von_mises)},
        {});
    ASSERT_TRUE(mixed.forces(field(size), 0, internal, external) &&
                never_assembled.forces(field(size), 0, by_cells, external));
    for (std::size_t i = 0; i < internal.size(); ++i)
      EXPECT_NEAR(internal[i], by_cells[i], 1e-13 * yield);
  }
  for (Index c = 0; c < mesh.cells.size(); ++c)
    EXPECT_EQ(mixed.plastic_strain()[c], 0);
  mixed.commit(field(20 * yield));
  const std::vector<double> plastic = mixed.plastic_strain();
  for (const Index c : mesh.groups.at("west").cells)
    EXPECT_EQ(plastic[c], 0);
  for (const Index c : mesh.groups.at("east").cells)
    EXPECT_GT(plastic[c], 0);
}

TEST(PlasticBodies, WhatCannotBeIsRefused)
{
  const Mesh mesh = BlockMesh{}.make();
  const auto message = [&](const BodyOptions &body, Kinematics kinematics, Strain strain) -> std::string
  {
    try
    {
      const BodyAssembly assembly(mesh, kinematics, strain, {body}, {});
    }
    catch (const UserError &error)
    {
      return error.what();
    }
    return "";
  };
  using testing::HasSubstr;
  EXPECT_THAT(message(plastic_body(), Kinematics::plane_stress, Strain::small), HasSubstr("plane stress"));
  EXPECT_THAT(message(plastic_body(), Kinematics::plane_strain, Strain::finite), HasSubstr("small strain only"));
  EXPECT_THAT(message(plastic_body(-1), Kinematics::plane_strain, Strain::small), HasSubstr("must not be negative"));
  BodyOptions body = plastic_body();
  body.material.yield_stress = 0;
  EXPECT_THAT(message(body, Kinematics::plane_strain, Strain::small), HasSubstr("yield-stress must be positive"));
  EXPECT_EQ(message(plastic_body(), Kinematics::plane_strain, Strain::small), "");
}
} // namespace
} // namespace amontons
