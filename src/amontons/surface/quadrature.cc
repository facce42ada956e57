#include "amontons/surface/quadrature.h"

#include "amontons/base/error.h"

#include <array>
#include <cmath>
#include <numbers>

namespace amontons
{
namespace
{
constexpr int most_points = 16;

/// Legendre's polynomial of degree n and its derivative.
std::pair<double, double> legendre(int n, double z)
{
  double p = 1, before = 0;
  for (int k = 1; k <= n; ++k)
  {
    const double next = ((2 * k - 1) * z * p - (k - 1) * before) / k;
    before = p;
    p = next;
  }
  return {p, n * (z * p - before) / (z * z - 1)};
}

std::vector<GaussPoint> make_rule(int n)
{
  std::vector<GaussPoint> out;
  for (int i = 0; i < n; ++i)
  {
    double z = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    for (int step = 0; step < 8; ++step)
    {
      const auto [p, slope] = legendre(n, z);
      z -= p / slope;
    }
    const double slope = legendre(n, z).second;
    out.push_back({(1 - z) / 2, 1 / ((1 - z * z) * slope * slope)});
  }
  return out;
}

std::vector<TrianglePoint> make_triangle_rule(int n)
{
  std::vector<TrianglePoint> out;
  for (const GaussPoint &u : gauss_rule(n))
    for (const GaussPoint &v : gauss_rule(n))
      out.push_back({{1 - u.x, u.x * (1 - v.x), u.x * v.x}, u.weight * v.weight * u.x});
  return out;
}

/// The rule for each n, made once.
template<class Rule>
const Rule &rule_of(int n, Rule (*make)(int))
{
  static const auto rules = [make]
  {
    std::array<Rule, most_points + 1> out;
    for (int k = 1; k <= most_points; ++k)
      out[k] = make(k);
    return out;
  }();
  AMONTONS_ASSERT(n >= 1 && n <= most_points);
  return rules[n];
}
} // namespace

const std::vector<GaussPoint> &gauss_rule(int n)
{
  return rule_of(n, make_rule);
}

const std::vector<TrianglePoint> &triangle_rule(int n)
{
  return rule_of(n, make_triangle_rule);
}
} // namespace amontons
