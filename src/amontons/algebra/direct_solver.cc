#include "amontons/algebra/linear_solver.h"
#include "amontons/algebra/petsc.h"
#include "amontons/algebra/petsc_matrix.h"

namespace amontons
{
namespace
{
/// Residual, over the right side, with which equations of a singular matrix count as free of contradiction; and from
/// which a solution is none: round-off can hide that the matrix is singular, a pivot of 1e-16 in the place of zero.
constexpr double contradiction = 1e-9, no_solution = 1e-3;
/// A residual that is this part of the matrix's norm times the solution's is round-off, unless those are beyond what
/// double precision tells from a singular matrix, over the right side.
constexpr double lost = 1e-12, most_resisted = 1e15;

/// Room beyond what the analysis foresees, per cent.
constexpr PetscInt least_workspace = 50, most_workspace = 3200;

/// Times that a solution is refined by its residual.
constexpr PetscInt refinements = 2;

class DirectSolver : public LinearSolver
{
public:
  void set_matrix(const SparseMatrix &matrix, const Sharing &blocks) override
  {
    ksp_.reset();
    matrix_ = PetscMatrix(matrix, blocks);
    is_first_ = blocks.rank() == 0;
    ++n_pattern_builds_;
  }

  void factorize() override
  {
    n_factorizations_ += is_first_ ? 1 : 0; // one for all processes
    matrix_.values_changed();
    const bool symmetric = matrix_.is_symmetric();
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
    check_residual();
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
    check_petsc(KSPCreate(matrix_.communicator(), &ksp), "solver");
    ksp_.reset(ksp);
    check_petsc(MatSetOption(matrix_.get(), MAT_SYMMETRIC, symmetric ? PETSC_TRUE : PETSC_FALSE), "symmetry");
    check_petsc(KSPSetOperators(ksp, matrix_.get(), matrix_.get()), "operator");
    choose_refinement(ksp);
    PC pc = nullptr;
    check_petsc(KSPGetPC(ksp, &pc), "preconditioner");
    check_petsc(PCSetType(pc, symmetric ? PCCHOLESKY : PCLU), "factorisation type");
    check_petsc(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS), "MUMPS");
    check_petsc(PCFactorSetUpMatSolverType(pc), "MUMPS");
    Mat factor = nullptr;
    check_petsc(PCFactorGetMatrix(pc, &factor), "MUMPS");
    check_petsc(MatMumpsSetIcntl(factor, 14, workspace_), "MUMPS workspace");
    check_petsc(MatMumpsSetIcntl(factor, 10, refinements), "MUMPS refinement");
    check_petsc(MatMumpsSetIcntl(factor, 24, 1), "MUMPS null pivots");
    // A last front that processes factorise together (by ScaLAPACK) would hide its null pivots.
    if (matrix_.is_distributed())
      check_petsc(MatMumpsSetIcntl(factor, 13, 1), "MUMPS root");
  }

  /// MUMPS itself refines a solution on one process only.
  void choose_refinement(KSP ksp) const
  {
    check_petsc(KSPSetType(ksp, matrix_.is_distributed() ? KSPRICHARDSON : KSPPREONLY), "solver type");
    check_petsc(KSPSetNormType(ksp, KSP_NORM_NONE), "norm");
    check_petsc(KSPSetTolerances(ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, 1 + refinements), "refinement");
  }

  /// Unknowns of null pivots were set to zero: right if the equations do not contradict each other. Where no pivot was
  /// null a residual may be no more than what is lost to round-off in a nearly singular matrix.
  void check_residual() const
  {
    const VecHandle residual = matrix_.make_vector();
    double left = 0, size = 0;
    check_petsc(MatMult(matrix_.get(), matrix_.solution(), residual.get()), "residual");
    check_petsc(VecAYPX(residual.get(), -1, matrix_.rhs()), "residual");
    check_petsc(VecNorm(residual.get(), NORM_2, &left), "residual");
    check_petsc(VecNorm(matrix_.rhs(), NORM_2, &size), "residual");
    const bool solves = left <= (n_null_pivots_ > 0 ? contradiction : no_solution) * size;
    if (!solves && (n_null_pivots_ > 0 || !is_round_off(left, size)))
      throw NumericalFailure("the tangent matrix is singular");
  }

  [[nodiscard]] bool is_round_off(double left, double size) const
  {
    double largest = 0, length = 0;
    check_petsc(MatNorm(matrix_.get(), NORM_INFINITY, &largest), "residual");
    check_petsc(VecNorm(matrix_.solution(), NORM_2, &length), "residual");
    const double resisted = largest * length;
    return left <= lost * resisted && resisted <= most_resisted * size;
  }

  static PetscInt count_null_pivots(PC pc)
  {
    Mat factor = nullptr;
    PetscInt n = 0;
    check_petsc(PCFactorGetMatrix(pc, &factor), "MUMPS");
    check_petsc(MatMumpsGetInfog(factor, 28, &n), "MUMPS null pivots");
    return n;
  }

  PetscMatrix matrix_;
  KspHandle ksp_;
  bool is_first_ = true;
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
