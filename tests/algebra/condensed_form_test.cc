#include "amontons/algebra/amg_solver.h"
#include "amontons/algebra/condensed_form.h"
#include "amontons/algebra/coupled_form.h"
#include "amontons/base/error.h"
#include "element_blocks.h"

#include <gtest/gtest.h>

/// The condensed form against the coupled one on random systems: every status, whatever shares whose nodes.
namespace amontons
{
namespace
{
using test::ElementBlocks;

/// Nodes 0 .. n-1, of which the last two are a rigid body that moves and turns (its unknowns come first), and the third
/// component of node 1 is held.
class CondensedFormTest : public testing::TestWithParam<int>
{
protected:
  static constexpr int n_nodes = 14;
  [[nodiscard]] int dim() const { return GetParam(); }
  [[nodiscard]] int face_size() const { return dim() == 2 ? 2 : 4; }
  [[nodiscard]] int n_rigid() const { return dim() + 1; }

  Layout make_layout()
  {
    std::vector<Index> offsets{0};
    std::vector<Term> terms;
    Index next = n_rigid();
    for (int node = 0; node < n_nodes; ++node)
      for (int c = 0; c < dim(); ++c)
      {
        if (node >= n_nodes - 2)
        {
          terms.push_back({c, 1});
          terms.push_back({dim(), make_.number()});
        }
        else if (node != 1 || c != dim() - 1)
          terms.push_back({next++, 1});
        offsets.push_back(static_cast<Index>(terms.size()));
      }
    return {next, n_constraints * dim(), offsets, terms};
  }

  /// Symmetric and positive definite.
  SubdomainMatrix make_body()
  {
    SubdomainMatrix out;
    out.n_components = dim();
    for (Index node = 0; node < n_nodes - 2; ++node)
      out.nodes.push_back(node);
    const Index n = (n_nodes - 2) * dim();
    const Eigen::MatrixXd a = make_.numbers(n, n), k = a * a.transpose() + Eigen::MatrixXd::Identity(n, n);
    out.row_ptr.push_back(0);
    for (Index i = 0; i < n; ++i)
    {
      for (Index j = 0; j < n; ++j)
      {
        out.col.push_back(j);
        out.values.push_back(k(i, j));
      }
      out.row_ptr.push_back(static_cast<Index>(out.col.size()));
    }
    return out;
  }

  [[nodiscard]] ConstraintPattern pattern(const std::vector<Index> &nodes, Index position) const
  {
    ConstraintPattern out;
    for (const Index node : nodes)
      for (int c = 0; c < dim(); ++c)
        out.nodal.push_back(node * dim() + c);
    for (int m = 0; m < dim(); ++m)
      out.multipliers[out.n_multipliers++] = position * dim() + m;
    return out;
  }
  /// An impactor node and a face of the nodes from `first` on.
  [[nodiscard]] ConstraintPattern pair(Index impactor, Index first, Index position) const
  {
    std::vector<Index> nodes{impactor};
    for (int k = 0; k < face_size(); ++k)
      nodes.push_back(first + k);
    return pattern(nodes, position);
  }

  void set_constraints(const std::vector<ConstraintPattern> &patterns)
  {
    for (SystemForm *form : forms())
    {
      form->set_constraints(patterns, {rigid_unknowns()});
      EXPECT_TRUE(form->prepare());
      form->update_subdomains();
    }
    update_rigid_block();
  }
  [[nodiscard]] std::vector<Index> rigid_unknowns() const
  {
    std::vector<Index> out;
    for (Index i = 0; i < n_rigid(); ++i)
      out.push_back(i);
    return out;
  }
  void update_rigid_block()
  {
    const Eigen::MatrixXd springs =
        Eigen::MatrixXd::Constant(n_rigid(), n_rigid(), 0.3) + 5 * Eigen::MatrixXd::Identity(n_rigid(), n_rigid());
    for (SystemForm *form : forms())
      form->update_dense_block(0, springs);
  }

  /// Gives both forms the same elements and a right side, and compares their solutions.
  void expect_same_step(const std::vector<ElementBlocks> &elements)
  {
    const Eigen::VectorXd rhs = make_.numbers(layout_.n_unknowns(), 1);
    std::array<Eigen::VectorXd, 2> x;
    for (int f = 0; f < 2; ++f)
    {
      SystemForm &form = *forms()[f];
      for (std::size_t k = 0; k < elements.size(); ++k)
        form.update_constraint(k, elements[k].values());
      form.factorize();
      x[f] = Eigen::VectorXd::Zero(rhs.size());
      form.solve({rhs.data(), static_cast<std::size_t>(rhs.size())},
                 {x[f].data(), static_cast<std::size_t>(rhs.size())}, 1e-14);
    }
    EXPECT_LT((x[0] - x[1]).norm(), 1e-9 * x[0].norm());
    const auto a = coupled_->mode_reactions(), b = condensed_->mode_reactions();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t m = 0; m < a.size(); ++m)
      EXPECT_NEAR(a[m], b[m], 1e-9 * x[0].norm());
  }

  std::array<SystemForm *, 2> forms() { return {coupled_.get(), condensed_.get()}; }
  ElementBlocks any_status(int k)
  {
    return k % 4 == 0   ? make_.stick()
           : k % 4 == 1 ? make_.slip(0.4, 0.6)
           : k % 4 == 2 ? make_.open()
                        : make_.frictionless();
  }

  static constexpr Index n_constraints = 4;
  test::ElementMaker make_{GetParam(), GetParam() == 2 ? 3 : 5, 5};
  Layout layout_ = make_layout();
  std::vector<SubdomainMatrix> bodies_{make_body()};
  std::unique_ptr<CoupledForm> coupled_ = std::make_unique<CoupledForm>(layout_, bodies_, make_direct_solver());
  std::vector<double> reference_;
  std::unique_ptr<CondensedForm> condensed_ =
      std::make_unique<CondensedForm>(layout_, bodies_, make_direct_solver(), reference_);
};

TEST_P(CondensedFormTest, StatusesChangeAndThePatternStands)
{
  set_constraints({pair(0, 4, 0), pair(1, 5, 1), pair(2, 6, 2), pair(3, 7, 3)});
  for (int round = 0; round < 6; ++round)
  {
    std::vector<ElementBlocks> elements;
    for (int k = 0; k < n_constraints; ++k)
      elements.push_back(k == 1 ? make_.open() : any_status(round + k));
    expect_same_step(elements);
  }
  EXPECT_EQ(condensed_->counters().n_pattern_builds, 1);
}

TEST_P(CondensedFormTest, NothingNewIsNotFactorisedAgain)
{
  set_constraints({pair(0, 4, 0), pair(2, 6, 1), pair(3, 7, 2), pair(8, 4, 3)});
  const std::vector<ElementBlocks> elements{make_.stick(), make_.frictionless(), make_.open(), make_.open()};
  for (int round = 0; round < 3; ++round)
    expect_same_step(elements);
  EXPECT_EQ(condensed_->counters().n_factorizations, 1);
}

/// Node 0 on a face with node 4, which is itself an impactor on a face with node 8; and in a circle.
TEST_P(CondensedFormTest, ImpactorsThatAreTargetsToo)
{
  set_constraints({pair(0, 4, 0), pair(4, 8, 1), pair(8, 0, 2), pair(9, 1, 3)});
  expect_same_step({make_.stick(), make_.slip(0.3, 0.5), make_.open(), make_.open()});
  expect_same_step({make_.frictionless(), make_.frictionless(), make_.slip(0.3, 0.5), make_.frictionless()});
  expect_same_step({make_.open(), make_.stick(), make_.frictionless(), make_.open()});
}

TEST_P(CondensedFormTest, TwoContactsOnOneNode)
{
  set_constraints({pair(0, 4, 0), pair(0, 8, 1), pair(2, 6, 2), pair(3, 7, 3)});
  expect_same_step({make_.frictionless(), make_.slip(0.3, 0.5), make_.stick(), make_.open()});
}

/// A face of the rigid body; the rigid body itself as the impactor; an impactor node with a held component.
TEST_P(CondensedFormTest, RigidBodiesAndHeldNodes)
{
  set_constraints({pair(0, n_nodes - face_size(), 0), pair(n_nodes - 1, 4, 1), pair(1, 8, 2), pair(n_nodes - 2, 4, 3)});
  expect_same_step({make_.stick(), make_.frictionless(), make_.frictionless(), make_.open()});
  expect_same_step({make_.slip(0.2, 0.7), make_.slip(0.2, 0.7), make_.frictionless(), make_.frictionless()});
}

TEST_P(CondensedFormTest, GeometricStiffness)
{
  set_constraints({pair(0, 4, 0), pair(4, 8, 1), pair(2, 6, 2), pair(3, 7, 3)});
  std::vector<ElementBlocks> elements{make_.stick(), make_.slip(0.3, 0.5), make_.frictionless(), make_.stick()};
  for (ElementBlocks &element : elements)
    element.stiffness += make_.numbers(make_.n(), make_.n());
  expect_same_step(elements);
}

/// Modes over nodes that are slaves too; then without them.
TEST_P(CondensedFormTest, HeldModes)
{
  set_constraints({pair(0, 4, 0), pair(1, 5, 1), pair(2, 6, 2), pair(3, 7, 3)});
  std::vector<std::vector<double>> modes(2);
  for (auto &mode : modes)
    for (Index i = 0; i < layout_.n_displacement_unknowns(); ++i)
      mode.push_back(make_.number());
  const std::vector<ElementBlocks> elements{make_.stick(), make_.open(), make_.slip(0.3, 0.5), make_.frictionless()};
  for (const auto &held : {modes, {}})
  {
    for (SystemForm *form : forms())
    {
      EXPECT_TRUE(form->set_held_modes(held));
      if (form->prepare())
        form->update_subdomains();
    }
    update_rigid_block();
    expect_same_step(elements);
  }
}

/// A motion that the body does not resist: the matrix is singular without the border.
TEST_P(CondensedFormTest, HeldModeOfASingularBody)
{
  const auto n = static_cast<Eigen::Index>(bodies_[0].n_rows());
  Eigen::Map<Eigen::MatrixXd> k(bodies_[0].values.data(), n, n);
  Eigen::VectorXd motion = make_.numbers(n, 1).normalized();
  motion[2 * dim() - 1] = 0; // held
  motion.normalize();
  const Eigen::MatrixXd others = Eigen::MatrixXd::Identity(n, n) - motion * motion.transpose();
  k = (others * k * others).eval();
  std::vector<double> mode(static_cast<std::size_t>(layout_.n_displacement_unknowns()), 0.0);
  for (Index nodal = 0; nodal < n; ++nodal)
    for (const Term &term : layout_.terms(nodal))
      mode[term.unknown] = motion[nodal];
  set_constraints({pair(0, 4, 0), pair(1, 5, 1), pair(2, 6, 2), pair(3, 7, 3)});
  for (SystemForm *form : forms())
    EXPECT_TRUE(form->set_held_modes({mode}));
  for (SystemForm *form : forms())
    if (form->prepare())
      form->update_subdomains();
  update_rigid_block();
  expect_same_step({make_.open(), make_.open(), make_.open(), make_.open()});
}

TEST_P(CondensedFormTest, Multigrid)
{
  for (int i = 0; i < n_nodes * dim(); ++i)
    reference_.push_back(make_.number());
  condensed_ = std::make_unique<CondensedForm>(layout_, bodies_, make_amg_solver(), reference_);
  set_constraints({pair(0, 4, 0), pair(1, 5, 1), pair(2, 6, 2), pair(3, 7, 3)});
  expect_same_step({make_.stick(), make_.open(), make_.frictionless(), make_.frictionless()});
  expect_same_step({make_.slip(0.3, 0.5), make_.open(), make_.stick(), make_.open()});
}

INSTANTIATE_TEST_SUITE_P(Dimensions, CondensedFormTest, testing::Values(2, 3));
} // namespace
} // namespace amontons
