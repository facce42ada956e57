#include "amontons/surface/shape_projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

struct Case
{
  std::string name;
  int dim;
  bool axisymmetric;
  Shape shape;
};

std::vector<Case> cases()
{
  const double c = 1 / std::sqrt(3.0);
  return {{"plane", 2, false, {ShapeType::plane, {0.1, 0.2, 0}, {0.6, 0.8, 0}}},
          {"plane", 3, false, {ShapeType::plane, {0.1, 0.2, 0.3}, {c, -c, c}}},
          {"circle", 2, false, {ShapeType::circle, {0.1, 0.2, 0}, {0, 1, 0}, 0.7}},
          {"sphere", 3, false, {ShapeType::sphere, {0.1, 0.2, 0.3}, {0, 1, 0}, 0.7}},
          {"ring of a sphere", 2, true, {ShapeType::sphere, {0, 0.2, 0}, {0, 1, 0}, 0.7}},
          {"cylinder", 3, false, {ShapeType::cylinder, {0.1, 0.2, 0.3}, {c, c, c}, 0.7}},
          {"cone", 3, false, {ShapeType::cone, {0.1, 0.2, 0.3}, {c, c, -c}, 0, 0.6}},
          {"blunt cone", 3, false, {ShapeType::cone, {0.1, 0.2, 0.3}, {0, 0, 1}, 0, 1.4}},
          {"ring of a cone", 2, true, {ShapeType::cone, {0, 0.2, 0}, {0, 1, 0}, 0, 1.1}}};
}

ShapeProjection project(const Case &c, const Vector3d &x)
{
  return project_on_shape(c.dim, c.axisymmetric, c.shape, c.shape.point, {x.data(), static_cast<std::size_t>(c.dim)});
}

std::vector<Vector3d> random_points(const Case &c)
{
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::vector<Vector3d> points;
  for (int i = 0; i < 200; ++i)
  {
    Vector3d x(uniform(random), uniform(random), uniform(random));
    if (c.dim == 2)
      x.z() = 0;
    if (c.axisymmetric)
      x.x() = std::abs(x.x());
    points.push_back(x);
  }
  return points;
}

TEST(ShapeProjection, TheNormalIsTheGradientOfTheGap)
{
  for (const Case &c : cases())
    for (const Vector3d &x : random_points(c))
    {
      const ShapeProjection at_x = project(c, x);
      EXPECT_NEAR(at_x.normal.norm(), 1, 1e-14) << c.name;
      for (int i = 0; i < c.dim; ++i)
      {
        const Vector3d step = 1e-6 * Vector3d::Unit(i);
        const double slope = (project(c, x + step).gap - project(c, x - step).gap) / 2e-6;
        EXPECT_NEAR(at_x.normal[i], slope, 2e-8) << c.name << " at " << x.transpose();
      }
    }
}

TEST(ShapeProjection, ThePointIsOnTheSurfaceAndAtTheGap)
{
  for (const Case &c : cases())
    for (const Vector3d &x : random_points(c))
    {
      const ShapeProjection at_x = project(c, x);
      EXPECT_NEAR(project(c, at_x.point).gap, 0, 1e-14) << c.name;
      EXPECT_NEAR((x - at_x.point).dot(at_x.normal), at_x.gap, 1e-14) << c.name;
      EXPECT_NEAR((x - at_x.point).norm(), std::abs(at_x.gap), 1e-14) << c.name;
    }
}

TEST(ShapeProjection, KnownGaps)
{
  const auto all = cases();
  EXPECT_NEAR(project(all[2], {0.1, 1.2, 0}).gap, 0.3, 1e-15);
  EXPECT_NEAR(project(all[3], {0.1, 0.2, 0}).gap, -0.4, 1e-15);
  EXPECT_NEAR(project(all[4], {0.3, 0.6, 0}).gap, 0.5 - 0.7, 1e-15);
  // Under the tip of a cone and beside its flank.
  EXPECT_EQ(project(all[8], {0, 0.1, 0}).kind, PairKind::vertex);
  EXPECT_NEAR(project(all[8], {0, 0.1, 0}).gap, 0.1, 1e-15);
  EXPECT_NEAR(project(all[8], {0.5, 0.2, 0}).gap, 0.5 * std::cos(1.1), 1e-15);
}

TEST(ShapeProjection, WhereTheDirectionIsNotUnique)
{
  for (const Case &c : cases())
  {
    const Vector3d x(c.shape.point[0], c.shape.point[1], c.dim == 3 ? c.shape.point[2] : 0.0);
    const ShapeProjection at_x = project(c, x);
    EXPECT_NEAR(at_x.normal.norm(), 1, 1e-14) << c.name;
    EXPECT_NEAR(at_x.gap, -c.shape.radius, 1e-14) << c.name;
  }
}

TEST(ShapeProjection, FollowsThePoint)
{
  const Case c = cases()[3];
  const std::array<double, 3> moved{1.1, 0.2, 0.3}, x{1.1, 0.2, 1.5};
  EXPECT_NEAR(project_on_shape(3, false, c.shape, moved, x).gap, 0.5, 1e-14);
}
} // namespace
} // namespace amontons
