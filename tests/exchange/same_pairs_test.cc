// On any number of processes. Every expectation holds on each of them.
#include "detection/scene.h"
#include "expect.h"

#include <map>

namespace amontons::test
{
namespace
{
constexpr std::array<ExchangeMode, 2> modes{ExchangeMode::distributed, ExchangeMode::gathered};

std::string name_of(ExchangeMode mode)
{
  return mode == ExchangeMode::gathered ? "gathered" : "distributed";
}

struct SceneName
{
  std::string surface, shape;
  double n_nodes;
};

// All surfaces of the detection benchmark.
std::vector<SceneName> scene_names()
{
  std::vector<SceneName> names;
  for (const std::string &surface : benchmark::scene_surfaces(2))
    names.push_back({surface, "segments", 600});
  for (const std::string &surface : benchmark::scene_surfaces(3))
    for (const std::string shape : {"triangles", "quadrilaterals"})
      names.push_back({surface, shape, 500});
  return names;
}

class SamePairs : public testing::Test
{
protected:
  // Detects again and again while the surfaces move, and holds each time against one process's detector.
  // @return detections that had kept their routes
  int follow(const benchmark::Scene &scene, const DetectionOptions &detection, const ExchangeOptions &options,
             Spread spread, const std::vector<int> &steps)
  {
    const Piece impactor = dealt(scene.impactor, world_, spread, false);
    const Piece target = dealt(scene.target, world_, spread, true);
    const auto parallel =
        make_parallel_detector(world_, options, {{&impactor.surface, impactor.n_own, &target.surface, detection, {}}});
    const auto one = make_detector(detection, scene.impactor, scene.target);
    int n_kept = 0;
    for (const int step : steps)
    {
      SCOPED_TRACE(scene.surface + " " + scene.shape + ", " + name_of(options.mode) + ", spread " +
                   std::to_string(int(spread)) + ", step " + std::to_string(step));
      const benchmark::Positions x = benchmark::moved(scene, step);
      const std::vector<double> own_x = impactor.of(x.impactor), target_x = target.of(x.target);
      const auto &met = parallel->detect(std::vector<SharePositions>{{own_x, target_x, scene.reach}});
      const Pairing &expected = one->detect(x.impactor, x.target, scene.reach);
      expect_as_on_one(scene.target, x.target, expected, impactor, met.at(0));
      EXPECT_EQ(parallel->report().distances.at(0), one->report().distance);
      n_kept += parallel->report().kept_routes ? 1 : 0;
    }
    return n_kept;
  }

  Communicator world_{MPI_COMM_WORLD};
};

TEST_F(SamePairs, OnEverySurface)
{
  for (const SceneName &name : scene_names())
  {
    const benchmark::Scene scene = benchmark::make_scene(name.surface, name.shape, name.n_nodes);
    for (const ExchangeMode mode : modes)
      follow(scene, {}, {mode}, Spread::random, {0});
  }
}

TEST_F(SamePairs, HoweverTheyAreSpread)
{
  for (const SceneName &name :
       {SceneName{"wavy", "segments", 300}, SceneName{"torus", "quadrilaterals", 400}, {"thin", "triangles", 400}})
  {
    const benchmark::Scene scene = benchmark::make_scene(name.surface, name.shape, name.n_nodes);
    for (const ExchangeMode mode : modes)
      for (const Spread spread : {Spread::apart, Spread::some_bare})
        follow(scene, {}, {mode}, spread, {0, 1});
  }
}

TEST_F(SamePairs, WhileSurfacesMove)
{
  for (const SceneName &name : {SceneName{"wavy", "segments", 300}, {"graded-50", "quadrilaterals", 400}})
  {
    const benchmark::Scene scene = benchmark::make_scene(name.surface, name.shape, name.n_nodes);
    // A step brings nodes at most 0.05 w nearer. Up to step 5 less than the skin of 0.3 w is used up.
    EXPECT_EQ(follow(scene, {}, {}, Spread::random, {0, 1, 2, 3, 4, 5}), 5);
    EXPECT_GE(follow(scene, {}, {}, Spread::random, {0, 3, 8, 10, 20, 21, 0}), 1);
    EXPECT_EQ(follow(scene, {}, {ExchangeMode::distributed, 0.0}, Spread::random, {0, 1, 2, 2}), 1);
    EXPECT_EQ(follow(scene, {}, {ExchangeMode::gathered}, Spread::random, {0, 2, 8}), 0);
  }
}

TEST_F(SamePairs, ByEveryMethodWithEveryOption)
{
  for (const SceneName &name : {SceneName{"wavy", "segments", 300}, {"wavy", "quadrilaterals", 300}})
  {
    const benchmark::Scene scene = benchmark::make_scene(name.surface, name.shape, name.n_nodes);
    for (const ExchangeMode mode : modes)
    {
      follow(scene, {DetectionMethod::nearest_node, {}, {}}, {mode}, Spread::random, {0, 4, 20});
      follow(scene, {DetectionMethod::brute, {}, {}}, {mode}, Spread::random, {0});
      follow(scene, {DetectionMethod::exact, {}, 0.0}, {mode}, Spread::random, {0, 20});
      follow(scene, {DetectionMethod::exact, {}, 0.5 * scene.distance}, {mode}, Spread::random, {0, 20});
      // A distance that covers no face, and one that covers many.
      follow(scene, {DetectionMethod::exact, 0.05 * scene.distance, {}}, {mode}, Spread::random, {0, 4});
      follow(scene, {DetectionMethod::exact, 5 * scene.distance, {}}, {mode}, Spread::random, {0, 40});
    }
  }
}

// Impactor nodes without faces, far and near, on all sides of a closed target and inside it.
TEST_F(SamePairs, OfNodesAlone)
{
  const Surface target = sheet(
      30, 20, false, [](double s, double t) { return torus(s, t, 1, 0.4); }, true);
  benchmark::Scene scene{"torus", "nodes alone", cloud_about(target, 800, 0.5, 6), target, 0.2, 0};
  for (const ExchangeMode mode : modes)
    for (const Spread spread : {Spread::random, Spread::apart})
      follow(scene, {}, {mode}, spread, {0});
}

// Nodes that see the same distance to faces of several processes, on edges and vertices of a matching mesh.
TEST_F(SamePairs, TiesGoByGlobalIds)
{
  const auto flat = [](double height) { return [height](double s, double t) { return Point{s, t, height}; }; };
  benchmark::Scene scene{"flat, matching",
                         "quadrilaterals",
                         sheet(20, 20, false, flat(0.01)),
                         shuffled(sheet(20, 20, false, flat(0)), 3),
                         0.05,
                         0.05};
  for (const bool triangles : {false, true})
  {
    scene.target = shuffled(sheet(20, 20, triangles, flat(0)), 3);
    for (const ExchangeMode mode : modes)
      for (const Spread spread : {Spread::random, Spread::apart})
        follow(scene, {}, {mode}, spread, {0});
  }
}
} // namespace
} // namespace amontons::test
