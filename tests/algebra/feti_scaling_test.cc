#include "amontons/algebra/feti_scaling.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <random>

namespace amontons
{
namespace
{
/// Rows of an impactor node of its own and some columns in common with the next ones, of length one in the product with
/// 1/stiffness.
class Scaling : public testing::TestWithParam<double>
{
protected:
  Scaling()
  {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(0.5, 1.5);
    inverse_stiffness_.resize(2 * n + 4);
    for (double &x : inverse_stiffness_)
      x = number(random);
    for (Index i = 0; i < n; ++i)
      inverse_stiffness_[i] /= GetParam();
    for (Index i = 0; i < n; ++i)
    {
      std::vector<FetiRows::Entry> row{{i, 1}};
      for (int k = 0; k < 4; ++k)
        row.emplace_back(n + i + k, -0.25 * number(random));
      double length2 = 0;
      for (const auto &[column, value] : row)
        length2 += value * value * inverse_stiffness_[column];
      for (auto &[column, value] : row)
      {
        value /= std::sqrt(length2);
        gram_root_(i, column) = value * std::sqrt(inverse_stiffness_[column]);
      }
      least_ = std::min(least_, gram_root_(i, i) * gram_root_(i, i));
      rows_.push_back(row);
    }
    scaling_.set(rows_, inverse_stiffness_, least_, Sharing(n));
  }
  [[nodiscard]] Eigen::MatrixXd scaling() const
  {
    Eigen::MatrixXd out = Eigen::MatrixXd::Identity(n, n);
    for (Index j = 0; j < n; ++j)
      scaling_.apply({out.col(j).data(), static_cast<std::size_t>(n)}, Sharing(n));
    return out;
  }

  static constexpr Index n = 30;
  FetiRows rows_;
  std::vector<double> inverse_stiffness_;
  Eigen::MatrixXd gram_root_ = Eigen::MatrixXd::Zero(n, 2 * n + 4);
  double least_ = 1;
  FetiScaling scaling_;
};

TEST_P(Scaling, IsNearlyTheInverse)
{
  const Eigen::MatrixXd inverse = scaling(), gram = gram_root_ * gram_root_.transpose();
  EXPECT_LT((inverse - inverse.transpose()).norm(), 1e-12 * inverse.norm());
  const Eigen::VectorXd values =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(inverse, gram.inverse()).eigenvalues();
  EXPECT_GT(values.minCoeff(), 0.9);
  EXPECT_LT(values.maxCoeff(), 1.1);
}

/// Rows given twice leave B D^-1 B^T singular.
TEST_P(Scaling, IsDefiniteForDependentRows)
{
  FetiRows twice = rows_;
  for (Index i = 0; i < n; ++i)
  {
    std::vector<FetiRows::Entry> row(rows_[i].begin(), rows_[i].end());
    twice.push_back(row);
  }
  scaling_.set(twice, inverse_stiffness_, least_, Sharing(2 * n));
  Eigen::MatrixXd scaling = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  for (Index j = 0; j < 2 * n; ++j)
    scaling_.apply({scaling.col(j).data(), static_cast<std::size_t>(2 * n)}, Sharing(2 * n));
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaling).eigenvalues().minCoeff(), 0.1);
}

/// How hard impactors are: their columns' stiffness over the targets'.
INSTANTIATE_TEST_SUITE_P(Hardness, Scaling, testing::Values(0.01, 1, 20, 300));

TEST(ScalingOfNothing, LeavesNothing)
{
  FetiScaling scaling;
  scaling.set({}, {}, 1, Sharing(0));
  scaling.apply({}, Sharing(0));
}
} // namespace
} // namespace amontons
