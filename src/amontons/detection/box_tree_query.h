#pragma once
#include "amontons/detection/box_tree.h"

namespace amontons
{
template<int dim>
template<typename Visitor, typename Filter>
void BoxTree<dim>::visit_within(const std::array<double, dim> &x, const double &squared_bound, const Front *front,
                                Visitor &&visit, Filter &&keep) const
{
  if (order_.empty())
    return;
  const FloatPoint point = relative(x.data());
  // A stack with the nearest on top. Depth first, it never holds more than seven nodes of each level below the first.
  std::array<Entry, static_cast<std::size_t>(Front::n_blocks * width + width * 16)> stack;
  int n_stacked = 0;
  if (front)
  {
    for (int block = 0; block * width < front->n_leaves_; ++block)
      append(squared_distances(front->boxes_[block], point, point), rounded_up(squared_bound), 0,
             static_cast<std::uint32_t>(block * width), stack.data(), n_stacked);
    for (int i = 0; i < n_stacked; ++i)
      stack[i].index = front->leaves_[stack[i].index];
    sort_farthest_first(stack.data(), n_stacked);
  }
  else
    stack[n_stacked++] = {0, top_level(), 0};
  while (n_stacked > 0)
  {
    const Entry entry = stack[--n_stacked];
    if (entry.squared_distance > rounded_up(squared_bound) || !keep(entry.level, entry.index))
      continue;
    if (entry.level < 0)
    {
      visit(static_cast<Index>(entry.index));
      continue;
    }
    const int first = n_stacked;
    append(squared_distances(node(entry), point, point), rounded_up(squared_bound), entry.level - 1,
           entry.index * width, stack.data(), n_stacked);
    sort_farthest_first(stack.data() + first, n_stacked - first);
  }
}

template<int dim>
typename BoxTree<dim>::Floats BoxTree<dim>::squared_distances(const Node &node, const FloatPoint &low,
                                                              const FloatPoint &high)
{
  Floats distances = Floats::Zero();
  for (std::size_t c = 0; c < low.size(); ++c)
    distances += (node.low[c] - high[c]).max(low[c] - node.high[c]).max(0.0F).square();
  return distances;
}

template<int dim>
void BoxTree<dim>::append(const Floats &distances, float bound, std::int32_t level, std::uint32_t first, Entry *out,
                          int &n)
{
  for (std::uint32_t i = 0; i < width; ++i) // no branch: it could not be foreseen
  {
    out[n] = {distances[i], level, first + i};
    n += distances[i] <= bound;
  }
}

template<int dim>
void BoxTree<dim>::sort_farthest_first(Entry *entries, int n)
{
  for (int i = 1; i < n; ++i)
  {
    const Entry moved = entries[i];
    int place = i;
    for (; place > 0 && entries[place - 1].squared_distance < moved.squared_distance; --place)
      entries[place] = entries[place - 1];
    entries[place] = moved;
  }
}
} // namespace amontons
