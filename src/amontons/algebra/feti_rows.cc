#include "amontons/algebra/feti_rows.h"

#include <algorithm>

namespace amontons
{
void FetiRows::push_back(std::vector<Entry> &row)
{
  std::sort(row.begin(), row.end(), [](const Entry &a, const Entry &b) { return a.first < b.first; });
  const auto first = static_cast<std::ptrdiff_t>(entries_.size());
  for (const Entry &entry : row)
    if (static_cast<std::ptrdiff_t>(entries_.size()) > first && entries_.back().first == entry.first)
      entries_.back().second += entry.second;
    else
      entries_.push_back(entry);
  entries_.erase(
      std::remove_if(entries_.begin() + first, entries_.end(), [](const Entry &entry) { return entry.second == 0; }),
      entries_.end());
  offsets_.push_back(static_cast<Index>(entries_.size()));
}

void FetiRows::multiply(std::span<const double> x, double *y) const
{
  for (Index row = 0; row < size(); ++row)
  {
    double sum = 0;
    for (Index k = offsets_[row]; k < offsets_[row + 1]; ++k)
      sum += entries_[k].second * x[entries_[k].first];
    y[row] = sum;
  }
}

void FetiRows::multiply_transposed_add(const double *x, std::span<double> y) const
{
  const auto n = static_cast<Index>(y.size());
  for (Index row = 0; row < size(); ++row)
    for (Index k = offsets_[row]; k < offsets_[row + 1] && entries_[k].first < n; ++k)
      y[entries_[k].first] += entries_[k].second * x[row];
}
} // namespace amontons
