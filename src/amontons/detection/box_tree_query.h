#pragma once
#include "amontons/detection/box_tree.h"

#include <cmath>
#include <limits>
#include <utility>

namespace amontons
{
template<int dim>
template<typename BoxOf>
void BoxTree<dim>::refit(const Box &all, BoxOf &&box_of)
{
  if (order_.empty())
    return;
  const float slack = centre_on(all);
  clear_incomplete();
  double inverse_extents = 0;
  for (std::size_t slot = 0; slot < order_.size(); ++slot)
  {
    const Box box = box_of(slot);
    BoxNode<dim> &leaf = nodes_[slot / width];
    double extent = 0;
    for (int c = 0; c < dim; ++c)
    {
      extent += box[c + dim] - box[c];
      leaf.low[c][slot % width] = static_cast<float>(box[c] - origin_[c]) - slack;
      leaf.high[c][slot % width] = static_cast<float>(box[c + dim] - origin_[c]) + slack;
    }
    inverse_extents += extent > 0 ? 1 / extent : 0;
  }
  mean_extent_ = inverse_extents > 0 ? static_cast<double>(order_.size()) / inverse_extents : 0;
  refit_parents();
}

template<int dim>
template<typename Visitor, typename Filter>
void BoxTree<dim>::visit_within(const double *x, const double &squared_bound, Visitor &&visit, Filter &&keep) const
{
  if (order_.empty())
    return;
  const FloatPoint point = relative(x);
  // A stack with the nearest on top. Depth first, it never holds more than the children of one node of each level.
  std::array<Entry, static_cast<std::size_t>(width * 9)> stack;
  int n_stacked = 0;
  stack[n_stacked++] = {0, top_level(), 0};
  while (n_stacked > 0)
  {
    const Entry entry = stack[--n_stacked];
    if (entry.squared_distance > rounded_up(squared_bound) || !keep(entry.level, entry.index))
      continue;
    if (entry.level < 0)
      visit(static_cast<Index>(entry.index));
    else
      push_children(nodes_[level_begin_[entry.level] + entry.index], point, rounded_up(squared_bound), entry,
                    stack.data(), n_stacked);
  }
}

template<int dim>
template<typename Visitor>
void BoxTree<dim>::visit_meeting(const Box &box, Visitor &&visit) const
{
  if (order_.empty())
    return;
  FloatPoint low = relative(box.data()), high = relative(box.data() + dim);
  for (std::size_t c = 0; c < low.size(); ++c)
  {
    low[c] = std::nextafter(low[c], -std::numeric_limits<float>::infinity());
    high[c] = std::nextafter(high[c], std::numeric_limits<float>::infinity());
  }
  const auto meets = [&](const BoxNode<dim> &node, int i)
  {
    bool out = true;
    for (std::size_t c = 0; c < low.size(); ++c)
      out = out && node.low[c][i] <= high[c] && node.high[c][i] >= low[c];
    return out;
  };
  std::array<std::pair<std::int32_t, std::uint32_t>, static_cast<std::size_t>(width * 9)> stack;
  int n_stacked = 0;
  stack[n_stacked++] = {top_level(), 0};
  while (n_stacked > 0)
  {
    const auto [level, index] = stack[--n_stacked];
    const BoxNode<dim> &node = nodes_[level_begin_[level] + index];
    for (int i = 0; i < width; ++i)
    {
      const auto child = static_cast<std::uint32_t>(index * width + i);
      if (!meets(node, i))
        continue;
      if (level == 0)
        visit(static_cast<Index>(child));
      else
        stack[n_stacked++] = {level - 1, child};
    }
  }
}

// Those within the bound, the farthest first.
template<int dim>
void BoxTree<dim>::push_children(const BoxNode<dim> &node, const FloatPoint &x, float bound, const Entry &parent,
                                 Entry *stack, int &n_stacked)
{
  alignas(64) float distances[width];
  for (int i = 0; i < width; ++i)
  {
    float sum = 0;
    for (int c = 0; c < dim; ++c)
    {
      const float distance = std::max(std::max(node.low[c][i] - x[c], x[c] - node.high[c][i]), 0.0F);
      sum += distance * distance;
    }
    distances[i] = sum;
  }
  const int first = n_stacked;
  for (int i = 0; i < width; ++i)
  {
    if (!(distances[i] <= bound))
      continue;
    int place = n_stacked++;
    for (; place > first && stack[place - 1].squared_distance < distances[i]; --place)
      stack[place] = stack[place - 1];
    stack[place] = {distances[i], parent.level - 1, parent.index * width + static_cast<std::uint32_t>(i)};
  }
}
} // namespace amontons
