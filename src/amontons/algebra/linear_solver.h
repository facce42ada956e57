#pragma once
#include "amontons/base/ids.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace amontons
{
/// Solves A x = b where the pattern of A stands for many values, and the values for many b. Collective.
class LinearSolver
{
public:
  virtual ~LinearSolver() = default;

  /// Pattern as a list of entries, rows[k], cols[k] in 0 .. n-1; repeated entries are summed.
  virtual void set_pattern(Index n, std::span<const Index> rows, std::span<const Index> cols) = 0;
  /// Values in the order of the pattern's entries.
  virtual void set_values(std::span<const double> values) = 0;
  /// Makes ready for solve() with the present values. @throws NumericalFailure if the matrix is singular
  virtual void factorize() = 0;
  virtual void solve(std::span<const double> rhs, std::span<double> solution) = 0;

  [[nodiscard]] virtual std::int64_t n_factorizations() const = 0;
  [[nodiscard]] virtual std::int64_t n_pattern_builds() const = 0;
  [[nodiscard]] virtual std::int64_t n_iterations() const = 0;
};

/// Sparse LU of an indefinite, unsymmetric matrix (MUMPS), on the calling process.
std::unique_ptr<LinearSolver> make_direct_solver();
} // namespace amontons
