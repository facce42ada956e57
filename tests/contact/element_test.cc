#include "amontons/contact/element.h"
#include "cases.h"

#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
constexpr double tiny = 1e-30;

enum class Situation
{
  open,
  stick,
  slip,
  frictionless
};
constexpr std::array situations{Situation::open, Situation::stick, Situation::slip, Situation::frictionless};

struct Law
{
  double mu;
  double r;
};

/// Multipliers that bring the case into a situation whatever its gap and slip.
Multipliers multipliers_for(Situation situation, const ContactLinearisation &lin, const Law &law, Random &random)
{
  const double pressed = situation == Situation::open ? uniform(random, 1, 2) : -uniform(random, 2, 3);
  const double ratio = situation == Situation::stick ? uniform(random, .1, .9) : uniform(random, 1.1, 3);
  const double length = ratio * (law.mu > 0 ? law.mu : 0.3) * std::abs(pressed);
  const double angle = uniform(random, -3, 3);
  const std::array<double, 2> sigma_t{lin.dim == 2 ? length : length * std::cos(angle), length * std::sin(angle)};
  Multipliers lambda{pressed - law.r * lin.gap, {}};
  for (int c = 0; c < lin.n_tangents(); ++c)
    lambda.tangential[c] = sigma_t[c] - law.r * lin.slip[c];
  return lambda;
}

/// THEORY's table at complex positions and multipliers: (F_x, F_lambda).
Eigen::VectorXcd residual(const Case &c, Situation situation, const Law &law, const Eigen::VectorXcd &unknowns)
{
  const int n = c.n_dofs(), n_tangents = c.dim - 1;
  const Measured at = c.measure(unknowns.head(n));
  const Complex lambda_n = unknowns[n], sigma_n = lambda_n + law.r * at.gap;
  Eigen::VectorXcd lambda_t = unknowns.tail(n_tangents), sigma_t = lambda_t;
  for (int k = 0; k < n_tangents; ++k)
    sigma_t[k] += law.r * at.slip[k];
  const Complex length = std::sqrt((sigma_t.array() * sigma_t.array()).sum());
  Eigen::VectorXcd out = Eigen::VectorXcd::Zero(n + 1 + n_tangents);
  if (situation == Situation::open)
  {
    out.tail(1 + n_tangents) = -unknowns.tail(1 + n_tangents) / law.r;
    return out;
  }
  out.head(n) = sigma_n * at.gap_gradient.head(n);
  out[n] = at.gap;
  for (int k = 0; k < n_tangents; ++k)
  {
    const Complex friction = -law.mu * sigma_n * sigma_t[k] / length;
    if (situation == Situation::stick)
      out.head(n) += sigma_t[k] * at.slip_direction[k].head(n);
    else if (situation == Situation::slip)
      out.head(n) += friction * at.slip_direction[k].head(n);
    out[n + 1 + k] = situation == Situation::stick  ? at.slip[k]
                     : situation == Situation::slip ? -(lambda_t[k] - friction) / law.r
                                                    : -lambda_t[k] / law.r;
  }
  return out;
}

Eigen::VectorXd unknowns_of(const Case &c, const Multipliers &lambda)
{
  Eigen::VectorXd out(c.n_dofs() + c.dim);
  out.head(c.n_dofs()) = c.x;
  out[c.n_dofs()] = lambda.normal;
  for (int k = 0; k < c.dim - 1; ++k)
    out[c.n_dofs() + 1 + k] = lambda.tangential[k];
  return out;
}

Eigen::VectorXd whole_residual(const ContactElement &element)
{
  Eigen::VectorXd out(element.force.size() + element.constraint.size());
  out << element.force, element.constraint;
  return out;
}

Eigen::MatrixXd whole_tangent(const ContactElement &element)
{
  const auto n = element.force.size(), m = element.constraint.size();
  Eigen::MatrixXd out(n + m, n + m);
  out << element.stiffness, element.force_by_multiplier, element.constraint_by_position,
      element.constraint_by_multiplier;
  return out;
}

Law law_of(Situation situation, Random &random)
{
  return {situation == Situation::frictionless ? 0 : uniform(random, .1, .8), uniform(random, .3, 3)};
}

class Element : public testing::TestWithParam<std::string>
{
};

TEST_P(Element, ResidualAndTangentOfEveryStatus)
{
  for (const Situation situation : situations)
    for (unsigned seed = 0; seed < 12; ++seed)
    {
      const Case c = make_case(GetParam(), seed, true);
      Random random(seed + 1000);
      const Law law = law_of(situation, random);
      const ContactLinearisation lin = c.linearise(c.x);
      const Multipliers lambda = multipliers_for(situation, lin, law, random);
      const ContactStatus status = contact_status(lin, lambda, law.mu, law.r);
      ASSERT_EQ(status, situation == Situation::open    ? ContactStatus::open
                        : situation == Situation::stick ? ContactStatus::stick
                                                        : ContactStatus::slip);
      const ContactElement element = contact_element(lin, lambda, law.mu, law.r, status);
      const Eigen::VectorXd at = unknowns_of(c, lambda);
      const Eigen::VectorXd expected = residual(c, situation, law, at.cast<Complex>()).real();
      EXPECT_LT((whole_residual(element) - expected).cwiseAbs().maxCoeff(), 1e-11 * expected.cwiseAbs().maxCoeff());

      Eigen::MatrixXd tangent(at.size(), at.size());
      for (int j = 0; j < at.size(); ++j)
      {
        Eigen::VectorXcd moved = at.cast<Complex>();
        moved[j] += Complex(0, tiny);
        tangent.col(j) = residual(c, situation, law, moved).imag() / tiny;
      }
      const double error = (whole_tangent(element) - tangent).cwiseAbs().maxCoeff();
      EXPECT_LT(error, 1e-10 * tangent.cwiseAbs().maxCoeff()) << "seed " << seed;
    }
}

/// L_a of THEORY.md section 2, closed, in stick or without friction, where no radius is held fast.
Complex augmented_lagrangian(const Case &c, Situation situation, double r, const Eigen::VectorXcd &unknowns)
{
  const int n = c.n_dofs();
  const Measured at = c.measure(unknowns.head(n));
  const auto term = [r](Complex g, Complex lambda) { return g * lambda + 0.5 * r * g * g; };
  Complex sum = term(at.gap, unknowns[n]);
  for (int k = 0; k < c.dim - 1; ++k)
  {
    const Complex lambda = unknowns[n + 1 + k], sigma = lambda + r * at.slip[k];
    sum += term(at.slip[k], lambda);
    if (situation == Situation::frictionless)
      sum -= sigma * sigma / (2 * r);
  }
  return sum;
}

class ElementWithoutSlip : public Element
{
};

TEST_P(ElementWithoutSlip, ResidualIsTheGradientOfTheAugmentedLagrangian)
{
  for (const Situation situation : {Situation::stick, Situation::frictionless})
    for (unsigned seed = 0; seed < 8; ++seed)
    {
      const Case c = make_case(GetParam(), seed, false);
      Random random(seed + 2000);
      const Law law = law_of(situation, random);
      const ContactLinearisation lin = c.linearise(c.x);
      const Multipliers lambda = multipliers_for(situation, lin, law, random);
      const ContactElement element =
          contact_element(lin, lambda, law.mu, law.r, contact_status(lin, lambda, law.mu, law.r));
      const Eigen::VectorXd at = unknowns_of(c, lambda);
      Eigen::VectorXd gradient(at.size());
      for (int j = 0; j < at.size(); ++j)
      {
        Eigen::VectorXcd moved = at.cast<Complex>();
        moved[j] += Complex(0, tiny);
        gradient[j] = augmented_lagrangian(c, situation, law.r, moved).imag() / tiny;
      }
      EXPECT_LT((whole_residual(element) - gradient).cwiseAbs().maxCoeff(), 1e-11 * gradient.cwiseAbs().maxCoeff());
      // In finite sliding stick's virtual slip is the gradient of the slip at zero slip only: no symmetry there.
      const Eigen::MatrixXd tangent = whole_tangent(element);
      if (situation == Situation::frictionless)
      {
        EXPECT_LT((tangent - tangent.transpose()).cwiseAbs().maxCoeff(), 1e-11 * tangent.cwiseAbs().maxCoeff());
      }
    }
}

/// Sum of the nodes' forces and of their moments about the origin.
std::pair<Eigen::Vector3d, Eigen::Vector3d> resultants(int dim, const ContactVector &force, const Eigen::VectorXd &x)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  for (int i = 0; i < force.size() / dim; ++i)
  {
    Eigen::Vector3d f = Eigen::Vector3d::Zero(), at = Eigen::Vector3d::Zero();
    f.head(dim) = force.segment(dim * i, dim);
    at.head(dim) = x.segment(dim * i, dim);
    sum += f;
    moment += at.cross(f);
  }
  return {sum, moment};
}

TEST_P(Element, ForcesBalance)
{
  const bool has_faces = make_case(GetParam(), 0, true).n_dofs() > 2 * make_case(GetParam(), 0, true).dim;
  const bool is_finite = GetParam().find("small") == std::string::npos;
  for (const Situation situation : {Situation::stick, Situation::slip})
    for (unsigned seed = 0; seed < 8; ++seed)
    {
      const Case c = make_case(GetParam(), seed, true);
      Random random(seed + 3000);
      const Law law = law_of(situation, random);
      const ContactLinearisation lin = c.linearise(c.x);
      const Multipliers lambda = multipliers_for(situation, lin, law, random);
      const ContactElement element =
          contact_element(lin, lambda, law.mu, law.r, contact_status(lin, lambda, law.mu, law.r));
      const auto [sum, moment] = resultants(c.dim, element.force, c.x);
      EXPECT_LT(sum.norm(), 1e-12 * element.force.norm());
      if (has_faces && is_finite) // even at a gap: the slip direction turns with it
      {
        EXPECT_LT(moment.norm(), 1e-11 * element.force.norm());
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Every, ElementWithoutSlip, testing::ValuesIn(slipless_case_kinds()),
                         [](const auto &info) { return info.param; });
INSTANTIATE_TEST_SUITE_P(Every, Element, testing::ValuesIn(case_kinds()), [](const auto &info) { return info.param; });

/// A node 0.01 inside the segment from (0, 0) to (2, 0), whose outward normal is -y.
ContactLinearisation flat_segment(double slip)
{
  Case c = make_case("segment", 0, false);
  ContactLinearisation lin = c.linearise(c.x);
  lin.gap = -0.01;
  lin.slip = {slip, 0};
  return lin;
}

TEST(ContactStatus, FollowsTheTable)
{
  const Multipliers none;
  EXPECT_EQ(contact_status(flat_segment(0), {1, {}}, 0.3, 10), ContactStatus::open);
  EXPECT_EQ(contact_status(flat_segment(0), none, 0.3, 10), ContactStatus::stick);
  EXPECT_EQ(contact_status(flat_segment(0.002), none, 0.3, 10), ContactStatus::stick);
  EXPECT_EQ(contact_status(flat_segment(0.004), none, 0.3, 10), ContactStatus::slip);
  EXPECT_EQ(contact_status(flat_segment(0), none, 0, 10), ContactStatus::slip) << "without friction";
  EXPECT_EQ(contact_status(flat_segment(0), {0.1, {}}, 0.3, 10), ContactStatus::stick) << "sigma_n = 0 is closed";
}

TEST(ContactElement, SlipWithoutADirectionIsFinite)
{
  for (const double mu : {0., 0.3})
  {
    const ContactElement element = contact_element(flat_segment(0), {}, mu, 10, ContactStatus::slip);
    EXPECT_TRUE(whole_residual(element).allFinite());
    EXPECT_TRUE(whole_tangent(element).allFinite());
    EXPECT_EQ(element.constraint[1], 0);
    EXPECT_DOUBLE_EQ(element.constraint_by_multiplier(1, 1), -0.1);
  }
}

TEST(ContactElement, AStatusMayBeHeldAgainstSigma)
{
  // Pulled apart but held in slip: the gap is still closed, and friction does not push the wrong way.
  const ContactElement element = contact_element(flat_segment(0.1), {5, {1, 0}}, 0.3, 10, ContactStatus::slip);
  EXPECT_DOUBLE_EQ(element.constraint[0], -0.01);
  EXPECT_DOUBLE_EQ(element.constraint[1], -0.1);
}
} // namespace
} // namespace amontons::test
