#include "problem.h"

#include <gmock/gmock.h>

/// What the answer must not depend on: the units of the deck, and the augmentation parameter r.
namespace amontons::test
{
namespace
{
/// A block on a larger one, all lengths and stresses in the given units.
Problem block_on_block(Strain strain, double length, double stress)
{
  Blocks blocks(2);
  blocks.add("base", length * Point(-2, -1, 0), length * Point(4, 1, 0), {10, 3, 0});
  blocks.add("slider", length * Point(-0.81, 0, 0), length * Point(1.57, 1, 0), {7, 4, 0});
  Problem problem(blocks, Kinematics::plane_strain, strain);
  problem.elastic("base", stress, 0.3);
  problem.elastic("slider", 2 * stress, 0.2);
  problem.contact("slider_bottom", "base_top", 0.25);
  problem.on("base_bottom").fix = {0, 1};
  problem.options.loading.increments = 6;
  problem.options.loading.fixed = true;
  return problem;
}

Problem moved_slider(Strain strain, double length, double stress)
{
  Problem problem = block_on_block(strain, length, stress);
  BoundaryOptions &top = problem.on("slider_top");
  top.displacement = {
      {0, expression(std::to_string(length) + (strain == Strain::small ? "*0.03*max(2*t-1,0)" : "*0.05*max(2*t-1,0)"))},
      {1, expression(std::to_string(length) + "*-0.1*min(2*t,1)")}};
  return problem;
}

Problem loaded_slider(Strain strain, double length, double stress)
{
  Problem problem = block_on_block(strain, length, stress);
  BoundaryOptions &top = problem.on("slider_top");
  top.traction = {{0, expression(0.005 * stress)}, {1, expression(-0.05 * stress)}};
  for (auto &[component, load] : top.traction)
    load.text += component == 0 ? "*max(2*t-1,0)" : "*min(2*t,1)";
  return problem;
}

/// A slider with a rounded lower side: nodes close with friction all the while.
Problem rounded_slider(Strain strain, double length, double stress)
{
  Blocks blocks(2);
  blocks.add("base", length * Point(-2, -1, 0), length * Point(4, 1, 0), {20, 5, 0});
  blocks.add("slider", length * Point(-0.81, 0, 0), length * Point(1.57, 1, 0), {13, 5, 0},
             [=](const Point &x) { return Point(x[0], x[1] + (length - x[1]) * std::pow(x[0] / length, 2) / 8, 0); });
  Problem problem(blocks, Kinematics::plane_strain, strain);
  problem.elastic("base", stress, 0.3);
  problem.elastic("slider", 2 * stress, 0.2);
  problem.contact("slider_bottom", "base_top", 0.25);
  problem.on("base_bottom").fix = {0, 1};
  const std::string l = std::to_string(length);
  problem.on("slider_top").displacement = {{0, expression(l + "*(0.01*t+0.012*max(2*t-1,0))")},
                                           {1, expression(l + "*-0.08*min(2*t,1)")}};
  problem.options.loading.increments = 6;
  problem.options.loading.fixed = true;
  return problem;
}

using Maker = Problem (*)(Strain, double, double);

class Units : public testing::TestWithParam<std::tuple<Maker, Strain>>
{
};

TEST_P(Units, SameIterationsAndTheSameAnswerScaled)
{
  const auto [make, strain] = GetParam();
  const Record in_mm = make(strain, 10, 2.1e5).converge();
  for (const auto &[length, stress] : {std::pair{1e-3, 1e6}, std::pair{1e6, 1e-12}}) // m, Pa; nm, N/nm^2
  {
    const Record other = make(strain, 10 * length, 2.1e5 * stress).converge();
    // Where nodes close one by one, round-off may decide which of two iterations is the last.
    ASSERT_EQ(other.iterations().size(), in_mm.iterations().size());
    for (std::size_t k = 0; k < in_mm.iterations().size(); ++k)
      EXPECT_LE(std::abs(other.iterations()[k] - in_mm.iterations()[k]), make == &rounded_slider ? 1 : 0);
    ASSERT_EQ(other.states.size(), in_mm.states.size());
    std::vector<double> pressure = other.contact().pressure, traction = other.contact().traction,
                        displacement = other.state().displacement;
    for (double &p : pressure)
      p /= stress;
    for (double &q : traction)
      q /= stress;
    for (double &u : displacement)
      u /= length;
    EXPECT_LT(relative_difference(pressure, in_mm.contact().pressure), 1e-9);
    EXPECT_LT(relative_difference(traction, in_mm.contact().traction), 1e-9);
    EXPECT_LT(relative_difference(displacement, in_mm.state().displacement), 1e-9);
    EXPECT_EQ(other.contact().status, in_mm.contact().status);
  }
  EXPECT_GT(in_mm.contact().n_stick, 0);
  EXPECT_GT(in_mm.contact().n_slip, 0);
}

INSTANTIATE_TEST_SUITE_P(All, Units,
                         testing::Combine(testing::Values(&moved_slider, &loaded_slider, &rounded_slider),
                                          testing::Values(Strain::small, Strain::finite)));

Problem slider_in_space()
{
  Blocks blocks(3);
  blocks.add("base", {-1, -1, -0.6}, {2, 2, 0.6}, {4, 4, 1});
  blocks.add("slider", {-0.5, -0.55, 0}, {1.03, 1.04, 0.7}, {3, 3, 2});
  Problem problem(blocks, Kinematics::three_dimensional);
  problem.elastic("base");
  problem.elastic("slider", 2, 0.2);
  problem.contact("slider_bottom", "base_top", 0.3);
  problem.on("base_bottom").fix = {0, 1, 2};
  problem.on("slider_top").displacement = {
      {0, expression("0.02*max(2*t-1,0)")}, {1, expression("0.03*max(2*t-1,0)")}, {2, expression("-0.05*min(2*t,1)")}};
  problem.options.loading.increments = 4;
  return problem;
}

void expect_independence_of_augmentation(Problem problem, std::array<double, 2> factors = {1e-3, 1e3})
{
  problem.options.loading.fixed = true;
  problem.options.solver.tolerance = 1e-10;
  const Record usual = problem.converge();
  EXPECT_GT(usual.contact().n_stick, 0);
  EXPECT_GT(usual.contact().n_slip, 0);
  for (const double factor : factors)
  {
    problem.options.contact[0].augmentation = factor;
    const Record other = problem.converge();
    ASSERT_EQ(other.states.size(), usual.states.size());
    for (std::size_t k = 0; k < usual.states.size(); ++k)
    {
      const ContactResult &a = usual.states[k].contacts[0], &b = other.states[k].contacts[0];
      EXPECT_LT(relative_difference(a.force, b.force), 1e-8) << "factor " << factor << ", increment " << k;
      EXPECT_EQ(a.status, b.status) << "factor " << factor << ", increment " << k;
    }
  }
}

TEST(Augmentation, DoesNotChangeTheAnswerInThePlane)
{
  expect_independence_of_augmentation(moved_slider(Strain::small, 1, 1));
}

TEST(Augmentation, DoesNotChangeTheAnswerInFiniteStrain)
{
  expect_independence_of_augmentation(moved_slider(Strain::finite, 1, 1));
}

TEST(Augmentation, DoesNotChangeTheAnswerWhereNodesClose)
{
  expect_independence_of_augmentation(rounded_slider(Strain::small, 1, 1));
  // In finite strain Newton swings between statuses with 100 r and more.
  expect_independence_of_augmentation(rounded_slider(Strain::finite, 1, 1), {1e-3, 10});
}

TEST(Augmentation, DoesNotChangeTheAnswerInSpace)
{
  expect_independence_of_augmentation(slider_in_space());
}
} // namespace
} // namespace amontons::test
