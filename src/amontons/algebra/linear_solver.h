#pragma once
#include "amontons/algebra/sparse_matrix.h"
#include "amontons/parallel/sharing.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace amontons
{
/// Solves A x = b where the pattern of A stands for many values, and the values for many b. Collective.
///
/// Over several processes each has rows of its own numbering, and of every row the part that it adds: A is the sum.
class LinearSolver
{
public:
  virtual ~LinearSolver() = default;

  /// A matrix with a new pattern. It stays the caller's, who may change its values in place and must keep it.
  /// @param blocks the processes' block rows, matrix.block_size rows each; must be kept too
  virtual void set_matrix(const SparseMatrix &matrix, const Sharing &blocks) = 0;
  /// Makes ready for solve() with the present values. @throws NumericalFailure
  virtual void factorize() = 0;
  /// @param rhs of a row the owner's value counts
  /// @param solution overwritten; the same on all copies of a row, bit by bit
  /// @param tolerance an iteration stops where |rhs - A x| is below it (as a force, not a part); a factorisation takes
  ///        no notice
  /// @throws NumericalFailure if the matrix is singular, or the iteration does not converge
  virtual void solve(std::span<const double> rhs, std::span<double> solution, double tolerance) = 0;

  /// Vectors that the matrix, seen locally, makes almost zero: a body's rigid motions. For multigrid.
  [[nodiscard]] virtual bool wants_smooth_modes() const { return false; }
  /// @param modes [n_rows] each; of a row the owner's value counts
  virtual void set_smooth_modes(std::vector<std::vector<double>> /*modes*/) {}

  [[nodiscard]] virtual std::int64_t n_factorizations() const { return 0; }
  [[nodiscard]] virtual std::int64_t n_preconditioner_setups() const { return 0; }
  [[nodiscard]] virtual std::int64_t n_pattern_builds() const = 0;
  [[nodiscard]] virtual std::int64_t n_iterations() const = 0;
};

/// Factorisation by MUMPS: LDL^T of a symmetric matrix, LU of any other. Of a singular matrix
/// one solution is found where there are any; where there are none solve() throws.
std::unique_ptr<LinearSolver> make_direct_solver();
} // namespace amontons
