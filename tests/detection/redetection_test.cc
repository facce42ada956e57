#include "amontons/detection/detector.h"
#include "surface/surfaces.h"

#include <gtest/gtest.h>

#include <cmath>
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
} // namespace
} // namespace amontons::test
