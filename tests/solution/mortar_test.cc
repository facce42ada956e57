#include "solvers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

/// Surface-to-surface contact: curved bodies, bodies that only contact holds, overlaps, and where it is refused.
namespace amontons::test
{
namespace
{
/// Contact alone holds the block, on rigid faces that do not match its own: it travels there and bears what presses it.
TEST(Mortar, BodyThatTravelsToWhereItTouches)
{
  Blocks blocks(2);
  blocks.add("block", {0, 0.01, 0}, {1, 1, 0}, {5, 4, 0});
  blocks.add_line("floor", {{2, 0, 0}, {-1, 0, 0}}, 7);
  for (const bool swapped : {false, true})
  {
    Problem problem(blocks, Kinematics::plane_strain);
    problem.elastic("block");
    problem.rigid("floor");
    problem.contact(swapped ? "floor" : "block_bottom", swapped ? "block_bottom" : "floor").discretization =
        Discretization::mortar;
    problem.on("block_top").traction[1] = expression(-0.02);
    for (const Solver &solver : all_solvers)
    {
      const Record run = solve_by(problem, solver);
      for (std::size_t i = 0; i < run.impactor_nodes[0].size(); ++i)
        if (run.contact().status[i] != ContactStatus::open)
        {
          EXPECT_NEAR(run.contact().pressure[i], 0.02, 1e-8 * 0.02);
          EXPECT_NEAR(run.contact().gap[i], 0, 1e-12);
        }
      EXPECT_NEAR(run.contact().contact_area, 1, 1e-9);
    }
  }
}

/// Meshes that overlap at the start: taken as touching, or pushed apart.
TEST(Mortar, InitialOverlap)
{
  Blocks blocks(2);
  blocks.add("lower", {0, 0, 0}, {1, 1, 0}, {3, 3, 0});
  blocks.add("upper", {0, 0.99, 0}, {1, 1, 0}, {4, 3, 0});
  for (const bool adjust : {false, true})
  {
    Problem problem(blocks, Kinematics::plane_strain);
    problem.elastic("lower", 1, 0);
    problem.elastic("upper", 1, 0);
    ContactOptions &contact = problem.contact("upper_bottom", "lower_top");
    contact.discretization = Discretization::mortar;
    contact.initial_overlap = adjust ? InitialOverlap::adjust : InitialOverlap::resolve;
    problem.on("lower_bottom").fix = {0, 1};
    problem.on("upper_top").fix = {0, 1};
    const Record run = problem.converge();
    for (const double pressure : run.contact().pressure)
      EXPECT_NEAR(pressure, adjust ? 0 : 0.005, 1e-10);
    ASSERT_EQ(run.warnings.size(), 1u);
    EXPECT_NE(run.warnings[0].find("5 nodes lie inside the target at the start, deepest -0.01"), std::string::npos);
  }
}

/// An elastic cylinder on an elastic block, 16 cells on the half-width of the contact against the block's 24, where
/// nodes against faces are at their worst: pressures within 0.5 % of Hertz (Johnson 1985, eq. 4.43 to 4.45), without a
/// ripple.
TEST(Mortar, HertzCylinder)
{
  std::ostringstream geometry;
  geometry << std::ifstream(std::filesystem::path(__FILE__).parent_path() /
                            "../../examples/hertz-cylinder/hertz-cylinder.geo")
                  .rdbuf();
  std::map<Discretization, double> worst;
  for (const Discretization discretization : {Discretization::node_to_face, Discretization::mortar})
  {
    Problem problem(geometry.str(), Kinematics::plane_strain);
    problem.options.mesh.parameters = {{"n_cylinder", 16}, {"n_block", 24}};
    problem.elastic("cylinder", 1, 0.3);
    problem.elastic("block", 2, 0.25);
    problem.contact("cylinder_bottom", "block_top").discretization = discretization;
    problem.on("symmetry").fix = {0};
    problem.on("block_bottom").fix = {0, 1};
    problem.on("mid_plane").displacement[1] = expression("-9.4e-4*t");
    const Record run = problem.converge();
    const double stiffness = 1 / ((1 - 0.09) / 1 + (1 - 0.0625) / 2), force = 2 * run.contact().normal_force[1];
    const double peak = std::sqrt(force * stiffness / std::numbers::pi);
    const double width = std::sqrt(4 * force / (std::numbers::pi * stiffness));
    for (std::size_t i = 0; i < run.impactor_nodes[0].size(); ++i)
    {
      const double x = run.place(static_cast<Index>(run.impactor_nodes[0][i]))[0] / width;
      if (x < 0.85)
        worst[discretization] =
            std::max(worst[discretization], std::abs(run.contact().pressure[i] / peak - std::sqrt(1 - x * x)));
    }
  }
  EXPECT_LT(worst[Discretization::mortar], 5e-3);
  EXPECT_LT(worst[Discretization::mortar], 0.1 * worst[Discretization::node_to_face]);
}

TEST(Mortar, IsRefusedWhereItHasNoMeaning)
{
  Blocks blocks(2);
  blocks.add("body", {0, 0, 0}, {1, 1, 0}, {2, 2, 0});
  const auto refused = [&](Strain strain, const std::string &target, const std::string &why)
  {
    Problem problem(blocks, Kinematics::plane_strain, strain);
    problem.elastic("body");
    problem.rigid("ground", ground(2));
    problem.contact("body_bottom", target).discretization = Discretization::mortar;
    problem.on("body_top").fix = {0, 1};
    EXPECT_THAT([&] { (void)problem.solve(); }, testing::ThrowsMessage<UserError>(testing::HasSubstr(why)));
  };
  refused(Strain::small, "ground", "is an analytic body");
  refused(Strain::small, "body_bottom", "touches itself");
}

/// Without a target in sight nodes stay open, and the record says so.
TEST(Mortar, WhatSeesNoTargetIsOpen)
{
  Blocks blocks(2);
  blocks.add("lower", {0, 0, 0}, {1, 1, 0}, {3, 2, 0});
  blocks.add("upper", {0.5, 1, 0}, {3, 1, 0}, {8, 2, 0});
  Problem problem(blocks, Kinematics::plane_strain);
  problem.elastic("lower");
  problem.elastic("upper");
  problem.contact("upper_bottom", "lower_top").discretization = Discretization::mortar;
  problem.on("lower_bottom").fix = {0, 1};
  problem.on("upper_top").displacement = {{0, expression(0)}, {1, expression("-0.01*t")}};
  const Record run = problem.converge();
  for (std::size_t i = 0; i < run.impactor_nodes[0].size(); ++i)
    if (run.place(static_cast<Index>(run.impactor_nodes[0][i]))[0] > 1.4)
    {
      EXPECT_EQ(run.contact().status[i], ContactStatus::open);
      EXPECT_TRUE(std::isinf(run.contact().gap[i]));
    }
  EXPECT_NEAR(run.contact().contact_area, 0.5, 1e-12);
  EXPECT_NEAR(run.reaction("upper_top")[1], -run.contact().normal_force[1], 1e-10);
}
} // namespace
} // namespace amontons::test
