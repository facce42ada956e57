// Brute force is the oracle of the other methods but projects as they do. Here it is held against arithmetic that is
// not ours: CGAL's squared distances to triangles, and on quadrilaterals a minimiser that knows only where points of a
// face are.
#include "amontons/detection/detector.h"
#include "detection/cases.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <limits>

namespace amontons::test
{
namespace
{
using Eigen::Vector3d;

Vector3d node_of(const Surface &surface, Index node)
{
  const double *x = surface.reference.data() + static_cast<std::ptrdiff_t>(node) * 3;
  return {x[0], x[1], x[2]};
}

std::vector<Vector3d> corners_of(const Surface &surface, Index f)
{
  std::vector<Vector3d> corners;
  for (const Index node : surface.face(f))
    corners.push_back(node_of(surface, node));
  return corners;
}

// All pairs, past the ends too: the closest point whatever lies there.
Pairing closest_by(DetectionMethod method, const Surface &impactor, const Surface &target, double reach)
{
  DetectionOptions options;
  options.method = method;
  options.extension = std::numeric_limits<double>::max();
  return make_detector(options, impactor, target)->detect(impactor.reference, target.reference, reach);
}

// The least value on [low, high] of a function with one minimum there: golden sections.
template<typename Function>
double least_value(const Function &function, double low, double high)
{
  const double section = 0.5 * (std::sqrt(5.0) - 1);
  double a = high - section * (high - low), b = low + section * (high - low);
  double at_a = function(a), at_b = function(b);
  while (high - low > 1e-9)
    if (at_a < at_b)
    {
      high = b;
      b = a;
      at_b = at_a;
      at_a = function(a = high - section * (high - low));
    }
    else
    {
      low = a;
      a = b;
      at_a = at_b;
      at_b = function(b = low + section * (high - low));
    }
  return std::min({at_a, at_b, function(low), function(high)});
}

// Squared distance to a bilinear quadrilateral. Along each of its straight lines there is one minimum; across them
// there may be several, told apart by a row of samples.
double squared_distance_to_quadrilateral(const std::vector<Vector3d> &x, const Vector3d &point)
{
  constexpr int n_samples = 24;
  const auto on_line = [&](double s)
  {
    const Vector3d from = x[0] + s * (x[1] - x[0]), to = x[3] + s * (x[2] - x[3]);
    return least_value([&](double t) { return (point - from - t * (to - from)).squaredNorm(); }, 0, 1);
  };
  std::vector<double> samples;
  for (int i = 0; i <= n_samples; ++i)
    samples.push_back(on_line(static_cast<double>(i) / n_samples));
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n_samples; ++i)
    if ((i == 0 || samples[i] <= samples[i - 1]) && (i == n_samples || samples[i] <= samples[i + 1]))
      least = std::min(least, least_value(on_line, std::max(i - 1.0, 0.0) / n_samples,
                                          std::min(i + 1.0, double{n_samples}) / n_samples));
  return least;
}

// The distance to all quadrilaterals; spheres about them tell which cannot be the closest.
double distance_to_quadrilaterals(const Surface &surface, const Vector3d &point)
{
  double bound = std::numeric_limits<double>::infinity();
  for (Index node = 0; node < surface.n_nodes(); ++node)
    bound = std::min(bound, (point - node_of(surface, node)).norm());
  double least = bound * bound;
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    const std::vector<Vector3d> x = corners_of(surface, f);
    double radius = 0;
    for (const Vector3d &corner : x)
      radius = std::max(radius, (corner - x[0]).norm());
    if ((point - x[0]).norm() - radius <= bound)
      least = std::min(least, squared_distance_to_quadrilateral(x, point));
  }
  return std::sqrt(least);
}

// Faces that are far from plane: their corners lie up and down by as much as they are long.
Case warped()
{
  std::mt19937 random(8);
  std::uniform_real_distribution<double> up(-1.0 / 15, 1.0 / 15);
  return {"warped", sheet(15, 15, false, [&](double s, double t) { return Point{s, t, up(random)}; }), 0.2};
}

double distance_to_segments(const Surface &surface, double x, double y)
{
  double least = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    const double *a = &surface.reference[2 * static_cast<std::size_t>(surface.face(f)[0])];
    const double *b = &surface.reference[2 * static_cast<std::size_t>(surface.face(f)[1])];
    const auto squared_distance = [=](double s)
    {
      const double dx = x - a[0] - s * (b[0] - a[0]), dy = y - a[1] - s * (b[1] - a[1]);
      return dx * dx + dy * dy;
    };
    least = std::min(least, least_value(squared_distance, 0, 1));
  }
  return std::sqrt(least);
}

TEST(Oracle, BruteForceAgreesWithAMinimiserOnSegments)
{
  for (const Case &c : cases_2d())
  {
    const Surface impactor = cloud_about(c.target, 100, c.spread, 20);
    const Pairing pairing = closest_by(DetectionMethod::brute, impactor, c.target, 2 * c.spread);
    for (Index node = 0; node < impactor.n_nodes(); ++node)
    {
      const double x = impactor.reference[2 * node], y = impactor.reference[2 * node + 1];
      ASSERT_GE(pairing[node].face, 0) << c.name;
      EXPECT_NEAR(pairing[node].distance, distance_to_segments(c.target, x, y), 1e-13) << c.name;
    }
  }
}

TEST(Oracle, BruteForceAgreesWithAMinimiserOnQuadrilaterals)
{
  std::vector<Case> cases = cases_3d(false);
  cases.push_back(warped());
  for (const Case &c : cases)
  {
    const Surface impactor = cloud_about(c.target, 60, c.spread, 21);
    const Pairing pairing = closest_by(DetectionMethod::brute, impactor, c.target, 2 * c.spread);
    int n_compared = 0;
    for (Index node = 0; node < impactor.n_nodes(); ++node)
      if (const Pair &pair = pairing[node]; pair.face >= 0)
      {
        ++n_compared;
        EXPECT_NEAR(pair.distance, distance_to_quadrilaterals(c.target, node_of(impactor, node)), 1e-13) << c.name;
      }
    EXPECT_GT(n_compared, 50) << c.name;
  }
}

// CGAL's own tree and its own closest points.
class CgalTriangles
{
public:
  explicit CgalTriangles(const Surface &surface)
  {
    for (Index f = 0; f < surface.n_faces(); ++f)
    {
      const std::vector<Vector3d> x = corners_of(surface, f);
      triangles_.emplace_back(point(x[0]), point(x[1]), point(x[2]));
    }
    tree_.insert(triangles_.cbegin(), triangles_.cend());
    tree_.build();
  }

  [[nodiscard]] double distance(const Vector3d &x) const { return std::sqrt(tree_.squared_distance(point(x))); }

private:
  using Kernel = CGAL::Simple_cartesian<double>;
  using Triangles = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
  static Kernel::Point_3 point(const Vector3d &x) { return {x.x(), x.y(), x.z()}; }

  Triangles triangles_;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree_;
};

TEST(Oracle, BruteForceAndExactAgreeWithCgalOnTriangles)
{
  for (const Case &c : cases_3d(true))
  {
    const CgalTriangles cgal(c.target);
    const Surface impactor = cloud_about(c.target, 300, c.spread, 22);
    for (const DetectionMethod method : {DetectionMethod::brute, DetectionMethod::exact})
    {
      const Pairing pairing = closest_by(method, impactor, c.target, 2 * c.spread);
      int n_compared = 0;
      for (Index node = 0; node < impactor.n_nodes(); ++node)
        if (const Pair &pair = pairing[node]; pair.face >= 0)
        {
          ++n_compared;
          EXPECT_NEAR(pair.distance, cgal.distance(node_of(impactor, node)), 1e-13) << c.name;
        }
      EXPECT_GT(n_compared, 250) << c.name;
    }
  }
}

// And whole surfaces, where brute force would take too long.
TEST(Oracle, ExactAgreesWithCgalOnLargeSurfaces)
{
  for (const Case &c : cases_3d(true, 3))
  {
    const CgalTriangles cgal(c.target);
    const Surface impactor = cloud_about(c.target, 3000, c.spread / 3, 23);
    const Pairing pairing = closest_by(DetectionMethod::exact, impactor, c.target, c.spread);
    double worst = 0;
    for (Index node = 0; node < impactor.n_nodes(); ++node)
      worst = std::max(worst, std::abs(pairing[node].distance - cgal.distance(node_of(impactor, node))));
    EXPECT_LE(worst, 1e-13) << c.name;
  }
}
} // namespace
} // namespace amontons::test
