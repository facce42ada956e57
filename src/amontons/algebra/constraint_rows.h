#pragma once
#include "amontons/algebra/system_form.h"

#include <vector>

namespace amontons
{
/// One constraint of a SystemForm brought to its proper constraint rows.
///
/// The multipliers whose corner block D is regular are eliminated within the constraint, exactly; what the augmentation
/// adds to the stiffness is taken out, since it vanishes with the rows. With rl the constraint's part of the right side
/// (its multiplier rows), the system then reads
///     (K + stiffness) du + forces y = right side - right_side_force rl,
///     rows du = row_right_side rl,
/// and the multipliers' step is multiplier_by_row y + multiplier_by_right_side rl + multiplier_by_position du.
/// An open node has no rows, one that sticks has as many as components, one that slips has the normal row, with the
/// friction in its force column (THEORY.md section 6: b_n - mu s . b_t).
struct ConstraintRows
{
  template<int rows_max, int cols_max>
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, rows_max, cols_max>;
  using ByRow = Matrix<3, 3>;
  using OverPosition = Matrix<3, Eigen::Dynamic>;
  using OnPosition = Matrix<Eigen::Dynamic, 3>;

  OverPosition rows;                   ///< [n_rows x n_nodal]
  OnPosition forces;                   ///< [n_nodal x n_rows]; rows^T itself where symmetric
  Eigen::MatrixXd stiffness;           ///< [n_nodal x n_nodal], or empty where it is zero
  ByRow row_right_side;                ///< [n_rows x n_multipliers]
  OnPosition right_side_force;         ///< [n_nodal x n_multipliers]
  ByRow multiplier_by_row;             ///< [n_multipliers x n_rows]
  ByRow multiplier_by_right_side;      ///< [n_multipliers x n_multipliers]
  OverPosition multiplier_by_position; ///< [n_multipliers x n_nodal]
  bool symmetric = true;               ///< forces = rows^T and stiffness = stiffness^T, to round-off

  [[nodiscard]] int n_rows() const { return static_cast<int>(rows.rows()); }
};

/// @throws NumericalFailure if the values are not finite, or a row or its forces are zero
ConstraintRows reduce_constraint(const ConstraintValues &values);

/// left diag(weight) right^T, the columns of left and right of length one.
struct LowRankMatrix
{
  Eigen::MatrixXd left;   ///< [n x rank]
  Eigen::VectorXd weight; ///< [rank], not zero; any sign
  Eigen::MatrixXd right;  ///< [n x rank]; equal to left for a symmetric matrix
};

/// A small matrix as a sum of as few products as it takes, to round-off. @param matrix [n x n], may be empty
LowRankMatrix factorise_low_rank(const Eigen::MatrixXd &matrix, bool symmetric);
} // namespace amontons
