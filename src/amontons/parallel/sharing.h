#pragma once
#include "amontons/base/ids.h"
#include "amontons/parallel/message_exchange.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace amontons
{
/// Items (nodes, unknowns, rows) that each process numbers for itself, some of them being copies of the same item on
/// several processes. One of the copies is the owner's.
///
/// Vectors over the items are given whole, [size() * width], width numbers to an item. Without processes (the default,
/// and whatever a communicator of one process gives) every item is its own and nothing is sent.
class Sharing
{
public:
  /// Another process with copies of items that are here too.
  struct Neighbour
  {
    Rank rank;
    std::vector<Index> items; ///< that both have, by increasing id
  };

  /// An item that a process has, as who looks after its id knows and tells.
  struct Holder
  {
    GlobalIndex id;
    Rank rank;
    char prefers; ///< to own it
  };

  explicit Sharing(Index n = 0)
    : n_(n)
    , n_own_(n)
  {
  }

  /// Finds out who has copies of what; the work is spread by id, no process hears of all. Collective.
  /// @param phase under which traffic is counted
  /// @param ids [n] each once on a process
  /// @param preferred [n] or empty: the owner is the lowest rank among those that have the item and prefer to own it,
  ///        else the lowest that has it
  Sharing(std::shared_ptr<MessageExchange> messages, std::string phase, std::span<const GlobalIndex> ids,
          std::span<const char> preferred = {});

  [[nodiscard]] Index size() const { return n_; }
  [[nodiscard]] bool is_distributed() const { return messages_ != nullptr; }
  [[nodiscard]] Rank rank() const { return messages_ ? messages_->communicator().rank() : 0; }
  [[nodiscard]] int n_processes() const { return messages_ ? messages_->communicator().size() : 1; }
  /// Null where nothing is distributed.
  [[nodiscard]] const std::shared_ptr<MessageExchange> &messages() const { return messages_; }

  [[nodiscard]] bool is_own(Index i) const { return is_own_.empty() || is_own_[i] != 0; }
  [[nodiscard]] Index n_own() const { return n_own_; }
  /// Over all processes.
  [[nodiscard]] GlobalIndex n_global() const { return messages_ ? n_global_ : n_; }
  /// 0 .. n_global()-1: the owners' items, process after process, in the order in which each has them.
  [[nodiscard]] GlobalIndex number(Index i) const { return messages_ ? numbers_[i] : i; }
  [[nodiscard]] GlobalIndex first_own_number() const { return first_own_; }
  /// Number of processes that have a copy.
  [[nodiscard]] int n_copies(Index i) const { return n_copies_.empty() ? 1 : n_copies_[i]; }
  /// By rank.
  [[nodiscard]] std::span<const Neighbour> neighbours() const { return neighbours_; }
  /// The same, its traffic counted under another phase.
  [[nodiscard]] Sharing counted_as(std::string phase) const;

  /// Each copy becomes the sum of all: added in the order of ranks, so that copies stay equal bit by bit. Collective.
  void sum(std::span<double> values, int width = 1) const;
  /// The same with the greatest.
  void maximum(std::span<double> values, int width = 1) const;
  /// Each copy becomes the owner's. Collective.
  void take_owners(std::span<double> values, int width = 1) const;

  /// sum of a_i b_i over the items, each once. Equal on all processes. Collective.
  [[nodiscard]] double dot(std::span<const double> a, std::span<const double> b, int width = 1) const;
  /// Sums, and greatest, over the processes, entry by entry. Equal on all. Collective.
  void sum_over_processes(std::span<double> values) const;
  void maximum_over_processes(std::span<double> values) const;
  [[nodiscard]] double maximum_over_processes(double value) const;
  /// Whether it is true on every process. Collective.
  [[nodiscard]] bool true_on_all(bool value) const;

private:
  void find_copies(std::span<const GlobalIndex> ids, std::span<const char> preferred);
  void take_holders(std::span<const GlobalIndex> ids, std::vector<Holder> holders);
  void number_items(std::span<const GlobalIndex> ids);
  template<class Combine>
  void combine(std::span<double> values, int width, Combine &&take) const;
  [[nodiscard]] std::vector<Message> swap(std::span<const double> values, int width) const;

  Index n_ = 0, n_own_ = 0;
  std::shared_ptr<MessageExchange> messages_;
  std::string phase_;
  std::vector<char> is_own_;
  std::vector<Rank> owner_;
  std::vector<int> n_copies_;
  std::vector<GlobalIndex> numbers_;
  GlobalIndex n_global_ = 0, first_own_ = 0;
  std::vector<Neighbour> neighbours_;
  std::vector<Rank> neighbour_ranks_;
  std::vector<Index> shared_; ///< items with copies elsewhere
};
} // namespace amontons
