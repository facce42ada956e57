#include "amontons/algebra/linear_solver.h"
#include "amontons/algebra/petsc.h"

namespace amontons
{
namespace
{
class DirectSolver : public LinearSolver
{
public:
  void set_pattern(Index n, std::span<const Index> rows, std::span<const Index> cols) override
  {
    ksp_.reset();
    matrix_.reset();
    Mat matrix = nullptr;
    check_petsc(MatCreate(PETSC_COMM_SELF, &matrix), "matrix");
    matrix_.reset(matrix);
    check_petsc(MatSetSizes(matrix, n, n, n, n), "matrix sizes");
    check_petsc(MatSetType(matrix, MATSEQAIJ), "matrix type");
    // PETSc reorders the lists it is given.
    std::vector<PetscInt> i(rows.begin(), rows.end()), j(cols.begin(), cols.end());
    check_petsc(MatSetPreallocationCOO(matrix, static_cast<PetscCount>(i.size()), i.data(), j.data()), "pattern");

    Vec solution = nullptr, rhs = nullptr;
    check_petsc(MatCreateVecs(matrix, &solution, &rhs), "vectors");
    solution_.reset(solution);
    rhs_.reset(rhs);
    create_ksp();
    ++n_pattern_builds_;
  }

  void set_values(std::span<const double> values) override
  {
    check_petsc(MatSetValuesCOO(matrix_.get(), values.data(), INSERT_VALUES), "values");
  }

  void factorize() override
  {
    ++n_factorizations_;
    check_petsc(KSPSetOperators(ksp_.get(), matrix_.get(), matrix_.get()), "operator");
    check_petsc(KSPSetUp(ksp_.get()), "factorisation");
    PC pc = nullptr;
    PCFailedReason reason = PC_NOERROR;
    check_petsc(KSPGetPC(ksp_.get(), &pc), "factorisation");
    check_petsc(PCGetFailedReason(pc, &reason), "factorisation");
    if (reason != PC_NOERROR)
    {
      create_ksp(); // a factorisation that failed is of no further use to PETSc
      throw NumericalFailure(reason == PC_FACTOR_OUTMEMORY ? "the factorisation ran out of memory"
                                                           : "the tangent matrix is singular");
    }
  }

  void solve(std::span<const double> rhs, std::span<double> solution) override
  {
    copy_in(rhs);
    check_petsc(KSPSolve(ksp_.get(), rhs_.get(), solution_.get()), "solution");
    ++n_iterations_;
    copy_out(solution);
  }

  [[nodiscard]] std::int64_t n_factorizations() const override { return n_factorizations_; }
  [[nodiscard]] std::int64_t n_pattern_builds() const override { return n_pattern_builds_; }
  [[nodiscard]] std::int64_t n_iterations() const override { return n_iterations_; }

private:
  void create_ksp()
  {
    KSP ksp = nullptr;
    check_petsc(KSPCreate(PETSC_COMM_SELF, &ksp), "solver");
    ksp_.reset(ksp);
    check_petsc(KSPSetOperators(ksp, matrix_.get(), matrix_.get()), "operator");
    check_petsc(KSPSetType(ksp, KSPPREONLY), "solver type");
    PC pc = nullptr;
    check_petsc(KSPGetPC(ksp, &pc), "preconditioner");
    check_petsc(PCSetType(pc, PCLU), "factorisation type");
    check_petsc(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS), "MUMPS");
    check_petsc(PCFactorSetUpMatSolverType(pc), "MUMPS");
    Mat factor = nullptr;
    check_petsc(PCFactorGetMatrix(pc, &factor), "MUMPS");
    check_petsc(MatMumpsSetIcntl(factor, 14, 50), "MUMPS workspace"); // per cent: pivoting in saddle points fills in
    check_petsc(MatMumpsSetIcntl(factor, 10, 2), "MUMPS refinement");
  }

  void copy_in(std::span<const double> rhs)
  {
    PetscScalar *array = nullptr;
    check_petsc(VecGetArrayWrite(rhs_.get(), &array), "vector");
    std::copy(rhs.begin(), rhs.end(), array);
    check_petsc(VecRestoreArrayWrite(rhs_.get(), &array), "vector");
  }

  void copy_out(std::span<double> solution)
  {
    const PetscScalar *array = nullptr;
    check_petsc(VecGetArrayRead(solution_.get(), &array), "vector");
    std::copy(array, array + solution.size(), solution.begin());
    check_petsc(VecRestoreArrayRead(solution_.get(), &array), "vector");
  }

  MatHandle matrix_;
  VecHandle solution_, rhs_;
  KspHandle ksp_;
  std::int64_t n_factorizations_ = 0, n_pattern_builds_ = 0, n_iterations_ = 0;
};
} // namespace

std::unique_ptr<LinearSolver> make_direct_solver()
{
  return std::make_unique<DirectSolver>();
}
} // namespace amontons
