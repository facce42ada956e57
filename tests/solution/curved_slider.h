#pragma once
#include "problem.h"

#include <cmath>
#include <numeric>

namespace amontons::test
{
/// A block with a curved foot ("slider", Young's modulus 2) on a larger one ("base", 1) that is held below; n cells of
/// the base along its height. What moves slider_top is left open.
inline Problem curved_slider(int dim, int n, double mu)
{
  const auto at = [dim](double across, double up)
  { return dim == 2 ? Point(across, up, 0) : Point(across, across, up); };
  const auto curved = [dim](const Point &x)
  {
    Point out = x;
    const double r2 = std::pow(x[0] - 1, 2) + (dim == 3 ? std::pow(x[1] - 1, 2) : 0);
    out[dim - 1] += r2 / 8 * (1 - x[dim - 1]);
    return out;
  };
  Blocks blocks(dim);
  blocks.add("base", at(0, -1), dim == 2 ? Point(2, 1, 0) : Point(2, 2, 1), {2 * n, dim == 2 ? n : 2 * n, n});
  blocks.add("slider", at(0.5, 0), Point::Ones(), {n + 1, n + 1, n + 1}, curved);
  Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional);
  problem.elastic("base");
  problem.elastic("slider", 2, 0.25);
  problem.contact("slider_bottom", "base_top", mu);
  std::vector<int> all(dim);
  std::iota(all.begin(), all.end(), 0);
  problem.on("base_bottom").fix = all;
  return problem;
}
} // namespace amontons::test
