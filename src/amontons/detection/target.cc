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
  , neighbours_(surface.face_nodes.size(), -1)
{
  AMONTONS_ASSERT(surface.node_face_offsets.size() == surface.node_ids.size() + 1);
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    const auto nodes = surface.face(f);
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
      const Index next = nodes[(k + 1) % nodes.size()];
      for (const Index other : surface.faces_of_node(nodes[k]))
        if (other != f && (surface.dim == 2 || contains(surface.face(other), next)))
        {
          neighbours_[surface.face_offsets[f] + static_cast<Index>(k)] = other;
          break;
        }
    }
  }
}
} // namespace amontons
