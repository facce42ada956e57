#include "amontons/exchange/grid_cut.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
constexpr double most_cells = 1e9; // along an axis
}

GridCut::GridCut(const Box &bounds, double w, int n_parts)
  : low_(bounds.low)
  , grown_blocks_(static_cast<std::size_t>(n_parts))
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    const double extent = bounds.high[c] - bounds.low[c];
    n_cells_[c] = static_cast<std::int64_t>(std::clamp(std::floor(extent / (2 * w)), 1.0, most_cells));
    width_[c] = extent / static_cast<double>(n_cells_[c]);
  }
  blocks_.push_back({{0, 0, 0}, n_cells_, 0, n_parts});
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    cut(k);
}

// Across the axis with most cells, in proportion to the processes on either side.
void GridCut::cut(std::size_t k)
{
  Block block = blocks_[k];
  std::size_t axis = 0;
  for (std::size_t c = 1; c < 3; ++c)
    if (block.last[c] - block.first[c] > block.last[axis] - block.first[axis])
      axis = c;
  const std::int64_t n = block.last[axis] - block.first[axis];
  if (block.n_parts == 1 || n == 1)
    return grow(block);
  Block below = block, above = block;
  below.n_parts = block.n_parts / 2;
  above.n_parts = block.n_parts - below.n_parts;
  above.part = block.part + below.n_parts;
  const double share = static_cast<double>(n) * below.n_parts / block.n_parts;
  below.last[axis] = above.first[axis] = block.first[axis] + std::clamp<std::int64_t>(std::llround(share), 1, n - 1);
  blocks_[k].axis = static_cast<int>(axis);
  blocks_[k].below = blocks_.size();
  blocks_[k].above = blocks_.size() + 1;
  blocks_.push_back(below);
  blocks_.push_back(above);
}

void GridCut::grow(const Block &block)
{
  Box &box = grown_blocks_[block.part];
  for (std::size_t c = 0; c < 3; ++c)
  {
    box.low[c] = low_[c] + static_cast<double>(block.first[c] - 1) * width_[c];
    box.high[c] = low_[c] + static_cast<double>(block.last[c] + 1) * width_[c];
  }
}

Rank GridCut::part_of(const Place &x) const
{
  std::size_t k = 0;
  while (blocks_[k].axis >= 0)
  {
    const auto axis = static_cast<std::size_t>(blocks_[k].axis);
    const auto cell = static_cast<std::int64_t>(std::floor((x[axis] - low_[axis]) / width_[axis]));
    k = cell < blocks_[blocks_[k].below].last[axis] ? blocks_[k].below : blocks_[k].above;
  }
  return blocks_[k].part;
}
} // namespace amontons
