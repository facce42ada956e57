#pragma once
#include "amontons/surface/dual.h"
#include "amontons/surface/quadrature.h"

#include <Eigen/Geometry>

#include <array>
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

  [[nodiscard]] PlaneVector<Scalar> normal_at(const Scalar &xi) const { return normal + xi * turn; }

  /// xi with (x(xi) - y) x n(xi) = 0: of the two roots the one for which y lies on this side of where neighbouring
  /// normals cross, which is the one that stays where the normals become parallel.
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

  /// Where on a target, [0, 1] from its start to its end, the normal through xi meets it.
  [[nodiscard]] Scalar meets(const Segment<Scalar> &target, const Scalar &xi) const
  {
    const PlaneVector<Scalar> n = normal_at(xi);
    return cross<Scalar>(x + xi * edge - target.start, n) / cross<Scalar>(target.end - target.start, n);
  }

  /// Whether it meets the target from outside, and before neighbouring normals cross.
  [[nodiscard]] bool sees(const Segment<Scalar> &target, const Scalar &xi) const
  {
    const PlaneVector<Scalar> n = normal_at(xi), along = target.end - target.start;
    const Scalar eta = meets(target, xi);
    if (!(value_of(eta) >= 0 && value_of(eta) <= 1 && value_of(cross<Scalar>(along, n)) > 0))
      return false;
    const PlaneVector<Scalar> way = target.start + eta * along - x - xi * edge;
    const Scalar near = cross<Scalar>(edge, n), there = near + way.dot(n) / n.dot(n) * cross<Scalar>(turn, n);
    return value_of(near) * value_of(there) > 0;
  }
};

/// A point of the overlap; the weight of integration is a length.
template<class Scalar>
struct SegmentPoint
{
  Scalar xi, eta, weight;
  double gap;
};

/// The parts of the impactor that see the target, between the projections of its ends; where the impactor ends, or
/// within 1e-10 of there, the ends of the parts do not move. Shorter than 1e-12 they are none.
template<class Scalar>
struct VisibleParts
{
  VisibleParts(const NormalField<Scalar> &field, const Segment<Scalar> &target)
  {
    add(Scalar(0));
    for (const auto &xi : {field.project(target.start), field.project(target.end)})
      if (xi && value_of(*xi) > 0 && value_of(*xi) < 1)
        add(*xi);
    if (n == 3 && value_of(ends[1]) > value_of(ends[2]))
      std::swap(ends[1], ends[2]);
    add(Scalar(1));
    for (int i = 0; i + 1 < n; ++i)
    {
      const double from = value_of(ends[i]), to = value_of(ends[i + 1]);
      visible[i] = to - from >= 1e-12 && field.sees(target, Scalar(0.5 * (from + to)));
    }
  }

  int n = 0;
  std::array<Scalar, 4> ends;    ///< ascending
  std::array<bool, 3> visible{}; ///< from ends[i] to ends[i + 1]

private:
  void add(const Scalar &xi)
  {
    constexpr double at_end = 1e-10;
    const double value = value_of(xi);
    ends[n++] = value <= at_end || value >= 1 - at_end ? Scalar(value) : xi;
  }
};

/// add(SegmentPoint) for each point of a rule that is exact for polynomials of degree 7. @return the overlap's length
template<class Scalar, class Add>
Scalar visit_overlap(const Segment<Scalar> &impactor, const Segment<Scalar> &normals, const Segment<Scalar> &target,
                     Add &&add)
{
  using std::sqrt;
  constexpr int n_points = 4;
  const NormalField<Scalar> field(impactor, normals);
  const VisibleParts<Scalar> parts(field, target);
  const PlaneVector<Scalar> along = target.end - target.start;
  Scalar whole = 0;
  for (int i = 0; i + 1 < parts.n; ++i)
  {
    if (!parts.visible[i])
      continue;
    const Scalar share = parts.ends[i + 1] - parts.ends[i], size = share * sqrt(field.edge.dot(field.edge));
    whole += size;
    for (const GaussPoint &point : gauss_rule(n_points))
    {
      const Scalar xi = parts.ends[i] + share * point.x, eta = field.meets(target, xi);
      const PlaneVector<Scalar> n = field.normal_at(xi);
      const PlaneVector<Scalar> way = target.start + eta * along - field.x - xi * field.edge;
      const double gap = value_of(way.dot(n)) / std::sqrt(value_of(n.dot(n)));
      add(SegmentPoint<Scalar>{xi, eta, size * point.weight, gap});
    }
  }
  return whole;
}
} // namespace amontons
