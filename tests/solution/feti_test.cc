#include "problem.h"

#include <gtest/gtest.h>

/// Total FETI against the direct solution of the coupled form.
namespace amontons::test
{
namespace
{
Record solve_by(Problem problem, LinearSolverType linear)
{
  problem.options.solver.linear = linear;
  return problem.converge();
}

void expect_same(const Problem &problem)
{
  const Record feti = solve_by(problem, LinearSolverType::feti), direct = solve_by(problem, LinearSolverType::direct);
  ASSERT_EQ(feti.states.size(), direct.states.size());
  EXPECT_LT(relative_difference(feti.state().displacement, direct.state().displacement), 1e-8);
  for (std::size_t c = 0; c < feti.state().contacts.size(); ++c)
  {
    EXPECT_LT(relative_difference(feti.contact(c).force, direct.contact(c).force), 1e-8);
    EXPECT_EQ(feti.contact(c).status, direct.contact(c).status);
  }
  EXPECT_EQ(feti.iterations(), direct.iterations());
}

/// Two blocks that do not match, pressed and pushed.
Problem two_blocks(int dim, double mu, Kinematics kinematics, int n)
{
  Blocks blocks(dim);
  blocks.add("lower", {0, 0, 0}, {2, dim == 3 ? 2. : 1., 1}, {2 * n, dim == 3 ? 2 * n : n, n});
  const double top = 1;
  const auto curved = [=](const Point &x)
  {
    Point out = x;
    const double r2 = std::pow(x[0] - 0.9, 2) + (dim == 3 ? std::pow(x[1] - 0.9, 2) : 0.0);
    out[dim - 1] += r2 / 16 * (top + 0.8 - x[dim - 1]) / 0.8;
    return out;
  };
  Point low(0.1, 0.1, 0), size(1.6, 1.6, 0.8);
  low[dim - 1] = top;
  size[dim - 1] = 0.8;
  const int m = 2 * n - 1;
  blocks.add("upper", low, size, {m, dim == 3 ? m : n, n}, curved);
  Problem problem(blocks, kinematics);
  problem.elastic("lower", 1, 0.3);
  problem.elastic("upper", 2, 0.25);
  problem.contact("upper_bottom", "lower_top", mu);
  std::vector<int> all = dim == 3 ? std::vector<int>{0, 1, 2} : std::vector<int>{0, 1};
  problem.on("lower_bottom").fix = all;
  BoundaryOptions &top_entry = problem.on("upper_top");
  for (const int c : all)
    top_entry.displacement[c] = expression(c == dim - 1 ? "-0.02*t" : c == 0 && mu > 0 ? "0.005*t" : "0");
  problem.options.loading.increments = 2;
  return problem;
}

TEST(Feti, PlaneBlocks)
{
  for (const double mu : {0.0, 0.3})
    for (const Kinematics kinematics : {Kinematics::plane_strain, Kinematics::plane_stress})
      expect_same(two_blocks(2, mu, kinematics, 20));
}

TEST(Feti, Blocks)
{
  for (const double mu : {0.0, 0.3})
    expect_same(two_blocks(3, mu, Kinematics::three_dimensional, 6));
}
} // namespace
} // namespace amontons::test
