#pragma once
#include "amontons/detection/box_tree.h"

#include <algorithm>

namespace amontons
{
template<int dim>
template<typename Visitor>
void BoxTree<dim>::visit_within(const std::array<double, dim> &x, const double &squared_bound, Visitor &&visit) const
{
  if (order_.empty())
    return;
  // Distances to boxes are rounded: compare with a bound a little larger than asked.
  constexpr float margin = 1 + 1e-5F;
  std::array<float, dim> point;
  for (int c = 0; c < dim; ++c)
    point[c] = static_cast<float>(x[c] - origin_[c]);
  std::array<Entry, static_cast<std::size_t>(width) * 16> stack; // depth of 16 levels: 8^16 faces
  std::size_t n_stacked = 0;
  stack[n_stacked++] = {0, static_cast<std::uint32_t>(level_begin_.size() - 2), 0};
  while (n_stacked > 0)
  {
    const Entry entry = stack[--n_stacked];
    if (entry.squared_distance > margin * static_cast<float>(squared_bound))
      continue;
    const Node &node = nodes_[level_begin_[entry.level] + entry.index];
    Floats distance = Floats::Zero();
    for (int c = 0; c < dim; ++c)
      distance += (node.low[c] - point[c]).max(point[c] - node.high[c]).max(0.0F).square();
    std::array<Entry, width + 1> found;
    int n_found = 0;
    const float bound = margin * static_cast<float>(squared_bound);
    for (std::uint32_t i = 0; i < width; ++i) // no branch: it could not be foreseen
    {
      found[n_found] = {distance[i], entry.level - 1, entry.index * width + i};
      n_found += distance[i] <= bound;
    }
    // Farthest first, so that the nearest comes off the stack first.
    for (int i = 1; i < n_found; ++i)
    {
      const Entry moved = found[i];
      int place = i;
      for (; place > 0 && found[place - 1].squared_distance < moved.squared_distance; --place)
        found[place] = found[place - 1];
      found[place] = moved;
    }
    if (entry.level > 0)
      for (int i = 0; i < n_found; ++i)
        stack[n_stacked++] = found[i];
    else
      for (int i = n_found; i-- > 0;)
        if (found[i].squared_distance <= margin * static_cast<float>(squared_bound))
          visit(static_cast<Index>(found[i].index));
  }
}
} // namespace amontons
