#include "amontons/detection/search_distance.h"

#include "amontons/base/error.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

// Squared. The farthest point from the nodes is the circumcentre, or, where an angle is obtuse, the point of the
// longest edge as far from its end as from the third node. Squares only: this is done for every face in every
// detection.
double triangle_radius2(const Vector3d &x, const Vector3d &y, const Vector3d &z)
{
  double a = (z - y).squaredNorm(), b = (x - z).squaredNorm(), c = (y - x).squaredNorm();
  if (b > a)
    std::swap(a, b);
  if (c > a)
    std::swap(a, c);
  if (!(a > 0))
    return 0;
  if (b + c > a)
    return a * b * c / (4 * a * b - (a + b - c) * (a + b - c)); // 16 area^2 below
  // b / (2 cos)^2, cos^2 = (a + b - c)^2 / (4 a b) for the edge b; the longer of the other two needs more.
  const double longer = std::max(b, c), twice_projection = a + longer - std::min(b, c);
  return longer * longer * a / (twice_projection * twice_projection);
}

// Not less than the covering radius of a segment or quadrilateral, squared; cheap, and for rectangles right: of a
// quadrilateral's four quarters each is within reach of its node, as the farthest point of a bilinear patch is one of
// its corners or nearer.
double radius2_bound(const FaceCoordinates &face)
{
  const auto &x = face.x;
  if (face.n_nodes == 2)
    return 0.25 * (x[1] - x[0]).squaredNorm();
  const Vector3d centre = 0.25 * ((x[0] + x[1]) + (x[2] + x[3]));
  double result = 0;
  for (std::size_t k = 0; k < 4; ++k)
    result = std::max({result, 0.25 * (x[(k + 1) % 4] - x[k]).squaredNorm(), (centre - x[k]).squaredNorm()});
  return result;
}

double quadrilateral_radius(const FaceCoordinates &face)
{
  const auto &x = face.x;
  const double first = std::max(triangle_radius2(x[0], x[1], x[2]), triangle_radius2(x[0], x[2], x[3]));
  const double second = std::max(triangle_radius2(x[0], x[1], x[3]), triangle_radius2(x[1], x[2], x[3]));
  const Vector3d warp = x[0] - x[1] + x[2] - x[3];
  const double bulge = 0.25 * std::abs(warp.dot(face_normal(face, {0.5, 0.5})));
  return std::sqrt(std::min(first, second)) + bulge;
}

[[noreturn]] void refuse(const Target &target, double w, const SearchDistance &least)
{
  const Surface &surface = target.surface();
  std::ostringstream message;
  message << "detection distance " << w << " is too small for the nearest-node method: face "
          << surface.face_ids[least.face] << " of the target (nodes";
  for (const Index node : surface.face(least.face))
    message << ' ' << surface.node_ids[node];
  message.precision(std::numeric_limits<double>::max_digits10);
  message << ") needs at least " << least.w
          << ", so that the balls of that radius about the target's nodes cover it. Give at least that, leave it to be "
             "computed (distance: auto), or use 'method: exact', which takes any distance";
  throw UserError(message.str());
}
} // namespace

double covering_radius(const FaceCoordinates &face)
{
  if (face.n_nodes == 2)
    return 0.5 * (face.x[1] - face.x[0]).norm();
  if (face.n_nodes == 3)
    return std::sqrt(triangle_radius2(face.x[0], face.x[1], face.x[2]));
  return std::min(quadrilateral_radius(face), std::sqrt(radius2_bound(face)));
}

SearchDistance search_distance(const Target &target, const DetectionOptions &options, double reach)
{
  const bool checked = options.method == DetectionMethod::nearest_node;
  if (options.distance && !(*options.distance > 0 && std::isfinite(*options.distance)))
    throw UserError("the detection distance must be a positive length");
  if (options.distance && !checked)
    return {*options.distance, -1};
  SearchDistance least;
  double squared = -1; // of the greatest so far; what does not exceed it needs no root
  for (Index f = 0; f < target.surface().n_faces(); ++f)
  {
    const FaceCoordinates face = target.face(f);
    const auto &x = face.x;
    if ((face.n_nodes == 3 ? triangle_radius2(x[0], x[1], x[2]) : radius2_bound(face)) <= squared)
      continue;
    if (const double radius = covering_radius(face); radius > least.w || least.face < 0)
    {
      least = {radius, f};
      squared = radius * radius;
    }
  }
  if (!options.distance)
    return {1.01 * std::hypot(least.w, reach), least.face};
  if (least.face >= 0 && *options.distance < least.w)
    refuse(target, *options.distance, least);
  return {*options.distance, -1};
}
} // namespace amontons
