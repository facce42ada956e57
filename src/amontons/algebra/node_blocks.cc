#include "amontons/algebra/node_blocks.h"

#include <algorithm>

namespace amontons
{
NodeBlocks::NodeBlocks(const Layout &layout, std::span<const SubdomainMatrix> subdomains)
{
  if (!subdomains.empty())
    size_ = subdomains.front().n_components;
  size_ = static_cast<int>(layout.sharing().maximum_over_processes(size_));
  std::vector<std::pair<Index, Index>> entries;
  for (Index nodal = 0; nodal < layout.n_nodal(); ++nodal)
    for (const Term &term : layout.terms(nodal))
      entries.emplace_back(term.unknown, nodal);
  nodal_of_unknown_ = {layout.n_displacement_unknowns(), entries};
  number_rows(layout);
  share_blocks(layout.sharing());
  n_local_ = n_blocks();

  entries.clear();
  const Index n_nodes = layout.n_nodal() / size_;
  for (Index node = 0; node < n_nodes; ++node)
  {
    std::vector<Index> blocks;
    for (int c = 0; c < size_; ++c)
      for (const Term &term : layout.terms(node * size_ + c))
        blocks.push_back(block(term.unknown));
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    for (const Index b : blocks)
      entries.emplace_back(node, b);
  }
  blocks_of_node_ = {n_nodes, entries};
  for (auto &[node, block] : entries)
    std::swap(node, block);
  nodes_of_block_ = {n_blocks(), entries};

  std::vector<std::pair<Index, std::pair<Index, Index>>> copies;
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    for (std::size_t local = 0; local < subdomains[s].nodes.size(); ++local)
      copies.push_back({subdomains[s].nodes[local], {static_cast<Index>(s), static_cast<Index>(local)}});
  copies_ = {n_nodes, copies};
}

void NodeBlocks::number_rows(const Layout &layout)
{
  row_of_unknown_.assign(static_cast<std::size_t>(layout.n_displacement_unknowns()), -1);
  for (Index nodal = 0; nodal < layout.n_nodal(); nodal += size_)
  {
    const auto first = static_cast<Index>(unknown_of_row_.size());
    bool any = false;
    for (int c = 0; c < size_; ++c)
      if (const auto terms = layout.terms(nodal + c); terms.size() == 1 && !is_shared(terms[0].unknown))
      {
        if (!any)
          unknown_of_row_.resize(static_cast<std::size_t>(first) + size_, -1);
        any = true;
        row_of_unknown_[terms[0].unknown] = first + c;
        unknown_of_row_[first + c] = terms[0].unknown;
      }
  }
  for (Index unknown = 0; unknown < layout.n_displacement_unknowns(); ++unknown)
    if (row_of_unknown_[unknown] < 0)
    {
      row_of_unknown_[unknown] = static_cast<Index>(unknown_of_row_.size());
      unknown_of_row_.push_back(unknown);
    }
  unknown_of_row_.resize((unknown_of_row_.size() + size_ - 1) / size_ * size_, -1);
}

void NodeBlocks::share_blocks(const Sharing &unknowns)
{
  if (!unknowns.is_distributed())
  {
    sharing_ = Sharing(n_blocks());
    return;
  }
  std::vector<GlobalIndex> ids;
  std::vector<char> preferred;
  for (auto row = unknown_of_row_.begin(); row != unknown_of_row_.end(); row += size_)
  {
    const Index first = *std::find_if(row, row + size_, [](Index unknown) { return unknown >= 0; });
    ids.push_back(unknowns.number(first));
    preferred.push_back(unknowns.is_own(first));
  }
  sharing_ = Sharing(unknowns.messages(), "linear system", ids, preferred);
  for (Index block = 0; block < n_blocks(); ++block)
    if (sharing_.is_own(block))
      own_blocks_.push_back(block);
    else
      other_blocks_.emplace(sharing_.number(block), block);
}

GlobalIndex NodeBlocks::number(Index row) const
{
  const Index block = row / size_;
  const GlobalIndex of_block = block < sharing_.size()
                                   ? sharing_.number(block)
                                   : new_numbers_[static_cast<std::size_t>(block - sharing_.size())];
  return of_block * size_ + row % size_;
}

Index NodeBlocks::find_row(GlobalIndex number) const
{
  if (!sharing_.is_distributed())
    return static_cast<Index>(number);
  const auto component = static_cast<Index>(number % size_);
  const GlobalIndex of_block = number / size_, own = of_block - sharing_.first_own_number();
  if (own >= 0 && own < sharing_.n_own())
    return own_blocks_[own] * size_ + component;
  const auto other = other_blocks_.find(of_block);
  return other == other_blocks_.end() ? -1 : other->second * size_ + component;
}

Index NodeBlocks::take_row(GlobalIndex number)
{
  if (const Index row = find_row(number); row >= 0)
    return row;
  const Index block = n_blocks();
  other_blocks_.emplace(number / size_, block);
  new_numbers_.push_back(number / size_);
  unknown_of_row_.resize(unknown_of_row_.size() + size_, -1);
  return block * size_ + static_cast<Index>(number % size_);
}

void NodeBlocks::share_foreign()
{
  if (sharing_.true_on_all(new_numbers_.empty()))
    return;
  std::vector<GlobalIndex> ids;
  std::vector<char> preferred;
  for (Index block = 0; block < n_blocks(); ++block)
  {
    ids.push_back(number(block * size_) / size_);
    preferred.push_back(block < n_local_ && sharing_.is_own(block));
  }
  sharing_ = Sharing(sharing_.messages(), "linear system", ids, preferred); // with the same owners, so the same numbers
  new_numbers_.clear();
}
} // namespace amontons
