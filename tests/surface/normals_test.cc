#include "amontons/surface/normals.h"

#include "surfaces.h"

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

void expect_gradients(const Surface &surface, double sharp_angle)
{
  constexpr double h = 1e-5;
  const int dim = surface.dim;
  for (Index f = 0; f < surface.n_faces(); ++f)
    for (Index corner = surface.face_offsets[f]; corner < surface.face_offsets[f + 1]; ++corner)
    {
      const NormalGradient gradient = smoothed_normal_gradient(surface, surface.reference, sharp_angle, f, corner);
      Eigen::MatrixXd found = Eigen::MatrixXd::Zero(dim, static_cast<Eigen::Index>(surface.reference.size()));
      for (std::size_t i = 0; i < gradient.nodes.size(); ++i)
        found.middleCols(dim * gradient.nodes[i], dim) =
            gradient.gradient.middleCols(dim * static_cast<Eigen::Index>(i), dim);
      for (std::size_t k = 0; k < surface.reference.size(); ++k)
      {
        std::vector<double> up = surface.reference, down = up;
        up[k] += h;
        down[k] -= h;
        const auto above = smoothed_normals(surface, up, sharp_angle),
                   below = smoothed_normals(surface, down, sharp_angle);
        for (int c = 0; c < dim; ++c)
          EXPECT_NEAR(found(c, static_cast<Eigen::Index>(k)),
                      (above[corner * dim + c] - below[corner * dim + c]) / (2 * h), 1e-8);
      }
    }
}

TEST(SmoothedNormals, GradientsMatchDifferences)
{
  // Unequal segments with a corner among them, and a bent sheet with a sharp fold along its middle.
  expect_gradients(polyline({0, 0, 1, 0.1, 1.5, 0.3, 1.6, 1, 1.5, 1.4}), 0.5);
  for (const bool triangles : {false, true})
    expect_gradients(
        test::sheet(
            2, 2, triangles,
            [](double s, double t) {
              return test::Point{s + 0.1 * t * t, t - 0.2 * s * t, 0.1 * s * s + std::abs(t - 0.5) + 0.05 * s * t};
            }),
        0.5);
}
} // namespace
} // namespace amontons
