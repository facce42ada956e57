#include "amontons/detection/detector.h"

#include "amontons/base/error.h"
#include "amontons/detection/renumbered_detector.h"
#include "amontons/detection/search.h"
#include "amontons/detection/search_distance.h"
#include "amontons/detection/self_contact_roles.h"

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

Pair no_pair(NoPairReason reason)
{
  Pair none;
  none.reason = reason;
  return none;
}

std::unique_ptr<Search> make_search(DetectionMethod method, int dim)
{
  switch (method)
  {
  case DetectionMethod::brute:
    return make_brute_search();
  case DetectionMethod::nearest_node:
    return make_nearest_node_search();
  case DetectionMethod::exact:
    break;
  }
  return make_tree_search(dim);
}

class SurfaceDetector : public Detector
{
public:
  SurfaceDetector(const DetectionOptions &options, const Surface &impactor, const Surface &target)
    : options_(options)
    , impactor_(impactor)
    , target_(target)
    , search_(make_search(options.method, target.dim))
    , pairing_(impactor.node_ids.size())
    , candidates_(impactor.node_ids.size())
  {
    AMONTONS_ASSERT(impactor.dim == target.dim);
    if (options_.extension && !(*options_.extension >= 0 && std::isfinite(*options_.extension)))
      throw UserError("the detection's extension must be a length, zero or more");
  }

  /// Impactor and target are the same surface.
  void set_self_contact(std::optional<double> self_distance, bool with_roles)
  {
    exclusions_.emplace(impactor_, self_distance);
    if (with_roles)
      roles_.emplace(impactor_);
  }

  const Pairing &detect(std::span<const double> impactor_x, std::span<const double> target_x, double reach) override
  {
    return detect_by(impactor_x, target_x, [&] { return search_distance(target_, options_, reach); });
  }
  const Pairing &detect_within(std::span<const double> impactor_x, std::span<const double> target_x, double w) override
  {
    return detect_by(impactor_x, target_x, [w] { return SearchDistance{w, -1}; });
  }
  [[nodiscard]] DetectionReport report() const override { return report_; }

private:
  enum class Verdict
  {
    taken,
    past_end,
    behind,
    obstructed
  };

  template<typename Distance>
  const Pairing &detect_by(std::span<const double> impactor_x, std::span<const double> target_x, Distance distance);
  template<int dim>
  void choose_nodes(std::span<const double> impactor_x, std::span<const double> target_x);
  Verdict judge(const Feature &feature, Index node);
  bool is_obstructed(const Feature &feature, Index node);
  bool own_wall_within(double distance, Index node);
  Vector3d impactor_normal(Index node) const;
  Pair pair_of(Index node);
  Pair next_best(Index node, const Vector3d &x);
  Pair best_of_considered(Index node, const Vector3d &x, NoPairReason &reason);
  void summarise();
  void summarise_self_contact();

  DetectionOptions options_;
  const Surface &impactor_;
  Target target_;
  std::unique_ptr<Search> search_;
  SearchDistance distance_;
  std::optional<Exclusions> exclusions_; ///< with roles_: self-contact
  std::optional<Roles> roles_;
  Pairing pairing_;
  DetectionReport report_;
  Timers timers_;
  // Kept for their memory.
  std::vector<Candidate> candidates_; ///< closest face per impactor node; a hint for the next detection
  std::vector<Index> nodes_;          ///< inside the target's grown box
  std::vector<Candidate> considered_, nearer_;
  Query query_;
};

// Nodes inside the target's box grown by w; the others are done with.
template<int dim>
void SurfaceDetector::choose_nodes(std::span<const double> impactor_x, std::span<const double> target_x)
{
  std::array<double, dim> low, high, sums{};
  low.fill(INFINITY);
  high.fill(-INFINITY);
  for (std::size_t i = 0; i < target_x.size(); i += dim)
    for (int c = 0; c < dim; ++c)
    {
      const double x = target_x[i + c];
      low[c] = x < low[c] ? x : low[c];
      high[c] = x > high[c] ? x : high[c];
      sums[c] += x;
    }
  nodes_.clear();
  nodes_.reserve(pairing_.size());
  for (Index node = 0; node < impactor_.n_nodes(); ++node)
  {
    const double *x = impactor_x.data() + static_cast<std::ptrdiff_t>(node) * dim;
    bool inside = true;
    for (int c = 0; c < dim; ++c)
    {
      sums[c] += x[c];
      inside = inside && x[c] >= low[c] - distance_.w && x[c] <= high[c] + distance_.w;
    }
    if (inside)
      nodes_.push_back(node);
    else
    {
      pairing_[node] = no_pair(NoPairReason::outside_box);
      candidates_[node].face = -1;
    }
  }
  if (!std::all_of(sums.begin(), sums.end(), [](double sum) { return std::isfinite(sum); }))
    throw NumericalFailure("contact detection: the nodes' positions are not finite");
}

template<typename Distance>
const Pairing &SurfaceDetector::detect_by(std::span<const double> impactor_x, std::span<const double> target_x,
                                          Distance distance)
{
  AMONTONS_ASSERT(impactor_x.size() == impactor_.node_ids.size() * impactor_.dim);
  AMONTONS_ASSERT(target_x.size() == target_.surface().node_ids.size() * impactor_.dim);
  timers_ = Timers();
  target_.move_to(target_x);
  {
    const auto time = timers_.measure("bounds");
    distance_ = distance();
    if (impactor_.dim == 2)
      choose_nodes<2>(impactor_x, target_x);
    else
      choose_nodes<3>(impactor_x, target_x);
  }
  if (exclusions_)
    exclusions_->move_to(target_x);
  query_ = {impactor_x,
            nodes_,
            distance_.w,
            options_.extension,
            exclusions_.has_value(),
            exclusions_ ? &*exclusions_ : nullptr};
  {
    const auto time = timers_.measure("fill");
    search_->fill(target_, query_);
  }
  search_->closest(target_, query_, candidates_, timers_);
  {
    const auto time = timers_.measure("projection");
    for (const Index node : nodes_)
      pairing_[node] = pair_of(node);
    if (roles_)
      roles_->assign(pairing_, exclusions_->node_normals());
  }
  summarise();
  return pairing_;
}

// Mean of the impactor's faces at the node, in the current geometry; zero where it has none.
Vector3d SurfaceDetector::impactor_normal(Index node) const
{
  Vector3d normal = Vector3d::Zero();
  if (impactor_.node_face_offsets.size() == impactor_.node_ids.size() + 1)
    for (const Index f : impactor_.faces_of_node(node))
      normal += face_normal(gather_face(impactor_.dim, impactor_.face(f), query_.x), {0.5, 0.5});
  return normal.normalized();
}

// Self-contact: whether the far side of the node's own wall is that near.
bool SurfaceDetector::own_wall_within(double distance, Index node)
{
  Query all = query_;
  all.exclusions = nullptr;
  all.extension = distance; // not only minima: at the wall's end there need not be one
  nearer_.clear();
  search_->minima(target_, all, node, distance, nearer_);
  return std::any_of(nearer_.begin(), nearer_.end(),
                     [&](const Candidate &candidate) { return exclusions_->is_far_side(node, candidate.face); });
}

// Self-contact: whether something hidden lies between the node and what it sees.
bool SurfaceDetector::is_obstructed(const Feature &feature, Index node)
{
  const Pair &pair = feature.pair;
  if (!feature.inside)
    return pair.gap < -on_surface * distance_.w || pair.distance > exclusions_->distance_in_crease(node);
  return own_wall_within(pair.distance, node);
}

SurfaceDetector::Verdict SurfaceDetector::judge(const Feature &feature, Index node)
{
  if (feature.pair.kind == PairKind::extension)
    if (feature.overhang > options_.extension.value_or(default_extension * feature.extent))
      return Verdict::past_end;
  if (feature.inside && feature.pair.distance > on_surface * distance_.w &&
      impactor_normal(node).dot(feature.normal) > same_way)
    return Verdict::behind;
  return exclusions_ && is_obstructed(feature, node) ? Verdict::obstructed : Verdict::taken;
}

Pair SurfaceDetector::pair_of(Index node)
{
  const Candidate &closest = candidates_[node];
  if (closest.face < 0)
    return no_pair(NoPairReason::too_far);
  const Vector3d x = point_of(query_.x, impactor_.dim, node);
  const Feature feature = look_at(target_, closest, x, false, {query_.exclusions, node});
  // Of all faces the closest point is a minimum; of those that are not hidden it may lie on the rim of the hidden.
  const bool is_minimum = feature.is_minimum || !query_.exclusions;
  return is_minimum && judge(feature, node) == Verdict::taken ? feature.pair : next_best(node, x);
}

// The closest point is not one to pair with: the next local minimum of the distance that is, sought in growing balls.
Pair SurfaceDetector::next_best(Index node, const Vector3d &x)
{
  Pair pair;
  // Without exclusions the closest point of all is a minimum, which the search may have left out for being past an end.
  NoPairReason reason = exclusions_ ? NoPairReason::too_far : NoPairReason::past_end;
  double done = -1;
  for (double radius = 2 * std::sqrt(candidates_[node].squared_distance);; radius *= 2)
  {
    const double bounded = std::clamp(radius, 1e-3 * distance_.w, distance_.w);
    considered_.clear();
    search_->minima(target_, query_, node, bounded, considered_);
    std::sort(considered_.begin(), considered_.end(),
              [this](const Candidate &a, const Candidate &b) { return comes_before(target_.surface(), a, b); });
    // Those of the last, smaller ball did not do.
    std::erase_if(considered_, [done](const Candidate &candidate) { return candidate.squared_distance <= done; });
    done = bounded * bounded;
    pair = best_of_considered(node, x, reason);
    if (pair.kind != PairKind::none || bounded == distance_.w)
      return pair;
    radius = bounded;
  }
}

// Once a node is seen to have come through a thin body (`behind`), only points seen from inside count.
Pair SurfaceDetector::best_of_considered(Index node, const Vector3d &x, NoPairReason &reason)
{
  for (const Candidate &candidate : considered_)
  {
    const Feature feature = look_at(target_, candidate, x, true, {query_.exclusions, node});
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
  return no_pair(reason);
}

void SurfaceDetector::summarise()
{
  DetectionReport &report = report_ = DetectionReport{};
  report.method = name_of(options_.method);
  report.distance = distance_.w;
  report.distance_face = distance_.face;
  report.seconds = timers_.seconds();
  count_pairs(pairing_, roles_.has_value(), report);
  if (roles_)
    summarise_self_contact();
  if (report.deepest_node >= 0)
  {
    const Vector3d x = point_of(query_.x, impactor_.dim, report.deepest_node);
    report.deepest_point = {x.x(), x.y(), x.z()};
  }
}

void SurfaceDetector::summarise_self_contact()
{
  SelfContactReport &report = report_.self_contact.emplace();
  report.n_zones = roles_->n_zones();
  report.n_excluded = static_cast<double>(exclusions_->n_near()) / std::max(impactor_.n_nodes(), 1);
  for (Index node = 0; node < impactor_.n_nodes(); ++node)
  {
    const double distance = exclusions_->self_distance(node);
    report.least_distance = node == 0 ? distance : std::min(report.least_distance, distance);
    report.greatest_distance = std::max(report.greatest_distance, distance);
  }
}
} // namespace

std::unique_ptr<Detector> make_detector(const DetectionOptions &options, const Surface &impactor, const Surface &target)
{
  const auto make = [&options](const Surface &own_impactor, const Surface &own_target)
  { return std::make_unique<SurfaceDetector>(options, own_impactor, own_target); };
  if (options.method == DetectionMethod::exact)
    if (auto renumbered = make_renumbered_detector(impactor, target, make))
      return renumbered;
  return make(impactor, target);
}

std::unique_ptr<Detector> make_self_detector(const DetectionOptions &options, const Surface &surface,
                                             std::optional<double> self_distance)
{
  auto detector = std::make_unique<SurfaceDetector>(options, surface, surface);
  detector->set_self_contact(self_distance, true);
  return detector;
}

std::unique_ptr<Detector> make_sight_detector(const DetectionOptions &options, const Surface &surface,
                                              std::optional<double> self_distance)
{
  auto detector = std::make_unique<SurfaceDetector>(options, surface, surface);
  detector->set_self_contact(self_distance, false);
  return detector;
}
} // namespace amontons
