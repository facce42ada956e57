#include "amontons/exchange/shipment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

namespace amontons
{
namespace
{
std::vector<double> coordinates_of(std::span<const Index> nodes, int dim, std::span<const double> x)
{
  std::vector<double> result;
  result.reserve(nodes.size() * dim);
  for (const Index node : nodes)
    result.insert(result.end(), x.begin() + static_cast<std::ptrdiff_t>(node) * dim,
                  x.begin() + static_cast<std::ptrdiff_t>(node + 1) * dim);
  return result;
}
} // namespace

void add_nodes_of_faces(Shipments &shipments, const Surface &surface)
{
  std::vector<Rank> taken_by(surface.node_ids.size(), -1);
  for (auto &[rank, shipment] : shipments)
  {
    for (const Index node : shipment.nodes)
      taken_by[node] = rank;
    for (const Index f : shipment.faces)
      for (const Index node : surface.face(f))
        if (taken_by[node] != rank)
        {
          taken_by[node] = rank;
          shipment.nodes.push_back(node);
        }
  }
}

void pack_topology(const Shipment &shipment, const Surface &surface, std::span<const double> reference,
                   std::vector<Index> &room, ByteWriter &writer)
{
  std::vector<Index> &number = room; // of the shipment's nodes, in it
  number.resize(surface.node_ids.size());
  std::vector<GlobalIndex> node_ids, face_ids;
  std::vector<Index> face_nodes, face_bodies;
  std::vector<std::uint8_t> face_sizes;
  for (std::size_t k = 0; k < shipment.nodes.size(); ++k)
  {
    node_ids.push_back(surface.node_ids[shipment.nodes[k]]);
    number[shipment.nodes[k]] = static_cast<Index>(k);
  }
  for (const Index f : shipment.faces)
  {
    face_ids.push_back(surface.face_ids[f]);
    face_sizes.push_back(static_cast<std::uint8_t>(surface.face(f).size()));
    for (const Index node : surface.face(f))
      face_nodes.push_back(number[node]);
    if (!surface.face_bodies.empty())
      face_bodies.push_back(surface.face_bodies[f]);
  }
  writer.add(shipment.n_own);
  writer.add_array(node_ids);
  writer.add_array(reference.empty() ? std::vector<double>() : coordinates_of(shipment.nodes, surface.dim, reference));
  writer.add_array(face_ids);
  writer.add_array(face_sizes);
  writer.add_array(face_nodes);
  writer.add_array(face_bodies);
}

void pack_positions(const Shipment &shipment, int dim, std::span<const double> x, ByteWriter &writer)
{
  writer.add_values(std::span<const double>(coordinates_of(shipment.nodes, dim, x)));
}

void HeldSurface::add_topology(Rank rank, ByteReader &reader)
{
  Sent sent;
  sources_.push_back({rank, reader.get<Index>(), {}, {}});
  sent.node_ids = reader.get_array<GlobalIndex>();
  sent.reference = reader.get_array<double>();
  sent.face_ids = reader.get_array<GlobalIndex>();
  sent.face_sizes = reader.get_array<std::uint8_t>();
  sent.face_nodes = reader.get_array<Index>();
  sent.face_bodies = reader.get_array<Index>();
  sent_.push_back(std::move(sent));
}

void HeldSurface::merge(bool repeated_faces)
{
  merge_nodes();
  merge_faces(repeated_faces);
  surface_.build_adjacency();
  bool has_reference = false;
  std::vector<double> reference(surface_.node_ids.size() * surface_.dim, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t s = 0; s < sent_.size(); ++s)
    if (!sent_[s].reference.empty())
    {
      place(reference, s, sent_[s].reference);
      has_reference = true;
    }
  if (has_reference)
    surface_.reference = std::move(reference);
  sent_ = {};
}

void HeldSurface::merge_nodes()
{
  std::vector<GlobalIndex> &ids = surface_.node_ids;
  for (const Sent &sent : sent_)
    ids.insert(ids.end(), sent.node_ids.begin(), sent.node_ids.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<Rank> owner(ids.size(), -1);
  for (std::size_t s = 0; s < sent_.size(); ++s)
  {
    Source &source = sources_[s];
    for (const GlobalIndex id : sent_[s].node_ids)
      source.nodes.push_back(static_cast<Index>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin()));
    for (Index k = 0; k < source.n_own; ++k)
    {
      const Index node = source.nodes[k];
      if (owner[node] >= 0)
        throw UserError("contact detection: node " + std::to_string(ids[node]) + " of the " + side_ +
                        " is owned by process " + std::to_string(owner[node]) + " and by process " +
                        std::to_string(source.rank) + "; each node is to have one owner");
      owner[node] = source.rank;
    }
  }
}

void HeldSurface::merge_faces(bool repeated)
{
  struct Entry
  {
    GlobalIndex id;
    std::size_t source;
    Index face;
    std::size_t first_node;
  };
  std::vector<Entry> entries;
  bool has_bodies = false;
  for (std::size_t s = 0; s < sent_.size(); ++s)
  {
    std::size_t first_node = 0;
    for (std::size_t f = 0; f < sent_[s].face_ids.size(); ++f)
    {
      entries.push_back({sent_[s].face_ids[f], s, static_cast<Index>(f), first_node});
      first_node += sent_[s].face_sizes[f];
    }
    sources_[s].faces.resize(sent_[s].face_ids.size());
    has_bodies = has_bodies || !sent_[s].face_bodies.empty();
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry &a, const Entry &b) { return std::tie(a.id, a.source) < std::tie(b.id, b.source); });
  for (const Entry &entry : entries)
  {
    const Sent &sent = sent_[entry.source];
    if (surface_.face_ids.empty() || surface_.face_ids.back() != entry.id)
    {
      surface_.face_ids.push_back(entry.id);
      for (std::size_t k = 0; k < sent.face_sizes[entry.face]; ++k)
        surface_.face_nodes.push_back(sources_[entry.source].nodes[sent.face_nodes[entry.first_node + k]]);
      surface_.face_offsets.push_back(static_cast<Index>(surface_.face_nodes.size()));
      if (has_bodies)
        surface_.face_bodies.push_back(sent.face_bodies.at(entry.face));
    }
    else if (!repeated)
      throw UserError("contact detection: face " + std::to_string(entry.id) + " of the " + side_ +
                      " is given more than once, also by process " + std::to_string(sources_[entry.source].rank));
    sources_[entry.source].faces[entry.face] = surface_.n_faces() - 1;
  }
}

void HeldSurface::place(std::vector<double> &x, std::size_t source, std::span<const double> from) const
{
  const int dim = surface_.dim;
  const std::vector<Index> &nodes = sources_[source].nodes;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (int c = 0; c < dim; ++c)
    {
      double &there = x[static_cast<std::size_t>(nodes[k]) * dim + c];
      if (!std::isnan(there) && there != from[k * dim + c])
        throw UserError("contact detection: node " + std::to_string(surface_.node_ids[nodes[k]]) + " of the " + side_ +
                        " is not where other processes have it on process " + std::to_string(sources_[source].rank));
      there = from[k * dim + c];
    }
}

void HeldSurface::move(std::span<ByteReader> readers)
{
  x_.assign(surface_.node_ids.size() * surface_.dim, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t s = 0; s < sources_.size(); ++s)
    place(x_, s, readers[s].get_values<double>(sources_[s].nodes.size() * surface_.dim));
  if (surface_.reference.empty())
    surface_.reference = x_;
}
} // namespace amontons
