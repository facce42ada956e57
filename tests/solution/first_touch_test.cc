#include "problem.h"

#include <gmock/gmock.h>

/// Bodies that contact alone holds, under force: they have to travel to where they touch.
namespace amontons::test
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;

/// Unit blocks over the ground, their lower side curved so that the middle (or the axis) is lowest.
Blocks barrel(double low, double left)
{
  Blocks blocks(2);
  blocks.add("body", {left, low, 0}, {1 - left, 1, 0}, {left < 0 ? 16 : 8, 8, 0},
             [=](const Point &x) { return Point(x[0], x[1] + 0.1 * x[0] * x[0] * (low + 1 - x[1]), 0); });
  return blocks;
}

Problem pressed(double gap, Kinematics kinematics, Strain strain, double mu)
{
  Problem problem(barrel(gap, kinematics == Kinematics::axisymmetric ? 0 : -1), kinematics, strain);
  problem.elastic("body");
  problem.rigid("ground", ground(2));
  problem.contact("body_bottom", "ground", mu);
  problem.on("body_top").traction[1] = expression("-0.01*t");
  return problem;
}

class FirstTouch : public testing::TestWithParam<std::tuple<Kinematics, Strain, double>>
{
};

/// Nothing holds the body but the contact it has to find: it carries the load, and without friction (which remembers
/// the way) bears it as a body that touched from the start does.
TEST_P(FirstTouch, BodyUnderTractionFindsTheGround)
{
  const auto [kinematics, strain, mu] = GetParam();
  const Record far = pressed(0.3, kinematics, strain, mu).converge();
  const Record near = pressed(0, kinematics, strain, mu).converge();
  const double load = kinematics == Kinematics::axisymmetric ? 0.01 * M_PI : 0.01 * 2;
  EXPECT_NEAR(total_force(far.contact())[1], load, 1e-7 * load);
  EXPECT_NEAR(total_force(near.contact())[1], load, 1e-7 * load);
  if (mu == 0)
    EXPECT_LT(relative_difference(far.contact().pressure, near.contact().pressure), 1e-6);
  for (std::size_t i = 0; i < far.contact().traction.size(); ++i)
    EXPECT_LE(std::abs(far.contact().traction[i]), mu * far.contact().pressure[i] * (1 + 1e-6));
  EXPECT_GT(far.contact().n_active, 2);
  EXPECT_EQ(far.attempts.size(), 1u) << "no increment had to be cut";
}

INSTANTIATE_TEST_SUITE_P(All, FirstTouch,
                         testing::Combine(testing::Values(Kinematics::plane_strain, Kinematics::axisymmetric),
                                          testing::Values(Strain::small, Strain::finite), testing::Values(0.0, 0.3)));

Problem rigid_on_block(Strain strain, double gap)
{
  Blocks blocks(2);
  blocks.add("block", {-1, 0, 0}, {2, 1, 0}, {12, 6, 0});
  blocks.add_line("punch", {{-0.5, 1.2 + gap, 0}, {-0.4, 1 + gap, 0}, {0.4, 1 + gap, 0}, {0.5, 1.2 + gap, 0}}, 2);
  Problem problem(blocks, Kinematics::plane_strain, strain);
  problem.elastic("block");
  problem.rigid("punch");
  problem.contact("block_top", "punch", 0.2);
  problem.on("block_bottom").fix = {0, 1};
  problem.on("punch").force[1] = expression("-0.02*t");
  return problem;
}

TEST(FirstTouch, RigidBodyUnderForceFindsTheBlock)
{
  for (const Strain strain : {Strain::small, Strain::finite})
  {
    const Record run = rigid_on_block(strain, 0.1).converge();
    EXPECT_NEAR(total_force(run.contact())[1], -0.02, 1e-8 * 0.02);
    EXPECT_NEAR(run.reaction("block_bottom")[1], 0.02, 1e-8 * 0.02);
    EXPECT_EQ(run.attempts.size(), 1u);
  }
}

/// A body on springs over the ground: nothing touches, the springs carry all.
TEST(FirstTouch, EverythingStaysOpen)
{
  Problem problem(barrel(0.5, -1), Kinematics::plane_strain);
  problem.elastic("body");
  problem.rigid("ground", ground(2));
  problem.contact("body_bottom", "ground", 0.2);
  problem.on("body_top").spring = {{0, expression(0.1)}, {1, expression(0.1)}};
  problem.on("body_top").traction[1] = expression("-0.01*t");
  const Record run = problem.converge();
  EXPECT_EQ(run.contact().n_active, 0);
  EXPECT_EQ(total_force(run.contact()).norm(), 0);
  const Index middle = run.node_at({0, 1.5, 0});
  EXPECT_NEAR(run.displacement(middle)[1], -0.1, 1e-9);
  EXPECT_NEAR(run.contact().min_gap, 0.4, 1e-9);
}

Problem block_on_ground(double push)
{
  Blocks blocks(2);
  blocks.add("body", {0, 0, 0}, {1, 1, 0}, {4, 4, 0});
  Problem problem(blocks, Kinematics::plane_strain);
  problem.elastic("body");
  problem.rigid("ground", ground(2));
  problem.contact("body_bottom", "ground");
  problem.on("body_top").traction[1] = expression(-0.01);
  if (push != 0)
    problem.on("body_left").traction[0] = expression(std::to_string(push) + "*max(t-0.5,0)");
  problem.options.loading.increments = 4;
  return problem;
}

/// Without friction or load nothing decides where the block stands: it stays in the mean where it was.
TEST(FreeSliding, UnloadedMotionIsHeldInTheMean)
{
  const Record run = block_on_ground(0).converge();
  EXPECT_NEAR(total_force(run.contact())[1], 0.01, 1e-10);
  EXPECT_NEAR(total_force(run.contact())[0], 0, 1e-14);
  double mean = 0, largest = 0;
  for (Index node = 0; node < run.mesh.n_nodes(); ++node)
  {
    mean += run.displacement(node)[0] / run.mesh.n_nodes();
    largest = std::max(largest, std::abs(run.displacement(node)[0]));
  }
  EXPECT_GT(largest, 1e-4) << "the block widens under its load";
  EXPECT_NEAR(mean, 0, 1e-12);
}

/// A horizontal load that comes later cannot be held: the run ends there, names the body, and keeps what converged.
TEST(FreeSliding, LoadedMotionEndsTheRunAndNamesTheBody)
{
  const Record run = block_on_ground(0.01).solve();
  EXPECT_FALSE(run.result.converged);
  EXPECT_THAT(run.result.failure, AllOf(HasSubstr("'body'"), HasSubstr("moves freely"), HasSubstr("along x")));
  EXPECT_EQ(run.failure, run.result.failure);
  EXPECT_GE(run.last.time, 0.5);
  EXPECT_LT(run.last.time, 0.51);
  EXPECT_NEAR(total_force(run.last.contacts[0])[1], 0.01, 1e-10);
}

TEST(FreeSliding, BodyPulledOffEndsTheRunAndNamesTheBody)
{
  Problem problem = block_on_ground(0);
  problem.options.boundary.back().traction[1] = expression("0.01*(t-0.6)");
  const Record run = problem.solve();
  EXPECT_FALSE(run.result.converged);
  EXPECT_THAT(run.result.failure, AllOf(HasSubstr("'body'"), HasSubstr("moves freely"), HasSubstr("along y")));
  EXPECT_NEAR(run.last.time, 0.6, 0.01);
}

TEST(Restraint, BodyThatNothingRestrainsIsAnErrorAtItsPlace)
{
  Blocks blocks(2);
  blocks.add("body", {0, 0, 0}, {1, 1, 0}, {2, 2, 0});
  blocks.add("stray", {3, 0, 0}, {1, 1, 0}, {2, 2, 0});
  Problem problem(blocks, Kinematics::plane_strain);
  problem.elastic("body");
  problem.elastic("stray");
  problem.rigid("ground", ground(2));
  problem.contact("body_bottom", "ground");
  problem.on("stray_bottom").fix = {1};
  EXPECT_EQ(message_of([&] { (void)problem.solve(); }),
            "deck.yaml:11:5: body 'stray' can move freely (translation along x): neither a support nor any of its "
            "contacts holds it");
  EXPECT_EQ(message_of([&] { check_problem(problem.options); }), message_of([&] { (void)problem.solve(); }));
  problem.options.boundary.back().fix = {0, 1};
  EXPECT_EQ(message_of([&] { check_problem(problem.options); }), "no error");
}

/// A contact restrains two bodies against each other, not both against the world.
TEST(Restraint, TwoBodiesThatOnlyHoldEachOtherAreAnError)
{
  Blocks blocks(2);
  blocks.add("lower", {0, 0, 0}, {1, 1, 0}, {2, 2, 0});
  blocks.add("upper", {0, 1, 0}, {1, 1, 0}, {2, 2, 0});
  Problem problem(blocks, Kinematics::plane_strain);
  problem.elastic("lower");
  problem.elastic("upper");
  problem.contact("upper_bottom", "lower_top", 0.3);
  EXPECT_THAT(message_of([&] { check_problem(problem.options); }), HasSubstr("can move freely"));
}
} // namespace
} // namespace amontons::test
