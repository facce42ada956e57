#pragma once
#include "amontons/base/ids.h"

#include <span>
#include <utility>
#include <vector>

namespace amontons
{
/// Rows of a sparse matrix, one after another.
class FetiRows
{
public:
  using Entry = std::pair<Index, double>; ///< column, coefficient

  [[nodiscard]] Index size() const { return static_cast<Index>(offsets_.size()) - 1; }
  [[nodiscard]] std::span<const Entry> operator[](Index row) const
  {
    return {entries_.data() + offsets_[row], static_cast<std::size_t>(offsets_[row + 1] - offsets_[row])};
  }
  void clear()
  {
    offsets_.assign(1, 0);
    entries_.clear();
  }
  /// Entries of equal column are summed, zeros left out. @param row sorted by column on return
  void push_back(std::vector<Entry> &row);
  void scale(Index row, double factor)
  {
    for (Index k = offsets_[row]; k < offsets_[row + 1]; ++k)
      entries_[k].second *= factor;
  }

  /// y = A x. @param y [size()]
  void multiply(std::span<const double> x, double *y) const;
  /// y += A^T x; columns beyond the end of y are left out. @param x [size()]
  void multiply_transposed_add(const double *x, std::span<double> y) const;

  friend bool operator==(const FetiRows &, const FetiRows &) = default;

private:
  std::vector<Index> offsets_{0};
  std::vector<Entry> entries_;
};
} // namespace amontons
