#include "problem.h"

#include <gmock/gmock.h>

/// Increments that are cut, grown, or not.
namespace amontons::test
{
namespace
{
using testing::HasSubstr;

/// A block pressed far into another, in finite strain without friction: the way does not matter.
Problem squeeze(int increments, TargetNormals normals = TargetNormals::faceted)
{
  Blocks blocks(2);
  blocks.add("base", {-1, -1, 0}, {2, 1, 0}, {8, 4, 0});
  blocks.add("punch", {-0.45, 0, 0}, {0.9, 0.5, 0}, {4, 2, 0});
  Problem problem(blocks, Kinematics::plane_strain, Strain::finite);
  problem.elastic("base");
  problem.elastic("punch", 5);
  problem.contact("punch_bottom", "base_top").normals = normals;
  problem.on("base_bottom").fix = {0, 1};
  problem.on("punch_top").displacement = {{0, expression("0")}, {1, expression("-0.15*t")}};
  problem.options.loading.increments = increments;
  problem.options.solver.tolerance = 1e-10;
  return problem;
}

TEST(Increments, TooLargeAnIncrementIsCutAndGivesTheSameAnswer)
{
  Problem large = squeeze(1);
  large.options.solver.max_iterations = 3;
  const Record cut = large.converge();
  const Record small = squeeze(8).converge();
  EXPECT_FALSE(cut.attempts.front().converged);
  EXPECT_THAT(cut.attempts.front().cause, HasSubstr("no convergence in 3 iterations"));
  EXPECT_LT(cut.attempts[1].time_step, 0.51);
  EXPECT_EQ(cut.state().time, 1);
  for (const Attempt &attempt : small.attempts)
    EXPECT_TRUE(attempt.converged);
  EXPECT_LT(relative_difference(cut.state().displacement, small.state().displacement), 1e-8);
  EXPECT_LT(relative_difference(cut.contact().force, small.contact().force), 1e-7);
  double time = 0;
  for (std::size_t k = 1; k < cut.states.size(); ++k)
  {
    EXPECT_GT(cut.states[k].time, time);
    EXPECT_EQ(cut.states[k].increment, static_cast<int>(k));
    time = cut.states[k].time;
  }
}

TEST(Increments, SmoothedNormalsCarryTheirLagOverOneIncrementOnly)
{
  const Record coarse = squeeze(8, TargetNormals::smoothed).converge();
  const Record fine = squeeze(16, TargetNormals::smoothed).converge();
  EXPECT_LT(relative_difference(coarse.state().displacement, fine.state().displacement), 0.01);
}

TEST(Increments, GrowAgainWhereTheyAreEasy)
{
  Problem problem = squeeze(1);
  problem.options.solver.max_iterations = 3;
  problem.options.loading.max_increment = 0.4;
  const Record run = problem.converge();
  EXPECT_EQ(run.state().time, 1);
  bool grew = false;
  for (std::size_t k = 1; k < run.attempts.size(); ++k)
  {
    const Attempt &before = run.attempts[k - 1], &now = run.attempts[k];
    EXPECT_LE(now.time_step, 0.4 + 1e-12);
    if (before.converged)
      grew = grew || now.time_step > 1.4 * before.time_step;
    else
      EXPECT_LT(now.time_step, 0.6 * before.time_step);
  }
  EXPECT_FALSE(run.attempts.front().converged);
  EXPECT_TRUE(grew);
}

TEST(Increments, FixedOnesAreNeverCut)
{
  Problem problem = squeeze(1);
  problem.options.solver.max_iterations = 3;
  problem.options.loading.fixed = true;
  const Record run = problem.solve();
  EXPECT_FALSE(run.result.converged);
  EXPECT_EQ(run.attempts.size(), 1u);
  EXPECT_THAT(run.result.failure, HasSubstr("no convergence in 3 iterations"));
  EXPECT_EQ(run.last.increment, 0);
}

/// Bodies that travel for some increments before they touch bear no force yet, and none to measure a residual by.
TEST(Increments, TravelBeforeTouchingConverges)
{
  Blocks blocks(2);
  blocks.add("block", {-0.5, 0.3, 0}, {1, 0.5, 0}, {4, 2, 0});
  Problem problem(blocks, Kinematics::plane_strain, Strain::finite);
  problem.elastic("block");
  problem.rigid("ground", ground(2));
  problem.contact("block_bottom", "ground");
  problem.on("block_top").displacement = {{0, expression("0")}, {1, expression("-0.4*t")}};
  problem.options.loading.increments = 8;
  problem.options.loading.fixed = true;
  const Record run = problem.converge();
  EXPECT_EQ(run.contact().n_active, 5);
}

/// The corners of the punch, at 0.45, come to the base's vertices at 0.5 as the base spreads.
TEST(Increments, DISABLED_CornerComesToAVertex)
{
  Problem problem = squeeze(8);
  problem.options.boundary.back().displacement[1] = expression("-0.3*t");
  const Record run = problem.converge();
  EXPECT_EQ(run.state().time, 1);
}

/// What cannot be: squeezed through the base. The last converged state is handed over with the cause.
TEST(Increments, FailureKeepsTheLastConvergedState)
{
  Problem problem = squeeze(4);
  problem.options.boundary.back().displacement[1] = expression("-2.5*t");
  problem.options.loading.min_increment = 0.02;
  const Record run = problem.solve();
  EXPECT_FALSE(run.result.converged);
  EXPECT_THAT(run.result.failure, HasSubstr("increment " + std::to_string(run.last.increment + 1) + " "));
  EXPECT_EQ(run.failure, run.result.failure);
  EXPECT_GT(run.last.increment, 0);
  EXPECT_EQ(run.last.time, run.state().time);
  EXPECT_EQ(run.last.displacement, run.state().displacement);
  EXPECT_EQ(run.last.contacts[0].force, run.contact().force);
  EXPECT_FALSE(run.attempts.back().converged);
  EXPECT_THAT(run.result.failure, HasSubstr(run.attempts.back().cause));
  EXPECT_LT(run.attempts.back().time_step, 0.04);
}
} // namespace
} // namespace amontons::test
