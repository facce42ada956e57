#include "problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

/// Surfaces that touch themselves, held against the same problem with its sides named.
namespace amontons::test
{
namespace
{
constexpr double thickness = 0.1, leg = 1, longer = 0.043, radius = 0.08; // of the mean line of the bend
constexpr double inner_gap = 2 * radius - thickness;

/// Two legs, the upper one longer, joined by a half-circle: x along the strip and y across it, from 0 to 1.
Point fold(const Point &x)
{
  const double arc = std::numbers::pi * radius, s = x[0] * (2 * leg + longer + arc), offset = (x[1] - 0.5) * thickness;
  if (s <= leg)
    return {s, offset, x[2]};
  if (s >= leg + arc)
    return {2 * leg + arc - s, 2 * radius - offset, x[2]};
  const double phi = (s - leg) / radius;
  return {leg + (radius - offset) * std::sin(phi), radius - (radius - offset) * std::cos(phi), x[2]};
}

/// A folded strip, its ends pressed together until they touch, and pushed along each other.
Problem folded(Strain strain, double mu, bool self)
{
  Blocks blocks(2);
  blocks.add("strip", {0, 0, 0}, {1, 1, 0}, {64, 2, 0}, fold);
  blocks.add_union("inner_lower", {"strip_top"}, [](const Point &x) { return x[0] < leg && x[1] < radius; });
  blocks.add_union("inner_upper", {"strip_top"}, [](const Point &x) { return x[0] < leg && x[1] > radius; });
  Problem problem(blocks, Kinematics::plane_strain, strain);
  problem.elastic("strip", 100, 0.3);
  if (self)
    problem.contact("strip_top", "strip_top", mu);
  else
    problem.contact("inner_lower", "inner_upper", mu);
  problem.on("strip_left").fix = {0, 1};
  BoundaryOptions &end = problem.on("strip_right");
  end.displacement[0] = expression("0.004*t");
  end.displacement[1] = expression(std::to_string(-1.2 * inner_gap) + "*t");
  problem.options.loading.increments = 5;
  return problem;
}

/// Differences of all displacements, and of the pressures and tractions of the nodes of `pair` in `self`.
void expect_alike(const Record &self, const Record &pair, double tolerance)
{
  EXPECT_LT(relative_difference(self.state().displacement, pair.state().displacement), tolerance);
  const ContactResult &a = self.contact(), &b = pair.contact();
  EXPECT_GT(b.n_active, 0);
  EXPECT_EQ(a.n_active, b.n_active);
  EXPECT_EQ(a.n_stick, b.n_stick);
  const auto d = static_cast<std::size_t>(self.mesh.dim);
  std::vector<double> force_a, force_b;
  for (std::size_t i = 0; i < self.impactor_nodes[0].size(); ++i)
    for (std::size_t j = 0; j < pair.impactor_nodes[0].size(); ++j)
      if (self.impactor_nodes[0][i] == pair.impactor_nodes[0][j])
        for (std::size_t c = 0; c < d; ++c)
        {
          force_a.push_back(a.force[i * d + c]);
          force_b.push_back(b.force[j * d + c]);
        }
  EXPECT_EQ(force_b.size(), b.force.size());
  EXPECT_LT(relative_difference(force_a, force_b), tolerance);
  EXPECT_LT((total_force(a) - total_force(b)).norm(), tolerance * total_force(b).norm());
  EXPECT_LT((sum_of_nodes(a) - total_force(a)).norm(), 1e-12 * total_force(a).norm());
}

TEST(SelfContact, AFoldedStripAsWithItsSidesNamed)
{
  for (const Strain strain : {Strain::small, Strain::finite})
    for (const double mu : {0.0, 0.3})
    {
      SCOPED_TRACE((strain == Strain::small ? "small, mu = " : "finite, mu = ") + std::to_string(mu));
      Problem with_self = folded(strain, mu, true), named = folded(strain, mu, false);
      for (Problem *problem : {&with_self, &named})
        problem->options.solver.tolerance = 1e-11;
      const Record self = with_self.converge(), pair = named.converge();
      expect_alike(self, pair, 1e-8);
      EXPECT_LT((self.reaction("strip_left") + self.reaction("strip_right")).norm(),
                1e-8 * self.reaction("strip_left").norm());
    }
}

/// Two blocks, all of whose sides are one surface; the upper one is coarser.
Problem blocks_in_one_skin(int dim, Strain strain, bool self)
{
  Blocks blocks(dim);
  blocks.add("lower", {0, 0, 0}, {1, 1, 1}, dim == 2 ? std::array{6, 4, 0} : std::array{3, 3, 2});
  Point corner(0.25, 0.25, 0);
  corner[dim - 1] = 1.01;
  blocks.add("upper", corner, {0.5, 0.5, 0.5}, dim == 2 ? std::array{2, 2, 0} : std::array{2, 1, 1});
  std::vector<std::string> sides{"lower_top", "lower_left", "lower_right", "upper_bottom", "upper_left", "upper_right"};
  if (dim == 3)
    sides.insert(sides.end(), {"lower_front", "lower_back", "upper_front", "upper_back"});
  blocks.add_union("skin", sides);
  Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional, strain);
  problem.elastic("lower", 1, 0.3);
  problem.elastic("upper", 10, 0.3);
  if (self)
    problem.contact("skin", "skin");
  else
    problem.contact(dim == 2 ? "lower_top" : "upper_bottom", dim == 2 ? "upper_bottom" : "lower_top");
  problem.on("lower_bottom").fix = dim == 2 ? std::vector{0, 1} : std::vector{0, 1, 2};
  BoundaryOptions &top = problem.on("upper_top");
  for (int c = 0; c < dim; ++c)
    top.displacement[c] = expression(c == dim - 1 ? "-0.06*t" : "0");
  problem.options.solver.tolerance = 1e-11;
  return problem;
}

TEST(SelfContact, BodiesInOneSurfaceTellTheirSides)
{
  for (const int dim : {2, 3})
    for (const Strain strain : {Strain::small, Strain::finite})
    {
      SCOPED_TRACE(std::to_string(dim) + (strain == Strain::small ? "D, small" : "D, finite"));
      const Record self = blocks_in_one_skin(dim, strain, true).converge();
      const ContactResult &contact = self.contact();
      // The contact force is what the bodies are held with.
      EXPECT_LT((total_force(contact).cwiseAbs() - self.reaction("lower_bottom").cwiseAbs()).norm(),
                1e-8 * total_force(contact).norm());
      EXPECT_LT((self.reaction("lower_bottom") + self.reaction("upper_top")).norm(),
                1e-8 * total_force(contact).norm());
      if (dim == 2)
        expect_alike(self, blocks_in_one_skin(dim, strain, false).converge(), 1e-8);
    }
}
} // namespace
} // namespace amontons::test
