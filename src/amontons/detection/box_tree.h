#pragma once
#include "amontons/base/ids.h"
#include "amontons/detection/box_kernels.h"
#include "amontons/detection/large_vector.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace amontons
{
/// Boxes of faces in a tree of sixteen children per node, packed along the Hilbert curve (Kamel, Faloutsos 1993): the
/// faces are sorted along the curve, sixteen successive ones make a leaf, sixteen successive leaves a node above, and
/// so on; no pointers. What a query costs hangs on how many faces come near, not on their sizes: neither a long edge
/// nor a graded mesh harms it. When the faces move the boxes are made anew in the same order.
template<int dim>
class BoxTree
{
public:
  static constexpr int width = BoxNode<dim>::width;

  using Box = std::array<double, static_cast<std::size_t>(2 * dim)>; ///< lower corner, then upper corner
  using FloatPoint = std::array<float, static_cast<std::size_t>(dim)>;

  /// Sets the order: runs of faces that follow one another, along the curve.
  /// @param centres of the runs @param run faces in each, but for the last, which may have fewer
  void order_by(std::span<const std::array<double, static_cast<std::size_t>(dim)>> centres, Index n_faces,
                Index run = 1);

  /// Faces in the order of the curve: the face in each slot.
  [[nodiscard]] const std::vector<Index> &order() const { return order_; }

  /// Takes in where the faces are now.
  /// @param all holds all of them @param box_of called with the slot, the slots one after another
  template<typename BoxOf>
  void refit(const Box &all, BoxOf &&box_of);

  /// Whether faces that follow one another have drifted apart since they were ordered, so that a new order pays.
  [[nodiscard]] bool is_poor() const { return extent_ > 1.5 * ordered_extent_; }

  /// Of the faces' boxes, over all axes: the harmonic mean, so that small ones count.
  [[nodiscard]] double mean_extent() const { return mean_extent_; }

  /// Relative to where the tree's boxes count from, in their precision.
  [[nodiscard]] FloatPoint relative(const double *x) const;
  /// Distances to boxes are rounded: they are compared with a bound a little larger than asked.
  static float rounded_up(double squared_bound)
  {
    return static_cast<float>(std::min((1 + 1e-5) * squared_bound, 1e38));
  }

  /// Leaves that come within the bound of a box. @param low, high its corners, relative()
  /// @param leaves [capacity] @return how many; more than `capacity`: too many
  int collect(const FloatPoint &low, const FloatPoint &high, double squared_bound, std::uint32_t *leaves,
              int capacity) const
  {
    if (order_.empty())
      return 0;
    return box_kernels<dim>().collect(view(), low.data(), high.data(), rounded_up(squared_bound), leaves, capacity);
  }
  /// list() will be asked for this leaf.
  void expect_leaf(std::uint32_t leaf) const
  {
    for (std::size_t line = 0; line < sizeof(BoxNode<dim>); line += 64)
      __builtin_prefetch(reinterpret_cast<const char *>(nodes_.data() + leaf) + line);
  }
  /// The slots of these leaves' faces that come within the bound of a box. @param low, high its corners, relative()
  /// @param slots [capacity] @return how many; more than `capacity`: too many
  int list(std::span<const std::uint32_t> leaves, const FloatPoint &low, const FloatPoint &high, double squared_bound,
           std::uint32_t *slots, int capacity) const
  {
    return box_kernels<dim>().list(view(), leaves.data(), static_cast<int>(leaves.size()), low.data(), high.data(),
                                   rounded_up(squared_bound), slots, capacity);
  }

  /// Visits the faces whose boxes come within the bound of x, the nearer first.
  /// @param squared_bound read anew after each visit, so that the visitor may shrink it
  /// @param visit called with the slot
  /// @param keep called with the level (-1: a face, 0: a leaf, ...) and the index at that level; where false, nothing
  ///        below is visited
  template<typename Visitor, typename Filter>
  void visit_within(const double *x, const double &squared_bound, Visitor &&visit, Filter &&keep) const;

  /// Visits the faces whose boxes meet a box, and maybe some that miss it by round-off.
  /// @param visit called with the slot
  template<typename Visitor>
  void visit_meeting(const Box &box, Visitor &&visit) const;

private:
  /// A node of the tree (at level -1 a face) and its distance.
  struct Entry
  {
    float squared_distance;
    std::int32_t level;
    std::uint32_t index;
  };

  float centre_on(const Box &all);
  void clear_incomplete();
  void refit_parents();
  [[nodiscard]] std::int32_t top_level() const { return static_cast<std::int32_t>(level_begin_.size()) - 2; }
  [[nodiscard]] BoxTreeView<dim> view() const { return {nodes_.data(), level_begin_.data(), top_level()}; }
  static void push_children(const BoxNode<dim> &node, const FloatPoint &x, float bound, const Entry &parent,
                            Entry *stack, int &n_stacked);

  std::array<double, dim> origin_{};
  std::vector<Index> order_;
  LargeVector<BoxNode<dim>> nodes_;        ///< level by level, the leaves first, relative to origin_
  std::vector<std::size_t> level_begin_;   ///< in nodes_
  double extent_ = 0, ordered_extent_ = 0; ///< of the leaves, summed
  double mean_extent_ = 0;
};
} // namespace amontons

#include "amontons/detection/box_tree_query.h"
