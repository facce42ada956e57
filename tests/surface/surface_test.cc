#include "amontons/surface/surface.h"

#include "surface/surfaces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace amontons::test
{
namespace
{
using std::numbers::pi;

double total(const std::vector<double> &areas)
{
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

TEST(Surface, AdjacencyListsEachFaceOfEachNode)
{
  const Surface surface = shuffled(sheet(4, 3, true, [](double s, double t) { return Point{s, t, 0}; }), 3);
  Index n_entries = 0;
  for (Index node = 0; node < surface.n_nodes(); ++node)
    for (const Index f : surface.faces_of_node(node))
    {
      const auto nodes = surface.face(f);
      EXPECT_NE(std::find(nodes.begin(), nodes.end(), node), nodes.end());
      ++n_entries;
    }
  EXPECT_EQ(n_entries, 3 * surface.n_faces());
}

TEST(TributaryAreas, SegmentsInThePlane)
{
  const Surface surface = chain({{0, 0}, {3, 4}, {3, 5}});
  EXPECT_EQ(tributary_areas(surface, false), (std::vector<double>{2.5, 3, 0.5}));
}

// Integrals of N_i 2 pi r over a straight segment, by hand; on the axis the first node's is not zero.
TEST(TributaryAreas, SegmentsOnTheRing)
{
  const Surface disc = chain({{0, 1}, {0.5, 1}, {2, 1}});
  const auto areas = tributary_areas(disc, true);
  EXPECT_NEAR(areas[0], 2 * pi * 0.5 * 0.5 / 6, 1e-15);
  EXPECT_NEAR(areas[2], 2 * pi * 1.5 * (0.5 / 6 + 2.0 / 3), 1e-14);
  EXPECT_NEAR(total(areas), 4 * pi, 1e-14);
  // A frustum's lateral area.
  const Surface frustum = chain({{1, 0}, {2, 3}, {2.5, 4.5}});
  EXPECT_NEAR(total(tributary_areas(frustum, true)), pi * (1 + 2.5) * std::hypot(1.5, 4.5), 1e-13);
}

TEST(TributaryAreas, PlaneFacesAddUpToTheArea)
{
  // A parallelogram's image, by quadrilaterals that are not parallelograms.
  const auto map = [](double s, double t)
  {
    const double p = s + 0.2 * s * (1 - s) * t, q = t + 0.3 * t * (1 - t) * s;
    return Point{2 * p + q, p - q, 3 * q};
  };
  const double area = std::hypot(std::hypot(1.0 * 3, 2 * 3.0), 3.0); // |(2,1,0) x (1,-1,3)|
  for (const bool triangles : {false, true})
    EXPECT_NEAR(total(tributary_areas(sheet(7, 5, triangles, map), false)), area, 1e-13);
}

TEST(TributaryAreas, OneTrapezium)
{
  const Surface surface = []
  {
    Surface s = sheet(1, 1, false, [](double a, double b) { return Point{a * (1 + b), b, 0}; });
    return s;
  }();
  // |J| = 1 + t: integrals of N_i (1 + t) over the unit square.
  const auto areas = tributary_areas(surface, false);
  const double low = 0.5 * (0.5 + 1.0 / 6), high = 0.5 * (0.5 + 1.0 / 3);
  EXPECT_NEAR(areas[0], low, 1e-15);
  EXPECT_NEAR(areas[1], low, 1e-15);
  EXPECT_NEAR(areas[2], high, 1e-15);
  EXPECT_NEAR(areas[3], high, 1e-15);
}
} // namespace
} // namespace amontons::test
