#pragma once
#include "amontons/exchange/box.h"
#include "amontons/exchange/parallel_detector.h"
#include "amontons/exchange/shipment.h"

#include <span>
#include <vector>

namespace amontons
{
/// Where the impactor nodes of one contact are that each part looks for, and what it needs about them.
struct PartRegions
{
  std::vector<Box> now;       ///< [n_parts]
  std::vector<Box> reference; ///< self-contact: in the reference
  std::vector<double> near;   ///< self-contact: the largest self-distance of a node in the part
};

/// Of a share's own nodes.
/// @param part_of_node [n_nodes of the impactor], -1 for one that need not be looked for
PartRegions regions_of(const ContactShare &share, const SharePositions &positions, std::span<const Rank> part_of_node,
                       int n_parts);

/// What of one contact goes to which part, so that it finds for its nodes what would be found with all:
///
/// - of the impactor its own nodes, with the faces attached to them (they tell where the node's own side is);
/// - of the target the faces that may come within the layer of one of them: those whose box is that near to the box of
///   the part's nodes. All faces that meet at a closest point are among them, so ends, edges and vertices are what
///   they are.
/// - In self-contact also the faces that may lie within the self-distance of its nodes in the reference: the ways along
///   the surface that decide what a node does not see run through no other.
struct ContactRoutes
{
  Shipments impactor, target; ///< self-contact: impactor only
};
/// @param layer w, and what surfaces may come nearer to each other before there are new routes
ContactRoutes make_routes(const ContactShare &share, const SharePositions &positions,
                          std::span<const Rank> part_of_node, const PartRegions &regions, double layer);

/// One message to each process that gets something: the topology of all contacts if asked for, then all positions.
/// @return by increasing rank
std::vector<Message> pack(std::span<const ContactShare> shares, std::span<const SharePositions> positions,
                          std::span<const ContactRoutes> routes, bool with_topology);
/// The own nodes that went to a part, in their order.
std::span<const Index> nodes_sent(const ContactRoutes &routes, Rank part);
/// To whom pack() writes.
std::vector<Rank> destinations(std::span<const ContactRoutes> routes);
} // namespace amontons
