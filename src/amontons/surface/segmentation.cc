#include "amontons/surface/segmentation.h"

#include "amontons/base/error.h"
#include "amontons/surface/quadrature.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace amontons
{
namespace
{
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Cosine of the largest angle between the impactor's normal and the opposite of the target's.
const double least_facing = std::cos(80 * 3.14159265358979323846 / 180);
/// Overlaps of a smaller part of the impactor face are round-off.
constexpr double round_off = 1e-12;
constexpr int n_on_segment = 4;

double cross(const Vector2d &a, const Vector2d &b)
{
  return a.x() * b.y() - a.y() * b.x();
}

/// A segment with normals at its ends that are interpolated between them.
struct NormalField
{
  Vector2d x, edge, normal, turn;

  NormalField(const FaceCoordinates &face, const std::array<Vector3d, 2> &normals)
    : x(face.x[0].head<2>())
    , edge((face.x[1] - face.x[0]).head<2>())
    , normal(normals[0].head<2>())
    , turn((normals[1] - normals[0]).head<2>())
  {
  }
  [[nodiscard]] Vector2d at(double xi) const { return x + xi * edge; }
  [[nodiscard]] Vector2d normal_at(double xi) const { return (normal + xi * turn).normalized(); }

  /// xi with (x(xi) - y) x n(xi) = 0: of the two roots the one that stays where the normals become parallel. The other
  /// one, where the normals would lie along the segment, may be the nearer for a point far off.
  [[nodiscard]] std::optional<double> project(const Vector2d &y) const
  {
    const double c = cross(x - y, normal), b = cross(edge, normal) + cross(x - y, turn), a = cross(edge, turn);
    const double discriminant = b * b - 4 * a * c;
    if (discriminant < 0)
      return {};
    const double denominator = b + std::copysign(std::sqrt(discriminant), cross(edge, normal));
    if (denominator == 0)
      return {};
    return -2 * c / denominator;
  }
};

/// A polygon in the plane of projection.
using Polygon = std::vector<Vector2d>;

/// Part of `subject` on the inner (left) side of the line from a to b.
Polygon clip(const Polygon &subject, const Vector2d &a, const Vector2d &b)
{
  Polygon out;
  const auto side = [&](const Vector2d &x) { return cross(b - a, x - a); };
  for (std::size_t i = 0; i < subject.size(); ++i)
  {
    const Vector2d &from = subject[i], &to = subject[(i + 1) % subject.size()];
    const double s = side(from), e = side(to);
    if (s >= 0)
      out.push_back(from);
    if ((s > 0 && e < 0) || (s < 0 && e > 0))
      out.emplace_back(from + s / (s - e) * (to - from));
  }
  return out;
}

double area(const Polygon &polygon)
{
  double sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return sum / 2;
}

/// A face seen in the plane of projection.
class FlatFace
{
public:
  /// @param base two orthonormal vectors of the plane through `origin`
  FlatFace(const FaceCoordinates &face, const Vector3d &origin, const std::array<Vector3d, 2> &base)
    : n_(face.n_nodes)
  {
    for (int i = 0; i < n_; ++i)
      x_[i] = {(face.x[i] - origin).dot(base[0]), (face.x[i] - origin).dot(base[1])};
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (int i = 0; i < n_; ++i)
    {
      const double corner = cross(x_[(i + 1) % n_] - x_[i], x_[(i + n_ - 1) % n_] - x_[i]);
      least = std::min(least, corner);
      most = std::max(most, corner);
    }
    // A target that faces the impactor is seen turning the other way.
    const bool turned = most < 0;
    convex_ = least > 0 || turned;
    distortion_ = n_ == 4 && convex_ ? (most - least) / std::abs(most + least) : 0;
    // Not a distortion but round-off.
    if (distortion_ < 1e-13)
      distortion_ = 0;
  }
  [[nodiscard]] bool convex() const { return convex_; }
  [[nodiscard]] bool triangle() const { return n_ == 3; }
  /// 0 for triangles and parallelograms, 1 where a corner becomes flat.
  [[nodiscard]] double distortion() const { return distortion_; }

  /// The corners, counter-clockwise.
  [[nodiscard]] Polygon polygon() const
  {
    Polygon out(x_.begin(), x_.begin() + n_);
    if (area(out) < 0)
      std::reverse(out.begin(), out.end());
    return out;
  }

  /// Local coordinates of a point of the face.
  [[nodiscard]] LocalPoint local(const Vector2d &y) const
  {
    const Vector2d mixed = n_ == 4 ? Vector2d(x_[0] - x_[1] + x_[2] - x_[3]) : Vector2d::Zero();
    const Vector2d a = x_[1] - x_[0], b = x_[n_ - 1] - x_[0];
    Vector2d xi = n_ == 4 ? Vector2d(0.5, 0.5) : Vector2d::Zero();
    // One step where the face is affine, and another for its round-off.
    for (int step = 0, steps = distortion_ == 0 ? 2 : 12; step < steps; ++step)
    {
      const Vector2d d1 = a + xi[1] * mixed, d2 = b + xi[0] * mixed;
      const Vector2d rest = y - x_[0] - xi[0] * a - xi[1] * b - xi[0] * xi[1] * mixed;
      const double det = cross(d1, d2);
      const Vector2d change(cross(rest, d2) / det, cross(d1, rest) / det);
      xi += change;
      if (change.cwiseAbs().maxCoeff() < 1e-15)
        break;
    }
    return {xi[0], xi[1]};
  }

private:
  int n_;
  std::array<Vector2d, 4> x_;
  bool convex_ = false;
  double distortion_ = 0;
};

/// Points along each side of a triangle's rule, with which the integrand is exact, or, on a distorted quadrilateral,
/// good to 1e-10: shape functions are analytic up to where the map folds, 1/distortion half-widths off, and Gauss's
/// rule converges as the ellipse through there tells (Trefethen 2008, SIAM Review 50).
int n_along_side(const FlatFace &impactor, const FlatFace &target)
{
  const double distortion = std::max(impactor.distortion(), target.distortion());
  const int exact = impactor.triangle() && target.triangle() ? 2 : 3;
  if (distortion == 0)
    return exact;
  const double fold = 1 / std::min(distortion, 0.9);
  const double ellipse = fold + std::sqrt(fold * fold - 1);
  return std::clamp(static_cast<int>(std::ceil(1 + 11.5 / std::log(ellipse))), exact, 12);
}

/// Adds the points of a triangle: Gauss's rule squeezed onto it (conical product).
template<class Add>
void visit_triangle(const Vector2d &a, const Vector2d &b, const Vector2d &c, int n, Add &&add)
{
  const double twice_area = cross(b - a, c - a);
  for (const GaussPoint &u : gauss_rule(n))
    for (const GaussPoint &v : gauss_rule(n))
      add(Vector2d(a + u.x * ((1 - v.x) * (b - a) + v.x * (c - a))), twice_area * u.weight * v.weight * u.x);
}
} // namespace

FaceOverlap overlap_of_segments(const FaceCoordinates &impactor, const std::array<Vector3d, 2> &normals,
                                const FaceCoordinates &target)
{
  FaceOverlap out;
  if (face_normal(target, {0, 0}).dot(face_normal(impactor, {0, 0})) > -least_facing)
    return out;
  const NormalField field(impactor, normals);
  const Vector2d y = target.x[0].head<2>(), along = (target.x[1] - target.x[0]).head<2>();
  const auto first = field.project(y), second = field.project(y + along);
  if (!first || !second)
    return out;
  const double from = std::max(0.0, std::min(*first, *second)), to = std::min(1.0, std::max(*first, *second));
  if (to - from < round_off)
    return out;
  const double length = field.edge.norm();
  out.size = (to - from) * length;
  for (const GaussPoint &point : gauss_rule(n_on_segment))
  {
    const double xi = from + (to - from) * point.x;
    const Vector2d x = field.at(xi), n = field.normal_at(xi);
    const double eta = cross(x - y, n) / cross(along, n);
    out.points.push_back({{xi, 0}, {eta, 0}, point.weight * out.size, (y + eta * along - x).dot(n)});
  }
  return out;
}

FaceOverlap overlap_of_faces(const FaceCoordinates &impactor, const FaceCoordinates &target)
{
  FaceOverlap out;
  const Vector3d normal = face_normal(impactor, face_centre(impactor));
  if (face_normal(target, face_centre(target)).dot(normal) > -least_facing)
    return out;
  const Vector3d origin = face_point(impactor, face_centre(impactor));
  const Vector3d e1 = (impactor.x[1] - impactor.x[0] - normal.dot(impactor.x[1] - impactor.x[0]) * normal).normalized();
  const std::array<Vector3d, 2> base{e1, normal.cross(e1)};
  const FlatFace own(impactor, origin, base), other(target, origin, base);
  if (!own.convex())
    throw NumericalFailure("a face of the impactor is not convex");
  if (!other.convex())
    return out;
  const Polygon mine = own.polygon();
  Polygon common = other.polygon();
  for (std::size_t i = 0; i < mine.size() && !common.empty(); ++i)
    common = clip(common, mine[i], mine[(i + 1) % mine.size()]);
  if (common.size() < 3 || area(common) < round_off * area(mine))
    return out;
  out.size = area(common);
  const int n = n_along_side(own, other);
  const auto add = [&](const Vector2d &x, double weight)
  {
    OverlapPoint point{own.local(x), other.local(x), weight, 0};
    point.gap = (face_point(target, point.target) - face_point(impactor, point.impactor)).dot(normal);
    out.points.push_back(point);
  };
  for (std::size_t i = 2; i < common.size(); ++i)
    visit_triangle(common[0], common[i - 1], common[i], n, add);
  return out;
}
} // namespace amontons
