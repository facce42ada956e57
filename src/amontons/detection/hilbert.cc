#include "amontons/detection/hilbert.h"

#include "amontons/detection/box_kernels.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace amontons
{
namespace
{
struct Key
{
  std::uint64_t position;
  Index index;
};

template<int dim>
std::vector<Key> keys_of(std::span<const std::array<double, static_cast<std::size_t>(dim)>> points, int bits)
{
  std::array<double, dim> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const auto &x : points)
    for (int c = 0; c < dim; ++c)
    {
      low[c] = std::min(low[c], x[c]);
      high[c] = std::max(high[c], x[c]);
    }
  double size = 0;
  for (int c = 0; c < dim; ++c)
    size = std::max(size, high[c] - low[c]);
  const double scale = size > 0 ? (static_cast<double>(1U << bits) - 1) / size : 0;
  constexpr std::size_t block = 256;
  std::array<std::array<std::uint32_t, block>, dim> cells{};
  std::array<const std::uint32_t *, dim> rows;
  for (int c = 0; c < dim; ++c)
    rows[c] = cells[c].data();
  std::array<std::uint64_t, block> positions;
  std::vector<Key> keys(points.size());
  for (std::size_t first = 0; first < points.size(); first += block)
  {
    const std::size_t n = std::min(block, points.size() - first);
    for (std::size_t i = 0; i < n; ++i)
      for (int c = 0; c < dim; ++c)
        cells[c][i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(scale * (points[first + i][c] - low[c])));
    box_kernels<dim>().hilbert(rows.data(), static_cast<int>((n + 15) / 16 * 16), bits, positions.data());
    for (std::size_t i = 0; i < n; ++i)
      keys[first + i] = {positions[i], static_cast<Index>(first + i)};
  }
  return keys;
}

// Stable, by `n_bits` of the position from `shift` on.
void counting_sort(const std::vector<Key> &from, std::vector<Key> &to, int shift, int n_bits)
{
  const std::uint64_t mask = (std::uint64_t{1} << n_bits) - 1;
  std::vector<std::size_t> place(mask + 2, 0);
  for (const Key &key : from)
    ++place[(key.position >> shift & mask) + 1];
  for (std::size_t i = 1; i < place.size(); ++i)
    place[i] += place[i - 1];
  for (const Key &key : from)
    to[place[key.position >> shift & mask]++] = key;
}
} // namespace

template<int dim>
std::vector<Index> curve_order(std::span<const std::array<double, static_cast<std::size_t>(dim)>> points)
{
  constexpr int bits = std::min(30, 60 / dim), few = 8, digit = 11;
  std::vector<Key> keys = keys_of<dim>(points, bits), sorted(keys.size());
  // The leading bits: a cell or two per point, were they spread evenly over a surface across the cube.
  const int per_axis = std::bit_width(points.size()) / (dim - 1) + 2;
  const int leading = std::min((per_axis * dim + digit - 1) / digit * digit, bits * dim);
  for (int done = 0; done < leading; done += digit)
  {
    counting_sort(keys, sorted, bits * dim - leading + done, std::min(digit, leading - done));
    keys.swap(sorted);
  }
  const auto cell_of = [&](const Key &key) { return key.position >> (bits * dim - leading); };
  for (auto first = keys.begin(); first != keys.end();)
  {
    auto last = first + 1;
    while (last != keys.end() && cell_of(*last) == cell_of(*first))
      ++last;
    if (last - first > few)
      std::stable_sort(first, last, [](const Key &a, const Key &b) { return a.position < b.position; });
    first = last;
  }
  std::vector<Index> order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    order[i] = keys[i].index;
  return order;
}

template std::vector<Index> curve_order<2>(std::span<const std::array<double, 2>>);
template std::vector<Index> curve_order<3>(std::span<const std::array<double, 3>>);
} // namespace amontons
