// Run on three processes. Every expectation holds on each of them.
#include "amontons/base/error.h"
#include "amontons/parallel/agreement.h"

#include <gmock/gmock.h>

#include <cmath>

namespace amontons
{
namespace
{
using testing::StrEq;
using testing::ThrowsMessage;

class Agreement : public testing::Test
{
protected:
  Communicator world_{MPI_COMM_WORLD};
};

TEST_F(Agreement, RunsOnSeveralProcesses)
{
  ASSERT_EQ(world_.size(), 3);
}

TEST_F(Agreement, NobodyFails)
{
  int done = 0;
  agree_on_errors(world_, [&] { ++done; });
  EXPECT_EQ(done, 1);
}

TEST_F(Agreement, ErrorOfOneIsErrorOfAll)
{
  const auto collective = [&]
  {
    agree_on_errors(world_,
                    [&]
                    {
                      if (world_.rank() == 1)
                        throw UserError("a.yml:3:1: no such region");
                    });
  };
  EXPECT_THAT(collective, ThrowsMessage<UserError>(StrEq("a.yml:3:1: no such region")));
}

TEST_F(Agreement, GravestErrorWinsThenLowestRank)
{
  const auto collective = [&]
  {
    agree_on_errors(world_,
                    [&]
                    {
                      if (world_.rank() == 0)
                        throw UserError("deck");
                      throw NumericalFailure("rank " + std::to_string(world_.rank()));
                    });
  };
  EXPECT_THAT(collective, ThrowsMessage<NumericalFailure>(StrEq("rank 1")));
}

TEST_F(Agreement, AnyOtherExceptionIsInternal)
{
  const auto collective = [&]
  {
    agree_on_errors(world_,
                    [&]
                    {
                      if (world_.rank() == 2)
                        throw std::out_of_range("vector");
                      throw NumericalFailure("norm");
                    });
  };
  EXPECT_THAT(collective, ThrowsMessage<InternalError>(StrEq("vector")));
}

TEST_F(Agreement, BroadcastsText)
{
  const std::string mine = "from rank " + std::to_string(world_.rank());
  EXPECT_EQ(world_.broadcast(mine, 2), "from rank 2");
  EXPECT_EQ(world_.broadcast(world_.rank() == 0 ? "" : mine, 0), "");
}

TEST_F(Agreement, OneOfAllIsTheGreatestAndTells)
{
  const Sharing processes(std::make_shared<MessageExchange>(world_), "test", std::vector<GlobalIndex>{world_.rank()});
  const auto winner = [&](double value, double place) {
    return told_by_one(processes, is_greatest(processes, value, place), [&] { return std::to_string(world_.rank()); });
  };
  const int rank = world_.rank();
  EXPECT_EQ(winner(-std::abs(rank - 1), 0), "1");
  EXPECT_EQ(winner(rank == 0 ? 4 : 5, 10 - rank), "2") << "of equal ones that of the lowest place";
  EXPECT_EQ(winner(rank == 0 ? -7 : no_candidate, rank), "0");
  EXPECT_EQ(winner(no_candidate, rank), "");
}
} // namespace
} // namespace amontons
