#include "problem.h"

#include <gtest/gtest.h>

/// Coupled and condensed, factorised and iterated: the same forces and statuses, after as many iterations.
namespace amontons::test
{
namespace
{
constexpr double down = 0.02;

std::vector<int> all(int dim)
{
  return dim == 2 ? std::vector{0, 1} : std::vector{0, 1, 2};
}

/// A block pressed on a larger one and pushed along it; meshes that do not match.
Problem blocks_in_contact(int dim, Strain strain, double mu)
{
  const auto high = [d = dim](double x, double y, double z) { return d == 2 ? Point(x, z, 0) : Point(x, y, z); };
  Blocks blocks(dim);
  const int across = dim == 2 ? 2 : 5;
  blocks.add("base", high(-1.5, -1.5, -1), high(3, 3, 1), {dim == 2 ? 9 : 5, across, 2});
  blocks.add("slider", high(-0.5, -0.5, 0), high(0.9, 1.1, 0.6), {dim == 2 ? 5 : 3, dim == 2 ? 2 : 3, 2});
  Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional, strain);
  problem.elastic("base");
  problem.elastic("slider", 3, 0.3);
  problem.contact("slider_bottom", "base_top", mu);
  problem.on("base_bottom").fix = all(dim);
  BoundaryOptions &top = problem.on("slider_top");
  top.displacement = {{0, expression("0.08*t")}, {dim - 1, expression("-0.05*t")}};
  if (dim == 3)
    top.displacement[1] = expression("0.03*t");
  problem.options.loading.increments = 2;
  return problem;
}

/// The same, surface to surface; `swapped`: the impactor is the larger one, its faces covered in part.
Problem blocks_in_mortar_contact(int dim, double mu, bool swapped)
{
  Problem problem = blocks_in_contact(dim, Strain::small, mu);
  ContactOptions &contact = problem.options.contact[0];
  contact.discretization = Discretization::mortar;
  if (swapped)
    std::swap(contact.impactor, contact.target);
  return problem;
}

/// Held by contact alone at first, so motions are held in the mean; under force, with friction.
Problem block_on_ground(Kinematics kinematics, double mu)
{
  Blocks blocks(2);
  blocks.add("block", {0, 0.01, 0}, {1, 1, 0}, {5, 4, 0});
  Problem problem(blocks, kinematics);
  problem.elastic("block");
  problem.rigid("ground", ground(2));
  problem.contact("block_bottom", "ground", mu);
  problem.on("block_top").traction[1] = expression(-down);
  return problem;
}

/// A corner node that is the impactor of two contacts.
Problem block_in_groove()
{
  Blocks blocks(2);
  blocks.add("body", {0, 0, 0}, {1, 1, 0}, {4, 4, 0});
  blocks.add_line("floor", {{2, 0, 0}, {-0.5, 0, 0}}, 3);
  blocks.add_line("wall", {{0, -0.5, 0}, {0, 2, 0}}, 3);
  Problem problem(blocks, Kinematics::plane_strain, Strain::finite);
  problem.elastic("body");
  problem.rigid("floor");
  problem.rigid("wall");
  problem.contact("body_bottom", "floor", 0.3);
  problem.contact("body_left", "wall", 0.3);
  problem.on("body_top").traction[1] = expression(-down);
  problem.on("body_right").traction[0] = expression(-down / 2);
  return problem;
}

/// The rigid punch's nodes are the impactors: their rows are resolved over the target's unknowns.
Problem rigid_impactor()
{
  Blocks blocks(2);
  blocks.add("block", {-1, 0, 0}, {2, 1, 0}, {16, 6, 0});
  blocks.add_line("punch", {{-0.33, 1.01, 0}, {0.33, 1.01, 0}}, 3);
  Problem problem(blocks, Kinematics::plane_strain);
  problem.elastic("block");
  problem.rigid("punch");
  problem.contact("punch", "block_top", 0.2);
  problem.on("block_bottom").fix = {0, 1};
  problem.on("punch").force[1] = expression(-down);
  return problem;
}

/// Four plates, each one cell thick: nodes on the plates' rims and faces are impactors of one contact and targets of
/// the next, in a chain over all plates.
Problem stack_of_plates()
{
  Blocks blocks(2);
  for (int k = 0; k < 4; ++k)
    blocks.add("plate" + std::to_string(k), {0, 0.1 * k, 0}, {1, 0.1, 0}, {5 + k, 1, 0});
  Problem problem(blocks, Kinematics::plane_strain);
  for (int k = 0; k < 4; ++k)
    problem.elastic("plate" + std::to_string(k));
  for (int k = 1; k < 4; ++k)
    problem.contact("plate" + std::to_string(k) + "_bottom", "plate" + std::to_string(k - 1) + "_top", 0.5);
  problem.contact("plate1_left", "plate0_top", 0);
  problem.on("plate0_bottom").fix = {0, 1};
  problem.on("plate3_top").displacement = {{0, expression("0.001*t")}, {1, expression("-0.02*t")}};
  return problem;
}

struct Case
{
  std::string name;
  std::function<Problem()> make;
};

class Forms : public testing::TestWithParam<Case>
{
protected:
  static Record solve(LinearSolverType linear, MultiplierForm multipliers)
  {
    Problem problem = GetParam().make();
    problem.options.solver.linear = linear;
    problem.options.solver.multipliers = multipliers;
    problem.options.solver.tolerance = 1e-10;
    return problem.converge();
  }
  static void expect_same(const Record &a, const Record &b)
  {
    ASSERT_EQ(a.states.size(), b.states.size());
    for (std::size_t c = 0; c < a.state().contacts.size(); ++c)
    {
      const ContactResult &x = a.state().contacts[c], &y = b.state().contacts[c];
      EXPECT_LT((total_force(x) - total_force(y)).norm(), 1e-8 * total_force(x).norm() + 1e-12);
      EXPECT_EQ(x.status, y.status);
      EXPECT_LT(relative_difference(x.pressure, y.pressure), 1e-7);
    }
    EXPECT_LT(relative_difference(a.state().displacement, b.state().displacement), 1e-8);
  }
};

TEST_P(Forms, SameForcesAndStatuses)
{
  const Record coupled = solve(LinearSolverType::direct, MultiplierForm::coupled);
  const Record condensed = solve(LinearSolverType::direct, MultiplierForm::condensed);
  expect_same(coupled, condensed);
  EXPECT_EQ(coupled.iterations(), condensed.iterations());
  expect_same(coupled, solve(LinearSolverType::amg, MultiplierForm::condensed));
}

INSTANTIATE_TEST_SUITE_P(
    All, Forms,
    testing::Values(Case{"plane", [] { return blocks_in_contact(2, Strain::small, 0); }},
                    Case{"plane_friction", [] { return blocks_in_contact(2, Strain::small, 0.3); }},
                    Case{"plane_finite", [] { return blocks_in_contact(2, Strain::finite, 0.3); }},
                    Case{"solid", [] { return blocks_in_contact(3, Strain::small, 0); }},
                    Case{"solid_friction", [] { return blocks_in_contact(3, Strain::small, 0.3); }},
                    Case{"solid_finite", [] { return blocks_in_contact(3, Strain::finite, 0.2); }},
                    Case{"held_motions", [] { return block_on_ground(Kinematics::plane_stress, 0); }},
                    Case{"axisymmetric", [] { return block_on_ground(Kinematics::axisymmetric, 0.2); }},
                    Case{"plane_mortar", [] { return blocks_in_mortar_contact(2, 0.3, false); }},
                    Case{"plane_mortar_swapped", [] { return blocks_in_mortar_contact(2, 0, true); }},
                    Case{"solid_mortar", [] { return blocks_in_mortar_contact(3, 0.3, false); }},
                    Case{"solid_mortar_swapped", [] { return blocks_in_mortar_contact(3, 0.3, true); }},
                    Case{"rigid_impactor_mortar",
                         []
                         {
                           Problem problem = rigid_impactor();
                           problem.options.contact[0].discretization = Discretization::mortar;
                           return problem;
                         }},
                    Case{"groove", block_in_groove}, Case{"rigid_impactor", rigid_impactor},
                    Case{"plates", stack_of_plates}),
    [](const auto &info) { return info.param.name; });

TEST(FormChoice, CoupledAsksForAFactorisation)
{
  for (const LinearSolverType linear : {LinearSolverType::amg, LinearSolverType::feti})
  {
    Problem problem = block_on_ground(Kinematics::plane_strain, 0);
    problem.options.solver.linear = linear;
    problem.options.solver.multipliers = MultiplierForm::coupled;
    EXPECT_THROW((void)problem.solve(), UserError);
  }
}
} // namespace
} // namespace amontons::test
