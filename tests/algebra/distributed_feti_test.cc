// On any number of processes. Every expectation holds on each of them.
#include "amontons/algebra/coupled_form.h"
#include "amontons/algebra/feti_form.h"
#include "amontons/algebra/linear_solver_failure.h"
#include "divided_problem.h"

/// Total FETI over processes against FETI of the whole, and the direct solution of the coupled form, on each alone.
namespace amontons
{
namespace
{
using test::Deal;
using test::DividedForm;
using test::FormProblem;
using test::LatticeProblem;
using test::Space;

std::unique_ptr<SystemForm> make_coupled(const FormProblem &problem)
{
  return std::make_unique<CoupledForm>(problem.layout, problem.subdomains, make_direct_solver());
}

class DistributedFeti : public testing::TestWithParam<std::tuple<Space, Deal>>
{
protected:
  [[nodiscard]] DividedForm divide(const DividedForm::Maker &reference) const
  {
    return {problem_, std::get<1>(GetParam()), reference, feti()};
  }
  [[nodiscard]] DividedForm::Maker feti() const
  {
    return [this](const FormProblem &problem)
    {
      FetiOptions options;
      options.points = problem.points;
      options.axisymmetric = problem_.space() == Space::axisymmetric;
      if (contact_is_known_)
        options.contact_nodes = problem.contact_nodes;
      options.lumped = lumped_;
      options.nodes = problem.nodes_sharing;
      return std::make_unique<FetiForm>(problem.layout, problem.subdomains, std::move(options));
    };
  }
  void update_all(DividedForm &forms, int round)
  {
    for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
      forms.update_constraint(k, problem_.any_status(static_cast<int>(k) + round));
  }
  /// Over the processes.
  [[nodiscard]] static std::int64_t n_factorizations(DividedForm &forms)
  {
    auto n = static_cast<double>(forms.divided().counters().n_factorizations);
    forms.part().layout.sharing().sum_over_processes({&n, 1});
    return static_cast<std::int64_t>(n);
  }
  void expect_equal_iterations(DividedForm &forms)
  {
    const auto n = static_cast<double>(forms.divided().counters().n_iterations);
    EXPECT_NEAR(n, static_cast<double>(forms.reference().counters().n_iterations), 1);
    EXPECT_EQ(forms.part().layout.sharing().maximum_over_processes(n), n);
  }

  LatticeProblem problem_{std::get<0>(GetParam())};
  bool lumped_ = false, contact_is_known_ = true;
};

TEST_P(DistributedFeti, SolvesEveryStatusWithoutFactorisingAgain)
{
  problem_.make_layout();
  DividedForm forms = divide(make_coupled);
  for (int round = 0; round < 4; ++round)
  {
    SCOPED_TRACE(round);
    update_all(forms, round);
    EXPECT_LT(forms.difference(problem_.random_rhs(), 1e-12), 1e-9);
  }
  EXPECT_EQ(n_factorizations(forms), static_cast<std::int64_t>(problem_.subdomains.size()));
  EXPECT_EQ(forms.divided().counters().n_pattern_builds, 1);
  EXPECT_EQ(forms.divided().counters().n_preconditioner_setups, 4);
}

TEST_P(DistributedFeti, IteratesAsOneProcess)
{
  problem_.make_layout();
  for (const bool slips : {false, true})
  {
    DividedForm forms = divide(feti());
    for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
      forms.update_constraint(k, slips && k % 2 ? problem_.make.slip(0.3, 0.4) : problem_.make.stick());
    EXPECT_LT(forms.difference(problem_.random_rhs(), 1e-8), 1e-6);
    expect_equal_iterations(forms);
  }
}

TEST_P(DistributedFeti, ImpactorsThatAreTargetsAndRigidOnes)
{
  problem_.entangle();
  problem_.make_layout();
  for (const bool with_feti : {false, true})
  {
    DividedForm forms = divide(with_feti ? feti() : make_coupled);
    for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
      forms.update_constraint(k, k == 0       ? problem_.make.stick()
                                 : k % 3 == 1 ? problem_.make.slip(0.3, 0.5)
                                              : problem_.make.frictionless());
    EXPECT_LT(forms.difference(problem_.random_rhs(), 1e-12), 1e-9);
    if (with_feti)
      expect_equal_iterations(forms);
  }
}

TEST_P(DistributedFeti, LumpedPreconditioner)
{
  lumped_ = true;
  problem_.make_layout();
  DividedForm forms = divide(feti());
  update_all(forms, 0);
  EXPECT_LT(forms.difference(problem_.random_rhs(), 1e-12), 1e-9);
  expect_equal_iterations(forms);
}

TEST_P(DistributedFeti, TakesNewStiffnessAndNewContactNodes)
{
  contact_is_known_ = false;
  problem_.make_layout();
  DividedForm forms = divide(make_coupled);
  for (const double factor : {1., 2.5})
  {
    for (SubdomainMatrix &matrix : problem_.subdomains)
      for (double &value : matrix.values)
        value *= factor;
    forms.take_bodies(problem_);
    update_all(forms, 0);
    EXPECT_LT(forms.difference(problem_.random_rhs(), 1e-12), 1e-9);
  }
  EXPECT_EQ(n_factorizations(forms), 2 * static_cast<std::int64_t>(problem_.subdomains.size()));
}

/// With its contacts open the upper lattice floats, loaded or not.
TEST_P(DistributedFeti, HoldsMotionsThatNothingElseHolds)
{
  problem_.make_layout(false);
  DividedForm forms = divide(make_coupled);
  forms.set_held_modes(problem_.upper_motions());
  for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
    forms.update_constraint(k, problem_.make.open());
  EXPECT_LT(forms.difference(problem_.random_rhs(), 1e-12), 1e-9);
}

/// The same held where nothing is free.
TEST_P(DistributedFeti, HoldsMotionsBesides)
{
  problem_.make_layout(true);
  DividedForm forms = divide(make_coupled);
  forms.set_held_modes(problem_.upper_motions());
  update_all(forms, 1);
  EXPECT_LT(forms.difference(problem_.random_rhs(), 1e-12), 1e-9);
}

TEST_P(DistributedFeti, FreeMotionIsNamedOnAll)
{
  problem_.make_layout(false);
  DividedForm forms = divide(feti());
  for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
    forms.update_constraint(k, problem_.make.open());
  EXPECT_THROW(forms.divided().factorize(), NumericalFailure);
}

/// Where one process cannot factorise, all say the same.
TEST_P(DistributedFeti, FailureOfOneSubdomainIsThatOfAll)
{
  problem_.make_layout();
  DividedForm forms = divide(feti());
  update_all(forms, 0);
  auto &subdomains = forms.part().subdomains;
  const Sharing &sharing = forms.part().layout.sharing();
  const bool has_one = !subdomains.empty();
  const double lowest = -sharing.maximum_over_processes(has_one ? -sharing.rank() : -HUGE_VAL);
  if (sharing.rank() == lowest)
    for (double &value : subdomains[0].values)
      value = -value;
  EXPECT_THROW(forms.divided().factorize(), LinearSolverFailure);
}

/// Two exchanges with each neighbour and five reductions an iteration, and not many more a round of it, of which there
/// are as many as reductions of loads. Contact rows take two exchanges and those of their scaling, of a degree that is
/// below ten here.
TEST_P(DistributedFeti, TrafficOfAnIteration)
{
  problem_.make_layout();
  DividedForm forms = divide(feti());
  for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
    forms.update_constraint(k, problem_.make.stick());
  const auto &messages = forms.part().layout.sharing().messages();
  if (!messages)
    return;
  forms.divided().factorize();
  messages->forget_traffic();
  std::vector<double> solution(forms.part().unknowns.size());
  forms.divided().solve(forms.part().of(problem_.random_rhs()), solution, 1e-10);
  const std::int64_t n_iterations = forms.divided().counters().n_iterations;
  const std::int64_t n_rounds = messages->traffic().at("feti_setup").reductions;
  const Traffic &traffic = messages->traffic().at("feti");
  EXPECT_GE(n_iterations, 5);
  const std::int64_t n_others = messages->communicator().size() - 1;
  EXPECT_LE(traffic.reductions, 5 * (n_iterations + n_rounds));
  EXPECT_LE(traffic.messages, (2 * n_iterations + 3 * n_rounds) * n_others);
  EXPECT_LE(messages->traffic().at("feti_contact").messages, 20 * (n_iterations + 2 * n_rounds) * n_others);
}

using testing::Values;
INSTANTIATE_TEST_SUITE_P(Plane, DistributedFeti,
                         testing::Combine(Values(Space::plane),
                                          Values(Deal::even, Deal::in_turn, Deal::apart, Deal::last_only)));
INSTANTIATE_TEST_SUITE_P(Axisymmetric, DistributedFeti,
                         testing::Combine(Values(Space::axisymmetric), Values(Deal::in_turn)));
INSTANTIATE_TEST_SUITE_P(Solid, DistributedFeti,
                         testing::Combine(Values(Space::solid), Values(Deal::even, Deal::apart)));
} // namespace
} // namespace amontons
