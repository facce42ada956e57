#pragma once
#include "detection/method.h"

#include <nlohmann/json.hpp>

namespace amontons::benchmark
{
struct Settings
{
  std::vector<std::string> methods; ///< exact, nearest-node, brute, nanoflann, cgal, embree
  int repeats = 3;
  double brute_pairs = 2e7; ///< node-face pairs that brute force is to look at, for a sample of the nodes
};

/// Runs all methods in turn, `repeats` times over, and compares what they find: an object per method, its times the
/// medians, in ns per impactor node.
nlohmann::json measure(const Scene &scene, const Settings &settings);
} // namespace amontons::benchmark
