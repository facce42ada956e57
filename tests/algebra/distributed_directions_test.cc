// Run on one, two and three processes: directions of FETI on vectors of which processes have parts of other lengths.
#include "amontons/algebra/feti_directions.h"

#include <gmock/gmock.h>

#include <cmath>

namespace amontons
{
namespace
{
/// A diagonal matrix, of which each process has some rows, the later ones more.
class Directions : public testing::Test
{
protected:
  Directions()
  {
    const Rank rank = world_.rank();
    for (Index i = 0; i < 100 + 40 * rank; ++i)
    {
      ids_.push_back(1000 * rank + i);
      diagonal_.push_back(1 + 3.7 * i + 0.11 * rank);
    }
  }

  std::vector<double> image(const std::vector<double> &x) const
  {
    std::vector<double> out(x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
      out[i] = diagonal_[i] * x[i];
    return out;
  }

  Communicator world_{MPI_COMM_WORLD};
  std::shared_ptr<MessageExchange> messages_ = std::make_shared<MessageExchange>(world_);
  std::vector<GlobalIndex> ids_;
  std::vector<double> diagonal_;
};

TEST_F(Directions, TheOldestGivesWayOnAllProcessesAtOnce)
{
  const Sharing rows(messages_, "test", ids_);
  // 45 of the shorter vectors, fewer of the longer ones.
  FetiDirections directions(45 * 16 * 100);
  directions.start(ids_.size(), 0, ids_.size(), rows);
  std::vector<double> x(ids_.size(), 0.0), r(ids_.size(), 1.0);
  const double start = std::sqrt(rows.dot(r, r));
  int n = 0;
  for (; n < 1000 && std::sqrt(rows.dot(r, r)) > 1e-6 * start; ++n)
    ASSERT_TRUE(directions.add(r, image(r), x, r));
  EXPECT_GT(n, 45);
  EXPECT_LT(n, 1000);
  const std::vector<double> resisted = image(x);
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_NEAR(resisted[i] + r[i], 1, 1e-9);
}
} // namespace
} // namespace amontons
