#pragma once
#include "amontons/detection/detector.h"

#include <functional>

namespace amontons
{
using DetectorMaker = std::function<std::unique_ptr<Detector>(const Surface &impactor, const Surface &target)>;

/// A detector that works on surfaces numbered along a space-filling curve, where those given are numbered so that
/// neighbours lie far apart in memory: once renumbered, every detection costs what it does in a good order, but for
/// fetching the positions and giving back the pairs.
/// @return null if both surfaces are well numbered
std::unique_ptr<Detector> make_renumbered_detector(const Surface &impactor, const Surface &target,
                                                   const DetectorMaker &make);
} // namespace amontons
