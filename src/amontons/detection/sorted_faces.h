#pragma once
#include "amontons/surface/projection.h"
#include "amontons/surface/surface.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace amontons
{
/// The target's faces in a given order (each has a slot), their nodes numbered as they are first met there, so that
/// faces which lie near one another lie so in memory too, however the mesh is numbered.
template<int dim>
class SortedFaces
{
public:
  using Box = std::array<double, static_cast<std::size_t>(2 * dim)>; ///< lower corner, then upper corner

  /// @param order the face in each slot
  void number(const Surface &surface, const std::vector<Index> &order);

  /// @param x current coordinates of the surface's nodes, [n_nodes * dim]
  void move_to(std::span<const double> x);
  /// From here on motion() counts.
  void mark()
  {
    marked_ = x_;
    motion_ = 0;
  }
  /// Largest distance of a node from where it was at mark(); infinite before.
  [[nodiscard]] double motion() const { return motion_; }

  [[nodiscard]] int n_nodes(std::uint32_t slot) const
  {
    return dim == 2 ? 2 : max_nodes_ == 4 && nodes_[slot * 4 + 3] >= 0 ? 4 : 3;
  }
  /// Its nodes' positions; beyond n_nodes the pointers are those of the first.
  [[nodiscard]] std::array<const double *, 4> corners(std::uint32_t slot) const
  {
    const Index *nodes = nodes_.data() + static_cast<std::size_t>(slot) * max_nodes_;
    std::array<const double *, 4> result;
    for (int k = 0; k < 4; ++k)
      result[k] = x_.data() + static_cast<std::ptrdiff_t>(k < max_nodes_ && nodes[k] >= 0 ? nodes[k] : nodes[0]) * dim;
    return result;
  }
  void prefetch(std::uint32_t slot) const { __builtin_prefetch(nodes_.data() + std::size_t{slot} * max_nodes_); }
  [[nodiscard]] FaceCoordinates face(std::uint32_t slot) const;
  [[nodiscard]] Box box(std::uint32_t slot) const;
  [[nodiscard]] const Box &box_of_all() const { return all_; }

private:
  int max_nodes_ = 2;
  std::vector<Index> nodes_;    ///< [n_faces * max_nodes_], -1 beyond a face's nodes
  std::vector<Index> original_; ///< node on the surface
  std::vector<double> x_, marked_;
  double motion_ = 0;
  Box all_{};
};
} // namespace amontons
