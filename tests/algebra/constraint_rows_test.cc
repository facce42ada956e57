#include "amontons/algebra/constraint_rows.h"
#include "amontons/base/error.h"
#include "element_blocks.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <random>

/// Constraints reduced to their rows, against dense solutions of the whole.
namespace amontons
{
namespace
{
using test::ElementBlocks;
constexpr double r = test::augmentation;

class ReducedConstraint : public testing::TestWithParam<int>
{
protected:
  [[nodiscard]] int dim() const { return GetParam(); }
  [[nodiscard]] int n() const { return make_.n(); }
  Eigen::MatrixXd numbers(Eigen::Index rows, Eigen::Index cols) { return make_.numbers(rows, cols); }
  ElementBlocks stick() { return make_.stick(); }
  ElementBlocks frictionless() { return make_.frictionless(); }
  ElementBlocks slip(double mu, double k) { return make_.slip(mu, k); }

  static void drop_row(ElementBlocks &out, Eigen::Index row)
  {
    out.constraint_by_position.row(row).setZero();
    out.constraint_by_multiplier.row(row).setZero();
    out.constraint_by_multiplier(row, row) = -1 / r;
  }
  /// Of the tangential rows one is kept, turned into another direction of the tangent plane.
  ElementBlocks half_stuck()
  {
    ElementBlocks out = stick();
    const double angle = 1.1;
    const Eigen::Vector2d kept{std::cos(angle), std::sin(angle)}, dropped{-kept[1], kept[0]};
    out.constraint_by_position.row(1) = kept.transpose() * out.constraint_by_position.bottomRows(2).eval();
    out.constraint_by_position.row(2).setZero();
    out.constraint_by_multiplier.block(2, 1, 1, 2) = -dropped.transpose() / r;
    return out;
  }

  /// Solves bodies and constraint whole, and reduced, and compares.
  void expect_same_solution(const ElementBlocks &b, int n_rows, bool symmetric)
  {
    const int m = dim();
    const Eigen::MatrixXd part = numbers(n(), n()), k = part * part.transpose() + Eigen::MatrixXd::Identity(n(), n());
    const Eigen::VectorXd rhs = numbers(n() + m, 1);
    Eigen::MatrixXd whole(n() + m, n() + m);
    whole << k + b.stiffness, b.force_by_multiplier, b.constraint_by_position, b.constraint_by_multiplier;
    const Eigen::VectorXd expected = whole.fullPivLu().solve(rhs), rl = rhs.tail(m);

    const ConstraintRows rows = reduce_constraint(b.values());
    ASSERT_EQ(rows.n_rows(), n_rows);
    EXPECT_EQ(rows.symmetric, symmetric);
    Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(n() + n_rows, n() + n_rows);
    reduced.topLeftCorner(n(), n()) = k;
    if (rows.stiffness.size() > 0)
      reduced.topLeftCorner(n(), n()) += rows.stiffness;
    reduced.topRightCorner(n(), n_rows) = rows.forces;
    reduced.bottomLeftCorner(n_rows, n()) = rows.rows;
    Eigen::VectorXd reduced_rhs(n() + n_rows);
    reduced_rhs << rhs.head(n()) - rows.right_side_force * rl, rows.row_right_side * rl;
    const Eigen::VectorXd x = reduced.fullPivLu().solve(reduced_rhs), du = x.head(n());
    const Eigen::VectorXd dlambda =
        rows.multiplier_by_row * x.tail(n_rows) + rows.multiplier_by_right_side * rl + rows.multiplier_by_position * du;
    EXPECT_LT((du - expected.head(n())).norm(), 1e-10 * expected.norm());
    EXPECT_LT((dlambda - expected.tail(m)).norm(), 1e-10 * expected.norm());
  }

  test::ElementMaker make_{GetParam(), GetParam() == 2 ? 3 : 5, 11};
};

TEST_P(ReducedConstraint, OpenHasNoRows)
{
  expect_same_solution(make_.open(), 0, true);
  EXPECT_EQ(reduce_constraint(make_.open().values()).stiffness.size(), 0);
}

TEST_P(ReducedConstraint, StickAndFrictionlessLeaveNoStiffness)
{
  expect_same_solution(stick(), dim(), true);
  expect_same_solution(frictionless(), 1, true);
  EXPECT_EQ(reduce_constraint(stick().values()).stiffness.size(), 0);
  EXPECT_EQ(reduce_constraint(frictionless().values()).stiffness.size(), 0);
}

TEST_P(ReducedConstraint, SlipPutsFrictionIntoTheForces)
{
  for (const double k : {0.1, 0.9, 1 - 1e-6})
    expect_same_solution(slip(0.4, k), 1, false);
  // Across the slip, kappa = r k/(1 - k); in the plane there is nothing across.
  const Eigen::MatrixXd stiffness = reduce_constraint(slip(0.4, 0.75).values()).stiffness;
  if (dim() == 2)
    EXPECT_EQ(stiffness.size(), 0);
  else
  {
    const LowRankMatrix product = factorise_low_rank(stiffness, true);
    ASSERT_EQ(product.weight.size(), 1);
    EXPECT_NEAR(product.weight[0], r * 3 * (1 + 1. / 4), 1e-12) << "over the impactor node and four others";
  }
}

TEST_P(ReducedConstraint, ForceOfSlipIsTheNormalAndFriction)
{
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(dim() - 1, dim() - 1);
  const Eigen::VectorXd s = Eigen::VectorXd::Unit(dim() - 1, 0);
  const ElementBlocks b = make_.blocks(-0.3 * s, 0.5 * (identity - s * s.transpose()));
  const ConstraintRows rows = reduce_constraint(b.values());
  const double sign = rows.rows.row(0).dot(b.constraint_by_position.row(0)) > 0 ? 1 : -1;
  EXPECT_LT((sign * rows.forces - b.force_by_multiplier.col(0)).norm(), 1e-12);
}

TEST_P(ReducedConstraint, RowsDropped)
{
  ElementBlocks none = stick(), one_left = stick(), frictionless_none = frictionless(), slipping = slip(0.4, 0.6);
  for (int row = 0; row < dim(); ++row)
    drop_row(none, row);
  drop_row(one_left, 0);
  for (int row = 2; row < dim(); ++row)
    drop_row(one_left, row);
  drop_row(frictionless_none, 0);
  drop_row(slipping, 0);
  expect_same_solution(none, 0, true);
  expect_same_solution(frictionless_none, 0, true);
  expect_same_solution(slipping, 0, false);
  expect_same_solution(one_left, 1, true);
  if (dim() == 3)
    expect_same_solution(half_stuck(), 2, true);
}

/// Finite strain: second derivatives of gap and slip, symmetric or not.
TEST_P(ReducedConstraint, GeometricStiffnessStays)
{
  const Eigen::MatrixXd any = 0.1 * numbers(n(), n());
  for (ElementBlocks b : {stick(), frictionless()})
  {
    b.stiffness += any + any.transpose();
    expect_same_solution(b, static_cast<int>(reduce_constraint(b.values()).rows.rows()), true);
    b.stiffness += any;
    expect_same_solution(b, static_cast<int>(reduce_constraint(b.values()).rows.rows()), false);
  }
}

TEST_P(ReducedConstraint, NodeWithoutAPair)
{
  const int m = dim();
  const Eigen::MatrixXd none(0, 0), no_force(0, m), no_row(m, 0), corner = -Eigen::MatrixXd::Identity(m, m) / r;
  const ConstraintRows rows = reduce_constraint({none, no_force, no_row, corner, r});
  EXPECT_EQ(rows.n_rows(), 0);
  EXPECT_NEAR(rows.multiplier_by_right_side(0, 0), -r, 1e-14);
}

TEST_P(ReducedConstraint, RowOfNothingIsAFailure)
{
  ElementBlocks b = frictionless();
  b.constraint_by_position.row(0).setZero();
  EXPECT_THROW(reduce_constraint(b.values()), NumericalFailure);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, ReducedConstraint, testing::Values(2, 3));

TEST(LowRankMatrix, GivesTheMatrixBack)
{
  std::mt19937 random(3);
  std::normal_distribution<> normal;
  const auto numbers = [&](int rows, int cols)
  { return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random); })); };
  const Eigen::MatrixXd a = numbers(12, 2), b = numbers(12, 2);
  const Eigen::Vector2d signs{1, -0.5};
  for (const bool symmetric : {true, false})
  {
    const Eigen::MatrixXd matrix = a * signs.asDiagonal() * (symmetric ? a : b).transpose();
    const LowRankMatrix out = factorise_low_rank(matrix, symmetric);
    EXPECT_EQ(out.weight.size(), 2);
    EXPECT_LT((out.left * out.weight.asDiagonal() * out.right.transpose() - matrix).norm(), 1e-13 * matrix.norm());
    if (symmetric)
      EXPECT_EQ(out.left, out.right);
  }
  EXPECT_EQ(factorise_low_rank(Eigen::MatrixXd(), true).weight.size(), 0);
}
} // namespace
} // namespace amontons
