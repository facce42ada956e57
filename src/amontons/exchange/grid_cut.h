#pragma once
#include "amontons/exchange/box.h"

#include <cstdint>
#include <vector>

namespace amontons
{
/// The paper's grid of cells at least 2w wide (THEORY.md section 4, step 1), cut into blocks of equal volume, one a
/// process (section 5, step 2). There may be fewer cells than processes: then some get none.
class GridCut
{
public:
  /// @param bounds of the target's nodes, grown by w
  GridCut(const Box &bounds, double w, int n_parts);

  /// @param x inside the bounds
  [[nodiscard]] Rank part_of(const Place &x) const;
  /// The part's cells with one further layer of cells round them; empty if it has none.
  [[nodiscard]] const std::vector<Box> &grown_blocks() const { return grown_blocks_; }

private:
  using Cell = std::array<std::int64_t, 3>;
  struct Block
  {
    Cell first{0, 0, 0}, last{0, 0, 0}; ///< cells [first, last)
    Rank part = 0;
    int n_parts = 0;
    int axis = -1; ///< cut across; -1: not cut
    std::size_t below = 0, above = 0;
  };
  void cut(std::size_t k);
  void grow(const Block &block);

  Place low_{0, 0, 0}, width_{1, 1, 1}; ///< of a cell
  Cell n_cells_{1, 1, 1};
  std::vector<Block> blocks_;
  std::vector<Box> grown_blocks_;
};
} // namespace amontons
