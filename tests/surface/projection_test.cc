#include "amontons/surface/projection.h"
#include "amontons/surface/quadrilateral.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <random>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

struct Random
{
  std::mt19937 engine;
  std::uniform_real_distribution<double> uniform{-1, 1};
  explicit Random(unsigned seed)
    : engine(seed)
  {
  }
  Vector3d vector() { return {uniform(engine), uniform(engine), uniform(engine)}; }
};

// A unit square pulled about: from nearly flat to folded over.
FaceCoordinates random_quadrilateral(Random &random, double distortion)
{
  FaceCoordinates face{4, {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 1, 0), Vector3d(0, 1, 0)}};
  for (Vector3d &x : face.x)
    x += distortion * random.vector();
  return face;
}

// Least squared distance by scanning a grid and closing in on the best cells: no derivative, no shared code but x(xi).
double least_squared_distance(const FaceCoordinates &face, const Vector3d &x)
{
  const auto f = [&](double s, double t) { return (x - face_point(face, {s, t})).squaredNorm(); };
  constexpr int n = 24;
  std::vector<std::array<double, 3>> starts;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
    {
      const double s = static_cast<double>(i) / n, t = static_cast<double>(j) / n;
      starts.push_back({f(s, t), s, t});
    }
  std::sort(starts.begin(), starts.end());
  double least = starts[0][0];
  for (std::size_t start = 0; start < 12; ++start)
  {
    auto [best, s, t] = starts[start];
    for (double step = 0.5 / n; step > 1e-11; step *= 0.7)
      for (int i = -2; i <= 2; ++i)
        for (int j = -2; j <= 2; ++j)
        {
          const double p = std::clamp(s + i * step / 2, 0.0, 1.0), q = std::clamp(t + j * step / 2, 0.0, 1.0);
          if (const double value = f(p, q); value < best)
          {
            best = value;
            s = p;
            t = q;
          }
        }
    least = std::min(least, best);
  }
  return least;
}

TEST(Projection, QuadrilateralAgreesWithAScalarMinimiser)
{
  for (const double distortion : {0.0, 0.1, 0.3, 0.8})
  {
    Random random(5);
    for (int trial = 0; trial < 150; ++trial)
    {
      const FaceCoordinates face = random_quadrilateral(random, distortion);
      const Vector3d x = 1.5 * random.vector() + Vector3d(0.5, 0.5, 0);
      const double expected = std::sqrt(least_squared_distance(face, x));
      EXPECT_NEAR(std::sqrt(closest_point(face, x).squared_distance), expected, 1e-9) << distortion << ' ' << trial;
      EXPECT_NEAR(std::sqrt(closest_point_by_quintic(face, x).squared_distance), expected, 1e-9)
          << distortion << ' ' << trial;
    }
  }
}

TEST(Projection, QuadrilateralByNewtonAndByQuinticAreTheSame)
{
  for (const double distortion : {0.0, 0.05, 0.2, 0.5, 1.0})
  {
    Random random(17);
    for (int trial = 0; trial < 4000; ++trial)
    {
      const FaceCoordinates face = random_quadrilateral(random, distortion);
      const Vector3d x = 1.5 * random.vector() + Vector3d(0.5, 0.5, 0);
      EXPECT_NEAR(std::sqrt(closest_point(face, x).squared_distance),
                  std::sqrt(closest_point_by_quintic(face, x).squared_distance), 1e-13)
          << distortion << ' ' << trial;
    }
  }
}
} // namespace
} // namespace amontons
