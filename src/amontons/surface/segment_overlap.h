#pragma once
#include "amontons/surface/dual.h"
#include "amontons/surface/quadrature.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

/// The overlap of two segments in the plane, for any scalar type: what is decided is decided by values.
namespace amontons
{
template<class Scalar>
using PlaneVector = Eigen::Matrix<Scalar, 2, 1>;

template<class Scalar>
Scalar cross(const PlaneVector<Scalar> &a, const PlaneVector<Scalar> &b)
{
  return a[0] * b[1] - a[1] * b[0];
}

template<class Scalar>
struct Segment
{
  PlaneVector<Scalar> start, end;
};

/// A segment with normals at its ends that are interpolated between them.
template<class Scalar>
struct NormalField
{
  PlaneVector<Scalar> x, edge, normal, turn;

  NormalField(const Segment<Scalar> &face, const Segment<Scalar> &normals)
    : x(face.start)
    , edge(face.end - face.start)
    , normal(normals.start)
    , turn(normals.end - normals.start)
  {
  }

  /// xi with (x(xi) - y) x n(xi) = 0: of the two roots the one that stays where the normals become parallel. The other
  /// one, where the normals would lie along the segment, may be the nearer for a point far off.
  [[nodiscard]] std::optional<Scalar> project(const PlaneVector<Scalar> &y) const
  {
    using std::sqrt;
    const PlaneVector<Scalar> rest = x - y;
    const Scalar along = cross<Scalar>(edge, normal);
    const Scalar a = cross<Scalar>(edge, turn), b = along + cross<Scalar>(rest, turn), c = cross<Scalar>(rest, normal);
    const Scalar discriminant = b * b - 4. * a * c;
    if (value_of(discriminant) < 0)
      return {};
    const Scalar root = sqrt(discriminant);
    const Scalar denominator = value_of(along) < 0 ? b - root : b + root;
    if (value_of(denominator) == 0)
      return {};
    return -2. * c / denominator;
  }
};

/// A point of the overlap; the weight of integration is a length.
template<class Scalar>
struct SegmentPoint
{
  Scalar xi, eta, weight;
  double gap;
};

/// The ends of an overlap, ascending; where the impactor ends, or within 1e-10 of there, they do not move.
template<class Scalar>
std::optional<std::pair<Scalar, Scalar>> overlap_ends(const NormalField<Scalar> &field, const Segment<Scalar> &target)
{
  constexpr double least = 1e-12, at_end = 1e-10;
  const auto first = field.project(target.start), second = field.project(target.end);
  if (!first || !second)
    return {};
  const bool in_order = value_of(*first) <= value_of(*second);
  const auto clipped = [](const Scalar &xi)
  {
    const double value = std::clamp(value_of(xi), 0.0, 1.0);
    return value <= at_end || value >= 1 - at_end ? Scalar(value) : xi;
  };
  const Scalar from = clipped(in_order ? *first : *second), to = clipped(in_order ? *second : *first);
  if (value_of(to) - value_of(from) < least)
    return {};
  return std::pair(from, to);
}

/// add(SegmentPoint) for each point of a rule that is exact for polynomials of degree 7. @return the overlap's length
template<class Scalar, class Add>
Scalar visit_overlap(const Segment<Scalar> &impactor, const Segment<Scalar> &normals, const Segment<Scalar> &target,
                     Add &&add)
{
  using std::sqrt;
  constexpr int n_points = 4;
  const NormalField<Scalar> field(impactor, normals);
  const auto ends = overlap_ends(field, target);
  if (!ends)
    return 0;
  const Scalar share = ends->second - ends->first, size = share * sqrt(field.edge.dot(field.edge));
  const PlaneVector<Scalar> along = target.end - target.start;
  for (const GaussPoint &point : gauss_rule(n_points))
  {
    const Scalar xi = ends->first + share * point.x;
    const PlaneVector<Scalar> rest = field.x + xi * field.edge - target.start, n = field.normal + xi * field.turn;
    const Scalar eta = cross<Scalar>(rest, n) / cross<Scalar>(along, n);
    const PlaneVector<Scalar> way = eta * along - rest;
    const double gap = value_of(way.dot(n)) / std::sqrt(value_of(n.dot(n)));
    add(SegmentPoint<Scalar>{xi, eta, size * point.weight, gap});
  }
  return size;
}
} // namespace amontons
