#include "problem.h"

#include <gmock/gmock.h>

/// Bodies that overlap before anything moves.
namespace amontons::test
{
namespace
{
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double overlap = 0.01;

/// Two bars of height 1 and 2, without Poisson's effect, that overlap where they meet.
Problem bars(Strain strain, InitialOverlap rule)
{
  Blocks blocks(2);
  blocks.add("lower", {0, 0, 0}, {1, 1, 0}, {3, 2, 0});
  blocks.add("upper", {0, 1 - overlap, 0}, {1, 2, 0}, {3, 3, 0});
  Problem problem(blocks, Kinematics::plane_strain, strain);
  problem.elastic("lower", 3, 0);
  problem.elastic("upper", 1, 0);
  problem.contact("upper_bottom", "lower_top").initial_overlap = rule;
  problem.on("lower_bottom").fix = {1};
  problem.on("lower_left").fix = {0};
  problem.on("upper_left").fix = {0};
  problem.on("upper_top").displacement[1] = expression("-0.02*max(t-1,0)");
  problem.options.loading.end = 2;
  problem.options.loading.increments = 2;
  return problem;
}

/// Pressure that closes an interference: the bars' compliances in a row.
double bar_pressure(double interference)
{
  return interference / (1.0 / 3 + 2.0 / 1);
}

TEST(InitialOverlap, ResolvedAsInterference)
{
  const Record run = bars(Strain::small, InitialOverlap::resolve).converge();
  ASSERT_EQ(run.states.size(), 3u);
  for (const double p : run.states[1].contacts[0].pressure)
    EXPECT_NEAR(p, bar_pressure(overlap), 1e-10);
  for (const double p : run.contact().pressure)
    EXPECT_NEAR(p, bar_pressure(overlap + 0.02), 1e-10);
  EXPECT_THAT(run.warnings, ElementsAre(HasSubstr("4 nodes lie inside the target at the start")));
  EXPECT_THAT(run.warnings[0], HasSubstr("resolved as interference"));
}

TEST(InitialOverlap, AdjustedLeavesNoStress)
{
  for (const Strain strain : {Strain::small, Strain::finite})
  {
    const Record run = bars(strain, InitialOverlap::adjust).converge();
    EXPECT_NEAR(run.states[1].contacts[0].max_pressure, 0, 1e-12);
    for (const double s : run.states[1].stress)
      EXPECT_NEAR(s, 0, 1e-12);
    EXPECT_THAT(run.warnings, ElementsAre(HasSubstr("taken as touching")));
    for (const double p : run.contact().pressure)
      EXPECT_NEAR(p, bar_pressure(0.02), strain == Strain::small ? 1e-10 : 0.02 * bar_pressure(0.02));
  }
}

/// Lame's two rings with an interference, in plane stress: p = E d / (2 b) (b^2 - a^2)(c^2 - b^2) / (b^2 (c^2 - a^2)).
TEST(InitialOverlap, PressFitOfTwoRings)
{
  const double a = 0.2, b = 0.6, c = 1, interference = 1e-3;
  const auto quarter = [](double inner, double outer)
  {
    return [=](const Point &x)
    {
      const double r = inner + (outer - inner) * x[0];
      return Point(r * std::cos(M_PI / 2 * x[1]), r * std::sin(M_PI / 2 * x[1]), 0);
    };
  };
  Blocks blocks(2);
  blocks.add("hub", {0, 0, 0}, {1, 1, 0}, {12, 24, 0}, quarter(a, b + interference));
  blocks.add("ring", {0, 0, 0}, {1, 1, 0}, {12, 24, 0}, quarter(b, c));
  Problem problem(blocks, Kinematics::plane_stress);
  problem.elastic("hub", 1, 0.2);
  problem.elastic("ring", 1, 0.2);
  problem.contact("ring_left", "hub_right");
  for (const char *body : {"hub", "ring"})
  {
    problem.on(std::string(body) + "_bottom").fix = {1};
    problem.on(std::string(body) + "_top").fix = {0};
  }
  const Record run = problem.converge();
  const double exact = interference / (2 * b) * (b * b - a * a) * (c * c - b * b) / (b * b * (c * c - a * a));
  const ContactResult &contact = run.contact();
  double mean = 0;
  for (std::size_t i = 0; i < contact.pressure.size(); ++i)
    mean += contact.pressure[i] / static_cast<double>(contact.pressure.size());
  EXPECT_NEAR(mean, exact, 0.01 * exact);
  for (const double p : contact.pressure)
    EXPECT_NEAR(p, mean, 0.01 * mean) << "the same all round, on the planes of symmetry too";
}
} // namespace
} // namespace amontons::test
