#pragma once
#include "amontons/parallel/bytes.h"
#include "amontons/parallel/communicator.h"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace amontons
{
/// To a process, or from one.
struct Message
{
  Rank rank = 0;
  Bytes bytes;
};

/// What one process has sent; what it keeps for itself is not counted.
struct Traffic
{
  std::int64_t messages = 0, bytes = 0;
  std::int64_t reductions = 0, reduced_bytes = 0; ///< calls of maximum() and sum(), and what it brought to them
};

/// Messages between processes of which each knows only whom it writes to. Counts what it sends, by named phase.
///
/// Works on a duplicate of the communicator, so that its messages meet nobody else's. All calls are collective, and so
/// are construction and destruction.
class MessageExchange
{
public:
  explicit MessageExchange(const Communicator &communicator);
  MessageExchange(const MessageExchange &) = delete;
  MessageExchange &operator=(const MessageExchange &) = delete;
  ~MessageExchange();

  [[nodiscard]] const Communicator &communicator() const { return own_; }

  /// Nobody knows who writes to it: synchronous sends, and a barrier that nobody waits in, entered once one's own
  /// messages have arrived (Hoefler, Siebert, Lumsdaine 2010, "NBX"). Costs its messages and one barrier of log N
  /// steps.
  /// @param out one message at most to a process, itself too @return by the sender's rank
  std::vector<Message> exchange(const std::string &phase, std::vector<Message> out);

  /// Each knows who writes to it: only the messages.
  /// @param sources by rank, each once @return in their order
  std::vector<Message> exchange_with(const std::string &phase, std::vector<Message> out, std::span<const Rank> sources);

  /// The same without agreement on the messages' lengths, for those that are known to be below 2 GB. Not collective.
  std::vector<Message> exchange_short_with(const std::string &phase, std::vector<Message> out,
                                           std::span<const Rank> sources);

  /// The greatest, and the sum, of all processes' values, entry by entry, on all.
  void maximum(const std::string &phase, std::span<double> values);
  void sum(const std::string &phase, std::span<double> values);

  [[nodiscard]] const std::map<std::string, Traffic> &traffic() const { return traffic_; }
  void forget_traffic() { traffic_.clear(); }
  /// Counts what the process has sent by other ways as well.
  void add_traffic(const std::map<std::string, Traffic> &other);

private:
  void count(const std::string &phase, const std::vector<Message> &out);
  void reduce(const std::string &phase, std::span<double> values, MPI_Op operation);

  Communicator own_;
  int round_ = 0; ///< of exchange()
  std::map<std::string, Traffic> traffic_;
};
} // namespace amontons
