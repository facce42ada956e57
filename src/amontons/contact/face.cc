#include "amontons/contact/face.h"

#include "amontons/base/error.h"
#include "amontons/surface/quadrilateral.h"

#include <algorithm>

namespace amontons
{
namespace
{
void require_extent(bool has_extent)
{
  if (!has_extent)
    throw NumericalFailure("a target face has collapsed to a line or a point");
}

bool is_plane(const Point<double, 3> &a1, const Point<double, 3> &a2)
{
  return a1.cross(a2).squaredNorm() > 1e-24 * a1.squaredNorm() * a2.squaredNorm();
}

/// The point of the plane through `origin`, spanned by a1 and a2, that is closest to x, in units of a1 and a2.
std::array<double, 2> project_on_plane(const Point<double, 3> &a1, const Point<double, 3> &a2,
                                       const Point<double, 3> &origin, const Point<double, 3> &x)
{
  const double m11 = a1.squaredNorm(), m22 = a2.squaredNorm(), m12 = a1.dot(a2);
  const double determinant = a1.cross(a2).squaredNorm();
  require_extent(is_plane(a1, a2));
  // Twice: the second step takes away the first one's round-off on a slender face.
  std::array<double, 2> xi{0, 0};
  for (int step = 0; step < 2; ++step)
  {
    const Point<double, 3> offset = x - origin - xi[0] * a1 - xi[1] * a2;
    const double r1 = offset.dot(a1), r2 = offset.dot(a2);
    xi = {xi[0] + (m22 * r1 - m12 * r2) / determinant, xi[1] + (m11 * r2 - m12 * r1) / determinant};
  }
  return xi;
}

Projection project_on_quadrilateral(const FaceNodes<double, 3, 4> &nodes, const Point<double, 3> &x,
                                    std::array<double, 2> xi_guess)
{
  const FaceCoordinates face{4, nodes};
  const auto converged = [&](LocalPoint &xi)
  {
    if (!newton_on_quadrilateral(face, x, xi))
      return false;
    const auto base = face_tangents(face, xi);
    require_extent(is_plane(base[0], base[1]));
    return true;
  };
  Projection out;
  out.xi = {std::clamp(xi_guess[0], -0.5, 1.5), std::clamp(xi_guess[1], -0.5, 1.5)};
  if (converged(out.xi))
    return out;
  const ClosestPoint closest = closest_point(face, x);
  out.xi = closest.xi;
  if (converged(out.xi))
    return out;
  out.chart = {true, closest.xi};
  const auto base = face_tangents(face, closest.xi);
  const auto d = project_on_plane(base[0], base[1], closest.point, x);
  out.xi = {closest.xi[0] + d[0], closest.xi[1] + d[1]};
  return out;
}
} // namespace

template<int dim, int n_nodes>
Projection project(const FaceNodes<double, dim, n_nodes> &face, const Point<double, dim> &x,
                   std::array<double, 2> xi_guess)
{
  if constexpr (n_nodes == 4)
    return project_on_quadrilateral(face, x, xi_guess);
  else if constexpr (n_nodes == 3)
    return {{}, project_on_plane(face[1] - face[0], face[2] - face[0], face[0], x)};
  else
  {
    const Point<double, dim> edge = face[1] - face[0];
    require_extent(edge.squaredNorm() > 0);
    return {{}, {(x - face[0]).dot(edge) / edge.squaredNorm(), 0}};
  }
}

template Projection project<2, 2>(const FaceNodes<double, 2, 2> &, const Point<double, 2> &, std::array<double, 2>);
template Projection project<3, 3>(const FaceNodes<double, 3, 3> &, const Point<double, 3> &, std::array<double, 2>);
template Projection project<3, 4>(const FaceNodes<double, 3, 4> &, const Point<double, 3> &, std::array<double, 2>);
} // namespace amontons
