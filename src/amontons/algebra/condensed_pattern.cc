#include "amontons/algebra/condensed_matrix.h"

#include <algorithm>

/// The pattern of the reduced matrix.
namespace amontons
{
void CondensedMatrix::set_constraints(std::span<const ConstraintPattern> patterns,
                                      std::span<const ConstraintRows> constraints,
                                      std::span<const std::vector<Index>> dense_unknowns,
                                      std::span<const Eigen::MatrixXd> dense_blocks)
{
  patterns_ = patterns;
  constraints_ = constraints;
  dense_unknowns_ = dense_unknowns;
  dense_blocks_ = dense_blocks;
  pattern_stands_ = false;
  constraints_of_node_.assign(static_cast<std::size_t>(blocks_.n_nodes()), {});
  masters_.assign(static_cast<std::size_t>(blocks_.n_blocks()), {});
  counted_constraints_.clear();
  counted_dense_.clear();
  for (std::size_t d = 0; d < dense_unknowns_.size(); ++d)
    if (!dense_unknowns_[d].empty() && layout_.sharing().is_own(dense_unknowns_[d].front()))
      counted_dense_.push_back(static_cast<Index>(d));
  const int n = blocks_.block_size();
  for (std::size_t k = 0; k < patterns_.size(); ++k)
  {
    const bool counted = layout_.counts_here(patterns_[k].nodal);
    if (counted)
      counted_constraints_.push_back(static_cast<Index>(k));
    for (int a = 0; a < patterns_[k].n_nodal(); a += n)
    {
      auto &of_node = constraints_of_node_[patterns_[k].nodal[a] / n];
      if (counted && (of_node.empty() || of_node.back() != static_cast<Index>(k)))
        of_node.push_back(static_cast<Index>(k));
      for (const Index slave : blocks_.blocks_of_node(patterns_[k].nodal[0] / n))
        if (blocks_.nodes_of_block(slave).size() == 1)
          for (const Index master : blocks_.blocks_of_node(patterns_[k].nodal[a] / n))
            masters_[slave].push_back(master);
    }
  }
  for (auto &masters : masters_)
  {
    std::sort(masters.begin(), masters.end());
    masters.erase(std::unique(masters.begin(), masters.end()), masters.end());
  }
}

/// Takes note of what slaves follow beyond the nodes of their face. @return whether the pattern is too small
bool CondensedMatrix::extend_fill(const ConstraintElimination &elimination)
{
  bool grown = false;
  for (const Index slave : elimination.slaves())
  {
    auto &masters = masters_[blocks_.block(slave)];
    for (const auto &terms : {elimination.motion(slave), elimination.weights(slave)})
      for (const Term &term : terms)
      {
        const Index block = blocks_.block(term.unknown);
        const auto place = std::lower_bound(masters.begin(), masters.end(), block);
        if (place != masters.end() && *place == block)
          continue;
        masters.insert(place, block);
        grown = true;
      }
  }
  return grown;
}

void CondensedMatrix::add_column(Index block, std::vector<Index> &columns)
{
  if (mark_[block] == stamp_)
    return;
  mark_[block] = stamp_;
  columns.push_back(block);
}

/// Columns of everything that moves a node or one that shares a cell or a constraint with it.
void CondensedMatrix::add_neighbours(Index node, std::vector<Index> &columns)
{
  const auto add_node = [&](Index other)
  {
    for (const Index block : blocks_.blocks_of_node(other))
    {
      add_column(block, columns);
      for (const Index master : masters_[block])
        add_column(master, columns);
    }
  };
  const int n = blocks_.block_size();
  for (const auto &[s, local] : blocks_.copies(node))
  {
    const SubdomainMatrix &matrix = subdomains_[s];
    const Index row = local * n;
    for (Index k = matrix.row_ptr[row]; k < matrix.row_ptr[row + 1]; k += n)
      add_node(matrix.nodes[matrix.col[k] / n]);
  }
  for (const Index k : constraints_of_node_[node])
    for (int a = 0; a < patterns_[k].n_nodal(); a += n)
      add_node(patterns_[k].nodal[a] / n);
}

void CondensedMatrix::collect_columns(Index block, std::vector<Index> &columns)
{
  ++stamp_;
  columns.clear();
  if (blocks_.sharing().is_own(block))
    add_column(block, columns);
  for (const Index node : blocks_.nodes_of_block(block))
    add_neighbours(node, columns);
  for (const Index slave : slaves_[block])
    for (const Index node : blocks_.nodes_of_block(slave))
      add_neighbours(node, columns);
  const int n = blocks_.block_size();
  for (int c = 0; c < n; ++c)
    if (const Index unknown = blocks_.unknown(block * n + c); unknown >= 0)
      for (const Index d : counted_dense_)
        if (const auto &dense = dense_unknowns_[d]; std::find(dense.begin(), dense.end(), unknown) != dense.end())
          for (const Index other : dense)
            add_column(blocks_.block(other), columns);
  std::sort(columns.begin(), columns.end());
}

void CondensedMatrix::build_pattern()
{
  const Index n_blocks = blocks_.n_blocks();
  const int n = blocks_.block_size();
  slaves_.assign(static_cast<std::size_t>(n_blocks), {});
  for (Index slave = 0; slave < n_blocks; ++slave)
    for (const Index master : masters_[slave])
      if (master != slave)
        slaves_[master].push_back(slave);
  mark_.assign(static_cast<std::size_t>(n_blocks), -1);
  stamp_ = -1;
  affected_.clear();
  matrix_.row_ptr.assign(1, 0);
  matrix_.col.clear();
  std::vector<Index> columns;
  for (Index block = 0; block < n_blocks; ++block)
  {
    collect_columns(block, columns);
    for (int c = 0; c < n; ++c)
    {
      for (const Index column : columns)
        for (int d = 0; d < n; ++d)
          matrix_.col.push_back(column * n + d);
      matrix_.row_ptr.push_back(static_cast<Index>(matrix_.col.size()));
    }
    // Columns of a slave's neighbours are those of its masters, so these rows are among the affected ones.
    if (std::any_of(columns.begin(), columns.end(),
                    [&](Index b) { return !masters_[b].empty() || !slaves_[b].empty(); }))
      affected_.push_back(block);
  }
  for (const Index d : counted_dense_)
    for (const Index unknown : dense_unknowns_[d])
      affected_.push_back(blocks_.block(unknown));
  std::sort(affected_.begin(), affected_.end());
  affected_.erase(std::unique(affected_.begin(), affected_.end()), affected_.end());
  matrix_.values.assign(matrix_.col.size(), 0.0);
  place_.assign(static_cast<std::size_t>(blocks_.n_rows()), -1);
  pattern_stands_ = true;
}
} // namespace amontons
