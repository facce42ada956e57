#include "amontons/detection/node_grid.h"
#include "amontons/detection/search_distance.h"
#include "detection/cases.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace amontons::test
{
namespace
{
std::vector<Eigen::Vector3d> nodes_of(const Surface &surface)
{
  std::vector<Eigen::Vector3d> nodes;
  for (std::size_t i = 0; i < surface.reference.size(); i += surface.dim)
    nodes.emplace_back(surface.reference[i], surface.reference[i + 1], surface.dim == 3 ? surface.reference[i + 2] : 0);
  return nodes;
}

// The nodes that lie in the cells that are looked at, each once.
std::set<Index> visited(const NodeGrid &grid, const Eigen::Vector3d &x)
{
  std::set<Index> nodes;
  grid.visit_near(x, std::numeric_limits<double>::infinity(),
                  [&](std::span<const NodeGrid::Node> some)
                  {
                    for (const NodeGrid::Node &node : some)
                      EXPECT_TRUE(nodes.insert(node.node).second);
                  });
  return nodes;
}

// No node within w is missed, nor are all looked at.
void expect_neighbours(const Case &c)
{
  Target target(c.target);
  target.move_to(c.target.reference);
  const double w = search_distance(target, {}, 0).w;
  NodeGrid grid;
  grid.fill(target, w);
  const std::vector<Eigen::Vector3d> nodes = nodes_of(c.target);
  std::size_t n_near = 0;
  for (const Eigen::Vector3d &x : nodes_of(cloud_about(c.target, 100, w / 2, 3)))
  {
    const std::set<Index> seen = visited(grid, x);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if ((nodes[i] - x).norm() <= w)
      {
        ++n_near;
        EXPECT_TRUE(seen.contains(static_cast<Index>(i))) << c.name;
      }
    EXPECT_LT(seen.size(), nodes.size()) << c.name;
  }
  EXPECT_GT(n_near, 50U) << c.name;
}

TEST(NodeGrid, HoldsAllNodesWithinReach)
{
  for (const Case &c : cases_2d())
    expect_neighbours(c);
  for (const Case &c : cases_3d(false))
    expect_neighbours(c);
}

// On a lattice with a node in the middle of each cell: the own cell and 3 of its 8 neighbours in the plane, 7 of its 26
// in space, those on the side where the point is.
TEST(NodeGrid, LooksAtTheNeighboursOnTheNodesSide)
{
  constexpr int n = 20;
  for (const int dim : {2, 3})
  {
    std::vector<double> x;
    for (int k = 0; k < (dim == 3 ? n : 1); ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
        {
          x.insert(x.end(), {i + 0.5, j + 0.5});
          if (dim == 3)
            x.push_back(k + 0.5);
        }
    const Surface lattice = cloud(dim, x);
    Target target(lattice);
    target.move_to(lattice.reference);
    NodeGrid grid;
    grid.fill(target, 0.499999); // n cells, 1 wide, from -w to n - 1 + w about the nodes
    const std::set<Index> seen = visited(grid, {7.7, 9.2, dim == 3 ? 3.9 : 0});
    std::set<Index> expected;
    for (const int k : dim == 3 ? std::vector<int>{3, 4} : std::vector<int>{0})
      for (const int j : {8, 9})
        for (const int i : {7, 8})
          expected.insert((k * n + j) * n + i);
    EXPECT_EQ(seen, expected);
  }
}

// Memory goes with the nodes: a diagonal in a box of 1e12 cells.
TEST(NodeGrid, TakesABoxThatIsNearlyEmpty)
{
  const Surface diagonal = curve(2000, [](double s) { return std::array<double, 2>{1e6 * s, 1e6 * s}; });
  Target target(diagonal);
  target.move_to(diagonal.reference);
  NodeGrid grid;
  grid.fill(target, 0.5);
  EXPECT_EQ(visited(grid, {5e5 + 0.2, 5e5 - 0.1, 0}), std::set<Index>{1000});
  EXPECT_TRUE(visited(grid, {5e5 + 200, 5e5, 0}).empty());
}
} // namespace
} // namespace amontons::test
