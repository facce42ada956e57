// On any number of processes. Every expectation holds on each of them.
#include "detection/scene.h"
#include "detection/self_contact_checks.h"
#include "expect.h"

namespace amontons::test
{
namespace
{
class SelfContactOfMany : public testing::Test
{
protected:
  // @param ways current coordinates, one detection after another @return pairs in all detections
  Index follow(const Surface &surface, const std::vector<std::vector<double>> &ways, const DetectionOptions &detection,
               std::optional<double> self_distance, ExchangeMode mode, Spread spread)
  {
    const Piece piece = dealt(surface, world_, spread, false);
    const auto parallel =
        make_parallel_detector(world_, {mode}, {{&piece.surface, piece.n_own, nullptr, detection, self_distance}});
    const auto one = make_self_detector(detection, surface, self_distance);
    Index n_pairs = 0;
    for (const std::vector<double> &x : ways)
    {
      const std::vector<double> own_x = piece.of(x);
      const auto &met = parallel->detect(std::vector<SharePositions>{{own_x, {}, 0}});
      expect_as_on_one(surface, x, one->detect(x, x, 0), piece, met.at(0));
      n_pairs += one->report().n_pairs;
    }
    return n_pairs;
  }

  Communicator world_{MPI_COMM_WORLD};
};

// From the reference to where it is, and on a little.
std::vector<std::vector<double>> way_to(const std::vector<double> &reference, const std::vector<double> &now)
{
  std::vector<std::vector<double>> ways;
  for (const double share : {0.98, 1.0, 1.01, 0.9})
  {
    std::vector<double> &x = ways.emplace_back(reference);
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] += share * (now[i] - reference[i]);
  }
  return ways;
}

TEST_F(SelfContactOfMany, AsOnOneInThePlane)
{
  for (const self_contact::Case &c : self_contact::cases())
  {
    SCOPED_TRACE(c.name);
    const Surface surface = outlines_surface(c.reference);
    DetectionOptions detection;
    detection.distance = c.distance;
    const auto ways = way_to(surface.reference, self_contact::flattened(c.now));
    const Index n = follow(surface, ways, detection, {}, ExchangeMode::distributed, Spread::random);
    EXPECT_TRUE(n > 0 || c.empty || c.through);
    follow(surface, {ways[1]}, detection, {}, ExchangeMode::gathered, Spread::some_bare);
  }
}

TEST_F(SelfContactOfMany, AsOnOneInSpace)
{
  constexpr int layers = 3;
  constexpr double depth = 0.1;
  for (const self_contact::Case &c : self_contact::cases())
    for (const bool triangles : {false, true})
    {
      if (c.name != "U, through itself" && c.name != "ring, crushed")
        continue;
      SCOPED_TRACE(c.name);
      const Surface surface = drawn_out(outlines_surface(c.reference), layers, depth, triangles);
      DetectionOptions detection;
      detection.distance = c.distance;
      const auto ways = way_to(surface.reference, drawn_out(self_contact::flattened(c.now), layers, depth));
      for (const std::optional<double> self_distance : {std::optional<double>(), std::optional(0.05)})
        EXPECT_GT(follow(surface, ways, detection, self_distance, ExchangeMode::distributed, Spread::random), 0);
      detection.method = DetectionMethod::nearest_node;
      detection.distance.reset();
      follow(surface, ways, detection, {}, ExchangeMode::gathered, Spread::random);
    }
}

// The way along the surface that decides what a node does not see runs far out of what is near now.
TEST_F(SelfContactOfMany, SelfDistanceManyTimesTheDistance)
{
  const Strip strip{240, 2};
  const Surface surface = outlines_surface({strip.outline(flat(4, 0.1))});
  const std::vector<double> folded = self_contact::flattened({strip.outline(folded_strip(2, 2, 0.06, 0.1))});
  DetectionOptions detection;
  detection.distance = 0.04;
  std::vector<Index> n;
  for (const double self_distance : {0.3, 1.5})
    for (const ExchangeMode mode : {ExchangeMode::distributed, ExchangeMode::gathered})
      n.push_back(follow(surface, {folded}, detection, self_distance, mode, Spread::random));
  EXPECT_GT(n[2], 0);
  EXPECT_GT(n[0], n[2] + 10);
}

// Two bodies in one surface; the upper one slides along the lower, off it and back, and roles are kept.
TEST_F(SelfContactOfMany, RolesAreKept)
{
  const auto shifted = [](double a, double b)
  {
    const PlanePoint x = flat(2, 0.1)(a, b);
    return PlanePoint{x[0], x[1] + 0.11};
  };
  Surface surface = outlines_surface({Strip{40, 2}.outline(flat(2, 0.1)), Strip{60, 2}.outline(shifted)});
  for (Index f = 0; f < surface.n_faces(); ++f)
    surface.face_bodies.push_back(f < 84 ? 0 : 1);
  std::vector<std::vector<double>> ways;
  for (const double dx : {0.0, 0.3, 0.9, 1.5, 0.2, -1.7, 0.0})
    for (const double dy : {0.02, -0.015, 0.5, 0.0})
    {
      std::vector<double> &x = ways.emplace_back(surface.reference);
      for (std::size_t i = 2 * 84; i < x.size(); i += 2)
      {
        x[i] += dx;
        x[i + 1] += dy;
      }
    }
  DetectionOptions detection;
  detection.distance = 0.05;
  for (const ExchangeMode mode : {ExchangeMode::distributed, ExchangeMode::gathered})
    EXPECT_GT(follow(surface, ways, detection, {}, mode, Spread::random), 300);
}

// In the plane and in space, two-sided and not, with options of their own, in the same messages.
TEST_F(SelfContactOfMany, SeveralContactsAtOnce)
{
  const benchmark::Scene wavy = benchmark::make_scene("wavy", "quadrilaterals", 400);
  const benchmark::Scene circle = benchmark::make_scene("circle", "segments", 300);
  const self_contact::Case fold = self_contact::cases().front();
  const Surface folded = outlines_surface(fold.reference);
  const std::vector<double> folded_x = self_contact::flattened(fold.now);
  DetectionOptions of_fold;
  of_fold.distance = fold.distance;
  const DetectionOptions of_circle{DetectionMethod::nearest_node, {}, {}};

  const Piece wavy_impactor = dealt(wavy.impactor, world_, Spread::apart, false);
  const Piece wavy_target = dealt(wavy.target, world_, Spread::apart, true);
  const Piece circle_impactor = dealt(circle.impactor, world_, Spread::random, false);
  const Piece circle_target = dealt(circle.target, world_, Spread::some_bare, true);
  const Piece fold_piece = dealt(folded, world_, Spread::random, false);
  const std::vector<double> fold_x = fold_piece.of(folded_x);
  const Pairing of_wavy =
      make_detector({}, wavy.impactor, wavy.target)->detect(wavy.impactor.reference, wavy.target.reference, wavy.reach);
  const Pairing on_circle = make_detector(of_circle, circle.impactor, circle.target)
                                ->detect(circle.impactor.reference, circle.target.reference, circle.reach);
  const Pairing in_fold = make_self_detector(of_fold, folded)->detect(folded_x, folded_x, 0);

  for (const ExchangeMode mode : {ExchangeMode::distributed, ExchangeMode::gathered})
  {
    const auto parallel = make_parallel_detector(
        world_, {mode},
        {{&wavy_impactor.surface, wavy_impactor.n_own, &wavy_target.surface, {}, {}},
         {&fold_piece.surface, fold_piece.n_own, nullptr, of_fold, {}},
         {&circle_impactor.surface, circle_impactor.n_own, &circle_target.surface, of_circle, {}}});
    for (int again = 0; again < 2; ++again)
    {
      const auto &met = parallel->detect(std::vector<SharePositions>{
          {wavy_impactor.surface.reference, wavy_target.surface.reference, wavy.reach},
          {fold_x, {}, 0},
          {circle_impactor.surface.reference, circle_target.surface.reference, circle.reach}});
      expect_as_on_one(wavy.target, wavy.target.reference, of_wavy, wavy_impactor, met.at(0));
      expect_as_on_one(folded, folded_x, in_fold, fold_piece, met.at(1));
      expect_as_on_one(circle.target, circle.target.reference, on_circle, circle_impactor, met.at(2));
    }
  }
}
} // namespace
} // namespace amontons::test
