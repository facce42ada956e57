#include "amontons/algebra/condensed_matrix.h"

#include "amontons/parallel/holders.h"

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
  take_layout();
  counted_dense_.clear();
  for (std::size_t d = 0; d < dense_unknowns_.size(); ++d)
    if (!dense_unknowns_[d].empty() && layout_.sharing().is_own(dense_unknowns_[d].front()))
      counted_dense_.push_back(static_cast<Index>(d));
  const int n = blocks_.block_size();
  for (std::size_t k = 0; k < patterns_.size(); ++k)
    for (int a = 0; a < patterns_[k].n_nodal(); a += n)
    {
      auto &of_node = constraints_of_node_[patterns_[k].nodal[a] / n];
      if (of_node.empty() || of_node.back() != static_cast<Index>(k))
        of_node.push_back(static_cast<Index>(k));
      for (const Index slave : blocks_.blocks_of_node(patterns_[k].nodal[0] / n))
        if (blocks_.nodes_of_block(slave).size() == 1)
          for (const Index master : blocks_.blocks_of_node(patterns_[k].nodal[a] / n))
            masters_[slave].push_back(master);
    }
  share_masters();
  for (auto &masters : masters_)
  {
    std::sort(masters.begin(), masters.end());
    masters.erase(std::unique(masters.begin(), masters.end()), masters.end());
  }
}

void CondensedMatrix::take_layout()
{
  blocks_ = NodeBlocks(layout_, subdomains_);
  matrix_.block_size = blocks_.block_size();
  direct_.assign(static_cast<std::size_t>(layout_.n_nodal()), -1);
  for (Index nodal = 0; nodal < layout_.n_nodal(); ++nodal)
    if (const auto terms = layout_.terms(nodal); terms.size() == 1 && !blocks_.is_shared(terms[0].unknown))
      direct_[nodal] = blocks_.row(terms[0].unknown);
  indirect_.clear();
  feeding_.clear();
  fed_.clear();
  pins_.clear();
  old_pins_.clear();
  constraints_of_node_.assign(static_cast<std::size_t>(blocks_.n_nodes()), {});
  masters_.assign(static_cast<std::size_t>(blocks_.n_blocks()), {});
  pattern_stands_ = false;
}

/// Whoever has a copy of a block hears what slaves in it may follow.
void CondensedMatrix::share_masters()
{
  const int n = blocks_.block_size();
  tell_holders(
      blocks_.sharing(), "condensation", [&](Index block) { return !masters_[block].empty(); },
      [&](Index block, ByteWriter &writer)
      {
        std::vector<GlobalIndex> rows;
        for (const Index master : masters_[block])
          rows.push_back(blocks_.number(master * n));
        writer.add_array(rows);
      },
      [&](Index block, ByteReader &reader)
      {
        for (const GlobalIndex row : reader.get_array<GlobalIndex>())
          masters_[block].push_back(blocks_.take_row(row) / n);
      });
  masters_.resize(static_cast<std::size_t>(blocks_.n_blocks()));
}

/// Takes note of what slaves follow beyond the nodes of their face. @return whether the pattern is too small
bool CondensedMatrix::extend_fill(const ConstraintElimination &elimination)
{
  bool grown = false;
  masters_.resize(static_cast<std::size_t>(blocks_.n_blocks()));
  for (const Index slave : elimination.slaves())
  {
    const Index of_slave = blocks_.block(slave);
    auto &masters = masters_[of_slave];
    if (masters.empty()) // rows around a slave without masters must be among the affected ones too
    {
      masters.push_back(of_slave);
      grown |= pattern_stands_ && slaves_[of_slave].empty();
    }
    for (const auto &terms : {elimination.motion(slave), elimination.weights(slave)})
      for (const auto &entry : terms)
      {
        const Index block = entry.row / blocks_.block_size();
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

/// With what its slaves follow.
void CondensedMatrix::add_block(Index block, std::vector<Index> &columns)
{
  add_column(block, columns);
  for (const Index master : masters_[block])
    add_column(master, columns);
}

/// Columns of everything that moves a node or one that shares a cell or a constraint with it.
void CondensedMatrix::add_neighbours(Index node, std::vector<Index> &columns)
{
  const auto add_node = [&](Index other)
  {
    for (const Index block : blocks_.blocks_of_node(other))
      add_block(block, columns);
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

/// Columns of everything that dense blocks join to a block.
void CondensedMatrix::add_dense(Index block, std::vector<Index> &columns)
{
  const int n = blocks_.block_size();
  for (Index row = block * n; row < (block + 1) * n; ++row)
    for (const Index d : counted_dense_)
      if (const auto &dense = dense_unknowns_[d];
          blocks_.unknown(row) >= 0 && std::find(dense.begin(), dense.end(), blocks_.unknown(row)) != dense.end())
        for (const Index other : dense)
          add_block(blocks_.block(other), columns);
}

void CondensedMatrix::collect_columns(Index block, std::vector<Index> &columns)
{
  ++stamp_;
  columns.clear();
  if (blocks_.sharing().is_own(block))
    add_column(block, columns);
  const auto add_row_of = [&](Index other)
  {
    for (const Index node : blocks_.nodes_of_block(other))
      add_neighbours(node, columns);
    add_dense(other, columns);
  };
  add_row_of(block);
  for (const Index slave : slaves_[block])
    add_row_of(slave);
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
