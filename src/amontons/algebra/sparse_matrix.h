#pragma once
#include "amontons/base/ids.h"

#include <span>
#include <vector>

namespace amontons
{
/// A square matrix in compressed rows, the columns of a row sorted and each there once.
struct SparseMatrix
{
  std::vector<Index> row_ptr{0}; ///< [n_rows + 1]
  std::vector<Index> col;
  std::vector<double> values;
  int block_size = 1; ///< rows of a node: the pattern consists of square blocks of this size

  [[nodiscard]] Index n_rows() const { return static_cast<Index>(row_ptr.size()) - 1; }
};

/// Gives the matrix the pattern of the entries (rows[k], cols[k]), repeated ones once, and zero values.
/// @return position of each entry among the values
std::vector<Index> make_pattern(SparseMatrix &matrix, Index n, std::span<const Index> rows,
                                std::span<const Index> cols);

/// Is the matrix equal to its transpose, to round-off? Compares A x with A^T x for a vector of random numbers.
bool is_symmetric(const SparseMatrix &matrix);
} // namespace amontons
