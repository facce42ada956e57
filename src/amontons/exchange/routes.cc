#include "amontons/exchange/routes.h"

#include "amontons/detection/self_contact_exclusions.h"
#include "amontons/exchange/part_boxes.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace amontons
{
namespace
{
// Ways along the surface are sums of rounded lengths.
constexpr double round_off = 1e-6;

double longest_edge(const Surface &surface, Index f)
{
  const auto nodes = surface.face(f);
  double squared = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    const Place a = place_of(surface.reference, surface.dim, nodes[k]);
    const Place b = place_of(surface.reference, surface.dim, nodes[(k + 1) % nodes.size()]);
    squared = std::max(squared, std::pow(a[0] - b[0], 2) + std::pow(a[1] - b[1], 2) + std::pow(a[2] - b[2], 2));
  }
  return std::sqrt(squared);
}

// The parts of a face's nodes, each once.
void collect_parts(std::span<const Index> nodes, std::span<const Rank> part_of_node, std::vector<Rank> &parts)
{
  parts.clear();
  for (const Index node : nodes)
    if (const Rank part = part_of_node[node]; part >= 0 && std::find(parts.begin(), parts.end(), part) == parts.end())
      parts.push_back(part);
}

void send_own_nodes(const ContactShare &share, std::span<const Rank> part_of_node, Shipments &shipments)
{
  for (Index node = 0; node < share.n_own; ++node)
    if (const Rank part = part_of_node[node]; part >= 0)
    {
      Shipment &shipment = shipments[part];
      shipment.nodes.push_back(node);
      ++shipment.n_own;
    }
}

void send_attached_faces(const ContactShare &share, std::span<const Rank> part_of_node, Shipments &shipments)
{
  std::vector<Rank> parts;
  for (Index f = 0; f < share.impactor->n_faces(); ++f)
  {
    collect_parts(share.impactor->face(f), part_of_node, parts);
    for (const Rank part : parts)
      shipments[part].faces.push_back(f);
  }
}

void send_faces_near(const Surface &surface, std::span<const double> x, const PartBoxes &boxes, double layer,
                     Shipments &shipments)
{
  for (Index f = 0; f < surface.n_faces(); ++f)
    boxes.visit_meeting(box_of(x, surface.dim, surface.face(f)), layer,
                        [&](Rank part) { shipments[part].faces.push_back(f); });
}

void send_faces_near_or_once_near(const Surface &surface, std::span<const double> x, const PartRegions &regions,
                                  double layer, Shipments &shipments)
{
  const PartBoxes now(regions.now);
  std::vector<Box> grown;
  for (std::size_t part = 0; part < regions.now.size(); ++part)
    grown.push_back(regions.reference[part].grown((1 + round_off) * regions.near[part]));
  const PartBoxes once(std::move(grown));
  std::vector<Rank> parts;
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    parts.clear();
    const auto take = [&parts](Rank part) { parts.push_back(part); };
    now.visit_meeting(box_of(x, surface.dim, surface.face(f)), layer, take);
    once.visit_meeting(box_of(surface.reference, surface.dim, surface.face(f)), 0, take);
    std::sort(parts.begin(), parts.end());
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    for (const Rank part : parts)
      shipments[part].faces.push_back(f);
  }
}

const Shipment &shipment_to(Rank rank, const Shipments &shipments)
{
  static const Shipment nothing;
  const auto found = shipments.find(rank);
  return found == shipments.end() ? nothing : found->second;
}
} // namespace

PartRegions regions_of(const ContactShare &share, const SharePositions &positions, std::span<const Rank> part_of_node,
                       int n_parts)
{
  const Surface &surface = *share.impactor;
  PartRegions regions;
  regions.now.resize(n_parts);
  for (Index node = 0; node < share.n_own; ++node)
    if (part_of_node[node] >= 0)
      regions.now[part_of_node[node]].include(place_of(positions.impactor, surface.dim, node));
  if (share.target)
    return regions;
  regions.reference.resize(n_parts);
  regions.near.resize(n_parts, share.self_distance.value_or(0));
  for (Index node = 0; node < share.n_own; ++node)
    if (part_of_node[node] >= 0)
      regions.reference[part_of_node[node]].include(place_of(surface.reference, surface.dim, node));
  for (Index f = 0; f < surface.n_faces() && !share.self_distance; ++f)
  {
    const double distance = Exclusions::default_edges * longest_edge(surface, f);
    for (const Index node : surface.face(f))
      if (const Rank part = part_of_node[node]; part >= 0)
        regions.near[part] = std::max(regions.near[part], distance);
  }
  return regions;
}

ContactRoutes make_routes(const ContactShare &share, const SharePositions &positions,
                          std::span<const Rank> part_of_node, const PartRegions &regions, double layer)
{
  ContactRoutes routes;
  send_own_nodes(share, part_of_node, routes.impactor);
  if (share.target)
  {
    send_attached_faces(share, part_of_node, routes.impactor);
    send_faces_near(*share.target, positions.target, PartBoxes(regions.now), layer, routes.target);
    add_nodes_of_faces(routes.target, *share.target);
  }
  else
    send_faces_near_or_once_near(*share.impactor, positions.impactor, regions, layer, routes.impactor);
  add_nodes_of_faces(routes.impactor, *share.impactor);
  return routes;
}

std::vector<Rank> destinations(std::span<const ContactRoutes> routes)
{
  std::set<Rank> ranks;
  for (const ContactRoutes &contact : routes)
    for (const Shipments *shipments : {&contact.impactor, &contact.target})
      for (const auto &[rank, shipment] : *shipments)
        ranks.insert(rank);
  return {ranks.begin(), ranks.end()};
}

std::span<const Index> nodes_sent(const ContactRoutes &routes, Rank part)
{
  const Shipment &shipment = shipment_to(part, routes.impactor);
  return std::span(shipment.nodes).first(static_cast<std::size_t>(shipment.n_own));
}

std::vector<Message> pack(std::span<const ContactShare> shares, std::span<const SharePositions> positions,
                          std::span<const ContactRoutes> routes, bool with_topology)
{
  std::vector<Message> messages;
  std::vector<Index> room;
  for (const Rank rank : destinations(routes))
  {
    ByteWriter writer;
    for (std::size_t c = 0; c < shares.size() && with_topology; ++c)
    {
      const Surface &impactor = *shares[c].impactor;
      const std::span<const double> reference = impactor.reference;
      pack_topology(shipment_to(rank, routes[c].impactor), impactor,
                    shares[c].target ? std::span<const double>() : reference, room, writer);
      if (shares[c].target)
        pack_topology(shipment_to(rank, routes[c].target), *shares[c].target, {}, room, writer);
    }
    for (std::size_t c = 0; c < shares.size(); ++c)
    {
      const int dim = shares[c].impactor->dim;
      pack_positions(shipment_to(rank, routes[c].impactor), dim, positions[c].impactor, writer);
      if (shares[c].target)
        pack_positions(shipment_to(rank, routes[c].target), dim, positions[c].target, writer);
    }
    messages.push_back({rank, writer.take()});
  }
  return messages;
}
} // namespace amontons
