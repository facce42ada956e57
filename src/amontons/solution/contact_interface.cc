#include "amontons/solution/contact_interface.h"

#include "amontons/bulk/surface_extraction.h"
#include "amontons/contact/frame.h"
#include "amontons/contact/kinematics.h"
#include "amontons/surface/normals.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
/// A gap below this fraction of the local size counts as touching when the run starts.
constexpr double touching = 1e-9;
constexpr int max_nodes = 5;
/// Edges of the target sharper than this stay sharp where normals are smoothed.
constexpr double sharp_angle = 3.14159265358979323846 / 6;

} // namespace

ContactInterface::ContactInterface(const Mesh &mesh, Kinematics kinematics, Strain strain,
                                   const ContactOptions &options, const DetectionOptions &detection,
                                   const RigidBody *analytic_target)
  : mesh_(mesh)
  , dim_(mesh.dim)
  , axisymmetric_(kinematics == Kinematics::axisymmetric)
  , small_(strain == Strain::small)
  , options_(options)
{
  Surface impactor = extract_surface(mesh, options.impactor, options.where);
  if (options.is_self_contact())
    impactor.face_bodies = bodies_of_faces(mesh, impactor);
  impactor_ = std::make_shared<const Surface>(std::move(impactor));
  areas_ = tributary_areas(*impactor_, axisymmetric_);
  if (analytic_target)
  {
    analytic_ = analytic_target->shape;
    shape_node_ = analytic_target->nodes.front();
  }
  else if (options.is_self_contact())
  {
    target_ = impactor_;
    detector_ = make_self_detector(detection, *impactor_, options.self_distance);
  }
  else
  {
    target_ = std::make_shared<const Surface>(extract_surface(mesh, options.target, options.where));
    check_not_welded(mesh, *impactor_, *target_, options.impactor, options.target, options.where);
    detector_ = make_detector(detection, *impactor_, *target_);
  }
  const auto n = static_cast<std::size_t>(n_nodes());
  pairing_.resize(n);
  augmentation_.assign(n, 1);
  n_face_changes_.assign(n, 0);
  slip_origin_.assign(n, Eigen::Vector3d::Zero());
  has_origin_.assign(n, 0);
  start_gap_.assign(n, 0);
  gap_offset_.assign(n, 0);
  total_slip_.assign(n * (dim_ - 1), 0);
  status_.assign(n, ContactStatus::open);
}

void ContactInterface::set_augmentation(std::span<const double> diagonal)
{
  const auto mean = [&](std::span<const Index> nodes)
  {
    double sum = 0;
    int n = 0;
    for (const Index node : nodes)
      for (int c = 0; c < dim_; ++c)
        if (const double k = diagonal[static_cast<std::size_t>(node) * dim_ + c]; k > 0)
        {
          sum += k;
          ++n;
        }
    return n > 0 ? sum / n : 0;
  };
  double on_target = 0;
  if (target_)
  {
    std::vector<Index> nodes(target_->node_ids.begin(), target_->node_ids.end());
    on_target = mean(nodes);
  }
  for (Index i = 0; i < n_nodes(); ++i)
  {
    const auto node = static_cast<Index>(impactor_->node_ids[i]);
    const double stiffness = mean({&node, 1});
    const double r = stiffness > 0 ? stiffness : on_target;
    if (r <= 0)
      throw UserError(options_.where, "both sides of contact '" + options_.name + "' are rigid; one must deform");
    augmentation_[i] = options_.augmentation * r;
  }
}

int ContactInterface::nodes(Index i, std::array<Index, 5> &out) const
{
  int n = 0;
  out[n++] = static_cast<Index>(impactor_->node_ids[i]);
  if (analytic_)
    out[n++] = shape_node_;
  else if (pairing_[i].face >= 0)
    for (const Index local : target_->face(pairing_[i].face))
      out[n++] = static_cast<Index>(target_->node_ids[local]);
  return n;
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
      out[k++] += node == shape_node_ ? analytic_->point[c] : mesh_.points[static_cast<std::size_t>(node) * dim_ + c];
}

Eigen::Vector3d ContactInterface::relative(Index i, std::span<const double> displacement) const
{
  std::array<Index, max_nodes> ids;
  const int n = nodes(i, ids);
  std::array<double, max_contact_dofs> u;
  gather({ids.data(), static_cast<std::size_t>(n)}, displacement, u);
  const Pair &pair = pairing_[i];
  std::array<double, 4> weight{1, 0, 0, 0};
  const double a = pair.xi[0], b = pair.xi[1];
  if (n == 3)
    weight = {1 - a, a, 0, 0};
  else if (n == 4)
    weight = {1 - a - b, a, b, 0};
  else if (n == 5)
    weight = {(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b};
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (int c = 0; c < dim_; ++c)
  {
    out[c] = u[c];
    for (int k = 1; k < n; ++k)
      out[c] -= weight[k - 1] * u[k * dim_ + c];
  }
  return out;
}

bool ContactInterface::begin_increment(std::span<const double> start)
{
  const auto same_face = [](const Pair &a, const Pair &b) { return a.face == b.face; };
  const bool restore =
      !start_pairing_.empty() && !std::equal(pairing_.begin(), pairing_.end(), start_pairing_.begin(), same_face);
  if (restore)
    pairing_ = start_pairing_;
  smooth_target_normals(start);
  for (Index i = 0; i < n_nodes(); ++i)
  {
    n_face_changes_[i] = 0;
    has_origin_[i] = 0;
    if (!paired(i))
      continue;
    const auto node = static_cast<Index>(impactor_->node_ids[i]);
    slip_origin_[i] = Eigen::Vector3d::Zero();
    if (small_)
      slip_origin_[i] = relative(i, start);
    else
    {
      gather({&node, 1}, start, {slip_origin_[i].data(), 3});
      add_reference({&node, 1}, {slip_origin_[i].data(), 3});
    }
    const double gap = linearise_with_origin(i, start, start).gap;
    start_gap_[i] = gap;
    const double size = std::pow(areas_[i], 1.0 / (dim_ - 1));
    has_origin_[i] = options_.tied || status_[i] != ContactStatus::open || gap <= touching * size;
  }
  return restore;
}

void ContactInterface::smooth_target_normals(std::span<const double> start)
{
  if (small_ || analytic_ || options_.normals == TargetNormals::faceted)
    return;
  std::vector<double> x(target_->reference);
  for (Index i = 0; i < target_->n_nodes(); ++i)
    for (int c = 0; c < dim_; ++c)
      x[i * dim_ + c] += start[static_cast<std::size_t>(target_->node_ids[i]) * dim_ + c];
  target_normals_ = smoothed_normals(*target_, x, sharp_angle);
}

std::span<const double> ContactInterface::normals_of_face(Index i) const
{
  if (target_normals_.empty())
    return {};
  const auto first = static_cast<std::size_t>(target_->face_offsets[pairing_[i].face]) * dim_;
  const auto end = static_cast<std::size_t>(target_->face_offsets[pairing_[i].face + 1]) * dim_;
  return {target_normals_.data() + first, end - first};
}

ContactLinearisation ContactInterface::linearise_with_origin(Index i, std::span<const double> displacement,
                                                             std::span<const double> start) const
{
  std::array<Index, max_nodes> ids;
  const auto n = static_cast<std::size_t>(nodes(i, ids));
  const std::size_t size = n * dim_, rest = size - dim_;
  const std::span<const Index> all{ids.data(), n};
  std::array<double, max_contact_dofs> now, then;
  const std::span<const double> origin{slip_origin_[i].data(), static_cast<std::size_t>(dim_)};
  const auto d = static_cast<std::size_t>(dim_);

  ContactLinearisation out;
  if (small_)
  {
    std::fill_n(then.begin(), size, 0.0);
    add_reference(all, then);
    gather(all, displacement, now);
    out = analytic_
              ? linearise_shape_small(dim_, axisymmetric_, *analytic_, {then.data(), d}, {now.data(), size}, origin)
              : linearise_small(dim_, {then.data(), d}, {then.data() + d, rest}, {now.data(), size}, origin,
                                pairing_[i].xi);
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

void ContactInterface::find_closing_origin(Index i, const ContactLinearisation &now,
                                           std::span<const double> displacement, std::span<const double> start)
{
  has_origin_[i] = 1;
  if (small_)
  {
    slip_origin_[i] += closing_fraction(start_gap_[i], now.gap) * (relative(i, displacement) - slip_origin_[i]);
    return;
  }
  std::array<Index, max_nodes> ids;
  const auto n = static_cast<std::size_t>(nodes(i, ids));
  const auto d = static_cast<std::size_t>(dim_);
  std::array<double, max_contact_dofs> x{}, x_start{};
  gather({ids.data(), n}, displacement, x);
  add_reference({ids.data(), n}, x);
  gather({ids.data(), n}, start, x_start);
  add_reference({ids.data(), n}, x_start);
  if (!analytic_)
  {
    slip_origin_[i] = closing_origin_finite(dim_, {x.data(), d}, {x.data() + d, (n - 1) * d}, {x_start.data(), d},
                                            {x_start.data() + d, (n - 1) * d}, pairing_[i].xi);
    return;
  }
  slip_origin_[i] = closing_origin_shape(dim_, axisymmetric_, *analytic_, {x.data(), d}, {x.data() + d, d},
                                         {x_start.data(), d}, {x_start.data() + d, d});
}

void ContactInterface::set_trial(std::span<const double> displacement, std::span<const double> start)
{
  for (Index i = 0; i < n_nodes(); ++i)
    if (paired(i) && !has_origin_[i])
      find_closing_origin(i, linearise_with_origin(i, displacement, start), displacement, start);
}

ContactLinearisation ContactInterface::linearise(Index i, std::span<const double> displacement,
                                                 std::span<const double> start)
{
  const ContactLinearisation now = linearise_with_origin(i, displacement, start);
  if (has_origin_[i] || now.gap > 0)
    return now;
  find_closing_origin(i, now, displacement, start);
  return linearise_with_origin(i, displacement, start);
}

void ContactInterface::set_initial_gap(std::span<const double> displacement)
{
  if (!options_.tied && options_.initial_overlap == InitialOverlap::resolve)
    return;
  for (Index i = 0; i < n_nodes(); ++i)
    if (paired(i))
    {
      const double gap = linearise_with_origin(i, displacement, displacement).gap;
      gap_offset_[i] = options_.tied ? gap : std::min(0.0, gap);
    }
}
} // namespace amontons
