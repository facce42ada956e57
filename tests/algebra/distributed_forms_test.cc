// On any number of processes. Every expectation holds on each of them.
#include "divided_problem.h"

/// Forms of a problem that is divided over the processes, against those of the whole on each process alone.
namespace amontons
{
namespace
{
using test::Deal;
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
  const ProblemPart part = test::Division(problem_, messages, deal()).take();
  const std::vector<double> x = problem_.random_rhs(), whole = stiffness_times(problem_, x);
  std::vector<double> forces = stiffness_times(part, part.of(x));
  part.layout.sharing().sum(forces);
  for (std::size_t i = 0; i < forces.size(); ++i)
    EXPECT_NEAR(forces[i], whole[part.unknowns[i]], 1e-12);
  EXPECT_EQ(part.layout.sharing().n_global(), problem_.layout.n_displacement_unknowns());
  for (std::size_t k = 0; k < problem_.patterns.size(); ++k)
    for (int a = 0; a < problem_.patterns[k].n_nodal(); ++a)
      EXPECT_EQ(part.nodes[part.patterns[k].nodal[a] / part.dim], problem_.patterns[k].nodal[a] / part.dim);
}

INSTANTIATE_TEST_SUITE_P(All, DividedProblem,
                         testing::Combine(testing::Values(Space::plane, Space::axisymmetric, Space::solid),
                                          testing::Values(Deal::even, Deal::in_turn, Deal::last_only)));
} // namespace
} // namespace amontons
