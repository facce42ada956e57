#include "solvers.h"

#include <gtest/gtest.h>

/// Surface-to-surface contact: what is uniform stays uniform, whatever the meshes, the way they lie and the solver.
namespace amontons::test
{
namespace
{
constexpr double exact = 1e-8;

std::vector<int> axes(int dim)
{
  return dim == 2 ? std::vector{0, 1} : std::vector{0, 1, 2};
}

/// Two blocks of 2 x 1 (x 1), one on the other, cells of either to the length, all of it in a turned frame; without
/// Poisson's effect, pressed together by 0.1 so that the pressure is 1e5.
Problem pressed_blocks(int dim, std::array<int, 2> n, const Eigen::Matrix3d &frame, bool swapped = false)
{
  const auto turned = [frame](const Point &x) { return Point(frame * x); };
  const auto size = dim == 2 ? Point(2, 1, 0) : Point(2, 1, 1);
  const auto cells = [dim](int k) { return std::array{2 * k, k, dim == 2 ? 0 : k}; };
  Blocks blocks(dim);
  blocks.add("lower", Point::Zero(), size, cells(n[0]), turned);
  blocks.add("upper", dim == 2 ? Point(0, 1, 0) : Point(0, 0, 1), size, cells(n[1]), turned);
  Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional);
  problem.elastic("lower", 2e6, 0);
  problem.elastic("upper", 2e6, 0);
  problem.contact(swapped ? "lower_top" : "upper_bottom", swapped ? "upper_bottom" : "lower_top").discretization =
      Discretization::mortar;
  problem.on("lower_bottom").fix = axes(dim);
  BoundaryOptions &top = problem.on("upper_top");
  for (int c = 0; c < dim; ++c)
    top.displacement[c] = expression(-0.1 * frame(c, dim - 1));
  return problem;
}

/// @param is_held of a node's place: a support carries what the contact would
void expect_uniform(
    const Record &run, double pressure, const Point &displacement,
    const std::function<bool(const Point &)> &is_held = [](const Point &) { return false; })
{
  for (std::size_t i = 0; i < run.impactor_nodes[0].size(); ++i)
  {
    const auto node = static_cast<Index>(run.impactor_nodes[0][i]);
    if (!is_held(run.place(node)))
      EXPECT_NEAR(run.contact().pressure[i], pressure, exact * std::abs(pressure)) << run.place(node).transpose();
    EXPECT_LT((run.displacement(node) - displacement).norm(), exact * displacement.norm());
  }
}

TEST(MortarPatch, PressedBlocks)
{
  const std::array<Eigen::Matrix3d, 2> frames{
      Eigen::Matrix3d::Identity(),
      Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.3, 0.1, 1).normalized()).toRotationMatrix()};
  for (const int dim : {2, 3})
    for (const bool tilted : {false, true})
      for (const std::array<int, 2> n : {std::array{3, 3}, {3, 4}, {5, 2}})
        for (const Solver &solver : all_solvers)
        {
          Eigen::Matrix3d frame = tilted ? frames[1] : frames[0];
          if (dim == 2 && tilted)
            frame = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
          const Record run = solve_by(pressed_blocks(dim, n, frame, n[0] == 5), solver);
          expect_uniform(run, 1e5, -0.05 * frame.col(dim - 1));
        }
}

/// Blocks cut by a slanted plane that does not slide below its angle of friction: one block in uniform compression, the
/// tangential part of the traction carried by sticking.
TEST(MortarPatch, SlantedInterfaceSticks)
{
  constexpr double slope = 0.3; // tan of the angle
  for (const int dim : {2, 3})
  {
    const auto size = dim == 2 ? Point(1, 1, 0) : Point(1, 1, 1);
    const int up = dim - 1;
    const auto lower = [=](const Point &x) { return Point(x + Point::Unit(up) * x[up] * slope * (x[0] - 0.5)); };
    const auto upper = [=](const Point &x) { return Point(x + Point::Unit(up) * (2 - x[up]) * slope * (x[0] - 0.5)); };
    Blocks blocks(dim);
    blocks.add("lower", Point::Zero(), size, dim == 2 ? std::array{4, 3, 0} : std::array{4, 3, 3}, lower);
    blocks.add("upper", Point::Unit(up), size, dim == 2 ? std::array{5, 3, 0} : std::array{3, 4, 3}, upper);
    Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional);
    problem.elastic("lower", 2e6, 0);
    problem.elastic("upper", 2e6, 0);
    problem.contact("upper_bottom", "lower_top", 0.35).discretization = Discretization::mortar;
    problem.on("lower_bottom").fix = axes(dim);
    BoundaryOptions &top = problem.on("upper_top");
    for (int c = 0; c < dim; ++c)
      top.displacement[c] = expression(c == up ? "-0.1*t" : "0");
    problem.options.loading.increments = 2;
    // The displacement is linear: what a plate at the height of the interface does.
    const double cosine2 = 1 / (1 + slope * slope), stress = 2e6 * 0.1 / 2;
    for (const Solver &solver : all_solvers)
    {
      const Record run = solve_by(problem, solver);
      EXPECT_EQ(run.contact().n_stick, static_cast<int>(run.impactor_nodes[0].size()));
      for (std::size_t i = 0; i < run.impactor_nodes[0].size(); ++i)
      {
        const auto node = static_cast<Index>(run.impactor_nodes[0][i]);
        EXPECT_NEAR(run.contact().pressure[i], stress * cosine2, exact * stress);
        const double *traction = run.contact().traction.data() + i * (dim - 1);
        EXPECT_NEAR(std::hypot(traction[0], dim == 3 ? traction[1] : 0), stress * slope * cosine2, exact * stress);
        EXPECT_LT((run.displacement(node) + 0.05 * run.place(node)[up] * Point::Unit(up)).norm(), exact);
      }
    }
  }
}

/// Pressed, then dragged: below Coulomb's limit the blocks are one, above it each node slides at mu times its pressure.
TEST(MortarPatch, SlidesAtCoulombsLimit)
{
  for (const int dim : {2, 3})
  {
    Problem problem = pressed_blocks(dim, {3, 4}, Eigen::Matrix3d::Identity());
    problem.options.contact[0].friction_coefficient = 0.2;
    BoundaryOptions &top = problem.options.boundary.back();
    top.displacement[dim - 1] = expression("-0.1*min(t,1)");
    top.displacement[0] = expression("0.3*max(t-1,0)");
    problem.options.loading.end = 2;
    problem.options.loading.increments = 4;
    const Record run = solve_by(problem, all_solvers[1]);
    const ContactResult &contact = run.contact();
    EXPECT_EQ(contact.n_stick, 0);
    EXPECT_NEAR(std::abs(contact.tangential_force[0]), 0.2 * std::abs(contact.normal_force[dim - 1]), 1e-6 * 2e5);
    for (std::size_t i = 0; i < contact.pressure.size(); ++i)
    {
      const double *traction = contact.traction.data() + i * (dim - 1);
      EXPECT_NEAR(std::hypot(traction[0], dim == 3 ? traction[1] : 0), 0.2 * contact.pressure[i], exact * 1e5);
    }
  }
}

/// Taylor and Papadopoulos: a punch on a wider foundation, both under the same pressure; the interface does not show.
TEST(MortarPatch, TaylorPapadopoulos)
{
  constexpr double young = 1000, poisson = 0.4, pressure = 10;
  for (const bool swapped : {false, true})
  {
    Blocks blocks(2);
    blocks.add("foundation", {0, 0, 0}, {3, 1, 0}, {9, 3, 0});
    blocks.add("punch", {1, 1, 0}, {1, 1, 0}, {4, 4, 0});
    blocks.add_union("shore", {"foundation_top"}, [](const Point &x) { return x[0] < 1 || x[0] > 2; });
    Problem problem(blocks, Kinematics::plane_strain);
    problem.elastic("foundation", young, poisson);
    problem.elastic("punch", young, poisson);
    problem.contact(swapped ? "foundation_top" : "punch_bottom", swapped ? "punch_bottom" : "foundation_top")
        .discretization = Discretization::mortar;
    problem.on("foundation_bottom").fix = {1};
    problem.on("foundation_left").fix = {0};
    problem.on("punch_left").displacement[0] = expression(pressure * poisson * (1 + poisson) / young);
    problem.on("punch_top").pressure = expression(pressure);
    problem.on("shore").pressure = expression(pressure);
    for (const Solver &solver : all_solvers)
    {
      const Record run = solve_by(problem, solver);
      for (std::size_t i = 0; i < run.impactor_nodes[0].size(); ++i)
      {
        const auto node = static_cast<Index>(run.impactor_nodes[0][i]);
        const bool covered = !swapped || (run.place(node)[0] > 1 - 1e-9 && run.place(node)[0] < 2 + 1e-9);
        EXPECT_NEAR(run.contact().pressure[i], covered ? pressure : 0, exact * pressure) << run.place(node).transpose();
        EXPECT_NEAR(run.displacement(node)[1], -pressure * (1 - poisson * poisson) / young, exact);
      }
    }
  }
}

/// Rings: the same in axisymmetry, nodes on the axis included.
TEST(MortarPatch, PressedDiscs)
{
  Blocks blocks(2);
  blocks.add("lower", {0, 0, 0}, {2, 1, 0}, {6, 3, 0});
  blocks.add("upper", {0, 1, 0}, {2, 1, 0}, {7, 4, 0});
  for (const bool swapped : {false, true})
  {
    Problem problem(blocks, Kinematics::axisymmetric);
    problem.elastic("lower", 2e6, 0.3);
    problem.elastic("upper", 2e6, 0.3);
    problem.contact(swapped ? "lower_top" : "upper_bottom", swapped ? "upper_bottom" : "lower_top").discretization =
        Discretization::mortar;
    problem.on("lower_bottom").fix = {1};
    problem.on("lower_left").fix = {0};
    problem.on("upper_left").fix = {0};
    problem.on("upper_top").displacement[1] = expression("-0.1*t");
    for (const Solver &solver : all_solvers)
    {
      const Record run = solve_by(problem, solver);
      for (std::size_t i = 0; i < run.impactor_nodes[0].size(); ++i)
      {
        EXPECT_NEAR(run.contact().pressure[i], 1e5, exact * 1e5);
        EXPECT_NEAR(run.displacement(static_cast<Index>(run.impactor_nodes[0][i]))[1], -0.05, exact);
      }
    }
  }
}

/// Held together, meshes that do not match are one body in any uniform state: tension and shear.
TEST(MortarPatch, TiedBlocksPassTensionAndShear)
{
  for (const int dim : {2, 3})
  {
    Problem problem = pressed_blocks(dim, {3, 4}, Eigen::Matrix3d::Identity());
    problem.options.contact[0].tied = true;
    problem.options.boundary.back().displacement = {{0, expression("0.04*t")}, {dim - 1, expression("0.1*t")}};
    if (dim == 3)
      problem.options.boundary.back().displacement[1] = expression("-0.02*t");
    // Sides on which the shear stress acts are held to the linear field.
    for (const char *body : {"lower", "upper"})
      for (const char *side : {"_left", "_right", "_front", "_back"})
        if (dim == 3 || side == std::string("_left") || side == std::string("_right"))
        {
          const std::string height = dim == 2 ? "y" : "z";
          BoundaryOptions &entry = problem.on(body + std::string(side));
          entry.displacement[0] = expression("0.02*t*" + height);
          entry.displacement[dim - 1] = expression("0.05*t*" + height);
          if (dim == 3)
            entry.displacement[1] = expression("-0.01*t*" + height);
        }
    const Record run = problem.converge();
    EXPECT_EQ(run.iterations(), std::vector{1});
    const auto on_a_side = [dim](const Point &x)
    { return x[0] < 1e-9 || x[0] > 2 - 1e-9 || (dim == 3 && (x[1] < 1e-9 || x[1] > 1 - 1e-9)); };
    expect_uniform(run, -1e5, dim == 2 ? Point(0.02, 0.05, 0) : Point(0.02, -0.01, 0.05), on_a_side);
  }
}
} // namespace
} // namespace amontons::test
