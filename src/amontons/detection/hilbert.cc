#include "amontons/detection/hilbert.h"

#include "amontons/detection/box_kernels.h"
#include "amontons/detection/large_vector.h"

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
class Curve
{
public:
  using Point = std::array<double, static_cast<std::size_t>(dim)>;
  static constexpr int most_bits = std::min(30, 60 / dim);

  explicit Curve(std::span<const Point> points)
    : points_(points)
  {
    low_.fill(std::numeric_limits<double>::infinity());
    Point high;
    high.fill(-std::numeric_limits<double>::infinity());
    for (const Point &x : points)
      for (std::size_t c = 0; c < dim; ++c)
      {
        low_[c] = std::min(low_[c], x[c]);
        high[c] = std::max(high[c], x[c]);
      }
    for (std::size_t c = 0; c < dim; ++c)
      size_ = std::max(size_, high[c] - low_[c]);
  }

  // Sets the positions of the keys' points on the curve of 2^bits cells a side.
  void place(std::span<Key> keys, int bits) const;

private:
  std::span<const Point> points_;
  Point low_;
  double size_ = 0;
};

template<int dim>
void Curve<dim>::place(std::span<Key> keys, int bits) const
{
  const double scale = size_ > 0 ? (static_cast<double>(1U << bits) - 1) / size_ : 0;
  constexpr std::size_t block = 256;
  std::array<std::array<std::uint32_t, block>, dim> cells{};
  std::array<std::uint32_t *, dim> rows;
  for (std::size_t c = 0; c < dim; ++c)
    rows[c] = cells[c].data();
  std::array<std::uint64_t, block> positions;
  for (std::size_t first = 0; first < keys.size(); first += block)
  {
    const std::size_t n = std::min(block, keys.size() - first);
    for (std::size_t i = 0; i < n; ++i)
    {
      const Point &x = points_[keys[first + i].index];
      for (std::size_t c = 0; c < dim; ++c)
        cells[c][i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(scale * (x[c] - low_[c])));
    }
    box_kernels<dim>().hilbert(rows.data(), static_cast<int>((n + 15) / 16 * 16), bits, positions.data());
    for (std::size_t i = 0; i < n; ++i)
      keys[first + i].position = positions[i];
  }
}

// Stable, by `n_bits` of the position from `shift` on.
void counting_sort(std::span<const Key> from, std::span<Key> to, int shift, int n_bits)
{
  const std::uint64_t mask = (std::uint64_t{1} << n_bits) - 1;
  std::vector<std::uint32_t> place(mask + 2, 0);
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
  constexpr int few = 8, digit = 11;
  const Curve<dim> curve(points);
  LargeVector<Key> keys(points.size()), sorted(points.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    keys[i].index = static_cast<Index>(i);
  // Cells about as fine as the points, were these spread evenly over a surface across the cube.
  const int bits = std::min(static_cast<int>(std::bit_width(points.size())) / (dim - 1) + 1, Curve<dim>::most_bits);
  curve.place(keys, bits);
  for (int done = 0; done < bits * dim; done += digit)
  {
    counting_sort(keys, sorted, done, std::min(digit, bits * dim - done));
    keys.swap(sorted);
  }
  for (auto first = keys.begin(); first != keys.end();)
  {
    auto last = first + 1;
    while (last != keys.end() && last->position == first->position)
      ++last;
    if (last - first > few)
    {
      curve.place({first, last}, Curve<dim>::most_bits);
      std::stable_sort(first, last, [](const Key &a, const Key &b) { return a.position < b.position; });
    }
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
