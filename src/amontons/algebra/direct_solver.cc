#include "amontons/algebra/linear_solver.h"
#include "amontons/algebra/petsc.h"
#include "amontons/algebra/petsc_matrix.h"

#include <cmath>

namespace amontons
{
namespace
{
/// Residual, over the right side, with which equations of a singular matrix count as free of contradiction.
constexpr double contradiction = 1e-9;

/// Room beyond what the analysis foresees, per cent.
constexpr PetscInt least_workspace = 50, most_workspace = 3200;

class DirectSolver : public LinearSolver
{
public:
  void set_matrix(const SparseMatrix &matrix) override
  {
    source_ = &matrix;
    ksp_.reset();
    matrix_ = PetscMatrix(matrix);
    ++n_pattern_builds_;
  }

  void factorize() override
  {
    ++n_factorizations_;
    matrix_.values_changed();
    const bool symmetric = is_symmetric(*source_);
    if (!ksp_ || symmetric != symmetric_)
      create_ksp(symmetric);
    PCFailedReason reason = attempt();
    // Pivoting in saddle points takes more room than the analysis foresees.
    while (reason == PC_FACTOR_OUTMEMORY && workspace_ < most_workspace)
    {
      workspace_ *= 4;
      create_ksp(symmetric);
      reason = attempt();
    }
    if (reason != PC_NOERROR)
    {
      ksp_.reset(); // a factorisation that failed is of no further use to PETSc
      throw NumericalFailure(reason == PC_FACTOR_OUTMEMORY ? "the factorisation ran out of memory"
                                                           : "the tangent matrix is singular");
    }
  }

  void solve(std::span<const double> rhs, std::span<double> solution, double /*tolerance*/) override
  {
    matrix_.set_rhs(rhs);
    check_petsc(KSPSolve(ksp_.get(), matrix_.rhs(), matrix_.solution()), "solution");
    ++n_iterations_;
    matrix_.get_solution(solution);
    if (n_null_pivots_ > 0)
      check_residual(rhs, solution);
  }

  [[nodiscard]] std::int64_t n_factorizations() const override { return n_factorizations_; }
  [[nodiscard]] std::int64_t n_pattern_builds() const override { return n_pattern_builds_; }
  [[nodiscard]] std::int64_t n_iterations() const override { return n_iterations_; }

private:
  PCFailedReason attempt()
  {
    check_petsc(KSPSetOperators(ksp_.get(), matrix_.get(), matrix_.get()), "operator");
    check_petsc(KSPSetUp(ksp_.get()), "factorisation");
    PC pc = nullptr;
    PCFailedReason reason = PC_NOERROR;
    check_petsc(KSPGetPC(ksp_.get(), &pc), "factorisation");
    check_petsc(PCGetFailedReason(pc, &reason), "factorisation");
    n_null_pivots_ = reason == PC_NOERROR ? count_null_pivots(pc) : 0;
    return reason;
  }

  void create_ksp(bool symmetric)
  {
    symmetric_ = symmetric;
    KSP ksp = nullptr;
    check_petsc(KSPCreate(PETSC_COMM_SELF, &ksp), "solver");
    ksp_.reset(ksp);
    check_petsc(MatSetOption(matrix_.get(), MAT_SYMMETRIC, symmetric ? PETSC_TRUE : PETSC_FALSE), "symmetry");
    check_petsc(KSPSetOperators(ksp, matrix_.get(), matrix_.get()), "operator");
    check_petsc(KSPSetType(ksp, KSPPREONLY), "solver type");
    PC pc = nullptr;
    check_petsc(KSPGetPC(ksp, &pc), "preconditioner");
    check_petsc(PCSetType(pc, symmetric ? PCCHOLESKY : PCLU), "factorisation type");
    check_petsc(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS), "MUMPS");
    check_petsc(PCFactorSetUpMatSolverType(pc), "MUMPS");
    Mat factor = nullptr;
    check_petsc(PCFactorGetMatrix(pc, &factor), "MUMPS");
    check_petsc(MatMumpsSetIcntl(factor, 14, workspace_), "MUMPS workspace");
    check_petsc(MatMumpsSetIcntl(factor, 10, 2), "MUMPS refinement");
    check_petsc(MatMumpsSetIcntl(factor, 24, 1), "MUMPS null pivots");
  }

  /// Unknowns of null pivots were set to zero: right if the equations do not contradict each other.
  void check_residual(std::span<const double> rhs, std::span<const double> solution) const
  {
    double residual = 0, size = 0;
    for (Index i = 0; i < source_->n_rows(); ++i)
    {
      double row = rhs[i];
      for (Index k = source_->row_ptr[i]; k < source_->row_ptr[i + 1]; ++k)
        row -= source_->values[k] * solution[source_->col[k]];
      residual += row * row;
      size += rhs[i] * rhs[i];
    }
    if (!(std::sqrt(residual) <= contradiction * std::sqrt(size)))
      throw NumericalFailure("the tangent matrix is singular");
  }

  static PetscInt count_null_pivots(PC pc)
  {
    Mat factor = nullptr;
    PetscInt n = 0;
    check_petsc(PCFactorGetMatrix(pc, &factor), "MUMPS");
    check_petsc(MatMumpsGetInfog(factor, 28, &n), "MUMPS null pivots");
    return n;
  }

  const SparseMatrix *source_ = nullptr;
  PetscMatrix matrix_;
  KspHandle ksp_;
  bool symmetric_ = false;
  PetscInt n_null_pivots_ = 0, workspace_ = least_workspace;
  std::int64_t n_factorizations_ = 0, n_pattern_builds_ = 0, n_iterations_ = 0;
};
} // namespace

std::unique_ptr<LinearSolver> make_direct_solver()
{
  return std::make_unique<DirectSolver>();
}
} // namespace amontons
