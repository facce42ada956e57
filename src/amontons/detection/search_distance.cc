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

// The farthest point from the nodes is the circumcentre, or, where the angle at `a` is obtuse, a point of the opposite
// edge as far from b (or c) as from a.
double triangle_radius(const Vector3d &a, const Vector3d &b, const Vector3d &c)
{
  std::array<double, 3> opposite{(c - b).norm(), (a - c).norm(), (b - a).norm()};
  const auto k = static_cast<std::size_t>(std::max_element(opposite.begin(), opposite.end()) - opposite.begin());
  const double longest = opposite[k], left = opposite[(k + 1) % 3], right = opposite[(k + 2) % 3];
  if (!(longest > 0))
    return 0;
  const double two_areas = (b - a).cross(c - a).norm();
  if (left * left + right * right > longest * longest)
    return longest * left * right / (2 * two_areas);
  // cos of the angle between the longest edge and each of the others
  const double cos_left = (longest * longest + left * left - right * right) / (2 * longest * left);
  const double cos_right = (longest * longest + right * right - left * left) / (2 * longest * right);
  return std::max(left > 0 ? left / (2 * cos_left) : 0.0, right > 0 ? right / (2 * cos_right) : 0.0);
}

double quadrilateral_radius(const FaceCoordinates &face)
{
  const auto &x = face.x;
  const double first = std::max(triangle_radius(x[0], x[1], x[2]), triangle_radius(x[0], x[2], x[3]));
  const double second = std::max(triangle_radius(x[0], x[1], x[3]), triangle_radius(x[1], x[2], x[3]));
  const Vector3d warp = x[0] - x[1] + x[2] - x[3];
  const double bulge = 0.25 * std::abs(warp.dot(face_normal(face, {0.5, 0.5})));
  return std::min(first, second) + bulge;
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
    return triangle_radius(face.x[0], face.x[1], face.x[2]);
  return quadrilateral_radius(face);
}

SearchDistance search_distance(const Target &target, const DetectionOptions &options, double reach)
{
  const bool checked = options.method == DetectionMethod::nearest_node;
  if (options.distance && !(*options.distance > 0 && std::isfinite(*options.distance)))
    throw UserError("the detection distance must be a positive length");
  if (options.distance && !checked)
    return {*options.distance, -1};
  SearchDistance least;
  for (Index f = 0; f < target.surface().n_faces(); ++f)
    if (const double radius = covering_radius(target.face(f)); radius > least.w || least.face < 0)
      least = {radius, f};
  if (!options.distance)
    return {1.01 * std::hypot(least.w, reach), least.face};
  if (least.face >= 0 && *options.distance < least.w)
    refuse(target, *options.distance, least);
  return {*options.distance, -1};
}
} // namespace amontons
