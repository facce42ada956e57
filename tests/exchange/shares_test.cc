// What each process holds, and what is wrong with what it gives. On any number of processes.
#include "amontons/base/error.h"
#include "detection/scene.h"
#include "expect.h"

#include <gmock/gmock.h>

#include <cmath>

namespace amontons::test
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class Shares : public testing::Test
{
protected:
  [[nodiscard]] double sum(double value) const
  {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, world_.mpi());
    return value;
  }
  [[nodiscard]] double greatest(double value) const
  {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, world_.mpi());
    return value;
  }

  Communicator world_{MPI_COMM_WORLD};
};

TEST_F(Shares, WorkIsEvenOnACrowdedCorner)
{
  const Surface impactor = crowded_corner(83, 1e-3), target = crowded_corner(80, 0);
  const Piece own_impactor = dealt(impactor, world_, Spread::random, false);
  const Piece own_target = dealt(target, world_, Spread::random, true);
  DetectionOptions detection;
  detection.distance = 4e-3;
  const auto parallel = make_parallel_detector(
      world_, {}, {{&own_impactor.surface, own_impactor.n_own, &own_target.surface, detection, {}}});
  const auto &met =
      parallel->detect(std::vector<SharePositions>{{own_impactor.surface.reference, own_target.surface.reference, 0}});
  expect_as_on_one(target, target.reference,
                   make_detector(detection, impactor, target)->detect(impactor.reference, target.reference, 0),
                   own_impactor, met.at(0));
  const ParallelReport &report = parallel->report();
  EXPECT_EQ(sum(report.n_sought), impactor.n_nodes());
  for (const double held : {double(report.n_sought), double(report.n_sought + report.n_target_nodes)})
    EXPECT_LT(greatest(held), 1.25 * sum(held) / world_.size());
}

TEST_F(Shares, HoldAPartAndALayerOnly)
{
  const benchmark::Scene scene = benchmark::make_scene("wavy", "quadrilaterals", 4000);
  const Piece impactor = dealt(scene.impactor, world_, Spread::random, false);
  const Piece target = dealt(scene.target, world_, Spread::random, true);
  const std::vector<SharePositions> x{{impactor.surface.reference, target.surface.reference, scene.reach}};
  const auto parallel =
      make_parallel_detector(world_, {}, {{&impactor.surface, impactor.n_own, &target.surface, {}, {}}});
  parallel->detect(x);
  const double share = 1.0 / world_.size(), n = scene.target.n_nodes();
  // About a square of n * share nodes lies a layer of w and skin, on four sides at most.
  const double layer = 4 * 1.3 * scene.distance * std::sqrt(n) * std::sqrt(n * share) + 40;
  EXPECT_LT(parallel->report().n_target_nodes, 1.1 * n * share + layer);
  EXPECT_LT(parallel->report().n_impactor_nodes, 1.1 * n * share + layer);
  EXPECT_EQ(parallel->report().n_hub_nodes, 0);
  // Again: no surface, no reduction but that of bounds, and as many bytes as there are coordinates and pairs.
  const auto first = parallel->report().traffic;
  parallel->detect(x);
  const auto again = parallel->report().traffic;
  EXPECT_TRUE(parallel->report().kept_routes);
  EXPECT_FALSE(again.contains("surfaces") || again.contains("cut"));
  EXPECT_EQ(again.at("positions").messages, first.at("surfaces").messages);
  if (world_.size() > 1)
    EXPECT_LT(1.5 * again.at("positions").bytes, first.at("surfaces").bytes);
  EXPECT_EQ(again.at("pairs").bytes, first.at("pairs").bytes);
  // Through the hub everything goes twice.
  const auto gathered = make_parallel_detector(world_, {ExchangeMode::gathered},
                                               {{&impactor.surface, impactor.n_own, &target.surface, {}, {}}});
  gathered->detect(x);
  EXPECT_EQ(gathered->report().n_hub_nodes, world_.is_root() ? scene.impactor.n_nodes() + scene.target.n_nodes() : 0);
}

// A sheet over a sheet, spread at random, with something wrong on the last process.
struct Wrong
{
  explicit Wrong(const Communicator &world)
    : impactor(dealt(above, world, Spread::random, false))
    , target(dealt(below, world, Spread::random, true))
    , is_last(world.rank() == world.size() - 1)
  {
  }
  void detect(const Communicator &world, ExchangeMode mode, const DetectionOptions &detection = {})
  {
    impactor.surface.build_adjacency();
    target.surface.build_adjacency();
    const auto parallel =
        make_parallel_detector(world, {mode}, {{&impactor.surface, impactor.n_own, &target.surface, detection, {}}});
    parallel->detect(std::vector<SharePositions>{{impactor.surface.reference, target.surface.reference, 0.1}});
  }

  static Surface flat(double height)
  {
    return sheet(8, 8, false, [height](double s, double t) { return Point{s, t, height}; });
  }
  Surface above = flat(0.05), below = flat(0);
  Piece impactor, target;
  bool is_last;
};

TEST_F(Shares, ErrorOfOneIsErrorOfAll)
{
  for (const ExchangeMode mode : {ExchangeMode::distributed, ExchangeMode::gathered})
  {
    Wrong good(world_);
    EXPECT_NO_THROW(good.detect(world_, mode));

    Wrong face_given_twice(world_);
    Surface &target = face_given_twice.target.surface;
    if (face_given_twice.is_last)
    {
      const std::vector<Index> first(target.face(0).begin(), target.face(0).end());
      target.face_nodes.insert(target.face_nodes.end(), first.begin(), first.end());
      target.face_offsets.push_back(static_cast<Index>(target.face_nodes.size()));
      target.face_ids.push_back(target.face_ids[0]);
    }
    EXPECT_THAT([&] { face_given_twice.detect(world_, mode); },
                ThrowsMessage<UserError>(AllOf(HasSubstr("of the target is given more than once"))));

    Wrong owned_twice(world_);
    if (owned_twice.is_last)
      ++owned_twice.impactor.n_own; // a node of a face
    if (world_.size() > 1)
      EXPECT_THAT([&] { owned_twice.detect(world_, mode); }, ThrowsMessage<UserError>(HasSubstr("one owner")));

    Wrong elsewhere(world_);
    if (elsewhere.is_last)
      for (double &x : elsewhere.target.surface.reference)
        x += 1e-12;
    if (world_.size() > 1)
      EXPECT_THAT([&] { elsewhere.detect(world_, mode); },
                  ThrowsMessage<UserError>(HasSubstr("is not where other processes have it")));

    Wrong lost(world_);
    if (lost.is_last)
      lost.impactor.surface.reference[0] = NAN;
    EXPECT_THROW(lost.detect(world_, mode), NumericalFailure);

    EXPECT_THAT(
        [&] {
          Wrong(world_).detect(world_, mode, {DetectionMethod::nearest_node, 0.01, {}});
        },
        ThrowsMessage<UserError>(HasSubstr("detection distance 0.01 is too small for the nearest-node method")));
    EXPECT_THROW(Wrong(world_).detect(world_, mode, {DetectionMethod::exact, -1, {}}), UserError);
  }
}

TEST_F(Shares, SelfContactNeedsTheReference)
{
  for (const ExchangeMode mode : {ExchangeMode::distributed, ExchangeMode::gathered})
  {
    Wrong one_side(world_);
    Surface &surface = one_side.impactor.surface;
    const std::vector<double> x = surface.reference;
    if (one_side.is_last)
      surface.reference.clear();
    const auto parallel =
        make_parallel_detector(world_, {mode}, {{&surface, one_side.impactor.n_own, nullptr, {}, 0.5}});
    EXPECT_THAT(
        [&] {
          parallel->detect(std::vector<SharePositions>{{x, {}, 0.1}});
        },
        ThrowsMessage<UserError>(HasSubstr("self-contact needs the reference coordinates")));
  }
}

TEST_F(Shares, DetectAgainAfterAnError)
{
  Wrong good(world_);
  const auto parallel =
      make_parallel_detector(world_, {}, {{&good.impactor.surface, good.impactor.n_own, &good.target.surface, {}, {}}});
  std::vector<double> x = good.impactor.surface.reference;
  const std::vector<double> target_x = good.target.surface.reference;
  const auto n_pairs = [&]
  {
    double n = 0;
    for (const Pair &pair : parallel->detect(std::vector<SharePositions>{{x, target_x, 0.1}}).at(0).pairs)
      n += pair.face >= 0 ? 1 : 0;
    return sum(n);
  };
  EXPECT_EQ(n_pairs(), 81);
  const double there = x[0];
  x[0] = good.is_last ? NAN : x[0];
  EXPECT_THROW(parallel->detect(std::vector<SharePositions>{{x, target_x, 0.1}}), NumericalFailure);
  x[0] = there;
  EXPECT_EQ(n_pairs(), 81);
}
} // namespace
} // namespace amontons::test
