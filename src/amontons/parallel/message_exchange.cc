#include "amontons/parallel/message_exchange.h"

#include "amontons/base/error.h"
#include "amontons/parallel/agreement.h"

#include <algorithm>
#include <limits>

namespace amontons
{
namespace
{
// A process can be one round of exchange() ahead of another, never two: the barrier of a round is left only after all
// have entered it. So two tags keep the rounds apart.
constexpr int known_tag = 2;

MPI_Comm duplicate(MPI_Comm communicator)
{
  MPI_Comm result = MPI_COMM_NULL;
  MPI_Comm_dup(communicator, &result);
  return result;
}

int length(const Message &message)
{
  return static_cast<int>(message.bytes.size());
}

// Before any is sent: who fails while others wait for its messages would leave them waiting.
void check_lengths(const Communicator &all, std::span<const Message> out)
{
  agree_on_errors(all,
                  [&]
                  {
                    for (const Message &message : out)
                      if (message.bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
                        throw UserError("a message of " + std::to_string(message.bytes.size()) + " bytes to process " +
                                        std::to_string(message.rank) +
                                        ": at most 2 GB go at once; take more processes");
                  });
}

Message receive(MPI_Message &handle, const MPI_Status &status)
{
  int n = 0;
  MPI_Get_count(&status, MPI_BYTE, &n);
  Message message{status.MPI_SOURCE, Bytes(static_cast<std::size_t>(n))};
  MPI_Mrecv(message.bytes.data(), n, MPI_BYTE, &handle, MPI_STATUS_IGNORE);
  return message;
}

// Takes out what a process sends to itself.
std::vector<Message> take_own(std::vector<Message> &out, Rank rank)
{
  std::vector<Message> own;
  for (Message &message : out)
    if (message.rank == rank)
      own.push_back(std::move(message));
  std::erase_if(out, [rank](const Message &message) { return message.rank == rank; });
  return own;
}

void sort_by_rank(std::vector<Message> &messages)
{
  std::sort(messages.begin(), messages.end(), [](const Message &a, const Message &b) { return a.rank < b.rank; });
}
} // namespace

MessageExchange::MessageExchange(const Communicator &communicator)
  : own_(duplicate(communicator.mpi()))
{
}

MessageExchange::~MessageExchange()
{
  int finalized = 0;
  MPI_Finalized(&finalized);
  MPI_Comm communicator = own_.mpi();
  if (finalized == 0)
    MPI_Comm_free(&communicator);
}

void MessageExchange::add_traffic(const std::map<std::string, Traffic> &other)
{
  for (const auto &[phase, traffic] : other)
  {
    Traffic &own = traffic_[phase];
    own.messages += traffic.messages;
    own.bytes += traffic.bytes;
    own.reductions += traffic.reductions;
    own.reduced_bytes += traffic.reduced_bytes;
  }
}

void MessageExchange::count(const std::string &phase, const std::vector<Message> &out)
{
  Traffic &traffic = traffic_[phase];
  traffic.messages += static_cast<std::int64_t>(out.size());
  for (const Message &message : out)
    traffic.bytes += static_cast<std::int64_t>(message.bytes.size());
}

std::vector<Message> MessageExchange::exchange(const std::string &phase, std::vector<Message> out)
{
  std::vector<Message> in = take_own(out, own_.rank());
  check_lengths(own_, out);
  count(phase, out);
  const int tag = round_++ % 2;
  std::vector<MPI_Request> sends(out.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    MPI_Issend(out[i].bytes.data(), length(out[i]), MPI_BYTE, out[i].rank, tag, own_.mpi(), &sends[i]);
  MPI_Request barrier = MPI_REQUEST_NULL;
  for (int all_arrived = 0; all_arrived == 0;)
  {
    int there_is_one = 0;
    MPI_Message handle = MPI_MESSAGE_NULL;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, tag, own_.mpi(), &there_is_one, &handle, &status);
    if (there_is_one != 0)
      in.push_back(receive(handle, status));
    if (barrier != MPI_REQUEST_NULL)
      MPI_Test(&barrier, &all_arrived, MPI_STATUS_IGNORE);
    else
    {
      int sent = 0;
      MPI_Testall(static_cast<int>(sends.size()), sends.data(), &sent, MPI_STATUSES_IGNORE);
      if (sent != 0)
        MPI_Ibarrier(own_.mpi(), &barrier);
    }
  }
  sort_by_rank(in);
  return in;
}

std::vector<Message> MessageExchange::exchange_with(const std::string &phase, std::vector<Message> out,
                                                    std::span<const Rank> sources)
{
  check_lengths(own_, out);
  return exchange_short_with(phase, std::move(out), sources);
}

std::vector<Message> MessageExchange::exchange_short_with(const std::string &phase, std::vector<Message> out,
                                                          std::span<const Rank> sources)
{
  std::vector<Message> in = take_own(out, own_.rank());
  count(phase, out);
  std::vector<MPI_Request> sends(out.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    MPI_Isend(out[i].bytes.data(), length(out[i]), MPI_BYTE, out[i].rank, known_tag, own_.mpi(), &sends[i]);
  for (const Rank source : sources)
  {
    if (source == own_.rank())
      continue;
    MPI_Message handle = MPI_MESSAGE_NULL;
    MPI_Status status;
    MPI_Mprobe(source, known_tag, own_.mpi(), &handle, &status);
    in.push_back(receive(handle, status));
  }
  MPI_Waitall(static_cast<int>(sends.size()), sends.data(), MPI_STATUSES_IGNORE);
  sort_by_rank(in);
  return in;
}

void MessageExchange::reduce(const std::string &phase, std::span<double> values, MPI_Op operation)
{
  Traffic &traffic = traffic_[phase];
  ++traffic.reductions;
  traffic.reduced_bytes += static_cast<std::int64_t>(values.size_bytes());
  AMONTONS_ASSERT(values.size() <= static_cast<std::size_t>(std::numeric_limits<int>::max()));
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, operation, own_.mpi());
}

void MessageExchange::maximum(const std::string &phase, std::span<double> values)
{
  reduce(phase, values, MPI_MAX);
}

void MessageExchange::sum(const std::string &phase, std::span<double> values)
{
  reduce(phase, values, MPI_SUM);
}
} // namespace amontons
