#include "amontons/contact/kinematics.h"
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
  if (!small_)
    throw UserError(options_.where, contact + "goes with 'strain: small'; in finite strain take node-to-face");
  if (analytic_)
    throw UserError(options_.where, contact + "wants faces on both sides, and '" + options_.target +
                                        "' is an analytic body; mesh it, or take node-to-face");
  if (options_.is_self_contact())
    throw UserError(options_.where, contact + "wants two sides; where a surface touches itself take node-to-face");
}

void ContactInterface::couple(double reach)
{
  const double w = mortar_distance_.value_or(reach);
  const FaceBoxes boxes(*target_, target_->reference);
  mortar_ =
      couple_mortar({*impactor_, impactor_->reference}, {*target_, target_->reference}, axisymmetric_, w,
                    [&](const Eigen::AlignedBox3d &box, std::vector<Index> &faces) { boxes.meeting(box, faces); });
  if (const Index f = mortar_->doubled_face; f >= 0)
  {
    const FaceCoordinates face = gather_face(dim_, impactor_->face(f), impactor_->reference);
    const Eigen::Vector3d middle = face_point(face, face_centre(face));
    throw UserError(options_.where, "contact '" + options_.name + "': the impactor's face at (" +
                                        std::to_string(middle.x()) + ", " + std::to_string(middle.y()) + ", " +
                                        std::to_string(middle.z()) +
                                        ") sees two layers of the target, which mortar cannot tell apart; set "
                                        "'detection: distance' below the distance of the farther one, now " +
                                        std::to_string(w));
  }
  for (Index i = 0; i < n_nodes(); ++i)
    if (mortar_->sees_target(i))
      areas_[i] = mortar_->area[i];
  report_mortar(w);
}

void ContactInterface::report_mortar(double w)
{
  DetectionReport &report = mortar_report_;
  report = {};
  report.method = "mortar";
  report.distance = w;
  const std::vector<double> still(static_cast<std::size_t>(mesh_.n_nodes()) * dim_, 0.0);
  for (Index i = 0; i < n_nodes(); ++i)
  {
    if (!mortar_->sees_target(i))
      continue;
    ++report.n_pairs;
    const double gap = linearise_with_origin(i, still, still).gap;
    if (gap > -round_off * w)
      continue;
    ++report.n_penetrations;
    if (gap >= report.deepest)
      continue;
    report.deepest = gap;
    report.deepest_node = i;
    std::copy_n(impactor_->reference.begin() + static_cast<std::ptrdiff_t>(i) * dim_, dim_,
                report.deepest_point.begin());
  }
  report.pairs_by_kind["mortar"] = report.n_pairs;
  report.unpaired_by_reason["uncovered"] = n_nodes() - report.n_pairs;
}
} // namespace amontons
