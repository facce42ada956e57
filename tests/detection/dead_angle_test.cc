// The table of dead angles (THEORY.md section 4, step 4): what is returned where no face, or more than one, holds the
// node's projection. Every case is run with all three methods, with the faces' ids in both orders where they tie.
#include "amontons/detection/detector.h"
#include "detection/dead_angles.h"

#include <gtest/gtest.h>

#include <optional>

namespace amontons::test
{
namespace
{
constexpr std::array<DetectionMethod, 3> all_methods{DetectionMethod::exact, DetectionMethod::nearest_node,
                                                     DetectionMethod::brute};

struct Expected
{
  PairKind kind = PairKind::none;
  NoPairReason reason = NoPairReason::paired;
  double gap = 0, distance = 0;
  Index face = -1; ///< -1: any
};

struct Table
{
  Surface target;
  double reach = 1;
  std::optional<double> extension;

  // One node, all methods.
  void expect(const std::vector<double> &x, const Expected &expected) const
  {
    const Surface impactor = cloud(target.dim, x);
    for (const DetectionMethod method : all_methods)
    {
      DetectionOptions options;
      options.method = method;
      options.extension = extension;
      const auto detector = make_detector(options, impactor, target);
      const Pair pair = detector->detect(impactor.reference, target.reference, reach).front();
      SCOPED_TRACE("method " + detector->report().method + " at " + ::testing::PrintToString(x));
      EXPECT_EQ(pair.kind, expected.kind);
      EXPECT_EQ(pair.reason, expected.reason);
      if (expected.kind == PairKind::none)
      {
        EXPECT_EQ(pair.face, -1);
        continue;
      }
      EXPECT_NEAR(pair.gap, expected.gap, 1e-13);
      EXPECT_NEAR(pair.distance, expected.distance, 1e-13);
      if (expected.face >= 0)
        EXPECT_EQ(pair.face, expected.face);
    }
  }
};

const double root_half = std::sqrt(0.5);

TEST(DeadAngles2d, ConvexVertex)
{
  const Table table{roof()};
  // Straight above both faces are equally far: the smaller id. More to the right: the right face.
  table.expect({0, 0.5}, {PairKind::vertex, {}, 0.5 * root_half, 0.5, 0});
  table.expect({0.1, 0.5}, {PairKind::vertex, {}, 0.6 * root_half, std::hypot(0.1, 0.5), 0});
  table.expect({-0.1, 0.5}, {PairKind::vertex, {}, 0.6 * root_half, std::hypot(0.1, 0.5), 1});
  table.expect({0, 0}, {PairKind::face, {}, 0, 0, 0});
  table.expect({0, -0.2}, {PairKind::face, {}, -0.2 * root_half, 0.2 * root_half, 0});
}

TEST(DeadAngles2d, ConcaveVertex)
{
  const Table table{valley()};
  table.expect({0.1, 0.5}, {PairKind::face, {}, 0.4 * root_half, 0.4 * root_half, 0}); // the nearer of two
  table.expect({-0.1, 0.5}, {PairKind::face, {}, 0.4 * root_half, 0.4 * root_half, 1});
  table.expect({0, 0.5}, {PairKind::face, {}, 0.5 * root_half, 0.5 * root_half, 0});
  // Below the valley's bottom, inside the body: the lesser penetration.
  table.expect({0.1, -0.4}, {PairKind::vertex, {}, -0.3 * root_half, std::hypot(0.1, 0.4), -1});
}

TEST(DeadAngles2d, EndOfTheTarget)
{
  Table table{line()}; // default extension: 0.1 of the last face
  table.expect({-0.05, 0.3}, {PairKind::extension, {}, 0.3, std::hypot(0.05, 0.3), 1});
  table.expect({-0.05, -0.3}, {PairKind::extension, {}, -0.3, std::hypot(0.05, 0.3), 1});
  table.expect({2.05, 0.3}, {PairKind::extension, {}, 0.3, std::hypot(0.05, 0.3), 0});
  table.expect({-0.15, 0.3}, {PairKind::none, NoPairReason::past_end});
  table.extension = 0.2;
  table.expect({-0.15, 0.3}, {PairKind::extension, {}, 0.3, std::hypot(0.15, 0.3), 1});
  table.extension = 0;
  table.expect({-1e-3, 0.3}, {PairKind::none, NoPairReason::past_end});
  // Round-off beyond the end is not past it.
  table.expect({-1e-15, 0.3}, {PairKind::face, {}, 0.3, 0.3, 1});
  table.expect({0, 0.3}, {PairKind::face, {}, 0.3, 0.3, 1});
}

// Past an upper terrace's end there may be a lower one.
TEST(DeadAngles2d, AnotherFaceBeyondAnEnd)
{
  Surface target = chain({{2, 0}, {1, 0}, {0, 0}, {-0.001, -0.5}, {-1, -0.5}, {-2, -0.5}});
  // Take the riser (face 2) away: two terraces.
  target.face_nodes.erase(target.face_nodes.begin() + 4, target.face_nodes.begin() + 6);
  target.face_offsets.pop_back();
  target.face_ids.erase(target.face_ids.begin() + 2);
  target.build_adjacency();
  const Surface impactor = cloud(2, {-0.3, -0.15});
  for (const DetectionMethod method : {DetectionMethod::exact, DetectionMethod::brute})
  {
    DetectionOptions options;
    options.method = method;
    const auto detector = make_detector(options, impactor, target);
    const Pair pair = detector->detect(impactor.reference, target.reference, 1).front();
    EXPECT_EQ(pair.kind, PairKind::face);
    EXPECT_NEAR(pair.gap, 0.35, 1e-14);
  }
}

TEST(DeadAngles2d, NodeOnASharedVertex)
{
  const Table table{line()};
  table.expect({1, 0}, {PairKind::face, {}, 0, 0, 0});
  table.expect({1 + 1e-15, 1e-15}, {PairKind::face, {}, 0, 0, 0});
}

TEST(DeadAngles3d, ConvexEdge)
{
  for (const bool triangles : {false, true})
  {
    const Table table{bent(1, false, triangles)};
    table.expect({0.1, 0.55, 0.5}, {PairKind::edge, {}, 0.6 * root_half, std::hypot(0.1, 0.5)});
    table.expect({0, 0.55, 0}, {PairKind::face, {}, 0, 0});
    table.expect({0.3, 0.6, -0.1}, {PairKind::face, {}, 0.2 * root_half, 0.2 * root_half});
  }
}

TEST(DeadAngles3d, ConcaveEdge)
{
  for (const bool triangles : {false, true})
  {
    const Table table{bent(-1, false, triangles)};
    table.expect({0.1, 0.55, 0.5}, {PairKind::face, {}, 0.4 * root_half, 0.4 * root_half});
    table.expect({0.1, 0.55, -0.4}, {PairKind::edge, {}, -0.3 * root_half, std::hypot(0.1, 0.4)});
  }
}

TEST(DeadAngles3d, ConvexVertex)
{
  for (const bool triangular : {false, true})
  {
    const Table table{cube_corner(triangular)};
    const double d = std::sqrt(0.04 + 0.01 + 0.01);
    table.expect({0.1, 0.1, 0.2}, {PairKind::vertex, {}, 0.2, d, 0}); // the face seen most from above
    table.expect({0.2, 0.1, 0.1}, {PairKind::vertex, {}, 0.2, d, triangular ? 2 : 1});
    table.expect({0.1, -0.4, 0.2}, {PairKind::edge, {}, 0.2, std::hypot(0.1, 0.2), triangular ? -1 : 0});
    table.expect({0, 0, 0}, {PairKind::face, {}, 0, 0, 0});
    table.expect({-0.2, -0.3, -0.1}, {PairKind::face, {}, -0.1, 0.1});
  }
}

TEST(DeadAngles3d, ConcaveVertex)
{
  // Above the bottom of a hollow pyramid the nearest flank; below it, inside, the bottom itself.
  for (const bool triangles : {false, true})
  {
    const Table table{bent(-1, true, triangles)};
    const Surface impactor = cloud(3, {0.01, 0.02, -0.3});
    DetectionOptions options;
    const auto detector = make_detector(options, impactor, table.target);
    const Pair pair = detector->detect(impactor.reference, table.target.reference, 1).front();
    EXPECT_EQ(pair.kind, PairKind::vertex);
    EXPECT_LT(pair.gap, 0);
    EXPECT_NEAR(pair.distance, std::sqrt(1e-4 + 4e-4 + 0.09), 1e-14);
  }
}

TEST(DeadAngles3d, EndOfTheTarget)
{
  for (const bool triangles : {false, true})
  {
    Table table{sheet(2, 2, triangles, [](double s, double t) { return Point{s, t, 0}; })};
    table.expect({-0.03, 0.3, 0.2}, {PairKind::extension, {}, 0.2, std::hypot(0.03, 0.2)});
    table.expect({-0.03, -0.04, 0.2}, {PairKind::extension, {}, 0.2, std::sqrt(0.0025 + 0.04)});
    table.expect({-0.03, -0.04, -0.2}, {PairKind::extension, {}, -0.2, std::sqrt(0.0025 + 0.04)});
    table.expect({-0.07, 0.3, 0.2}, {PairKind::none, NoPairReason::past_end});
    table.extension = 0.1;
    table.expect({-0.07, 0.3, 0.2}, {PairKind::extension, {}, 0.2, std::hypot(0.07, 0.2)});
    table.extension = 0;
    table.expect({-1e-3, 0.3, 0.2}, {PairKind::none, NoPairReason::past_end});
    table.expect({-1e-15, 0.3, 0.2}, {PairKind::face, {}, 0.2, 0.2});
    table.expect({0, 0, 0}, {PairKind::face, {}, 0, 0});
  }
}

TEST(DeadAngles3d, NodeOnASharedVertex)
{
  const Table table{sheet(2, 2, false, [](double s, double t) { return Point{s, t, 0}; })};
  table.expect({0.5, 0.5, 0}, {PairKind::face, {}, 0, 0, 0});
  table.expect({0.5 + 1e-16, 0.5 - 1e-16, 1e-17}, {PairKind::face, {}, 0, 0, 0});
  table.expect({0.5, 0.7, 0}, {PairKind::face, {}, 0, 0, 2});
}

// A plate thinner than w, its whole surface the target; the impactor above has its normal downwards.
TEST(ThinBodies, TheWrongSideIsNotChosen)
{
  const Surface plate = chain({{4, 0}, {2, 0}, {0, 0}, {0, -0.1}, {2, -0.1}, {4, -0.1}}, true);
  const auto pair_at = [&plate](double y, DetectionMethod method)
  {
    // Faces that run to the right have their normals downwards.
    const Surface impactor = chain({{1.2, y}, {1.5, y}, {1.8, y}});
    DetectionOptions options;
    options.method = method;
    const auto detector = make_detector(options, impactor, plate);
    return detector->detect(impactor.reference, plate.reference, 1)[1];
  };
  for (const DetectionMethod method : {DetectionMethod::exact, DetectionMethod::brute})
  {
    EXPECT_NEAR(pair_at(0.02, method).gap, 0.02, 1e-15);
    EXPECT_NEAR(pair_at(-0.02, method).gap, -0.02, 1e-15);
    // Nearer to the lower side, but it came from above.
    EXPECT_NEAR(pair_at(-0.08, method).gap, -0.08, 1e-15);
    EXPECT_EQ(pair_at(-0.08, method).face, 1);
  }
}
} // namespace
} // namespace amontons::test
