#include "amontons/solution/form_choice.h"
#include "curved_slider.h"

#include <gtest/gtest.h>

#include <numeric>

/// What the counters of a run prove: nothing is rebuilt that has not changed.
namespace amontons::test
{
namespace
{
constexpr int n_increments = 4;

/// A block with a curved foot on a larger one, pressed and pushed: contact grows; small strain, linear.
Problem pushed_block(int dim, int n, double mu)
{
  Problem problem = curved_slider(dim, n, mu);
  BoundaryOptions &top = problem.on("slider_top");
  top.displacement = {{0, expression("0.002*t")}, {dim - 1, expression("-0.02*t^2")}};
  if (dim == 3)
    top.displacement[1] = expression("0");
  problem.options.loading.increments = n_increments;
  return problem;
}

Record solve_by(Problem problem, LinearSolverType linear, MultiplierForm multipliers = MultiplierForm::condensed)
{
  problem.options.solver.linear = linear;
  problem.options.solver.multipliers = multipliers;
  return problem.converge();
}

int sum_of_iterations(const Record &run)
{
  const std::vector<int> of_increments = run.iterations();
  return std::accumulate(of_increments.begin(), of_increments.end(), 0);
}

/// Statuses changed in an iteration.
int n_changes(const Record &run)
{
  int sum = 0;
  for (const Attempt &attempt : run.attempts)
    for (const IterationReport &iteration : attempt.iterations)
      sum += iteration.n_status_changes > 0;
  return sum;
}

/// In small strain contact elements stay, so there is one detection and one pattern, whatever statuses do.
void expect_bodies_built_once(const Record &run)
{
  EXPECT_EQ(run.attempts.size(), static_cast<std::size_t>(n_increments));
  EXPECT_GT(n_changes(run), 0);
  EXPECT_EQ(run.counters.n_bulk_assemblies, 1);
  EXPECT_EQ(run.counters.n_detections, 1);
  EXPECT_EQ(run.counters.n_pattern_builds, 1);
  EXPECT_EQ(run.counters.n_newton_iterations, sum_of_iterations(run));
}

TEST(Counters, BodiesAndPatternsAreBuiltOnceInSmallStrain)
{
  for (const int dim : {2, 3})
    for (const double mu : {0.0, 0.3})
    {
      const Problem problem = pushed_block(dim, dim == 2 ? 16 : 5, mu);
      expect_bodies_built_once(solve_by(problem, LinearSolverType::direct, MultiplierForm::coupled));
      expect_bodies_built_once(solve_by(problem, LinearSolverType::direct));
      expect_bodies_built_once(solve_by(problem, LinearSolverType::amg));
      expect_bodies_built_once(solve_by(problem, LinearSolverType::feti));
    }
}

TEST(Counters, FetiFactorisesEachSubdomainOnce)
{
  for (const int dim : {2, 3})
  {
    const Problem problem = pushed_block(dim, dim == 2 ? 32 : 6, 0.3);
    const Record run = solve_by(problem, LinearSolverType::feti);
    ProblemOptions options = problem.options;
    options.solver.linear = LinearSolverType::feti;
    const std::vector<Index> subdomain = make_partition(options, run.mesh, 1);
    const Index n_subdomains = 1 + *std::max_element(subdomain.begin(), subdomain.end());
    EXPECT_GT(n_subdomains, 3);
    EXPECT_EQ(run.counters.n_factorizations, n_subdomains);
    // Rows change with statuses; an iteration without such a change keeps the coarse matrix.
    EXPECT_LT(run.counters.n_preconditioner_setups, run.counters.n_newton_iterations);
    EXPECT_EQ(run.counters.n_pattern_builds, 1);
  }
}

TEST(Counters, MultigridIsSetUpLessOftenThanItIsUsed)
{
  const Record run = solve_by(pushed_block(3, 5, 0.3), LinearSolverType::amg);
  EXPECT_GE(run.counters.n_preconditioner_setups, 1);
  EXPECT_LE(2 * run.counters.n_preconditioner_setups, run.counters.n_newton_iterations);
  EXPECT_EQ(run.counters.n_factorizations, 0);
}

TEST(Counters, FactorisationIsKeptWhileStatusesStand)
{
  Blocks blocks(2);
  blocks.add("base", {0, -1, 0}, {2, 1, 0}, {8, 4, 0});
  blocks.add("slider", {0.5, 0, 0}, {1, 1, 0}, {5, 5, 0});
  Problem problem(blocks, Kinematics::plane_strain);
  problem.elastic("base");
  problem.elastic("slider");
  problem.contact("slider_bottom", "base_top");
  problem.on("base_bottom").fix = {0, 1};
  problem.on("slider_top").displacement = {{0, expression("0.01*t^2")}, {1, expression("-0.02*t")}};
  problem.options.loading.increments = n_increments;
  const Record run = solve_by(problem, LinearSolverType::direct);
  EXPECT_EQ(n_changes(run), 0);
  EXPECT_GT(run.counters.n_newton_iterations, 1);
  EXPECT_EQ(run.counters.n_factorizations, 1);
}

/// All nodes of the slider cross an edge of the base in the same increment, twice in all.
TEST(Counters, PatternIsBuiltOncePerDetectionThatChangedThePairing)
{
  Blocks blocks(2);
  blocks.add("base", {0, -1, 0}, {3, 1, 0}, {12, 4, 0});
  blocks.add("slider", {0.875, 0, 0}, {0.75, 0.5, 0}, {3, 2, 0});
  Problem problem(blocks, Kinematics::plane_strain, Strain::finite);
  problem.elastic("base");
  problem.elastic("slider");
  problem.contact("slider_bottom", "base_top");
  problem.on("base_bottom").fix = {0, 1};
  problem.on("slider_top").displacement = {{0, expression("0.5*t")}, {1, expression("-1e-3*t")}};
  problem.options.loading.increments = 10;
  for (const MultiplierForm form : {MultiplierForm::coupled, MultiplierForm::condensed})
  {
    const Record run = solve_by(problem, LinearSolverType::direct, form);
    EXPECT_EQ(run.attempts.size(), 10U);
    EXPECT_GT(run.counters.n_detections, 10);
    EXPECT_EQ(run.counters.n_pattern_builds, 3);
  }
}
} // namespace
} // namespace amontons::test
