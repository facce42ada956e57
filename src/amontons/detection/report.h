#pragma once
#include "amontons/base/ids.h"
#include "amontons/detection/options.h"
#include "amontons/surface/pairing.h"

#include <array>
#include <map>
#include <optional>
#include <string>

namespace amontons
{
/// What only self-contact knows.
struct SelfContactReport
{
  Index n_zones = 0;                                ///< of contact, each with its impactor and its target side
  double n_excluded = 0;                            ///< faces within the self-distance of a node, mean over the nodes
  double least_distance = 0, greatest_distance = 0; ///< self-distances of the nodes, length
};

/// What one detection did, for the user.
struct DetectionReport
{
  std::string method;
  double distance = 0;      ///< w used
  Index distance_face = -1; ///< face whose size set w; -1 where the user gave it
  Index n_pairs = 0;
  std::map<std::string, Index> pairs_by_kind; ///< "face", "edge", "vertex", "extension"; or "mortar"
  std::map<std::string, Index>
      unpaired_by_reason; ///< "outside_box", "too_far", "behind", "past_end", "target_side"; mortar: "uncovered"
  Index n_penetrations = 0;
  double deepest = 0;      ///< least gap, <= 0
  Index deepest_node = -1; ///< local index on the impactor surface
  std::array<double, 3> deepest_point{0, 0, 0};
  std::optional<SelfContactReport> self_contact;
  std::map<std::string, double> seconds; ///< per step: "bounds", "fill", "nearest", "projection"
};

/// As in the deck.
const char *name_of(DetectionMethod method);

/// Counts the pairs by kind, the nodes without one by reason, and the penetrations.
/// @param self_contact whether nodes may be without a pair because their side is the target
void count_pairs(const Pairing &pairing, bool self_contact, DetectionReport &report);
} // namespace amontons
