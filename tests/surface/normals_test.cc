#include "amontons/surface/normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace amontons
{
namespace
{
constexpr double right_angle = 1.5707963267948966;

/// Segments through points of the plane, the outward side on the right hand.
Surface polyline(const std::vector<double> &points)
{
  Surface surface;
  surface.dim = 2;
  surface.reference = points;
  const auto n = static_cast<Index>(points.size() / 2);
  for (Index i = 0; i < n; ++i)
    surface.node_ids.push_back(i);
  for (Index i = 0; i + 1 < n; ++i)
  {
    surface.face_nodes.insert(surface.face_nodes.end(), {i, i + 1});
    surface.face_offsets.push_back(2 * (i + 1));
    surface.face_ids.push_back(i);
  }
  surface.build_adjacency();
  return surface;
}

TEST(SmoothedNormals, AreThoseOfTheCircleThroughTheNodes)
{
  // Unequal arcs: counter-clockwise round the origin, outward is radial. A chord's length is not quite its arc's, so
  // the average errs by the third power of the angle.
  const std::vector<double> angles{0, 0.02, 0.05, 0.055, 0.09, 0.1};
  std::vector<double> points;
  for (const double a : angles)
    points.insert(points.end(), {std::cos(a), std::sin(a)});
  const Surface circle = polyline(points);
  const std::vector<double> normals = smoothed_normals(circle, circle.reference, 0.5);
  for (Index f = 0; f < circle.n_faces(); ++f)
    for (int k = 0; k < 2; ++k)
    {
      const Index node = circle.face(f)[k];
      if (node == 0 || node + 1 == circle.n_nodes())
        continue;
      for (int c = 0; c < 2; ++c)
        EXPECT_NEAR(normals[(circle.face_offsets[f] + k) * 2 + c], circle.reference[node * 2 + c], 1e-5);
    }
}

TEST(SmoothedNormals, LeaveSharpEdgesSharp)
{
  const Surface corner = polyline({0, 0, 1, 0, 1, 1});
  const std::vector<double> sharp = smoothed_normals(corner, corner.reference, 0.5 * right_angle);
  const std::vector<double> own{0, -1, 0, -1, 1, 0, 1, 0};
  for (std::size_t i = 0; i < own.size(); ++i)
    EXPECT_NEAR(sharp[i], own[i], 1e-15);
  const std::vector<double> round = smoothed_normals(corner, corner.reference, 1.01 * right_angle);
  EXPECT_NEAR(round[2], std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(round[3], -std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(round[4], round[2], 1e-15);
}

TEST(SmoothedNormals, AreRadialOnASphere)
{
  // Four unequal faces round one node of the unit sphere: N. Max's weights make its normal exact.
  Surface surface;
  surface.dim = 3;
  const std::vector<std::pair<double, double>> places{{0, 0}, {0.3, 0}, {0, 0.2}, {-0.4, 0}, {0, -0.1}};
  for (const auto &[x, y] : places)
  {
    surface.node_ids.push_back(static_cast<GlobalIndex>(surface.node_ids.size()));
    surface.reference.insert(surface.reference.end(), {x, y, std::sqrt(1 - x * x - y * y)});
  }
  for (Index k = 0; k < 4; ++k)
  {
    surface.face_nodes.insert(surface.face_nodes.end(), {0, 1 + k, 1 + (k + 1) % 4});
    surface.face_offsets.push_back(3 * (k + 1));
    surface.face_ids.push_back(k);
  }
  surface.build_adjacency();
  const std::vector<double> normals = smoothed_normals(surface, surface.reference, 1);
  EXPECT_NEAR(normals[0], 0, 1e-15);
  EXPECT_NEAR(normals[1], 0, 1e-15);
  EXPECT_NEAR(normals[2], 1, 1e-15);
}
} // namespace
} // namespace amontons
