#include "amontons/detection/report.h"

namespace amontons
{
const char *name_of(DetectionMethod method)
{
  switch (method)
  {
  case DetectionMethod::exact:
    return "exact";
  case DetectionMethod::nearest_node:
    return "nearest-node";
  case DetectionMethod::brute:
    return "brute";
  }
  return "";
}

void count_pairs(const Pairing &pairing, bool self_contact, DetectionReport &report)
{
  constexpr std::array<const char *, 5> kinds{"none", "face", "edge", "vertex", "extension"};
  constexpr std::array<const char *, 6> reasons{"paired", "outside_box", "too_far",
                                                "behind", "past_end",    "target_side"};
  std::array<Index, kinds.size()> by_kind{};
  std::array<Index, reasons.size()> by_reason{};
  for (std::size_t node = 0; node < pairing.size(); ++node)
  {
    const Pair &pair = pairing[node];
    ++by_kind[static_cast<std::size_t>(pair.kind)];
    ++by_reason[static_cast<std::size_t>(pair.reason)];
    if (pair.kind == PairKind::none || !(pair.gap < 0))
      continue;
    ++report.n_penetrations;
    if (pair.gap < report.deepest)
    {
      report.deepest = pair.gap;
      report.deepest_node = static_cast<Index>(node);
    }
  }
  report.n_pairs = by_reason[0];
  for (std::size_t i = 1; i < kinds.size(); ++i)
    report.pairs_by_kind[kinds[i]] = by_kind[i];
  for (std::size_t i = 1; i < reasons.size(); ++i)
    if (self_contact || static_cast<NoPairReason>(i) != NoPairReason::target_side)
      report.unpaired_by_reason[reasons[i]] = by_reason[i];
}
} // namespace amontons
