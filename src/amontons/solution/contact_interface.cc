#include "amontons/solution/contact_interface.h"

#include "amontons/contact/frame.h"
#include "amontons/contact/kinematics.h"
#include "amontons/surface/normals.h"
#include "amontons/surface/projection.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace amontons
{
namespace
{
/// A gap below this fraction of the local size counts as touching when the run starts.
constexpr double touching = 1e-9;
/// Edges of the target sharper than this stay sharp where normals are smoothed.
constexpr double sharp_angle = 3.14159265358979323846 / 6;
} // namespace

MeanStiffness::MeanStiffness(std::span<const double> diagonal, std::span<const Index> nodes, int dim)
{
  for (const Index node : nodes)
    for (int c = 0; c < dim; ++c)
      if (const double k = diagonal[static_cast<std::size_t>(node) * dim + c]; k > 0)
      {
        sum += k;
        ++n;
      }
}

ContactInterface::ContactInterface(const std::vector<double> &points, Kinematics kinematics, Strain strain,
                                   const ContactOptions &options, const DetectionOptions &detection,
                                   ContactSurfaces surfaces, const RigidBody *analytic_target)
  : points_(points)
  , dim_(surfaces.impactor.dim)
  , axisymmetric_(kinematics == Kinematics::axisymmetric)
  , small_(strain == Strain::small)
  , options_(options)
  , surfaces_(std::move(surfaces))
{
  if (analytic_target)
  {
    analytic_ = analytic_target->shape;
    shape_node_ = analytic_target->nodes.front();
  }
  if (is_mortar())
  {
    mortar_distance_ = detection.distance;
    require_meshed_sides();
    if (!small_)
      moving_mortar_.emplace(surfaces_.whole_impactor, surfaces_.whole_target, axisymmetric_,
                             std::span(impactor().node_ids).first(static_cast<std::size_t>(n_nodes())),
                             detection.distance);
  }
  const auto n = static_cast<std::size_t>(n_nodes());
  pairing_.resize(n);
  faces_.ids.assign(n * max_face_nodes, -1);
  faces_.positions.assign(n * max_face_nodes, -1);
  areas_.assign(n, 0);
  augmentation_.assign(n, 1);
  n_face_changes_.assign(n, 0);
  slip_origin_.assign(n, Eigen::Vector3d::Zero());
  has_origin_.assign(n, 0);
  start_gap_.assign(n, 0);
  gap_offset_.assign(n, 0);
  left_out_.assign(n, 0);
  total_slip_.assign(n * (dim_ - 1), 0);
  status_.assign(n, ContactStatus::open);
}

void ContactInterface::share(std::shared_ptr<MessageExchange> messages)
{
  std::vector<char> is_own(surfaces_.nodes.size(), 0);
  std::fill_n(is_own.begin(), n_nodes(), 1);
  surfaces_.sharing = Sharing(std::move(messages), "model", impactor().node_ids, is_own);
}

void ContactInterface::set_augmentation(std::span<const double> diagonal, double on_target)
{
  for (Index i = 0; i < n_nodes(); ++i)
  {
    const MeanStiffness at_node(diagonal, {&surfaces_.nodes[i], 1}, dim_);
    const double r = at_node.sum > 0 ? at_node.sum / at_node.n : on_target;
    if (r <= 0)
      throw UserError(options_.where, "both sides of contact '" + options_.name + "' are rigid; one must deform");
    augmentation_[i] = options_.augmentation * r;
  }
}

std::span<const Index> ContactInterface::face_nodes(Index i) const
{
  const Index *first = faces_.positions.data() + static_cast<std::ptrdiff_t>(i) * max_face_nodes;
  return {first, std::find(first, first + max_face_nodes, -1)};
}

std::vector<Index> ContactInterface::nodes(Index i) const
{
  if (moving_mortar_)
    return moving_mortar_->nodes(i);
  std::vector<Index> out{node(i)};
  const auto add = [&](std::span<const Index> targets) { out.insert(out.end(), targets.begin(), targets.end()); };
  if (analytic_)
    out.push_back(shape_node_);
  else if (mortar_)
    add(mortar_->of(mortar_->positions, i));
  else if (pairing_[i].face >= 0)
    add(face_nodes(i));
  return out;
}

/// Small strain: what each target node counts in the mean that the impactor node is held against.
std::vector<double> ContactInterface::target_weights(Index i) const
{
  if (analytic_)
    return {1};
  if (mortar_)
  {
    const auto weights = mortar_->of(mortar_->weight, i);
    return {weights.begin(), weights.end()};
  }
  const auto n = face_nodes(i).size();
  const auto shape = shape_functions(static_cast<int>(n), pairing_[i].xi);
  return {shape.begin(), shape.begin() + static_cast<std::ptrdiff_t>(n)};
}

void ContactInterface::gather(std::span<const Index> nodes, std::span<const double> displacement,
                              std::span<double> out) const
{
  std::size_t k = 0;
  for (const Index node : nodes)
    for (int c = 0; c < dim_; ++c)
      out[k++] = displacement[static_cast<std::size_t>(node) * dim_ + c];
}

void ContactInterface::add_reference(std::span<const Index> nodes, std::span<double> out) const
{
  std::size_t k = 0;
  for (const Index node : nodes)
    for (int c = 0; c < dim_; ++c)
      out[k++] += node == shape_node_ ? analytic_->point[c] : points_[static_cast<std::size_t>(node) * dim_ + c];
}

Eigen::Vector3d ContactInterface::relative(Index i, std::span<const double> displacement) const
{
  const std::vector<Index> ids = nodes(i);
  const std::vector<double> weights = target_weights(i);
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (int c = 0; c < dim_; ++c)
  {
    out[c] = displacement[static_cast<std::size_t>(ids[0]) * dim_ + c];
    for (std::size_t k = 0; k < weights.size(); ++k)
      out[c] -= weights[k] * displacement[static_cast<std::size_t>(ids[k + 1]) * dim_ + c];
  }
  return out;
}

bool ContactInterface::begin_increment(std::span<const double> start, double reach)
{
  const auto same_face = [](const Pair &a, const Pair &b) { return a.face == b.face; };
  bool changed =
      !start_pairing_.empty() && !std::equal(pairing_.begin(), pairing_.end(), start_pairing_.begin(), same_face);
  if (changed)
  {
    pairing_ = start_pairing_;
    faces_ = start_faces_;
  }
  if (moving_mortar_)
    changed = start_mortar(start, reach);
  smooth_target_normals(start);
  for (Index i = 0; i < n_nodes(); ++i)
  {
    n_face_changes_[i] = 0;
    has_origin_[i] = 0;
    if (!paired(i))
      continue;
    slip_origin_[i] = Eigen::Vector3d::Zero();
    if (small_)
      slip_origin_[i] = relative(i, start);
    else
    {
      gather({&surfaces_.nodes[i], 1}, start, {slip_origin_[i].data(), 3});
      add_reference({&surfaces_.nodes[i], 1}, {slip_origin_[i].data(), 3});
    }
    start_gap_[i] = gap(i, start);
    const double size = std::pow(areas_[i], 1.0 / (dim_ - 1));
    has_origin_[i] = options_.tied || status_[i] != ContactStatus::open || start_gap_[i] <= touching * size;
  }
  return changed;
}

void ContactInterface::smooth_target_normals(std::span<const double> start)
{
  if (!surfaces_.whole_target || is_mortar())
    return;
  const Surface &target = *surfaces_.whole_target;
  std::vector<double> x(target.reference);
  for (Index i = 0; i < target.n_nodes(); ++i)
    for (int c = 0; c < dim_; ++c)
      x[i * dim_ + c] += start[static_cast<std::size_t>(smoothed_positions_[i]) * dim_ + c];
  target_normals_ = smoothed_normals(target, x, sharp_angle);
}

std::span<const double> ContactInterface::normals_of_face(Index i) const
{
  if (target_normals_.empty())
    return {};
  const Surface &target = *surfaces_.whole_target;
  const auto face = std::lower_bound(target.face_ids.begin(), target.face_ids.end(), pairing_[i].face);
  const auto f = face - target.face_ids.begin();
  const auto first = static_cast<std::size_t>(target.face_offsets[f]) * dim_;
  const auto end = static_cast<std::size_t>(target.face_offsets[f + 1]) * dim_;
  return {target_normals_.data() + first, end - first};
}

ContactLinearisation ContactInterface::linearise_with_origin(Index i, std::span<const double> displacement,
                                                             std::span<const double> start) const
{
  const std::vector<Index> all = nodes(i);
  const auto d = static_cast<std::size_t>(dim_);
  const std::size_t size = all.size() * d, rest = size - d;
  std::vector<double> now(size), then(size, 0.0);
  const std::span<const double> origin{slip_origin_[i].data(), d};

  ContactLinearisation out;
  if (moving_mortar_)
    out = moving_mortar_->linearise(i);
  else if (small_)
  {
    add_reference(all, then);
    gather(all, displacement, now);
    const std::span<const double> own{then.data(), d}, targets{then.data() + d, rest};
    if (analytic_)
      out = linearise_shape_small(dim_, axisymmetric_, *analytic_, own, now, origin);
    else if (mortar_)
      out = linearise_mean(dim_, mortar_->normal[i], own, targets, mortar_->of(mortar_->weight, i), now, origin);
    else
      out = linearise_small(dim_, own, targets, now, origin, pairing_[i].xi);
  }
  else
  {
    gather(all, displacement, now);
    add_reference(all, now);
    gather(all, start, then);
    add_reference(all, then);
    out = analytic_ ? linearise_shape(dim_, axisymmetric_, *analytic_, {now.data(), d}, {now.data() + d, d}, origin,
                                      {then.data() + d, d})
                    : linearise_finite(dim_, {now.data(), d}, {now.data() + d, rest}, origin, {then.data() + d, rest},
                                       pairing_[i].xi, normals_of_face(i));
  }
  out.gap -= gap_offset_[i];
  return out;
}

void ContactInterface::find_closing_origin(Index i, double gap, std::span<const double> displacement,
                                           std::span<const double> start)
{
  has_origin_[i] = 1;
  if (moving_mortar_)
  {
    moving_mortar_->set_origin(i, closing_fraction(start_gap_[i], gap));
    return;
  }
  if (small_)
  {
    slip_origin_[i] += closing_fraction(start_gap_[i], gap) * (relative(i, displacement) - slip_origin_[i]);
    return;
  }
  const std::vector<Index> ids = nodes(i);
  const std::size_t n = ids.size();
  const auto d = static_cast<std::size_t>(dim_);
  std::vector<double> x(n * d), x_start(n * d);
  gather(ids, displacement, x);
  add_reference(ids, x);
  gather(ids, start, x_start);
  add_reference(ids, x_start);
  if (!analytic_)
  {
    slip_origin_[i] = closing_origin_finite(dim_, {x.data(), d}, {x.data() + d, (n - 1) * d}, {x_start.data(), d},
                                            {x_start.data() + d, (n - 1) * d}, pairing_[i].xi);
    return;
  }
  slip_origin_[i] = closing_origin_shape(dim_, axisymmetric_, *analytic_, {x.data(), d}, {x.data() + d, d},
                                         {x_start.data(), d}, {x_start.data() + d, d});
}

bool ContactInterface::set_trial(std::span<const double> displacement, std::span<const double> start)
{
  move_to(displacement);
  for (Index i = 0; i < n_nodes(); ++i)
    if (paired(i) && !has_origin_[i])
      find_closing_origin(i, gap(i, displacement), displacement, start);
  return moving_mortar_ && moving_mortar_->take_nodes(false);
}

ContactLinearisation ContactInterface::linearise(Index i, std::span<const double> displacement,
                                                 std::span<const double> start)
{
  const ContactLinearisation now = linearise_with_origin(i, displacement, start);
  if (has_origin_[i] || now.gap > 0)
    return now;
  find_closing_origin(i, now.gap, displacement, start);
  return linearise_with_origin(i, displacement, start);
}

double ContactInterface::set_initial_gap(std::span<const double> displacement)
{
  if (!options_.tied && options_.initial_overlap == InitialOverlap::resolve)
    return 0;
  move_to(displacement);
  double deepest = 0;
  for (Index i = 0; i < n_nodes(); ++i)
  {
    if (!paired(i))
    {
      left_out_[i] = options_.tied ? 1 : 0;
      continue;
    }
    const double initial = gap(i, displacement);
    deepest = std::max(deepest, -initial);
    gap_offset_[i] = options_.tied ? initial : std::min(0.0, initial);
  }
  return deepest;
}
} // namespace amontons
