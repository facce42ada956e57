#include "amontons/contact/kinematics.h"
#include "cases.h"

#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
constexpr double tiny = 1e-30;

/// Greatest difference, relative to the greatest entry (or to 1, the size of the faces).
template<class A, class B>
double difference(const A &a, const B &b)
{
  return (a - b).cwiseAbs().maxCoeff() / std::max(1., b.cwiseAbs().maxCoeff());
}

Eigen::VectorXd real(const Jet::Gradient &gradient, int n)
{
  return gradient.real().head(n);
}

class Kinematics : public testing::TestWithParam<std::string>
{
};

TEST_P(Kinematics, MatchesTheIndependentMeasure)
{
  for (unsigned seed = 0; seed < 25; ++seed)
  {
    const Case c = make_case(GetParam(), seed, true);
    const ContactLinearisation lin = c.linearise(c.x);
    const Measured measured = c.measure(c.x.cast<Complex>());
    ASSERT_EQ(lin.n_dofs(), c.n_dofs());
    EXPECT_NEAR(lin.gap, measured.gap.real(), 1e-12);
    EXPECT_LT(difference(lin.gap_gradient, real(measured.gap_gradient, c.n_dofs())), 1e-12);
    for (int t = 0; t < lin.n_tangents(); ++t)
    {
      EXPECT_NEAR(lin.slip[t], measured.slip[t].real(), 1e-12) << "seed " << seed;
      EXPECT_LT(difference(lin.slip_gradient[t], real(measured.slip_gradient[t], c.n_dofs())), 1e-11);
      EXPECT_LT(difference(lin.slip_direction[t], real(measured.slip_direction[t], c.n_dofs())), 1e-11);
    }
  }
}

TEST_P(Kinematics, SecondDerivativesMatchComplexSteps)
{
  for (unsigned seed = 0; seed < 25; ++seed)
  {
    const Case c = make_case(GetParam(), seed, true);
    const int n = c.n_dofs();
    const ContactLinearisation lin = c.linearise(c.x);
    Eigen::MatrixXd hessian(n, n);
    std::array<Eigen::MatrixXd, 2> turning{Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n)};
    for (int j = 0; j < n; ++j)
    {
      Eigen::VectorXcd x = c.x.cast<Complex>();
      x[j] += Complex(0, tiny);
      const Measured measured = c.measure(x);
      hessian.col(j) = measured.gap_gradient.imag().head(n) / tiny;
      for (int t = 0; t < 2; ++t)
        turning[t].col(j) = measured.slip_direction[t].imag().head(n) / tiny;
    }
    // In small strain there is nothing to store.
    const auto stored = [&](const ContactMatrix &m) { return m.size() > 0 ? m : ContactMatrix::Zero(n, n).eval(); };
    const ContactMatrix gap_gradient = stored(lin.gap_direction_gradient);
    EXPECT_LT(difference(gap_gradient, hessian), 1e-10) << "seed " << seed;
    EXPECT_LT(difference(gap_gradient, gap_gradient.transpose()), 1e-13);
    for (int t = 0; t < lin.n_tangents(); ++t)
      EXPECT_LT(difference(stored(lin.slip_direction_gradient[t]), turning[t]), 1e-10) << "seed " << seed;
  }
}

class KinematicsWithoutSlip : public Kinematics
{
};

TEST_P(KinematicsWithoutSlip, SlipDirectionIsTheSlipGradient)
{
  for (unsigned seed = 0; seed < 10; ++seed)
  {
    const Case c = make_case(GetParam(), seed, false);
    const ContactLinearisation lin = c.linearise(c.x);
    for (int t = 0; t < lin.n_tangents(); ++t)
    {
      EXPECT_NEAR(lin.slip[t], 0, 1e-13);
      EXPECT_LT(difference(lin.slip_gradient[t], lin.slip_direction[t]), 1e-12);
    }
  }
}

TEST_P(Kinematics, FrameIsRightHandedAndTangential)
{
  const Case c = make_case(GetParam(), 3, true);
  const ContactLinearisation lin = c.linearise(c.x);
  EXPECT_NEAR(lin.normal.norm(), 1, 1e-14);
  EXPECT_NEAR(lin.tangent[0].norm(), 1, 1e-14);
  EXPECT_NEAR(lin.tangent[0].dot(lin.normal), 0, 1e-14);
  if (c.dim == 3)
  {
    EXPECT_LT((lin.tangent[1] - lin.normal.cross(lin.tangent[0])).norm(), 1e-14);
  }
  else // n = (t_y, -t_x)
  {
    EXPECT_LT((lin.normal - Eigen::Vector3d(lin.tangent[0].y(), -lin.tangent[0].x(), 0)).norm(), 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, KinematicsWithoutSlip, testing::ValuesIn(slipless_case_kinds()),
                         [](const auto &info) { return info.param; });
INSTANTIATE_TEST_SUITE_P(Every, Kinematics, testing::ValuesIn(case_kinds()),
                         [](const auto &info) { return info.param; });
} // namespace
} // namespace amontons::test
