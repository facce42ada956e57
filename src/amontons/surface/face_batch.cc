#include "amontons/surface/face_batch.h"

#include "amontons/surface/closest_point_lanes.h"
#include "amontons/surface/instruction_set.h"
#include "amontons/surface/quadrilateral.h"

#include <bit>

namespace amontons
{
namespace
{
// Of the origin over the face.
template<int n_nodes>
double gap_of(const baseline::Vec<double, 3> *nodes, LocalPoint xi)
{
  const auto [s, t] = xi;
  return baseline::gap_at<n_nodes>(nodes, baseline::point_at<n_nodes>(nodes, s, t), s, t);
}
} // namespace

double gap_at(const FaceCoordinates &face, LocalPoint xi, const Eigen::Vector3d &x)
{
  std::array<baseline::Vec<double, 3>, 4> nodes{};
  for (int k = 0; k < face.n_nodes; ++k)
    for (int c = 0; c < 3; ++c)
      nodes[k].c[c] = face.x[k][c] - x[c];
  return face.n_nodes == 2   ? gap_of<2>(nodes.data(), xi)
         : face.n_nodes == 3 ? gap_of<3>(nodes.data(), xi)
                             : gap_of<4>(nodes.data(), xi);
}

void FaceBatch::project(double *gaps)
{
  static const FaceBatchKernel kernel =
      kernel_for_processor<FaceBatchKernel>(baseline::project_batch, avx2::project_batch, avx512::project_batch);
  std::uint64_t unproven = kernel({corners_, s_, t_, squared_distance_, gaps, n_nodes_, size_});
  if (size_ < capacity)
    unproven &= (std::uint64_t{1} << size_) - 1;
  for (; unproven != 0; unproven &= unproven - 1)
  {
    const int i = std::countr_zero(unproven);
    FaceCoordinates face;
    face.n_nodes = 4;
    for (int k = 0; k < 4; ++k)
      face.x[k] = Eigen::Vector3d(corners_[3 * k][i], corners_[3 * k + 1][i], corners_[3 * k + 2][i]);
    const ClosestPoint closest = closest_point_by_quintic(face, Eigen::Vector3d::Zero());
    s_[i] = closest.xi[0];
    t_[i] = closest.xi[1];
    squared_distance_[i] = closest.squared_distance;
    if (gaps)
      gaps[i] = gap_at(face, closest.xi, Eigen::Vector3d::Zero());
  }
}
} // namespace amontons
