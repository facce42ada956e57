#include "amontons/bulk/mesh_distribution.h"

#include "amontons/bulk/surface_extraction.h"
#include "amontons/parallel/archive.h"

#include <algorithm>
#include <map>

namespace amontons
{
namespace
{
template<class Archive>
void show(Archive &message, Connectivity &entities)
{
  message.array(entities.offsets);
  message.array(entities.nodes);
}

/// All but the adjacency, which follows from it.
template<class Archive>
void show(Archive &message, Surface &surface)
{
  message.value(surface.dim);
  message.array(surface.node_ids);
  message.array(surface.reference);
  message.array(surface.face_offsets);
  message.array(surface.face_nodes);
  message.array(surface.face_ids);
  message.array(surface.face_bodies);
}

template<class Archive>
void show(Archive &message, Group &group)
{
  message.value(group.dim);
  show(message, group.entities);
  message.array(group.cells);
  message.array(group.other_nodes);
}

template<class Archive>
void show(Archive &message, Mesh &mesh)
{
  message.value(mesh.dim);
  message.value(mesh.n_global_nodes);
  message.value(mesh.n_global_cells);
  message.text(mesh.file);
  message.array(mesh.points);
  message.array(mesh.node_tags);
  message.array(mesh.node_ids);
  show(message, mesh.cells);
  message.array(mesh.cell_tags);
  message.array(mesh.cell_ids);
  std::vector<std::string> names;
  for (const auto &[name, group] : mesh.groups)
    names.push_back(name);
  std::size_t n_groups = names.size();
  message.value(n_groups);
  names.resize(n_groups);
  for (std::string &name : names)
  {
    message.text(name);
    show(message, mesh.groups[name]);
  }
}

template<class Archive>
void show(Archive &message, MeshPart &part)
{
  show(message, part.mesh);
  message.array(part.subdomain_of_cell);
  for (std::vector<Surface> *surfaces : {&part.surfaces, &part.whole_surfaces})
  {
    std::size_t n_surfaces = surfaces->size();
    message.value(n_surfaces);
    surfaces->resize(n_surfaces);
    for (Surface &surface : *surfaces)
      show(message, surface);
  }
}

/// Cuts the whole mesh up, part after part.
class Cutter
{
public:
  Cutter(const MeshPart &whole, std::span<const Rank> process_of_cell, const std::vector<bool> &is_rigid,
         std::span<const Index> everywhere, int n_processes)
    : whole_(whole)
    , mesh_(whole.mesh)
    , is_rigid_(is_rigid)
    , cells_(static_cast<std::size_t>(n_processes))
    , is_everywhere_(static_cast<std::size_t>(mesh_.n_nodes()), 0)
    , position_(static_cast<std::size_t>(mesh_.n_nodes()), -1)
    , cell_position_(static_cast<std::size_t>(mesh_.cells.size()), -1)
  {
    for (Index cell = 0; cell < mesh_.cells.size(); ++cell)
      cells_[process_of_cell[cell]].push_back(cell);
    for (const Index node : everywhere)
      is_everywhere_[node] = 1;
    find_cells_of_nodes();
    for (const auto &[name, group] : mesh_.groups)
      place_group(name, group, process_of_cell);
    for (const Surface &surface : whole.surfaces)
      place_faces(surface, process_of_cell);
  }

  MeshPart part(Rank rank)
  {
    MeshPart out;
    out.mesh.dim = mesh_.dim;
    out.mesh.file = mesh_.file;
    out.mesh.n_global_nodes = mesh_.n_global_nodes;
    out.mesh.n_global_cells = mesh_.n_global_cells;
    take_nodes(rank, out.mesh);
    take_cells(rank, out.mesh);
    for (const auto &[name, group] : mesh_.groups)
      take_group(rank, group, processes_of_entities_.at(name), out.mesh.groups[name]);
    take_subdomains(rank, out);
    for (std::size_t s = 0; s < whole_.surfaces.size(); ++s)
      out.surfaces.push_back(share(whole_.surfaces[s], faces_of_processes_[s][rank]));
    out.whole_surfaces = whole_.whole_surfaces;
    for (const GlobalIndex node : out.mesh.node_ids)
      position_[node] = -1;
    for (const Index cell : cells_[rank])
      cell_position_[cell] = -1;
    return out;
  }

private:
  /// Deformable cells of the nodes of groups of lower dimension.
  void find_cells_of_nodes()
  {
    std::vector<char> wanted(position_.size(), 0);
    for (const auto &[name, group] : mesh_.groups)
      if (group.dim < mesh_.dim)
        for (const Index node : group.entities.nodes)
          wanted[node] = 1;
    for (Index cell = 0; cell < mesh_.cells.size(); ++cell)
      if (!is_rigid_[cell])
        for (const Index node : mesh_.cells[cell])
          if (wanted[node])
            cells_of_node_[node].push_back(cell);
  }

  [[nodiscard]] Index cell_of(std::span<const Index> entity) const
  {
    const auto found = cells_of_node_.find(entity[0]);
    if (found == cells_of_node_.end())
      return -1;
    for (const Index cell : found->second)
    {
      const auto nodes = mesh_.cells[cell];
      if (std::all_of(entity.begin(), entity.end(),
                      [&](Index node) { return std::find(nodes.begin(), nodes.end(), node) != nodes.end(); }))
        return cell;
    }
    return -1;
  }

  void place_group(const std::string &name, const Group &group, std::span<const Rank> process_of_cell)
  {
    std::vector<Rank> &processes = processes_of_entities_[name];
    for (Index e = 0; e < group.entities.size(); ++e)
    {
      const Index cell = group.dim == mesh_.dim ? group.cells[e] : cell_of(group.entities[e]);
      processes.push_back(cell >= 0 ? process_of_cell[cell] : 0);
      if (cell < 0)
        orphans_.insert(orphans_.end(), group.entities[e].begin(), group.entities[e].end());
    }
  }

  void place_faces(const Surface &surface, std::span<const Rank> process_of_cell)
  {
    std::vector<std::vector<Index>> &faces = faces_of_processes_.emplace_back(cells_.size());
    std::vector<Index> nodes;
    for (Index f = 0; f < surface.n_faces(); ++f)
    {
      nodes.clear();
      for (const Index local : surface.face(f))
        nodes.push_back(static_cast<Index>(surface.node_ids[local]));
      const Index cell = cell_of(nodes);
      faces[cell >= 0 ? process_of_cell[cell] : 0].push_back(f);
    }
  }

  /// These faces of a surface, and all its nodes that the part has.
  [[nodiscard]] Surface share(const Surface &surface, std::span<const Index> faces) const
  {
    std::vector<Index> nodes;
    for (Index i = 0; i < surface.n_nodes(); ++i)
      if (position_[surface.node_ids[i]] >= 0)
        nodes.push_back(i);
    return share_of_surface(surface, nodes, faces);
  }

  void take_nodes(Rank rank, Mesh &out)
  {
    std::vector<Index> own;
    for (const Index cell : cells_[rank])
      own.insert(own.end(), mesh_.cells[cell].begin(), mesh_.cells[cell].end());
    if (rank == 0)
      own.insert(own.end(), orphans_.begin(), orphans_.end());
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    const auto take = [&](Index node)
    {
      position_[node] = out.n_nodes();
      out.node_tags.push_back(mesh_.node_tags[node]);
      out.node_ids.push_back(node);
      const auto x = mesh_.points.begin() + static_cast<std::ptrdiff_t>(node) * mesh_.dim;
      out.points.insert(out.points.end(), x, x + mesh_.dim);
    };
    for (Index node = 0; node < mesh_.n_nodes(); ++node)
      if (is_everywhere_[node])
        take(node);
    for (const Index node : own)
      if (!is_everywhere_[node])
        take(node);
  }

  [[nodiscard]] std::vector<Index> positions(std::span<const Index> nodes) const
  {
    std::vector<Index> out;
    for (const Index node : nodes)
      out.push_back(position_[node]);
    return out;
  }

  void take_cells(Rank rank, Mesh &out)
  {
    for (const Index cell : cells_[rank])
    {
      cell_position_[cell] = out.cells.size();
      out.cells.push_back(positions(mesh_.cells[cell]));
      out.cell_tags.push_back(mesh_.cell_tags[cell]);
      out.cell_ids.push_back(cell);
    }
  }

  void take_group(Rank rank, const Group &group, std::span<const Rank> processes, Group &out) const
  {
    out.dim = group.dim;
    for (Index e = 0; e < group.entities.size(); ++e)
    {
      if (processes[e] == rank)
      {
        out.entities.push_back(positions(group.entities[e]));
        if (group.dim == mesh_.dim)
          out.cells.push_back(cell_position_[group.cells[e]]);
        continue;
      }
      for (const Index node : group.entities[e])
        if (position_[node] >= 0)
          out.other_nodes.push_back(position_[node]);
    }
    std::sort(out.other_nodes.begin(), out.other_nodes.end());
    out.other_nodes.erase(std::unique(out.other_nodes.begin(), out.other_nodes.end()), out.other_nodes.end());
  }

  void take_subdomains(Rank rank, MeshPart &out) const
  {
    if (whole_.subdomain_of_cell.empty())
      return;
    std::vector<Index> ids;
    for (const Index cell : cells_[rank])
      if (!is_rigid_[cell])
        ids.push_back(whole_.subdomain_of_cell[cell]);
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (const Index cell : cells_[rank])
    {
      const auto place = std::lower_bound(ids.begin(), ids.end(), whole_.subdomain_of_cell[cell]) - ids.begin();
      out.subdomain_of_cell.push_back(is_rigid_[cell] ? 0 : static_cast<Index>(place)); // rigid ones count for none
    }
  }

  const MeshPart &whole_;
  const Mesh &mesh_;
  const std::vector<bool> &is_rigid_;
  std::vector<std::vector<Index>> cells_; ///< by process
  std::vector<char> is_everywhere_;
  std::map<Index, std::vector<Index>> cells_of_node_;
  std::map<std::string, std::vector<Rank>> processes_of_entities_;  ///< by group
  std::vector<std::vector<std::vector<Index>>> faces_of_processes_; ///< by surface and process
  std::vector<Index> orphans_;       ///< nodes of entities that belong to no deformable cell
  std::vector<Index> position_;      ///< of each node in the part that is being made, or -1
  std::vector<Index> cell_position_; ///< the same for cells
};
} // namespace

MeshPart distribute(MessageExchange &messages, const MeshPart &whole, std::span<const Rank> process_of_cell,
                    const std::vector<bool> &is_rigid, std::span<const Index> everywhere)
{
  std::vector<Message> out;
  const Communicator &all = messages.communicator();
  if (all.is_root())
  {
    Cutter cutter(whole, process_of_cell, is_rigid, everywhere, all.size());
    for (Rank rank = 0; rank < all.size(); ++rank)
    {
      Packer packer;
      MeshPart part = cutter.part(rank);
      show(packer, part);
      out.push_back({rank, packer.message.take()});
    }
  }
  const std::vector<Rank> root{0};
  const std::vector<Message> in = messages.exchange_with("mesh", std::move(out), root);
  Unpacker unpacker{ByteReader(in.front().bytes)};
  MeshPart part;
  show(unpacker, part);
  for (std::vector<Surface> *surfaces : {&part.surfaces, &part.whole_surfaces})
    for (Surface &surface : *surfaces)
      surface.build_adjacency();
  return part;
}
} // namespace amontons
