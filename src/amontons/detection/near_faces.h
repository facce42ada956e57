#pragma once
#include "amontons/detection/box_tree.h"
#include "amontons/detection/near_leaves.h"
#include "amontons/detection/sorted_faces.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace amontons
{
/// The faces near a block of impactor nodes, gathered once for all of them: what bounds the distance of each from below
/// costs a node far less than a projection, and hardly leaves more than the closest face to project on.
template<int dim>
class NearFaces
{
public:
  using Point = std::array<double, static_cast<std::size_t>(dim)>;
  using Group = PointGroup<dim>;

  /// Whether all faces of a region have been gathered.
  [[nodiscard]] bool hold(const Region<dim> &region) const
  {
    bool result = region_.reach >= region.reach;
    for (std::size_t c = 0; c < dim; ++c)
      result = result && region.low[c] >= region_.low[c] && region.high[c] <= region_.high[c];
    return result;
  }
  void clear() { region_ = Region<dim>::none(); }

  /// Gathers the faces whose boxes in the tree come into the region, where they are now. @param leaves those of the
  /// region at least @return false if they are too many
  bool gather(const BoxTree<dim> &tree, const SortedFaces<dim> &faces, std::span<const std::uint32_t> leaves,
              const Region<dim> &region);

  /// Bounds the distances of the group's points from those of the faces that come within the reach of any of them.
  /// @param point_of called with 0, ..., n_points - 1, points in the box of the region
  /// @param likeliest null, or see BoxKernels
  template<typename PointOf>
  void measure(int n_points, PointOf &&point_of, double reach, Group &group, std::uint32_t *likeliest) const;

  /// A squared distance as the group has them: what is farther is farther in truth.
  [[nodiscard]] float squared_bound(double distance) const
  {
    return BoxTree<dim>::rounded_up(scale_ * scale_ * distance * distance);
  }

private:
  void set_corners(const SortedFaces<dim> &faces);

  Region<dim> region_ = Region<dim>::none();
  Point origin_{};
  double scale_ = 1;
  SlabbedFaces<dim> slabbed_;
};

template<int dim>
bool NearFaces<dim>::gather(const BoxTree<dim> &tree, const SortedFaces<dim> &faces,
                            std::span<const std::uint32_t> leaves, const Region<dim> &region)
{
  slabbed_.n = tree.list(leaves, tree.relative(region.low.data()), tree.relative(region.high.data()),
                         region.reach * region.reach, slabbed_.slots, SlabbedFaces<dim>::capacity);
  if (slabbed_.n > SlabbedFaces<dim>::capacity)
  {
    clear();
    return false;
  }
  region_ = region;
  for (int i = 0; i < slabbed_.n; ++i)
    faces.expect_corners(slabbed_.slots[i]);
  set_corners(faces);
  float size = 0; // of the points' part
  for (std::size_t c = 0; c < dim; ++c)
    size = std::max(size, static_cast<float>(region.high[c] - origin_[c]));
  scale_ = box_kernels<dim>().enclose(slabbed_, size);
  return true;
}

template<int dim>
void NearFaces<dim>::set_corners(const SortedFaces<dim> &faces)
{
  for (std::size_t c = 0; c < dim; ++c)
    origin_[c] = 0.5 * (region_.low[c] + region_.high[c]);
  bool any_quadrilateral = false;
  for (int i = 0; i < slabbed_.n; ++i)
  {
    const auto corners = faces.corners(slabbed_.slots[i]);
    any_quadrilateral = any_quadrilateral || corners[3] != corners[0];
    for (std::size_t k = 0; k < SlabbedFaces<dim>::n_corners; ++k)
      for (std::size_t c = 0; c < dim; ++c)
        slabbed_.corners[k][c][i] = static_cast<float>(corners[k][c] - origin_[c]);
  }
  slabbed_.n_sides = dim == 2 ? 2 : any_quadrilateral ? 4 : 3;
}

template<int dim>
template<typename PointOf>
void NearFaces<dim>::measure(int n_points, PointOf &&point_of, double reach, Group &group,
                             std::uint32_t *likeliest) const
{
  std::array<float, dim> low, high;
  for (int i = 0; i < n_points; ++i)
  {
    const Point &x = point_of(i);
    for (std::size_t c = 0; c < dim; ++c)
    {
      const auto own = static_cast<float>(scale_ * (x[c] - origin_[c]));
      group.x[c][i] = own;
      low[c] = i == 0 ? own : std::min(low[c], own);
      high[c] = i == 0 ? own : std::max(high[c], own);
    }
  }
  for (std::size_t c = 0; c < dim; ++c)
    std::fill(group.x[c] + n_points, group.x[c] + Group::most_points, low[c]);
  box_kernels<dim>().measure(slabbed_, low.data(), high.data(), squared_bound(reach), group, likeliest);
}
} // namespace amontons
