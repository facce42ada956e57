#include "amontons/bulk/mesh_distribution.h"

#include <algorithm>
#include <map>

namespace amontons
{
namespace
{
void add(ByteWriter &writer, const Connectivity &entities)
{
  writer.add_array(entities.offsets);
  writer.add_array(entities.nodes);
}

Connectivity get_connectivity(ByteReader &reader)
{
  Connectivity out;
  out.offsets = reader.get_array<Index>();
  out.nodes = reader.get_array<Index>();
  return out;
}

void add(ByteWriter &writer, const std::string &text)
{
  writer.add_array(std::vector<char>(text.begin(), text.end()));
}

std::string get_text(ByteReader &reader)
{
  const std::vector<char> text = reader.get_array<char>();
  return {text.begin(), text.end()};
}

void add(ByteWriter &writer, const Surface &surface)
{
  writer.add(surface.dim);
  writer.add_array(surface.node_ids);
  writer.add_array(surface.reference);
  writer.add_array(surface.face_offsets);
  writer.add_array(surface.face_nodes);
  writer.add_array(surface.face_ids);
  writer.add_array(surface.face_bodies);
}

Surface get_surface(ByteReader &reader)
{
  Surface out;
  out.dim = reader.get<int>();
  out.node_ids = reader.get_array<GlobalIndex>();
  out.reference = reader.get_array<double>();
  out.face_offsets = reader.get_array<Index>();
  out.face_nodes = reader.get_array<Index>();
  out.face_ids = reader.get_array<GlobalIndex>();
  out.face_bodies = reader.get_array<Index>();
  out.build_adjacency();
  return out;
}

Bytes packed(const MeshPart &part)
{
  const Mesh &mesh = part.mesh;
  ByteWriter writer;
  writer.add(mesh.dim);
  writer.add(mesh.n_global_nodes);
  writer.add(mesh.n_global_cells);
  add(writer, mesh.file);
  writer.add_array(mesh.points);
  writer.add_array(mesh.node_tags);
  writer.add_array(mesh.node_ids);
  add(writer, mesh.cells);
  writer.add_array(mesh.cell_tags);
  writer.add_array(mesh.cell_ids);
  writer.add(static_cast<Index>(mesh.groups.size()));
  for (const auto &[name, group] : mesh.groups)
  {
    add(writer, name);
    writer.add(group.dim);
    add(writer, group.entities);
    writer.add_array(group.cells);
    writer.add_array(group.other_nodes);
  }
  writer.add_array(part.subdomain_of_cell);
  writer.add(static_cast<Index>(part.surfaces.size()));
  for (const Surface &surface : part.surfaces)
    add(writer, surface);
  return writer.take();
}

MeshPart unpacked(std::span<const std::byte> bytes)
{
  ByteReader reader(bytes);
  MeshPart part;
  Mesh &mesh = part.mesh;
  mesh.dim = reader.get<int>();
  mesh.n_global_nodes = reader.get<GlobalIndex>();
  mesh.n_global_cells = reader.get<GlobalIndex>();
  mesh.file = get_text(reader);
  mesh.points = reader.get_array<double>();
  mesh.node_tags = reader.get_array<GlobalIndex>();
  mesh.node_ids = reader.get_array<GlobalIndex>();
  mesh.cells = get_connectivity(reader);
  mesh.cell_tags = reader.get_array<GlobalIndex>();
  mesh.cell_ids = reader.get_array<GlobalIndex>();
  for (auto n_groups = reader.get<Index>(); n_groups > 0; --n_groups)
  {
    Group &group = mesh.groups[get_text(reader)];
    group.dim = reader.get<int>();
    group.entities = get_connectivity(reader);
    group.cells = reader.get_array<Index>();
    group.other_nodes = reader.get_array<Index>();
  }
  part.subdomain_of_cell = reader.get_array<Index>();
  for (auto n_surfaces = reader.get<Index>(); n_surfaces > 0; --n_surfaces)
    part.surfaces.push_back(get_surface(reader));
  return part;
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
    for (const Surface &surface : whole.surfaces)
      for (const GlobalIndex node : surface.node_ids)
        is_everywhere_[node] = 1;
    find_cells_of_nodes();
    for (const auto &[name, group] : mesh_.groups)
      place_group(name, group, process_of_cell);
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
    for (Surface surface : whole_.surfaces)
    {
      for (GlobalIndex &node : surface.node_ids)
        node = position_[node];
      out.surfaces.push_back(std::move(surface));
    }
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
  std::map<std::string, std::vector<Rank>> processes_of_entities_; ///< by group
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
      out.push_back({rank, packed(cutter.part(rank))});
  }
  const std::vector<Rank> root{0};
  const std::vector<Message> in = messages.exchange_with("mesh", std::move(out), root);
  return unpacked(in.front().bytes);
}
} // namespace amontons
