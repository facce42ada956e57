#include "amontons/detection/normal_cones.h"

#include "amontons/detection/box_tree.h"
#include "amontons/detection/closest_feature.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace amontons
{
namespace
{
// Cones wider than this say nothing: a sharp fold has minima in directions that its faces' normals do not hold.
constexpr float widest = 1.0F;
constexpr float everything = 4.0F; // more than pi
constexpr float round_off = 1e-3F;

// Not less than the angle between two unit vectors, from their chord c: 2 asin(c/2) <= c + c^3/20 up to c = 1.
float angle_bound(const Eigen::Vector3f &a, const Eigen::Vector3f &b)
{
  const float chord2 = (a - b).squaredNorm();
  return chord2 < 1 ? std::sqrt(chord2) * (1 + 0.05F * chord2) : everything;
}

// Not less than the arcsine.
float arcsine_bound(float sine)
{
  return sine < 0.5F ? 1.05F * sine : 1.58F;
}
} // namespace

NormalCones::Cone NormalCones::around(std::span<const Cone> parts)
{
  Cone cone;
  for (const Cone &part : parts)
  {
    cone.centre += part.centre / static_cast<float>(parts.size());
    cone.axis += part.axis;
  }
  cone.axis.normalize();
  for (const Cone &part : parts)
  {
    cone.radius = std::max(cone.radius, (1 + 1e-5F) * ((part.centre - cone.centre).norm() + part.radius));
    cone.half_angle = std::max(cone.half_angle, angle_bound(cone.axis, part.axis) + part.half_angle);
    cone.face_radius = std::max(cone.face_radius, part.face_radius);
    cone.is_at_end = cone.is_at_end || part.is_at_end;
  }
  if (!(cone.half_angle < widest) || cone.axis.squaredNorm() < 0.5F)
    cone.half_angle = everything;
  return cone;
}

// Of the normals at the corners of each face.
std::vector<NormalCones::Cone> NormalCones::cones_of_faces(const Target &target)
{
  std::vector<Cone> result(target.surface().face_ids.size());
  for (Index f = 0; f < target.surface().n_faces(); ++f)
  {
    const FaceCoordinates face = target.face(f);
    static constexpr std::array<LocalPoint, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const std::size_t n_normals = face.n_nodes == 4 ? 4 : 1;
    std::array<Cone, 4> parts;
    for (std::size_t k = 0; k < n_normals; ++k)
      parts[k] = {{0, 0, 0}, 0, face_normal(face, corners[k]).cast<float>(), round_off};
    result[f] = n_normals == 1 ? parts[0] : around(parts);
  }
  return result;
}

// Of all faces attached to each node.
std::vector<NormalCones::Cone> NormalCones::cones_of_nodes(const Target &target) const
{
  const Surface &surface = target.surface();
  const std::vector<Cone> faces = cones_of_faces(target);
  std::vector<Cone> result(surface.node_ids.size());
  std::vector<Cone> parts;
  for (Index node = 0; node < surface.n_nodes(); ++node)
  {
    parts.clear();
    for (const Index f : surface.faces_of_node(node))
      parts.push_back(faces[f]);
    if (!parts.empty())
      result[node] = around(parts);
    result[node].is_at_end = is_end_[node] != 0;
  }
  return result;
}

void NormalCones::find_ends(const Target &target)
{
  const Surface &surface = target.surface();
  if (is_end_.size() == surface.node_ids.size())
    return;
  is_end_.assign(surface.node_ids.size(), 0);
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    const auto nodes = surface.face(f);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (target.neighbour(f, static_cast<int>(k)) < 0)
        is_end_[nodes[k]] = is_end_[nodes[surface.dim == 2 ? k : (k + 1) % nodes.size()]] = 1;
  }
}

void NormalCones::build(const Target &target, const std::vector<Index> &order)
{
  constexpr std::size_t width = BoxTree<3>::width;
  find_ends(target);
  const std::vector<Cone> nodes = cones_of_nodes(target);
  levels_.assign(1, std::vector<Cone>(order.size()));
  if (!order.empty())
    origin_ = target.face(order[0]).x[0];
  for (std::size_t slot = 0; slot < order.size(); ++slot)
  {
    const FaceCoordinates face = target.face(order[slot]);
    const auto own = target.surface().face(order[slot]);
    std::array<Cone, 4> corners;
    for (int k = 0; k < face.n_nodes; ++k)
    {
      corners[k] = nodes[own[k]];
      corners[k].centre = (face.x[k] - origin_).cast<float>();
    }
    Cone &cone = levels_[0][slot] = around({corners.data(), static_cast<std::size_t>(face.n_nodes)});
    cone.face_radius = cone.radius;
  }
  while (levels_.back().size() > 1 || levels_.size() == 1)
  {
    const std::vector<Cone> &below = levels_.back();
    std::vector<Cone> level((below.size() + width - 1) / width);
    for (std::size_t i = 0; i < level.size(); ++i)
      level[i] = around(std::span(below).subspan(i * width, std::min(width, below.size() - i * width)));
    levels_.push_back(std::move(level));
  }
}

bool NormalCones::may_hold_minimum(int level, std::size_t index, const Eigen::Vector3d &x,
                                   std::optional<double> extension, bool ends_anywhere) const
{
  const Cone &cone = levels_[level + 1][index];
  if (cone.half_angle > widest)
    return true;
  const Eigen::Vector3f offset = (x - origin_).cast<float>() - cone.centre;
  const float distance = offset.norm();
  const float least = distance - cone.radius - 1e-6F * (cone.centre.norm() + distance);
  // A face's extent is at most twice its radius.
  constexpr auto fraction = static_cast<float>(1.01 * 2 * default_extension);
  const float past_end = !cone.is_at_end && !ends_anywhere ? 0.0F
                         : extension                       ? static_cast<float>(*extension)
                                                           : fraction * cone.face_radius;
  if (least <= past_end || least <= 0)
    return true;
  // Mostly the direction is far off, and its sine, which is less than it, tells.
  const float allowed = cone.half_angle + arcsine_bound(cone.radius / distance) + arcsine_bound(past_end / least);
  const float across = offset.cross(cone.axis).norm();
  if (across > (allowed + round_off) * distance)
    return false;
  const float angle = std::atan2(across, offset.dot(cone.axis));
  const float from_axis = std::min(angle, std::numbers::pi_v<float> - angle);
  return from_axis <= cone.half_angle + std::asin(cone.radius / distance) + std::asin(past_end / least) + round_off;
}
} // namespace amontons
