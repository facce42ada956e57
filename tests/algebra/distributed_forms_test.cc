// On any number of processes. Every expectation holds on each of them.
#include "amontons/algebra/amg_solver.h"
#include "amontons/algebra/condensed_form.h"
#include "amontons/algebra/coupled_form.h"
#include "amontons/base/error.h"
#include "divided_problem.h"

/// Forms of a problem that is divided over the processes, against those of the whole on each process alone.
namespace amontons
{
namespace
{
using test::Deal;
using test::ElementBlocks;
using test::LatticeProblem;
using test::ProblemPart;
using test::Space;

/// K x over the displacement unknowns, of what subdomains are there.
std::vector<double> stiffness_times(const test::FormProblem &problem, std::span<const double> x)
{
  std::vector<double> nodal(static_cast<std::size_t>(problem.layout.n_nodal()), 0.0), forces(nodal);
  for (Index i = 0; i < problem.layout.n_nodal(); ++i)
    for (const Term &term : problem.layout.terms(i))
      nodal[i] += term.coefficient * x[term.unknown];
  for (const SubdomainMatrix &matrix : problem.subdomains)
    multiply_add(matrix, nodal, forces);
  std::vector<double> out(static_cast<std::size_t>(problem.layout.n_displacement_unknowns()), 0.0);
  problem.layout.gather(forces, out);
  return out;
}

class DividedProblem : public testing::TestWithParam<std::tuple<Space, Deal>>
{
protected:
  DividedProblem() { problem_.make_layout(); }
  [[nodiscard]] static Deal deal() { return std::get<1>(GetParam()); }

  LatticeProblem problem_{std::get<0>(GetParam())};
};

TEST_P(DividedProblem, PartsMakeTheWhole)
{
  const auto messages = std::make_shared<MessageExchange>(Communicator(MPI_COMM_WORLD));
  const ProblemPart part = test::Division(problem_, problem_.patterns, messages, deal()).take();
  const std::vector<double> x = problem_.random_rhs(), whole = stiffness_times(problem_, x);
  std::vector<double> forces = stiffness_times(part, part.of(x));
  part.layout.sharing().sum(forces);
  for (std::size_t i = 0; i < forces.size(); ++i)
    EXPECT_NEAR(forces[i], whole[part.unknowns[i]], 1e-12);
  EXPECT_EQ(part.layout.sharing().n_global(), problem_.layout.n_displacement_unknowns());
}

/// Each constraint once, by the owner of its impactor node and the node's unknowns.
TEST_P(DividedProblem, ConstraintsHaveOneGiver)
{
  const auto messages = std::make_shared<MessageExchange>(Communicator(MPI_COMM_WORLD));
  const ProblemPart part = test::Division(problem_, problem_.patterns, messages, deal()).take();
  std::vector<double> n_givers(problem_.patterns.size(), 0.0);
  for (std::size_t k = 0; k < part.patterns.size(); ++k)
  {
    const ConstraintPattern &pattern = part.patterns[k], &whole = problem_.patterns[part.whole_constraints[k]];
    ++n_givers[part.whole_constraints[k]];
    ASSERT_EQ(pattern.n_nodal(), whole.n_nodal());
    for (int a = 0; a < pattern.n_nodal(); ++a)
      EXPECT_EQ(part.nodes[pattern.nodal[a] / part.dim] * part.dim + pattern.nodal[a] % part.dim, whole.nodal[a]);
    for (int m = 0; m < pattern.n_multipliers; ++m)
      EXPECT_EQ(part.unknowns[part.layout.multiplier(pattern.multipliers[m])],
                problem_.layout.multiplier(whole.multipliers[m]));
    EXPECT_TRUE(part.nodes_sharing.is_own(pattern.nodal[0] / part.dim));
    for (int c = 0; c < part.dim; ++c)
      for (const Term &term : part.layout.terms(pattern.nodal[c]))
        EXPECT_TRUE(term.unknown < part.n_rigid || part.layout.sharing().is_own(term.unknown));
  }
  part.layout.sharing().sum_over_processes(n_givers);
  EXPECT_EQ(n_givers, std::vector<double>(problem_.patterns.size(), 1.0));
}

INSTANTIATE_TEST_SUITE_P(All, DividedProblem,
                         testing::Combine(testing::Values(Space::plane, Space::axisymmetric, Space::solid),
                                          testing::Values(Deal::even, Deal::in_turn, Deal::last_only)));

std::unique_ptr<SystemForm> coupled_direct(const test::FormProblem &problem)
{
  return std::make_unique<CoupledForm>(problem.layout, problem.subdomains, make_direct_solver());
}
std::unique_ptr<SystemForm> condensed_direct(const test::FormProblem &problem)
{
  return std::make_unique<CondensedForm>(problem.layout, problem.subdomains, make_direct_solver(), problem.points);
}
std::unique_ptr<SystemForm> condensed_multigrid(const test::FormProblem &problem)
{
  return std::make_unique<CondensedForm>(problem.layout, problem.subdomains, make_amg_solver(), problem.points);
}

struct Kind
{
  std::string name;
  std::unique_ptr<SystemForm> (*make)(const test::FormProblem &);
  double accuracy; ///< of a solution
  friend std::ostream &operator<<(std::ostream &out, const Kind &kind) { return out << kind.name; }
};
const Kind coupled{"coupled", coupled_direct, 1e-10}, condensed{"condensed", condensed_direct, 1e-10},
    multigrid{"multigrid", condensed_multigrid, 1e-8};

/// Against the coupled form of the whole, on each process alone.
class DividedForms : public testing::TestWithParam<std::tuple<Kind, Space, Deal>>
{
protected:
  [[nodiscard]] static const Kind &kind() { return std::get<0>(GetParam()); }
  void start(bool held = true)
  {
    problem_.make_layout(held);
    forms_ = std::make_unique<test::DividedForm>(problem_, std::get<2>(GetParam()), coupled_direct, kind().make);
  }
  void expect_same_step() { EXPECT_LT(forms_->difference(problem_.random_rhs(), 1e-13), kind().accuracy); }
  [[nodiscard]] std::size_t n() const { return problem_.patterns.size(); }

  LatticeProblem problem_{std::get<1>(GetParam())};
  std::unique_ptr<test::DividedForm> forms_;
};

/// Last the springs of the rigid body alone change.
TEST_P(DividedForms, EveryStatusAndChangedBodies)
{
  start();
  for (int round = 0; round < 5; ++round)
  {
    SCOPED_TRACE(round);
    for (std::size_t k = 0; k < n(); ++k)
      forms_->update_constraint(k, problem_.any_status(static_cast<int>(k) + round));
    if (round == 3)
    {
      for (std::size_t s = 0; s < problem_.subdomains.size(); ++s)
        for (double &value : problem_.subdomains[s].values)
          value *= 1 + 0.2 * static_cast<double>(s);
      forms_->take_bodies(problem_);
    }
    if (round == 4)
    {
      const Index n = forms_->part().n_rigid;
      forms_->update_rigid_springs(2 * Eigen::MatrixXd::Identity(n, n));
    }
    expect_same_step();
  }
  // In axisymmetry target nodes become slaves of an impactor on the axis; their pattern may have to grow for it.
  EXPECT_LE(forms_->divided().counters().n_pattern_builds, problem_.space() == Space::axisymmetric ? 2 : 1);
}

TEST_P(DividedForms, WithoutFrictionItIsSymmetric)
{
  start();
  for (std::size_t k = 0; k < n(); ++k)
    forms_->update_constraint(k, k % 3 == 0   ? problem_.make.stick()
                                 : k % 3 == 1 ? problem_.make.frictionless()
                                              : problem_.make.open());
  expect_same_step();
  for (int times = 0; times < 2; ++times) // nothing new: from what is kept
    expect_same_step();
}

TEST_P(DividedForms, ImpactorsThatAreTargetsAndRigidOnes)
{
  problem_.entangle();
  start();
  for (int round = 0; round < 4; ++round)
  {
    SCOPED_TRACE(round);
    for (std::size_t k = 0; k < n(); ++k)
      // In axisymmetry the rigid body moves along the axis only: it cannot stick to two.
      forms_->update_constraint(k, (k + round) % 4 == 0   ? problem_.make.frictionless()
                                   : (k + round) % 4 == 1 ? problem_.make.open()
                                   : (k + round) % 4 == 2 ? problem_.make.slip(0.3, 0.5)
                                   : k == 0               ? problem_.make.stick()
                                                          : problem_.make.frictionless());
    expect_same_step();
  }
}

TEST_P(DividedForms, OtherPairs)
{
  start();
  for (const int shift : {0, 1, 3})
  {
    std::vector<ConstraintPattern> patterns = problem_.patterns;
    for (std::size_t k = 0; k < n(); ++k)
    {
      const auto &from = problem_.patterns[(k + shift) % n()].nodal;
      std::copy(from.begin() + problem_.dim, from.end(), patterns[k].nodal.begin() + problem_.dim);
    }
    forms_->set_constraints(patterns);
    for (std::size_t k = 0; k < n(); ++k)
      forms_->update_constraint(k, problem_.any_status(static_cast<int>(k) + 1));
    expect_same_step();
  }
}

/// Blocks without symmetry on the contacts.
TEST_P(DividedForms, GeometricStiffness)
{
  start();
  for (std::size_t k = 0; k < n(); ++k)
  {
    ElementBlocks element = problem_.any_status(static_cast<int>(k));
    element.stiffness += 0.1 * problem_.make.numbers(problem_.make.n(), problem_.make.n());
    forms_->update_constraint(k, element);
  }
  expect_same_step();
}

/// The upper lattice floats: its motions are held in the mean. Then contacts hold it.
TEST_P(DividedForms, HeldModes)
{
  start(false);
  forms_->set_held_modes(problem_.upper_motions());
  for (const bool closed : {false, true})
  {
    for (std::size_t k = 0; k < n(); ++k)
      forms_->update_constraint(k, closed ? problem_.any_status(static_cast<int>(k)) : problem_.make.open());
    expect_same_step();
  }
}

TEST_P(DividedForms, FailsOnAllAndGoesOn)
{
  start(false);
  for (std::size_t k = 0; k < n(); ++k)
    forms_->update_constraint(k, problem_.make.open());
  EXPECT_THROW(forms_->solve_divided(problem_.random_rhs(), 1e-13), NumericalFailure);
  for (std::size_t k = 0; k < n(); ++k)
    forms_->update_constraint(k, problem_.make.stick());
  expect_same_step();
}

/// What one process alone is given.
TEST(CondensedOverProcesses, ValuesWithoutProperRowsFailOnAllUntilBetterOnesCome)
{
  LatticeProblem problem(Space::plane);
  problem.make_layout();
  test::DividedForm forms(problem, Deal::apart, coupled_direct, condensed_direct);
  for (std::size_t k = 0; k < problem.patterns.size(); ++k)
    forms.update_constraint(k, problem.make.stick());
  ElementBlocks broken = problem.make.stick();
  broken.stiffness(0, 0) = broken.force_by_multiplier(0, 0) = std::nan("");
  forms.update_constraint(0, broken);
  for (int times = 0; times < 2; ++times)
    EXPECT_THROW(forms.divided().factorize(), NumericalFailure);
  forms.update_constraint(0, problem.make.stick());
  EXPECT_LT(forms.difference(problem.random_rhs(), 1e-13), condensed.accuracy);
}

std::string name_of(Space space)
{
  return space == Space::plane ? "plane" : space == Space::axisymmetric ? "axisymmetric" : "solid";
}
std::string name_of(Deal deal)
{
  return deal == Deal::even ? "even" : deal == Deal::in_turn ? "in_turn" : deal == Deal::apart ? "apart" : "last_only";
}
std::string name_of(const testing::TestParamInfo<DividedForms::ParamType> &info)
{
  const auto &[kind, space, deal] = info.param;
  return kind.name + "_" + name_of(space) + "_" + name_of(deal);
}

using testing::Combine;
using testing::Values;
constexpr auto named = [](const auto &info) { return name_of(info); };
INSTANTIATE_TEST_SUITE_P(Direct, DividedForms,
                         Combine(Values(coupled, condensed), Values(Space::plane, Space::solid), Values(Deal::even)),
                         named);
INSTANTIATE_TEST_SUITE_P(Axisymmetric, DividedForms,
                         Combine(Values(coupled, condensed), Values(Space::axisymmetric),
                                 Values(Deal::in_turn, Deal::apart)),
                         named);
INSTANTIATE_TEST_SUITE_P(Apart, DividedForms,
                         Combine(Values(coupled, condensed, multigrid), Values(Space::plane, Space::solid),
                                 Values(Deal::apart)),
                         named);
INSTANTIATE_TEST_SUITE_P(EmptyParts, DividedForms,
                         Combine(Values(coupled, condensed, multigrid), Values(Space::plane), Values(Deal::last_only)),
                         named);
INSTANTIATE_TEST_SUITE_P(Multigrid, DividedForms,
                         Combine(Values(multigrid), Values(Space::solid), Values(Deal::in_turn)), named);
} // namespace
} // namespace amontons
