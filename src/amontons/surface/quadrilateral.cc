#include "amontons/surface/quadrilateral.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

// x(xi) = centre + u p + v q + u v warp, with u = xi1 - 1/2, v = xi2 - 1/2.
struct Bilinear
{
  explicit Bilinear(const FaceCoordinates &face)
    : centre(0.25 * (face.x[0] + face.x[1] + face.x[2] + face.x[3]))
    , p(0.5 * (face.x[1] + face.x[2] - face.x[0] - face.x[3]))
    , q(0.5 * (face.x[2] + face.x[3] - face.x[0] - face.x[1]))
    , warp(face.x[0] - face.x[1] + face.x[2] - face.x[3])
  {
  }
  Vector3d centre, p, q, warp;
};

ClosestPoint at(const FaceCoordinates &face, LocalPoint xi, const Vector3d &x)
{
  ClosestPoint result{xi, face_point(face, xi), 0};
  result.squared_distance = (x - result.point).squaredNorm();
  return result;
}

ClosestPoint closest_on_border(const FaceCoordinates &face, const Vector3d &x)
{
  ClosestPoint best;
  best.squared_distance = INFINITY;
  for (std::size_t k = 0; k < 4; ++k)
  {
    const Vector3d &a = face.x[k];
    const Vector3d direction = face.x[(k + 1) % 4] - a;
    const double length2 = direction.squaredNorm();
    const double s = length2 > 0 ? std::clamp((x - a).dot(direction) / length2, 0.0, 1.0) : 0.0;
    const std::array<LocalPoint, 4> xi{{{s, 0}, {1, s}, {1 - s, 1}, {0, 1 - s}}};
    if (const ClosestPoint candidate = at(face, xi[k], x); candidate.squared_distance < best.squared_distance)
      best = candidate;
  }
  return best;
}

template<std::size_t degree>
using Polynomial = std::array<double, degree + 1>; // coefficients of 1, s, s^2, ...

template<std::size_t m, std::size_t n>
Polynomial<m + n> product(const Polynomial<m> &a, const Polynomial<n> &b)
{
  Polynomial<m + n> result{};
  for (std::size_t i = 0; i <= m; ++i)
    for (std::size_t j = 0; j <= n; ++j)
      result[i + j] += a[i] * b[j];
  return result;
}

template<std::size_t degree>
double value(const Polynomial<degree> &a, double s)
{
  double result = a[degree];
  for (std::size_t i = degree; i-- > 0;)
    result = result * s + a[i];
  return result;
}

template<std::size_t degree>
double bisect(const Polynomial<degree> &a, double low, double high)
{
  const bool rising = value<degree>(a, low) < 0;
  for (int i = 0; i < 60 && low < high; ++i)
  {
    const double middle = 0.5 * (low + high);
    ((value<degree>(a, middle) < 0) == rising ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

struct Roots
{
  std::array<double, 8> s{};
  int n = 0;
};

// Roots in [0, 1] at which the sign changes: between the derivative's roots the polynomial is monotone. A double root
// is not found; it is no minimum of the distance either.
template<std::size_t degree>
Roots roots_in_unit_interval(const Polynomial<degree> &a)
{
  Roots result;
  if constexpr (degree >= 1)
  {
    Polynomial<degree - 1> derivative{};
    for (std::size_t i = 1; i <= degree; ++i)
      derivative[i - 1] = static_cast<double>(i) * a[i];
    const Roots turns = roots_in_unit_interval<degree - 1>(derivative);
    double low = 0;
    for (int i = 0; i <= turns.n; ++i)
    {
      const double high = i < turns.n ? turns.s[i] : 1.0;
      if ((value<degree>(a, low) < 0) != (value<degree>(a, high) < 0))
        result.s[result.n++] = bisect<degree>(a, low, high);
      low = high;
    }
  }
  return result;
}

// The quintic in s = xi1: [ (e.e stationary in t) substituted into (e.e stationary in s) ].
// With e(s) = x - x(s, 0) and d(s) = dx/dt, both linear in s: t = e.d / d.d, and
// (d.d e - e.d d) . (d.d a + e.d warp) = 0, a = dx/ds at t = 0.
Polynomial<5> stationary_quintic(const FaceCoordinates &face, const Vector3d &x)
{
  const Vector3d e0 = x - face.x[0], e1 = face.x[0] - face.x[1];
  const Vector3d d0 = face.x[3] - face.x[0], d1 = face.x[0] - face.x[1] + face.x[2] - face.x[3];
  const Polynomial<2> dd{d0.dot(d0), 2 * d0.dot(d1), d1.dot(d1)};
  const Polynomial<2> ed{e0.dot(d0), e0.dot(d1) + e1.dot(d0), e1.dot(d1)};
  Polynomial<5> result{};
  for (int c = 0; c < 3; ++c)
  {
    const Polynomial<1> e{e0[c], e1[c]}, d{d0[c], d1[c]};
    const auto dde = product<2, 1>(dd, e), edd = product<2, 1>(ed, d);
    Polynomial<3> normal_part{};
    for (std::size_t i = 0; i < 4; ++i)
      normal_part[i] = dde[i] - edd[i];
    Polynomial<2> tangent{};
    for (std::size_t i = 0; i < 3; ++i)
      tangent[i] = -e1[c] * dd[i] + d1[c] * ed[i];
    const auto term = product<3, 2>(normal_part, tangent);
    for (std::size_t i = 0; i < 6; ++i)
      result[i] += term[i];
  }
  return result;
}

// Best xi2 for a given xi1.
LocalPoint on_ruling(const FaceCoordinates &face, double s, const Vector3d &x)
{
  const Vector3d foot = (1 - s) * face.x[0] + s * face.x[1];
  const Vector3d d = (1 - s) * face.x[3] + s * face.x[2] - foot;
  const double length2 = d.squaredNorm();
  return {s, length2 > 0 ? std::clamp((x - foot).dot(d) / length2, 0.0, 1.0) : 0.0};
}
} // namespace

bool newton_on_quadrilateral(const FaceCoordinates &face, const Vector3d &x, LocalPoint &xi)
{
  const Bilinear quad(face);
  for (int iteration = 0; iteration < 25; ++iteration)
  {
    const double u = xi[0] - 0.5, v = xi[1] - 0.5;
    const Vector3d a = quad.p + v * quad.warp, b = quad.q + u * quad.warp;
    const Vector3d e = x - quad.centre - u * quad.p - v * b;
    const double aa = a.dot(a), bb = b.dot(b), ea = e.dot(a), eb = e.dot(b), ab = a.dot(b);
    double m = ab - e.dot(quad.warp);
    const bool positive = aa * bb > m * m;
    if (!positive)
      m = ab; // Gauss-Newton's Hessian, never indefinite
    const double det = aa * bb - m * m;
    if (!(det > 0))
      return false;
    const double du = (bb * ea - m * eb) / det, dv = (aa * eb - m * ea) / det;
    const double scale = std::min(1.0, 1.0 / std::max(std::abs(du), std::abs(dv)));
    xi[0] += scale * du;
    xi[1] += scale * dv;
    if (std::max(std::abs(xi[0] - 0.5), std::abs(xi[1] - 0.5)) > 1.5)
      return false;
    if (std::max(std::abs(du), std::abs(dv)) < 1e-8) // the step after would be below round-off
      return positive;
  }
  return false;
}

ClosestPoint closest_point_by_quintic(const FaceCoordinates &face, const Vector3d &x)
{
  ClosestPoint best = closest_on_border(face, x);
  const Roots roots = roots_in_unit_interval<5>(stationary_quintic(face, x));
  for (int i = 0; i < roots.n; ++i)
    if (const ClosestPoint candidate = at(face, on_ruling(face, roots.s[i], x), x);
        candidate.squared_distance < best.squared_distance)
      best = candidate;
  // The polynomial's roots carry its round-off: a last Newton step or two takes it away.
  LocalPoint xi = best.xi;
  if (feature_at(4, xi, 0).type == FaceFeature::interior && newton_on_quadrilateral(face, x, xi) && in_face(4, xi, 0))
    if (const ClosestPoint polished = at(face, xi, x); polished.squared_distance <= best.squared_distance)
      best = polished;
  return best;
}
} // namespace amontons
