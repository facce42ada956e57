#include "amontons/detection/sorted_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace amontons
{
template<int dim>
void SortedFaces<dim>::number(const Surface &surface, const std::vector<Index> &order)
{
  max_nodes_ = 2;
  for (Index f = 0; f < surface.n_faces(); ++f)
    max_nodes_ = std::max(max_nodes_, static_cast<int>(surface.face(f).size()));
  nodes_.assign(order.size() * max_nodes_, -1);
  original_.clear();
  std::vector<Index> number(surface.node_ids.size(), -1);
  for (std::size_t slot = 0; slot < order.size(); ++slot)
  {
    Index *nodes = nodes_.data() + slot * max_nodes_;
    for (const Index node : surface.face(order[slot]))
    {
      if (number[node] < 0)
      {
        number[node] = static_cast<Index>(original_.size());
        original_.push_back(node);
      }
      *nodes++ = number[node];
    }
  }
  marked_.clear();
}

template<int dim>
void SortedFaces<dim>::move_to(std::span<const double> x)
{
  x_.resize(original_.size() * dim);
  std::fill_n(all_.begin(), dim, std::numeric_limits<double>::infinity());
  std::fill_n(all_.begin() + dim, dim, -std::numeric_limits<double>::infinity());
  const bool is_marked = marked_.size() == x_.size();
  double squared_motion = 0;
  for (std::size_t i = 0; i < original_.size(); ++i)
  {
    const double *from = x.data() + static_cast<std::ptrdiff_t>(original_[i]) * dim;
    double *to = x_.data() + i * dim;
    double squared = 0;
    for (int c = 0; c < dim; ++c)
    {
      to[c] = from[c];
      all_[c] = std::min(all_[c], from[c]);
      all_[c + dim] = std::max(all_[c + dim], from[c]);
      if (is_marked)
        squared += (from[c] - marked_[i * dim + c]) * (from[c] - marked_[i * dim + c]);
    }
    squared_motion = std::max(squared_motion, squared);
  }
  motion_ = is_marked ? std::sqrt(squared_motion) : std::numeric_limits<double>::infinity();
}

template<int dim>
FaceCoordinates SortedFaces<dim>::face(std::uint32_t slot) const
{
  FaceCoordinates result;
  result.n_nodes = n_nodes(slot);
  const auto from = corners(slot);
  for (int k = 0; k < result.n_nodes; ++k)
    result.x[k] = Eigen::Vector3d(from[k][0], from[k][1], dim == 3 ? from[k][dim - 1] : 0.0);
  return result;
}

template<int dim>
typename SortedFaces<dim>::Box SortedFaces<dim>::box(std::uint32_t slot) const
{
  const auto from = corners(slot);
  Box result;
  for (int c = 0; c < dim; ++c)
  {
    double low = from[0][c], high = low;
    for (int k = 1; k < (dim == 2 ? 2 : 4); ++k)
    {
      low = std::min(low, from[k][c]);
      high = std::max(high, from[k][c]);
    }
    result[c] = low;
    result[c + dim] = high;
  }
  return result;
}

template class SortedFaces<2>;
template class SortedFaces<3>;
} // namespace amontons
