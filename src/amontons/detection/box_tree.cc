#include "amontons/detection/box_tree.h"

#include "amontons/detection/hilbert.h"

#include <algorithm>
#include <limits>

namespace amontons
{
template<int dim>
void BoxTree<dim>::order_by(std::span<const std::array<double, static_cast<std::size_t>(dim)>> centres, Index n_faces,
                            Index run)
{
  order_.clear();
  order_.reserve(static_cast<std::size_t>(n_faces));
  for (const Index first : curve_order<dim>(centres))
    for (Index face = first * run; face < std::min((first + 1) * run, n_faces); ++face)
      order_.push_back(face);
  level_begin_.assign(1, 0);
  for (std::size_t count = order_.size(); level_begin_.size() == 1 || count > 1;)
  {
    count = (count + width - 1) / width;
    level_begin_.push_back(level_begin_.back() + count);
  }
  nodes_.resize(level_begin_.back());
  ordered_extent_ = 0;
}

// Sets the origin, and tells by how much boxes must grow to hold what is rounded to single precision about it.
template<int dim>
float BoxTree<dim>::centre_on(const Box &all)
{
  double size = 0;
  for (int c = 0; c < dim; ++c)
  {
    origin_[c] = 0.5 * (all[c] + all[c + dim]);
    size = std::max(size, all[c + dim] - all[c]);
  }
  return static_cast<float>(size * 2.4e-7);
}

// The last node of a level is the only one that may have fewer children: nothing is near the others.
template<int dim>
void BoxTree<dim>::clear_incomplete()
{
  constexpr float far = std::numeric_limits<float>::infinity();
  for (std::int32_t level = 0; level <= top_level(); ++level)
    for (int c = 0; c < dim; ++c)
    {
      BoxNode<dim> &last = nodes_[level_begin_[level + 1] - 1];
      std::fill_n(last.low[c], width, far);
      std::fill_n(last.high[c], width, -far);
    }
}

// Sets the boxes of nodes in their parents, level by level, and adds up the leaves' extents.
template<int dim>
void BoxTree<dim>::refit_parents()
{
  extent_ = 0;
  for (std::int32_t level = 0; level <= top_level(); ++level)
    for (std::size_t child = level_begin_[level]; child < level_begin_[level + 1]; ++child)
    {
      const std::size_t i = child - level_begin_[level];
      for (int c = 0; c < dim; ++c)
      {
        float low = nodes_[child].low[c][0], high = nodes_[child].high[c][0];
        for (int k = 1; k < width; ++k)
        {
          low = std::min(low, nodes_[child].low[c][k]);
          high = std::max(high, nodes_[child].high[c][k]);
        }
        if (level == 0)
          extent_ += high - low;
        if (level == top_level())
          continue;
        BoxNode<dim> &parent = nodes_[level_begin_[level + 1] + i / width];
        parent.low[c][i % width] = low;
        parent.high[c][i % width] = high;
      }
    }
  if (ordered_extent_ == 0)
    ordered_extent_ = extent_;
}

template<int dim>
typename BoxTree<dim>::FloatPoint BoxTree<dim>::relative(const double *x) const
{
  FloatPoint result;
  for (std::size_t c = 0; c < result.size(); ++c)
    result[c] = static_cast<float>(x[c] - origin_[c]);
  return result;
}

template class BoxTree<2>;
template class BoxTree<3>;
} // namespace amontons
