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
  if (is_mortar())
    return mortar_report();
  DetectionReport report;
  report.method = "analytic";
  report.n_pairs = n_nodes();
  report.pairs_by_kind["face"] = n_nodes();
  return report;
}

/// @param face id of the found one
bool ContactInterface::keeps_face(Index i, const Pair &found, GlobalIndex face,
                                  std::span<const double> displacement) const
{
  const Pair &old = pairing_[i];
  // Two sides that were both impactors would hold each other twice.
  if (found.reason == NoPairReason::target_side)
    return false;
  if (old.face < 0 || face == old.face)
    return old.face >= 0;
  const double hold = n_face_changes_[i] < many_face_changes ? face_hold : tired_face_hold;
  const ContactLinearisation now = linearise_with_origin(i, displacement, displacement);
  const bool triangle = face_nodes(i).size() == 3;
  const double a = now.xi[0], b = dim_ == 2 ? 0.5 : now.xi[1];
  const double low = std::min(a, b), high = triangle ? a + b : std::max(a, b);
  if (low < -hold || high > 1 + hold)
    return false;
  return std::abs(now.gap) <= found.distance * (1 + 1e-6) || n_face_changes_[i] >= many_face_changes;
}

void ContactInterface::set_face(Index i, const Pair &pair, const Surface &target)
{
  GlobalIndex *id = faces_.ids.data() + static_cast<std::ptrdiff_t>(i) * max_face_nodes;
  std::fill_n(id, max_face_nodes, -1);
  pairing_[i] = pair;
  if (pair.face < 0)
    return;
  for (const Index node : target.face(pair.face))
    *id++ = target.node_ids[node];
  pairing_[i].face = static_cast<Index>(target.face_ids[pair.face]);
}

bool ContactInterface::take_pairs(const Pairing &found, const Surface &target, std::span<const double> displacement,
                                  bool keep)
{
  old_frames_.clear();
  bool changed = false;
  for (Index i = 0; i < n_nodes(); ++i)
  {
    const GlobalIndex face = found[i].face < 0 ? -1 : target.face_ids[found[i].face];
    const bool same = face == pairing_[i].face;
    if (!same && keep && keeps_face(i, found[i], face, displacement))
      continue;
    if (!same)
    {
      changed = true;
      ++n_face_changes_[i];
      if (pairing_[i].face >= 0 && face >= 0 && dim_ == 3)
      {
        const ContactLinearisation old = linearise_with_origin(i, displacement, displacement);
        old_frames_.push_back({i, old.normal, old.tangent});
      }
    }
    set_face(i, found[i], target);
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

ContactHistory ContactInterface::history() const
{
  const auto &ids = impactor().node_ids;
  return {{ids.begin(), ids.begin() + n_nodes()}, start_pairing_, start_faces_.ids, status_, total_slip_};
}

void ContactInterface::set_history(const ContactHistory &history)
{
  const auto n = static_cast<std::size_t>(n_nodes());
  if (history.status.size() != n || history.total_slip.size() != n * (dim_ - 1) ||
      history.pairing.size() != pairing_.size() || history.face_nodes.size() != faces_.ids.size())
    throw UserError("the checkpoint holds another number of nodes of contact '" + options_.name + "'");
  status_ = history.status;
  total_slip_ = history.total_slip;
  if (!small_) // there pairs are those of the reference, for what the loads will move
  {
    pairing_ = history.pairing;
    faces_.ids = history.face_nodes;
  }
  start_pairing_ = pairing_;
  start_faces_ = faces_;
}

std::vector<GlobalIndex> ContactInterface::wanted_nodes() const
{
  std::vector<GlobalIndex> out;
  for (const TargetFaces *faces : {&faces_, &start_faces_})
    std::copy_if(faces->ids.begin(), faces->ids.end(), std::back_inserter(out), [](GlobalIndex id) { return id >= 0; });
  if (mortar_)
    out.insert(out.end(), mortar_->targets.begin(), mortar_->targets.end());
  if (moving_mortar_)
  {
    const std::vector<GlobalIndex> nodes = moving_mortar_->wanted_nodes();
    out.insert(out.end(), nodes.begin(), nodes.end());
  }
  return out;
}

void ContactInterface::place_faces(const std::function<Index(GlobalIndex)> &position_of)
{
  const auto place = [&](const std::vector<GlobalIndex> &ids, std::vector<Index> &positions)
  {
    positions.resize(ids.size());
    std::transform(ids.begin(), ids.end(), positions.begin(),
                   [&](GlobalIndex id) { return id < 0 ? Index(-1) : position_of(id); });
  };
  for (TargetFaces *faces : {&faces_, &start_faces_})
    place(faces->ids, faces->positions);
  if (mortar_)
    place(mortar_->targets, mortar_->positions);
  if (moving_mortar_)
    moving_mortar_->place(position_of);
  if (surfaces_.whole_target && !is_mortar())
    place(surfaces_.whole_target->node_ids, smoothed_positions_);
}
} // namespace amontons
