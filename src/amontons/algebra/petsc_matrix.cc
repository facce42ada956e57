#include "amontons/algebra/petsc_matrix.h"

#include <algorithm>
#include <limits>

namespace amontons
{
PetscMatrix::PetscMatrix(const SparseMatrix &source, const Sharing &blocks)
  : source_(&source)
  , blocks_(&blocks)
{
  AMONTONS_ASSERT(source.n_rows() == blocks.size() * source.block_size);
  if (blocks.is_distributed())
    create_distributed();
  else
  {
    Mat matrix = nullptr;
    // PETSc's interface takes pointers to what it does not change.
    check_petsc(MatCreateSeqAIJWithArrays(
                    PETSC_COMM_SELF, source.n_rows(), source.n_rows(), const_cast<PetscInt *>(source.row_ptr.data()),
                    const_cast<PetscInt *>(source.col.data()), const_cast<double *>(source.values.data()), &matrix),
                "matrix");
    matrix_.reset(matrix);
    check_petsc(MatSetBlockSize(matrix, source.block_size), "block size");
  }
  Vec solution = nullptr, rhs = nullptr;
  check_petsc(MatCreateVecs(matrix_.get(), &solution, &rhs), "vectors");
  solution_.reset(solution);
  rhs_.reset(rhs);
}

MPI_Comm PetscMatrix::communicator_of(const Sharing &blocks)
{
  return blocks.is_distributed() ? blocks.messages()->communicator().mpi() : PETSC_COMM_SELF;
}

void PetscMatrix::create_distributed()
{
  const int size = source_->block_size;
  const GlobalIndex n_global = blocks_->n_global() * size;
  if (n_global > std::numeric_limits<PetscInt>::max())
    throw UserError("a system of " + std::to_string(n_global) + " unknowns: at most " +
                    std::to_string(std::numeric_limits<PetscInt>::max()) + " can be solved with this build of PETSc");
  const auto number = [&](Index row) { return static_cast<PetscInt>(blocks_->number(row / size) * size + row % size); };
  std::vector<PetscInt> rows, cols;
  rows.reserve(source_->col.size());
  cols.reserve(source_->col.size());
  for (Index row = 0; row < source_->n_rows(); ++row)
    for (Index k = source_->row_ptr[row]; k < source_->row_ptr[row + 1]; ++k)
    {
      rows.push_back(number(row));
      cols.push_back(number(source_->col[k]));
    }
  Mat matrix = nullptr;
  check_petsc(MatCreate(communicator_of(*blocks_), &matrix), "matrix");
  matrix_.reset(matrix);
  const auto n_own = static_cast<PetscInt>(blocks_->n_own() * size);
  check_petsc(MatSetSizes(matrix, n_own, n_own, static_cast<PetscInt>(n_global), static_cast<PetscInt>(n_global)),
              "matrix");
  check_petsc(MatSetBlockSize(matrix, size), "block size");
  check_petsc(MatSetType(matrix, MATMPIAIJ), "matrix");
  check_petsc(MatSetPreallocationCOO(matrix, static_cast<PetscCount>(rows.size()), rows.data(), cols.data()), "matrix");
}

VecHandle PetscMatrix::make_vector() const
{
  Vec vector = nullptr;
  check_petsc(VecDuplicate(rhs_.get(), &vector), "vector");
  return VecHandle(vector);
}

void PetscMatrix::values_changed()
{
  if (is_distributed())
  {
    check_petsc(MatSetValuesCOO(matrix_.get(), source_->values.data(), INSERT_VALUES), "values");
    return;
  }
  check_petsc(MatAssemblyBegin(matrix_.get(), MAT_FINAL_ASSEMBLY), "values");
  check_petsc(MatAssemblyEnd(matrix_.get(), MAT_FINAL_ASSEMBLY), "values");
}

bool PetscMatrix::is_symmetric() const
{
  return blocks_->true_on_all(amontons::is_symmetric(*source_));
}

void PetscMatrix::fill(Vec vector, std::span<const double> values) const
{
  const int size = source_->block_size;
  PetscScalar *array = nullptr;
  check_petsc(VecGetArrayWrite(vector, &array), "vector");
  PetscScalar *next = array;
  for (Index block = 0; block < blocks_->size(); ++block)
    if (blocks_->is_own(block))
      next = std::copy_n(&values[static_cast<std::size_t>(block) * size], size, next);
  check_petsc(VecRestoreArrayWrite(vector, &array), "vector");
}

void PetscMatrix::get_solution(std::span<double> values) const
{
  const int size = source_->block_size;
  const PetscScalar *array = nullptr;
  check_petsc(VecGetArrayRead(solution_.get(), &array), "vector");
  const PetscScalar *next = array;
  for (Index block = 0; block < blocks_->size(); ++block)
    if (blocks_->is_own(block))
    {
      std::copy_n(next, size, &values[static_cast<std::size_t>(block) * size]);
      next += size;
    }
  check_petsc(VecRestoreArrayRead(solution_.get(), &array), "vector");
  blocks_->take_owners(values, size);
}
} // namespace amontons
