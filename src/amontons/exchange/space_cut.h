#pragma once
#include "amontons/exchange/box.h"
#include "amontons/parallel/message_exchange.h"

#include <string>
#include <vector>

namespace amontons
{
/// Space cut in two again and again, across its longest extent (recursive coordinate bisection: Berger, Bokhari 1987),
/// until there are as many parts as processes: each holds as many points, of all processes taken together. Where to
/// cut is found by histograms that are summed up; no process sees another's points, all know all cuts.
///
/// Cuts are tilted by a thousandth, so that the rows of a regular mesh can be parted too.
class SpaceCut
{
public:
  /// Collective. @param points of this process that count as work: nodes to be sought, faces to be looked at
  /// @param phase under which messages are counted
  SpaceCut(MessageExchange &messages, const std::string &phase, std::span<const Place> points);

  /// The part that a place belongs to; every place belongs to one.
  [[nodiscard]] Rank part_of(const Place &x) const;

private:
  struct Cut
  {
    Rank first = 0, last = 0; ///< parts on both sides: [first, last)
    Place direction{0, 0, 0};
    double offset = 0;
    double threshold = 0;       ///< parts below have direction . x - offset less than this
    int below = -1, above = -1; ///< cuts; -1: a part
    [[nodiscard]] Rank middle() const { return first + (last - first) / 2; }
    [[nodiscard]] double key(const Place &x) const
    {
      return direction[0] * x[0] + direction[1] * x[1] + direction[2] * x[2] - offset;
    }
  };
  struct Bracket;
  void aim(MessageExchange &messages, const std::string &phase, std::span<const Place> points,
           const std::vector<int> &cut_of_point, int first_cut);
  void find_thresholds(MessageExchange &messages, const std::string &phase, std::span<const Place> points,
                       const std::vector<int> &cut_of_point, int first_cut);
  void divide(int first_cut, std::span<const Place> points, std::vector<int> &cut_of_point);

  std::vector<Cut> cuts_; ///< level by level; none where there is one process
};
} // namespace amontons
