#include "amontons/algebra/feti_scaling.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
/// What is left of a vector on the interval at the most.
constexpr double accuracy = 0.1;
/// The interval's ends are not further apart than this, so that the degree stays below 50.
constexpr double widest = 1000;
} // namespace

void FetiScaling::set(const FetiRows &rows, std::span<const double> inverse_stiffness, double least,
                      const Sharing &rows_sharing)
{
  scaled_.clear();
  std::vector<Index> place(inverse_stiffness.size(), -1);
  std::vector<double> lengths; // of columns, in the sum of absolutes
  std::vector<FetiRows::Entry> row;
  n_columns_ = 0;
  for (Index r = 0; r < rows.size(); ++r)
  {
    row.clear();
    for (const auto &[column, coefficient] : rows[r])
      if (inverse_stiffness[column] > 0)
      {
        if (place[column] < 0)
        {
          place[column] = n_columns_++;
          lengths.push_back(0);
        }
        row.emplace_back(place[column], coefficient * std::sqrt(inverse_stiffness[column]));
        lengths[place[column]] += std::abs(row.back().second);
      }
    scaled_.push_back(row);
  }
  std::vector<double> sums(static_cast<std::size_t>(rows.size()), 0.0);
  for (Index r = 0; r < rows.size(); ++r)
    for (const auto &[column, coefficient] : scaled_[r])
      sums[r] += std::abs(coefficient) * lengths[column];
  rows_sharing.sum(sums);
  const double greatest =
      rows_sharing.maximum_over_processes(sums.empty() ? 0. : *std::max_element(sums.begin(), sums.end()));
  least = std::clamp(least, greatest / widest, greatest);
  center_ = 0.5 * (greatest + least);
  radius_ = 0.5 * (greatest - least);
  degree_ = 1;
  if (radius_ > 0)
    degree_ = std::max(1, static_cast<int>(std::ceil(std::acosh(1 / accuracy) / std::acosh(center_ / radius_))));
}

void FetiScaling::apply(std::span<double> values, const Sharing &rows_sharing) const
{
  if (center_ == 0) // no row anywhere
    return;
  const std::size_t n = values.size();
  std::vector<double> step(n), product(n), x(n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    step[i] = values[i] / center_;
  double rho = radius_ / center_;
  for (int k = 1;; ++k)
  {
    for (std::size_t i = 0; i < n; ++i)
      x[i] += step[i];
    if (k == degree_)
      break;
    std::vector<double> pulled(static_cast<std::size_t>(n_columns_), 0.0);
    scaled_.multiply_transposed_add(step.data(), pulled);
    scaled_.multiply(pulled, product.data());
    rows_sharing.sum(product);
    const double next = 1 / (2 * center_ / radius_ - rho);
    for (std::size_t i = 0; i < n; ++i)
    {
      values[i] -= product[i];
      step[i] = next * (rho * step[i] + 2 / radius_ * values[i]);
    }
    rho = next;
  }
  std::copy(x.begin(), x.end(), values.begin());
}
} // namespace amontons
