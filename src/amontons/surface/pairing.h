#pragma once
#include "amontons/base/ids.h"

#include <array>
#include <limits>
#include <vector>

namespace amontons
{
/// How the closest point of the target was found.
enum class PairKind : unsigned char
{
  none,     ///< nothing within reach
  face,     ///< the projection lies inside the face
  edge,     ///< dead angle: the closest point lies on an edge (3D)
  vertex,   ///< dead angle: the closest point is a vertex
  extension ///< past the end of the target, on the extended face
};

/// Why a node has no face (PairKind::none).
enum class NoPairReason : unsigned char
{
  paired,
  outside_box, ///< outside the target's box grown by w
  too_far,     ///< no target point within w
  behind,      ///< only faces seen from inside their body and facing as the impactor does: no way out within w
  past_end,    ///< past the end of a target that does not extend that far
  target_side  ///< self-contact: it sees a face, but is itself of the side that serves as target
};

/// The target seen by one impactor node.
struct Pair
{
  Index face = -1;                ///< on the target surface, local index; -1 without a pair
  std::array<double, 2> xi{0, 0}; ///< on `face`; for edge, vertex and extension pairs the projection on the face
                                  ///< extended, so it may lie outside the face
  double gap = std::numeric_limits<double>::infinity();      ///< (x - xbar(xi)) . n, negative inside the target
  double distance = std::numeric_limits<double>::infinity(); ///< to the closest target point, >= 0
  PairKind kind = PairKind::none;
  NoPairReason reason = NoPairReason::paired;
};

/// One entry per impactor node, in the order of the impactor surface's nodes.
using Pairing = std::vector<Pair>;
} // namespace amontons
