#include "amontons/surface/face_batch.h"

#include "amontons/surface/instruction_set.h"
#include "amontons/surface/quadrilateral.h"

#include <bit>

namespace amontons
{
void FaceBatch::project()
{
  static const FaceBatchKernel kernel =
      kernel_for_processor<FaceBatchKernel>(baseline::project_batch, avx2::project_batch, avx512::project_batch);
  std::uint64_t unproven = kernel({corners_, s_, t_, squared_distance_, n_nodes_, size_});
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
  }
}
} // namespace amontons
