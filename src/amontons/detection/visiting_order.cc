#include "amontons/detection/visiting_order.h"

#include "amontons/detection/hilbert.h"

#include <cmath>
#include <limits>

namespace amontons
{
namespace
{
// Mean step from node to node, in units of the spacing of as many nodes spread evenly, that still counts as close.
constexpr double close = 8;

template<int dim>
std::vector<Index> order_of(const Surface &surface)
{
  std::vector<std::array<double, dim>> points(surface.node_ids.size());
  std::array<double, dim> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  double way = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    double squared_step = 0;
    for (int c = 0; c < dim; ++c)
    {
      const double x = points[i][c] = surface.reference[i * dim + c];
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
  if (way > close * n * spacing)
    return curve_order<dim>(points);
  return {};
}
} // namespace

std::vector<Index> visiting_order(const Surface &surface)
{
  return surface.dim == 2 ? order_of<2>(surface) : order_of<3>(surface);
}
} // namespace amontons
