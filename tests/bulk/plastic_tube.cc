// Thick tube, 1 <= R <= 2, under internal pressure: perfectly plastic, incompressible (Hill 1950, chapter V).
#include "plastic_body.h"

#include <gmock/gmock.h>

#include <numbers>

namespace amontons
{
namespace
{
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
} // namespace
} // namespace amontons
