#include "amontons/detection/self_contact_exclusions.h"

#include "amontons/base/error.h"
#include "amontons/surface/projection.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <queue>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

// A wall may be stretched or squeezed by this factor before its far side is seen.
constexpr double wall_stretch = 3;
// Depth below which surfaces touch rather than bound a wall, in units of the local edges: beyond the error of chords
// of curved surfaces in contact, below any wall that a mesh resolves.
constexpr double touching = 5e-3;

Vector3d place(const Surface &surface, std::span<const double> x, Index node)
{
  const double *p = x.data() + static_cast<std::ptrdiff_t>(node) * surface.dim;
  return {p[0], p[1], surface.dim == 3 ? p[2] : 0.0};
}

Vector3d centre(const Surface &surface, std::span<const double> x, Index face)
{
  Vector3d sum = Vector3d::Zero();
  for (const Index node : surface.face(face))
    sum += place(surface, x, node);
  return sum / static_cast<double>(surface.face(face).size());
}

// Shortest ways along the surface from one node at a time; its arrays are cleaned of what was touched only.
class Distances
{
public:
  explicit Distances(Index n_nodes)
    : distance_(n_nodes, INFINITY)
  {
  }

  /// @param visit called with each node within `bound` of `start`
  template<typename Length, typename Visit>
  void from(const Surface &surface, Index start, double bound, Length length, Visit visit)
  {
    reach(start, 0);
    while (!queue_.empty())
    {
      const auto [distance, node] = queue_.top();
      queue_.pop();
      if (distance > distance_[node])
        continue;
      visit(node);
      for (const Index f : surface.faces_of_node(node))
        for (const Index other : surface.face(f))
          if (const double to = distance + length(node, other); to <= bound && to < distance_[other])
            reach(other, to);
    }
    for (const Index node : touched_)
      distance_[node] = INFINITY;
    touched_.clear();
  }

private:
  void reach(Index node, double distance)
  {
    distance_[node] = distance;
    touched_.push_back(node);
    queue_.emplace(distance, node);
  }

  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::vector<double> distance_;
  std::vector<Index> touched_;
};
} // namespace

SurfaceNormals surface_normals(const Surface &surface, std::span<const double> x)
{
  SurfaceNormals result;
  result.face.resize(surface.face_ids.size());
  result.node.assign(surface.node_ids.size(), Eigen::Vector3f::Zero());
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    const auto nodes = surface.face(f);
    const LocalPoint middle = nodes.size() == 3 ? LocalPoint{1.0 / 3, 1.0 / 3} : LocalPoint{0.5, 0.5};
    result.face[f] = face_normal(gather_face(surface.dim, nodes, x), middle).cast<float>();
    for (const Index node : nodes)
      result.node[node] += result.face[f];
  }
  for (Eigen::Vector3f &normal : result.node)
    if (normal.squaredNorm() > 0)
      normal.normalize();
  return result;
}

Exclusions::Exclusions(const Surface &surface, std::optional<double> self_distance)
  : surface_(surface)
  , self_distance_(self_distance)
  , x_(surface.reference)
  , size_(surface.node_ids.size(), 0.0)
{
  AMONTONS_ASSERT(surface.node_face_offsets.size() == surface.node_ids.size() + 1);
  if (self_distance && !(*self_distance >= 0 && std::isfinite(*self_distance)))
    throw UserError("the self-distance must be a length, zero or more");
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    const auto nodes = surface.face(f);
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
      const Index a = nodes[k], b = nodes[(k + 1) % nodes.size()];
      const double length = edge_length(a, b);
      for (const Index node : nodes)
        size_[node] = std::max(size_[node], length);
    }
  }
  find_near();
  reference_ = now_ = surface_normals(surface, surface.reference);
}

double Exclusions::edge_length(Index a, Index b) const
{
  return (place(surface_, surface_.reference, a) - place(surface_, surface_.reference, b)).norm();
}

void Exclusions::find_near()
{
  const Index n = surface_.n_nodes();
  Distances distances(n);
  std::vector<Index> faces;
  near_offsets_.assign(1, 0);
  for (Index node = 0; node < n; ++node)
  {
    faces.clear();
    // The least more, so that whole multiples of the edges are in.
    const double bound = (1 + 1e-9) * self_distance(node);
    distances.from(
        surface_, node, bound, [this](Index a, Index b) { return edge_length(a, b); },
        [&](Index reached)
        {
          const auto attached = surface_.faces_of_node(reached);
          faces.insert(faces.end(), attached.begin(), attached.end());
        });
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    near_faces_.insert(near_faces_.end(), faces.begin(), faces.end());
    near_offsets_.push_back(near_faces_.size());
  }
  near_faces_.shrink_to_fit();
}

void Exclusions::move_to(std::span<const double> x)
{
  AMONTONS_ASSERT(x.size() == surface_.reference.size());
  x_ = x;
  now_ = surface_normals(surface_, x);
}

bool Exclusions::is_near(Index node, Index face) const
{
  const auto faces = near(node);
  return std::binary_search(faces.begin(), faces.end(), face);
}

double Exclusions::distance_in_crease(Index node) const
{
  const Vector3d x = place(surface_, x_, node), normal = now_.node[node].cast<double>();
  double least = INFINITY;
  for (const Index f : near(node))
  {
    if (is_turned_away(node, f))
      continue;
    const Vector3d ahead = centre(surface_, x_, f) - x;
    if (ahead.dot(normal) > 0 && ahead.dot(now_.face[f].cast<double>()) < 0)
      least = std::min(least, closest_point(gather_face(surface_.dim, surface_.face(f), x_), x).squared_distance);
  }
  return std::sqrt(least);
}

bool Exclusions::is_own_wall(Index node, Index face) const
{
  if (!surface_.face_bodies.empty() && !surface_.faces_of_node(node).empty() &&
      surface_.face_bodies[surface_.faces_of_node(node).front()] != surface_.face_bodies[face])
    return false;
  const Vector3d now = centre(surface_, x_, face) - place(surface_, x_, node);
  const double depth = now.dot(now_.face[face].cast<double>());
  if (depth <= 0)
    return false;
  const std::span<const double> reference = surface_.reference;
  const Vector3d then = centre(surface_, reference, face) - place(surface_, reference, node);
  const double depth_then = then.dot(reference_.face[face].cast<double>());
  if (depth_then <= touching * size_[node])
    return false;
  return wall_stretch * depth >= depth_then && wall_stretch * wall_stretch * now.squaredNorm() >= then.squaredNorm();
}
} // namespace amontons
