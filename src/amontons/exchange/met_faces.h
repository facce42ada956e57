#pragma once
#include "amontons/exchange/box.h"
#include "amontons/exchange/parallel_detector.h"
#include "amontons/exchange/shipment.h"

#include <span>
#include <vector>

namespace amontons
{
/// What the given nodes see: their pairs, and the faces met with their nodes and places.
/// @param pairs of all nodes, faces on `target` @param room scratch, the same from call to call
void pack_pairs(std::span<const Index> nodes, std::span<const Pair> pairs, const Surface &target,
                std::span<const double> target_x, std::vector<Index> &room, ByteWriter &writer);

/// Of the nodes without a face tells those outside the target's box grown by w from those too far from it: a part's box
/// is not the target's.
/// @param x of the nodes, first
void tell_outside(Pairing &pairs, int dim, std::span<const double> x, const Box &target, double w);

/// Puts together what several processes have found for the own nodes of one.
class MetFaces
{
public:
  MetFaces(int dim, Index n_own);

  /// @param nodes those that were sent to be looked for, in that order
  void add(Rank rank, std::span<const Index> nodes, ByteReader &reader);

  MetPairing finish();

private:
  HeldSurface held_; ///< its reference coordinates are where the nodes are
  MetPairing result_;
  std::vector<std::vector<Index>> nodes_; ///< by source
};
} // namespace amontons
