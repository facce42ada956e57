#include "amontons/detection/box_tree.h"

#include "amontons/detection/hilbert.h"
#include "amontons/detection/near_leaves.h"
#include "detection/box_kernel_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace amontons::test
{
namespace
{
// Along the Hilbert curve one goes from each cell to one that shares a side with it, and visits them all.
template<int dim>
void expect_a_curve_through_all_cells()
{
  constexpr int bits = 4, side = 1 << bits, n = dim == 2 ? side * side : side * side * side;
  for (const BoxKernels<dim> &kernels : kernels_of_this_processor<dim>())
  {
    std::vector<std::vector<std::uint32_t>> cells(dim, std::vector<std::uint32_t>(n));
    for (int i = 0, rest = 0; i < n; ++i)
    {
      rest = i;
      for (int c = 0; c < dim; ++c, rest /= side)
        cells[c][i] = static_cast<std::uint32_t>(rest % side);
    }
    const auto original = cells;
    std::array<std::uint32_t *, dim> rows;
    for (int c = 0; c < dim; ++c)
      rows[c] = cells[c].data();
    std::vector<std::uint64_t> positions(n);
    kernels.hilbert(rows.data(), n, bits, positions.data());
    std::vector<int> cell_at(n, -1);
    for (int i = 0; i < n; ++i)
    {
      ASSERT_LT(positions[i], static_cast<std::uint64_t>(n));
      ASSERT_EQ(cell_at[positions[i]], -1);
      cell_at[positions[i]] = i;
    }
    for (int place = 1; place < n; ++place)
    {
      int steps = 0;
      for (int c = 0; c < dim; ++c)
        steps +=
            std::abs(static_cast<int>(original[c][cell_at[place]]) - static_cast<int>(original[c][cell_at[place - 1]]));
      ASSERT_EQ(steps, 1) << place;
    }
  }
}

TEST(HilbertCurve, GoesThroughAllCellsStepByStep)
{
  expect_a_curve_through_all_cells<2>();
  expect_a_curve_through_all_cells<3>();
}

TEST(HilbertCurve, OrdersPointsOfVeryDifferentSpacing)
{
  std::vector<std::array<double, 2>> points;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 3000; ++i)
  {
    const double size = i % 3 == 0 ? 1.0 : 1e-5;
    points.push_back({size * uniform(random), size * uniform(random)});
  }
  const std::vector<Index> order = curve_order<2>(points);
  EXPECT_EQ(std::set<Index>(order.begin(), order.end()).size(), points.size());
  double way = 0;
  for (std::size_t i = 1; i < order.size(); ++i)
  {
    const auto &a = points[order[i]], &b = points[order[i - 1]];
    if (std::max({a[0], a[1], b[0], b[1]}) < 1e-5)
      way += std::hypot(a[0] - b[0], a[1] - b[1]);
  }
  // 2000 points in a square of 1e-5: a way of about 0.9 sqrt(area n); at random it would be 0.52e-5 per step.
  EXPECT_LT(way, 1.3e-5 * std::sqrt(2000.0));
}

template<int dim>
using Boxes = std::vector<std::array<double, static_cast<std::size_t>(2 * dim)>>;

// Boxes about a wavy surface, far from the origin so that rounding to single precision counts.
template<int dim>
Boxes<dim> random_boxes(int n)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  Boxes<dim> boxes(n);
  for (auto &box : boxes)
  {
    double height = 1000;
    for (int c = 0; c + 1 < dim; ++c)
    {
      box[c] = uniform(random) - 300;
      height += 0.05 * std::sin(20 * box[c]);
    }
    box[dim - 1] = height;
    for (int c = 0; c < dim; ++c)
      box[c + dim] = box[c] + 0.02 * uniform(random);
  }
  return boxes;
}

// Of a box from the box [low, high].
template<int dim>
double squared_distance(const std::array<double, static_cast<std::size_t>(2 * dim)> &box,
                        const std::array<double, static_cast<std::size_t>(dim)> &low,
                        const std::array<double, static_cast<std::size_t>(dim)> &high)
{
  double result = 0;
  for (int c = 0; c < dim; ++c)
  {
    const double distance = std::max({box[c] - high[c], low[c] - box[c + dim], 0.0});
    result += distance * distance;
  }
  return result;
}

template<int dim>
void expect_all_boxes_in_reach(int n)
{
  const Boxes<dim> boxes = random_boxes<dim>(n);
  std::vector<std::array<double, dim>> centres(n);
  typename BoxTree<dim>::Box all = boxes[0];
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < dim; ++c)
    {
      centres[i][c] = 0.5 * (boxes[i][c] + boxes[i][c + dim]);
      all[c] = std::min(all[c], boxes[i][c]);
      all[c + dim] = std::max(all[c + dim], boxes[i][c + dim]);
    }
  BoxTree<dim> tree;
  tree.order_by(centres, n);
  tree.refit(all, [&](std::size_t slot) { return boxes[tree.order()[slot]]; });
  int n_needed = 0, n_found = 0;
  for (int trial = 0; trial < 50; ++trial)
  {
    const double bound = 1e-4 * (trial % 5);
    Region<dim> region = Region<dim>::none();
    std::vector<std::array<double, dim>> points(5);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      for (int c = 0; c < dim; ++c)
        points[i][c] = boxes[trial * 7919 % n][c] + 0.01 * std::sin(static_cast<double>(trial + c) + i);
      region.extend(points[i]);
    }
    const auto low = tree.relative(region.low.data()), high = tree.relative(region.high.data());
    std::vector<std::uint32_t> leaves(n / BoxTree<dim>::width + 1), slots(n);
    leaves.resize(tree.collect(low, high, bound, leaves.data(), static_cast<int>(leaves.size())));
    slots.resize(tree.list(leaves, low, high, bound, slots.data(), n));
    std::set<Index> listed;
    for (const std::uint32_t slot : slots)
      listed.insert(tree.order()[slot]);
    EXPECT_EQ(listed.size(), slots.size());
    n_found += static_cast<int>(listed.size());
    for (Index f = 0; f < n; ++f)
    {
      if (squared_distance<dim>(boxes[f], region.low, region.high) > bound)
        continue;
      ++n_needed;
      EXPECT_TRUE(listed.contains(f)) << f;
    }
    for (const auto &x : points)
    {
      std::set<Index> visited;
      tree.visit_within(
          x.data(), bound, [&](Index slot) { visited.insert(tree.order()[slot]); },
          [](int, std::size_t) { return true; });
      for (Index f = 0; f < n; ++f)
        EXPECT_TRUE(visited.contains(f) || squared_distance<dim>(boxes[f], x, x) > bound) << f;
      EXPECT_TRUE(std::includes(listed.begin(), listed.end(), visited.begin(), visited.end()));
    }
    if (slots.size() > 1)
      EXPECT_GT(tree.list(leaves, low, high, bound, slots.data(), static_cast<int>(slots.size()) - 1),
                static_cast<int>(slots.size()) - 1);
    if (leaves.size() > 1)
      EXPECT_GT(tree.collect(low, high, bound, leaves.data(), static_cast<int>(leaves.size()) - 1),
                static_cast<int>(leaves.size()) - 1);
  }
  EXPECT_GE(n_needed, n < 50 ? 20 : 200);
  EXPECT_LT(n_found, 1.2 * n_needed + 20);
}

TEST(BoxTree, FindsAllBoxesInReach)
{
  for (const int n : {1, 16, 17, 3000})
  {
    expect_all_boxes_in_reach<2>(n);
    expect_all_boxes_in_reach<3>(n);
  }
}
} // namespace
} // namespace amontons::test
