#include "amontons/detection/box_tree.h"
#include "amontons/detection/normal_cones.h"

#include "amontons/detection/closest_feature.h"
#include "surface/surfaces.h"

#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
// On every level the group of a face that holds a minimum is kept; and far more groups are dropped than kept.
TEST(NormalCones, KeepEveryMinimumAndDropMostOfTheRest)
{
  for (const bool triangles : {false, true})
  {
    const Surface surface = sheet(32, 32, triangles,
                                  [](double s, double t) {
                                    return Point{s, t, 0.1 * std::sin(9 * s) * std::cos(7 * t)};
                                  });
    Target target(surface);
    target.move_to(surface.reference);
    std::vector<Index> order(surface.face_ids.size());
    std::iota(order.begin(), order.end(), 0);
    NormalCones cones;
    cones.build(target, order);
    const Surface points = cloud_about(surface, 200, 0.4, 2);
    int n_minima = 0, n_kept = 0, n_faces = 0;
    for (Index i = 0; i < points.n_nodes(); ++i)
    {
      const Eigen::Vector3d x(points.reference.data() + 3 * static_cast<std::ptrdiff_t>(i));
      for (Index f = 0; f < surface.n_faces(); ++f)
      {
        const ClosestPoint closest = closest_point(target.face(f), x);
        const Feature feature = look_at(target, {f, closest.xi, closest.squared_distance}, x);
        const bool kept = cones.may_hold_minimum(-1, f, x, {});
        ++n_faces;
        n_kept += kept;
        const bool past_end = feature.overhang > 0.1 * feature.extent;
        if (!feature.is_minimum || past_end)
          continue;
        ++n_minima;
        ASSERT_TRUE(kept) << "face " << f << ", node " << i;
        for (int level = 0, group = f / BoxTree<3>::width; level < 2; ++level, group /= BoxTree<3>::width)
          ASSERT_TRUE(cones.may_hold_minimum(level, group, x, {})) << "level " << level;
      }
    }
    EXPECT_GT(n_minima, 200);
    EXPECT_LT(n_kept, n_faces / 10);
  }
}
} // namespace
} // namespace amontons::test
