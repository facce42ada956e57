#include "amontons/detection/target.h"

#include "amontons/base/error.h"

#include <algorithm>

namespace amontons
{
namespace
{
bool contains(std::span<const Index> nodes, Index node)
{
  return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
}
} // namespace

Target::Target(const Surface &surface)
  : surface_(&surface)
{
  AMONTONS_ASSERT(surface.node_face_offsets.size() == surface.node_ids.size() + 1);
  const std::size_t n_faces = surface.face_ids.size();
  for (const int n : {2, 3, 4}) // a face in space has three or four
    if ((surface.dim == 2) == (n == 2) && surface.face_nodes.size() == n * n_faces)
      n_nodes_of_all_ = n;
}

Index Target::neighbour(Index f, int k) const
{
  const auto nodes = surface_->face(f);
  const Index next = nodes[(k + 1) % nodes.size()];
  for (const Index other : surface_->faces_of_node(nodes[k]))
    if (other != f && (surface_->dim == 2 || contains(surface_->face(other), next)))
      return other;
  return -1;
}
} // namespace amontons
