#pragma once
#include "surface/surfaces.h"

#include <string>
#include <vector>

namespace amontons::test
{
/// A target, and how far about it impactor nodes are to lie.
struct Case
{
  std::string name;
  Surface target;
  double spread; ///< of the impactor nodes about the target
};

inline double graded(double s, double ratio)
{
  return std::expm1(std::log(ratio) * s) / (ratio - 1);
}

/// Some 300 segments each, times `fine`.
inline std::vector<Case> cases_2d(int fine = 1)
{
  using P = std::array<double, 2>;
  std::vector<Case> cases;
  cases.push_back({"wavy", curve(400 * fine, [](double s) { return P{-s, 0.05 * std::sin(30 * s)}; }), 0.02});
  cases.push_back({"graded 1:500", curve(300 * fine, [](double s) { return P{-graded(s, 500), 0.1 * s * s}; }), 0.03});
  cases.push_back({"circle",
                   curve(
                       300 * fine,
                       [](double s) {
                         return P{std::cos(6.283185307179586 * s), -std::sin(6.283185307179586 * s)};
                       },
                       true),
                   0.3});
  cases.push_back({"folded",
                   curve(400 * fine,
                         [](double s)
                         {
                           const double leg = 10 * s;
                           return P{std::abs(std::remainder(leg, 2.0)), 0.01 * leg};
                         }),
                   0.02});
  cases.push_back({"thin",
                   chain(
                       [fine]
                       {
                         std::vector<P> points;
                         for (int i = 0; i <= 200 * fine; ++i)
                           points.push_back({1 - i / (200.0 * fine), 0.002});
                         for (int i = 0; i <= 150 * fine; ++i)
                           points.push_back({i / (150.0 * fine), 0});
                         return points;
                       }(),
                       true),
                   0.01});
  cases.push_back({"shuffled", shuffled(cases[0].target, 7), 0.02});
  return cases;
}

/// Some 900 quadrilaterals, or twice as many triangles, each, times the square of `fine`.
inline std::vector<Case> cases_3d(bool triangles, int fine = 1)
{
  std::vector<Case> cases;
  const auto wavy = [](double s, double t) { return Point{s, t, 0.05 * std::sin(20 * s) * std::cos(15 * t)}; };
  cases.push_back({"wavy", sheet(30 * fine, 30 * fine, triangles, wavy), 0.05});
  cases.push_back({"graded 1:50",
                   sheet(30 * fine, 30 * fine, triangles,
                         [](double s, double t)
                         {
                           const double x = graded(s, 50), y = graded(t, 50);
                           return Point{x, y, 0.2 * x * y};
                         }),
                   0.1});
  cases.push_back({"aspect 100",
                   sheet(5 * fine, 150 * fine, triangles,
                         [](double s, double t) {
                           return Point{3 * s, 0.9 * t, 0.05 * std::sin(4 * s + 9 * t)};
                         }),
                   0.1});
  cases.push_back({"torus",
                   sheet(
                       36 * fine, 24 * fine, triangles, [](double s, double t) { return torus(s, t, 1, 0.4); }, true),
                   0.2});
  cases.push_back({"thin",
                   sheet(
                       36 * fine, 24 * fine, triangles,
                       [](double s, double t)
                       {
                         Point x = torus(s, t, 1, 0.4);
                         x[2] *= 0.02;
                         return x;
                       },
                       true),
                   0.05});
  cases.push_back({"folded",
                   sheet(60 * fine, 12 * fine, triangles,
                         [](double s, double t) {
                           return Point{0.5 * std::sin(25 * s), t, 0.5 * s + 0.02 * std::sin(7 * t)};
                         }),
                   0.1});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.3 / (30 * fine), 0.3 / (30 * fine));
  cases.push_back({"random",
                   sheet(30 * fine, 30 * fine, triangles,
                         [&](double s, double t) {
                           return Point{s + noise(random), t + noise(random), noise(random)};
                         }),
                   0.05});
  cases.push_back({"shuffled", shuffled(cases[0].target, 11), 0.05});
  return cases;
}
} // namespace amontons::test
