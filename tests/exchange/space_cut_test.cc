// On any number of processes.
#include "amontons/exchange/grid_cut.h"
#include "amontons/exchange/part_boxes.h"
#include "amontons/exchange/space_cut.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace amontons
{
namespace
{
// Spread unevenly: with three processes the last has none.
std::vector<Place> own_share(const std::vector<Place> &points, const Communicator &world)
{
  std::vector<Place> own;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (static_cast<Rank>(i * i % static_cast<std::size_t>(world.size())) == world.rank())
      own.push_back(points[i]);
  return own;
}

TEST(SpaceCut, PartsHoldAsMuch)
{
  const Communicator world(MPI_COMM_WORLD);
  MessageExchange messages(world);
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::vector<Place> lattice, cloud, line;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
    {
      lattice.push_back({double(i), double(j), 0});
      cloud.push_back({std::exp(2 * normal(random)), std::exp(2 * normal(random)), 1e-3 * normal(random)});
      line.push_back({1.0, 2.0, std::pow(1.01, i * 60 + j - 3600.0)});
    }
  for (const auto &points : {lattice, cloud, line})
  {
    const SpaceCut cut(messages, "cut", own_share(points, world));
    std::vector<double> n(world.size(), 0.0);
    for (const Place &x : points)
      ++n.at(cut.part_of(x));
    for (const double own : n)
      EXPECT_NEAR(own, static_cast<double>(points.size()) / world.size(), 20);
  }
  const SpaceCut of_nothing(messages, "cut", {});
  EXPECT_LT(of_nothing.part_of({0, 0, 0}), world.size());
}

TEST(PartBoxes, ThoseThatABoxMeets)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const std::size_t n_parts : {1, 2, 3, 7, 16, 33})
  {
    std::vector<Box> boxes(n_parts);
    for (std::size_t p = 0; p < n_parts; p += p % 5 == 3 ? 2 : 1) // some stay empty
      for (int k = 0; k < 2; ++k)
        boxes[p].include(Place{double(p) + 1.5 * uniform(random), uniform(random), uniform(random)});
    const PartBoxes tree(boxes);
    for (int k = 0; k < 200; ++k)
    {
      Box box;
      box.include(Place{static_cast<double>(n_parts) * uniform(random), uniform(random), uniform(random)});
      const double distance = uniform(random);
      std::set<Rank> found, expected;
      tree.visit_meeting(box, distance, [&](Rank part) { EXPECT_TRUE(found.insert(part).second); });
      for (std::size_t p = 0; p < n_parts; ++p)
        if (boxes[p].meets(box, distance))
          expected.insert(static_cast<Rank>(p));
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(GridCut, BlocksOfEqualVolumeWithALayer)
{
  Box bounds;
  bounds.include(Place{0, 0, 0});
  bounds.include(Place{8, 4, 0.5});
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const int n_parts : {1, 2, 3, 5, 16, 1000})
  {
    const GridCut grid(bounds, 0.25, n_parts); // 16 x 8 x 1 cells
    std::vector<int> n(n_parts, 0);
    for (int k = 0; k < 8000; ++k)
    {
      const Place x{8 * uniform(random), 4 * uniform(random), 0.5 * uniform(random)};
      const Rank part = grid.part_of(x);
      ++n.at(part);
      // Anything within w of a node lies in the blocks its part is sent: every corner of the cube about it.
      for (int corner = 0; corner < 8; ++corner)
        EXPECT_TRUE(
            grid.grown_blocks()[part].holds({x[0] + (corner & 1 ? 0.25 : -0.25), x[1] + (corner & 2 ? 0.25 : -0.25),
                                             x[2] + (corner & 4 ? 0.25 : -0.25)},
                                            1e-12));
    }
    if (n_parts <= 16)
      for (const int own : n)
        EXPECT_NEAR(own, 8000 / n_parts, 8000 / n_parts * 0.2);
  }
}
} // namespace
} // namespace amontons
