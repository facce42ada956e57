#pragma once
#include "amontons/surface/face_batch_kernel.h"
#include "amontons/surface/projection.h"

#include <array>

namespace amontons
{
/// (x - point) . n at a local point of a face, n the outward unit normal there; 0 on a face of no area. Bit by bit what
/// FaceBatch gives.
double gap_at(const FaceCoordinates &face, LocalPoint xi, const Eigen::Vector3d &x);

/// Closest points of many faces to as many points, several at a time, with the widest instructions that the
/// processor has. Each result is bit by bit that of closest_point(), on every processor.
class FaceBatch
{
public:
  static constexpr int capacity = FaceBatchView::capacity;

  /// @param n_nodes of all its faces: 2 (in the plane), 3 or 4 (in space)
  explicit FaceBatch(int n_nodes)
    : n_nodes_(n_nodes)
  {
  }

  /// @param corners of the face, each [dim] @param x point, [dim] @return place in the batch
  template<int dim>
  int add(const std::array<const double *, 4> &corners, const double *x)
  {
    for (int k = 0; k < n_nodes_; ++k)
      for (int c = 0; c < dim; ++c)
        corners_[k * dim + c][size_] = corners[k][c] - x[c];
    return size_++;
  }

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] bool full() const { return size_ == capacity; }
  void clear() { size_ = 0; }

  void project() { project(nullptr); }
  /// With the gaps: of each point over its face, along the outward unit normal at the closest point.
  void project_with_gaps() { project(gap_); }

  // After project().
  [[nodiscard]] LocalPoint xi(int i) const { return {s_[i], t_[i]}; }
  [[nodiscard]] double squared_distance(int i) const { return squared_distance_[i]; }
  [[nodiscard]] double gap(int i) const { return gap_[i]; }

private:
  void project(double *gaps);

  int n_nodes_, size_ = 0;
  alignas(64) double corners_[12][capacity] = {};
  alignas(64) double s_[capacity] = {}, t_[capacity] = {}, squared_distance_[capacity] = {}, gap_[capacity] = {};
};
} // namespace amontons
