// Overlaps of faces held against areas found by other means: the intersection of convex polygons from corners inside
// each other and crossings of edges, rays cast one by one, and parts that have to sum to the whole.
#include "amontons/surface/quadrature.h"
#include "overlap_points.h"
#include "surfaces.h"

#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
using Eigen::Vector2d;
using Eigen::Vector3d;

double cross(const Vector2d &a, const Vector2d &b)
{
  return a.x() * b.y() - a.y() * b.x();
}

TEST(GaussRule, IsExactForPolynomials)
{
  for (int n = 1; n <= 12; ++n)
    for (int degree = 0; degree < 2 * n; ++degree)
    {
      double sum = 0;
      for (const GaussPoint &point : gauss_rule(n))
        sum += point.weight * std::pow(point.x, degree);
      EXPECT_NEAR(sum, 1.0 / (degree + 1), 1e-14) << n << " points, degree " << degree;
    }
}

/// A convex polygon with its corners on an ellipse-like curve, counter-clockwise.
std::vector<Vector2d> random_face(int n, std::mt19937 &random)
{
  std::uniform_real_distribution<double> share(-1, 1);
  const Vector2d centre(0.6 * share(random), 0.6 * share(random));
  const double turn = 3 * share(random);
  std::vector<Vector2d> out;
  for (int i = 0; i < n; ++i)
  {
    const double angle = turn + 2 * std::numbers::pi * (i + 0.3 * share(random)) / n;
    out.emplace_back(centre + Vector2d(1.3 * std::cos(angle), std::sin(angle)));
  }
  return out;
}

bool inside(const std::vector<Vector2d> &polygon, const Vector2d &x)
{
  for (std::size_t i = 0; i < polygon.size(); ++i)
    if (cross(polygon[(i + 1) % polygon.size()] - polygon[i], x - polygon[i]) < 0)
      return false;
  return true;
}

/// The area that two convex polygons share, from the hull of its corners about their mean.
double shared_area(const std::vector<Vector2d> &a, const std::vector<Vector2d> &b)
{
  std::vector<Vector2d> corners;
  for (const Vector2d &x : a)
    if (inside(b, x))
      corners.push_back(x);
  for (const Vector2d &x : b)
    if (inside(a, x))
      corners.push_back(x);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k)
    {
      const Vector2d p = a[i], r = a[(i + 1) % a.size()] - p, q = b[k], s = b[(k + 1) % b.size()] - q;
      const double t = cross(q - p, s) / cross(r, s), u = cross(q - p, r) / cross(r, s);
      if (t >= 0 && t <= 1 && u >= 0 && u <= 1)
        corners.push_back(p + t * r);
    }
  if (corners.size() < 3)
    return 0;
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d &x : corners)
    mean += x / static_cast<double>(corners.size());
  std::sort(corners.begin(), corners.end(),
            [&](const Vector2d &x, const Vector2d &y) {
              return std::atan2(x.y() - mean.y(), x.x() - mean.x()) < std::atan2(y.y() - mean.y(), y.x() - mean.x());
            });
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += cross(corners[i] - mean, corners[(i + 1) % corners.size()] - mean) / 2;
  return sum;
}

/// A plane polygon as a face in a turned frame; `down`: its corners in the other order, so that it faces the other way.
FaceCoordinates placed(std::vector<Vector2d> polygon, const Eigen::Matrix3d &frame, double height, bool down)
{
  if (down)
    std::reverse(polygon.begin(), polygon.end());
  FaceCoordinates face;
  face.n_nodes = static_cast<int>(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i)
    face.x[i] = frame * Vector3d(polygon[i].x(), polygon[i].y(), height) + Vector3d(3, -2, 5);
  return face;
}

TEST(Segmentation, AreasOfPlaneFaces)
{
  std::mt19937 random(7);
  int n_empty = 0;
  for (int trial = 0; trial < 400; ++trial)
  {
    const Eigen::Matrix3d frame = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
    const auto a = random_face(3 + trial % 2, random), b = random_face(3 + trial / 2 % 2, random);
    const double gap = 0.1 * (trial % 7 - 3);
    const FaceOverlap overlap = overlap_of_faces(placed(a, frame, 0, false), placed(b, frame, gap, true));
    const double area = shared_area(a, b);
    n_empty += area == 0;
    EXPECT_NEAR(overlap.size, area, 1e-12);
    double weights = 0;
    for (const OverlapPoint &point : overlap.points)
    {
      weights += point.weight;
      EXPECT_NEAR(point.gap, gap, 1e-13);
      const Vector3d on_a = face_point(placed(a, frame, 0, false), point.impactor);
      const Vector3d on_b = face_point(placed(b, frame, gap, true), point.target);
      EXPECT_LT((on_b - on_a - gap * frame.col(2)).norm(), 1e-12);
    }
    EXPECT_NEAR(weights, area, 1e-12);
  }
  EXPECT_LT(n_empty, 100);
}

/// The integral of N_i N_k over a whole face by a product rule of high order in its own coordinates.
double integral_of_product(const FaceCoordinates &face, int i, int k)
{
  double sum = 0;
  for (const GaussPoint &s : gauss_rule(10))
    for (const GaussPoint &t : gauss_rule(10))
    {
      const LocalPoint xi = face.n_nodes == 4 ? LocalPoint{s.x, t.x} : LocalPoint{s.x * (1 - t.x), s.x * t.x};
      const auto n = shape_functions(face.n_nodes, xi);
      const auto base = face_tangents(face, xi);
      sum += s.weight * t.weight * (face.n_nodes == 4 ? 1 : s.x) * base[0].cross(base[1]).norm() * n[i] * n[k];
    }
  return sum;
}

// A face covered by many: what its parts integrate to is what the whole does, distorted quadrilaterals included.
TEST(Segmentation, PartsSumToTheWhole)
{
  std::mt19937 random(3);
  for (int trial = 0; trial < 30; ++trial)
  {
    const FaceCoordinates face = placed(random_face(3 + trial % 2, random), Eigen::Matrix3d::Identity(), 0, false);
    const auto bent = [&](double s, double t) {
      return Point{3 + 6 * s - 3 + 0.3 * t * t, -2 + 6 * t - 3 - 0.4 * s * t, 5.25};
    };
    // The sheet's normal has to look down.
    const Surface cover = sheet(5, 4, trial % 3 == 0, [&](double s, double t) { return bent(t, s); });
    Eigen::Matrix4d mass = Eigen::Matrix4d::Zero();
    double size = 0;
    for (Index f = 0; f < cover.n_faces(); ++f)
    {
      const FaceOverlap overlap = overlap_of_faces(face, gather_face(3, cover.face(f), cover.reference));
      size += overlap.size;
      for (const OverlapPoint &point : overlap.points)
      {
        const auto n = shape_functions(face.n_nodes, point.impactor);
        const Eigen::Map<const Eigen::Vector4d> values(n.data());
        mass += point.weight * values * values.transpose();
        EXPECT_NEAR(point.gap, 0.25, 1e-12);
      }
    }
    double whole = 0;
    for (int i = 0; i < face.n_nodes; ++i)
      for (int k = 0; k < face.n_nodes; ++k)
      {
        EXPECT_NEAR(mass(i, k), integral_of_product(face, i, k), 1e-9);
        whole += integral_of_product(face, i, k);
      }
    EXPECT_NEAR(size, whole, 1e-11);
  }
}

TEST(Segmentation, FacesThatLookTheSameWayDoNotMeet)
{
  std::mt19937 random(1);
  const auto a = random_face(4, random);
  const Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  EXPECT_GT(overlap_of_faces(placed(a, frame, 0, false), placed(a, frame, 0.1, true)).size, 1);
  EXPECT_TRUE(overlap_of_faces(placed(a, frame, 0, false), placed(a, frame, 0.1, false)).points.empty());
}

FaceCoordinates segment(const Vector2d &a, const Vector2d &b)
{
  FaceCoordinates face;
  face.n_nodes = 2;
  face.x[0] = {a.x(), a.y(), 0};
  face.x[1] = {b.x(), b.y(), 0};
  return face;
}

// Rays along the interpolated normals, cast one by one.
TEST(Segmentation, SegmentsMeetWhereRaysDo)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(-1, 1);
  constexpr int n_rays = 20000;
  for (int trial = 0; trial < 50; ++trial)
  {
    const auto jitter = [&] { return 0.2 * share(random); };
    const FaceCoordinates impactor = segment({1 + jitter(), jitter()}, {0 + jitter(), jitter()});
    const double along = share(random), height = 0.4 * share(random);
    const FaceCoordinates target = segment({along, height + jitter()}, {along + 0.7, height + jitter()});
    const Vector3d middle = face_normal(impactor, {0, 0});
    const auto tilted = [&](double angle) { return Vector3d(Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * middle); };
    // Outwards at the ends or inwards.
    const double angle = 0.25 * share(random);
    const std::array<Vector3d, 2> normals{tilted(angle), tilted(-angle)};
    double length = 0;
    for (int ray = 0; ray < n_rays; ++ray)
    {
      const double xi = (ray + 0.5) / n_rays;
      const Vector3d x = face_point(impactor, {xi, 0}), n = ((1 - xi) * normals[0] + xi * normals[1]).normalized();
      Eigen::Matrix2d matrix;
      matrix << (target.x[1] - target.x[0]).head<2>(), -n.head<2>();
      const Vector2d hit = matrix.inverse() * (x - target.x[0]).head<2>();
      length += hit[0] >= 0 && hit[0] <= 1 ? (impactor.x[1] - impactor.x[0]).norm() / n_rays : 0;
    }
    const FaceOverlap overlap = overlap_of_segments(impactor, normals, target);
    EXPECT_NEAR(overlap.size, length, 2.5 / n_rays);
    for (const OverlapPoint &point : overlap.points)
    {
      const double xi = point.impactor[0];
      const Vector3d n = ((1 - xi) * normals[0] + xi * normals[1]).normalized();
      const Vector3d seen = face_point(impactor, point.impactor) + point.gap * n;
      EXPECT_LT((seen - face_point(target, point.target)).norm(), 1e-13);
      EXPECT_TRUE(point.target[0] > 0 && point.target[0] < 1);
    }
  }
}

// A face at the end of a flat, its normals turned at one end only, before a target of one long segment.
TEST(Segmentation, LongSegmentsAreSeenWhole)
{
  const FaceCoordinates impactor = segment({1, 0}, {0, 0});
  const Vector3d middle = face_normal(impactor, {0, 0});
  const double side = middle.y() > 0 ? 1 : -1;
  for (const double angle : {-0.5, -0.2, -0.05, 0.05, 0.2, 0.5})
    for (const int end : {0, 1})
      for (const double length : {1.5, 10.0, 100.0, 2000.0})
      {
        std::array<Vector3d, 2> normals{middle, middle};
        normals[end] = Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * middle;
        const FaceCoordinates target = segment({-length, 1e-3 * side}, {length, 1e-3 * side});
        EXPECT_NEAR(overlap_of_segments(impactor, normals, target).size, 1, 1e-12)
            << angle << ' ' << end << ' ' << length;
      }
}

// A round face above a long flat one: the normals of its sides meet behind it, and what lies beyond there they do not
// see, however far they look. Each ray that goes down meets the flat once, in one piece or in many.
TEST(Segmentation, NothingIsSeenBehindWhereNormalsMeet)
{
  const auto at = [](double angle) { return Vector2d(std::sin(angle), 1.2 - std::cos(angle)); };
  const double step = 0.2;
  for (const int pieces : {1, 3, 40})
    for (double angle = -1.1; angle < 1; angle += step)
    {
      const FaceCoordinates impactor = segment(at(angle), at(angle + step));
      const auto outward = [](double a) { return Vector3d(std::sin(a), -std::cos(a), 0); };
      const std::array<Vector3d, 2> normals{outward(angle), outward(angle + step)};
      double size = 0, gap = 0;
      for (int k = 0; k < pieces; ++k)
      {
        const FaceCoordinates target = segment({20 - 40. * k / pieces, 0}, {20 - 40. * (k + 1) / pieces, 0});
        const FaceOverlap overlap = overlap_of_segments(impactor, normals, target);
        size += overlap.size;
        for (const OverlapPoint &point : overlap.points)
          gap = std::max(gap, std::abs(point.gap));
      }
      EXPECT_NEAR(size, (impactor.x[1] - impactor.x[0]).norm(), 1e-12) << pieces << ' ' << angle;
      EXPECT_LT(gap, 1.2 / std::cos(1.1));
    }
}
} // namespace
} // namespace amontons::test
