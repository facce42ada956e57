#pragma once
#include <array>
#include <vector>

namespace amontons
{
/// A point of [0, 1] with its weight; the weights of a rule sum to 1.
struct GaussPoint
{
  double x = 0, weight = 0;
};

/// Gauss's rule of n points on [0, 1], exact for polynomials of degree 2 n - 1. @param n >= 1
const std::vector<GaussPoint> &gauss_rule(int n);

/// A point of a triangle by its shares of the corners; the weights of a rule sum to 1/2, the unit triangle's area.
struct TrianglePoint
{
  std::array<double, 3> share{};
  double weight = 0;
};

/// Gauss's rule of n by n points squeezed onto a triangle (conical product), exact for polynomials of degree 2 n - 2.
const std::vector<TrianglePoint> &triangle_rule(int n);
} // namespace amontons
