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

private:
  using Floats = Eigen::Array<float, width, 1>;
  /// Eight boxes, single precision, grown by what rounding may have taken, relative to origin_.
  struct Node
  {
    std::array<Floats, dim> low, high;
  };

public:
  /// The leaves near a group of points: found once for all of them, so that the way down from the root is shared.
  class Front
  {
    friend class BoxTree;
    static constexpr int n_blocks = 8;
    std::array<Node, n_blocks> boxes_;
    std::array<std::uint32_t, static_cast<std::size_t>(n_blocks *width)> leaves_;
    int n_leaves_ = 0;
  };

  /// Collects the leaves that come within the bound of a box. @return false if they are too many for a front
  bool collect(const Box &group, double squared_bound, Front &front) const;

  /// Visits the faces whose boxes come within the bound of x, the nearer leaves first.
  /// @param front collected for a box that holds x and a bound not smaller; null: from the root
  /// @param squared_bound read anew after each visit, so that the visitor may shrink it
  /// @param visit called with the slot
  /// @param keep called with the level (-1: a face, 0: eight of them, ...) and the index at that level; where false,
  ///        nothing below is visited
  template<typename Visitor, typename Filter>
  void visit_within(const std::array<double, dim> &x, const double &squared_bound, const Front *front, Visitor &&visit,
                    Filter &&keep) const;

private:
  using FloatPoint = std::array<float, static_cast<std::size_t>(dim)>;

  /// A node of the tree (at level -1 a face) and its distance.
  struct Entry
  {
    float squared_distance;
    std::int32_t level;
    std::uint32_t index;
  };

  /// Distances to boxes are rounded: they are compared with a bound a little larger than asked.
  static float rounded_up(double squared_bound) { return (1 + 1e-5F) * static_cast<float>(squared_bound); }

  float centre_on(std::span<const Box> boxes);
  void refit_parents(std::int32_t level);
  [[nodiscard]] FloatPoint relative(const double *x) const;
  [[nodiscard]] std::int32_t top_level() const { return static_cast<std::int32_t>(level_begin_.size()) - 2; }
  [[nodiscard]] const Node &node(const Entry &entry) const { return nodes_[level_begin_[entry.level] + entry.index]; }
  /// Squared distances of eight boxes from the box [low, high].
  static Floats squared_distances(const Node &node, const FloatPoint &low, const FloatPoint &high);
  /// Appends those within the bound. `out` needs room for one more than are appended.
  static void append(const Floats &distances, float bound, std::int32_t level, std::uint32_t first, Entry *out, int &n);
  static void sort_farthest_first(Entry *entries, int n);

  std::array<double, dim> origin_{};
  std::vector<Index> order_;
  std::vector<Node> nodes_;                ///< level by level, the leaves first
  std::vector<std::size_t> level_begin_;   ///< in nodes_
  double extent_ = 0, ordered_extent_ = 0; ///< of the leaves, summed
};
} // namespace amontons

#include "amontons/detection/box_tree_query.h"
