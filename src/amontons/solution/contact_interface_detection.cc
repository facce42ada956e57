#include "amontons/contact/frame.h"
#include "amontons/solution/contact_interface.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
/// How far, in local coordinates, a projection may leave its face before the node looks for another; and how far once
/// it has changed its face often within the increment, so that a node at a vertex comes to rest.
constexpr double face_hold = 0.02, tired_face_hold = 0.1;
constexpr int many_face_changes = 4;
} // namespace

DetectionReport ContactInterface::detection_report() const
{
  if (detector_)
    return detector_->report();
  if (mortar_)
    return mortar_report_;
  DetectionReport report;
  report.method = "analytic";
  report.n_pairs = n_nodes();
  report.pairs_by_kind["face"] = n_nodes();
  return report;
}

bool ContactInterface::keeps_face(Index i, const Pair &found, std::span<const double> displacement) const
{
  const Pair &old = pairing_[i];
  // Two sides that were both impactors would hold each other twice.
  if (found.reason == NoPairReason::target_side)
    return false;
  if (old.face < 0 || found.face == old.face)
    return old.face >= 0;
  const double hold = n_face_changes_[i] < many_face_changes ? face_hold : tired_face_hold;
  const ContactLinearisation now = linearise_with_origin(i, displacement, displacement);
  const bool triangle = target_->face(old.face).size() == 3;
  const double a = now.xi[0], b = dim_ == 2 ? 0.5 : now.xi[1];
  const double low = std::min(a, b), high = triangle ? a + b : std::max(a, b);
  if (low < -hold || high > 1 + hold)
    return false;
  return std::abs(now.gap) <= found.distance * (1 + 1e-6) || n_face_changes_[i] >= many_face_changes;
}

bool ContactInterface::detect(std::span<const double> displacement, double reach, bool keep)
{
  old_frames_.clear();
  if (analytic_)
    return false;
  if (is_mortar())
  {
    couple(reach);
    return true;
  }
  std::vector<double> impactor_x(impactor_->reference), target_x(target_->reference);
  if (!small_)
    for (auto [surface, x] : {std::pair{impactor_.get(), &impactor_x}, std::pair{target_.get(), &target_x}})
      for (Index i = 0; i < surface->n_nodes(); ++i)
        for (int c = 0; c < dim_; ++c)
          (*x)[i * dim_ + c] += displacement[static_cast<std::size_t>(surface->node_ids[i]) * dim_ + c];

  const Pairing &found = detector_->detect(impactor_x, target_x, reach);
  bool changed = false;
  for (Index i = 0; i < n_nodes(); ++i)
  {
    if (found[i].face == pairing_[i].face)
    {
      pairing_[i] = found[i];
      continue;
    }
    if (keep && keeps_face(i, found[i], displacement))
      continue;
    changed = true;
    ++n_face_changes_[i];
    if (pairing_[i].face >= 0 && found[i].face >= 0 && dim_ == 3)
    {
      const ContactLinearisation old = linearise_with_origin(i, displacement, displacement);
      old_frames_.push_back({i, old.normal, old.tangent});
    }
    pairing_[i] = found[i];
  }
  return changed;
}

void ContactInterface::turn_multipliers(std::span<const double> displacement, std::span<double> multipliers)
{
  for (const OldFrame &old : old_frames_)
  {
    double *lambda = multipliers.data() + multiplier(old.node) + 1;
    const ContactLinearisation now = linearise_with_origin(old.node, displacement, displacement);
    const auto turned = carry_tangential({lambda[0], lambda[1]}, old.normal, old.tangent, now);
    std::copy_n(turned.begin(), 2, lambda);
  }
  old_frames_.clear();
}
} // namespace amontons
