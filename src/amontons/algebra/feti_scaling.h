#pragma once
#include "amontons/algebra/feti_rows.h"
#include "amontons/parallel/sharing.h"

#include <span>
#include <vector>

namespace amontons
{
/// (B D^-1 B^T)^-1 among rows of length one in the inner product of D^-1, by a Chebyshev polynomial in B D^-1 B^T
/// (Saad 2003, Iterative Methods for Sparse Linear Systems, algorithm 12.1). It is symmetric positive definite whatever
/// the rows, takes one exchange with neighbours for each degree, and does not depend on the number of processes.
///
/// The spectrum lies below the largest sum of |B| D^-1 |B|^T over a row. Where each row has columns that no other row
/// touches, it lies above the least share of those in a row's length; where that is very small, as with a hard
/// impactor on a soft target, what lies lower is scaled less than it should be.
class FetiScaling
{
public:
  /// Collective. @param rows all that touch an own column, over own columns @param rows_sharing of the rows
  /// @param least the least share that is a row's alone, over all processes
  void set(const FetiRows &rows, std::span<const double> inverse_stiffness, double least, const Sharing &rows_sharing);
  /// Collective.
  void apply(std::span<double> values, const Sharing &rows_sharing) const;

private:
  FetiRows scaled_; ///< B D^-1/2, over the columns that a row touches
  Index n_columns_ = 0;
  double center_ = 1, radius_ = 0; ///< of the interval that the spectrum lies in
  int degree_ = 0;
};
} // namespace amontons
