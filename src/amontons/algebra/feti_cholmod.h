#pragma once
#include "amontons/base/ids.h"

#include <suitesparse/cholmod.h>

#include <memory>
#include <span>
#include <vector>

namespace amontons
{
/// CHOLMOD's settings and workspace (Chen, Davis, Hager, Rajamanickam 2008). One per thread; outlives its factors.
class CholmodSession
{
public:
  CholmodSession();
  ~CholmodSession();
  CholmodSession(const CholmodSession &) = delete;
  CholmodSession &operator=(const CholmodSession &) = delete;

  [[nodiscard]] cholmod_common *common() { return &common_; }
  /// Solves with a factor in the session's own memory. @param system as CHOLMOD counts them
  /// @return n_rows * n_columns values, by columns, until the next call
  double *solve(int system, cholmod_factor *factor, double *rhs, std::size_t n_rows, std::size_t n_columns);

private:
  cholmod_common common_{};
  cholmod_dense *solution_ = nullptr, *work_y_ = nullptr, *work_e_ = nullptr;
};

/// Upper triangle of a symmetric matrix, compressed columns (or, the same, lower triangle, compressed rows).
struct SymmetricPattern
{
  std::vector<Index> offsets{0}; ///< [n + 1]
  std::vector<Index> rows;       ///< ascending within a column, none below the diagonal

  [[nodiscard]] Index size() const { return static_cast<Index>(offsets.size()) - 1; }
};

/// Supernodal factors L L^T of a sparse symmetric positive definite matrix, reordered. The pattern's analysis stands
/// for many values.
class SparseCholesky
{
public:
  explicit SparseCholesky(CholmodSession &session)
    : session_(&session)
  {
  }
  ~SparseCholesky();
  SparseCholesky(SparseCholesky &&other) noexcept;
  SparseCholesky &operator=(SparseCholesky &&) = delete;

  void analyze(SymmetricPattern &pattern);
  /// @param values in the order of the pattern that was analysed @return false if the matrix is not positive definite
  [[nodiscard]] bool factorize(SymmetricPattern &pattern, std::span<double> values);
  /// Estimate of the reciprocal condition number, from the diagonal of L.
  [[nodiscard]] double reciprocal_condition() const;
  /// x = A^-1 x
  void solve(std::span<double> x);
  /// Row k of the reordered matrix is row order()[k] of the matrix. [n]
  [[nodiscard]] std::span<const int> order() const;
  /// X = L^-1 B with the rows of B reordered, so that X^T X = B^T A^-1 B. @param B [n * n_columns], by columns
  /// @return X like B, in the session's memory until the next solution
  [[nodiscard]] const double *solve_half(std::vector<double> &B, Index n_columns);

private:
  CholmodSession *session_;
  cholmod_factor *factor_ = nullptr;
};
} // namespace amontons
