#include "amontons/algebra/feti_copies.h"

#include "amontons/base/error.h"

#include <algorithm>
#include <numeric>

namespace amontons
{
FetiCopies::FetiCopies(Index n_nodes, std::span<const SubdomainMatrix> subdomains, const Sharing &nodes)
  : nodes_(nodes.counted_as(feti_setup_phase))
  , rank_(nodes.rank())
  , offsets_(static_cast<std::size_t>(n_nodes) + 1, 0)
{
  count_subdomains(static_cast<Index>(subdomains.size()));
  std::vector<Located> all;
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    for (std::size_t a = 0; a < subdomains[s].nodes.size(); ++a)
      all.push_back({subdomains[s].nodes[a], {first_own_subdomain() + static_cast<Index>(s), static_cast<Index>(a)}});
  sort_by_node(all);
  if (const std::vector<Located> others = those_of_others(); !others.empty())
  {
    all.insert(all.end(), others.begin(), others.end());
    sort_by_node(all);
  }
}

void FetiCopies::count_subdomains(Index n_own)
{
  std::vector<double> counts(static_cast<std::size_t>(nodes_.n_processes()), 0.0);
  counts[rank_] = n_own;
  nodes_.sum_over_processes(counts);
  first_subdomain_.assign(1, 0);
  for (const double count : counts)
    first_subdomain_.push_back(first_subdomain_.back() + static_cast<Index>(count));
}

Rank FetiCopies::rank_of(Index subdomain) const
{
  const auto next = std::upper_bound(first_subdomain_.begin(), first_subdomain_.end(), subdomain);
  return static_cast<Rank>(next - first_subdomain_.begin()) - 1;
}

void FetiCopies::sort_by_node(const std::vector<Located> &copies)
{
  std::fill(offsets_.begin(), offsets_.end(), 0);
  for (const Located &located : copies)
    ++offsets_[located.node + 1];
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
  copies_.resize(copies.size());
  for (const Located &located : copies)
    copies_[next[located.node]++] = located.copy;
  for (Index node = 0; node < n_nodes(); ++node)
    std::sort(of(node).begin(), of(node).end(),
              [](const FetiCopy &a, const FetiCopy &b) { return a.subdomain < b.subdomain; });
}

/// Each tells its neighbours, node by node, which copies it has of what they both have.
std::vector<FetiCopies::Located> FetiCopies::those_of_others() const
{
  std::vector<Located> out;
  std::vector<Message> messages;
  for (const Sharing::Neighbour &neighbour : nodes_.neighbours())
  {
    ByteWriter writer;
    for (const Index node : neighbour.items)
    {
      writer.add(static_cast<Index>(of(node).size()));
      for (const FetiCopy &copy : of(node))
      {
        writer.add(copy.subdomain);
        writer.add(copy.node);
      }
    }
    messages.push_back({neighbour.rank, writer.take()});
  }
  const std::vector<Message> in = exchange(std::move(messages));
  for (std::size_t n = 0; n < in.size(); ++n)
  {
    ByteReader reader(in[n].bytes);
    for (const Index node : nodes_.neighbours()[n].items)
      for (auto left = reader.get<Index>(); left > 0; --left)
      {
        const auto subdomain = reader.get<Index>();
        out.push_back({node, {subdomain, reader.get<Index>()}});
      }
  }
  return out;
}

void FetiCopies::hand_over(int width, const std::function<void(const FetiCopy &, double *)> &give,
                           const std::function<void(FetiCopy &, const double *)> &take)
{
  std::vector<Message> messages;
  for (const Sharing::Neighbour &neighbour : nodes_.neighbours())
  {
    std::vector<double> values;
    for (const Index node : neighbour.items)
      for (const FetiCopy &copy : of(node))
        if (is_own(copy))
        {
          values.resize(values.size() + width, 0.0);
          give(copy, values.data() + values.size() - width);
        }
    ByteWriter writer;
    writer.add_array(values);
    messages.push_back({neighbour.rank, writer.take()});
  }
  const std::vector<Message> in = exchange(std::move(messages));
  for (std::size_t n = 0; n < in.size(); ++n)
  {
    ByteReader reader(in[n].bytes);
    const auto values = reader.get_array<double>();
    const double *next = values.data();
    for (const Index node : nodes_.neighbours()[n].items)
      for (FetiCopy &copy : of(node))
        if (is_of(copy, in[n].rank))
        {
          take(copy, next);
          next += width;
        }
    AMONTONS_ASSERT(next == values.data() + values.size());
  }
}

std::vector<Message> FetiCopies::exchange(std::vector<Message> out) const
{
  if (!nodes_.is_distributed())
    return {};
  std::vector<Rank> ranks;
  for (const Sharing::Neighbour &neighbour : nodes_.neighbours())
    ranks.push_back(neighbour.rank);
  return nodes_.messages()->exchange_with(feti_setup_phase, std::move(out), ranks);
}
} // namespace amontons
