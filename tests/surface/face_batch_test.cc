#include "amontons/surface/face_batch.h"

#include "amontons/surface/instruction_set.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace amontons
{
namespace
{
struct Pairs
{
  int n_nodes, dim;
  std::vector<double> corners, points; ///< [pair][n_nodes][dim], [pair][dim]
};

// Faces of about unit size, their nodes astray by up to `distortion`, and points about them.
Pairs random_pairs(int n_nodes, int n_pairs, double distortion, unsigned seed)
{
  constexpr double base[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  Pairs pairs{n_nodes, n_nodes == 2 ? 2 : 3, {}, {}};
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int pair = 0; pair < n_pairs; ++pair)
  {
    for (int k = 0; k < n_nodes; ++k)
      for (int c = 0; c < pairs.dim; ++c)
        pairs.corners.push_back(base[k][c] + distortion * uniform(random));
    for (int c = 0; c < pairs.dim; ++c)
      pairs.points.push_back(0.5 + 1.5 * uniform(random));
  }
  return pairs;
}

std::array<const double *, 4> corners_of(const Pairs &pairs, int i)
{
  std::array<const double *, 4> result{};
  for (int k = 0; k < pairs.n_nodes; ++k)
    result[k] = pairs.corners.data() + (i * pairs.n_nodes + k) * pairs.dim;
  return result;
}

FaceCoordinates face_of(const Pairs &pairs, int i)
{
  FaceCoordinates face;
  face.n_nodes = pairs.n_nodes;
  const auto from = corners_of(pairs, i);
  const auto vector = [&](const double *x) { return Eigen::Vector3d(x[0], x[1], pairs.dim == 3 ? x[2] : 0.0); };
  for (int k = 0; k < pairs.n_nodes; ++k)
    face.x[k] = vector(from[k]);
  return face;
}

Eigen::Vector3d point_of(const Pairs &pairs, int i)
{
  const double *x = pairs.points.data() + i * pairs.dim;
  return {x[0], x[1], pairs.dim == 3 ? x[2] : 0.0};
}

ClosestPoint closest_one_by_one(const Pairs &pairs, int i)
{
  return closest_point(face_of(pairs, i), point_of(pairs, i));
}

// Bit by bit that of one face alone, which is what face_point() and face_normal() give.
void expect_the_gap(const Pairs &pairs, int i, LocalPoint xi, double gap)
{
  const FaceCoordinates face = face_of(pairs, i);
  const Eigen::Vector3d x = point_of(pairs, i);
  EXPECT_EQ(gap, gap_at(face, xi, x)) << pairs.n_nodes;
  EXPECT_NEAR(gap, (x - face_point(face, xi)).dot(face_normal(face, xi)), 1e-13) << pairs.n_nodes;
}

TEST(FaceBatch, IsBitByBitTheClosestPointOfOneFace)
{
  for (const int n_nodes : {2, 3, 4})
    for (const double distortion : {0.0, 0.02, 0.2, 0.8})
    {
      const int n = 3 * FaceBatch::capacity + 5;
      const Pairs pairs = random_pairs(n_nodes, n, distortion, 3);
      FaceBatch batch(n_nodes);
      for (int first = 0; first < n; first += FaceBatch::capacity)
      {
        batch.clear();
        for (int i = first; i < std::min(n, first + FaceBatch::capacity); ++i)
          n_nodes == 2 ? batch.add<2>(corners_of(pairs, i), pairs.points.data() + 2 * i)
                       : batch.add<3>(corners_of(pairs, i), pairs.points.data() + 3 * i);
        batch.project_with_gaps();
        for (int i = 0; i < batch.size(); ++i)
        {
          const ClosestPoint expected = closest_one_by_one(pairs, first + i);
          EXPECT_EQ(batch.squared_distance(i), expected.squared_distance) << n_nodes << ' ' << distortion;
          EXPECT_EQ(batch.xi(i), expected.xi) << n_nodes << ' ' << distortion;
          expect_the_gap(pairs, first + i, batch.xi(i), batch.gap(i));
        }
      }
    }
}

// Every instruction set that this processor has gives the same bits.
TEST(FaceBatch, InstructionSetsAgree)
{
  std::vector<FaceBatchKernel> kernels{baseline::project_batch};
  if (instruction_set() != InstructionSet::baseline)
    kernels.push_back(avx2::project_batch);
  if (instruction_set() == InstructionSet::avx512)
    kernels.push_back(avx512::project_batch);
  struct Output
  {
    alignas(64) double s[64], t[64], squared_distance[64], gap[64];
  };
  for (const int n_nodes : {2, 3, 4})
  {
    const Pairs pairs = random_pairs(n_nodes, 64, 0.1, 11);
    alignas(64) double corners[12][64] = {};
    for (int i = 0; i < 64; ++i)
      for (int k = 0; k < n_nodes; ++k)
        for (int c = 0; c < pairs.dim; ++c)
          corners[k * pairs.dim + c][i] = corners_of(pairs, i)[k][c] - pairs.points[i * pairs.dim + c];
    std::vector<Output> outputs(kernels.size());
    std::vector<std::uint64_t> unproven;
    for (std::size_t k = 0; k < kernels.size(); ++k)
    {
      Output &output = outputs[k];
      unproven.push_back(kernels[k]({corners, output.s, output.t, output.squared_distance, output.gap, n_nodes, 64}));
      EXPECT_EQ(unproven[k], unproven[0]);
      EXPECT_EQ(std::memcmp(&output, &outputs[0], sizeof(Output)), 0) << n_nodes;
      EXPECT_EQ(output.squared_distance[7], closest_one_by_one(pairs, 7).squared_distance);
    }
  }
}
} // namespace
} // namespace amontons
