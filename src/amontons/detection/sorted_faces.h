#pragma once
#include "amontons/detection/large_vector.h"
#include "amontons/surface/projection.h"
#include "amontons/surface/surface.h"

#include <array>
#include <cstdint>
#include <span>

namespace amontons
{
/// The target's faces in a given order (each has a slot), where they are now, and how far they have moved. Nothing is
/// copied: the surface is numbered so that what lies near is near in memory (renumbered_detector.h).
template<int dim>
class SortedFaces
{
public:
  using Box = std::array<double, static_cast<std::size_t>(2 * dim)>; ///< lower corner, then upper corner

  /// @param order the face in each slot; it and the surface must outlive their use
  void number(const Surface &surface, std::span<const Index> order);

  /// @param x current coordinates of the surface's nodes, [n_nodes * dim]; they must outlive their use
  void move_to(std::span<const double> x);
  /// From here on motion() counts.
  void mark();
  /// Largest distance of a node from where it was at mark(); infinite before.
  [[nodiscard]] double motion() const { return motion_; }

  [[nodiscard]] int n_nodes(std::uint32_t slot) const
  {
    const Index *range = face_offsets_ + order_[slot];
    return range[1] - range[0];
  }
  /// Its nodes' positions; beyond n_nodes the pointers are those of the first.
  [[nodiscard]] std::array<const double *, 4> corners(std::uint32_t slot) const
  {
    const Index *range = face_offsets_ + order_[slot];
    const Index *nodes = face_nodes_ + range[0];
    const int n = dim == 2 ? 2 : range[1] - range[0];
    std::array<const double *, 4> result;
    for (int k = 0; k < 4; ++k)
      result[k] = x_ + static_cast<std::ptrdiff_t>(nodes[k < n ? k : 0]) * dim;
    return result;
  }
  [[nodiscard]] FaceCoordinates face(std::uint32_t slot) const;
  [[nodiscard]] Box box(std::uint32_t slot) const
  {
    const auto from = corners(slot);
    Box result;
    for (int c = 0; c < dim; ++c)
    {
      double low = from[0][c], high = low;
      for (int k = 1; k < (dim == 2 ? 2 : 4); ++k)
      {
        low = from[k][c] < low ? from[k][c] : low;
        high = from[k][c] > high ? from[k][c] : high;
      }
      result[c] = low;
      result[c + dim] = high;
    }
    return result;
  }
  [[nodiscard]] const Box &box_of_all() const { return all_; }

private:
  const Index *order_ = nullptr, *face_offsets_ = nullptr, *face_nodes_ = nullptr;
  const double *x_ = nullptr;
  std::size_t n_coordinates_ = 0;
  LargeVector<double> marked_;
  double motion_ = 0;
  Box all_{};
};
} // namespace amontons
