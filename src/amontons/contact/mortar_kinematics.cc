#include "amontons/base/error.h"
#include "amontons/contact/kinematics.h"

#include <algorithm>

namespace amontons
{
namespace
{
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A unit vector and its derivative with respect to the impactors' positions, [3 x dim * n_impactors].
struct Direction
{
  Vector3d value;
  MatrixXd gradient;
};

/// The columns of a, each crossed with b.
MatrixXd crossed(const MatrixXd &a, const Vector3d &b)
{
  MatrixXd out(3, a.cols());
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    out.col(i) = Vector3d(a.col(i)).cross(b);
  return out;
}

std::array<Direction, max_tangents> tangents(int dim, const Direction &normal, const Vector3d &along,
                                             const std::array<int, 2> &ends)
{
  const Vector3d &n = normal.value;
  Direction first, second;
  if (dim == 2)
  {
    first.value = Vector3d(-n.y(), n.x(), 0);
    first.gradient = MatrixXd::Zero(3, normal.gradient.cols());
    first.gradient.row(0) = -normal.gradient.row(1);
    first.gradient.row(1) = normal.gradient.row(0);
    return {first, second};
  }
  const Vector3d part = along - n.dot(along) * n;
  const double length = part.norm();
  if (!(length > 0))
    throw NumericalFailure("the impactor is folded: its normal lies in its own face");
  MatrixXd change = -n.dot(along) * normal.gradient - n * (along.transpose() * normal.gradient);
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - n * n.transpose();
  change.middleCols<3>(3 * static_cast<Eigen::Index>(ends[0])) -= across;
  change.middleCols<3>(3 * static_cast<Eigen::Index>(ends[1])) += across;
  first.value = part / length;
  first.gradient = (change - first.value * (first.value.transpose() * change)) / length;
  second.value = n.cross(first.value);
  second.gradient = crossed(normal.gradient, first.value) - crossed(first.gradient, n);
  return {first, second};
}

/// Rows and columns of the dofs, with the weights and all that does not depend on the direction.
struct Mean
{
  int dim;
  Eigen::Index n_impactors, n_targets;
  Eigen::Map<const VectorXd> weights, origin;
  const MatrixXd &weight_gradient;
  Eigen::Matrix3Xd targets; ///< from the impactor node

  [[nodiscard]] Eigen::Index place(Eigen::Index target) const { return dim * (n_impactors + target); }
  [[nodiscard]] Eigen::Index n_dofs() const { return place(n_targets); }

  /// A unit force along `direction` on the impactor node and its reaction on the targets.
  [[nodiscard]] VectorXd opposed(const Direction &direction) const
  {
    VectorXd out = VectorXd::Zero(n_dofs());
    out.head(dim) = direction.value.head(dim);
    for (Eigen::Index k = 0; k < n_targets; ++k)
      out.segment(place(k), dim) = -weights[k] * direction.value.head(dim);
    return out;
  }

  [[nodiscard]] MatrixXd opposed_gradient(const Direction &direction) const
  {
    MatrixXd out = MatrixXd::Zero(n_dofs(), n_dofs());
    const Eigen::Index turning = dim * n_impactors;
    out.topLeftCorner(dim, turning) = direction.gradient.topRows(dim);
    for (Eigen::Index k = 0; k < n_targets; ++k)
    {
      auto rows = out.middleRows(place(k), dim);
      rows.noalias() = -direction.value.head(dim) * weight_gradient.row(k);
      rows.leftCols(turning) -= weights[k] * direction.gradient.topRows(dim);
    }
    return out;
  }

  /// Gradient of direction . sum_k share_k x_k, x_k from the impactor node, where the shares change as the weights do.
  [[nodiscard]] VectorXd gradient_along(const Direction &direction, const VectorXd &shares) const
  {
    VectorXd out = weight_gradient.transpose() * (targets.transpose() * direction.value);
    out.head(dim * n_impactors) += direction.gradient.transpose() * (targets * shares);
    for (Eigen::Index k = 0; k < n_targets; ++k)
      out.segment(place(k), dim) += shares[k] * direction.value.head(dim);
    return out;
  }
};
} // namespace

ContactLinearisation linearise_mortar(int dim, const Vector3d &normal, const MatrixXd &normal_gradient,
                                      std::span<const double> impactors, std::span<const double> targets,
                                      std::span<const double> weights, const MatrixXd &weight_gradient,
                                      std::span<const double> origin_weights, const std::array<int, 2> &ends)
{
  const auto n_impactors = static_cast<Eigen::Index>(impactors.size()) / dim,
             n_targets = static_cast<Eigen::Index>(weights.size());
  AMONTONS_ASSERT(n_impactors >= 1 && targets.size() == dim * weights.size());
  AMONTONS_ASSERT(origin_weights.size() == weights.size() && normal_gradient.rows() == dim);
  AMONTONS_ASSERT(normal_gradient.cols() == dim * n_impactors && weight_gradient.rows() == n_targets);
  AMONTONS_ASSERT(weight_gradient.cols() == dim * (n_impactors + n_targets));
  AMONTONS_ASSERT(dim == 2 || (std::min(ends[0], ends[1]) >= 0 && std::max(ends[0], ends[1]) < n_impactors));
  const Eigen::Map<const MatrixXd> own(impactors.data(), dim, n_impactors), others(targets.data(), dim, n_targets);
  Mean mean{dim,
            n_impactors,
            n_targets,
            {weights.data(), n_targets},
            {origin_weights.data(), n_targets},
            weight_gradient,
            Eigen::Matrix3Xd::Zero(3, n_targets)};
  mean.targets.topRows(dim) = others.colwise() - own.col(0);
  Direction n{normal, MatrixXd::Zero(3, normal_gradient.cols())};
  n.gradient.topRows(dim) = normal_gradient;
  Vector3d along = Vector3d::Zero();
  if (dim == 3)
    along = own.col(ends[1]) - own.col(ends[0]);

  ContactLinearisation out;
  out.dim = dim;
  out.normal = normal;
  out.gap = -normal.dot(mean.targets * mean.weights);
  out.gap_direction = mean.opposed(n);
  out.gap_direction_gradient = mean.opposed_gradient(n);
  out.gap_gradient = -mean.gradient_along(n, mean.weights);
  out.gap_gradient.head(dim) += normal.head(dim);
  const VectorXd slipped = mean.weights - mean.origin;
  const auto frame = tangents(dim, n, along, ends);
  for (int c = 0; c < dim - 1; ++c)
  {
    out.tangent[c] = frame[c].value;
    out.slip[c] = frame[c].value.dot(mean.targets * slipped);
    out.slip_gradient[c] = mean.gradient_along(frame[c], slipped);
    out.slip_direction[c] = mean.opposed(frame[c]);
    out.slip_direction_gradient[c] = mean.opposed_gradient(frame[c]);
  }
  return out;
}
} // namespace amontons
