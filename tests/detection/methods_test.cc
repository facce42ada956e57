#include "amontons/detection/detector.h"
#include "amontons/surface/projection.h"
#include "detection/cases.h"

#include <gtest/gtest.h>

#include <iostream>
#include <optional>

namespace amontons::test
{
namespace
{
struct Comparison
{
  int n_paired = 0;
  int n_wrong = 0;
  int n_other_face = 0;
};

// Counts the nodes whose distance to the target differs from the oracle's.
Comparison compare(const Pairing &pairing, const Pairing &oracle)
{
  Comparison result;
  for (std::size_t i = 0; i < oracle.size(); ++i)
  {
    result.n_paired += oracle[i].kind != PairKind::none;
    if (pairing[i].kind != oracle[i].kind || pairing[i].reason != oracle[i].reason ||
        (oracle[i].face >= 0 && !(std::abs(pairing[i].distance - oracle[i].distance) <= 1e-14)))
      ++result.n_wrong;
    else
      result.n_other_face += pairing[i].face != oracle[i].face;
  }
  return result;
}

void expect_exact(const Case &c, unsigned seed, int n_nodes = 300)
{
  const Surface impactor = cloud_about(c.target, n_nodes, c.spread, seed);
  DetectionOptions options;
  options.method = DetectionMethod::brute;
  const auto oracle = make_detector(options, impactor, c.target);
  options.method = DetectionMethod::exact;
  const auto exact = make_detector(options, impactor, c.target);
  const Pairing expected = oracle->detect(impactor.reference, c.target.reference, 0.3 * c.spread);
  const Comparison result = compare(exact->detect(impactor.reference, c.target.reference, 0.3 * c.spread), expected);
  EXPECT_GT(result.n_paired, n_nodes / 5) << c.name;
  EXPECT_EQ(result.n_wrong, 0) << c.name << ", seed " << seed;
  EXPECT_EQ(result.n_other_face, 0) << c.name << ", seed " << seed;
}

TEST(ExactDetection, EqualsBruteForceInThePlane)
{
  for (const Case &c : cases_2d())
    for (const unsigned seed : {1U, 2U, 3U})
      expect_exact(c, seed);
}

TEST(ExactDetection, EqualsBruteForceOnQuadrilaterals)
{
  for (const Case &c : cases_3d(false))
    for (const unsigned seed : {1U, 2U})
      expect_exact(c, seed);
}

TEST(ExactDetection, EqualsBruteForceOnTriangles)
{
  for (const Case &c : cases_3d(true))
    for (const unsigned seed : {1U, 2U})
      expect_exact(c, seed);
}

// Surfaces of some 1e4 nodes; few nodes against them, for the sake of time.
TEST(ExactDetection, EqualsBruteForceOnLargerSurfaces)
{
  for (Case &c : cases_2d(30))
  {
    c.spread /= 30;
    expect_exact(c, 4, 200);
  }
  for (const bool triangles : {false, true})
    for (Case &c : cases_3d(triangles, 3))
    {
      c.spread /= 3;
      expect_exact(c, 4, 30);
    }
}

// Sheets with ends all round, one above another, and nodes all about them: many lie past an end and take another sheet.
Surface terraces(bool triangles)
{
  const auto map = [](double s, double t)
  {
    const int level = static_cast<int>(3 * t - 1e-9);
    const double y = 3 * t - level;
    return Point{(1 - 0.2 * level) * graded(s, 20), y, 0.2 * level + 0.05 * std::sin(5 * s + 7 * y)};
  };
  Surface all = sheet(24, 36, triangles, map);
  Surface cut; // without the faces from one level to the next
  cut.dim = 3;
  cut.node_ids = all.node_ids;
  cut.reference = all.reference;
  for (Index f = 0; f < all.n_faces(); ++f)
  {
    double low = 1, high = 0;
    for (const Index node : all.face(f))
    {
      low = std::min(low, all.reference[3 * static_cast<std::size_t>(node) + 1]);
      high = std::max(high, all.reference[3 * static_cast<std::size_t>(node) + 1]);
    }
    if (high - low > 0.2)
      continue;
    for (const Index node : all.face(f))
      cut.face_nodes.push_back(node);
    cut.face_offsets.push_back(static_cast<Index>(cut.face_nodes.size()));
    cut.face_ids.push_back(f);
  }
  cut.build_adjacency();
  return cut;
}

TEST(ExactDetection, EqualsBruteForcePastTheEnds)
{
  for (const bool triangles : {false, true})
  {
    const Surface target = terraces(triangles);
    const Surface impactor = cloud_about(target, 700, 0.2, 3);
    for (const std::optional<double> extension : {std::optional<double>{}, std::optional<double>{0.05}})
    {
      DetectionOptions options;
      options.extension = extension;
      options.method = DetectionMethod::brute;
      const auto oracle = make_detector(options, impactor, target);
      options.method = DetectionMethod::exact;
      const auto exact = make_detector(options, impactor, target);
      const Pairing expected = oracle->detect(impactor.reference, target.reference, 0.3);
      const Comparison result = compare(exact->detect(impactor.reference, target.reference, 0.3), expected);
      EXPECT_EQ(result.n_wrong + result.n_other_face, 0);
      const DetectionReport report = oracle->report();
      EXPECT_GT(report.unpaired_by_reason.at("past_end"), 20);
      EXPECT_GT(report.pairs_by_kind.at("extension"), 5);
      // Some take a sheet that is not the closest: farther away than the closest point of all.
      options.extension = 10;
      const auto all = make_detector(options, impactor, target);
      const Pairing &closest = all->detect(impactor.reference, target.reference, 0.3);
      int n_elsewhere = 0;
      for (std::size_t i = 0; i < expected.size(); ++i)
        n_elsewhere += expected[i].face >= 0 && expected[i].distance > closest[i].distance + 1e-12;
      EXPECT_GT(n_elsewhere, 20);
    }
  }
}

// The paper's rule looks only at the faces of the nearest node. Its distance is never too small; where the mesh is
// graded or stretched it is too large for some nodes: how many is recorded, and shown.
struct Misses
{
  int n_paired = 0, n_farther = 0, n_lost = 0;
};

Misses misses_of_nearest_node(const Case &c)
{
  const Surface impactor = cloud_about(c.target, 300, c.spread, 5);
  DetectionOptions options;
  options.method = DetectionMethod::brute;
  const auto oracle = make_detector(options, impactor, c.target);
  options.method = DetectionMethod::nearest_node;
  const auto nearest = make_detector(options, impactor, c.target);
  // A reach of the largest distance: then no node is lost because its nearest node is beyond w.
  const double reach = 2 * c.spread;
  const Pairing &expected = oracle->detect(impactor.reference, c.target.reference, reach);
  const Pairing &pairing = nearest->detect(impactor.reference, c.target.reference, reach);
  Misses misses;
  for (std::size_t i = 0; i < pairing.size(); ++i)
  {
    if (expected[i].kind == PairKind::none)
      continue;
    ++misses.n_paired;
    misses.n_lost += pairing[i].kind == PairKind::none;
    misses.n_farther += pairing[i].kind != PairKind::none && pairing[i].distance > expected[i].distance + 1e-13;
    if (pairing[i].kind == PairKind::face && expected[i].kind == PairKind::face)
      EXPECT_GE(pairing[i].distance, expected[i].distance - 1e-13) << c.name;
  }
  std::cout << c.name << ": nearest-node is farther for " << misses.n_farther << " and loses " << misses.n_lost
            << " of " << misses.n_paired << " nodes\n";
  return misses;
}

TEST(NearestNodeDetection, IsRightOnUniformMeshes)
{
  for (const std::size_t uniform : {0U, 5U})
  {
    const Misses misses = misses_of_nearest_node(cases_2d()[uniform]);
    EXPECT_EQ(misses.n_lost, 0);
    EXPECT_LE(misses.n_farther, misses.n_paired / 50);
  }
}

TEST(NearestNodeDetection, WrongAnswersAreCounted)
{
  int n_wrong = 0;
  for (const bool triangles : {false, true})
    for (const Case &c : cases_3d(triangles))
    {
      const Misses misses = misses_of_nearest_node(c);
      n_wrong += misses.n_farther;
    }
  EXPECT_GT(n_wrong, 0); // the rule is not exact: if it were, the exact method would be needless
}

// One detector over several motions: what it keeps between detections must not show.
TEST(ExactDetection, RedetectionEqualsDetectionFromScratch)
{
  for (Case &c : cases_3d(true))
  {
    const Surface impactor = cloud_about(c.target, 300, c.spread, 9);
    const DetectionOptions options;
    const auto kept = make_detector(options, impactor, c.target);
    std::vector<double> x = c.target.reference, y = impactor.reference;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> move(-0.4 * c.spread, 0.4 * c.spread);
    for (int step = 0; step < 6; ++step)
    {
      const Pairing &again = kept->detect(y, x, c.spread);
      const auto fresh = make_detector(options, impactor, c.target);
      const Comparison result = compare(again, fresh->detect(y, x, c.spread));
      EXPECT_EQ(result.n_wrong + result.n_other_face, 0) << c.name << ", step " << step;
      for (std::size_t i = 0; i < x.size(); ++i) // large steps too: the order of the boxes is made anew
        x[i] = step < 3 ? 1.1 * x[i] : x[i] * (i % 3 == 0 ? 3 : 0.5);
      for (std::size_t i = 0; i < y.size(); ++i)
        y[i] = (step < 3 ? 1.1 * y[i] : y[i] * (i % 3 == 0 ? 3 : 0.5)) + move(random);
    }
  }
}
} // namespace
} // namespace amontons::test
