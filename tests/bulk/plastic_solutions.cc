// Uniform states of von Mises' law, which are known exactly.
#include "plastic_body.h"

#include <gmock/gmock.h>

namespace amontons
{
namespace
{
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
  return {
      {CellShape::triangle, Kinematics::plane_stress},         {CellShape::quadrilateral, Kinematics::plane_stress},
      {CellShape::triangle, Kinematics::axisymmetric},         {CellShape::quadrilateral, Kinematics::axisymmetric},
      {CellShape::tetrahedron, Kinematics::three_dimensional}, {CellShape::hexahedron, Kinematics::three_dimensional}};
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

/// Equal pull on all sides of a sheet: the equivalent stress is the stress, and the sheet thins by the plastic strain
/// p, so the strain is (1 - nu) stress / E + p / 2. A Poisson's ratio of zero makes the search for the thinning
/// hardest.
TEST(PlasticSheet, EqualBiaxialTensionIsPiecewiseLinear)
{
  const double h = 0.2;
  for (const double nu : {0.0, 0.3, 0.49})
  {
    const Mesh mesh = BlockMesh{CellShape::quadrilateral, {2, 2, 1}, 0.2}.make();
    BodyAssembly assembly(mesh, Kinematics::plane_stress, Strain::small, {plastic_body(h, 0, nu)}, {});
    for (const double strain : {0.5 * yield, 2 * yield, 50 * yield})
    {
      const auto u = nodal_field(mesh, [&](const auto &X) { return Eigen::Vector3d(strain * X[0], strain * X[1], 0); });
      const double p = std::max(0.0, (strain - (1 - nu) * yield / young) / ((1 - nu) * h / young + 0.5));
      const std::vector<double> stress = assembly.stress(u);
      assembly.commit(u);
      for (std::size_t c = 0; c < assembly.plastic_strain().size(); ++c)
      {
        EXPECT_NEAR(assembly.plastic_strain()[c], p, 1e-11 * yield);
        EXPECT_NEAR(stress[6 * c], p > 0 ? yield + h * p : young * strain / (1 - nu), 1e-11 * yield);
        EXPECT_NEAR(stress[6 * c + 2], 0, 1e-11 * yield);
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
} // namespace
} // namespace amontons
