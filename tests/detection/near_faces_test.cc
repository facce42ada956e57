#include "amontons/detection/near_leaves.h"
#include "amontons/surface/projection.h"
#include "detection/box_kernel_sets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

namespace amontons::test
{
namespace
{
using Eigen::Vector3d;

struct Shapes
{
  std::vector<FaceCoordinates> faces;
  int n_regular = 0; ///< flat and not too slender, the first of all
};

Vector3d random_point(std::mt19937 &random, int dim)
{
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, dim == 3 ? z : 0.0};
}

FaceCoordinates flat_face(std::mt19937 &random, int n_nodes)
{
  std::uniform_real_distribution<double> noise(-0.2, 0.2);
  const Vector3d from = random_point(random, n_nodes == 2 ? 2 : 3);
  const Vector3d a = random_point(random, n_nodes == 2 ? 2 : 3).normalized();
  const Vector3d b = n_nodes == 2 ? Vector3d(0, 0, 1) : Vector3d(a.cross(random_point(random, 3)).normalized());
  const std::array<std::array<double, 2>, 4> corners{{{0, 0}, {1, 0}, {n_nodes == 3 ? 0.0 : 1.0, 1}, {0, 1}}};
  FaceCoordinates face;
  face.n_nodes = n_nodes;
  for (int k = 0; k < n_nodes; ++k)
  {
    const double s = corners[k][0] + noise(random), t = n_nodes == 2 ? 0.0 : corners[k][1] + noise(random);
    face.x[k] = from + 0.3 * (s * a + t * b);
  }
  return face;
}

// Regular ones, then twisted, slender, very small ones and some without any area.
Shapes shapes(int dim, bool quadrilaterals)
{
  std::mt19937 random(11);
  Shapes result;
  for (int i = 0; i < 60; ++i)
    result.faces.push_back(flat_face(random, dim == 2 ? 2 : quadrilaterals && i % 3 > 0 ? 4 : 3));
  result.n_regular = static_cast<int>(result.faces.size());
  for (int i = 0; i < 90; ++i)
  {
    FaceCoordinates face = flat_face(random, dim == 2 ? 2 : quadrilaterals && i % 3 > 0 ? 4 : 3);
    for (int k = 1; k < face.n_nodes; ++k)
      switch (i % 6)
      {
      case 0: // anything
        face.x[k] = random_point(random, dim);
        break;
      case 1: // one corner on another
        face.x[k] = face.x[k == 2 ? 1 : k];
        break;
      case 2: // a point
        face.x[k] = face.x[0];
        break;
      case 3: // on a line, but for round-off
        face.x[k] = face.x[0] + k * k * 0.1 * (face.x[1] - face.x[0]);
        break;
      case 4: // very slender
        face.x[k] = face.x[0] + (k % 2) * (face.x[1] - face.x[0]) + 1e-5 * random_point(random, dim);
        break;
      default: // very small
        face.x[k] = face.x[0] + 1e-6 * random_point(random, dim);
      }
    result.faces.push_back(face);
  }
  return result;
}

template<int dim>
std::unique_ptr<SlabbedFaces<dim>> slabbed(const std::vector<FaceCoordinates> &faces, double unit)
{
  auto result = std::make_unique<SlabbedFaces<dim>>();
  result->n = static_cast<int>(faces.size());
  result->n_sides = dim == 2 ? 2 : 3;
  for (int i = 0; i < result->n; ++i)
  {
    result->slots[i] = 1000 + static_cast<std::uint32_t>(i);
    if (faces[i].n_nodes == 4)
      result->n_sides = 4;
    for (int k = 0; k < SlabbedFaces<dim>::n_corners; ++k)
      for (int c = 0; c < dim; ++c)
        result->corners[k][c][i] = static_cast<float>(unit * faces[i].x[k < faces[i].n_nodes ? k : 0][c]);
  }
  return result;
}

// Bounds of the distances never exceed them, and where the face is flat and the point over it or over an edge they are
// equal; select() names exactly those that come within a bound.
template<int dim>
void expect_bounds(const BoxKernels<dim> &kernels, bool quadrilaterals, double unit)
{
  const Shapes all = shapes(dim, quadrilaterals);
  const auto faces = slabbed<dim>(all.faces, unit);
  const float scale = kernels.enclose(*faces, static_cast<float>(1.2 * unit));
  auto group = std::make_unique<PointGroup<dim>>();
  std::mt19937 random(5);
  int n_equal = 0;
  for (int trial = 0; trial < 20; ++trial)
  {
    constexpr int most = PointGroup<dim>::most_points;
    std::array<Vector3d, most> points;
    std::array<float, dim> low, high;
    std::array<float, most> bounds;
    std::array<std::uint32_t, most> likeliest, known;
    for (int i = 0; i < most; ++i)
    {
      points[i] = 0.6 * (random_point(random, dim) + random_point(random, dim));
      for (int c = 0; c < dim; ++c)
      {
        const float x = group->x[c][i] = static_cast<float>(scale * unit * points[i][c]);
        low[c] = i == 0 ? x : std::min(low[c], x);
        high[c] = i == 0 ? x : std::max(high[c], x);
      }
      bounds[i] = 0.01F * static_cast<float>(i);
    }
    kernels.measure(*faces, low.data(), high.data(), 1e30F, *group, likeliest.data());
    ASSERT_EQ(group->n_slots, faces->n);
    for (int i = 0; i < most; ++i)
    {
      float least = 1e30F;
      for (int k = 0; k < group->n_slots; ++k)
      {
        const int f = static_cast<int>(group->slots[k]) - 1000;
        const ClosestPoint closest = closest_point(all.faces[f], points[i]);
        const double distance = std::sqrt(closest.squared_distance);
        const double bound = std::sqrt(static_cast<double>(group->squared_distances[k][i])) / (scale * unit);
        ASSERT_LE(bound, (1 + 5e-6) * distance) << "face " << f;
        least = std::min(least, group->squared_distances[k][i]);
        const FaceFeature where = feature_at(all.faces[f].n_nodes, closest.xi, 1e-6).type;
        if (f >= all.n_regular || (dim == 3 && where == FaceFeature::vertex))
          continue;
        ASSERT_GE(bound, distance - 2e-5) << "face " << f;
        ++n_equal;
      }
      EXPECT_TRUE(likeliest[i] >= 1000 &&
                  group->squared_distances[likeliest[i] - 1000][i] == least); // none is left out, so k is the face
      known[i] = likeliest[i];
    }
    std::vector<std::uint16_t> near(group->n_slots);
    kernels.select(*group, bounds.data(), known.data(), near.data());
    for (int k = 0; k < group->n_slots; ++k)
      for (int i = 0; i < most; ++i)
        ASSERT_EQ((near[k] >> i & 1) != 0,
                  group->squared_distances[k][i] <= bounds[i] && group->slots[k] != likeliest[i]);
  }
  EXPECT_GT(n_equal, 4000);
}

TEST(NearFaces, AreNoNearerThanTheirBounds)
{
  for (const double unit : {1.0, 1e-9, 1e6})
  {
    for (const auto &kernels : kernels_of_this_processor<2>())
      expect_bounds<2>(kernels, false, unit);
    for (const auto &kernels : kernels_of_this_processor<3>())
      for (const bool quadrilaterals : {false, true})
        expect_bounds<3>(kernels, quadrilaterals, unit);
  }
}

// A group is given the faces whose boxes come within its reach, and no others.
TEST(NearFaces, ComeFromTheGroupsReachAlone)
{
  const Shapes all = shapes(3, true);
  for (const auto &kernels : kernels_of_this_processor<3>())
  {
    const auto faces = slabbed<3>(all.faces, 1);
    const float scale = kernels.enclose(*faces, 1);
    auto group = std::make_unique<PointGroup<3>>();
    const std::array<float, 3> low{-0.1F, 0, -0.2F}, high{0.1F, 0.1F, -0.1F};
    const float reach = 0.1F;
    kernels.measure(*faces, low.data(), high.data(), reach * reach, *group, nullptr);
    std::vector<bool> given(all.faces.size());
    for (int k = 0; k < group->n_slots; ++k)
      given[group->slots[k] - 1000] = true;
    int n_given = 0;
    for (std::size_t f = 0; f < all.faces.size(); ++f)
    {
      double squared = 0;
      for (int c = 0; c < 3; ++c)
      {
        double least = 1e30, most = -1e30;
        for (int k = 0; k < all.faces[f].n_nodes; ++k)
        {
          least = std::min(least, scale * all.faces[f].x[k][c]);
          most = std::max(most, scale * all.faces[f].x[k][c]);
        }
        const double out = std::max({least - high[c], low[c] - most, 0.0});
        squared += out * out;
      }
      n_given += given[f];
      EXPECT_TRUE(given[f] || squared > reach * reach) << f;
      EXPECT_TRUE(!given[f] || std::sqrt(squared) < reach + 1e-5) << f;
    }
    EXPECT_GT(n_given, 10);
    EXPECT_LT(n_given, faces->n);
  }
}

// A region holds exactly the points whose distance from its box is at most its reach: covers() is held against points.
template<int dim>
void expect_covers()
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int n_covered = 0, n_not = 0;
  for (int trial = 0; trial < 3000; ++trial)
  {
    Region<dim> a = Region<dim>::none(), b = a;
    for (int k = 0; k < 3; ++k)
    {
      typename Region<dim>::Point x, y;
      for (int c = 0; c < dim; ++c)
      {
        x[c] = uniform(random);
        y[c] = 0.6 * uniform(random);
      }
      a.extend(x);
      b.extend(y);
    }
    EXPECT_FALSE(a.covers(b)); // no reach yet: nothing
    a.reach = std::abs(uniform(random));
    b.reach = 0.7 * std::abs(uniform(random));
    // The point of b farthest from a's box: from the farthest corner straight away from it.
    double farthest = 0;
    for (int corner = 0; corner < 1 << dim; ++corner)
    {
      double squared = 0;
      for (int c = 0; c < dim; ++c)
      {
        const double x = (corner >> c & 1) != 0 ? b.high[c] : b.low[c];
        const double out = std::max({a.low[c] - x, x - a.high[c], 0.0});
        squared += out * out;
      }
      farthest = std::max(farthest, std::sqrt(squared));
    }
    const bool inside = farthest + b.reach <= a.reach;
    EXPECT_TRUE(!a.covers(b) || inside);
    n_covered += a.covers(b);
    n_not += !inside;
    for (int k = 0; k < 5 && a.covers(b); ++k) // points of b, straight from its box
    {
      double squared = 0, length = 0;
      std::array<double, dim> x, direction;
      for (int c = 0; c < dim; ++c)
      {
        direction[c] = uniform(random);
        length += direction[c] * direction[c];
      }
      for (int c = 0; c < dim; ++c)
      {
        x[c] = b.low[c] + 0.5 * (1 + uniform(random)) * (b.high[c] - b.low[c]);
        x[c] += b.reach * direction[c] / std::sqrt(length);
        const double out = std::max({a.low[c] - x[c], x[c] - a.high[c], 0.0});
        squared += out * out;
      }
      EXPECT_LE(std::sqrt(squared), a.reach * (1 + 1e-12));
    }
  }
  EXPECT_GT(n_covered, 300);
  EXPECT_GT(n_not, 300);
}

TEST(Region, CoversWhatLiesInIt)
{
  expect_covers<2>();
  expect_covers<3>();
}

TEST(NearLeaves, AreThoseKeptForTheBlockAndNoOthers)
{
  NearLeaves<2> near;
  std::mt19937 random(1);
  std::vector<std::vector<std::uint32_t>> kept(20);
  for (int search = 0; search < 5; ++search)
  {
    near.begin(kept.size());
    for (std::size_t block = 0; block < kept.size(); ++block)
    {
      const auto leaves = near.leaves(block);
      ASSERT_EQ(std::vector<std::uint32_t>(leaves.begin(), leaves.end()), kept[block]) << search;
      EXPECT_EQ(near.region(block).reach >= 0, !kept[block].empty());
      kept[block].assign(random() % 4, static_cast<std::uint32_t>(random()));
      Region<2> region = Region<2>::none();
      region.reach = 2;
      if (kept[block].empty())
        near.forget(block);
      else
        near.keep(block, region, kept[block]);
    }
  }
  near.begin(kept.size());
  near.shrink(1.5);
  for (std::size_t block = 0; block < kept.size(); ++block)
    EXPECT_EQ(near.region(block).reach, kept[block].empty() ? -2.5 : 0.5);
  near.begin(kept.size() + 1); // other blocks
  for (std::size_t block = 0; block <= kept.size(); ++block)
  {
    EXPECT_TRUE(near.leaves(block).empty());
    EXPECT_FALSE(near.region(block).covers(Region<2>{{0, 0}, {0, 0}, 0}));
  }
}
} // namespace
} // namespace amontons::test
