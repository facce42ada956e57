#include "amontons/algebra/linear_solver.h"
#include "amontons/base/error.h"

#include <gtest/gtest.h>

namespace amontons
{
namespace
{
/// Values of [a b; c d] and, once more, of the first.
struct Small
{
  Small() { positions = make_pattern(matrix, 2, std::vector<Index>{0, 0, 1, 1, 0}, std::vector<Index>{0, 1, 0, 1, 0}); }
  void set(const std::vector<double> &entries)
  {
    matrix.values.assign(matrix.values.size(), 0);
    for (std::size_t k = 0; k < entries.size(); ++k)
      matrix.values[positions[k]] += entries[k];
  }
  SparseMatrix matrix;
  Sharing blocks{2};
  std::vector<Index> positions;
};

TEST(SparseMatrix, RepeatedEntriesHaveOnePlace)
{
  Small small;
  EXPECT_EQ(small.matrix.col, (std::vector<Index>{0, 1, 0, 1}));
  EXPECT_EQ(small.positions[0], small.positions[4]);
  small.set({1, 2, 2, 4, 5});
  EXPECT_TRUE(is_symmetric(small.matrix));
  small.set({1, 2, 2 + 1e-9, 4, 5});
  EXPECT_FALSE(is_symmetric(small.matrix));
}

TEST(DirectSolver, SolvesAndSaysWhatIsSingular)
{
  Small small;
  const auto solver = make_direct_solver();
  solver->set_matrix(small.matrix, small.blocks);
  std::vector<double> x(2);
  const auto solve = [&](const std::vector<double> &entries)
  {
    small.set(entries);
    solver->factorize();
    solver->solve(std::vector<double>{10, 14}, x, 0);
  };
  solve({1, 2, 3, 4, 5}); // [6 2; 3 4]
  EXPECT_NEAR(x[0], 2. / 3, 1e-14);
  EXPECT_NEAR(x[1], 3, 1e-14);
  EXPECT_THROW(solve({1, 2, 0, 0, 2}), NumericalFailure); // [3 2; 0 0]
  EXPECT_THROW(solve({1, 2, 2, 4, 0}), NumericalFailure) << "symmetric, of rank one";
  solve({1, 2, 3, 4, 5});
  EXPECT_NEAR(x[1], 3, 1e-14) << "a failure leaves the solver usable";
  solve({1, 2, 2, -4, 5}); // [6 2; 2 -4], indefinite
  EXPECT_NEAR(x[0], 68. / 28, 1e-14);
  EXPECT_NEAR(x[1], -64. / 28, 1e-14);
}

/// A body on a spring far softer than itself: what is left is the round-off of forces that are far greater than the
/// load.
TEST(DirectSolver, WeakRestraintsAreNoSingularity)
{
  constexpr double spring = 1e-13;
  Small small;
  const auto solver = make_direct_solver();
  solver->set_matrix(small.matrix, small.blocks);
  small.set({1 + spring, -1, -1, 1, 0});
  solver->factorize();
  std::vector<double> x(2);
  solver->solve(std::vector<double>{10, 14}, x, 0);
  EXPECT_NEAR(x[0] * spring / 24, 1, 0.01); // 1 + 1e-13 is known to a thousandth of the spring
  EXPECT_NEAR(x[1] / x[0], 1, 1e-12);
}
} // namespace
} // namespace amontons
