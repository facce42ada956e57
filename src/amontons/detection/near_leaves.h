#pragma once
#include "amontons/detection/large_vector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace amontons
{
/// A box and all within a distance of it.
template<int dim>
struct Region
{
  using Point = std::array<double, static_cast<std::size_t>(dim)>;

  Point low, high;
  double reach = 0; ///< negative: nothing

  /// Around nothing.
  static Region none()
  {
    Region result;
    result.low.fill(std::numeric_limits<double>::infinity());
    result.high.fill(-std::numeric_limits<double>::infinity());
    result.reach = -1;
    return result;
  }
  void extend(const Point &x)
  {
    for (std::size_t c = 0; c < dim; ++c)
    {
      low[c] = x[c] < low[c] ? x[c] : low[c];
      high[c] = x[c] > high[c] ? x[c] : high[c];
    }
  }
  /// Whether all of the other region lies in this one.
  [[nodiscard]] bool covers(const Region &other) const
  {
    double squared = 0; // what the other's box needs of the reach
    for (std::size_t c = 0; c < dim; ++c)
    {
      const double out = std::max({low[c] - other.low[c], other.high[c] - high[c], 0.0});
      squared += out * out;
    }
    return reach >= 0 && std::sqrt(squared) + other.reach <= reach;
  }
};

/// For each block of impactor nodes the leaves of the search tree that come into a region about the block: all that a
/// later search within the region has to look at, while neither the nodes nor the target have moved out of it (the
/// list of neighbours of molecular dynamics, Verlet 1967, kept for boxes of nodes and boxes of faces).
template<int dim>
class NearLeaves
{
public:
  /// A new search begins: what is kept from now on is for the next.
  void begin(std::size_t n_blocks)
  {
    if (fronts_.size() != n_blocks)
    {
      clear();
      fronts_.resize(n_blocks);
    }
    last_leaves_.swap(leaves_);
    leaves_.clear();
  }
  void clear()
  {
    fronts_.clear();
    leaves_.clear();
  }
  /// The faces have moved by that much since they were looked for, and their boxes are new.
  void shrink(double motion)
  {
    for (Front &front : fronts_)
      front.region.reach -= motion;
  }

  [[nodiscard]] const Region<dim> &region(std::size_t block) const { return fronts_[block].region; }
  [[nodiscard]] std::span<const std::uint32_t> leaves(std::size_t block) const
  {
    return {last_leaves_.data() + fronts_[block].begin, fronts_[block].n};
  }

  /// @param leaves in the region; of each block once
  void keep(std::size_t block, const Region<dim> &region, std::span<const std::uint32_t> leaves)
  {
    fronts_[block] = {region, static_cast<std::uint32_t>(leaves_.size()), static_cast<std::uint32_t>(leaves.size())};
    leaves_.insert(leaves_.end(), leaves.begin(), leaves.end());
  }
  void forget(std::size_t block) { fronts_[block] = {}; }

private:
  struct Front
  {
    Region<dim> region = Region<dim>::none();
    std::uint32_t begin = 0, n = 0;
  };
  LargeVector<Front> fronts_;
  LargeVector<std::uint32_t> leaves_, last_leaves_;
};
} // namespace amontons
