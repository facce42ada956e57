#include "amontons/bulk/mesh.h"

#include "amontons/base/suggestion.h"

#include <algorithm>
#include <numeric>

namespace amontons
{
namespace
{
std::vector<std::string> group_names(const Mesh &mesh, int dim)
{
  std::vector<std::string> names;
  for (const auto &[name, group] : mesh.groups)
    if (dim < 0 || group.dim == dim)
      names.push_back(name);
  return names;
}

std::string listed(const Mesh &mesh, int dim)
{
  const std::vector<std::string> names = group_names(mesh, dim);
  const std::string what = dim < 0 ? "groups" : "groups of " + dimension_word(dim);
  return names.empty() ? "; the mesh has no " + what : "; " + what + ": " + joined(names);
}
} // namespace

CellShape cell_shape(int dim, std::size_t n_nodes)
{
  if (dim == 1 && n_nodes == 2)
    return CellShape::segment;
  if (dim == 2 && n_nodes == 3)
    return CellShape::triangle;
  if (dim == 2 && n_nodes == 4)
    return CellShape::quadrilateral;
  if (dim == 3 && n_nodes == 4)
    return CellShape::tetrahedron;
  if (dim == 3 && n_nodes == 8)
    return CellShape::hexahedron;
  throw InternalError("no cell shape of dimension " + std::to_string(dim) + " with " + std::to_string(n_nodes) +
                      " nodes");
}

std::string dimension_word(int dim)
{
  static const std::vector<std::string> words{"points", "curves", "surfaces", "volumes"};
  return words.at(static_cast<std::size_t>(dim));
}

std::vector<Index> Group::nodes() const
{
  std::vector<Index> out = entities.nodes;
  out.insert(out.end(), other_nodes.begin(), other_nodes.end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

void number_whole(Mesh &mesh)
{
  mesh.n_global_nodes = mesh.n_nodes();
  mesh.n_global_cells = mesh.cells.size();
  mesh.node_ids.resize(static_cast<std::size_t>(mesh.n_global_nodes));
  mesh.cell_ids.resize(static_cast<std::size_t>(mesh.n_global_cells));
  std::iota(mesh.node_ids.begin(), mesh.node_ids.end(), 0);
  std::iota(mesh.cell_ids.begin(), mesh.cell_ids.end(), 0);
}

const Group &find_group(const Mesh &mesh, const std::string &name, int dim, const SourceLocation &where)
{
  const auto found = mesh.groups.find(name);
  if (found == mesh.groups.end())
    throw UserError(where, "no physical group '" + name + "' in the mesh" + did_you_mean(name, group_names(mesh, dim)) +
                               listed(mesh, dim));
  if (dim >= 0 && found->second.dim != dim)
    throw UserError(where, "the physical group '" + name + "' is one of " + dimension_word(found->second.dim) +
                               "; one of " + dimension_word(dim) + " is wanted here" + listed(mesh, dim));
  return found->second;
}
} // namespace amontons
