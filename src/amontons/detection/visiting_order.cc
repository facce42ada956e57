#include "amontons/detection/visiting_order.h"

#include "amontons/detection/hilbert.h"
#include "amontons/detection/large_vector.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace amontons
{
namespace
{
// Mean step from node to node, in units of the spacing of as many nodes spread evenly, that still counts as close.
constexpr double close = 8;

template<int dim>
LargeVector<std::array<double, dim>> points_of(const Surface &surface)
{
  LargeVector<std::array<double, dim>> points(surface.node_ids.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    std::copy_n(surface.reference.data() + i * dim, dim, points[i].begin());
  return points;
}

// Whether nodes that follow one another are far apart.
template<int dim>
bool is_scattered(std::span<const std::array<double, static_cast<std::size_t>(dim)>> points)
{
  std::array<double, dim> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  double way = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    double squared_step = 0;
    for (int c = 0; c < dim; ++c)
    {
      const double x = points[i][c];
      low[c] = std::min(low[c], x);
      high[c] = std::max(high[c], x);
      if (i > 0)
        squared_step += (x - points[i - 1][c]) * (x - points[i - 1][c]);
    }
    way += std::sqrt(squared_step);
  }
  double squared_diagonal = 0;
  for (int c = 0; c < dim && !points.empty(); ++c)
    squared_diagonal += (high[c] - low[c]) * (high[c] - low[c]);
  const auto n = static_cast<double>(points.size());
  const double spacing = std::sqrt(squared_diagonal) / std::pow(n, 1.0 / (dim - 1));
  return way > close * n * spacing;
}

template<int dim>
std::vector<Index> order_of(const Surface &surface)
{
  const auto points = points_of<dim>(surface);
  return is_scattered<dim>(points) ? curve_order<dim>(points) : std::vector<Index>{};
}
} // namespace

std::vector<Index> numbering_order(const Surface &surface)
{
  return surface.dim == 2 ? order_of<2>(surface) : order_of<3>(surface);
}

std::vector<Index> visiting_order(const Surface &surface)
{
  if (surface.dim == 2 || surface.reference.size() != 3 * surface.node_ids.size())
    return {};
  return curve_order<3>(points_of<3>(surface));
}
} // namespace amontons
