#include "amontons/contact/face.h"

#include "amontons/base/error.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
using Quad = FaceNodes<double, 3, 4>;

void require_area(double area_squared, double edge_squared)
{
  if (!(area_squared > 1e-24 * edge_squared * edge_squared))
    throw NumericalFailure("a target face has collapsed to a line or a point");
}

/// Closest point of the face itself: exact minimisation along xi_1 and xi_2 in turn, from the nearest of the centre and
/// the corners. Each line of a bilinear face is straight, so each step is a projection on a segment.
std::array<double, 2> closest_point(const Quad &face, const Point<double, 3> &x)
{
  std::array<double, 2> xi{0.5, 0.5};
  double nearest = (x - combine(shape_functions<4>(Chart{}, xi).value, face)).squaredNorm();
  for (int i = 0; i < 4; ++i)
    if ((x - face[i]).squaredNorm() < nearest)
    {
      nearest = (x - face[i]).squaredNorm();
      xi = {i == 1 || i == 2 ? 1. : 0., i >= 2 ? 1. : 0.};
    }
  for (int sweep = 0; sweep < 200; ++sweep)
  {
    const auto before = xi;
    for (int a = 0; a < 2; ++a)
    {
      const auto shape = shape_functions<4>(Chart{}, xi);
      const Point<double, 3> base = combine(shape.derivative[a], face);
      const Point<double, 3> offset = x - combine(shape.value, face);
      xi[a] = std::clamp(xi[a] + offset.dot(base) / base.squaredNorm(), 0., 1.);
    }
    if (std::abs(xi[0] - before[0]) + std::abs(xi[1] - before[1]) < 1e-12)
      break;
  }
  return xi;
}

/// One Newton step on (x - xbar(xi)).xbar_,a = 0. @return false where the point is no strict minimum
template<int n_nodes>
bool newton_step(const Chart &chart, const FaceNodes<double, 3, n_nodes> &face, const Point<double, 3> &x,
                 std::array<double, 2> &xi, double &step)
{
  const auto shape = shape_functions<n_nodes>(chart, xi);
  const Point<double, 3> a1 = combine(shape.derivative[0], face), a2 = combine(shape.derivative[1], face);
  const Point<double, 3> offset = x - combine(shape.value, face);
  const double m11 = a1.squaredNorm(), m22 = a2.squaredNorm();
  const double m12 = a1.dot(a2) - offset.dot(combine(shape.mixed, face));
  const double determinant = m11 * m22 - m12 * m12;
  require_area(a1.cross(a2).squaredNorm(), std::max(m11, m22));
  if (!(determinant > 1e-6 * m11 * m22))
    return false;
  const double r1 = offset.dot(a1), r2 = offset.dot(a2);
  const std::array<double, 2> d{(m22 * r1 - m12 * r2) / determinant, (m11 * r2 - m12 * r1) / determinant};
  xi = {xi[0] + d[0], xi[1] + d[1]};
  step = std::max(std::abs(d[0]), std::abs(d[1]));
  return true;
}

bool is_near(const std::array<double, 2> &xi)
{
  const auto inside = [](double s) { return s >= -0.5 && s <= 1.5; };
  return inside(xi[0]) && inside(xi[1]);
}

/// Newton from xi on the bilinear extension. @return whether it ended in a minimum near the face
bool newton(const Quad &face, const Point<double, 3> &x, std::array<double, 2> &xi)
{
  double step = 1;
  for (int iteration = 0; iteration < 12 && step > 1e-9; ++iteration)
    if (!newton_step<4>(Chart{}, face, x, xi, step) || !(std::abs(xi[0]) < 4 && std::abs(xi[1]) < 4))
      return false;
  // From 1e-9 the next quadratic step leaves round-off alone.
  return step <= 1e-9 && newton_step<4>(Chart{}, face, x, xi, step) && is_near(xi);
}
} // namespace

template<int dim, int n_nodes>
Projection project(const FaceNodes<double, dim, n_nodes> &face, const Point<double, dim> &x,
                   std::array<double, 2> xi_guess)
{
  Projection out;
  if constexpr (n_nodes == 2)
  {
    const Point<double, dim> edge = face[1] - face[0];
    require_area(edge.squaredNorm(), edge.squaredNorm());
    out.xi[0] = (x - face[0]).dot(edge) / edge.squaredNorm();
  }
  else if constexpr (n_nodes == 3)
  {
    double step = 0;
    if (!newton_step<3>(Chart{}, face, x, out.xi, step) || !newton_step<3>(Chart{}, face, x, out.xi, step))
      throw NumericalFailure("a target triangle has degenerated");
  }
  else
  {
    out.xi = {std::clamp(xi_guess[0], -0.5, 1.5), std::clamp(xi_guess[1], -0.5, 1.5)};
    if (newton(face, x, out.xi))
      return out;
    out.xi = closest_point(face, x);
    const auto nearest = out.xi;
    if (newton(face, x, out.xi))
      return out;
    out.chart = {true, nearest};
    out.xi = nearest;
    double step = 0;
    if (!newton_step<4>(out.chart, face, x, out.xi, step) || !newton_step<4>(out.chart, face, x, out.xi, step))
      throw NumericalFailure("a target quadrilateral has degenerated");
  }
  return out;
}

template Projection project<2, 2>(const FaceNodes<double, 2, 2> &, const Point<double, 2> &, std::array<double, 2>);
template Projection project<3, 3>(const FaceNodes<double, 3, 3> &, const Point<double, 3> &, std::array<double, 2>);
template Projection project<3, 4>(const FaceNodes<double, 3, 4> &, const Point<double, 3> &, std::array<double, 2>);
} // namespace amontons
