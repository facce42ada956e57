#include "amontons/detection/box_tree.h"

#include "amontons/detection/hilbert.h"
#include "amontons/detection/near_leaves.h"
#include "amontons/surface/instruction_set.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <random>
#include <set>

namespace amontons
{
namespace
{
template<int dim>
std::vector<BoxKernels<dim>> kernels_of_this_processor()
{
  std::vector<InstructionSet> sets{InstructionSet::baseline};
  if (instruction_set() != InstructionSet::baseline)
    sets.push_back(InstructionSet::avx2);
  if (instruction_set() == InstructionSet::avx512)
    sets.push_back(InstructionSet::avx512);
  std::vector<BoxKernels<dim>> result;
  for (const InstructionSet set : sets)
    if constexpr (dim == 2)
      result.push_back(set == InstructionSet::baseline ? baseline::box_kernels_2()
                       : set == InstructionSet::avx2   ? avx2::box_kernels_2()
                                                       : avx512::box_kernels_2());
    else
      result.push_back(set == InstructionSet::baseline ? baseline::box_kernels_3()
                       : set == InstructionSet::avx2   ? avx2::box_kernels_3()
                                                       : avx512::box_kernels_3());
  return result;
}

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

template<int dim>
double squared_distance(const std::array<double, static_cast<std::size_t>(2 * dim)> &box, const double *x)
{
  double result = 0;
  for (int c = 0; c < dim; ++c)
  {
    const double distance = std::max({box[c] - x[c], x[c] - box[c + dim], 0.0});
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
  constexpr int n_points = 5, most = BoxGroup<dim>::most_points;
  auto group = std::make_unique<BoxGroup<dim>>();
  int n_needed = 0, n_found = 0;
  for (int trial = 0; trial < 50; ++trial)
  {
    std::array<std::array<double, dim>, n_points> points;
    const double bound = 1e-4 * (trial % 5);
    std::array<float, most> bounds;
    std::array<std::uint32_t, most> known, likeliest;
    bounds.fill(-1);
    known.fill(no_slot);
    Region<dim> region = Region<dim>::none();
    for (int i = 0; i < n_points; ++i)
    {
      const auto &near = boxes[trial * 7919 % n];
      for (int c = 0; c < dim; ++c)
        points[i][c] = near[c] + 0.01 * std::sin(trial + c + i);
      region.extend(points[i]);
      const auto x = tree.relative(points[i].data());
      for (int c = 0; c < dim; ++c)
        group->x[c][i] = x[c];
      bounds[i] = BoxTree<dim>::rounded_up(bound / (1 + i));
    }
    std::vector<std::uint32_t> leaves(n / BoxTree<dim>::width + 1);
    const int n_leaves = tree.collect(tree.relative(region.low.data()), tree.relative(region.high.data()), bound,
                                      leaves.data(), static_cast<int>(leaves.size()));
    leaves.resize(n_leaves);
    ASSERT_TRUE(tree.measure(leaves, n_points, bound, *group, likeliest.data()));
    std::vector<std::uint16_t> near(group->n_slots);
    box_kernels<dim>().select(*group, bounds.data(), known.data(), near.data());
    for (int i = 0; i < n_points; ++i)
    {
      std::set<Index> found, visited;
      for (int k = 0; k < group->n_slots; ++k)
        if (near[k] >> i & 1)
          found.insert(tree.order()[group->slots[k]]);
      const double own_bound = bound / (1 + i);
      tree.visit_within(
          points[i].data(), own_bound, [&](Index slot) { visited.insert(tree.order()[slot]); },
          [](int, std::size_t) { return true; });
      EXPECT_EQ(found, visited);
      EXPECT_TRUE(likeliest[i] != no_slot || found.empty());
      n_found += static_cast<int>(found.size());
      for (Index f = 0; f < n; ++f)
        if (squared_distance<dim>(boxes[f], points[i].data()) <= own_bound)
        {
          ++n_needed;
          EXPECT_TRUE(found.contains(f)) << f;
        }
      if (found.empty())
        continue;
      known[i] = likeliest[i]; // a box that is known is not given again
      box_kernels<dim>().select(*group, bounds.data(), known.data(), near.data());
      for (int k = 0; k < group->n_slots; ++k)
        EXPECT_EQ(near[k] >> i & 1, group->slots[k] != likeliest[i] && found.contains(tree.order()[group->slots[k]]));
    }
  }
  EXPECT_GE(n_needed, 200 / (n < 50 ? 4 : 1));
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
} // namespace amontons
