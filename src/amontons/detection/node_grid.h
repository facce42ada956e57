#pragma once
#include "amontons/detection/target.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace amontons
{
/// The paper's grid of the target's nodes (THEORY.md section 4, steps 1 and 2; Yastrebov, Cailletaud, Feyel 2011):
/// cells at least 2w wide, nodes counted and sorted by cell. A surface leaves most cells of its box empty, so they are
/// kept in blocks of 64 (8 by 8, or 4 by 4 by 4), found by a hash table: memory goes with the number of nodes, whatever
/// the box.
class NodeGrid
{
public:
  struct Node
  {
    Eigen::Vector3d x;
    Index node;
  };

  /// @param w cells are at least twice as wide
  void fill(const Target &target, double w);

  /// Calls `visit` with the nodes, some at a time, of the cell that holds x and of the cells on its side of it, 3 of
  /// the 8 neighbours in 2D and 7 of the 26 in 3D: they hold every node within w of x.
  /// @param squared_bound nodes farther than this may be left out; read anew after each call, so that the visitor may
  ///        shrink it
  template<typename Visitor>
  void visit_near(const Eigen::Vector3d &x, const double &squared_bound, Visitor &&visit) const;

private:
  static constexpr std::int64_t cells_per_block = 64;
  static constexpr Index nodes_per_box = 16;
  struct Box
  {
    Eigen::Vector3d low, high;
  };
  using Cell = std::array<std::int64_t, 3>;
  void size_cells(const Target &target, double w);
  void sort(const Target &target);
  void make_boxes();
  [[nodiscard]] double position(const Eigen::Vector3d &x, int axis) const
  {
    return (x[axis] - low_[axis]) * per_cell_[axis];
  }
  [[nodiscard]] std::int64_t cell(double position, int axis) const
  {
    return std::clamp(static_cast<std::int64_t>(position), std::int64_t{0}, n_cells_[axis] - 1);
  }
  [[nodiscard]] std::uint64_t key(const Cell &cell) const
  {
    std::uint64_t result = 0;
    for (int c = 0; c < 3; ++c)
      result |= static_cast<std::uint64_t>(cell[c] >> block_bits_[c]) << key_place_[c];
    return result;
  }
  /// Which of the cells of its block, the first axis fastest.
  [[nodiscard]] std::uint32_t place_in_block(const Cell &cell) const
  {
    std::uint32_t result = 0;
    for (int c = 2; c >= 0; --c)
      result = result << block_bits_[c] | (static_cast<std::uint32_t>(cell[c]) & ((1U << block_bits_[c]) - 1));
    return result;
  }
  /// Where in the table the key is, or would be.
  [[nodiscard]] std::size_t place_of(std::uint64_t key) const
  {
    std::size_t place = key * 0x9E3779B97F4A7C15ULL >> hash_shift_;
    while (table_[place].block >= 0 && table_[place].key != key)
      place = (place + 1) & (table_.size() - 1);
    return place;
  }
  std::uint32_t find_or_add(std::uint64_t key);
  void grow_table(int bits);

  struct Entry
  {
    std::uint64_t key = 0;
    std::int64_t block = -1;
  };

  Eigen::Vector3d low_{0, 0, 0}, per_cell_{0, 0, 0};
  Cell n_cells_{1, 1, 1};
  std::array<int, 3> block_bits_{}, key_place_{};
  std::vector<Entry> table_; ///< open addressing, a power of two long, at most half full
  int hash_shift_ = 0;
  std::size_t n_blocks_ = 0;
  std::vector<Index> cell_begin_; ///< of all cells of all blocks, in nodes_
  std::vector<Node> nodes_;       ///< cell by cell
  /// Of as many nodes in turn: where edges differ much a cell holds many nodes, of which few are near.
  std::vector<Box> boxes_;
  std::vector<std::uint32_t> cells_; ///< of each node; kept for their memory
  std::vector<Index> next_;
};

template<typename Visitor>
void NodeGrid::visit_near(const Eigen::Vector3d &x, const double &squared_bound, Visitor &&visit) const
{
  Cell first, last;
  for (int c = 0; c < 3; ++c)
  {
    const double p = position(x, c);
    const std::int64_t own = cell(p, c);
    const bool lower_half = p - static_cast<double>(own) < 0.5;
    first[c] = std::max(own - lower_half, std::int64_t{0});
    last[c] = std::min(own + !lower_half, n_cells_[c] - 1);
  }
  for (std::int64_t k = first[2]; k <= last[2]; ++k)
    for (std::int64_t j = first[1]; j <= last[1]; ++j)
      for (std::int64_t i = first[0], end = i; i <= last[0]; i = end + 1)
      {
        end = std::min(last[0], i | ((std::int64_t{1} << block_bits_[0]) - 1)); // in one block
        const Entry &entry = table_[place_of(key({i, j, k}))];
        if (entry.block < 0)
          continue;
        const Index *begin = cell_begin_.data() + entry.block * cells_per_block + place_in_block({i, j, k});
        const Index from = begin[0], to = begin[end - i + 1];
        if (to - from <= nodes_per_box)
        {
          visit(std::span<const Node>(nodes_.data() + from, nodes_.data() + to));
          continue;
        }
        for (Index box = from / nodes_per_box; box * nodes_per_box < to; ++box)
          if ((boxes_[box].low - x).cwiseMax(x - boxes_[box].high).cwiseMax(0.0).squaredNorm() <= squared_bound)
            visit(std::span<const Node>(nodes_.data() + std::max(from, box * nodes_per_box),
                                        nodes_.data() + std::min(to, (box + 1) * nodes_per_box)));
      }
}
} // namespace amontons
