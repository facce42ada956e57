#include "amontons/surface/flat_overlap.h"

#include "amontons/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace amontons
{
namespace
{
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Of the impactor's size: what is as near to one of its edges lies on it.
constexpr double on_edge = 1e-10;
/// Corners that are flat to round-off, as one part in this of the greatest, are not convex: the map is singular there.
constexpr double flat_corner = 1e-9;

double cross(const Vector2d &a, const Vector2d &b)
{
  return a.x() * b.y() - a.y() * b.x();
}

std::array<Vector3d, 2> base_of(const FaceCoordinates &face, const Vector3d &normal)
{
  const Vector3d edge = face.x[1] - face.x[0];
  const Vector3d first = (edge - normal.dot(edge) * normal).normalized();
  return {first, normal.cross(first)};
}

/// Part of `subject` on the inner (left) side of the line from a to b.
FlatPolygon clip(const FlatPolygon &subject, const Vector2d &a, const Vector2d &b, FlatLine line, double tolerance)
{
  std::array<double, FlatPolygon::max_corners> side{};
  const Vector2d along = b - a;
  const double nought = tolerance * along.norm();
  for (int i = 0; i < subject.n; ++i)
  {
    side[i] = cross(along, subject.corner[i] - a);
    if (std::abs(side[i]) <= nought)
      side[i] = 0;
  }
  FlatPolygon out;
  for (int i = 0; i < subject.n; ++i)
  {
    const int next = (i + 1) % subject.n;
    const Vector2d &from = subject.corner[i], &to = subject.corner[next];
    const double s = side[i], e = side[next];
    if (s > 0)
      out.add(from, subject.side[i]);
    if (s > 0 && e <= 0)
      out.add(from + s / (s - e) * (to - from), line);
    if (s <= 0 && e > 0)
      out.add(from + s / (s - e) * (to - from), subject.side[i]);
  }
  return out;
}

/// The corners counter-clockwise. @param first number of the face's first node among both faces'
FlatPolygon polygon_of(const FlatFace &face, int first)
{
  FlatPolygon out;
  const int n = face.n_nodes();
  for (int i = 0; i < n; ++i)
  {
    const int here = face.sense() > 0 ? i : n - 1 - i, next = (here + face.sense() + n) % n;
    out.add(face.node(here), {first + here, first + next});
  }
  return out;
}
} // namespace

FlatFace::FlatFace(const FaceCoordinates &face, const Vector3d &origin, const std::array<Vector3d, 2> &base)
  : n_(face.n_nodes)
{
  const Vector3d normal = base[0].cross(base[1]);
  for (int i = 0; i < n_; ++i)
  {
    const Vector3d x = face.x[i] - origin;
    x_[i] = {x.dot(base[0]), x.dot(base[1])};
    height_[i] = x.dot(normal);
  }
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (int i = 0; i < n_; ++i)
  {
    const double corner = cross(x_[(i + 1) % n_] - x_[i], x_[(i + n_ - 1) % n_] - x_[i]);
    least = std::min(least, corner);
    most = std::max(most, corner);
  }
  // A target that faces the impactor is seen turning the other way.
  sense_ = most < 0 ? -1 : 1;
  const double flat = flat_corner * std::max(std::abs(least), std::abs(most));
  convex_ = least > flat || most < -flat;
  distortion_ = n_ == 4 && convex_ ? (most - least) / std::abs(most + least) : 0;
  // Not a distortion but round-off.
  if (distortion_ < 1e-13)
    distortion_ = 0;
  a_ = x_[1] - x_[0];
  b_ = x_[n_ - 1] - x_[0];
  mixed_ = n_ == 4 ? Vector2d(x_[2] - x_[1] - b_) : Vector2d::Zero();
}

// y - x_0 - s a is along b + s mixed: a quadratic for s. Its derivative there is minus the map's Jacobian J(s, t),
// which tells the root; the denominator is twice J(0, t), so nothing cancels.
LocalPoint FlatFace::local(const Vector2d &y) const
{
  const Vector2d r = y - x_[0];
  const double square = -cross(a_, mixed_), linear = cross(r, mixed_) - cross(a_, b_), constant = cross(r, b_);
  const double root = std::sqrt(std::max(0.0, linear * linear - 4 * square * constant));
  const double s = 2 * constant / (sense_ * root - linear);
  const Vector2d way = b_ + s * mixed_;
  return {s, (r - s * a_).dot(way) / way.squaredNorm()};
}

FlatShape FlatFace::shape(const Vector2d &y, bool with_gradient) const
{
  FlatShape out;
  out.xi = local(y);
  out.value = shape_functions(n_, out.xi);
  if (!with_gradient)
    return out;
  const auto by_xi = shape_gradients(n_, out.xi);
  const Vector2d d1 = a_ + out.xi[1] * mixed_, d2 = b_ + out.xi[0] * mixed_;
  const double scale = 1 / cross(d1, d2);
  const Vector2d xi1 = scale * Vector2d(d2.y(), -d2.x()), xi2 = scale * Vector2d(-d1.y(), d1.x());
  for (int c = 0; c < 2; ++c)
    for (int i = 0; i < n_; ++i)
      out.gradient[c][i] = by_xi[0][i] * xi1[c] + by_xi[1][i] * xi2[c];
  return out;
}

double FlatFace::height_at(const FlatShape &shape) const
{
  double out = 0;
  for (int i = 0; i < n_; ++i)
    out += shape.value[i] * height_[i];
  return out;
}

ProjectionPlane::ProjectionPlane(const FaceCoordinates &impactor)
  : face_(impactor)
  , origin_(face_point(impactor, face_centre(impactor)))
  , normal_(face_normal(impactor, face_centre(impactor)))
  , base_(base_of(impactor, normal_))
  , own_(impactor, origin_, base_)
{
}

Eigen::Matrix<double, 2, 12> ProjectionPlane::tilt() const
{
  const auto by_xi = shape_gradients(face_.n_nodes, face_centre(face_));
  const auto tangents = face_tangents(face_, face_centre(face_));
  const double scale = 1 / tangents[0].cross(tangents[1]).norm();
  Eigen::Matrix<double, 2, 12> out = Eigen::Matrix<double, 2, 12>::Zero();
  for (int i = 0; i < face_.n_nodes; ++i)
  {
    const Vector3d turning = by_xi[0][i] * tangents[1] - by_xi[1][i] * tangents[0];
    for (int c = 0; c < 2; ++c)
      out.block<1, 3>(c, 3 * i) = scale * turning.cross(base_[c]).transpose();
  }
  return out;
}

void FlatPolygon::add(const Vector2d &x, FlatLine along)
{
  AMONTONS_ASSERT(n < max_corners);
  corner[n] = x;
  side[n] = along;
  ++n;
}

double FlatPolygon::area() const
{
  double sum = 0;
  for (int i = 2; i < n; ++i)
    sum += triangle(i).twice_area;
  return sum / 2;
}

FlatTriangle FlatPolygon::triangle(int i) const
{
  return {{corner[0], corner[i - 1], corner[i]}, cross(corner[i - 1] - corner[0], corner[i] - corner[0])};
}

FlatPolygon shared_part(const FlatFace &own, const FlatFace &other)
{
  if (!own.convex())
    throw NumericalFailure("a face of the impactor is not convex");
  if (!other.convex())
    return {};
  const FlatPolygon mine = polygon_of(own, 0);
  FlatPolygon out = polygon_of(other, 4);
  const double whole = mine.area(), tolerance = on_edge * std::sqrt(whole);
  for (int i = 0; i < mine.n && out.n > 0; ++i)
    out = clip(out, mine.corner[i], mine.corner[(i + 1) % mine.n], mine.side[i], tolerance);
  // Slivers stay: a neighbour's side moves against theirs.
  if (out.n < 3 || !(out.area() > on_edge * on_edge * whole))
    out.n = 0;
  return out;
}

// Shape functions are analytic up to where the map folds, 1/distortion half-widths off, and Gauss's rule converges as
// the ellipse through there tells (Trefethen 2008, SIAM Review 50); the polynomials of the undistorted face take three
// points of it. How far the error has to fall from theirs, for 1e-10 to 1e-9 of the area, is measured.
int n_along_side(const FlatFace &own, const FlatFace &other, bool with_gradient)
{
  constexpr double wanted = 3e-7;
  constexpr int most = 12;
  const double distortion = std::max(own.distortion(), other.distortion());
  if (own.triangle() && other.triangle())
    return 2;
  if (distortion == 0)
    return with_gradient ? 4 : 3;
  const double fold = 1 / std::min(distortion, 0.9);
  const double ellipse = fold + std::sqrt(fold * fold - 1);
  return std::min(3 + static_cast<int>(std::ceil(-0.5 * std::log(wanted) / std::log(ellipse))), most);
}
} // namespace amontons
