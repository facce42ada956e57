// Run on one, two and three processes: whole solutions against those of one process.
#include "problem.h"

#include <gmock/gmock.h>

#include <numbers>

namespace amontons::test
{
namespace
{
const Communicator world(MPI_COMM_WORLD);

struct Solver
{
  const char *name;
  LinearSolverType linear;
  MultiplierForm form;
};

void PrintTo(const Solver &solver, std::ostream *out)
{
  *out << solver.name;
}

MATCHER_P(IsWithin, difference, "")
{
  return std::abs(std::get<0>(arg) - std::get<1>(arg)) <= difference;
}

class DistributedRun : public testing::TestWithParam<Solver>
{
protected:
  /// The same iterations, statuses and, to the solvers' tolerance, forces.
  /// @param cuts whether increments are cut, and grow again
  static void expect_as_alone(Problem &problem, bool cuts = false)
  {
    problem.options.solver.linear = GetParam().linear;
    problem.options.solver.multipliers = GetParam().form;
    problem.options.solver.tolerance = 1e-11;
    problem.options.loading.fixed = !cuts;
    const Record alone = problem.solve(), spread = problem.solve(world);
    ASSERT_TRUE(alone.result.converged) << alone.result.failure;
    ASSERT_TRUE(spread.result.converged) << spread.result.failure;
    EXPECT_EQ(spread.n_dofs, alone.n_dofs);
    EXPECT_EQ(spread.attempts.size(), alone.attempts.size());
    EXPECT_EQ(alone.attempts.size() > alone.iterations().size(), cuts);
    // What an iteration leaves of its linear system, within its tolerance, hangs on the processes: multigrid's levels
    // do.
    const bool iterates = GetParam().linear == LinearSolverType::amg || GetParam().linear == LinearSolverType::feti;
    const int allowed = iterates ? 1 : 0;
    EXPECT_THAT(spread.iterations(), testing::Pointwise(IsWithin(allowed), alone.iterations()));
    ASSERT_EQ(spread.states.size(), alone.states.size());
    for (std::size_t s = 0; s < alone.states.size(); ++s)
      for (std::size_t c = 0; c < alone.states[s].contacts.size(); ++c)
        expect_same_contact(spread, alone, s, c);
    for (std::size_t r = 0; r < alone.state().reactions.size(); ++r)
    {
      const Reaction &one = alone.state().reactions[r], &all = spread.state().reactions[r];
      EXPECT_EQ(all.region, one.region);
      expect_near(all.force, one.force);
    }
    expect_same_displacements(alone, spread);
  }

  /// At all nodes that the process has.
  static void expect_same_contact(const Record &spread, const Record &alone, std::size_t s, std::size_t c)
  {
    const ContactResult &all = spread.states[s].contacts[c], &one = alone.states[s].contacts[c];
    const std::vector<GlobalIndex> &nodes = spread.impactor_nodes[c], &of_all = alone.impactor_nodes[c];
    EXPECT_EQ(all.n_nodes, one.n_nodes);
    EXPECT_EQ(all.n_stick, one.n_stick);
    EXPECT_EQ(all.n_slip, one.n_slip);
    expect_near(all.normal_force, one.normal_force);
    expect_near(all.tangential_force, one.tangential_force);
    std::vector<ContactStatus> status;
    std::vector<double> force, slip;
    for (const GlobalIndex node : nodes)
    {
      const auto i = std::find(of_all.begin(), of_all.end(), node) - of_all.begin();
      const auto take = [i](std::vector<double> &to, const std::vector<double> &from, std::ptrdiff_t width)
      { to.insert(to.end(), from.begin() + i * width, from.begin() + (i + 1) * width); };
      status.push_back(one.status.at(i));
      take(force, one.force, one.dim);
      take(slip, one.slip, one.dim - 1);
    }
    EXPECT_EQ(all.status, status);
    expect_near(all.force, force);
    expect_near(all.slip, slip);
  }

  static void expect_near(std::span<const double> all, std::span<const double> one)
  {
    double size = 1e-4; // of forces, displacements and slips of 1e-3 to 1
    for (const double x : one)
      size = std::max(size, std::abs(x));
    ASSERT_EQ(all.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i)
      EXPECT_NEAR(all[i], one[i], 1e-8 * size);
  }

  static void expect_same_displacements(const Record &alone, const Record &spread)
  {
    const auto dim = static_cast<std::size_t>(alone.mesh.dim);
    std::vector<double> expected;
    for (const GlobalIndex node : spread.mesh.node_ids)
      for (std::size_t c = 0; c < dim; ++c)
        expected.push_back(alone.state().displacement[static_cast<std::size_t>(node) * dim + c]);
    expect_near(spread.state().displacement, expected);
  }
};

/// Pressed, then dragged until a part of the nodes slides.
Problem dragged_block()
{
  Blocks mesh(3);
  mesh.add("lower", {0, 0, 0}, {2, 2, 1}, {8, 8, 4}); // three subdomains with the other block
  mesh.add("upper", {0.3, 0.2, 1}, {1, 1.2, 1}, {4, 5, 4},
           [](const Point &x) { return Point(x[0], x[1], x[2] + 0.02 * (x[0] - 0.8) * (x[0] - 0.8)); });
  Problem problem(mesh, Kinematics::three_dimensional);
  problem.elastic("lower", 10);
  problem.elastic("upper", 3, 0.2);
  problem.on("lower_bottom").fix = {0, 1, 2};
  problem.on("upper_top").displacement = {
      {0, expression("0.03 * t")}, {1, expression(0)}, {2, expression("-0.03 * t")}};
  problem.contact("upper_bottom", "lower_top", 0.3);
  problem.options.loading.increments = 3;
  return problem;
}

TEST_P(DistributedRun, BlockDraggedWithFriction)
{
  Problem problem = dragged_block();
  expect_as_alone(problem);
}

TEST_P(DistributedRun, BodiesHeldByContactAlone)
{
  // The middle block lies between the others; the uppermost is rigid and loaded by a force.
  Blocks mesh(3);
  mesh.add("lower", {0, 0, 0}, {2, 2, 1}, {4, 4, 2});
  mesh.add("middle", {0.3, 0.3, 1}, {1, 1, 0.6}, {3, 3, 3});
  mesh.add("upper", {0.2, 0.2, 1.6}, {1.2, 1.2, 0.3}, {1, 1, 1});
  Problem problem(mesh, Kinematics::three_dimensional);
  problem.elastic("lower", 10);
  problem.elastic("middle", 3, 0.2);
  problem.rigid("upper");
  problem.on("lower_bottom").fix = {0, 1, 2};
  problem.on("upper").force[2] = expression("-0.1 * t");
  problem.contact("middle_bottom", "lower_top", 0.3);
  problem.contact("middle_top", "upper_bottom", 0.3);
  problem.options.loading.increments = 2;
  expect_as_alone(problem);
}

TEST_P(DistributedRun, PlasticBlockUnderAShape)
{
  Blocks mesh(2);
  mesh.add("block", {-1, -1, 0}, {2, 1, 0}, {12, 6, 0});
  Problem problem(mesh, Kinematics::plane_strain);
  BodyOptions &block = problem.elastic("block", 100);
  block.material.law = MaterialLaw::von_mises;
  block.material.yield_stress = 1;
  Shape shape = ground(2);
  shape.type = ShapeType::circle;
  shape.radius = 1;
  shape.point = {0.1, 1, 0};
  problem.rigid("roller", shape);
  problem.on("block_bottom").fix = {0, 1};
  problem.on("roller").displacement = {{0, expression("0.02 * t")}, {1, expression("-0.05 * t")}};
  problem.contact("block_top", "roller", 0.2);
  problem.options.loading.increments = 4;
  expect_as_alone(problem);
}

/// Pressed, then pushed along over two faces of the lower one.
Problem sliding_block()
{
  Blocks mesh(2);
  mesh.add("lower", {-1, -1, 0}, {3, 1, 0}, {15, 5, 0});
  mesh.add("upper", {-0.5, 0.01, 0}, {1, 0.7, 0}, {6, 4, 0});
  Problem problem(mesh, Kinematics::plane_strain, Strain::finite);
  problem.elastic("lower", 1);
  problem.elastic("upper", 2, 0.2);
  problem.on("lower_bottom").fix = {0, 1};
  problem.on("upper_top").displacement = {{0, expression("0.4 * t")}, {1, expression("-0.1 * min(4*t, 1)")}};
  problem.contact("upper_bottom", "lower_top", 0.3);
  problem.options.loading.increments = 8;
  return problem;
}

TEST_P(DistributedRun, FiniteStrainFromFaceToFace)
{
  if (GetParam().linear == LinearSolverType::feti)
    GTEST_SKIP() << "feti is for small strain";
  Problem problem = sliding_block();
  expect_as_alone(problem);
}

TEST_P(DistributedRun, FiniteStrainWhileAllTurns)
{
  if (GetParam().linear == LinearSolverType::feti)
    GTEST_SKIP() << "feti is for small strain";
  Problem problem = sliding_block();
  const auto turning = [](const std::string &x, const std::string &y)
  {
    return std::map<int, Expression>{{0, expression("cos(3*t*t)*(" + x + ")-sin(3*t*t)*(" + y + ")-x")},
                                     {1, expression("sin(3*t*t)*(" + x + ")+cos(3*t*t)*(" + y + ")-y")}};
  };
  problem.options.boundary.clear();
  problem.on("lower_bottom").displacement = turning("x", "y");
  problem.on("upper_top").displacement = turning("x+0.4*t", "y-0.1*min(4*t,1)");
  expect_as_alone(problem);
}

TEST_P(DistributedRun, WhatNobodyHoldsIsSaidByAll)
{
  Problem problem = dragged_block();
  problem.options.boundary.erase(problem.options.boundary.begin());
  problem.on("lower_bottom").traction[0] = expression(1);
  problem.options.solver.linear = GetParam().linear;
  problem.options.solver.multipliers = GetParam().form;
  const Record spread = problem.solve(world);
  EXPECT_FALSE(spread.result.converged);
  EXPECT_THAT(spread.failure, testing::HasSubstr("body 'lower' moves freely"));
}

INSTANTIATE_TEST_SUITE_P(Solvers, DistributedRun,
                         testing::Values(Solver{"coupled", LinearSolverType::direct, MultiplierForm::coupled},
                                         Solver{"direct", LinearSolverType::direct, MultiplierForm::condensed},
                                         Solver{"amg", LinearSolverType::amg, MultiplierForm::condensed},
                                         Solver{"feti", LinearSolverType::feti, MultiplierForm::condensed}),
                         [](const auto &info) { return std::string(info.param.name); });

/// Kinds of contact that bring more to a process than the pairs of its own nodes.
class DistributedContact : public DistributedRun
{
};

TEST_P(DistributedContact, SmoothedNormalsFoundByTheHub)
{
  Problem problem = sliding_block();
  problem.options.contact[0].normals = TargetNormals::smoothed;
  problem.options.exchange.mode = ExchangeMode::gathered;
  expect_as_alone(problem);
}

TEST_P(DistributedContact, SurfaceToSurface)
{
  Problem problem = dragged_block();
  problem.options.contact[0].discretization = Discretization::mortar;
  expect_as_alone(problem);
}

TEST_P(DistributedContact, Tied)
{
  Problem problem = dragged_block();
  problem.options.contact[0].tied = true;
  expect_as_alone(problem);
}

/// A strip bent to a hairpin, its ends pressed together and pushed along each other.
TEST_P(DistributedContact, ASurfaceThatTouchesItself)
{
  constexpr double radius = 0.08, thickness = 0.1, arc = std::numbers::pi * radius, length = 2.043 + arc;
  Blocks mesh(2);
  mesh.add("strip", {0, 0, 0}, {1, 1, 0}, {64, 2, 0},
           [](const Point &x)
           {
             const double s = x[0] * length, offset = (x[1] - 0.5) * thickness, phi = (s - 1) / radius;
             if (s <= 1)
               return Point(s, offset, 0);
             if (s >= 1 + arc)
               return Point(2 + arc - s, 2 * radius - offset, 0);
             return Point(1 + (radius - offset) * std::sin(phi), radius - (radius - offset) * std::cos(phi), 0);
           });
  Problem problem(mesh, Kinematics::plane_strain, Strain::finite);
  problem.elastic("strip", 100, 0.3);
  problem.contact("strip_top", "strip_top", 0.2);
  problem.on("strip_left").fix = {0, 1};
  problem.on("strip_right").displacement = {{0, expression("0.004*t")}, {1, expression("-0.072*t")}};
  problem.options.loading.increments = 5;
  expect_as_alone(problem);
}

/// Cells of one law may be on one process alone, those of the other on the rest.
TEST_P(DistributedContact, PlasticOnElastic)
{
  Problem problem = dragged_block();
  problem.options.bodies[1].material.law = MaterialLaw::von_mises;
  problem.options.bodies[1].material.yield_stress = 0.05;
  problem.options.loading.increments = 2;
  expect_as_alone(problem);
}

/// Frames of faces turn in space; nodes come to faces that their process did not know.
Problem sliding_block_in_space()
{
  Blocks mesh(3);
  mesh.add("lower", {-1, -0.5, -0.4}, {3, 1, 0.4}, {12, 3, 2},
           [](const Point &x) { return Point(x[0], x[1], x[2] + (x[2] > -0.1 ? 0.02 * std::sin(2 * x[0]) : 0)); });
  mesh.add("upper", {-0.6, -0.3, 0.03}, {0.8, 0.55, 0.4}, {4, 3, 2});
  Problem problem(mesh, Kinematics::three_dimensional, Strain::finite);
  problem.elastic("lower", 1);
  problem.elastic("upper", 2, 0.2);
  problem.on("lower_bottom").fix = {0, 1, 2};
  problem.on("upper_top").displacement = {
      {0, expression("0.5 * t")}, {1, expression("0.05 * t")}, {2, expression("-0.08 * min(4*t, 1)")}};
  problem.contact("upper_bottom", "lower_top", 0.2);
  problem.options.loading.increments = 8;
  return problem;
}

TEST_P(DistributedContact, InSpaceFromFaceToFace)
{
  Problem problem = sliding_block_in_space();
  expect_as_alone(problem);
}

/// Finite strain, the upper block borne by contact alone while it is pushed along.
TEST_P(DistributedContact, ABodyThatOnlyContactHolds)
{
  Blocks mesh(2);
  mesh.add("lower", {-1, -1, 0}, {3, 1, 0}, {15, 4, 0});
  mesh.add("upper", {-0.5, 0.02, 0}, {1, 0.7, 0}, {6, 4, 0});
  Problem problem(mesh, Kinematics::plane_strain, Strain::finite);
  problem.elastic("lower", 10);
  problem.elastic("upper", 20, 0.2);
  problem.on("lower_bottom").fix = {0, 1};
  problem.on("upper_top").traction[1] = expression("-0.2");
  problem.on("upper_left").displacement[0] = expression("0.3 * t");
  problem.contact("upper_bottom", "lower_top");
  problem.options.loading.increments = 6;
  expect_as_alone(problem);
}

/// A block in a corner, one of its nodes in two contacts, pressed by a rigid lid that is an impactor.
TEST_P(DistributedContact, ACornerUnderARigidImpactor)
{
  Blocks mesh(2);
  mesh.add("floor", {-1, -1, 0}, {3, 1, 0}, {11, 4, 0});
  mesh.add("wall", {-0.5, -0.05, 0}, {0.5, 1.3, 0}, {2, 5, 0});
  mesh.add("box", {0, 0, 0}, {1, 1, 0}, {6, 6, 0});
  mesh.add("lid", {0.1, 1, 0}, {0.7, 0.2, 0}, {4, 1, 0});
  Problem problem(mesh, Kinematics::plane_strain);
  problem.elastic("floor", 10);
  problem.elastic("wall", 5);
  problem.elastic("box", 3, 0.2);
  problem.rigid("lid");
  problem.on("floor_bottom").fix = {0, 1};
  problem.on("wall_left").fix = {0, 1};
  problem.on("box_right").displacement[0] = expression("-0.02 * t");
  BoundaryOptions &lid = problem.on("lid");
  lid.displacement = {{0, expression(0)}, {1, expression("-0.03 * t")}};
  lid.rotation[2] = expression("-0.01 * t");
  problem.contact("box_bottom", "floor_top", 0.3);
  problem.contact("box_left", "wall_right", 0.1);
  problem.contact("lid_bottom", "box_top");
  problem.options.loading.increments = 3;
  expect_as_alone(problem);
}

/// Pairs that a failed attempt had changed are put back, whatever halo it asked for.
TEST_P(DistributedContact, IncrementsThatAreCut)
{
  Problem problem = sliding_block();
  problem.options.solver.max_iterations = 5;
  problem.options.loading.increments = 4;
  expect_as_alone(problem, true);
}

INSTANTIATE_TEST_SUITE_P(Solvers, DistributedContact,
                         testing::Values(Solver{"coupled", LinearSolverType::direct, MultiplierForm::coupled},
                                         Solver{"direct", LinearSolverType::direct, MultiplierForm::condensed}),
                         [](const auto &info) { return std::string(info.param.name); });

/// Surface to surface in finite strain, which the coupled form alone solves.
class DistributedMortar : public DistributedRun
{
};

TEST_P(DistributedMortar, OverManyFaces)
{
  Problem problem = sliding_block();
  problem.options.contact[0].discretization = Discretization::mortar;
  expect_as_alone(problem);
}

TEST_P(DistributedMortar, InSpace)
{
  Problem problem = sliding_block_in_space();
  problem.options.contact[0].discretization = Discretization::mortar;
  problem.options.loading.increments = 4;
  expect_as_alone(problem);
}

INSTANTIATE_TEST_SUITE_P(Solvers, DistributedMortar,
                         testing::Values(Solver{"coupled", LinearSolverType::automatic, MultiplierForm::automatic}),
                         [](const auto &info) { return std::string(info.param.name); });
} // namespace
} // namespace amontons::test
