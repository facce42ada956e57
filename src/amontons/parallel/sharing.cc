#include "amontons/parallel/sharing.h"

#include "amontons/base/error.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace amontons
{
namespace
{
struct Entry
{
  GlobalIndex id;
  char prefers;
};

using Holder = Sharing::Holder;

bool is_before(const Holder &a, const Holder &b)
{
  return a.id < b.id || (a.id == b.id && a.rank < b.rank);
}

/// Calls take(holders of an id, by rank) for each id of some holders, which are put in order.
template<class Take>
void for_each_item(std::vector<Holder> &holders, Take &&take)
{
  std::sort(holders.begin(), holders.end(), is_before);
  for (auto first = holders.begin(); first != holders.end();)
  {
    const auto end = std::find_if(first, holders.end(), [&](const Holder &h) { return h.id != first->id; });
    take(std::span<const Holder>(first, end));
    first = end;
  }
}

/// All messages of a map from rank to what is written for it.
std::vector<Message> messages_of(std::map<Rank, ByteWriter> &writers)
{
  std::vector<Message> out;
  for (auto &[rank, writer] : writers)
    out.push_back({rank, writer.take()});
  return out;
}
} // namespace

Sharing::Sharing(std::shared_ptr<MessageExchange> messages, std::string phase, std::span<const GlobalIndex> ids,
                 std::span<const char> preferred)
  : n_(static_cast<Index>(ids.size()))
  , n_own_(n_)
{
  if (!messages || messages->communicator().size() == 1)
    return;
  messages_ = std::move(messages);
  phase_ = std::move(phase);
  find_copies(ids, preferred);
  number_items(ids);
}

/// Who looks after an id (its rank is the id modulo their number) hears from all that have it and tells each of the
/// others.
void Sharing::find_copies(std::span<const GlobalIndex> ids, std::span<const char> preferred)
{
  std::map<Rank, std::vector<Entry>> told;
  for (std::size_t i = 0; i < ids.size(); ++i)
    told[static_cast<Rank>(ids[i] % n_processes())].push_back({ids[i], preferred.empty() ? char(0) : preferred[i]});
  std::map<Rank, ByteWriter> writers;
  for (const auto &[rank, entries] : told)
    writers[rank].add_array(entries);
  std::vector<Holder> holders;
  for (const Message &message : messages_->exchange(phase_, messages_of(writers)))
    for (const Entry &entry : ByteReader(message.bytes).get_array<Entry>())
      holders.push_back({entry.id, message.rank, entry.prefers});

  std::map<Rank, std::vector<Holder>> answers;
  for_each_item(holders,
                [&](std::span<const Holder> of_item)
                {
                  if (of_item.size() > 1)
                    for (const Holder &to : of_item)
                      answers[to.rank].insert(answers[to.rank].end(), of_item.begin(), of_item.end());
                });
  writers.clear();
  for (const auto &[rank, of_items] : answers)
    writers[rank].add_array(of_items);
  holders.clear();
  for (const Message &message : messages_->exchange(phase_, messages_of(writers)))
  {
    const std::vector<Holder> more = ByteReader(message.bytes).get_array<Holder>();
    holders.insert(holders.end(), more.begin(), more.end());
  }
  take_holders(ids, std::move(holders));
}

/// @param holders of all items with copies elsewhere
void Sharing::take_holders(std::span<const GlobalIndex> ids, std::vector<Holder> holders)
{
  std::vector<std::pair<GlobalIndex, Index>> place;
  for (std::size_t i = 0; i < ids.size(); ++i)
    place.emplace_back(ids[i], static_cast<Index>(i));
  std::sort(place.begin(), place.end());
  AMONTONS_ASSERT(std::adjacent_find(place.begin(), place.end(),
                                     [](const auto &a, const auto &b) { return a.first == b.first; }) == place.end());
  owner_.assign(ids.size(), rank());
  n_copies_.assign(ids.size(), 1);
  std::map<Rank, std::vector<Index>> common; // by increasing id
  auto next = place.begin();
  for_each_item(holders,
                [&](std::span<const Holder> of_item)
                {
                  next = std::lower_bound(next, place.end(), std::pair{of_item.front().id, Index(0)});
                  const Index item = next->second;
                  n_copies_[item] = static_cast<int>(of_item.size());
                  const auto wishes =
                      std::find_if(of_item.begin(), of_item.end(), [](const Holder &h) { return h.prefers != 0; });
                  owner_[item] = (wishes == of_item.end() ? of_item.front() : *wishes).rank;
                  shared_.push_back(item);
                  for (const Holder &holder : of_item)
                    if (holder.rank != rank())
                      common[holder.rank].push_back(item);
                });
  std::sort(shared_.begin(), shared_.end());
  for (auto &[other, items] : common)
  {
    neighbours_.push_back({other, std::move(items)});
    neighbour_ranks_.push_back(other);
  }
}

void Sharing::number_items(std::span<const GlobalIndex> ids)
{
  is_own_.resize(ids.size());
  n_own_ = 0;
  for (std::size_t i = 0; i < ids.size(); ++i)
    n_own_ += is_own_[i] = owner_[i] == rank();
  std::vector<double> counts(static_cast<std::size_t>(n_processes()), 0.0);
  counts[rank()] = n_own_;
  messages_->sum(phase_, counts);
  first_own_ = static_cast<GlobalIndex>(std::accumulate(counts.begin(), counts.begin() + rank(), 0.0));
  n_global_ = static_cast<GlobalIndex>(std::accumulate(counts.begin(), counts.end(), 0.0));
  std::vector<double> numbers(ids.size(), 0.0);
  for (std::size_t i = 0, own = 0; i < ids.size(); ++i)
    if (is_own_[i])
      numbers[i] = static_cast<double>(first_own_) + static_cast<double>(own++);
  take_owners(numbers);
  numbers_.assign(numbers.begin(), numbers.end());
}

Sharing Sharing::counted_as(std::string phase) const
{
  Sharing out = *this;
  out.phase_ = std::move(phase);
  return out;
}

std::vector<Message> Sharing::swap(std::span<const double> values, int width) const
{
  AMONTONS_ASSERT(values.size() == static_cast<std::size_t>(n_) * width);
  std::vector<Message> out;
  for (const Neighbour &neighbour : neighbours_)
  {
    std::vector<double> sent;
    sent.reserve(neighbour.items.size() * width);
    for (const Index item : neighbour.items)
      for (int c = 0; c < width; ++c)
        sent.push_back(values[static_cast<std::size_t>(item) * width + c]);
    ByteWriter writer;
    writer.add_values(std::span<const double>(sent));
    out.push_back({neighbour.rank, writer.take()});
  }
  return messages_->exchange_short_with(phase_, std::move(out), neighbour_ranks_);
}

/// Calls take(place, value, rank) for every copy of every shared item, rank after rank, its own among them.
template<class Combine>
void Sharing::combine(std::span<double> values, int width, Combine &&take) const
{
  const std::vector<Message> in = swap(values, width);
  std::vector<double> own;
  for (const Index item : shared_)
    for (int c = 0; c < width; ++c)
      own.push_back(values[static_cast<std::size_t>(item) * width + c]);
  const auto take_own = [&]
  {
    std::size_t k = 0;
    for (const Index item : shared_)
      for (int c = 0; c < width; ++c)
        take(item, static_cast<std::size_t>(item) * width + c, own[k++], rank());
  };
  bool own_taken = false;
  for (std::size_t n = 0; n < in.size(); ++n)
  {
    AMONTONS_ASSERT(in[n].rank == neighbours_[n].rank);
    if (in[n].rank > rank() && !std::exchange(own_taken, true))
      take_own();
    ByteReader reader(in[n].bytes);
    const auto received = reader.get_values<double>(neighbours_[n].items.size() * width);
    std::size_t k = 0;
    for (const Index item : neighbours_[n].items)
      for (int c = 0; c < width; ++c)
        take(item, static_cast<std::size_t>(item) * width + c, received[k++], in[n].rank);
  }
  if (!own_taken)
    take_own();
}

void Sharing::sum(std::span<double> values, int width) const
{
  if (!messages_)
    return;
  std::vector<double> sums(values.size(), 0.0);
  combine(values, width, [&](Index, std::size_t k, double value, Rank) { sums[k] += value; });
  for (const Index item : shared_)
    for (std::size_t k = static_cast<std::size_t>(item) * width; k < static_cast<std::size_t>(item + 1) * width; ++k)
      values[k] = sums[k];
}

void Sharing::maximum(std::span<double> values, int width) const
{
  if (messages_)
    combine(values, width, [&](Index, std::size_t k, double value, Rank) { values[k] = std::max(values[k], value); });
}

void Sharing::take_owners(std::span<double> values, int width) const
{
  if (messages_)
    combine(values, width,
            [&](Index item, std::size_t k, double value, Rank from)
            {
              if (owner_[item] == from)
                values[k] = value;
            });
}

double Sharing::dot(std::span<const double> a, std::span<const double> b, int width) const
{
  double out = 0;
  for (Index i = 0; i < n_; ++i)
    if (is_own(i))
      for (std::size_t k = static_cast<std::size_t>(i) * width; k < static_cast<std::size_t>(i + 1) * width; ++k)
        out += a[k] * b[k];
  sum_over_processes({&out, 1});
  return out;
}

void Sharing::sum_over_processes(std::span<double> values) const
{
  if (messages_)
    messages_->sum(phase_, values);
}

void Sharing::maximum_over_processes(std::span<double> values) const
{
  if (messages_)
    messages_->maximum(phase_, values);
}

double Sharing::maximum_over_processes(double value) const
{
  maximum_over_processes({&value, 1});
  return value;
}

bool Sharing::true_on_all(bool value) const
{
  return maximum_over_processes(value ? 0. : 1.) == 0;
}
} // namespace amontons
