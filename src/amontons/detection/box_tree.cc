#include "amontons/detection/box_tree.h"

#include "amontons/detection/hilbert.h"

#include <cmath>
#include <limits>

namespace amontons
{
template<int dim>
void BoxTree<dim>::fill(std::span<const Box> boxes)
{
  if (order_.size() != boxes.size())
  {
    sort(boxes);
    refit(boxes);
    sorted_extent_ = total_extent();
    return;
  }
  refit(boxes);
  // Faces that were neighbours along the curve have drifted apart: a new order pays.
  if (total_extent() > 1.5 * sorted_extent_)
  {
    sort(boxes);
    refit(boxes);
    sorted_extent_ = total_extent();
  }
}

template<int dim>
void BoxTree<dim>::sort(std::span<const Box> boxes)
{
  constexpr int bits = 60 / dim > 30 ? 30 : 60 / dim;
  std::array<double, dim> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Box &box : boxes)
    for (int c = 0; c < dim; ++c)
    {
      low[c] = std::min(low[c], box[c] + box[c + dim]);
      high[c] = std::max(high[c], box[c] + box[c + dim]);
    }
  double extent = 0;
  for (int c = 0; c < dim; ++c)
    extent = std::max(extent, high[c] - low[c]);
  const double scale = extent > 0 ? (static_cast<double>(1U << bits) - 1) / extent : 0;
  keys_.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    std::array<std::uint32_t, dim> cell;
    for (int c = 0; c < dim; ++c)
      cell[c] = static_cast<std::uint32_t>(scale * (boxes[i][c] + boxes[i][c + dim] - low[c]));
    keys_[i] = {hilbert_position<dim, bits>(cell), static_cast<Index>(i)};
  }
  std::sort(keys_.begin(), keys_.end());
  order_.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    order_[i] = keys_[i].second;
  level_begin_.assign(1, 0);
  for (std::size_t count = boxes.size(); level_begin_.size() == 1 || count > 1;)
  {
    count = (count + width - 1) / width;
    level_begin_.push_back(level_begin_.back() + count);
  }
  nodes_.resize(level_begin_.back());
}

template<int dim>
void BoxTree<dim>::refit(std::span<const Box> boxes)
{
  std::array<double, dim> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Box &box : boxes)
    for (int c = 0; c < dim; ++c)
    {
      low[c] = std::min(low[c], box[c]);
      high[c] = std::max(high[c], box[c + dim]);
    }
  double extent = 0;
  for (int c = 0; c < dim && !boxes.empty(); ++c)
  {
    origin_[c] = 0.5 * (low[c] + high[c]);
    extent = std::max(extent, high[c] - low[c]);
  }
  slack_ = static_cast<float>(extent * 2.4e-7);

  constexpr float far = std::numeric_limits<float>::infinity();
  for (Node &node : nodes_)
    for (int c = 0; c < dim; ++c)
    {
      node.low[c].setConstant(far);
      node.high[c].setConstant(-far);
    }
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (int c = 0; c < dim; ++c)
    {
      const Box &box = boxes[order_[i]];
      nodes_[i / width].low[c][i % width] = static_cast<float>(box[c] - origin_[c]) - slack_;
      nodes_[i / width].high[c][i % width] = static_cast<float>(box[c + dim] - origin_[c]) + slack_;
    }
  for (std::size_t level = 1; level + 1 < level_begin_.size(); ++level)
    for (std::size_t child = level_begin_[level - 1]; child < level_begin_[level]; ++child)
    {
      const std::size_t i = child - level_begin_[level - 1];
      Node &parent = nodes_[level_begin_[level] + i / width];
      for (int c = 0; c < dim; ++c)
      {
        parent.low[c][i % width] = nodes_[child].low[c].minCoeff();
        parent.high[c][i % width] = nodes_[child].high[c].maxCoeff();
      }
    }
}

template<int dim>
double BoxTree<dim>::total_extent() const
{
  double total = 0;
  for (std::size_t n = level_begin_.size() > 1 ? level_begin_[1] : 0; n-- > 0;)
    for (int c = 0; c < dim; ++c)
      total += nodes_[n].high[c].maxCoeff() - nodes_[n].low[c].minCoeff();
  return total;
}

template class BoxTree<2>;
template class BoxTree<3>;
} // namespace amontons
