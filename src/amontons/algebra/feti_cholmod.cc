#include "amontons/algebra/feti_cholmod.h"

#include "amontons/base/error.h"

#include <cblas.h>

#include <algorithm>
#include <utility>

namespace amontons
{
namespace
{
/// A view of the arrays as CHOLMOD wants it.
cholmod_sparse view(SymmetricPattern &pattern, double *values)
{
  cholmod_sparse out{};
  out.nrow = out.ncol = static_cast<std::size_t>(pattern.size());
  out.nzmax = pattern.rows.size();
  out.p = pattern.offsets.data();
  out.i = pattern.rows.data();
  out.x = values;
  out.stype = 1;
  out.itype = CHOLMOD_INT;
  out.xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN;
  out.dtype = CHOLMOD_DOUBLE;
  out.sorted = 1;
  out.packed = 1;
  return out;
}

cholmod_dense view(double *values, std::size_t n_rows, std::size_t n_columns)
{
  cholmod_dense out{};
  out.nrow = out.d = n_rows;
  out.ncol = n_columns;
  out.nzmax = n_rows * n_columns;
  out.x = values;
  out.xtype = CHOLMOD_REAL;
  out.dtype = CHOLMOD_DOUBLE;
  return out;
}

void check(const cholmod_common &common, const char *what)
{
  if (common.status < CHOLMOD_OK)
    throw NumericalFailure(std::string("CHOLMOD, ") + what +
                           (common.status == CHOLMOD_OUT_OF_MEMORY ? ": out of memory" : ": failed"));
}
} // namespace

CholmodSession::CholmodSession()
{
  openblas_set_num_threads(1); // thousands of small matrices: threads within one would cost more than they give
  cholmod_start(&common_);
  common_.supernodal = CHOLMOD_SUPERNODAL;
  common_.print = 0;
  common_.error_handler = nullptr;
}

CholmodSession::~CholmodSession()
{
  for (cholmod_dense **dense : {&solution_, &work_y_, &work_e_})
    cholmod_free_dense(dense, &common_);
  cholmod_finish(&common_);
}

double *CholmodSession::solve(int system, cholmod_factor *factor, double *rhs, std::size_t n_rows,
                              std::size_t n_columns)
{
  cholmod_dense right = view(rhs, n_rows, n_columns);
  cholmod_solve2(system, factor, &right, nullptr, &solution_, nullptr, &work_y_, &work_e_, &common_);
  check(common_, "solution");
  return static_cast<double *>(solution_->x);
}

SparseCholesky::~SparseCholesky()
{
  cholmod_free_factor(&factor_, session_->common());
}

SparseCholesky::SparseCholesky(SparseCholesky &&other) noexcept
  : session_(other.session_)
  , factor_(std::exchange(other.factor_, nullptr))
{
}

void SparseCholesky::analyze(SymmetricPattern &pattern)
{
  cholmod_common *common = session_->common();
  cholmod_free_factor(&factor_, common);
  cholmod_sparse matrix = view(pattern, nullptr);
  factor_ = cholmod_analyze(&matrix, common);
  check(*common, "analysis");
}

bool SparseCholesky::factorize(SymmetricPattern &pattern, std::span<double> values)
{
  cholmod_common *common = session_->common();
  cholmod_sparse matrix = view(pattern, values.data());
  cholmod_factorize(&matrix, factor_, common);
  check(*common, "factorisation");
  return common->status == CHOLMOD_OK;
}

double SparseCholesky::reciprocal_condition() const
{
  return cholmod_rcond(factor_, session_->common());
}

void SparseCholesky::solve(std::span<double> x)
{
  if (x.empty())
    return;
  std::copy_n(session_->solve(CHOLMOD_A, factor_, x.data(), x.size(), 1), x.size(), x.begin());
}

std::span<const int> SparseCholesky::order() const
{
  return {static_cast<const int *>(factor_->Perm), factor_->n};
}

const double *SparseCholesky::solve_half(std::vector<double> &B, Index n_columns)
{
  return session_->solve(CHOLMOD_L, factor_, B.data(), B.size() / n_columns, n_columns);
}
} // namespace amontons
