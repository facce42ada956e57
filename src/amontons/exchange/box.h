#pragma once
#include "amontons/base/ids.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace amontons
{
/// A point; in the plane z = 0.
using Place = std::array<double, 3>;

/// A box along the axes; in the plane z = 0. Empty as it begins.
struct Box
{
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Place low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};

  void include(const Place &x)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      low[c] = std::min(low[c], x[c]);
      high[c] = std::max(high[c], x[c]);
    }
  }
  void include(const Box &other)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      low[c] = std::min(low[c], other.low[c]);
      high[c] = std::max(high[c], other.high[c]);
    }
  }
  [[nodiscard]] Place centre() const
  {
    return {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])};
  }
  [[nodiscard]] Box grown(double distance) const
  {
    Box result = *this;
    for (std::size_t c = 0; c < 3; ++c)
    {
      result.low[c] -= distance;
      result.high[c] += distance;
    }
    return result;
  }
  /// Whether some point of the other is within the distance of some point of this one; never if one is empty.
  [[nodiscard]] bool meets(const Box &other, double distance) const
  {
    double squared = 0;
    for (std::size_t c = 0; c < 3; ++c)
    {
      const double gap = std::max({0.0, other.low[c] - high[c], low[c] - other.high[c]});
      squared += gap * gap;
    }
    return squared <= distance * distance;
  }
  /// Whether x lies in the box grown by the distance along each axis.
  [[nodiscard]] bool holds(const Place &x, double distance) const
  {
    for (std::size_t c = 0; c < 3; ++c)
      if (!(x[c] >= low[c] - distance && x[c] <= high[c] + distance))
        return false;
    return true;
  }
};

inline Place place_of(std::span<const double> x, int dim, Index node)
{
  const double *p = x.data() + static_cast<std::ptrdiff_t>(node) * dim;
  return {p[0], p[1], dim == 3 ? p[2] : 0.0};
}
inline Box box_of(std::span<const double> x, int dim, std::span<const Index> nodes)
{
  Box box;
  for (const Index node : nodes)
    box.include(place_of(x, dim, node));
  return box;
}
} // namespace amontons
