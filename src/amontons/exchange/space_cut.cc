#include "amontons/exchange/space_cut.h"

#include <cmath>
#include <numeric>

namespace amontons
{
namespace
{
constexpr int n_bins = 64, most_rounds = 10;
// Share of a cut's points by which its sides may differ from what they should hold.
constexpr double tolerance = 1e-3;
// Against the other axes, in units of the extents.
constexpr std::array<double, 2> tilt{1e-3, 3e-4};
} // namespace

/// Where a threshold is looked for.
struct SpaceCut::Bracket
{
  double low = 0, high = 1;
  double below = 0;  ///< points below `low`
  double wanted = 0; ///< points that are to be below the threshold
  double total = -1; ///< of the cut; -1: not counted yet
  bool is_found = false;

  [[nodiscard]] double width() const { return (high - low) / n_bins; }
  [[nodiscard]] int bin(double key) const
  {
    return std::clamp(static_cast<int>(std::floor((key - low) / width())), 0, n_bins - 1);
  }
  /// @param counts points in each bin @return the threshold so far
  double narrow(std::span<const double> counts);
};

double SpaceCut::Bracket::narrow(std::span<const double> counts)
{
  double sum = below;
  int k = 0;
  while (k + 1 < n_bins && sum + counts[k] < wanted)
    sum += counts[k++];
  const double from = low + k * width(), to = from + width();
  const double lower_error = wanted - sum, upper_error = sum + counts[k] - wanted;
  is_found = std::min(lower_error, upper_error) <= tolerance * total;
  const double threshold = lower_error < upper_error ? from : to;
  low = from;
  high = to;
  below = sum;
  return threshold;
}

SpaceCut::SpaceCut(MessageExchange &messages, const std::string &phase, std::span<const Place> points)
{
  const int n_parts = messages.communicator().size();
  if (n_parts == 1)
    return;
  cuts_.push_back({0, n_parts, {0, 0, 0}, 0, 0, -1, -1});
  std::vector<int> cut_of_point(points.size(), 0);
  for (int first_cut = 0; first_cut < static_cast<int>(cuts_.size());)
  {
    const int end = static_cast<int>(cuts_.size());
    aim(messages, phase, points, cut_of_point, first_cut);
    find_thresholds(messages, phase, points, cut_of_point, first_cut);
    divide(first_cut, points, cut_of_point);
    first_cut = end;
  }
}

// Across the longest extent of each cut's points, nearly. Keys run from 0 to a little more than 1.
void SpaceCut::aim(MessageExchange &messages, const std::string &phase, std::span<const Place> points,
                   const std::vector<int> &cut_of_point, int first_cut)
{
  const std::size_t n = cuts_.size() - static_cast<std::size_t>(first_cut);
  std::vector<double> bounds(6 * n, -Box::infinity); // -low, high
  for (std::size_t i = 0; i < points.size(); ++i)
    if (cut_of_point[i] >= first_cut)
      for (std::size_t c = 0; c < 3; ++c)
      {
        double *bound = &bounds[6 * static_cast<std::size_t>(cut_of_point[i] - first_cut)];
        bound[c] = std::max(bound[c], -points[i][c]);
        bound[c + 3] = std::max(bound[c + 3], points[i][c]);
      }
  messages.maximum(phase, bounds);
  for (std::size_t k = 0; k < n; ++k)
  {
    const double *bound = &bounds[6 * k];
    Cut &cut = cuts_[static_cast<std::size_t>(first_cut) + k];
    std::array<double, 3> extent{};
    for (std::size_t c = 0; c < 3; ++c)
      extent[c] = std::max(bound[c] + bound[c + 3], 0.0); // of no points: -infinity
    const auto axis = static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
    for (std::size_t i = 0; i < 3; ++i)
    {
      const std::size_t c = (axis + i) % 3;
      if (extent[c] > 0)
        cut.direction[c] = (i == 0 ? 1 : tilt[i - 1]) / extent[c];
      cut.offset -= extent[c] > 0 ? cut.direction[c] * bound[c] : 0;
    }
  }
}

void SpaceCut::find_thresholds(MessageExchange &messages, const std::string &phase, std::span<const Place> points,
                               const std::vector<int> &cut_of_point, int first_cut)
{
  const std::size_t n = cuts_.size() - static_cast<std::size_t>(first_cut);
  std::vector<Bracket> brackets(n);
  for (Bracket &bracket : brackets)
    bracket.high = 1 + tilt[0] + tilt[1] + 1e-9;
  for (int round = 0; round < most_rounds; ++round)
  {
    std::vector<double> counts(n * n_bins, 0.0);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const int k = cut_of_point[i] - first_cut;
      if (k < 0 || brackets[k].is_found)
        continue;
      const double key = cuts_[cut_of_point[i]].key(points[i]);
      if (round == 0 || (key >= brackets[k].low && key < brackets[k].high))
        counts[static_cast<std::size_t>(k) * n_bins + brackets[k].bin(key)] += 1;
    }
    messages.sum(phase, counts);
    bool all_found = true;
    for (std::size_t k = 0; k < n; ++k)
    {
      Bracket &bracket = brackets[k];
      Cut &cut = cuts_[static_cast<std::size_t>(first_cut) + k];
      const auto own = std::span<const double>(counts).subspan(k * n_bins, n_bins);
      if (round == 0)
      {
        bracket.total = std::accumulate(own.begin(), own.end(), 0.0);
        bracket.wanted = bracket.total * (cut.middle() - cut.first) / (cut.last - cut.first);
      }
      if (!bracket.is_found)
        cut.threshold = bracket.narrow(own);
      all_found = all_found && bracket.is_found;
    }
    if (all_found)
      return;
  }
}

// Hands the points on to the cuts of the next level.
void SpaceCut::divide(int first_cut, std::span<const Place> points, std::vector<int> &cut_of_point)
{
  const int end = static_cast<int>(cuts_.size());
  for (int k = first_cut; k < end; ++k)
    for (const bool is_below : {true, false})
    {
      const Rank first = is_below ? cuts_[k].first : cuts_[k].middle();
      const Rank last = is_below ? cuts_[k].middle() : cuts_[k].last;
      if (last - first == 1)
        continue;
      (is_below ? cuts_[k].below : cuts_[k].above) = static_cast<int>(cuts_.size());
      cuts_.push_back({first, last, {0, 0, 0}, 0, 0, -1, -1});
    }
  for (std::size_t i = 0; i < points.size(); ++i)
    if (int &k = cut_of_point[i]; k >= first_cut)
      k = cuts_[k].key(points[i]) < cuts_[k].threshold ? cuts_[k].below : cuts_[k].above;
}

Rank SpaceCut::part_of(const Place &x) const
{
  if (cuts_.empty())
    return 0;
  for (const Cut *cut = &cuts_[0];;)
  {
    const bool is_below = cut->key(x) < cut->threshold;
    const int next = is_below ? cut->below : cut->above;
    if (next < 0)
      return is_below ? cut->first : cut->middle();
    cut = &cuts_[next];
  }
}
} // namespace amontons
