#include "amontons/algebra/amg_solver.h"

#include "amontons/algebra/linear_solver_failure.h"

#include "amontons/algebra/petsc_matrix.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
/// Iterations after which GMRES starts again: vectors kept.
constexpr PetscInt restart = 60;
constexpr PetscInt max_iterations = 1000;
/// Least residual over the right side that is asked for: round-off of large systems.
constexpr double least_reduction = 1e-12;
/// A kept hierarchy is made anew when the iterations that it took beyond a fresh one's are worth a set-up, which costs
/// about as much as this many iterations (27 to 33 measured, 3D, 7e4 to 4e5 unknowns); within a solve when it takes
/// more than `hopeless` times a fresh one's.
constexpr double setup_in_iterations = 30, hopeless = 3;

class AmgSolver : public LinearSolver
{
public:
  void set_matrix(const SparseMatrix &matrix, const Sharing &blocks) override
  {
    ksp_.reset();
    matrix_ = PetscMatrix(matrix, blocks);
    ++n_pattern_builds_;
  }

  [[nodiscard]] bool wants_smooth_modes() const override { return true; }
  void set_smooth_modes(std::vector<std::vector<double>> modes) override { modes_ = std::move(modes); }

  void factorize() override
  {
    matrix_.values_changed();
    symmetric_ = matrix_.is_symmetric();
    if (!ksp_ || worse_)
      set_up();
    else
    {
      choose_method();
      fresh_ = false;
    }
  }

  void solve(std::span<const double> rhs, std::span<double> solution, double tolerance) override
  {
    matrix_.set_rhs(rhs);
    check_petsc(VecSet(matrix_.solution(), 0), "start");
    double norm = 0;
    check_petsc(VecNorm(matrix_.rhs(), NORM_2, &norm), "norm");
    tolerance = std::max(tolerance, least_reduction * norm);
    if (norm > tolerance)
    {
      const double digits = std::log10(norm / tolerance);
      const bool converged = iterate(tolerance, fresh_ ? max_iterations : allowed_iterations(digits));
      if (!converged && fresh_)
        throw LinearSolverFailure("the linear solver (multigrid) does not converge");
      if (!converged)
      {
        set_up();
        check_petsc(VecSet(matrix_.solution(), 0), "start");
        if (!iterate(tolerance, max_iterations))
          throw LinearSolverFailure("the linear solver (multigrid) does not converge");
      }
      judge(digits);
    }
    matrix_.get_solution(solution);
  }

  [[nodiscard]] std::int64_t n_preconditioner_setups() const override { return n_setups_; }
  [[nodiscard]] std::int64_t n_pattern_builds() const override { return n_pattern_builds_; }
  [[nodiscard]] std::int64_t n_iterations() const override { return n_iterations_; }

private:
  [[nodiscard]] PetscInt allowed_iterations(double digits) const
  {
    return static_cast<PetscInt>(std::ceil(hopeless * std::max(iterations_per_digit_ * digits, 3.)));
  }

  /// @return whether the residual went below the tolerance
  bool iterate(double tolerance, PetscInt most)
  {
    check_petsc(KSPSetTolerances(ksp_.get(), 1e-50, tolerance, PETSC_DEFAULT, most), "tolerance");
    check_petsc(KSPSolve(ksp_.get(), matrix_.rhs(), matrix_.solution()), "solution");
    check_petsc(KSPGetIterationNumber(ksp_.get(), &n_last_), "iterations");
    n_iterations_ += n_last_;
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    check_petsc(KSPGetConvergedReason(ksp_.get(), &reason), "convergence");
    return reason > 0;
  }

  void judge(double digits)
  {
    const double now = n_last_ / std::max(digits, 1.);
    if (fresh_)
      iterations_per_digit_ = std::max(now, 1.);
    excess_ += std::max(0., n_last_ - iterations_per_digit_ * std::max(digits, 1.));
    worse_ = excess_ > setup_in_iterations;
  }

  /// The iteration that the matrix allows, about the same hierarchy.
  void choose_method()
  {
    check_petsc(MatSetOption(matrix_.get(), MAT_SYMMETRIC, symmetric_ ? PETSC_TRUE : PETSC_FALSE), "symmetry");
    check_petsc(KSPSetType(ksp_.get(), symmetric_ ? KSPCG : KSPGMRES), "solver type");
    if (!symmetric_)
      check_petsc(KSPGMRESSetRestart(ksp_.get(), restart), "restart");
    check_petsc(KSPSetPCSide(ksp_.get(), symmetric_ ? PC_LEFT : PC_RIGHT), "side");
    check_petsc(KSPSetNormType(ksp_.get(), KSP_NORM_UNPRECONDITIONED), "norm");
  }

  void set_up()
  {
    KSP ksp = nullptr;
    check_petsc(KSPCreate(matrix_.communicator(), &ksp), "solver");
    ksp_.reset(ksp);
    check_petsc(KSPSetOptionsPrefix(ksp, "amontons_"), "options");
    attach_modes();
    check_petsc(KSPSetOperators(ksp, matrix_.get(), matrix_.get()), "operator");
    choose_method();
    check_petsc(KSPSetInitialGuessNonzero(ksp, PETSC_TRUE), "start");
    make_hierarchy(ksp);
    check_petsc(KSPSetUp(ksp), "multigrid");
    check_petsc(KSPSetReusePreconditioner(ksp, PETSC_TRUE), "multigrid");
    ++n_setups_;
    fresh_ = true;
    worse_ = false;
    excess_ = 0;
  }

  static void make_hierarchy(KSP ksp)
  {
    PC pc = nullptr;
    check_petsc(KSPGetPC(ksp, &pc), "preconditioner");
    check_petsc(PCSetType(pc, PCGAMG), "multigrid");
    check_petsc(PCGAMGSetType(pc, PCGAMGAGG), "aggregation");
    check_petsc(PCGAMGSetNSmooths(pc, 1), "smoothed aggregation");
    PetscReal threshold = 0; // entries that only other statuses fill are zero: no neighbours
    check_petsc(PCGAMGSetThreshold(pc, &threshold, 1), "threshold");
    check_petsc(PCSetFromOptions(pc), "options");
  }

  /// The near kernel, orthonormal as PETSc wants it.
  void attach_modes()
  {
    std::vector<VecHandle> vectors;
    std::vector<Vec> basis;
    for (const auto &mode : modes_)
    {
      Vec vector = vectors.emplace_back(matrix_.make_vector()).get();
      matrix_.fill(vector, mode);
      double before = 0, after = 0;
      check_petsc(VecNorm(vector, NORM_2, &before), "modes");
      for (Vec other : basis)
      {
        double product = 0;
        check_petsc(VecDot(vector, other, &product), "modes");
        check_petsc(VecAXPY(vector, -product, other), "modes");
      }
      check_petsc(VecNormalize(vector, &after), "modes");
      if (after > 1e-6 * before)
        basis.push_back(vector);
    }
    MatNullSpace space = nullptr;
    check_petsc(MatNullSpaceCreate(matrix_.communicator(), PETSC_FALSE, static_cast<PetscInt>(basis.size()),
                                   basis.data(), &space),
                "modes");
    check_petsc(MatSetNearNullSpace(matrix_.get(), space), "modes");
    check_petsc(MatNullSpaceDestroy(&space), "modes");
  }

  PetscMatrix matrix_;
  KspHandle ksp_;
  std::vector<std::vector<double>> modes_;
  bool symmetric_ = false, fresh_ = false, worse_ = false;
  double iterations_per_digit_ = 0, excess_ = 0;
  PetscInt n_last_ = 0;
  std::int64_t n_setups_ = 0, n_pattern_builds_ = 0, n_iterations_ = 0;
};
} // namespace

std::unique_ptr<LinearSolver> make_amg_solver()
{
  return std::make_unique<AmgSolver>();
}
} // namespace amontons
