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
  problem.options.solver.multipliers =
      linear == LinearSolverType::feti ? MultiplierForm::condensed : MultiplierForm::coupled;
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
  // Linear solves that stop early cost Newton some iterations.
  for (std::size_t k = 0; k < direct.iterations().size(); ++k)
    EXPECT_LE(feti.iterations()[k], 2 * direct.iterations()[k] + 2);
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
    {
      Problem problem = two_blocks(2, mu, kinematics, 20);
      problem.options.loading.increments = 1;
      expect_same(problem);
    }
}

TEST(Feti, Blocks)
{
  for (const double mu : {0.0, 0.3})
    expect_same(two_blocks(3, mu, Kinematics::three_dimensional, 6));
}

TEST(Feti, SurfaceToSurface)
{
  for (const bool swapped : {false, true})
    for (const auto &[dim, n] : {std::pair{2, 20}, {3, 5}})
    {
      Problem problem = two_blocks(dim, 0.3, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional, n);
      ContactOptions &contact = problem.options.contact[0];
      contact.discretization = Discretization::mortar;
      if (swapped)
        std::swap(contact.impactor, contact.target);
      expect_same(problem);
    }
}

/// Contact alone holds the body, which has to travel to where it touches; motions without load are held in the mean.
TEST(Feti, BodyThatTravelsToWhereItTouches)
{
  for (const Kinematics kinematics : {Kinematics::plane_strain, Kinematics::axisymmetric})
    for (const double mu : {0.0, 0.3})
    {
      const bool axisymmetric = kinematics == Kinematics::axisymmetric;
      Blocks blocks(2);
      blocks.add("body", {axisymmetric ? 0. : -1., 0.3, 0}, {axisymmetric ? 1. : 2., 1, 0},
                 {axisymmetric ? 15 : 30, 15, 0},
                 [](const Point &x) { return Point(x[0], x[1] + 0.1 * x[0] * x[0] * (1.3 - x[1]), 0); });
      Problem problem(blocks, kinematics);
      problem.elastic("body");
      problem.rigid("ground", ground(2));
      problem.contact("body_bottom", "ground", mu);
      problem.on("body_top").traction[1] = expression("-0.01*t");
      expect_same(problem);
    }
}

/// A rigid body under force: its unknowns are those of a subdomain without stiffness.
TEST(Feti, RigidBodyUnderForce)
{
  Blocks blocks(2);
  blocks.add("block", {-1, 0, 0}, {2, 1, 0}, {40, 20, 0});
  blocks.add_line("punch", {{-0.5, 1.3, 0}, {-0.4, 1.1, 0}, {0.4, 1.1, 0}, {0.5, 1.3, 0}}, 2);
  Problem problem(blocks, Kinematics::plane_strain);
  problem.elastic("block");
  problem.rigid("punch");
  problem.contact("block_top", "punch", 0.2);
  problem.on("block_bottom").fix = {0, 1};
  problem.on("punch").force[1] = expression("-0.02*t");
  expect_same(problem);
}

TEST(Feti, IsRefusedInFiniteStrain)
{
  Blocks blocks(2);
  blocks.add("body", {0, 0, 0}, {1, 1, 0}, {2, 2, 0});
  Problem problem(blocks, Kinematics::plane_strain, Strain::finite);
  problem.elastic("body");
  problem.on("body_bottom").fix = {0, 1};
  problem.options.solver.linear = LinearSolverType::feti;
  problem.options.solver.multipliers = MultiplierForm::condensed;
  EXPECT_THROW((void)problem.solve(), UserError);
}
} // namespace
} // namespace amontons::test
