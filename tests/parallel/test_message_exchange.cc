// Run on several processes. Every expectation holds on each of them.
#include "amontons/parallel/message_exchange.h"

#include <gtest/gtest.h>

#include <random>

namespace amontons
{
namespace
{
// What process `from` writes to process `to` in a round: numbers that tell who, whom and when; nothing for most.
std::vector<int> letter(int round, Rank from, Rank to, int size)
{
  std::mt19937 random(static_cast<unsigned>((round * size + from) * size + to));
  if (random() % 3 != 0)
    return {};
  std::vector<int> numbers(random() % (round % 5 == 0 ? 40000 : 5)); // long ones do not go without a receiver
  for (int &number : numbers)
    number = static_cast<int>(random());
  numbers.insert(numbers.begin(), {round, from, to});
  return numbers;
}

class MessagesOfMany : public testing::Test
{
protected:
  std::vector<Message> outgoing(int round)
  {
    std::vector<Message> out;
    for (Rank to = 0; to < world_.size(); ++to)
      if (const std::vector<int> numbers = letter(round, world_.rank(), to, world_.size()); !numbers.empty())
      {
        ByteWriter writer;
        writer.add_array(numbers);
        out.push_back({to, writer.take()});
      }
    return out;
  }
  void expect_incoming(int round, const std::vector<Message> &in)
  {
    std::size_t k = 0;
    for (Rank from = 0; from < world_.size(); ++from)
    {
      const std::vector<int> numbers = letter(round, from, world_.rank(), world_.size());
      if (numbers.empty())
        continue;
      ASSERT_LT(k, in.size());
      EXPECT_EQ(in[k].rank, from);
      ByteReader reader(in[k].bytes);
      EXPECT_EQ(reader.get_array<int>(), numbers);
      EXPECT_TRUE(reader.is_at_end());
      ++k;
    }
    EXPECT_EQ(k, in.size());
  }

  Communicator world_{MPI_COMM_WORLD};
  MessageExchange messages_{world_};
};

TEST_F(MessagesOfMany, RoundsDoNotMix)
{
  for (int round = 0; round < 50; ++round)
    expect_incoming(round, messages_.exchange("round", outgoing(round)));
}

TEST_F(MessagesOfMany, KnownSources)
{
  for (int round = 0; round < 50; ++round)
  {
    std::vector<Rank> sources;
    for (Rank from = 0; from < world_.size(); ++from)
      if (!letter(round, from, world_.rank(), world_.size()).empty())
        sources.push_back(from);
    expect_incoming(round, messages_.exchange_with("known", outgoing(round), sources));
    expect_incoming(round + 1, messages_.exchange("round", outgoing(round + 1)));
  }
}

TEST_F(MessagesOfMany, CountsWhatIsSentToOthers)
{
  const Rank next = (world_.rank() + 1) % world_.size();
  messages_.exchange("a", {{next, Bytes(10)}, {world_.rank(), Bytes(1000)}});
  messages_.exchange("a", {{next, Bytes(7)}});
  std::vector<double> values{static_cast<double>(world_.rank()), -static_cast<double>(world_.rank())};
  messages_.maximum("b", values);
  EXPECT_EQ(values, (std::vector<double>{world_.size() - 1.0, 0.0}));
  messages_.sum("b", values);
  EXPECT_EQ(values[0], (world_.size() - 1.0) * world_.size());
  const auto &traffic = messages_.traffic();
  EXPECT_EQ(traffic.at("a").messages, 2);
  EXPECT_EQ(traffic.at("a").bytes, 17);
  EXPECT_EQ(traffic.at("b").messages, 0);
  EXPECT_EQ(traffic.at("b").reductions, 2);
  EXPECT_EQ(traffic.at("b").reduced_bytes, 32);
  messages_.forget_traffic();
  EXPECT_TRUE(messages_.traffic().empty());
}
} // namespace
} // namespace amontons
