#include "amontons/detection/sorted_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace amontons
{
template<int dim>
void SortedFaces<dim>::number(const Surface &surface, std::span<const Index> order)
{
  nodes_.clear();
  nodes_.reserve(order.size());
  for (const Index f : order)
  {
    Nodes &nodes = nodes_.emplace_back();
    nodes.fill(no_node);
    const auto own = surface.face(f);
    std::copy(own.begin(), own.end(), nodes.begin());
  }
  marked_.clear();
}

template<int dim>
void SortedFaces<dim>::move_to(std::span<const double> x)
{
  x_ = x.data();
  n_coordinates_ = x.size();
  std::array<double, dim> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  const bool is_marked = marked_.size() == x.size();
  double squared_motion = 0;
  for (std::size_t i = 0; i < n_coordinates_; i += dim)
  {
    double squared = 0;
    for (int c = 0; c < dim; ++c)
    {
      low[c] = x_[i + c] < low[c] ? x_[i + c] : low[c];
      high[c] = x_[i + c] > high[c] ? x_[i + c] : high[c];
      if (is_marked)
        squared += (x_[i + c] - marked_[i + c]) * (x_[i + c] - marked_[i + c]);
    }
    squared_motion = std::max(squared_motion, squared);
  }
  std::copy(low.begin(), low.end(), all_.begin());
  std::copy(high.begin(), high.end(), all_.begin() + dim);
  motion_ = is_marked ? std::sqrt(squared_motion) : std::numeric_limits<double>::infinity();
}

template<int dim>
void SortedFaces<dim>::mark()
{
  marked_.assign(x_, x_ + n_coordinates_);
  motion_ = 0;
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

template class SortedFaces<2>;
template class SortedFaces<3>;
} // namespace amontons
