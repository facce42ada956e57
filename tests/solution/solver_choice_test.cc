#include "problem.h"

#include <gtest/gtest.h>

/// Bodies of very different stiffness: how tightly linear systems are solved, and what takes over where a solver fails.
namespace amontons::test
{
namespace
{
/// A stiff block pressed on a soft one and pushed along it.
Problem stiff_on_soft(double stiffness, int n, double mu)
{
  Blocks blocks(3);
  blocks.add("soft", {0, 0, 0}, {2, 1, 1}, {2 * n, n, n});
  blocks.add("stiff", {0, 0, 1}, {2, 1, 1}, {2 * n + 2, n + 1, n + 1});
  Problem problem(blocks, Kinematics::three_dimensional);
  problem.elastic("soft", 1, 0.3);
  problem.elastic("stiff", stiffness, 0.3);
  problem.contact("stiff_bottom", "soft_top", mu);
  problem.on("soft_bottom").fix = {0, 1, 2};
  problem.on("stiff_top").displacement = {
      {0, expression("0.1*t")}, {1, expression("0.03*t")}, {2, expression("-0.05*t")}};
  problem.options.loading.increments = 4;
  return problem;
}

TEST(SolverChoice, IterationsOfNewtonDoNotHangOnTheContrastOfStiffness)
{
  Problem problem = stiff_on_soft(1000, 5, 0.3);
  problem.options.solver.linear = LinearSolverType::direct;
  const Record direct = problem.converge();
  for (const LinearSolverType linear : {LinearSolverType::amg, LinearSolverType::feti})
  {
    problem.options.solver.linear = linear;
    const Record run = problem.converge();
    EXPECT_EQ(run.attempts.size(), direct.attempts.size());
    EXPECT_EQ(run.iterations(), direct.iterations());
    EXPECT_LT((total_force(run.contact()) - total_force(direct.contact())).norm(),
              1e-8 * total_force(direct.contact()).norm());
  }
}

// Single precision in the subdomains cannot tell a body from one 1e11 times stiffer, nor can multigrid.
TEST(SolverChoice, AnotherSolverTakesOverWhereOneFails)
{
  Problem problem = stiff_on_soft(1e11, 14, 0);
  problem.options.contact[0].tied = true;
  problem.options.loading.increments = 1;
  const Record run = problem.converge();
  ASSERT_EQ(run.warnings.size(), 2u);
  EXPECT_NE(run.warnings[0].find("'linear: amg' takes over"), std::string::npos) << run.warnings[0];
  EXPECT_NE(run.warnings[1].find("'linear: direct' takes over"), std::string::npos) << run.warnings[1];
  EXPECT_EQ(run.attempts.size(), 3u) << "the increment is not cut";
}

TEST(SolverChoice, ASolverAskedForByNameIsNotExchanged)
{
  Problem problem = stiff_on_soft(1e11, 3, 0);
  problem.options.contact[0].tied = true;
  problem.options.loading.increments = 1;
  problem.options.loading.fixed = true;
  problem.options.solver.linear = LinearSolverType::feti;
  const Record run = problem.solve();
  EXPECT_FALSE(run.result.converged);
  EXPECT_TRUE(run.warnings.empty());
  EXPECT_NE(run.failure.find("subdomains"), std::string::npos) << run.failure;
}
} // namespace
} // namespace amontons::test
