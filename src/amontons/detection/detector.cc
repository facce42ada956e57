#include "amontons/detection/detector.h"

#include "amontons/base/error.h"
#include "amontons/detection/large_vector.h"
#include "amontons/detection/pairer.h"
#include "amontons/detection/renumbered_detector.h"
#include "amontons/detection/search.h"
#include "amontons/detection/search_distance.h"
#include "amontons/detection/self_contact_roles.h"
#include "amontons/detection/visiting_order.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

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
  SurfaceDetector(const DetectionOptions &options, const Surface &impactor, const Surface &target,
                  GivenNumbers given = {})
    : options_(options)
    , impactor_(impactor)
    , given_(given)
    , target_(target)
    , search_(make_search(options.method, target.dim))
    , pairer_(impactor, target_, *search_)
    , visiting_order_(options.method == DetectionMethod::exact ? visiting_order(impactor) : std::vector<Index>{})
    , pairing_(impactor.node_ids.size())
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
  template<typename Distance>
  const Pairing &detect_by(std::span<const double> impactor_x, std::span<const double> target_x, Distance distance);
  template<int dim>
  void choose_nodes(std::span<const double> impactor_x, std::span<const double> target_x);
  void summarise();
  void summarise_self_contact();

  DetectionOptions options_;
  const Surface &impactor_;
  GivenNumbers given_; ///< of the pairs
  Target target_;
  std::unique_ptr<Search> search_;
  Pairer pairer_;
  std::vector<Index> visiting_order_; ///< of the impactor's nodes; empty: as they are numbered
  SearchDistance distance_;
  std::optional<Exclusions> exclusions_; ///< with roles_: self-contact
  std::optional<Roles> roles_;
  Pairing pairing_;
  DetectionReport report_;
  Timers timers_;
  // Kept for their memory.
  LargeVector<Index> nodes_; ///< inside the target's grown box
  std::vector<std::uint32_t> block_begins_;
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
  block_begins_.clear();
  for (Index k = 0; k < impactor_.n_nodes(); ++k)
  {
    if (k % Query::block_size == 0)
      block_begins_.push_back(static_cast<std::uint32_t>(nodes_.size()));
    const Index node = visiting_order_.empty() ? k : visiting_order_[k];
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
      pairing_[given_.node(node)] = Pairer::none(NoPairReason::outside_box);
  }
  block_begins_.push_back(static_cast<std::uint32_t>(nodes_.size()));
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
            block_begins_,
            distance_.w,
            options_.extension,
            exclusions_.has_value(),
            exclusions_ ? &*exclusions_ : nullptr};
  {
    const auto time = timers_.measure("fill");
    search_->fill(target_, query_);
  }
  search_->closest(
      target_, query_,
      [this](std::span<const Index> nodes, std::span<const Candidate> found)
      {
        const auto time = timers_.measure("projection");
        for (const Index node : nodes)
          __builtin_prefetch(&pairing_[given_.node(node)], 1);
        for (std::size_t i = 0; i < nodes.size(); ++i)
        {
          Pair &pair = pairing_[given_.node(nodes[i])];
          pairer_.pair(query_, nodes[i], found[i], pair);
          pair.face = given_.face(pair.face);
        }
      },
      timers_);
  if (roles_)
  {
    const auto time = timers_.measure("projection");
    roles_->assign(pairing_, exclusions_->node_normals());
  }
  summarise();
  return pairing_;
}

void SurfaceDetector::summarise()
{
  DetectionReport &report = report_ = DetectionReport{};
  report.method = name_of(options_.method);
  report.distance = distance_.w;
  report.distance_face = given_.face(distance_.face);
  report.seconds = timers_.seconds();
  count_pairs(pairing_, roles_.has_value(), report);
  if (roles_)
    summarise_self_contact();
  if (report.deepest_node >= 0)
  {
    const auto own = std::find(given_.nodes.begin(), given_.nodes.end(), report.deepest_node);
    const auto place = static_cast<Index>(own - given_.nodes.begin());
    const Vector3d x = point_of(query_.x, impactor_.dim, given_.nodes.empty() ? report.deepest_node : place);
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
  const auto make = [&options](const Surface &own_impactor, const Surface &own_target, GivenNumbers given)
  { return std::make_unique<SurfaceDetector>(options, own_impactor, own_target, given); };
  if (options.method == DetectionMethod::exact)
    if (auto renumbered = make_renumbered_detector(impactor, target, make))
      return renumbered;
  return make(impactor, target, {});
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
