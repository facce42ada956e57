#include "amontons/contact/kinematics.h"
#include "amontons/contact/mortar.h"
#include "amontons/detection/face_boxes.h"
#include "amontons/solution/contact_interface.h"
#include "amontons/surface/projection.h"

#include <algorithm>

namespace amontons
{
namespace
{
/// Of the detection distance: means over faces that touch are no overlaps.
constexpr double round_off = 1e-12;
} // namespace

void ContactInterface::require_meshed_sides() const
{
  const std::string contact = "contact '" + options_.name + "': 'discretization: mortar' ";
  if (analytic_)
    throw UserError(options_.where, contact + "wants faces on both sides, and '" + options_.target +
                                        "' is an analytic body; mesh it, or take node-to-face");
  if (options_.is_self_contact())
    throw UserError(options_.where, contact + "wants two sides; where a surface touches itself take node-to-face");
}

bool ContactInterface::start_mortar(std::span<const double> start, double reach)
{
  moving_mortar_->set_reach(reach);
  moving_mortar_->move_to(start);
  moving_mortar_->begin_increment();
  return moving_mortar_->take_nodes(true);
}

void ContactInterface::keep_in_sight(double deepest)
{
  if (moving_mortar_)
    moving_mortar_->set_least_distance(options_.tied ? moving_mortar_->distance() : 2 * deepest);
}

bool ContactInterface::couple(std::span<const double> displacement, double reach)
{
  if (moving_mortar_)
  {
    moving_mortar_->set_reach(reach);
    moving_mortar_->move_to(displacement);
    return moving_mortar_->take_nodes(false);
  }
  couple_reference(reach);
  return true;
}

void ContactInterface::couple_reference(double reach)
{
  const double w = mortar_distance_.value_or(reach);
  const Surface &impactor = *surfaces_.whole_impactor, &target = *surfaces_.whole_target;
  const FaceBoxes boxes(target, target.reference);
  const MortarCoupling whole =
      couple_mortar({impactor, impactor.reference}, {target, target.reference}, axisymmetric_, w,
                    [&](const Eigen::AlignedBox3d &box, std::vector<Index> &faces) { boxes.meeting(box, faces); });
  MortarMeans &means = mortar_.emplace();
  for (Index i = 0; i < n_nodes(); ++i)
  {
    const auto place =
        std::lower_bound(impactor.node_ids.begin(), impactor.node_ids.end(), this->impactor().node_ids[i]);
    const auto j = static_cast<Index>(place - impactor.node_ids.begin());
    means.sees.push_back(whole.sees_target(j) ? 1 : 0);
    means.normal.push_back(whole.normal[j]);
    for (const Index node : whole.targets_of(j))
      means.targets.push_back(target.node_ids[node]);
    const auto weights = whole.weights_of(j);
    means.weight.insert(means.weight.end(), weights.begin(), weights.end());
    means.offsets.push_back(static_cast<Index>(means.targets.size()));
    if (whole.sees_target(j))
      areas_[i] = whole.area[j];
  }
  mortar_distance_ = w;
  surfaces_.whole_impactor.reset();
  surfaces_.whole_target.reset();
}

std::vector<double> ContactInterface::covered_areas() const
{
  std::vector<double> out = areas_;
  if (!moving_mortar_)
    return out;
  const std::vector<double> shares = moving_mortar_->covered_shares();
  for (Index i = 0; i < n_nodes(); ++i)
    if (paired(i))
      out[i] *= shares[i];
  return out;
}

DetectionReport ContactInterface::mortar_report() const
{
  DetectionReport report;
  report.method = "mortar";
  report.distance = moving_mortar_ ? moving_mortar_->distance() : mortar_distance_.value();
  const std::vector<double> still(points_.size(), 0.0);
  for (Index i = 0; i < n_nodes(); ++i)
  {
    if (!paired(i))
      continue;
    ++report.n_pairs;
    const double depth = gap(i, still) + gap_offset_[i];
    if (depth > -round_off * report.distance)
      continue;
    ++report.n_penetrations;
    if (depth >= report.deepest)
      continue;
    report.deepest = depth;
    report.deepest_node = i;
    std::copy_n(impactor().reference.begin() + static_cast<std::ptrdiff_t>(i) * dim_, dim_,
                report.deepest_point.begin());
  }
  report.pairs_by_kind["mortar"] = report.n_pairs;
  report.unpaired_by_reason["uncovered"] = n_nodes() - report.n_pairs;
  return report;
}
} // namespace amontons
