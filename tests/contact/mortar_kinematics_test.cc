// linearise_mortar against differences of its own values, for normals and weights that are any smooth functions of the
// positions: what it takes for granted of them is that the normal is a unit vector and that weights sum to 1.
#include "amontons/contact/kinematics.h"

#include "amontons/base/error.h"
#include "measures.h"

#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Normal and weights as made-up functions of all positions x (impactors, then targets).
struct Mean
{
  int dim, n_impactors, n_targets;
  std::array<int, 2> ends;
  MatrixXd normal_form; ///< [dim x dim * n_impactors]
  MatrixXd weight_form; ///< [n_targets x n dofs]
  VectorXd origin;      ///< [n_targets]

  Mean(int dimension, unsigned seed)
    : dim(dimension)
    , n_impactors(4)
    , n_targets(5)
    , ends{static_cast<int>(seed) % 4, static_cast<int>(seed + 1) % 4}
  {
    Random random(seed);
    const auto matrix = [&](int n, int m)
    { return MatrixXd(Eigen::Map<const MatrixXd>(random_vector(random, n * m).eval().data(), n, m)); };
    normal_form = matrix(dim, dim * n_impactors);
    weight_form = 0.3 * matrix(n_targets, n_dofs());
    origin = matrix(n_targets, 1);
    origin.array() += (1 - origin.sum()) / n_targets;
  }
  [[nodiscard]] int n_dofs() const { return dim * (n_impactors + n_targets); }

  [[nodiscard]] VectorXd normal(const VectorXd &x) const
  {
    return (normal_form * x.head(dim * n_impactors)).normalized();
  }
  [[nodiscard]] VectorXd weights(const VectorXd &x) const
  {
    const VectorXd shares = (weight_form * x).array().sin() + 2;
    return shares / shares.sum();
  }
  [[nodiscard]] ContactLinearisation linearise(const VectorXd &x) const
  {
    const VectorXd raw = normal_form * x.head(dim * n_impactors);
    const VectorXd n = raw.normalized(), w = weights(x);
    const MatrixXd dn = (normal_form - n * (n.transpose() * normal_form)) / raw.norm();
    const VectorXd angles = weight_form * x;
    const MatrixXd shares = angles.array().cos().matrix().asDiagonal() * weight_form;
    const double sum = (angles.array().sin() + 2).sum();
    const MatrixXd dw = (shares - w * shares.colwise().sum()) / sum;
    Vector3d n3 = Vector3d::Zero();
    n3.head(dim) = n;
    const VectorXd own = x.head(dim * n_impactors), others = x.tail(dim * n_targets);
    return linearise_mortar(dim, n3, dn, span(own), span(others), span(w), dw, span(origin), ends);
  }
};

template<class Function>
MatrixXd differences(const VectorXd &x, double h, const Function &f)
{
  MatrixXd out(f(x).size(), x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j)
  {
    VectorXd up = x, down = x;
    up[j] += h;
    down[j] -= h;
    out.col(j) = (f(up) - f(down)) / (2 * h);
  }
  return out;
}

TEST(MortarKinematics, MatchesItsDefinition)
{
  for (const int dim : {2, 3})
    for (unsigned seed = 0; seed < 6; ++seed)
    {
      const Mean mean(dim, seed);
      Random random(seed + 100);
      const VectorXd x = random_vector(random, mean.n_dofs());
      const ContactLinearisation lin = mean.linearise(x);
      const VectorXd n = mean.normal(x), w = mean.weights(x);
      VectorXd opposite = x.head(dim), chord = VectorXd::Zero(dim);
      for (int k = 0; k < mean.n_targets; ++k)
      {
        opposite -= w[k] * x.segment(dim * (mean.n_impactors + k), dim);
        chord += (w[k] - mean.origin[k]) * x.segment(dim * (mean.n_impactors + k), dim);
      }
      EXPECT_NEAR(lin.gap, n.dot(opposite), 1e-14);
      EXPECT_LT((lin.normal.head(dim) - n).norm(), 1e-15);
      const VectorXd edge = x.segment(dim * mean.ends[1], dim) - x.segment(dim * mean.ends[0], dim);
      const VectorXd first = dim == 2 ? VectorXd(Eigen::Vector2d(-n[1], n[0])) : (edge - n.dot(edge) * n).normalized();
      EXPECT_LT((lin.tangent[0].head(dim) - first).norm(), 1e-14);
      if (dim == 3)
      {
        EXPECT_LT((lin.tangent[1] - lin.normal.cross(lin.tangent[0])).norm(), 1e-14);
      }
      for (int c = 0; c < dim - 1; ++c)
      {
        EXPECT_NEAR(lin.slip[c], lin.tangent[c].head(dim).dot(chord), 1e-14);
        for (int i = 0; i < mean.n_impactors + mean.n_targets; ++i)
        {
          const double share = i == 0 ? 1 : i < mean.n_impactors ? 0 : -w[i - mean.n_impactors];
          EXPECT_LT((lin.slip_direction[c].segment(dim * i, dim) - share * lin.tangent[c].head(dim)).norm(), 1e-14);
          EXPECT_LT((lin.gap_direction.segment(dim * i, dim) - share * n).norm(), 1e-14);
        }
      }
    }
}

TEST(MortarKinematics, GradientsMatchDifferences)
{
  constexpr double h = 1e-5;
  for (const int dim : {2, 3})
    for (unsigned seed = 0; seed < 6; ++seed)
    {
      const Mean mean(dim, seed);
      Random random(seed + 100);
      const VectorXd x = random_vector(random, mean.n_dofs());
      const ContactLinearisation lin = mean.linearise(x);
      const auto expect_gradient = [&](const MatrixXd &gradient, const auto &f)
      {
        const MatrixXd expected = differences(x, h, f);
        EXPECT_LT((gradient - expected).cwiseAbs().maxCoeff(), 1e-7 * std::max(1., expected.cwiseAbs().maxCoeff()));
      };
      expect_gradient(lin.gap_gradient.transpose(),
                      [&](const VectorXd &at) { return VectorXd::Constant(1, mean.linearise(at).gap).eval(); });
      expect_gradient(lin.gap_direction_gradient, [&](const VectorXd &at) { return mean.linearise(at).gap_direction; });
      for (int c = 0; c < dim - 1; ++c)
      {
        expect_gradient(lin.slip_gradient[c].transpose(),
                        [&](const VectorXd &at) { return VectorXd::Constant(1, mean.linearise(at).slip[c]).eval(); });
        expect_gradient(lin.slip_direction_gradient[c],
                        [&](const VectorXd &at) { return mean.linearise(at).slip_direction[c]; });
      }
    }
}

TEST(MortarKinematics, AnEdgeAlongTheNormalIsANumericalFailure)
{
  const std::vector<double> impactors{0, 0, 0, 0, 0, 1}, targets{0, 0, -1}, weight{1};
  EXPECT_THROW(linearise_mortar(3, Vector3d::UnitZ(), MatrixXd::Zero(3, 6), impactors, targets, weight,
                                MatrixXd::Zero(1, 9), weight, {0, 1}),
               NumericalFailure);
}
} // namespace
} // namespace amontons::test
