#include "problem.h"

#include "amontons/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Two regions with prescribed displacements that share nodes.
namespace amontons::test
{
namespace
{
/// A block whose left side and bottom are moved along x.
Problem held_on_two_sides(const std::string &left, const std::string &bottom)
{
  Blocks blocks(2);
  blocks.add("block", {100, 100, 0}, {1, 1, 0}, {2, 2, 0});
  Problem problem(blocks, Kinematics::plane_strain);
  problem.elastic("block");
  problem.on("block_left").displacement = {{0, expression(left)}};
  problem.on("block_bottom").displacement = {{0, expression(bottom)}, {1, expression(0)}};
  return problem;
}

TEST(Supports, DifferOnASharedNodeByRoundOffOnly)
{
  // (x + 0.1) - 0.1 - 100 is 0 on the left but for round-off.
  EXPECT_TRUE(held_on_two_sides("((x+0.1)-0.1-100)*t", "0").solve().result.converged);
}

TEST(Supports, ThatContradictEachOtherAreNamed)
{
  try
  {
    (void)held_on_two_sides("1e-9", "0").solve();
    FAIL() << "no error";
  }
  catch (const UserError &error)
  {
    EXPECT_THAT(error.what(), testing::HasSubstr("conflicting boundary conditions: component x of node"));
    EXPECT_THAT(error.what(), testing::HasSubstr("moved by 1e-09 through region 'block_left' and by 0 "));
    EXPECT_THAT(error.what(), testing::HasSubstr("through region 'block_bottom'"));
  }
}
} // namespace
} // namespace amontons::test
