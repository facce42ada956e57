#pragma once
#include "amontons/detection/closest_feature.h"
#include "amontons/detection/search.h"
#include "amontons/surface/pairing.h"
#include "amontons/surface/surface.h"

#include <Eigen/Core>

#include <vector>

namespace amontons
{
/// Makes a pair of the closest point that a search has found for a node, by the rules of sides and ends (detector.h);
/// where that point does not do, of the next local minimum of the distance that does.
class Pairer
{
public:
  /// All must outlive it.
  Pairer(const Surface &impactor, const Target &target, Search &search)
    : impactor_(impactor)
    , target_(target)
    , search_(search)
  {
  }

  void pair(const Query &query, Index node, const Candidate &closest, Pair &result)
  {
    query_ = &query;
    if (!pair_above_face(node, closest, result))
      result = pair_of(node, closest);
  }

  static Pair none(NoPairReason reason);

private:
  enum class Verdict
  {
    taken,
    past_end,
    behind,
    obstructed
  };

  bool pair_above_face(Index node, const Candidate &closest, Pair &pair) const;
  Pair pair_of(Index node, const Candidate &closest);
  Pair next_best(Index node, const Eigen::Vector3d &x, double squared_distance);
  Pair best_of_considered(Index node, const Eigen::Vector3d &x, NoPairReason &reason);
  Verdict judge(const Feature &feature, Index node);
  bool is_obstructed(const Feature &feature, Index node);
  bool own_wall_within(double distance, Index node);
  bool is_behind(Index face, LocalPoint xi, double distance, Index node) const;

  const Surface &impactor_;
  const Target &target_;
  Search &search_;
  const Query *query_ = nullptr;               ///< of the pair that is being made
  std::vector<Candidate> considered_, nearer_; ///< kept for their memory
};
} // namespace amontons
