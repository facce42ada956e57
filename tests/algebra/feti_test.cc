#include "amontons/algebra/coupled_form.h"
#include "amontons/algebra/feti_form.h"
#include "amontons/base/error.h"
#include "lattice_problem.h"

#include <gtest/gtest.h>

/// Total FETI against the direct solution of the coupled form.
namespace amontons
{
namespace
{
using test::ElementBlocks;
using test::LatticeProblem;
using test::Space;

class FetiTest : public testing::TestWithParam<Space>
{
protected:
  FetiTest()
  {
    options_.points = problem_.points;
    options_.axisymmetric = GetParam() == Space::axisymmetric;
    options_.contact_nodes = problem_.contact_nodes;
  }

  void start(bool held = true)
  {
    problem_.make_layout(held);
    feti_ = std::make_unique<FetiForm>(problem_.layout, problem_.subdomains, options_);
    coupled_ = std::make_unique<CoupledForm>(problem_.layout, problem_.subdomains, make_direct_solver());
    for (SystemForm *form : forms())
    {
      form->set_constraints(problem_.patterns, {});
      form->prepare();
      form->update_subdomains();
    }
  }
  [[nodiscard]] std::array<SystemForm *, 2> forms() const { return {feti_.get(), coupled_.get()}; }

  void update(std::size_t k, const ElementBlocks &blocks)
  {
    for (SystemForm *form : forms())
      form->update_constraint(k, blocks.values());
  }

  /// The difference of the two forms' solutions, over the solution.
  double difference(const std::vector<double> &rhs)
  {
    std::vector<Eigen::VectorXd> x;
    for (SystemForm *form : forms())
    {
      x.emplace_back(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rhs.size())));
      form->prepare();
      form->factorize();
      form->solve(rhs, {x.back().data(), rhs.size()}, 1e-12);
    }
    return (x[0] - x[1]).norm() / x[1].norm();
  }

  LatticeProblem problem_{GetParam()};
  FetiOptions options_;
  std::unique_ptr<FetiForm> feti_;
  std::unique_ptr<CoupledForm> coupled_;
};

TEST_P(FetiTest, SolvesEveryStatusWithoutFactorisingAgain)
{
  start();
  const auto n_subdomains = static_cast<std::int64_t>(problem_.subdomains.size());
  for (int round = 0; round < 4; ++round)
  {
    SCOPED_TRACE(round);
    for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
      update(k, problem_.any_status(static_cast<int>(k) + round));
    EXPECT_LT(difference(problem_.random_rhs()), 1e-9);
  }
  EXPECT_EQ(feti_->counters().n_factorizations, n_subdomains);
  EXPECT_EQ(feti_->counters().n_pattern_builds, 1);
}

TEST_P(FetiTest, LumpedPreconditioner)
{
  options_.lumped = true;
  start();
  for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
    update(k, k % 2 ? problem_.make.stick() : problem_.make.frictionless());
  EXPECT_LT(difference(problem_.random_rhs()), 1e-9);
}

TEST_P(FetiTest, DirectionsOfFormerSolvesServeAgain)
{
  start();
  for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
    update(k, problem_.make.stick());
  const std::vector<double> rhs = problem_.random_rhs();
  EXPECT_LT(difference(rhs), 1e-9);
  const std::int64_t first = feti_->counters().n_iterations;
  EXPECT_LT(difference(rhs), 1e-9);
  EXPECT_LE(3 * (feti_->counters().n_iterations - first), 2 * first);
  EXPECT_EQ(feti_->counters().n_preconditioner_setups, 1);
}

/// With its contacts open the upper lattice floats: its motions are held in the mean, loaded or not.
TEST_P(FetiTest, HoldsMotionsThatNothingElseHolds)
{
  start(false);
  for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
    update(k, problem_.make.open());
  const std::vector<std::vector<double>> modes = problem_.upper_motions();
  for (SystemForm *form : forms())
    EXPECT_TRUE(form->set_held_modes(modes));
  coupled_->prepare();
  coupled_->update_subdomains();
  for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
    update(k, problem_.make.open());
  EXPECT_LT(difference(problem_.random_rhs()), 1e-9);
  for (std::size_t m = 0; m < modes.size(); ++m)
    EXPECT_NEAR(feti_->mode_reactions()[m], coupled_->mode_reactions()[m],
                1e-8 * std::abs(coupled_->mode_reactions()[0]));
}

TEST_P(FetiTest, FreeMotionIsNamed)
{
  start(false);
  for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
    feti_->update_constraint(k, problem_.make.open().values());
  EXPECT_THROW(feti_->factorize(), NumericalFailure);
}

/// Springs between a subdomain and the ground take its kernel away.
TEST_P(FetiTest, SpringsHoldSubdomains)
{
  SubdomainMatrix &last = problem_.subdomains.back();
  for (Index i = 0; i < last.n_rows(); ++i)
    last.values[last.row_ptr[i] + i] += 0.1;
  start(false);
  for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
    update(k, problem_.make.open());
  EXPECT_LT(difference(problem_.random_rhs()), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, FetiTest, testing::Values(Space::plane, Space::axisymmetric, Space::solid),
                         [](const auto &info) {
                           return info.param == Space::plane          ? "plane"
                                  : info.param == Space::axisymmetric ? "axisymmetric"
                                                                      : "solid";
                         });
} // namespace
} // namespace amontons
