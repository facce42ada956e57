#pragma once
#include <optional>

namespace amontons
{
enum class DetectionMethod
{
  exact,        ///< the closest point of the target within w
  nearest_node, ///< the paper's four steps
  brute         ///< all faces for all nodes: the oracle
};

struct DetectionOptions
{
  DetectionMethod method = DetectionMethod::exact;
  std::optional<double> distance;  ///< w, length; computed where absent
  std::optional<double> extension; ///< length past the target's ends; a fraction of the local face where absent
};
} // namespace amontons
