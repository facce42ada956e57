#include "amontons/bulk/surface_extraction.h"

#include "amontons/base/disjoint_sets.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <sstream>
#include <unordered_map>

namespace amontons
{
namespace
{
using FacetKey = std::array<Index, 4>;

struct FacetHash
{
  std::size_t operator()(const FacetKey &key) const
  {
    std::size_t hash = 0;
    for (const Index node : key)
      hash = (hash ^ static_cast<std::size_t>(node)) * 0x9E3779B97F4A7C15u;
    return hash ^ (hash >> 29);
  }
};

FacetKey facet_key(std::span<const Index> nodes)
{
  FacetKey key{-1, -1, -1, -1};
  std::copy(nodes.begin(), nodes.end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

std::vector<Index> facet_nodes(std::span<const Index> cell, const std::array<int, 4> &local)
{
  std::vector<Index> nodes;
  for (const int v : local)
    if (v >= 0)
      nodes.push_back(cell[static_cast<std::size_t>(v)]);
  return nodes;
}

std::string place(const Mesh &mesh, Index node)
{
  std::ostringstream text;
  text << "node " << mesh.node_tags[node] << " at (";
  for (int c = 0; c < mesh.dim; ++c)
    text << (c ? ", " : "") << mesh.points[static_cast<std::size_t>(node) * mesh.dim + c];
  text << ")";
  return text.str();
}

/// Local numbers of the mesh's nodes on the surface, in the order of the mesh.
class SurfaceBuilder
{
public:
  explicit SurfaceBuilder(const Mesh &mesh, const Group &group)
    : mesh_(mesh)
  {
    nodes_ = group.nodes();
    surface_.dim = mesh.dim;
    surface_.node_ids.assign(nodes_.begin(), nodes_.end());
    for (const Index node : nodes_)
      for (int c = 0; c < mesh.dim; ++c)
        surface_.reference.push_back(mesh_.points[static_cast<std::size_t>(node) * mesh.dim + c]);
  }

  void add_face(std::span<const Index> nodes, GlobalIndex id)
  {
    for (const Index node : nodes)
      surface_.face_nodes.push_back(
          static_cast<Index>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin()));
    surface_.face_offsets.push_back(static_cast<Index>(surface_.face_nodes.size()));
    surface_.face_ids.push_back(id);
  }

  Surface finished()
  {
    surface_.build_adjacency();
    return std::move(surface_);
  }

private:
  const Mesh &mesh_;
  std::vector<Index> nodes_;
  Surface surface_;
};
} // namespace

std::span<const std::array<int, 4>> facets_of(CellShape shape)
{
  using Facet = std::array<int, 4>;
  static constexpr std::array<Facet, 3> triangle{{{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 0, -1, -1}}};
  static constexpr std::array<Facet, 4> quadrilateral{{{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 3, -1, -1}, {3, 0, -1, -1}}};
  static constexpr std::array<Facet, 4> tetrahedron{{{0, 2, 1, -1}, {0, 1, 3, -1}, {0, 3, 2, -1}, {1, 2, 3, -1}}};
  static constexpr std::array<Facet, 6> hexahedron{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  switch (shape)
  {
  case CellShape::triangle:
    return triangle;
  case CellShape::quadrilateral:
    return quadrilateral;
  case CellShape::tetrahedron:
    return tetrahedron;
  case CellShape::hexahedron:
    return hexahedron;
  case CellShape::segment:
    break;
  }
  throw InternalError("a segment has no facets");
}

std::vector<FacetOwner> facet_owners(const Mesh &mesh, const Group &group)
{
  AMONTONS_ASSERT(group.dim == mesh.dim - 1);
  std::unordered_map<FacetKey, std::vector<Index>, FacetHash> wanted;
  std::vector<bool> on_group(static_cast<std::size_t>(mesh.n_nodes()));
  for (Index f = 0; f < group.entities.size(); ++f)
  {
    wanted[facet_key(group.entities[f])].push_back(f);
    for (const Index node : group.entities[f])
      on_group[static_cast<std::size_t>(node)] = true;
  }
  std::vector<FacetOwner> owners(static_cast<std::size_t>(group.entities.size()));
  for (Index c = 0; c < mesh.cells.size(); ++c)
  {
    const std::span<const Index> cell = mesh.cells[c];
    const auto n_on_group =
        std::count_if(cell.begin(), cell.end(), [&](Index node) { return on_group[static_cast<std::size_t>(node)]; });
    if (n_on_group < mesh.dim)
      continue;
    const auto facets = facets_of(cell_shape(mesh.dim, cell.size()));
    for (std::size_t local = 0; local < facets.size(); ++local)
      if (const auto found = wanted.find(facet_key(facet_nodes(cell, facets[local]))); found != wanted.end())
        for (const Index f : found->second)
        {
          FacetOwner &owner = owners[static_cast<std::size_t>(f)];
          if (owner.cell < 0)
            owner = {c, -1, static_cast<int>(local)};
          else if (owner.other_cell < 0)
            owner.other_cell = c;
        }
  }
  return owners;
}

Surface extract_surface(const Mesh &mesh, const std::string &name, const SourceLocation &where)
{
  const Group &group = find_group(mesh, name, mesh.dim - 1, where);
  const std::vector<FacetOwner> owners = facet_owners(mesh, group);
  SurfaceBuilder builder(mesh, group);
  std::set<FacetKey> seen;
  for (Index f = 0; f < group.entities.size(); ++f)
  {
    const FacetOwner &owner = owners[static_cast<std::size_t>(f)];
    const std::span<const Index> facet = group.entities[f];
    if (owner.other_cell >= 0)
      throw UserError(where, "the facet of '" + name + "' with " + place(mesh, facet[0]) + " and " +
                                 place(mesh, facet[1]) + " lies between two cells (" +
                                 std::to_string(mesh.cell_tags[owner.cell]) + " and " +
                                 std::to_string(mesh.cell_tags[owner.other_cell]) +
                                 "); a contact surface bounds one body: were two bodies meshed with common nodes?");
    if (!seen.insert(facet_key(facet)).second)
      continue;
    if (owner.cell < 0)
    {
      builder.add_face(facet, f);
      continue;
    }
    const std::span<const Index> cell = mesh.cells[owner.cell];
    const auto facets = facets_of(cell_shape(mesh.dim, cell.size()));
    builder.add_face(facet_nodes(cell, facets[static_cast<std::size_t>(owner.local_facet)]), f);
  }
  return builder.finished();
}

std::vector<Index> bodies_of_faces(const Mesh &mesh, const Surface &surface)
{
  std::vector<Index> parent(static_cast<std::size_t>(mesh.n_nodes()));
  std::iota(parent.begin(), parent.end(), 0);
  for (Index c = 0; c < mesh.cells.size(); ++c)
    for (const Index node : mesh.cells[c])
    {
      const Index a = find_root(parent, mesh.cells[c][0]), b = find_root(parent, node);
      parent[std::max(a, b)] = std::min(a, b);
    }
  std::vector<Index> bodies;
  for (Index f = 0; f < surface.n_faces(); ++f)
    bodies.push_back(find_root(parent, static_cast<Index>(surface.node_ids[surface.face(f)[0]])));
  return bodies;
}

Surface share_of_surface(const Surface &surface, std::span<const Index> nodes, std::span<const Index> faces)
{
  Surface out;
  out.dim = surface.dim;
  std::vector<Index> place(static_cast<std::size_t>(surface.n_nodes()), -1);
  for (const Index node : nodes)
  {
    place[node] = out.n_nodes();
    out.node_ids.push_back(surface.node_ids[node]);
    const auto x = surface.reference.begin() + static_cast<std::ptrdiff_t>(node) * surface.dim;
    out.reference.insert(out.reference.end(), x, x + surface.dim);
  }
  for (const Index f : faces)
  {
    for (const Index node : surface.face(f))
      out.face_nodes.push_back(place[node]);
    out.face_offsets.push_back(static_cast<Index>(out.face_nodes.size()));
    out.face_ids.push_back(surface.face_ids[f]);
    if (!surface.face_bodies.empty())
      out.face_bodies.push_back(surface.face_bodies[f]);
  }
  return out;
}

void check_not_welded(const Mesh &mesh, const Surface &impactor, const Surface &target,
                      const std::string &impactor_name, const std::string &target_name, const SourceLocation &where)
{
  std::vector<GlobalIndex> shared;
  std::vector<GlobalIndex> a = impactor.node_ids, b = target.node_ids;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(shared));
  if (shared.empty())
    return;
  throw UserError(where, "'" + impactor_name + "' and '" + target_name + "' share " + std::to_string(shared.size()) +
                             (shared.size() == 1 ? " node" : " nodes") + " of the mesh, the first " +
                             place(mesh, static_cast<Index>(shared.front())) +
                             ": the bodies are welded there; mesh each body with its own points and curves");
}
} // namespace amontons
