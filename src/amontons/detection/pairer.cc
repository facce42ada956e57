#include "amontons/detection/pairer.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

// Cosine above which the impactor's and the face's normals point the same way.
constexpr double same_way = 0.5;
// Depth below which a node lies on the surface, in units of w.
constexpr double on_surface = 1e-9;
} // namespace

Pair Pairer::none(NoPairReason reason)
{
  Pair result;
  result.reason = reason;
  return result;
}

// Whether a node seen from inside the face has come through a thin body.
bool Pairer::is_behind(Index face, LocalPoint xi, double distance, Index node) const
{
  if (distance <= on_surface * query_->w || impactor_.node_face_offsets.size() != impactor_.node_ids.size() + 1)
    return false;
  const auto normal_of = [](const FaceCoordinates &x, LocalPoint at)
  {
    const auto tangents = face_tangents(x, at);
    return Vector3d(tangents[0].cross(tangents[1]));
  };
  const auto own_normal = [&](Index f) {
    return normal_of(gather_face(impactor_.dim, impactor_.face(f), query_->x), {0.5, 0.5});
  };
  // Mostly none of the node's faces faces the way of this one, which takes no roots to tell.
  const Vector3d normal = normal_of(target_.face(face), xi);
  const auto own = impactor_.faces_of_node(node);
  if (std::none_of(own.begin(), own.end(), [&](Index f) { return own_normal(f).dot(normal) > 0; }))
    return false;
  Vector3d sum = Vector3d::Zero();
  for (const Index f : own)
    sum += own_normal(f).normalized();
  return sum.normalized().dot(normal.normalized()) > same_way;
}

// Self-contact: whether the far side of the node's own wall is that near.
bool Pairer::own_wall_within(double distance, Index node)
{
  Query all = *query_;
  all.exclusions = nullptr;
  all.extension = distance; // not only minima: at the wall's end there need not be one
  nearer_.clear();
  search_.minima(target_, all, node, distance, nearer_);
  return std::any_of(nearer_.begin(), nearer_.end(),
                     [&](const Candidate &candidate) { return query_->exclusions->is_far_side(node, candidate.face); });
}

// Self-contact: whether something hidden lies between the node and what it sees.
bool Pairer::is_obstructed(const Feature &feature, Index node)
{
  const Pair &pair = feature.pair;
  if (!feature.inside)
    return pair.gap < -on_surface * query_->w || pair.distance > query_->exclusions->distance_in_crease(node);
  return own_wall_within(pair.distance, node);
}

Pairer::Verdict Pairer::judge(const Feature &feature, Index node)
{
  if (feature.pair.kind == PairKind::extension)
    if (feature.overhang > query_->extension.value_or(default_extension * feature.extent))
      return Verdict::past_end;
  if (feature.inside && is_behind(feature.pair.face, feature.closest, feature.pair.distance, node))
    return Verdict::behind;
  return query_->exclusions && is_obstructed(feature, node) ? Verdict::obstructed : Verdict::taken;
}

// What most nodes are: above the inside of a face, or below it and not through a thin body. @return whether it is
bool Pairer::pair_above_face(Index node, const Candidate &closest, Pair &pair) const
{
  if (query_->exclusions || closest.face < 0 || !is_inside_face(target_, closest))
    return false;
  const double distance = std::sqrt(closest.squared_distance);
  if (closest.gap < 0 && is_behind(closest.face, closest.xi, distance, node))
    return false;
  pair.face = closest.face;
  pair.xi[0] = closest.xi[0]; // one by one, as they have just been written
  pair.xi[1] = closest.xi[1];
  pair.gap = closest.gap;
  pair.distance = distance;
  pair.kind = PairKind::face;
  pair.reason = NoPairReason::paired;
  return true;
}

Pair Pairer::pair_of(Index node, const Candidate &closest)
{
  if (closest.face < 0)
    return none(NoPairReason::too_far);
  const Vector3d x = point_of(query_->x, impactor_.dim, node);
  const Feature feature = look_at(target_, closest, x, false, {query_->exclusions, node});
  // Of all faces the closest point is a minimum; of those that are not hidden it may lie on the rim of the hidden.
  const bool is_minimum = feature.is_minimum || !query_->exclusions;
  return is_minimum && judge(feature, node) == Verdict::taken ? feature.pair
                                                              : next_best(node, x, closest.squared_distance);
}

// The closest point is not one to pair with: the next local minimum of the distance that is, sought in growing balls.
Pair Pairer::next_best(Index node, const Vector3d &x, double squared_distance)
{
  Pair pair;
  // Without exclusions the closest point of all is a minimum, which the search may have left out for being past an end.
  NoPairReason reason = query_->exclusions ? NoPairReason::too_far : NoPairReason::past_end;
  double done = -1;
  for (double radius = 2 * std::sqrt(squared_distance);; radius *= 2)
  {
    const double bounded = std::clamp(radius, 1e-3 * query_->w, query_->w);
    considered_.clear();
    search_.minima(target_, *query_, node, bounded, considered_);
    std::sort(considered_.begin(), considered_.end(),
              [this](const Candidate &a, const Candidate &b) { return comes_before(target_.surface(), a, b); });
    // Those of the last, smaller ball did not do.
    std::erase_if(considered_, [done](const Candidate &candidate) { return candidate.squared_distance <= done; });
    done = bounded * bounded;
    pair = best_of_considered(node, x, reason);
    if (pair.kind != PairKind::none || bounded == query_->w)
      return pair;
    radius = bounded;
  }
}

// Once a node is seen to have come through a thin body (`behind`), only points seen from inside count.
Pair Pairer::best_of_considered(Index node, const Vector3d &x, NoPairReason &reason)
{
  for (const Candidate &candidate : considered_)
  {
    const Feature feature = look_at(target_, candidate, x, true, {query_->exclusions, node});
    if (!feature.is_minimum)
      continue;
    const Verdict verdict = judge(feature, node);
    if (verdict == Verdict::behind)
      reason = NoPairReason::behind;
    else if (reason != NoPairReason::behind)
      reason = NoPairReason::past_end;
    if (verdict == Verdict::taken && (feature.inside || reason != NoPairReason::behind))
      return feature.pair;
  }
  return none(reason);
}
} // namespace amontons
