#include "amontons/detection/search_distance.h"

#include "amontons/base/error.h"
#include "amontons/detection/detector.h"
#include "surface/surfaces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <random>

namespace amontons::test
{
namespace
{
using Eigen::Vector3d;
using ::testing::HasSubstr;

// Largest distance to the nearest node over a fine grid of the face's points.
double sampled_radius(const FaceCoordinates &face)
{
  constexpr int n = 120;
  double radius = 0;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= (face.n_nodes == 3 ? n - i : n); ++j)
    {
      const Vector3d x = face_point(face, {static_cast<double>(i) / n, static_cast<double>(j) / n});
      double nearest = INFINITY;
      for (int k = 0; k < face.n_nodes; ++k)
        nearest = std::min(nearest, (x - face.x[k]).norm());
      radius = std::max(radius, nearest);
    }
  return radius;
}

TEST(CoveringRadius, RegularFaces)
{
  const double h = 0.3;
  const FaceCoordinates triangle{3, {Vector3d(0, 0, 0), Vector3d(h, 0, 0), Vector3d(h / 2, h * std::sqrt(0.75), 0)}};
  EXPECT_NEAR(covering_radius(triangle), h / std::sqrt(3.0), 1e-15);
  const FaceCoordinates square{4, {Vector3d(0, 0, 1), Vector3d(h, 0, 1), Vector3d(h, h, 1), Vector3d(0, h, 1)}};
  EXPECT_NEAR(covering_radius(square), h / std::sqrt(2.0), 1e-15);
  const FaceCoordinates segment{2, {Vector3d(0, 0, 0), Vector3d(0, h, 0)}};
  EXPECT_NEAR(covering_radius(segment), h / 2, 1e-16);
}

TEST(CoveringRadius, CoversRandomFacesAndTrianglesTightly)
{
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 200; ++trial)
    for (const int n : {3, 4})
    {
      FaceCoordinates face{n, {Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(2, 2, 0), Vector3d(0, 2, 0)}};
      for (int k = 0; k < n; ++k)
        face.x[k] += (n == 3 ? 1.0 : 0.6) * Vector3d(uniform(random), uniform(random), uniform(random));
      const double sampled = sampled_radius(face);
      EXPECT_GE(covering_radius(face), sampled * (1 - 1e-12));
      if (n == 3)
        EXPECT_LE(covering_radius(face), 1.02 * sampled);
    }
}

TEST(SearchDistance, AutomaticCoversTheWorstFaceAndReaches)
{
  const Surface target = chain({{0, 0}, {1, 0}, {4, 0}, {4.5, 0}});
  const Surface impactor = cloud(2, {2.5, 0.7});
  for (const auto method : {DetectionMethod::exact, DetectionMethod::nearest_node, DetectionMethod::brute})
  {
    DetectionOptions options;
    options.method = method;
    const auto detector = make_detector(options, impactor, target);
    EXPECT_EQ(detector->detect(impactor.reference, target.reference, 0.7).front().kind, PairKind::face);
    EXPECT_NEAR(detector->report().distance, 1.01 * std::hypot(1.5, 0.7), 1e-14);
    EXPECT_EQ(detector->report().distance_face, 1);
  }
}

std::string message_for(const DetectionOptions &options)
{
  Surface target = chain({{0, 0}, {1, 0}, {4, 0}, {4.5, 0}});
  target.face_ids = {70, 71, 72};
  target.node_ids = {10, 11, 12, 13};
  const Surface impactor = cloud(2, {2.5, 0.1});
  try
  {
    make_detector(options, impactor, target)->detect(impactor.reference, target.reference, 0);
  }
  catch (const UserError &error)
  {
    return error.what();
  }
  return "";
}

TEST(SearchDistance, TooSmallForNearestNodeNamesTheFaceAndTheLeast)
{
  DetectionOptions options;
  options.method = DetectionMethod::nearest_node;
  options.distance = 1.4;
  const std::string message = message_for(options);
  EXPECT_THAT(message, HasSubstr("face 71"));
  EXPECT_THAT(message, HasSubstr("nodes 11 12"));
  EXPECT_THAT(message, HasSubstr("at least 1.5"));
  options.distance = 1.5;
  EXPECT_EQ(message_for(options), "");
  options.distance = 1.4;
  options.method = DetectionMethod::exact;
  EXPECT_EQ(message_for(options), "");
}

TEST(SearchDistance, MustBePositive)
{
  DetectionOptions options;
  for (const double w : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
  {
    options.distance = w;
    EXPECT_THAT(message_for(options), HasSubstr("positive"));
  }
  options.distance.reset();
  options.extension = -1;
  EXPECT_THAT(message_for(options), HasSubstr("extension"));
}

TEST(Detector, ReportsReasonsPenetrationsAndTimes)
{
  const Surface target = chain({{2, 0}, {1, 0}, {0, 0}});
  const Surface impactor = cloud(2, {0.5, 0.1, 0.5, -0.2, 1.5, -0.3, 0.2, 5, -0.5, 0.2, 1, 0.75, -0.69, 0.69});
  DetectionOptions options;
  options.distance = 0.7;
  const auto detector = make_detector(options, impactor, target);
  detector->detect(impactor.reference, target.reference, 0);
  const DetectionReport report = detector->report();
  EXPECT_EQ(report.method, "exact");
  EXPECT_EQ(report.distance_face, -1);
  EXPECT_EQ(report.n_pairs, 3);
  EXPECT_EQ(report.pairs_by_kind.at("face"), 3);
  EXPECT_EQ(report.unpaired_by_reason.at("outside_box"), 2);
  EXPECT_EQ(report.unpaired_by_reason.at("past_end"), 1);
  EXPECT_EQ(report.unpaired_by_reason.at("too_far"), 1);
  EXPECT_EQ(report.n_penetrations, 2);
  EXPECT_DOUBLE_EQ(report.deepest, -0.3);
  EXPECT_EQ(report.deepest_node, 2);
  EXPECT_EQ(report.deepest_point, (std::array<double, 3>{1.5, -0.3, 0}));
  for (const char *step : {"bounds", "fill", "nearest", "projection"})
    EXPECT_GE(report.seconds.at(step), 0) << step;
}

// The exact method works on surfaces that it has numbered anew where the given ones are numbered at random; brute force
// never does.
TEST(Detector, ReportsInTheGivenNumbers)
{
  const auto wavy = [](double s, double t) { return Point{s * s + 0.2 * s, t, 0.05 * std::sin(9 * s)}; };
  const Surface target = shuffled(sheet(40, 30, true, wavy), 3);
  const Surface impactor = shuffled(cloud_about(target, 600, 0.03, 2), 4);
  DetectionOptions exact, brute;
  brute.method = DetectionMethod::brute;
  const auto detector = make_detector(exact, impactor, target), oracle = make_detector(brute, impactor, target);
  const Pairing &pairs = detector->detect(impactor.reference, target.reference, 0);
  const Pairing &expected = oracle->detect(impactor.reference, target.reference, 0);
  const DetectionReport report = detector->report(), given = oracle->report();
  EXPECT_EQ(report.distance_face, given.distance_face);
  EXPECT_EQ(report.deepest_node, given.deepest_node);
  EXPECT_EQ(report.deepest_point, given.deepest_point);
  ASSERT_GE(report.deepest_node, 0);
  EXPECT_EQ(report.deepest_point[2], impactor.reference[3 * report.deepest_node + 2]);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    EXPECT_EQ(pairs[i].face, expected[i].face) << i;
}

TEST(Detector, PositionsThatAreNotFiniteAreANumericalFailure)
{
  const Surface target = chain({{2, 0}, {1, 0}, {0, 0}});
  const Surface impactor = cloud(2, {0.5, 0.1});
  const auto detector = make_detector({}, impactor, target);
  std::vector<double> x = impactor.reference;
  x[1] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(detector->detect(x, target.reference, 0.1), NumericalFailure);
}

TEST(Detector, NothingToFind)
{
  const Surface target = chain({{2, 0}, {1, 0}, {0, 0}});
  for (const auto method : {DetectionMethod::exact, DetectionMethod::nearest_node, DetectionMethod::brute})
  {
    DetectionOptions options;
    options.method = method;
    const Surface nobody = cloud(2, {});
    EXPECT_TRUE(make_detector(options, nobody, target)->detect({}, target.reference, 1).empty());
    Surface empty;
    empty.build_adjacency();
    const Surface impactor = cloud(2, {0.5, 0.1});
    const auto detector = make_detector(options, impactor, empty);
    EXPECT_EQ(detector->detect(impactor.reference, {}, 1).front().reason, NoPairReason::outside_box);
  }
}
} // namespace
} // namespace amontons::test
