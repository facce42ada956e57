#pragma once
#include "amontons/surface/lanes.h"

namespace amontons::AMONTONS_INSTRUCTION_SET
{
/// The closest point of a face to the origin: the same formulas for one face (Real = double) and for several (Lanes).
template<typename Real>
struct Closest
{
  Real s, t, squared_distance;
};

template<typename Real, int dim>
struct Vec
{
  Real c[dim];
};

template<typename Real, int dim>
AMONTONS_INLINE Vec<Real, dim> operator-(const Vec<Real, dim> &a, const Vec<Real, dim> &b)
{
  Vec<Real, dim> result;
  for (int i = 0; i < dim; ++i)
    result.c[i] = a.c[i] - b.c[i];
  return result;
}
template<typename Real, int dim>
AMONTONS_INLINE Vec<Real, dim> operator+(const Vec<Real, dim> &a, const Vec<Real, dim> &b)
{
  Vec<Real, dim> result;
  for (int i = 0; i < dim; ++i)
    result.c[i] = a.c[i] + b.c[i];
  return result;
}
template<typename Real, int dim>
AMONTONS_INLINE Vec<Real, dim> operator*(const Real &factor, const Vec<Real, dim> &a)
{
  Vec<Real, dim> result;
  for (int i = 0; i < dim; ++i)
    result.c[i] = factor * a.c[i];
  return result;
}
template<typename Real, int dim>
AMONTONS_INLINE Real dot(const Vec<Real, dim> &a, const Vec<Real, dim> &b)
{
  Real result = a.c[0] * b.c[0];
  for (int i = 1; i < dim; ++i)
    result = result + a.c[i] * b.c[i];
  return result;
}

template<typename Real>
AMONTONS_INLINE Real constant(double value)
{
  return value - Real{}; // the same in all lanes
}

/// Point of a face; exactly a node there.
template<int n_nodes, typename Real, int dim>
AMONTONS_INLINE Vec<Real, dim> point_at(const Vec<Real, dim> *x, const Real &s, const Real &t)
{
  if constexpr (n_nodes == 2)
    return (1.0 - s) * x[0] + s * x[1];
  else if constexpr (n_nodes == 3)
    return ((1.0 - s) - t) * x[0] + s * x[1] + t * x[2];
  else
  {
    const Vec<Real, dim> low = (1.0 - s) * x[0] + s * x[1], high = s * x[2] + (1.0 - s) * x[3];
    return (1.0 - t) * low + t * high;
  }
}

/// Parameter in [0, 1] of the point of the segment (a, b) closest to the origin.
template<typename Real, int dim>
AMONTONS_INLINE Real on_segment(const Vec<Real, dim> &a, const Vec<Real, dim> &b)
{
  const Vec<Real, dim> direction = b - a;
  const Real length2 = dot(direction, direction), zero = constant<Real>(0), one = constant<Real>(1);
  const Real s = dot(a, direction) / -(length2 > 0.0 ? length2 : one);
  return length2 > 0.0 ? greatest<Real>(least<Real>(s, one), zero) : zero;
}

template<typename Real, int dim>
AMONTONS_INLINE Closest<Real> closest_on_segment(const Vec<Real, dim> *x)
{
  const Real s = on_segment(x[0], x[1]);
  const Vec<Real, dim> point = point_at<2>(x, s, s);
  return {s, constant<Real>(0), dot(point, point)};
}

template<typename Real>
AMONTONS_INLINE Real triangle_distance2(const Vec<Real, 3> *x, const Real &s, const Real &t)
{
  const Vec<Real, 3> point = point_at<3>(x, s, t);
  return dot(point, point);
}

template<typename Real>
AMONTONS_INLINE Closest<Real> closest_on_triangle(const Vec<Real, 3> *x)
{
  const Vec<Real, 3> a = x[1] - x[0], b = x[2] - x[0];
  const Real aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), ea = -dot(x[0], a), eb = -dot(x[0], b);
  const Real det = aa * bb - ab * ab, zero = constant<Real>(0), one = constant<Real>(1);
  const Real scale = one / (det > 0.0 ? det : one);
  Closest<Real> result;
  result.s = (bb * ea - ab * eb) * scale;
  result.t = (aa * eb - ab * ea) * scale;
  const auto inside = (det > 0.0) & (result.s > 0.0) & (result.t > 0.0) & (result.s + result.t < 1.0);
  if (any(inside ^ (zero == zero)))
  {
    const Real p = on_segment(x[0], x[1]), q = on_segment(x[1], x[2]), r = on_segment(x[2], x[0]);
    Closest<Real> border{p, zero, triangle_distance2(x, p, zero)};
    const Closest<Real> second{1.0 - q, q, triangle_distance2<Real>(x, 1.0 - q, q)};
    const Closest<Real> third{zero, 1.0 - r, triangle_distance2<Real>(x, zero, 1.0 - r)};
    const Closest<Real> others[] = {second, third};
    for (const Closest<Real> &other : others)
    {
      const auto closer = other.squared_distance < border.squared_distance;
      border.s = closer ? other.s : border.s;
      border.t = closer ? other.t : border.t;
      border.squared_distance = closer ? other.squared_distance : border.squared_distance;
    }
    result.s = inside ? result.s : border.s;
    result.t = inside ? result.t : border.t;
  }
  result.squared_distance = triangle_distance2(x, result.s, result.t);
  return result;
}

/// x(s, t) = centre + u p + v q + u v warp with u = s - 1/2, v = t - 1/2; what its squared distance from the origin
/// needs.
template<typename Real>
struct Bilinear
{
  AMONTONS_INLINE explicit Bilinear(const Vec<Real, 3> *x)
  {
    const Real quarter = constant<Real>(0.25), half = constant<Real>(0.5);
    const Vec<Real, 3> centre = quarter * ((x[0] + x[1]) + (x[2] + x[3]));
    const Vec<Real, 3> p = half * ((x[1] + x[2]) - (x[0] + x[3])), q = half * ((x[2] + x[3]) - (x[0] + x[1]));
    const Vec<Real, 3> warp = (x[0] - x[1]) + (x[2] - x[3]);
    pp = dot(p, p), pw = dot(p, warp), qq = dot(q, q), qw = dot(q, warp), ww = dot(warp, warp);
    cp = dot(centre, p), cq = dot(centre, q), mixed = dot(p, q) + dot(centre, warp);
  }

  // Half the gradient is (gs, gt), half the Hessian [aa, m; m, bb].
  AMONTONS_INLINE Real aa(const Real &v) const { return pp + v * (2.0 * pw + v * ww); }
  AMONTONS_INLINE Real bb(const Real &u) const { return qq + u * (2.0 * qw + u * ww); }
  AMONTONS_INLINE Real m(const Real &u, const Real &v) const { return mixed + 2.0 * (u * pw + v * (qw + u * ww)); }
  AMONTONS_INLINE Real gs(const Real &u, const Real &v) const { return (cp + v * (mixed + v * qw)) + u * aa(v); }
  AMONTONS_INLINE Real gt(const Real &u, const Real &v) const { return (cq + u * (mixed + u * pw)) + v * bb(u); }

  /// Whether the squared distance is convex over the face, by bounds of its Hessian over |u|, |v| <= 1/2.
  AMONTONS_INLINE auto is_convex() const
  {
    const Real spread = magnitude(pw) + magnitude(qw);
    const Real least_aa = pp - magnitude(pw), least_bb = qq - magnitude(qw);
    const Real most_m = (magnitude(mixed) + spread) + 0.5 * ww;
    return (least_aa > 0.0) & (least_bb > 0.0) & (least_aa * least_bb > most_m * most_m);
  }

  Real pp, pw, qq, qw, ww, cp, cq, mixed;
};

template<typename Real>
AMONTONS_INLINE Real quadrilateral_distance2(const Vec<Real, 3> *x, const Real &s, const Real &t)
{
  const Vec<Real, 3> point = point_at<4>(x, s, t);
  return dot(point, point);
}

template<typename Real>
AMONTONS_INLINE Closest<Real> closest_on_edges(const Vec<Real, 3> *x)
{
  const Real zero = constant<Real>(0), one = constant<Real>(1);
  Closest<Real> best;
  for (int k = 0; k < 4; ++k)
  {
    const Vec<Real, 3> &from = x[k], &to = x[(k + 1) % 4];
    const Real along = on_segment(from, to), back = 1.0 - along;
    const Vec<Real, 3> point = back * from + along * to;
    const Real squared_distance = dot(point, point);
    const Real s = k == 0 ? along : k == 1 ? one : k == 2 ? back : zero;
    const Real t = k == 0 ? zero : k == 1 ? along : k == 2 ? one : back;
    if (k == 0)
    {
      best = {s, t, squared_distance};
      continue;
    }
    const auto closer = squared_distance < best.squared_distance;
    best.s = closer ? s : best.s;
    best.t = closer ? t : best.t;
    best.squared_distance = closer ? squared_distance : best.squared_distance;
  }
  return best;
}

/// Newton's method from the centre. @return lanes where it converged within the face
template<typename Real>
AMONTONS_INLINE auto newton_within_face(const Bilinear<Real> &quad, Real &u, Real &v)
{
  u = v = constant<Real>(0);
  auto active = u == u, converged = u != u;
  for (int iteration = 0; iteration < 16 && any(active); ++iteration)
  {
    const Real aa = quad.aa(v), bb = quad.bb(u), m = quad.m(u, v), gs = quad.gs(u, v), gt = quad.gt(u, v);
    const Real det = aa * bb - m * m;
    active = active & (det > 0.0);
    const Real scale = 1.0 / (det > 0.0 ? det : constant<Real>(1));
    const Real du = (m * gt - bb * gs) * scale, dv = (m * gs - aa * gt) * scale;
    u = active ? u + du : u;
    v = active ? v + dv : v;
    const auto done = greatest(magnitude(du), magnitude(dv)) < 1e-8; // the step after would be below round-off
    converged = converged | (active & done);
    // Half a face beyond the border it will hardly come back; if it would, the border is found not to be closest.
    active = active & (greatest(magnitude(u), magnitude(v)) < 1.0) & (converged ^ (u == u));
  }
  return converged & (greatest(magnitude(u), magnitude(v)) <= 0.5);
}

/// @param certain where the result is proven to be the closest point: the squared distance is convex over the face, and
///        stationary there or, on the border, growing inwards
template<typename Real, typename Mask>
AMONTONS_INLINE Closest<Real> closest_on_quadrilateral(const Vec<Real, 3> *x, Mask &certain)
{
  const Bilinear<Real> quad(x);
  Real u, v;
  const auto inside = newton_within_face(quad, u, v);
  Closest<Real> result{u + 0.5, v + 0.5, u};
  certain = quad.is_convex();
  const auto outside = inside ^ (u == u);
  if (any(outside))
  {
    const Closest<Real> border = closest_on_edges(x);
    result.s = inside ? result.s : border.s;
    result.t = inside ? result.t : border.t;
    u = border.s - 0.5;
    v = border.t - 0.5;
    const Real gs = quad.gs(u, v), gt = quad.gt(u, v);
    const Real round_off_s = 1e-14 * (quad.pp + magnitude(quad.cp)),
               round_off_t = 1e-14 * (quad.qq + magnitude(quad.cq));
    const auto falls_inwards = ((border.s <= 0.0) & (gs < -round_off_s)) | ((border.s >= 1.0) & (gs > round_off_s)) |
                               ((border.t <= 0.0) & (gt < -round_off_t)) | ((border.t >= 1.0) & (gt > round_off_t));
    certain = certain & (inside | (falls_inwards ^ (u == u)));
  }
  result.squared_distance = quadrilateral_distance2(x, result.s, result.t);
  return result;
}
/// Of the origin over the face at (s, t), along the face's outward unit normal there; 0 on a face of no area.
/// @param point of the face at (s, t)
template<int n_nodes, typename Real, int dim>
AMONTONS_INLINE Real gap_at(const Vec<Real, dim> *x, const Vec<Real, dim> &point, const Real &s, const Real &t)
{
  Real along, squared_length;
  if constexpr (n_nodes == 2)
  {
    const Vec<Real, dim> a = x[1] - x[0];
    along = point.c[1] * a.c[0] - point.c[0] * a.c[1];
    squared_length = dot(a, a);
  }
  else
  {
    Vec<Real, dim> a = x[1] - x[0], b = x[n_nodes - 1] - x[0];
    if constexpr (n_nodes == 4)
    {
      a = (1.0 - t) * a + t * (x[2] - x[3]);
      b = (1.0 - s) * b + s * (x[2] - x[1]);
    }
    const Vec<Real, dim> normal{
        {a.c[1] * b.c[2] - a.c[2] * b.c[1], a.c[2] * b.c[0] - a.c[0] * b.c[2], a.c[0] * b.c[1] - a.c[1] * b.c[0]}};
    along = -dot(point, normal);
    squared_length = dot(normal, normal);
  }
  const Real zero = constant<Real>(0);
  return squared_length > 0.0 ? along / root(squared_length > 0.0 ? squared_length : zero + 1.0) : zero;
}

} // namespace amontons::AMONTONS_INSTRUCTION_SET
