#include "amontons/detection/detector.h"
#include "surface/surfaces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

namespace amontons::test
{
namespace
{
struct Motion
{
  const char *name;
  double step, drift, noise; ///< of the impactor by step, of both in common, at random; in units of w
};

bool identical(const Pair &a, const Pair &b)
{
  return a.face == b.face && a.xi == b.xi && a.kind == b.kind && a.reason == b.reason && a.distance == b.distance &&
         (a.gap == b.gap || a.kind == PairKind::none);
}

// Detects over twelve steps with one detector, and each time from scratch.
void expect_the_same(const char *name, const Surface &target, const Surface &impactor)
{
  const DetectionOptions options;
  for (const Motion motion : {Motion{"small", 0.02, 0, 0.02}, Motion{"rigid", 0.03, 0.2, 0},
                              Motion{"large", 0.3, 0, 0.1}, Motion{"still", 0, 0, 0}})
  {
    const auto kept = make_detector(options, impactor, target);
    std::vector<double> x = impactor.reference, y = target.reference;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int n_faces_changed = 0;
    Pairing last;
    for (int step = 0; step < 12; ++step)
    {
      const Pairing &again = kept->detect(x, y, 0);
      const double w = kept->report().distance;
      const auto fresh = make_detector(options, impactor, target);
      const Pairing &expected = fresh->detect(x, y, 0);
      for (std::size_t i = 0; i < expected.size(); ++i)
      {
        ASSERT_TRUE(identical(again[i], expected[i]))
            << name << ", " << motion.name << ", step " << step << ", node " << i << ": face " << again[i].face
            << " and " << expected[i].face << ", distance " << again[i].distance << " and " << expected[i].distance;
        n_faces_changed += step > 0 && last[i].face != expected[i].face;
      }
      last = expected;
      for (std::size_t i = 0; i < x.size(); ++i)
        x[i] += w * (motion.step * std::sin(0.7 * step + static_cast<double>(i % target.dim)) + motion.drift +
                     motion.noise * uniform(random));
      for (std::size_t i = 0; i < y.size(); ++i)
        y[i] += w * (motion.drift + 0.3 * motion.noise * uniform(random));
    }
    EXPECT_EQ(n_faces_changed > 0, motion.step > 0) << name << ", " << motion.name;
  }
}

double graded(double s)
{
  return std::expm1(std::log(50.0) * s) / 49;
}

TEST(Redetection, IsIdenticalToDetectionFromScratch)
{
  const auto arc = [](double s) { return std::array<double, 2>{-s, 0.1 * std::sin(9 * s)}; };
  expect_the_same("curve", curve(200, arc), cloud_about(curve(200, arc), 300, 0.003, 4));
  const auto stretched = [](double s) { return std::array<double, 2>{-graded(s), 0.1 * s}; };
  expect_the_same("graded curve", curve(150, stretched), cloud_about(curve(150, stretched), 300, 0.01, 4));
  for (const bool triangles : {false, true})
  {
    const Surface wavy = sheet(30, 20, triangles,
                               [](double s, double t) {
                                 return Point{s, t, 0.1 * std::sin(9 * s) * std::cos(7 * t)};
                               });
    expect_the_same("wavy", wavy, cloud_about(wavy, 500, 0.02, 8));
    const Surface uneven = sheet(24, 24, triangles,
                                 [](double s, double t) {
                                   return Point{graded(s), graded(t), 0.1 * s * t};
                                 });
    expect_the_same("graded", shuffled(uneven, 3), cloud_about(uneven, 400, 0.02, 8));
    const Surface ring = sheet(
        30, 18, triangles, [](double s, double t) { return torus(s, t, 1, 0.4); }, true);
    expect_the_same("torus", ring, cloud_about(ring, 400, 0.05, 2));
  }
}

struct Walk
{
  const char *name;
  double impactor, target;             ///< length of each node's step, in units of w
  double impactor_slide, target_slide; ///< in each step along the first axis, in units of w
  int n_steps;
};

// Moves each node by a smooth part, the same for its neighbours, and one of its own.
void step_on(std::vector<double> &x, int dim, double length, double phase, std::mt19937 &random)
{
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (std::size_t i = 0; i < x.size(); i += dim)
  {
    const double where = 5 * x[i] - 3 * x[i + 1];
    for (int c = 0; c < dim; ++c)
      x[i + c] += length * (0.5 * std::sin(where + phase + 2 * c) + 0.2 * uniform(random));
  }
}

// What is kept must give what a detection from nothing gives, and brute force: after steps that are all below what the
// kept faces allow for, and together far above it, of either side alone and of both.
void expect_right_all_along(const char *name, const Surface &target, const Surface &impactor, std::optional<double> w)
{
  DetectionOptions options, all;
  options.distance = all.distance = w;
  all.method = DetectionMethod::brute;
  for (const Walk walk : {Walk{"target alone", 0, 0.04, 0, 0, 18}, Walk{"impactor alone", 0.04, 0, 0, 0, 18},
                          Walk{"both", 0.03, 0.03, 0, 0, 18}, Walk{"target slides", 0, 0.01, 0, 0.08, 24},
                          Walk{"past the end", 0.01, 0, 0.15, 0, 15}, Walk{"into reach", 0.01, 0.01, -0.15, 0, 15}})
  {
    const auto kept = make_detector(options, impactor, target);
    std::vector<double> x = impactor.reference, y = target.reference;
    std::mt19937 random(17);
    int n_changed = 0;
    std::vector<Index> last(impactor.node_ids.size(), -2); // not known yet
    kept->detect(x, y, 0);
    for (int step = 1; step <= walk.n_steps; ++step)
    {
      const bool is_last = step == walk.n_steps;
      const double unit = kept->report().distance;
      step_on(x, target.dim, walk.impactor * unit, 0.1 * step, random);
      step_on(y, target.dim, walk.target * unit, 1 + 0.1 * step, random);
      for (std::size_t i = 0; i < x.size(); i += target.dim)
        x[i] += walk.impactor_slide * unit;
      for (std::size_t i = 0; i < y.size(); i += target.dim)
        y[i] += walk.target_slide * unit;
      const Pairing &again = kept->detect(x, y, 0);
      if (step % 5 != 0 && !is_last)
        continue;
      const auto fresh = make_detector(is_last ? all : options, impactor, target);
      const Pairing &expected = fresh->detect(x, y, 0);
      for (std::size_t i = 0; i < expected.size(); ++i)
      {
        ASSERT_TRUE(identical(again[i], expected[i]))
            << name << ", " << walk.name << ", step " << step << ", node " << i << ": face " << again[i].face << " and "
            << expected[i].face << ", distance " << again[i].distance << " and " << expected[i].distance;
        n_changed += last[i] >= -1 && last[i] != again[i].face;
        last[i] = again[i].face;
      }
    }
    EXPECT_GT(n_changed, 20) << name << ", " << walk.name;
  }
}

TEST(Redetection, StaysRightOverManySmallSteps)
{
  const auto arc = [](double s) { return std::array<double, 2>{-s, 0.1 * std::sin(9 * s)}; };
  expect_right_all_along("long curve", curve(3000, arc), cloud_about(curve(3000, arc), 700, 0.0004, 5), {});
  expect_right_all_along("shuffled curve", shuffled(curve(2000, arc), 2), cloud_about(curve(2000, arc), 400, 0.0006, 6),
                         {});
  const auto wavy = [](double s, double t) { return Point{s, t, 0.1 * std::sin(9 * s) * std::cos(7 * t)}; };
  for (const bool triangles : {false, true})
  {
    const Surface large = sheet(32, 28, triangles, wavy);
    // As many nodes in rows as there are, so that blocks are what they are on surfaces in contact.
    Surface opposite = sheet(17, 15, false,
                             [&](double s, double t)
                             {
                               Point x = wavy(s, t);
                               x[2] += 0.015 + 0.03 * std::sin(11 * s + 7 * t);
                               return x;
                             });
    expect_right_all_along("large", large, opposite, {});
    if (triangles)
      expect_right_all_along("shuffled", shuffled(large, 5), shuffled(opposite, 9), {});
    expect_right_all_along("far reach", sheet(18, 15, triangles, wavy), cloud_about(large, 200, 0.2, 3), 0.15);
  }
}
} // namespace
} // namespace amontons::test
