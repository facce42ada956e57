#include "amontons/algebra/coupled_form.h"
#include "amontons/base/error.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <random>

/// The coupled form and the direct solver against dense matrices.
namespace amontons
{
namespace
{
/// Four nodes of two components: node 0 free, node 1 held in y, nodes 2 and 3 on a rigid body that turns and moves.
/// Unknowns: rigid x, y and spin, then node 0's x and y and node 1's x; three multipliers.
Layout small_layout()
{
  const std::vector<std::vector<Term>> terms{
      {{3, 1}},           {{4, 1}},           {{5, 1}},           {}, {{0, 1}, {2, -0.7}},
      {{1, 1}, {2, 0.4}}, {{0, 1}, {2, 0.2}}, {{1, 1}, {2, -1.1}}};
  std::vector<Index> offsets{0};
  std::vector<Term> all;
  for (const auto &of_component : terms)
  {
    all.insert(all.end(), of_component.begin(), of_component.end());
    offsets.push_back(static_cast<Index>(all.size()));
  }
  return {6, 3, offsets, all};
}

/// du = T d(unknowns)
Eigen::MatrixXd dense_terms(const Layout &layout)
{
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(layout.n_nodal(), layout.n_displacement_unknowns());
  for (Index i = 0; i < layout.n_nodal(); ++i)
    for (const Term &term : layout.terms(i))
      out(i, term.unknown) += term.coefficient;
  return out;
}

class CoupledFormTest : public testing::Test
{
protected:
  CoupledFormTest()
  {
    // Two subdomains that share node 1.
    for (const std::vector<Index> &nodes : {std::vector<Index>{1, 0}, std::vector<Index>{1, 2, 3}})
      subdomains_.push_back(full_subdomain(nodes));
    form_ = std::make_unique<CoupledForm>(layout_, subdomains_, make_direct_solver());
  }

  double number() { return std::uniform_real_distribution(-1., 1.)(random_); }
  Eigen::MatrixXd numbers(Eigen::Index rows, Eigen::Index cols)
  {
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return number(); });
  }

  SubdomainMatrix full_subdomain(std::vector<Index> nodes)
  {
    SubdomainMatrix out;
    out.n_components = 2;
    out.nodes = std::move(nodes);
    const auto n = static_cast<Index>(2 * out.nodes.size());
    out.row_ptr.push_back(0);
    for (Index i = 0; i < n; ++i)
    {
      for (Index j = 0; j < n; ++j)
      {
        out.col.push_back(j);
        out.values.push_back(number() + (i == j ? 4 : 0));
      }
      out.row_ptr.push_back(static_cast<Index>(out.col.size()));
    }
    return out;
  }

  /// Node 0 against the face of nodes 2 and 3.
  static ConstraintPattern pattern()
  {
    ConstraintPattern out;
    for (const Index nodal : {0, 1, 4, 5, 6, 7})
      out.nodal.push_back(nodal);
    out.multipliers = {2, 0, 0};
    out.n_multipliers = 2;
    return out;
  }
  /// A multiplier on its own: what a node without a pair has.
  static ConstraintPattern lone_multiplier()
  {
    ConstraintPattern out;
    out.multipliers = {1, 0, 0};
    out.n_multipliers = 1;
    return out;
  }

  void add_block(Eigen::MatrixXd &to, const ConstraintPattern &p, const ConstraintValues &v) const
  {
    const Eigen::MatrixXd terms = dense_terms(layout_);
    Eigen::MatrixXd rows(p.n_nodal(), terms.cols());
    for (int k = 0; k < p.n_nodal(); ++k)
      rows.row(k) = terms.row(p.nodal[k]);
    const Index n = layout_.n_displacement_unknowns();
    to.topLeftCorner(n, n) += rows.transpose() * v.stiffness * rows;
    for (int m = 0; m < p.n_multipliers; ++m)
    {
      to.block(0, n + p.multipliers[m], n, 1) += rows.transpose() * v.force_by_multiplier.col(m);
      to.block(n + p.multipliers[m], 0, 1, n) += v.constraint_by_position.row(m) * rows;
      for (int k = 0; k < p.n_multipliers; ++k)
        to(n + p.multipliers[m], n + p.multipliers[k]) += v.constraint_by_multiplier(m, k);
    }
  }

  Eigen::MatrixXd dense_bodies() const
  {
    Eigen::MatrixXd nodal = Eigen::MatrixXd::Zero(layout_.n_nodal(), layout_.n_nodal());
    for (const SubdomainMatrix &matrix : subdomains_)
      for (Index row = 0; row < matrix.n_rows(); ++row)
        for (Index k = matrix.row_ptr[row]; k < matrix.row_ptr[row + 1]; ++k)
          nodal(matrix.nodes[row / 2] * 2 + row % 2, matrix.nodes[matrix.col[k] / 2] * 2 + matrix.col[k] % 2) +=
              matrix.values[k];
    const Eigen::MatrixXd terms = dense_terms(layout_);
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(layout_.n_unknowns(), layout_.n_unknowns());
    out.topLeftCorner(terms.cols(), terms.cols()) = terms.transpose() * nodal * terms;
    return out;
  }

  Eigen::VectorXd solve(const Eigen::VectorXd &rhs)
  {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(rhs.size());
    form_->factorize();
    form_->solve({rhs.data(), static_cast<std::size_t>(rhs.size())}, {x.data(), static_cast<std::size_t>(x.size())}, 0);
    return x;
  }

  std::mt19937 random_{7};
  Layout layout_ = small_layout();
  std::vector<SubdomainMatrix> subdomains_;
  std::unique_ptr<CoupledForm> form_;
};

TEST_F(CoupledFormTest, SolvesWhatTheDenseMatrixDoes)
{
  form_->set_constraints({pattern(), lone_multiplier()}, {{2}});
  EXPECT_TRUE(form_->prepare());
  EXPECT_FALSE(form_->prepare()) << "nothing has changed";
  for (int round = 0; round < 3; ++round) // the pattern stands for many values
  {
    for (SubdomainMatrix &matrix : subdomains_)
      for (double &value : matrix.values)
        value += 0.1 * number();
    form_->update_subdomains();
    Eigen::MatrixXd dense = dense_bodies();
    const Eigen::MatrixXd stiffness = numbers(6, 6), by_multiplier = numbers(6, 2), by_position = numbers(2, 6),
                          corner = numbers(2, 2), none(0, 0), no_force(0, 1), no_row(1, 0),
                          alone = Eigen::MatrixXd::Constant(1, 1, -0.5), spin = numbers(1, 1);
    form_->update_constraint(0, {stiffness, by_multiplier, by_position, corner, 1});
    add_block(dense, pattern(), {stiffness, by_multiplier, by_position, corner, 1});
    form_->update_constraint(1, {none, no_force, no_row, alone, 1});
    dense(6 + 1, 6 + 1) += -0.5;
    form_->update_dense_block(0, spin);
    dense(2, 2) += spin(0, 0);
    const Eigen::VectorXd rhs = numbers(9, 1);
    const Eigen::VectorXd expected = dense.fullPivLu().solve(rhs);
    EXPECT_LT((solve(rhs) - expected).norm(), 1e-11 * expected.norm());
  }
  EXPECT_EQ(form_->counters().n_pattern_builds, 1);
  EXPECT_EQ(form_->counters().n_factorizations, 3);
}

TEST_F(CoupledFormTest, NewConstraintsMakeANewPattern)
{
  form_->set_constraints({}, {});
  form_->prepare();
  form_->set_constraints({lone_multiplier()}, {});
  EXPECT_TRUE(form_->prepare());
  EXPECT_EQ(form_->counters().n_pattern_builds, 2);
}

/// The border m: [A m; m^T 0] [x; r] = [b; 0].
TEST_F(CoupledFormTest, HoldsModesByReactionsOfTheirOwn)
{
  layout_ = Layout(
      6, 0,
      [&]
      {
        std::vector<Index> offsets{0};
        for (Index i = 0; i < layout_.n_nodal(); ++i)
          offsets.push_back(offsets.back() + static_cast<Index>(layout_.terms(i).size()));
        return offsets;
      }(),
      [&]
      {
        std::vector<Term> terms;
        for (Index i = 0; i < layout_.n_nodal(); ++i)
          terms.insert(terms.end(), layout_.terms(i).begin(), layout_.terms(i).end());
        return terms;
      }());
  form_->set_constraints({}, {});
  const std::vector<double> mode{0, 1, 0, 0.5, 0, -2};
  EXPECT_TRUE(form_->set_held_modes({mode}));
  form_->prepare();
  form_->update_subdomains();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(7, 7);
  dense.topLeftCorner(6, 6) = dense_bodies();
  dense.col(6).head(6) = dense.row(6).head(6) = Eigen::Map<const Eigen::VectorXd>(mode.data(), 6);
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(7);
  rhs.head(6) = numbers(6, 1);
  const Eigen::VectorXd expected = dense.fullPivLu().solve(rhs);
  EXPECT_LT((solve(rhs.head(6)) - expected.head(6)).norm(), 1e-11 * expected.norm());
  ASSERT_EQ(form_->mode_reactions().size(), 1u);
  EXPECT_NEAR(form_->mode_reactions()[0], expected[6], 1e-11 * expected.norm());
  EXPECT_TRUE(form_->set_held_modes({})) << "the border goes";
  EXPECT_FALSE(form_->set_held_modes({}));
}

TEST_F(CoupledFormTest, SingularMatrixIsAFailure)
{
  form_->set_constraints({lone_multiplier()}, {});
  form_->prepare();
  form_->update_subdomains();
  const Eigen::MatrixXd none(0, 0), no_force(0, 1), no_row(1, 0), zero = Eigen::MatrixXd::Zero(1, 1);
  form_->update_constraint(0, {none, no_force, no_row, zero, 1});
  EXPECT_THROW((void)solve(Eigen::VectorXd::Ones(9)), NumericalFailure);
}
} // namespace
} // namespace amontons
