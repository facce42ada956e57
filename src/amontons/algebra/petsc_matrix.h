#pragma once
#include "amontons/algebra/petsc.h"
#include "amontons/algebra/sparse_matrix.h"

#include <algorithm>
#include <span>

namespace amontons
{
/// A matrix of ours seen by PETSc without a copy, with a right side and a solution, on the calling process.
class PetscMatrix
{
public:
  PetscMatrix() = default;
  explicit PetscMatrix(const SparseMatrix &source)
  {
    const PetscInt n = source.n_rows();
    Mat matrix = nullptr;
    // PETSc's interface takes pointers to what it does not change.
    check_petsc(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, const_cast<PetscInt *>(source.row_ptr.data()),
                                          const_cast<PetscInt *>(source.col.data()),
                                          const_cast<double *>(source.values.data()), &matrix),
                "matrix");
    matrix_.reset(matrix);
    check_petsc(MatSetBlockSize(matrix, source.block_size), "block size");
    Vec solution = nullptr, rhs = nullptr;
    check_petsc(MatCreateVecs(matrix, &solution, &rhs), "vectors");
    solution_.reset(solution);
    rhs_.reset(rhs);
  }

  [[nodiscard]] Mat get() const { return matrix_.get(); }
  [[nodiscard]] Vec rhs() const { return rhs_.get(); }
  [[nodiscard]] Vec solution() const { return solution_.get(); }

  void values_changed()
  {
    check_petsc(MatAssemblyBegin(matrix_.get(), MAT_FINAL_ASSEMBLY), "values");
    check_petsc(MatAssemblyEnd(matrix_.get(), MAT_FINAL_ASSEMBLY), "values");
  }

  void set_rhs(std::span<const double> values) { fill(rhs_.get(), values); }
  void get_solution(std::span<double> values) const
  {
    const PetscScalar *array = nullptr;
    check_petsc(VecGetArrayRead(solution_.get(), &array), "vector");
    std::copy(array, array + values.size(), values.begin());
    check_petsc(VecRestoreArrayRead(solution_.get(), &array), "vector");
  }
  static void fill(Vec vector, std::span<const double> values)
  {
    PetscScalar *array = nullptr;
    check_petsc(VecGetArrayWrite(vector, &array), "vector");
    std::copy(values.begin(), values.end(), array);
    check_petsc(VecRestoreArrayWrite(vector, &array), "vector");
  }

private:
  MatHandle matrix_;
  VecHandle solution_, rhs_;
};
} // namespace amontons
