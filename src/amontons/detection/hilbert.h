#pragma once
#include "amontons/base/ids.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace amontons
{
/// Position along the Hilbert curve of a cell of a cube of 2^bits cells a side (Skilling 2004, AIP Conf. Proc. 707: the
/// coordinates are turned in place into the bits of the position, axis by axis).
template<int dim, int bits>
std::uint64_t hilbert_position(std::array<std::uint32_t, dim> x)
{
  static_assert(dim * bits <= 64);
  for (std::uint32_t level = 1U << (bits - 1); level > 1; level >>= 1)
  {
    const std::uint32_t below = level - 1;
    for (int c = 0; c < dim; ++c)
      if (x[c] & level)
        x[0] ^= below;
      else
      {
        const std::uint32_t differ = (x[0] ^ x[c]) & below;
        x[0] ^= differ;
        x[c] ^= differ;
      }
  }
  for (int c = 1; c < dim; ++c)
    x[c] ^= x[c - 1];
  std::uint32_t flip = 0;
  for (std::uint32_t level = 1U << (bits - 1); level > 1; level >>= 1)
    if (x[dim - 1] & level)
      flip ^= level - 1;
  std::uint64_t position = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (int c = 0; c < dim; ++c)
      position = position << 1 | (((x[c] ^ flip) >> bit) & 1U);
  return position;
}

/// The given points along the Hilbert curve of their bounding cube: indices in that order.
template<int dim>
std::vector<Index> curve_order(std::span<const std::array<double, static_cast<std::size_t>(dim)>> points)
{
  constexpr int bits = std::min(30, 60 / dim);
  std::array<double, static_cast<std::size_t>(dim)> low;
  low.fill(std::numeric_limits<double>::infinity());
  for (const auto &x : points)
    for (std::size_t c = 0; c < x.size(); ++c)
      low[c] = std::min(low[c], x[c]);
  double size = 0;
  for (const auto &x : points)
    for (std::size_t c = 0; c < x.size(); ++c)
      size = std::max(size, x[c] - low[c]);
  const double scale = size > 0 ? (static_cast<double>(1U << bits) - 1) / size : 0;
  std::vector<std::pair<std::uint64_t, Index>> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    std::array<std::uint32_t, dim> cell;
    for (std::size_t c = 0; c < cell.size(); ++c)
      cell[c] = static_cast<std::uint32_t>(scale * (points[i][c] - low[c]));
    keys[i] = {hilbert_position<dim, bits>(cell), static_cast<Index>(i)};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    order[i] = keys[i].second;
  return order;
}
} // namespace amontons
