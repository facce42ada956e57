#include "problem.h"

#include <gtest/gtest.h>

/// The end of Newton's method in finite strain is quadratic, with contact and friction.
namespace amontons::test
{
namespace
{
/// Once the statuses have settled, each residual is of the order of the square of the one before.
void expect_quadratic_end(const Attempt &attempt)
{
  constexpr double round_off = 1e-12, factor = 100;
  const auto &iterations = attempt.iterations;
  std::size_t settled = iterations.size();
  while (settled > 0 && iterations[settled - 1].n_status_changes == 0 && iterations[settled - 1].step_length == 1)
    --settled;
  std::string residuals;
  int n_small = 0;
  for (std::size_t k = settled + 1; k < iterations.size(); ++k)
  {
    const double before = iterations[k - 1].residual, now = iterations[k].residual;
    residuals += std::to_string(std::log10(before)) + " -> " + std::to_string(std::log10(now)) + "; ";
    if (before < 1e-2)
      EXPECT_LE(now, factor * before * before + round_off) << "t = " << attempt.time << ", iteration " << k + 1;
    n_small += before < 1e-4 && before > 10 * round_off;
  }
  EXPECT_GT(n_small, 0) << "t = " << attempt.time << ": " << residuals;
}

class QuadraticEnd : public testing::TestWithParam<std::tuple<int, double>>
{
};

TEST_P(QuadraticEnd, InFiniteStrain)
{
  const auto [dim, mu] = GetParam();
  const auto high = [d = dim](double x, double y, double z) { return d == 2 ? Point(x, z, 0) : Point(x, y, z); };
  Blocks blocks(dim);
  const int n = dim == 2 ? 9 : 4, across = dim == 2 ? 3 : 4;
  blocks.add("base", high(-1.5, -1.5, -1), high(3, 3, 1), {n, across, 2});
  blocks.add("slider", high(-0.5, -0.5, 0), high(0.9, 1.1, 0.6), {dim == 2 ? 5 : 2, 2, 2});
  Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional, Strain::finite);
  problem.elastic("base");
  problem.elastic("slider", 3, 0.3);
  problem.contact("slider_bottom", "base_top", mu);
  problem.on("base_bottom").fix = dim == 2 ? std::vector{0, 1} : std::vector{0, 1, 2};
  BoundaryOptions &top = problem.on("slider_top");
  top.displacement = {{0, expression("0.3*max(2*t-1,0)")}, {dim - 1, expression("-0.15*min(2*t,1)")}};
  if (dim == 3)
    top.displacement[1] = expression("0.1*max(2*t-1,0)");
  problem.options.loading.increments = 4;
  problem.options.solver.tolerance = 1e-11;
  const Record run = problem.converge();
  for (const Attempt &attempt : run.attempts)
    expect_quadratic_end(attempt);
  if (mu > 0)
    EXPECT_GT(run.contact().n_slip, 0);
}

INSTANTIATE_TEST_SUITE_P(All, QuadraticEnd, testing::Combine(testing::Values(2, 3), testing::Values(0.0, 0.3)));
} // namespace
} // namespace amontons::test
