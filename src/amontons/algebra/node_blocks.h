#pragma once
#include "amontons/algebra/layout.h"
#include "amontons/algebra/subdomain_matrix.h"

#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace amontons
{
/// The displacement unknowns numbered in whole blocks, one per node that has unknowns of its own; unknowns that move
/// many nodes (of rigid bodies) make blocks of their own behind these. Components that are held, and what fills the
/// last block up, are rows without an unknown.
///
/// Over several processes a block's copies have the same unknowns in the same order; it belongs to who owns the first
/// of them. Foreign blocks, of nodes that are not here, can be taken in behind the others: rows without an unknown that
/// other processes have unknowns for.
class NodeBlocks
{
public:
  NodeBlocks() = default;
  /// Collective.
  NodeBlocks(const Layout &layout, std::span<const SubdomainMatrix> subdomains);

  [[nodiscard]] int block_size() const { return size_; }
  [[nodiscard]] Index n_blocks() const { return static_cast<Index>(unknown_of_row_.size()) / size_; }
  /// Of the blocks, but for foreign ones not yet shared.
  [[nodiscard]] const Sharing &sharing() const { return sharing_; }
  /// Of a row, in the whole. Foreign blocks do not change it.
  [[nodiscard]] GlobalIndex number(Index row) const;
  /// The row of a number, -1 where its block is not here.
  [[nodiscard]] Index find_row(GlobalIndex number) const;
  /// The row of a number, its block taken in if it is not here.
  Index take_row(GlobalIndex number);
  /// Makes foreign blocks that processes have taken in copies like the others. Collective.
  void share_foreign();
  [[nodiscard]] bool is_own_row(Index row) const { return sharing_.is_own(row / size_); }
  [[nodiscard]] Index n_rows() const { return static_cast<Index>(unknown_of_row_.size()); }
  [[nodiscard]] Index n_nodes() const { return static_cast<Index>(blocks_of_node_.size()) - 1; }
  [[nodiscard]] Index row(Index unknown) const { return row_of_unknown_[unknown]; }
  /// -1 for none.
  [[nodiscard]] Index unknown(Index row) const { return unknown_of_row_[row]; }
  [[nodiscard]] Index block(Index unknown) const { return row_of_unknown_[unknown] / size_; }
  /// Unknowns that more than one nodal component follows.
  [[nodiscard]] bool is_shared(Index unknown) const { return nodal_of_unknown_.size(unknown) != 1; }

  /// Blocks that move a node.
  [[nodiscard]] std::span<const Index> blocks_of_node(Index node) const { return blocks_of_node_[node]; }
  [[nodiscard]] std::span<const Index> nodes_of_block(Index block) const
  {
    return block < n_local_ ? nodes_of_block_[block] : std::span<const Index>();
  }
  [[nodiscard]] std::span<const Index> nodal_of_unknown(Index unknown) const { return nodal_of_unknown_[unknown]; }
  /// Where a node is in the subdomains: (subdomain, local node).
  [[nodiscard]] std::span<const std::pair<Index, Index>> copies(Index node) const { return copies_[node]; }

private:
  template<class T>
  class Lists
  {
  public:
    Lists() = default;
    /// @param entries (list, item) in any order; a list's items keep theirs
    Lists(Index n, const std::vector<std::pair<Index, T>> &entries)
      : offsets_(static_cast<std::size_t>(n) + 1, 0)
      , items_(entries.size())
    {
      for (const auto &[list, item] : entries)
        ++offsets_[list + 1];
      for (std::size_t i = 1; i < offsets_.size(); ++i)
        offsets_[i] += offsets_[i - 1];
      std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
      for (const auto &[list, item] : entries)
        items_[next[list]++] = item;
    }
    [[nodiscard]] std::span<const T> operator[](Index list) const
    {
      return {items_.data() + offsets_[list], static_cast<std::size_t>(size(list))};
    }
    [[nodiscard]] Index size(Index list) const { return offsets_[list + 1] - offsets_[list]; }
    [[nodiscard]] std::size_t size() const { return offsets_.size(); }

  private:
    std::vector<Index> offsets_{0};
    std::vector<T> items_;
  };

  void number_rows(const Layout &layout);
  void share_blocks(const Sharing &unknowns);

  int size_ = 1;
  Index n_local_ = 0; ///< blocks that are not foreign
  std::vector<Index> row_of_unknown_, unknown_of_row_;
  Sharing sharing_;
  std::vector<Index> own_blocks_;                       ///< by number, from the first own one on
  std::unordered_map<GlobalIndex, Index> other_blocks_; ///< by number
  std::vector<GlobalIndex> new_numbers_;                ///< of blocks that are not yet shared
  Lists<Index> blocks_of_node_, nodes_of_block_, nodal_of_unknown_;
  Lists<std::pair<Index, Index>> copies_;
};
} // namespace amontons
