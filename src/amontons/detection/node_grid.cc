#include "amontons/detection/node_grid.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
void NodeGrid::size_cells(const Target &target, double w)
{
  const int dim = target.surface().dim;
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-INFINITY);
  low_ = Eigen::Vector3d::Constant(INFINITY);
  for (Index i = 0; i < target.surface().n_nodes(); ++i)
  {
    low_ = low_.cwiseMin(target.node(i));
    high = high.cwiseMax(target.node(i));
  }
  low_.array() -= w;
  high.array() += w;
  block_bits_ = dim == 2 ? std::array<int, 3>{3, 3, 0} : std::array<int, 3>{2, 2, 2};
  key_place_ = dim == 2 ? std::array<int, 3>{0, 32, 0} : std::array<int, 3>{0, 21, 42};
  const double most = dim == 2 ? 1e9 : 8e6; // more would not go into a key
  for (int c = 0; c < 3; ++c)
  {
    const double n = std::clamp(std::floor((high[c] - low_[c]) / (2 * w)), 1.0, most);
    n_cells_[c] = c < dim ? static_cast<std::int64_t>(n) : 1;
    per_cell_[c] = static_cast<double>(n_cells_[c]) / (high[c] - low_[c]);
  }
}

void NodeGrid::grow_table(int bits)
{
  std::vector<Entry> old(std::size_t{1} << bits);
  old.swap(table_);
  hash_shift_ = 64 - bits;
  for (const Entry &entry : old)
    if (entry.block >= 0)
      table_[place_of(entry.key)] = entry;
}

std::uint32_t NodeGrid::find_or_add(std::uint64_t key)
{
  std::size_t place = place_of(key);
  if (table_[place].block < 0)
  {
    if (2 * (n_blocks_ + 1) > table_.size())
    {
      grow_table(65 - hash_shift_);
      place = place_of(key);
    }
    table_[place] = {key, static_cast<std::int64_t>(n_blocks_++)};
  }
  return static_cast<std::uint32_t>(table_[place].block);
}

void NodeGrid::fill(const Target &target, double w)
{
  size_cells(target, w);
  n_blocks_ = 0;
  if (table_.empty())
    grow_table(6);
  std::fill(table_.begin(), table_.end(), Entry{});
  cells_.resize(target.surface().node_ids.size());
  std::uint64_t last_key = ~std::uint64_t{0};
  std::uint32_t block = 0;
  for (Index i = 0; i < target.surface().n_nodes(); ++i)
  {
    const Eigen::Vector3d x = target.node(i);
    const Cell own{cell(position(x, 0), 0), cell(position(x, 1), 1), cell(position(x, 2), 2)};
    if (key(own) != last_key)
    {
      last_key = key(own);
      block = find_or_add(last_key);
    }
    cells_[i] = block * static_cast<std::uint32_t>(cells_per_block) + place_in_block(own);
  }
  sort(target);
}

// Counts the nodes of each cell and puts them in the order of the cells.
void NodeGrid::sort(const Target &target)
{
  cell_begin_.assign(n_blocks_ * cells_per_block + 1, 0);
  for (const std::uint32_t cell : cells_)
    ++cell_begin_[cell + 1];
  for (std::size_t cell = 0; cell + 1 < cell_begin_.size(); ++cell)
    cell_begin_[cell + 1] += cell_begin_[cell];
  next_.assign(cell_begin_.begin(), cell_begin_.end() - 1);
  nodes_.resize(cells_.size());
  for (std::size_t i = 0; i < cells_.size(); ++i)
    nodes_[next_[cells_[i]]++] = {target.node(static_cast<Index>(i)), static_cast<Index>(i)};
  make_boxes();
}

void NodeGrid::make_boxes()
{
  boxes_.resize((nodes_.size() + nodes_per_box - 1) / nodes_per_box);
  for (std::size_t first = 0; first < nodes_.size(); first += nodes_per_box)
  {
    Box box{nodes_[first].x, nodes_[first].x};
    for (std::size_t i = first + 1; i < std::min(first + nodes_per_box, nodes_.size()); ++i)
    {
      box.low = box.low.cwiseMin(nodes_[i].x);
      box.high = box.high.cwiseMax(nodes_[i].x);
    }
    boxes_[first / nodes_per_box] = box;
  }
}
} // namespace amontons
