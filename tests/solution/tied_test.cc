#include "problem.h"

#include <gtest/gtest.h>

/// Bodies that are held together: bars in a row, whatever their meshes, gap and the sign of the force.
namespace amontons::test
{
namespace
{
constexpr double gap = 0.004, pull = 0.03, push = 0.02;

/// Two bars of height 1 without Poisson's effect, pulled to t = 1 and sheared to t = 2, with a gap between them.
Problem tied_bars(int dim, int refinement)
{
  Blocks blocks(dim);
  blocks.add("lower", {0, 0, 0}, dim == 2 ? Point(1, 1, 0) : Point(1, 1, 1),
             {3 * refinement, 2 * refinement, 2 * refinement});
  blocks.add("upper", dim == 2 ? Point(0, 1 + gap, 0) : Point(0, 0, 1 + gap),
             dim == 2 ? Point(1, 1, 0) : Point(1, 1, 1), {2 * refinement, 3 * refinement, 2 * refinement});
  Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional);
  problem.elastic("lower", 3, 0);
  problem.elastic("upper", 1, 0);
  problem.contact("upper_bottom", "lower_top").tied = true;
  for (int c = 0; c < dim; ++c)
    problem.on("lower_bottom").fix.push_back(c);
  BoundaryOptions &top = problem.on("upper_top");
  top.displacement[dim - 1] = expression(std::to_string(pull) + "*min(t,1)");
  top.displacement[0] = expression(std::to_string(push) + "*max(t-1,0)");
  if (dim == 3)
    top.displacement[1] = expression(0);
  problem.options.loading.end = 2;
  problem.options.loading.increments = 2;
  return problem;
}

TEST(Tied, BarsInARowTakeTension)
{
  for (const int dim : {2, 3})
  {
    std::vector<double> error;
    for (const int refinement : {1, 2, 4})
    {
      const Record run = tied_bars(dim, refinement).converge();
      ASSERT_EQ(run.states.size(), 3u);
      EXPECT_EQ(run.iterations(), (std::vector{1, 1})) << "the system is linear";
      EXPECT_TRUE(run.warnings.empty());
      // Nodes move apart by the bars' own strain alone: their compliances in a row.
      const double force = -pull / (1.0 / 3 + 1.0);
      error.push_back(std::abs(total_force(run.states[1].contacts[0])[dim - 1] / force - 1));
      EXPECT_NEAR(run.reaction("upper_top")[dim - 1], -total_force(run.contact())[dim - 1], 1e-12);
      EXPECT_NEAR(run.reaction("upper_top")[0], -total_force(run.contact())[0], 1e-12);
      EXPECT_GT(run.reaction("upper_top")[0], 0.1 * push);
    }
    // Nodes tied to faces that do not match pass a constant stress in the mean only: an error that goes with the cells.
    EXPECT_LT(error[1], 0.6 * error[0]);
    EXPECT_LT(error[2], 0.6 * error[1]);
    EXPECT_LT(error[2], 5e-3);
  }
}

/// With meshes that match, the tied bars are one bar.
TEST(Tied, MatchingMeshesAreOneBody)
{
  for (const Strain strain : {Strain::small, Strain::finite})
  {
    const auto bar = [&](bool tied)
    {
      Blocks blocks(2);
      blocks.add("lower", {0, 0, 0}, {1, tied ? 1. : 2., 0}, {3, tied ? 2 : 4, 0});
      if (tied)
        blocks.add("upper", {0, 1, 0}, {1, 1, 0}, {3, 2, 0});
      Problem problem(blocks, Kinematics::plane_strain, strain);
      problem.elastic("lower", 1, 0.3);
      if (tied)
      {
        problem.elastic("upper", 1, 0.3);
        problem.contact("upper_bottom", "lower_top").tied = true;
      }
      problem.on("lower_bottom").fix = {0, 1};
      BoundaryOptions &top = problem.on(tied ? "upper_top" : "lower_top");
      top.displacement = {{0, expression("0.1*t")}, {1, expression("0.2*t")}};
      problem.options.loading.increments = 4;
      problem.options.solver.tolerance = 1e-11;
      const Record run = problem.converge();
      return run.reaction(tied ? "upper_top" : "lower_top");
    };
    const Point tied = bar(true), whole = bar(false);
    EXPECT_LT((tied - whole).norm(), 1e-10 * whole.norm());
  }
}

/// Nodes beyond the target's end are not tied, and are not when it has come to lie below them.
TEST(Tied, WhatFindsNoTargetAtTheStartStaysFree)
{
  for (const Discretization discretization : {Discretization::node_to_face, Discretization::mortar})
  {
    Blocks blocks(2);
    blocks.add("lower", {0, 0, 0}, {1, 1, 0}, {5, 5, 0});
    blocks.add("upper", {0, 1, 0}, {2, 0.5, 0}, {7, 3, 0});
    Problem problem(blocks, Kinematics::plane_strain, Strain::finite);
    problem.elastic("lower", 0.1, 0.3);
    problem.elastic("upper", 1, 0.3);
    ContactOptions &contact = problem.contact("upper_bottom", "lower_top");
    contact.discretization = discretization;
    contact.tied = true;
    problem.on("lower_bottom").displacement = {{0, expression("0.6*t*x")}, {1, expression(0)}};
    problem.on("lower_right").displacement[0] = expression("0.6*t");
    problem.on("upper_top").fix = {0, 1};
    problem.options.loading.increments = 6;
    const Record run = problem.converge();
    EXPECT_GT(run.contact().n_active, 3);
    for (const SolutionState &state : run.states)
      if (state.increment > 0)
        EXPECT_EQ(state.contacts[0].n_active, run.states[1].contacts[0].n_active);
  }
}
} // namespace
} // namespace amontons::test
