#include "amontons/algebra/constraint_rows.h"

#include "amontons/base/error.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>

namespace amontons
{
namespace
{
/// Of r D, whose entries are 0 or of the order of 1: a multiplier below this has no corner of its own. Near the limit
/// of sticking in 3D the corner across the slip goes to zero gradually.
constexpr double regular_corner = 1e-9;
constexpr double round_off = 1e-13;

using Corner = ConstraintRows::ByRow;

/// Singular value decomposition of the corner, D = U diag(sigma) V^T, split by whether sigma counts.
struct CornerSplit
{
  Corner inverse;           ///< D^+ of the regular part
  Corner rows, multipliers; ///< columns: left and right kernel
};

CornerSplit split_corner(const Corner &corner, double r)
{
  const Eigen::Index m = corner.rows();
  if (corner.isZero(0))
    return {Corner::Zero(m, m), Corner::Identity(m, m), Corner::Identity(m, m)};
  const Eigen::JacobiSVD<Corner> svd(corner, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Index n_regular = 0;
  while (n_regular < m && r * svd.singularValues()[n_regular] > regular_corner)
    ++n_regular;
  const Corner weights = svd.singularValues().head(n_regular).cwiseInverse().asDiagonal();
  const Corner u = svd.matrixU(), v = svd.matrixV();
  return {v.leftCols(n_regular) * weights * u.leftCols(n_regular).transpose(), u.rightCols(m - n_regular),
          v.rightCols(m - n_regular)};
}

bool nearly_equal(const Eigen::Ref<const Eigen::MatrixXd> &a, const Eigen::Ref<const Eigen::MatrixXd> &b)
{
  return (a - b).norm() <= round_off * (a.norm() + b.norm());
}

/// Scales the multipliers of the rows so that along the rows a unit of one does what a unit of a reaction would.
void normalise_multipliers(ConstraintRows &out)
{
  const Corner along = out.rows * out.forces;
  const Eigen::FullPivLU<Corner> lu(along);
  if (!lu.isInvertible())
    return;
  const Corner scale = lu.solve(Corner(out.rows * out.rows.transpose()));
  out.forces = (out.forces * scale).eval();
  out.multiplier_by_row = (out.multiplier_by_row * scale).eval();
}

/// Takes out the part forces X rows: where the rows are met it is forces X row_right_side.
void take_out_augmentation(ConstraintRows &out, Eigen::MatrixXd &stiffness)
{
  if (out.n_rows() == 0)
    return;
  const Corner over_rows = (out.rows * out.rows.transpose()).inverse();
  const Corner over_forces = (out.forces.transpose() * out.forces).inverse();
  const Corner x = over_forces * (out.forces.transpose() * stiffness * out.rows.transpose()) * over_rows;
  stiffness.noalias() -= out.forces * x * out.rows;
  out.right_side_force += out.forces * x * out.row_right_side;
}
} // namespace

ConstraintRows reduce_constraint(const ConstraintValues &values)
{
  const auto &f = values.force_by_multiplier;
  const auto &c = values.constraint_by_position;
  if (!values.stiffness.allFinite() || !f.allFinite() || !c.allFinite())
    throw NumericalFailure("a contact element is not finite");
  const CornerSplit corner = split_corner(values.constraint_by_multiplier, values.augmentation);

  ConstraintRows out;
  out.rows = corner.rows.transpose() * c;
  out.forces = f * corner.multipliers;
  out.row_right_side = corner.rows.transpose();
  out.multiplier_by_row = corner.multipliers;
  out.multiplier_by_right_side = corner.inverse;
  out.multiplier_by_position = -corner.inverse * c;
  out.right_side_force = f * corner.inverse;
  if (out.n_rows() > 0 && (out.rows.rowwise().norm().minCoeff() == 0 || out.forces.colwise().norm().minCoeff() == 0))
    throw NumericalFailure("the tangent matrix is singular: a contact multiplier acts on nothing");
  if (!nearly_equal(out.forces, out.rows.transpose()))
    normalise_multipliers(out);

  Eigen::MatrixXd stiffness = values.stiffness + f * out.multiplier_by_position;
  take_out_augmentation(out, stiffness);
  const double cut = round_off * (values.augmentation * f.norm() * c.norm() + values.stiffness.norm());
  if (stiffness.norm() > cut)
    out.stiffness = std::move(stiffness);

  out.symmetric = nearly_equal(out.forces, out.rows.transpose());
  if (out.symmetric)
    out.forces = out.rows.transpose();
  if (out.stiffness.size() > 0 && (out.stiffness - out.stiffness.transpose()).norm() > cut)
    out.symmetric = false;
  return out;
}

LowRankMatrix factorise_low_rank(const Eigen::MatrixXd &matrix, bool symmetric)
{
  LowRankMatrix out;
  const Eigen::Index n = matrix.rows();
  Eigen::VectorXd weight;
  Eigen::MatrixXd left, right;
  if (n == 0)
    return out;
  if (symmetric)
  {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
    weight = eigen.eigenvalues();
    left = right = eigen.eigenvectors();
  }
  else
  {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    weight = svd.singularValues();
    left = svd.matrixU();
    right = svd.matrixV();
  }
  const double cut = round_off * weight.cwiseAbs().maxCoeff();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index j = 0; j < n; ++j)
    if (std::abs(weight[j]) > cut)
      kept.push_back(j);
  out.left = left(Eigen::all, kept);
  out.weight = weight(kept);
  out.right = right(Eigen::all, kept);
  return out;
}
} // namespace amontons
