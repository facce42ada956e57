#include "problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Surface-to-surface contact in finite strain: uniform states, motions of the whole, sliding far, Newton's iterations.
namespace amontons::test
{
namespace
{
constexpr double exact = 1e-8;

/// Two blocks with meshes that do not match, one on the other, held on top and bottom as a press would: by what is
/// smooth.
Problem pressed_blocks(int dim, std::array<int, 2> n)
{
  const auto side = [dim](int k) { return std::array{k, dim == 3 ? k : 2, 2}; };
  const Point size = dim == 2 ? Point(1, 1, 0) : Point(1, 1, 1);
  Blocks blocks(dim);
  blocks.add("lower", Point::Zero(), size, side(n[0]));
  blocks.add("upper", Point::Unit(dim - 1), size, side(n[1]));
  Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional, Strain::finite);
  for (const std::string body : {"lower", "upper"})
  {
    problem.elastic(body, 2, 0.3);
    problem.on(body + "_left").fix = {0};
    if (dim == 3)
      problem.on(body + "_front").fix = {1};
  }
  problem.on("lower_bottom").fix = {dim - 1};
  problem.on("upper_top").displacement[dim - 1] = expression("-0.6*t");
  problem.contact("upper_bottom", "lower_top").discretization = Discretization::mortar;
  problem.options.loading.increments = 3;
  problem.options.solver.tolerance = 1e-11;
  return problem;
}

/// One block twice as high.
Record whole_block(int dim)
{
  Blocks blocks(dim);
  blocks.add("block", Point::Zero(), dim == 2 ? Point(1, 2, 0) : Point(1, 1, 2), {2, 2, 2});
  Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional, Strain::finite);
  problem.elastic("block", 2, 0.3);
  problem.on("block_left").fix = {0};
  if (dim == 3)
    problem.on("block_front").fix = {1};
  problem.on("block_bottom").fix = {dim - 1};
  problem.on("block_top").displacement[dim - 1] = expression("-0.6*t");
  problem.options.loading.increments = 3;
  problem.options.solver.tolerance = 1e-11;
  return problem.converge();
}

/// Without friction both blocks widen alike: pressed to 70 % of their height they are one block.
TEST(MovingMortar, PressedBlocksAreOne)
{
  for (const int dim : {2, 3})
  {
    const Record whole = whole_block(dim);
    const double force = std::abs(whole.reaction("block_top")[dim - 1]);
    const double widening = whole.displacement(whole.node_at(dim == 2 ? Point(1, 1, 0) : Point(1, 1, 1)))[0];
    for (const std::array<int, 2> n : {std::array{3, 3}, {3, 4}, {5, 2}})
    {
      const Record run = pressed_blocks(dim, n).converge();
      EXPECT_NEAR(run.contact().normal_force[dim - 1], force, exact * force);
      for (std::size_t i = 0; i < run.impactor_nodes[0].size(); ++i)
      {
        const auto node = static_cast<Index>(run.impactor_nodes[0][i]);
        EXPECT_NEAR(run.contact().pressure[i], force, exact * force); // the area is 1
        EXPECT_NEAR(run.displacement(node)[0], widening * run.place(node)[0], exact);
        EXPECT_NEAR(run.displacement(node)[dim - 1], -0.3, exact);
      }
      for (const int iterations : run.iterations())
        EXPECT_LE(iterations, 6);
    }
  }
}

/// The position turned by an angle about the origin after a motion to (x, y + way), as a displacement.
void turn(BoundaryOptions &support, const std::string &way, const std::string &angle)
{
  support.fix.clear();
  support.displacement[0] = expression("cos(" + angle + ")*x - sin(" + angle + ")*(y" + way + ") - x");
  support.displacement[1] = expression("sin(" + angle + ")*x + cos(" + angle + ")*(y" + way + ") - y");
}

/// A rounded block pressed on a wider one and dragged along it with friction; all of it turned meanwhile.
Record dragged(double angle)
{
  Blocks blocks(2);
  blocks.add("lower", {-1.5, -0.6, 0}, {4, 0.6, 0}, {17, 3, 0},
             [](const Point &x) { return Point(x[0], x[1] + (x[1] > -0.1 ? 0.03 * std::sin(2 * x[0]) : 0), 0); });
  blocks.add("upper", {-0.5, 0.03, 0}, {1, 0.5, 0}, {6, 3, 0},
             [](const Point &x) { return Point(x[0], x[1] + (0.6 - x[1]) * 0.2 * x[0] * x[0], 0); });
  Problem problem(blocks, Kinematics::plane_strain, Strain::finite);
  problem.elastic("lower", 1, 0.3);
  problem.elastic("upper", 3, 0.3);
  problem.contact("upper_bottom", "lower_top", 0.25).discretization = Discretization::mortar;
  const std::string by = "(" + std::to_string(angle) + "*t)";
  turn(problem.on("lower_bottom"), "", by);
  BoundaryOptions &top = problem.on("upper_top");
  // x + 0.3 max(t-1, 0): as a turn of the place that it has then.
  const std::string x = "(x+0.3*max(t-1,0))", y = "(y-0.12*min(t,1))";
  top.displacement[0] = expression("cos(" + by + ")*" + x + " - sin(" + by + ")*" + y + " - x");
  top.displacement[1] = expression("sin(" + by + ")*" + x + " + cos(" + by + ")*" + y + " - y");
  problem.options.loading.end = 3;
  problem.options.loading.increments = 15;
  problem.options.solver.tolerance = 1e-11;
  return problem.converge();
}

TEST(MovingMortar, SlidesAsTheWholeTurns)
{
  const Record still = dragged(0), turned = dragged(0.4);
  const ContactResult &a = still.contact(), &b = turned.contact();
  EXPECT_GT(a.n_slip, 0);
  EXPECT_EQ(a.status, b.status);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(3 * 0.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const double size = vector(a.normal_force).norm();
  EXPECT_LT((turn * vector(a.normal_force) - vector(b.normal_force)).norm(), 1e-9 * size);
  EXPECT_LT((turn * vector(a.tangential_force) - vector(b.tangential_force)).norm(), 1e-9 * size);
  for (const Record *run : {&still, &turned})
    for (const int iterations : run->iterations())
      EXPECT_LE(iterations, 9);
  // Forces on both sides and supports are in equilibrium.
  EXPECT_LT((turned.reaction("lower_bottom") + turned.reaction("upper_top")).norm(), 1e-8 * size);
}

/// Over a plane that does not deform, with faces of its own: Coulomb's ratio whatever is crossed.
TEST(MovingMortar, SlidesFarAtCoulombsLimit)
{
  for (const int dim : {2, 3})
  {
    Blocks blocks(dim);
    blocks.add("block", dim == 2 ? Point(0, 0.01, 0) : Point(0, 0, 0.01),
               dim == 2 ? Point(1, 0.8, 0) : Point(1, 1, 0.8), dim == 2 ? std::array{4, 3, 0} : std::array{3, 3, 2});
    if (dim == 2)
      blocks.add_line("floor", {{4, 0, 0}, {-2, 0, 0}}, 23);
    else
      blocks.add_sheet("floor", {-2, -2, 0}, {6, 0, 0}, {0, 5, 0}, {19, 14});
    Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional, Strain::finite);
    problem.elastic("block", 1, 0.3);
    problem.rigid("floor");
    problem.on("floor").displacement = {{0, expression(0)}, {1, expression(0)}};
    if (dim == 3)
      problem.options.boundary.back().displacement[2] = expression(0);
    BoundaryOptions &top = problem.on("block_top");
    top.displacement[0] = expression("0.8*max(t-1,0)");
    top.displacement[dim - 1] = expression("-0.1*min(t,1)");
    if (dim == 3)
      top.displacement[1] = expression("0.5*max(t-1,0)");
    problem.contact("block_bottom", "floor", 0.2).discretization = Discretization::mortar;
    problem.options.loading.end = 3;
    problem.options.loading.increments = 12;
    problem.options.solver.tolerance = 1e-11;
    const Record run = problem.converge();
    const ContactResult &contact = run.contact();
    EXPECT_EQ(contact.n_slip, contact.n_active);
    EXPECT_GT(contact.n_active, 0);
    const Point friction = vector(contact.tangential_force);
    EXPECT_NEAR(friction.norm(), 0.2 * contact.normal_force[dim - 1], 1e-3 * contact.normal_force[dim - 1]);
    EXPECT_NEAR(friction[dim - 1], 0, 1e-9);
    for (std::size_t i = 0; i < contact.pressure.size(); ++i)
    {
      const double *traction = contact.traction.data() + i * (dim - 1);
      EXPECT_NEAR(std::hypot(traction[0], dim == 3 ? traction[1] : 0), 0.2 * contact.pressure[i], exact);
    }
  }
}

/// Held together and pulled apart while all is turned by a right angle: what it is without the turn.
TEST(MovingMortar, TiedBlocksTurn)
{
  Blocks blocks(2);
  blocks.add("lower", {0, 0, 0}, {1, 1, 0}, {3, 2, 0});
  blocks.add("upper", {0, 1, 0}, {1, 1, 0}, {4, 2, 0});
  std::array<Record, 2> runs;
  for (const bool turns : {false, true})
  {
    Problem problem(blocks, Kinematics::plane_strain, Strain::finite);
    problem.elastic("lower", 2, 0.3);
    problem.elastic("upper", 2, 0.3);
    ContactOptions &contact = problem.contact("upper_bottom", "lower_top");
    contact.discretization = Discretization::mortar;
    contact.tied = true;
    const std::string angle = turns ? "(1.5707963267948966*t)" : "(0*t)";
    turn(problem.on("lower_bottom"), "", angle);
    turn(problem.on("upper_top"), "+0.2*t", angle);
    problem.options.loading.increments = 8;
    problem.options.solver.tolerance = 1e-11;
    runs[turns ? 1 : 0] = problem.converge();
  }
  for (std::size_t i = 0; i < runs[0].impactor_nodes[0].size(); ++i)
  {
    const auto node = static_cast<Index>(runs[0].impactor_nodes[0][i]);
    const Point still = runs[0].place(node) + runs[0].displacement(node),
                turned = runs[1].place(node) + runs[1].displacement(node);
    EXPECT_LT((turned - Point(-still[1], still[0], 0)).norm(), exact);
    EXPECT_LT(runs[0].contact().pressure[i], -0.1);
    EXPECT_NEAR(runs[1].contact().pressure[i], runs[0].contact().pressure[i], exact);
  }
}

/// Contact alone holds the block, in finite strain: it travels to the floor, on faces that are not its own, and bears
/// what presses it.
TEST(MovingMortar, BodyThatTravelsToWhereItTouches)
{
  for (const bool swapped : {false, true})
  {
    Blocks blocks(2);
    blocks.add("block", {0, 0.01, 0}, {1, 1, 0}, {5, 4, 0});
    blocks.add_line("floor", {{2, 0, 0}, {-1, 0, 0}}, 7);
    Problem problem(blocks, Kinematics::plane_strain, Strain::finite);
    problem.elastic("block");
    problem.rigid("floor");
    problem.contact(swapped ? "floor" : "block_bottom", swapped ? "block_bottom" : "floor").discretization =
        Discretization::mortar;
    problem.on("block_top").traction[1] = expression(-0.02);
    problem.options.solver.tolerance = 1e-11;
    const Record run = problem.converge();
    EXPECT_NEAR(std::abs(run.contact().normal_force[1]), 0.02, exact * 0.02);
    EXPECT_NEAR(run.contact().tangential_force[0], 0, 1e-12);
    if (swapped)
      continue;
    for (std::size_t i = 0; i < run.impactor_nodes[0].size(); ++i)
    {
      EXPECT_NEAR(run.contact().pressure[i], 0.02, exact * 0.02); // over the reference
      EXPECT_NEAR(run.contact().gap[i], 0, 1e-12);
    }
  }
}

/// Two bars in a row along y without Poisson's effect, their ends `gap` apart, moved towards each other by `way`; faces
/// of a twentieth.
Problem bars(double gap, double way)
{
  Blocks blocks(2);
  blocks.add("lower", {0, 0, 0}, {1, 1, 0}, {18, 2, 0});
  blocks.add("upper", {0, 1 + gap, 0}, {1, 1, 0}, {20, 2, 0});
  Problem problem(blocks, Kinematics::plane_strain, Strain::finite);
  problem.elastic("lower", 2, 0);
  problem.elastic("upper", 1, 0);
  problem.contact("upper_bottom", "lower_top").discretization = Discretization::mortar;
  problem.on("lower_bottom").fix = {0, 1};
  problem.on("upper_top").displacement = {{0, expression(0)}, {1, expression(std::to_string(-way) + "*t")}};
  problem.options.loading.increments = 4;
  problem.options.solver.tolerance = 1e-11;
  return problem;
}

/// What is tied across many faces' lengths stays tied while little moves, and as if there were no gap.
TEST(MovingMortar, TiesAcrossAGap)
{
  std::array<double, 2> force{};
  for (const bool apart : {false, true})
  {
    Problem problem = bars(apart ? 0.4 : 0, -0.1);
    problem.options.contact[0].tied = true;
    const Record run = problem.converge();
    EXPECT_EQ(run.contact().n_active, run.contact().n_nodes);
    force[apart ? 1 : 0] = run.contact().normal_force[1];
  }
  EXPECT_LT(force[0], -0.05);
  EXPECT_NEAR(force[1], force[0], 1e-5 * std::abs(force[0])); // the ends narrow, each by its own strain
}

/// An overlap of some faces' lengths that counts as touching is told, and stays where it is.
TEST(MovingMortar, AdjustsADeepOverlap)
{
  std::array<double, 2> force{};
  for (const bool overlap : {false, true})
  {
    Problem problem = bars(overlap ? -0.18 : 0, 0.2);
    problem.options.contact[0].initial_overlap = InitialOverlap::adjust;
    const Record run = problem.converge();
    EXPECT_EQ(run.contact().n_active, run.contact().n_nodes);
    force[overlap ? 1 : 0] = run.contact().normal_force[1];
    if (overlap)
      EXPECT_THAT(run.warnings, testing::ElementsAre(testing::HasSubstr("taken as touching")));
    else
      EXPECT_THAT(run.warnings, testing::IsEmpty());
  }
  EXPECT_GT(force[0], 0.05);
  EXPECT_NEAR(force[1], force[0], 1e-5 * force[0]); // the ends widen, each by its own strain
}

/// A block whose sides belong to the impactor, too, pressed on a rigid plane and dragged: as its lower side alone.
TEST(MovingMortar, SidesOfTheImpactorMayBelongToIt)
{
  std::array<Record, 2> runs;
  for (const bool sides : {false, true})
  {
    Blocks blocks(3);
    blocks.add("block", {0, 0, 0}, {1, 1, 0.8}, {3, 3, 2});
    blocks.add_sheet("floor", {-2, -2, 0}, {6, 0, 0}, {0, 5, 0}, {19, 14});
    blocks.add_union("hull", {"block_left", "block_right", "block_front", "block_back", "block_bottom"});
    Problem problem(blocks, Kinematics::three_dimensional, Strain::finite);
    problem.elastic("block", 1, 0.3);
    problem.rigid("floor");
    problem.on("floor").displacement = {{0, expression(0)}, {1, expression(0)}, {2, expression(0)}};
    problem.on("block_top").displacement = {
        {0, expression("0.3*max(t-1,0)")}, {1, expression("0.2*max(t-1,0)")}, {2, expression("-0.05*min(t,1)")}};
    problem.contact(sides ? "hull" : "block_bottom", "floor", 0.2).discretization = Discretization::mortar;
    problem.options.loading.end = 2;
    problem.options.loading.increments = 4;
    problem.options.solver.tolerance = 1e-11;
    runs[sides ? 1 : 0] = problem.converge();
  }
  const ContactResult &lower = runs[0].contact(), &hull = runs[1].contact();
  EXPECT_EQ(lower.n_active, 16);
  EXPECT_EQ(hull.n_active, lower.n_active);
  EXPECT_LT((total_force(hull) - total_force(lower)).norm(), exact * total_force(lower).norm());
}

TEST(MovingMortar, WantsTheCoupledForm)
{
  Problem problem = pressed_blocks(2, {2, 3});
  problem.options.solver.multipliers = MultiplierForm::condensed;
  EXPECT_THAT([&] { (void)problem.solve(); },
              testing::ThrowsMessage<UserError>(testing::HasSubstr("'multipliers: coupled'")));
  problem.options.solver.multipliers = MultiplierForm::automatic;
  problem.options.solver.linear = LinearSolverType::amg;
  EXPECT_THAT([&] { (void)problem.solve(); },
              testing::ThrowsMessage<UserError>(testing::HasSubstr("'multipliers: coupled'")));
}
} // namespace
} // namespace amontons::test
