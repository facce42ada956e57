#pragma once
#include "amontons/detection/large_vector.h"
#include "amontons/surface/projection.h"
#include "amontons/surface/surface.h"

#include <array>
#include <cstdint>
#include <span>

namespace amontons
{
/// The target's faces in a given order (each has a slot), where they are now, and how far they have moved. Their nodes
/// stand in that order too; coordinates are not copied: the surface is numbered so that what lies near is near in
/// memory (renumbered_detector.h).
template<int dim>
class SortedFaces
{
public:
  using Box = std::array<double, static_cast<std::size_t>(2 * dim)>; ///< lower corner, then upper corner

  /// @param order the face in each slot; nothing is kept of it or the surface
  void number(const Surface &surface, std::span<const Index> order);

  /// @param x current coordinates of the surface's nodes, [n_nodes * dim]; they must outlive their use
  void move_to(std::span<const double> x);
  /// From here on motion() counts.
  void mark();
  /// Largest distance of a node from where it was at mark(); infinite before.
  [[nodiscard]] double motion() const { return motion_; }

  [[nodiscard]] int n_nodes(std::uint32_t slot) const { return dim == 2 ? 2 : nodes_[slot].back() == no_node ? 3 : 4; }
  /// Its nodes' positions; beyond n_nodes the pointers are those of the first.
  [[nodiscard]] std::array<const double *, 4> corners(std::uint32_t slot) const
  {
    const Nodes &nodes = nodes_[slot];
    std::array<const double *, 4> result;
    for (std::size_t k = 0; k < 4; ++k)
    {
      const bool is_node = k < nodes.size() && nodes[k] != no_node;
      result[k] = x_ + static_cast<std::ptrdiff_t>(nodes[is_node ? k : 0]) * dim;
    }
    return result;
  }
  /// corners() will be asked for.
  void expect(std::uint32_t slot) const { __builtin_prefetch(nodes_.data() + slot); }
  void expect_corners(std::uint32_t slot) const
  {
    for (std::size_t k = 0; k < dim; k += dim - 1) // opposite ones: the others are next to them in memory
      __builtin_prefetch(x_ + static_cast<std::ptrdiff_t>(nodes_[slot][k]) * dim);
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
  using Nodes = std::array<Index, dim == 2 ? 2 : 4>;
  static constexpr Index no_node = -1;

  LargeVector<Nodes> nodes_; ///< of the faces; a triangle's fourth is no_node
  const double *x_ = nullptr;
  std::size_t n_coordinates_ = 0;
  LargeVector<double> marked_;
  double motion_ = 0;
  Box all_{};
};
} // namespace amontons
