#pragma once
#include "amontons/base/ids.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace amontons
{
/// Boxes of faces in a tree of eight children per node, packed along the Hilbert curve (Kamel, Faloutsos 1993): the
/// faces are sorted along the curve, eight successive ones make a node, eight successive nodes a node above, and so on;
/// no pointers. What a query costs hangs on how many faces come near, not on their sizes: neither a long edge nor a
/// graded mesh harms it. When the faces move the boxes are made anew in the same order, which is all that stays to be
/// done between detections.
template<int dim>
class BoxTree
{
public:
  static constexpr int width = 8;

  using Box = std::array<double, static_cast<std::size_t>(2 * dim)>; ///< lower corner, then upper corner

  /// Sets the order: the faces with the given centres along the curve.
  void order_by(std::span<const std::array<double, static_cast<std::size_t>(dim)>> centres);

  /// Faces in the order of the curve: the face in each slot.
  [[nodiscard]] const std::vector<Index> &order() const { return order_; }

  /// Takes in where the faces are now.
  /// @param boxes slot by slot
  void refit(std::span<const Box> boxes);

  /// Whether faces that follow one another have drifted apart since they were ordered, so that a new order pays.
  [[nodiscard]] bool is_poor() const { return extent_ > 1.5 * ordered_extent_; }

  /// Visits boxes nearest first within each node, as long as they come within the bound.
  /// @param squared_bound read anew after each visit, so that the visitor may shrink it
  /// @param visit called with the slot
  template<typename Visitor>
  void visit_within(const std::array<double, dim> &x, const double &squared_bound, Visitor &&visit) const;

private:
  using Floats = Eigen::Array<float, width, 1>;
  /// Eight boxes, single precision, grown by what rounding may have taken, relative to origin_.
  struct Node
  {
    std::array<Floats, dim> low, high;
  };
  struct Entry
  {
    float squared_distance;
    std::uint32_t level;
    std::uint32_t index;
  };

  std::array<double, dim> origin_{};
  std::vector<Index> order_;
  std::vector<Node> nodes_;                ///< level by level, the leaves first
  std::vector<std::size_t> level_begin_;   ///< in nodes_
  double extent_ = 0, ordered_extent_ = 0; ///< of the leaves, summed
};
} // namespace amontons

#include "amontons/detection/box_tree_query.h"
