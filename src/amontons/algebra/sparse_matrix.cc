#include "amontons/algebra/sparse_matrix.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace amontons
{
std::vector<Index> make_pattern(SparseMatrix &matrix, Index n, std::span<const Index> rows, std::span<const Index> cols)
{
  std::vector<std::size_t> first(static_cast<std::size_t>(n) + 1, 0);
  for (const Index row : rows)
    ++first[row + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::size_t> by_row(rows.size()), next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < rows.size(); ++k)
    by_row[next[rows[k]]++] = k;

  matrix.row_ptr.assign(1, 0);
  matrix.col.clear();
  std::vector<Index> position(rows.size());
  for (Index row = 0; row < n; ++row)
  {
    const auto begin = by_row.begin() + static_cast<std::ptrdiff_t>(first[row]),
               end = by_row.begin() + static_cast<std::ptrdiff_t>(first[row + 1]);
    std::sort(begin, end, [&](std::size_t a, std::size_t b) { return cols[a] < cols[b]; });
    for (auto k = begin; k != end; ++k)
    {
      if (k == begin || cols[*k] != matrix.col.back())
        matrix.col.push_back(cols[*k]);
      position[*k] = static_cast<Index>(matrix.col.size()) - 1;
    }
    matrix.row_ptr.push_back(static_cast<Index>(matrix.col.size()));
  }
  matrix.values.assign(matrix.col.size(), 0);
  return position;
}

bool is_symmetric(const SparseMatrix &matrix)
{
  constexpr double round_off = 1e-13;
  std::mt19937 random(1);
  const auto n = static_cast<std::size_t>(matrix.n_rows());
  std::vector<double> x(n), difference(n, 0.0), size(n, 0.0);
  for (double &value : x)
    value = 0.5 + static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  for (Index i = 0; i < matrix.n_rows(); ++i)
    for (Index k = matrix.row_ptr[i]; k < matrix.row_ptr[i + 1]; ++k)
    {
      const Index j = matrix.col[k];
      difference[i] += matrix.values[k] * x[j];
      difference[j] -= matrix.values[k] * x[i];
      size[i] += std::abs(matrix.values[k] * x[j]);
    }
  for (std::size_t i = 0; i < n; ++i)
    if (std::abs(difference[i]) > round_off * static_cast<double>(n > 1000 ? 1000 : n) * size[i])
      return false;
  return true;
}
} // namespace amontons
