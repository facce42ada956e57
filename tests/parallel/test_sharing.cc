// Run on three processes.
#include "amontons/parallel/holders.h"
#include "amontons/parallel/sharing.h"

#include <gmock/gmock.h>

#include <map>

namespace amontons
{
namespace
{
using testing::ElementsAre;

/// Ids 10 r .. 10 r + 9 on process r alone; 100 on all, 101 on 0 and 2, 102 on 1 and 2.
class SharedItems : public testing::Test
{
protected:
  SharedItems()
  {
    const Rank rank = messages_->communicator().rank();
    ids_ = {100};
    for (int k = 0; k < 10; ++k)
      ids_.push_back(10 * rank + k);
    if (rank != 1)
      ids_.push_back(101);
    if (rank != 0)
      ids_.insert(ids_.begin() + 3, 102);
  }
  [[nodiscard]] double &of(GlobalIndex id, std::vector<double> &values) const
  {
    return values[std::find(ids_.begin(), ids_.end(), id) - ids_.begin()];
  }
  [[nodiscard]] bool has(GlobalIndex id) const { return std::find(ids_.begin(), ids_.end(), id) != ids_.end(); }

  std::shared_ptr<MessageExchange> messages_ = std::make_shared<MessageExchange>(Communicator(MPI_COMM_WORLD));
  std::vector<GlobalIndex> ids_;
};

TEST_F(SharedItems, NumbersAreThoseOfTheOwners)
{
  const Sharing sharing(messages_, "test", ids_);
  EXPECT_EQ(sharing.n_global(), 33);
  std::vector<double> seen(33, 0.0);
  for (Index i = 0; i < sharing.size(); ++i)
    if (sharing.is_own(i))
    {
      ++seen[sharing.number(i)];
      EXPECT_GE(sharing.number(i), sharing.first_own_number());
      EXPECT_LT(sharing.number(i), sharing.first_own_number() + sharing.n_own());
    }
  sharing.sum_over_processes(seen);
  EXPECT_THAT(seen, testing::Each(1));
  // Process 0 has the first, so its number is known.
  EXPECT_EQ(sharing.number(0), 0);
  EXPECT_EQ(sharing.n_copies(0), 3);
}

TEST_F(SharedItems, WhoPrefersToOwnDoes)
{
  std::vector<char> preferred(ids_.size(), 0);
  preferred[0] = messages_->communicator().rank() == 2;
  const Sharing sharing(messages_, "test", ids_, preferred);
  EXPECT_EQ(sharing.is_own(0), messages_->communicator().rank() == 2);
}

TEST_F(SharedItems, SumMaximumAndOwnersReachEveryCopy)
{
  const Sharing sharing(messages_, "test", ids_);
  const Rank rank = messages_->communicator().rank();
  std::vector<double> two(2 * ids_.size());
  for (std::size_t i = 0; i < ids_.size(); ++i)
  {
    two[2 * i] = static_cast<double>(ids_[i]);
    two[2 * i + 1] = rank + 1;
  }
  std::vector<double> sums = two, greatest = two, owners = two;
  sharing.sum(sums, 2);
  sharing.maximum(greatest, 2);
  sharing.take_owners(owners, 2);
  for (std::size_t i = 0; i < ids_.size(); ++i)
  {
    const GlobalIndex id = ids_[i];
    const double n = id == 100 ? 3 : id > 100 ? 2 : 1;
    EXPECT_EQ(sums[2 * i], n * static_cast<double>(id));
    EXPECT_EQ(sums[2 * i + 1], id == 100 ? 6 : id == 101 ? 4 : id == 102 ? 5 : rank + 1);
    EXPECT_EQ(greatest[2 * i + 1], id >= 100 ? 3 : rank + 1);
    EXPECT_EQ(owners[2 * i + 1], id == 100 || id == 101 ? 1 : id == 102 ? 2 : rank + 1);
  }
}

TEST_F(SharedItems, CopiesOfASumAreEqualBitByBit)
{
  const Sharing sharing(messages_, "test", ids_);
  std::vector<double> values(ids_.size(), 0.1 * (messages_->communicator().rank() + 1) + 1e-17);
  sharing.sum(values);
  std::vector<double> greatest = values, least = values;
  for (double &value : least)
    value = -value;
  sharing.maximum(greatest);
  sharing.maximum(least);
  for (std::size_t i = 0; i < ids_.size(); ++i)
    EXPECT_EQ(greatest[i], -least[i]);
}

/// Process r says r + 1 numbers of every item but 101.
TEST_F(SharedItems, HoldersHearWhatOthersSay)
{
  const Sharing sharing(messages_, "test", ids_);
  const Rank rank = messages_->communicator().rank();
  std::map<GlobalIndex, std::vector<std::vector<double>>> heard;
  tell_holders(
      sharing, "test", [&](Index i) { return ids_[i] != 101; },
      [&](Index i, ByteWriter &writer)
      { writer.add_array(std::vector<double>(rank + 1, static_cast<double>(ids_[i]))); },
      [&](Index i, ByteReader &reader) { heard[ids_[i]].push_back(reader.get_array<double>()); });
  std::map<GlobalIndex, std::vector<std::vector<double>>> expected;
  for (Rank other = 0; other < 3; ++other)
    for (const GlobalIndex id : {100, 102})
      if (other != rank && has(id) && (id == 100 || other != 0))
        expected[id].emplace_back(other + 1, static_cast<double>(id));
  EXPECT_EQ(heard, expected);
}

TEST_F(SharedItems, DotCountsEachItemOnce)
{
  const Sharing sharing(messages_, "test", ids_);
  const std::vector<double> ones(ids_.size(), 1.0);
  EXPECT_EQ(sharing.dot(ones, ones), 33);
  EXPECT_FALSE(sharing.true_on_all(messages_->communicator().rank() != 1));
  EXPECT_TRUE(sharing.true_on_all(true));
}

TEST_F(SharedItems, NeighboursListTheSameItemsInTheSameOrder)
{
  const Sharing sharing(messages_, "test", ids_);
  const Rank rank = messages_->communicator().rank();
  ASSERT_EQ(sharing.neighbours().size(), 2U);
  for (const Sharing::Neighbour &neighbour : sharing.neighbours())
  {
    std::vector<GlobalIndex> common;
    for (const Index item : neighbour.items)
      common.push_back(ids_[item]);
    const Rank third = 3 - rank - neighbour.rank;
    const std::vector<std::vector<GlobalIndex>> expected{{100, 102}, {100, 101}, {100}};
    EXPECT_EQ(common, expected[third]);
  }
}

TEST_F(SharedItems, TrafficIsCountedUnderTheNamedPhase)
{
  const Sharing sharing = Sharing(messages_, "test", ids_).counted_as("other");
  messages_->forget_traffic();
  std::vector<double> values(ids_.size(), 1.0);
  sharing.sum(values);
  EXPECT_EQ(messages_->traffic().size(), 1U);
  EXPECT_EQ(messages_->traffic().at("other").messages, 2);
}

TEST(Sharing, OfOneProcessSendsNothing)
{
  const auto alone = std::make_shared<MessageExchange>(Communicator(MPI_COMM_SELF));
  const Sharing sharing(alone, "test", std::vector<GlobalIndex>{7, 3});
  EXPECT_FALSE(sharing.is_distributed());
  std::vector<double> values{1, 2};
  sharing.sum(values);
  EXPECT_THAT(values, ElementsAre(1, 2));
  EXPECT_EQ(sharing.number(1), 1);
  EXPECT_EQ(sharing.n_global(), 2);
}
} // namespace
} // namespace amontons
