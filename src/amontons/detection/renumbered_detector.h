#pragma once
#include "amontons/detection/detector.h"

#include <functional>
#include <span>

namespace amontons
{
/// Which nodes of the impactor and faces of the target given by the user those that a detector works on are; empty: the
/// same. Pairs are made in the user's numbers at once, for a second list of them is a third of what a detector holds.
struct GivenNumbers
{
  std::span<const Index> nodes, faces;

  [[nodiscard]] Index node(Index own) const { return nodes.empty() || own < 0 ? own : nodes[own]; }
  [[nodiscard]] Index face(Index own) const { return faces.empty() || own < 0 ? own : faces[own]; }
};

using DetectorMaker =
    std::function<std::unique_ptr<Detector>(const Surface &impactor, const Surface &target, GivenNumbers given)>;

/// A detector that works on surfaces numbered along a space-filling curve, where those given are numbered so that
/// neighbours lie far apart in memory: once renumbered, every detection costs what it does in a good order, but for
/// fetching the positions.
/// @return null if both surfaces are well numbered
std::unique_ptr<Detector> make_renumbered_detector(const Surface &impactor, const Surface &target,
                                                   const DetectorMaker &make);
} // namespace amontons
