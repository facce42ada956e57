#pragma once
#include "amontons/algebra/petsc.h"
#include "amontons/algebra/sparse_matrix.h"
#include "amontons/parallel/sharing.h"

#include <span>

namespace amontons
{
/// A matrix of ours as PETSc's, with a right side and a solution: on one process without a copy; over several it is the
/// sum of what each has, its rows with their owners. All calls are collective.
class PetscMatrix
{
public:
  PetscMatrix() = default;
  /// The matrix and the sharing stay the caller's and must be kept. @param blocks source.block_size rows each
  /// @throws UserError if PETSc cannot number the rows
  PetscMatrix(const SparseMatrix &source, const Sharing &blocks);

  [[nodiscard]] Mat get() const { return matrix_.get(); }
  [[nodiscard]] Vec rhs() const { return rhs_.get(); }
  [[nodiscard]] Vec solution() const { return solution_.get(); }
  [[nodiscard]] MPI_Comm communicator() const { return communicator_of(*blocks_); }
  [[nodiscard]] bool is_distributed() const { return blocks_->is_distributed(); }
  /// A vector like the right side, its values left open.
  [[nodiscard]] VecHandle make_vector() const;

  void values_changed();
  /// Whether every process's part is symmetric, to round-off; then their sum is.
  [[nodiscard]] bool is_symmetric() const;

  void set_rhs(std::span<const double> values) { fill(rhs_.get(), values); }
  void get_solution(std::span<double> values) const;
  /// @param values [n_rows] of the calling process, of which the owners' are taken
  void fill(Vec vector, std::span<const double> values) const;

private:
  static MPI_Comm communicator_of(const Sharing &blocks);
  void create_distributed();

  const SparseMatrix *source_ = nullptr;
  const Sharing *blocks_ = nullptr;
  MatHandle matrix_;
  VecHandle solution_, rhs_;
};
} // namespace amontons
