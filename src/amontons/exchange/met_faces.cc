#include "amontons/exchange/met_faces.h"

#include <algorithm>

namespace amontons
{
namespace
{
// The faces met, each once, and of each pair the place of its face among them.
std::vector<Index> faces_of(std::span<const Index> nodes, std::span<const Pair> pairs)
{
  std::vector<Index> faces;
  for (const Index node : nodes)
    if (pairs[node].face >= 0)
      faces.push_back(pairs[node].face);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

void pack_pair(const Pair &pair, std::span<const Index> faces, int dim, ByteWriter &writer)
{
  writer.add(pair.kind);
  if (pair.kind == PairKind::none)
    return writer.add(pair.reason);
  writer.add(static_cast<Index>(std::lower_bound(faces.begin(), faces.end(), pair.face) - faces.begin()));
  writer.add_values(std::span<const double>(pair.xi).first(static_cast<std::size_t>(dim - 1)));
  writer.add(pair.gap);
  writer.add(pair.distance);
}

Pair unpack_pair(int dim, ByteReader &reader)
{
  Pair pair;
  pair.kind = reader.get<PairKind>();
  if (pair.kind == PairKind::none)
  {
    pair.reason = reader.get<NoPairReason>();
    return pair;
  }
  pair.face = reader.get<Index>();
  for (int a = 0; a < dim - 1; ++a)
    pair.xi[a] = reader.get<double>();
  pair.gap = reader.get<double>();
  pair.distance = reader.get<double>();
  return pair;
}
} // namespace

void pack_pairs(std::span<const Index> nodes, std::span<const Pair> pairs, const Surface &target,
                std::span<const double> target_x, std::vector<Index> &room, ByteWriter &writer)
{
  Shipments met;
  met[0].faces = faces_of(nodes, pairs);
  add_nodes_of_faces(met, target);
  pack_topology(met[0], target, target_x, room, writer);
  for (const Index node : nodes)
    pack_pair(pairs[node], met[0].faces, target.dim, writer);
}

MetFaces::MetFaces(int dim, Index n_own)
  : held_(dim, "target")
{
  result_.pairs.resize(n_own);
  for (Pair &pair : result_.pairs) // of nodes that nobody was sent
    pair.reason = NoPairReason::too_far;
}

void MetFaces::add(Rank rank, std::span<const Index> nodes, ByteReader &reader)
{
  held_.add_topology(rank, reader);
  for (const Index node : nodes)
    result_.pairs[node] = unpack_pair(held_.surface().dim, reader);
  nodes_.emplace_back(nodes.begin(), nodes.end());
}

MetPairing MetFaces::finish()
{
  held_.merge(true);
  for (std::size_t s = 0; s < nodes_.size(); ++s)
    for (const Index node : nodes_[s])
      if (Index &face = result_.pairs[node].face; face >= 0)
        face = held_.sources()[s].faces[face];
  result_.target = held_.take_surface();
  result_.target_x.swap(result_.target.reference);
  return std::move(result_);
}

void tell_outside(Pairing &pairs, int dim, std::span<const double> x, const Box &target, double w)
{
  for (Index node = 0; node < static_cast<Index>(pairs.size()); ++node)
    if (Pair &pair = pairs[node]; pair.reason == NoPairReason::too_far || pair.reason == NoPairReason::outside_box)
      pair.reason = target.holds(place_of(x, dim, node), w) ? NoPairReason::too_far : NoPairReason::outside_box;
}
} // namespace amontons
