#include "curved_slider.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>
#include <sstream>

/// Plastic bodies in whole runs.
namespace amontons::test
{
namespace
{
constexpr double yield = 1e-3;

void make_plastic(BodyOptions &body, double isotropic, double kinematic)
{
  body.material.law = MaterialLaw::von_mises;
  body.material.yield_stress = yield;
  body.material.isotropic_hardening = isotropic;
  body.material.kinematic_hardening = kinematic;
}

/// A curved elastic slider pressed into a plastic base so that part of the base yields.
Problem pressed(int dim, int n, double mu, const std::string &approach)
{
  Problem problem = curved_slider(dim, n, mu);
  make_plastic(problem.options.bodies[0], 0.05, 0.05);
  BoundaryOptions &top = problem.on("slider_top");
  top.displacement = {{0, expression("0")}, {dim - 1, expression(approach)}};
  if (dim == 3)
    top.displacement[1] = expression("0");
  return problem;
}

double largest(const std::vector<double> &values)
{
  return *std::max_element(values.begin(), values.end());
}

TEST(Plasticity, EveryFormGivesTheSame)
{
  for (const int dim : {2, 3})
    for (const double mu : {0.0, 0.3})
    {
      Problem problem = pressed(dim, dim == 2 ? 12 : 4, mu, "-0.02*sin(2*t)");
      problem.options.loading.increments = 4; // the last ones unload
      problem.options.loading.fixed = true;
      problem.options.solver.tolerance = 1e-10;
      problem.options.solver.linear = LinearSolverType::direct;
      const Record direct = problem.converge();
      EXPECT_GT(largest(direct.state().plastic_strain), yield);
      problem.options.solver.multipliers = MultiplierForm::coupled;
      std::vector<Record> others{problem.converge()};
      problem.options.solver.multipliers = MultiplierForm::condensed;
      for (const LinearSolverType linear : {LinearSolverType::amg, LinearSolverType::feti})
      {
        problem.options.solver.linear = linear;
        others.push_back(problem.converge());
      }
      for (const Record &other : others)
      {
        EXPECT_LT(relative_difference(other.state().displacement, direct.state().displacement), 1e-8);
        EXPECT_LT(relative_difference(other.state().plastic_strain, direct.state().plastic_strain), 1e-7);
      }
    }
}

TEST(Plasticity, BodiesAreAssembledAtEachIterationAndElasticOnesStayElastic)
{
  const Record run = pressed(2, 12, 0, "-0.02*t").converge();
  EXPECT_GT(run.counters.n_newton_iterations, 2);
  EXPECT_GT(run.counters.n_bulk_assemblies, run.counters.n_newton_iterations);
  EXPECT_EQ(run.counters.n_pattern_builds, 1);
  const auto strain_in = [&](const std::string &group)
  {
    double most = 0;
    for (const Index cell : run.mesh.groups.at(group).cells)
      most = std::max(most, run.state().plastic_strain[cell]);
    return most;
  };
  EXPECT_GT(strain_in("base"), yield);
  EXPECT_EQ(strain_in("slider"), 0);
  EXPECT_TRUE(std::all_of(run.states.front().plastic_strain.begin(), run.states.front().plastic_strain.end(),
                          [](double p) { return p == 0; }));

  Problem elastic = pressed(2, 12, 0, "-0.02*t");
  elastic.options.bodies[0].material.law = MaterialLaw::linear_elastic;
  const Record other = elastic.converge();
  EXPECT_EQ(other.counters.n_bulk_assemblies, 1);
  EXPECT_TRUE(other.state().plastic_strain.empty());
}

/// Once the plastic zone stands the residual of an iteration goes like the square of the last one's.
TEST(Plasticity, NewtonConvergesQuadratically)
{
  for (const int dim : {2, 3})
  {
    Blocks blocks(dim);
    blocks.add("base", {0, 0, 0}, Point::Ones(), dim == 2 ? std::array{12, 12, 0} : std::array{4, 4, 4});
    Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional);
    make_plastic(problem.elastic("base"), 0.02, 0.02);
    problem.on("base_bottom").fix = dim == 2 ? std::vector{0, 1} : std::vector{0, 1, 2};
    BoundaryOptions &top = problem.on("base_top");
    top.displacement = {{0, expression("0.01*t")}, {dim - 1, expression("-0.02*t")}};
    if (dim == 3)
      top.displacement[1] = expression("0");
    problem.options.loading.fixed = true;
    problem.options.solver.tolerance = 1e-12;
    problem.options.solver.linear = LinearSolverType::direct;
    const Record run = problem.converge();
    std::vector<double> residuals;
    for (const IterationReport &iteration : run.attempts.front().iterations)
      if (iteration.residual > 1e-13) // below is round-off
        residuals.push_back(iteration.residual);
    ASSERT_GE(residuals.size(), 4u);
    const auto last = residuals.end() - 1;
    const double order = std::log(last[0] / last[-1]) / std::log(last[-1] / last[-2]);
    EXPECT_GT(order, 1.8) << testing::PrintToString(residuals);
  }
}

/// The increments that converged after cuts, asked for from the start, give the same: an attempt that failed leaves no
/// plastic strain behind.
TEST(Plasticity, AnIncrementThatWasCutLeavesNoTrace)
{
  Problem cut = pressed(2, 12, 0, "-0.03*sin(2.5*t)");
  cut.options.loading.increments = 2;
  cut.options.solver.max_iterations = 5;
  cut.options.solver.tolerance = 1e-11;
  const Record first = cut.converge();
  EXPECT_TRUE(std::any_of(first.attempts.begin(), first.attempts.end(), [](const Attempt &a) { return !a.converged; }));

  std::ostringstream approach; // -0.03 sin(2.5 t_k) at t = k, linear between
  approach.precision(17);
  const auto value = [&](std::size_t k) { return -0.03 * std::sin(2.5 * first.states[k].time); };
  const std::size_t n = first.states.size() - 1;
  for (std::size_t k = 1; k <= n; ++k)
    approach << (k < n ? "(t <= " + std::to_string(k) + ") ? (" : "(") << value(k - 1) << " + (t - " << k - 1 << ")*("
             << value(k) - value(k - 1) << "))" << (k < n ? " : " : "");
  Problem asked = pressed(2, 12, 0, approach.str());
  asked.options.loading.end = static_cast<double>(n);
  asked.options.loading.increments = static_cast<int>(n);
  asked.options.loading.fixed = true;
  asked.options.solver.tolerance = 1e-11;
  const Record second = asked.converge();
  ASSERT_EQ(second.states.size(), first.states.size());
  EXPECT_LT(relative_difference(first.state().displacement, second.state().displacement), 1e-9);
  EXPECT_LT(relative_difference(first.state().plastic_strain, second.state().plastic_strain), 1e-8);
}
} // namespace
} // namespace amontons::test
