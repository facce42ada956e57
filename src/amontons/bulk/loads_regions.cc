#include "amontons/bulk/loads_regions.h"

#include "amontons/base/suggestion.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace amontons
{
namespace
{
/// Adds an entity to the block of its shape and subdomain.
void append(std::vector<EntityBlock> &blocks, CellShape shape, Index subdomain, std::span<const Index> nodes)
{
  auto block = std::find_if(blocks.begin(), blocks.end(),
                            [&](const EntityBlock &b) { return b.shape == shape && b.subdomain == subdomain; });
  if (block == blocks.end())
    block = blocks.insert(block, {shape, subdomain, {}});
  block->nodes.insert(block->nodes.end(), nodes.begin(), nodes.end());
}

Eigen::Vector3d position(const Mesh &mesh, Index node)
{
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int d = 0; d < mesh.dim; ++d)
    x[d] = mesh.points[static_cast<std::size_t>(node) * mesh.dim + d];
  return x;
}

Eigen::Vector3d centre(const Mesh &mesh, std::span<const Index> nodes)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Index node : nodes)
    sum += position(mesh, node);
  return sum / static_cast<double>(nodes.size());
}
} // namespace

LoadRegions::LoadRegions(const Mesh &mesh, const std::vector<BodyOptions> &bodies,
                         std::span<const Index> deformable_body_of_cell, std::span<const Index> subdomain_of_cell)
  : mesh_(mesh)
  , bodies_(bodies)
  , body_of_cell_(deformable_body_of_cell)
  , subdomain_of_cell_(subdomain_of_cell)
{
}

const BodyOptions *LoadRegions::find_body(const std::string &name) const
{
  const auto found = std::find_if(bodies_.begin(), bodies_.end(), [&](const auto &body) { return body.name == name; });
  return found == bodies_.end() ? nullptr : &*found;
}

bool LoadRegions::is_rigid(const BoundaryOptions &entry) const
{
  return std::any_of(bodies_.begin(), bodies_.end(),
                     [&](const BodyOptions &body)
                     {
                       return body.material.law == MaterialLaw::rigid &&
                              (body.name == entry.region || (!body.region.empty() && body.region == entry.region));
                     });
}

std::string LoadRegions::describe(std::span<const Index> nodes) const
{
  std::string text;
  for (const Index node : nodes)
    text += (text.empty() ? "" : ", ") + std::to_string(mesh_.node_tags[node]);
  return text;
}

std::vector<std::vector<Index>> LoadRegions::deformable_cells_of(const Group &group) const
{
  std::vector<bool> wanted(static_cast<std::size_t>(mesh_.n_nodes()), false);
  for (const Index node : group.entities.nodes)
    wanted[node] = true;
  std::vector<std::vector<Index>> cells(static_cast<std::size_t>(mesh_.n_nodes()));
  for (Index c = 0; c < mesh_.cells.size(); ++c)
    if (body_of_cell_[c] >= 0)
      for (const Index node : mesh_.cells[c])
        if (wanted[node])
          cells[node].push_back(c);
  return cells;
}

std::vector<Index> LoadRegions::owners(std::span<const Index> facet,
                                       const std::vector<std::vector<Index>> &cells_of_node) const
{
  std::vector<Index> found;
  for (const Index c : cells_of_node[facet[0]])
  {
    const auto nodes = mesh_.cells[c];
    if (std::all_of(facet.begin(), facet.end(),
                    [&](Index node) { return std::find(nodes.begin(), nodes.end(), node) != nodes.end(); }))
      found.push_back(c);
  }
  return found;
}

bool LoadRegions::faces_outwards(std::span<const Index> facet, Index cell) const
{
  const auto x = [&](std::size_t i) { return position(mesh_, facet[i]); };
  Eigen::Vector3d normal;
  if (facet.size() == 2)
    normal = (x(1) - x(0)).cross(Eigen::Vector3d::UnitZ());
  else if (facet.size() == 3)
    normal = (x(1) - x(0)).cross(x(2) - x(0));
  else
    normal = (x(2) - x(0)).cross(x(3) - x(1));
  return normal.dot(centre(mesh_, facet) - centre(mesh_, mesh_.cells[cell])) > 0;
}

std::vector<EntityBlock> LoadRegions::facets(const BoundaryOptions &entry, bool one_sided) const
{
  if (find_body(entry.region) && !mesh_.groups.contains(entry.region))
    throw UserError(entry.where, "traction, pressure and spring act on facets, but '" + entry.region +
                                     "' is a body: name a physical group of its " +
                                     (mesh_.dim == 2 ? "boundary curves" : "boundary surfaces"));
  const Group &group = find_group(mesh_, entry.region, mesh_.dim - 1, entry.where);
  const auto cells_of_node = deformable_cells_of(group);
  std::vector<EntityBlock> blocks;
  for (Index f = 0; f < group.entities.size(); ++f)
  {
    const auto nodes = group.entities[f];
    const std::vector<Index> cells = owners(nodes, cells_of_node);
    const std::string name = "the facet with nodes " + describe(nodes) + " of '" + entry.region + "'";
    if (cells.empty())
      throw UserError(entry.where, name + " bounds no cell of a deformable body: a load has nothing to act on");
    if (one_sided && cells.size() > 1)
      throw UserError(entry.where, name + " lies between two cells: a pressure has no side to act on");
    std::vector<Index> turned(nodes.begin(), nodes.end());
    if (one_sided && !faces_outwards(nodes, cells[0]))
      std::reverse(turned.begin(), turned.end());
    append(blocks, cell_shape(mesh_.dim - 1, nodes.size()), subdomain(cells[0]), turned);
  }
  return blocks;
}

std::vector<EntityBlock> LoadRegions::cells(const BoundaryOptions &entry) const
{
  const BodyOptions *body = find_body(entry.region);
  if (!body && !mesh_.groups.contains(entry.region))
  {
    std::vector<std::string> names;
    for (const BodyOptions &candidate : bodies_)
      names.push_back(candidate.name);
    throw UserError(entry.where, "'" + entry.region + "' is neither a body nor a physical group of cells" +
                                     did_you_mean(entry.region, names));
  }
  const Group &group = body ? find_group(mesh_, body->region, mesh_.dim, body->where)
                            : find_group(mesh_, entry.region, mesh_.dim, entry.where);
  std::vector<EntityBlock> blocks;
  for (const Index c : group.cells)
    if (body_of_cell_[c] >= 0)
      append(blocks, cell_shape(mesh_.dim, mesh_.cells[c].size()), subdomain(c), mesh_.cells[c]);
  return blocks;
}

std::vector<Index> LoadRegions::points(const BoundaryOptions &entry) const
{
  if (find_body(entry.region) && !mesh_.groups.contains(entry.region))
    throw UserError(entry.where, "force acts on rigid bodies and on groups of points, but '" + entry.region +
                                     "' is a deformable body: use traction on its boundary, or body_force");
  const Group &group = find_group(mesh_, entry.region, 0, entry.where);
  const auto cells_of_node = deformable_cells_of(group);
  std::vector<Index> nodes = group.entities.nodes; // those of other processes bear their forces there
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const Index node : nodes)
    if (cells_of_node[node].empty())
      throw UserError(entry.where, "the point " + std::to_string(mesh_.node_tags[node]) + " of '" + entry.region +
                                       "' belongs to no cell of a deformable body: a force has nothing to act on");
  return nodes;
}
} // namespace amontons
