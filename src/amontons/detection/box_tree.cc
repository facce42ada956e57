#include "amontons/detection/box_tree.h"

#include "amontons/detection/hilbert.h"

#include <algorithm>
#include <limits>

namespace amontons
{
template<int dim>
void BoxTree<dim>::order_by(std::span<const std::array<double, static_cast<std::size_t>(dim)>> centres)
{
  order_ = curve_order<dim>(centres);
  level_begin_.assign(1, 0);
  for (std::size_t count = order_.size(); level_begin_.size() == 1 || count > 1;)
  {
    count = (count + width - 1) / width;
    level_begin_.push_back(level_begin_.back() + count);
  }
  nodes_.resize(level_begin_.back());
  ordered_extent_ = 0;
}

template<int dim>
void BoxTree<dim>::refit(std::span<const Box> boxes)
{
  if (boxes.empty())
    return;
  const float slack = centre_on(boxes);
  constexpr float far = std::numeric_limits<float>::infinity();
  for (std::int32_t level = 0; level <= top_level(); ++level)
  {
    Node &last = nodes_[level_begin_[level + 1] - 1]; // the only one that may have fewer than eight children
    for (int c = 0; c < dim; ++c)
    {
      last.low[c].setConstant(far);
      last.high[c].setConstant(-far);
    }
  }
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (int c = 0; c < dim; ++c)
    {
      nodes_[i / width].low[c][i % width] = static_cast<float>(boxes[i][c] - origin_[c]) - slack;
      nodes_[i / width].high[c][i % width] = static_cast<float>(boxes[i][c + dim] - origin_[c]) + slack;
    }
  extent_ = 0;
  for (std::int32_t level = 0; level <= top_level(); ++level)
    refit_parents(level);
  if (ordered_extent_ == 0)
    ordered_extent_ = extent_;
}

// Sets the origin, and tells by how much boxes must grow to hold what is rounded to single precision about it.
template<int dim>
float BoxTree<dim>::centre_on(std::span<const Box> boxes)
{
  Box all;
  std::fill_n(all.begin(), dim, std::numeric_limits<double>::infinity());
  std::fill_n(all.begin() + dim, dim, -std::numeric_limits<double>::infinity());
  for (const Box &box : boxes)
    for (int c = 0; c < dim; ++c)
    {
      all[c] = std::min(all[c], box[c]);
      all[c + dim] = std::max(all[c + dim], box[c + dim]);
    }
  double size = 0;
  for (int c = 0; c < dim && !boxes.empty(); ++c)
  {
    origin_[c] = 0.5 * (all[c] + all[c + dim]);
    size = std::max(size, all[c + dim] - all[c]);
  }
  return static_cast<float>(size * 2.4e-7);
}

// Sets the boxes of a level's nodes in their parents, and adds up the leaves' extents.
template<int dim>
void BoxTree<dim>::refit_parents(std::int32_t level)
{
  for (std::size_t child = level_begin_[level]; child < level_begin_[level + 1]; ++child)
  {
    const std::size_t i = child - level_begin_[level];
    for (int c = 0; c < dim; ++c)
    {
      const float low = nodes_[child].low[c].minCoeff(), high = nodes_[child].high[c].maxCoeff();
      if (level == 0)
        extent_ += high - low;
      if (level == top_level())
        continue;
      Node &parent = nodes_[level_begin_[level + 1] + i / width];
      parent.low[c][i % width] = low;
      parent.high[c][i % width] = high;
    }
  }
}

template<int dim>
typename BoxTree<dim>::FloatPoint BoxTree<dim>::relative(const double *x) const
{
  FloatPoint result;
  for (std::size_t c = 0; c < result.size(); ++c)
    result[c] = static_cast<float>(x[c] - origin_[c]);
  return result;
}

template<int dim>
bool BoxTree<dim>::collect(const Box &group, double squared_bound, Front &front) const
{
  front.n_leaves_ = 0;
  if (top_level() < 1) // one leaf, or none: nothing to share
    return false;
  const FloatPoint low = relative(group.data()), high = relative(group.data() + dim);
  const float bound = rounded_up(squared_bound);
  for (Node &block : front.boxes_)
    for (std::size_t c = 0; c < low.size(); ++c)
    {
      block.low[c].setConstant(std::numeric_limits<float>::infinity());
      block.high[c].setConstant(-std::numeric_limits<float>::infinity());
    }
  std::array<Entry, static_cast<std::size_t>(width * 16)> stack;
  int n_stacked = 1;
  stack[0] = {0, top_level(), 0};
  while (n_stacked > 0)
  {
    const Entry entry = stack[--n_stacked];
    const Node &parent = node(entry);
    const int first = n_stacked;
    append(squared_distances(parent, low, high), bound, entry.level - 1, entry.index * width, stack.data(), n_stacked);
    if (entry.level > 1)
      continue;
    if (front.n_leaves_ + n_stacked - first > Front::n_blocks * width)
      return false;
    for (; n_stacked > first; --n_stacked)
    {
      const std::uint32_t leaf = stack[n_stacked - 1].index;
      Node &block = front.boxes_[front.n_leaves_ / width];
      for (std::size_t c = 0; c < low.size(); ++c)
      {
        block.low[c][front.n_leaves_ % width] = parent.low[c][leaf % width];
        block.high[c][front.n_leaves_ % width] = parent.high[c][leaf % width];
      }
      front.leaves_[front.n_leaves_++] = leaf;
    }
  }
  return true;
}

template class BoxTree<2>;
template class BoxTree<3>;
} // namespace amontons
