#pragma once
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
} // namespace amontons
