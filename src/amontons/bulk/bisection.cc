#include "amontons/bulk/bisection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

namespace amontons
{
namespace
{
using Place = std::array<double, 3>;

/// A cut may be off the share wanted by this much over the number of layers of parts.
constexpr double greatest_slack = 0.25;
/// A body's least extent over its greatest, so that flat ones have a volume.
constexpr double thinnest = 1e-3;

/// Mean of each cell's nodes.
std::vector<Place> centres(const Mesh &mesh, const std::vector<Index> &cells)
{
  std::vector<Place> out(cells.size(), Place{});
  for (std::size_t k = 0; k < cells.size(); ++k)
    for (const Index node : mesh.cells[cells[k]])
      for (int c = 0; c < mesh.dim; ++c)
        out[k][c] += mesh.points[static_cast<std::size_t>(node) * mesh.dim + c] /
                     static_cast<double>(mesh.cells[cells[k]].size());
  return out;
}

class Bisection
{
public:
  Bisection(std::vector<Place> places, int dim)
    : places_(std::move(places))
    , dim_(dim)
    , part_(places_.size())
  {
  }

  std::vector<Index> divide(Index n)
  {
    std::vector<Index> order(places_.size());
    std::iota(order.begin(), order.end(), 0);
    divide(order, n, 0);
    return std::move(part_);
  }

private:
  /// Parts first, ..., first + n - 1 for these cells.
  void divide(std::span<Index> order, Index n, Index first)
  {
    if (n == 1 || order.size() < 2)
    {
      for (const Index k : order)
        part_[k] = first;
      return;
    }
    const Place side = extents(order);
    const auto axis = static_cast<int>(std::max_element(side.begin(), side.end()) - side.begin());
    std::sort(order.begin(), order.end(),
              [&](Index a, Index b) { return std::tie(places_[a][axis], a) < std::tie(places_[b][axis], b); });
    const Index n_low = parts_below(side, side[axis], n);
    const std::size_t cut = widest_gap(order, axis, n_low, n);
    divide(order.first(cut), n_low, first);
    divide(order.subspan(cut), n - n_low, first + n_low);
  }

  [[nodiscard]] Place extents(std::span<const Index> order) const
  {
    Place side{};
    for (int c = 0; c < dim_; ++c)
    {
      const auto [least, most] = std::minmax_element(order.begin(), order.end(),
                                                     [&](Index a, Index b) { return places_[a][c] < places_[b][c]; });
      side[c] = places_[*most][c] - places_[*least][c];
    }
    return side;
  }

  /// Parts below a cut across the longest side: whole layers of cubes, where n cubes fill the box.
  [[nodiscard]] Index parts_below(const Place &side, double longest, Index n) const
  {
    double volume = 1;
    for (int c = 0; c < dim_; ++c)
      volume *= std::max(side[c] / longest, thinnest);
    const auto n_layers = std::max<Index>(2, std::lround(std::pow(n / volume, 1.0 / dim_)));
    return std::clamp<Index>(std::lround(static_cast<double>(n) * (n_layers / 2) / n_layers), 1, n - 1);
  }

  /// Number of cells below the widest gap near the share n_low / n, gaps farther away counting less.
  [[nodiscard]] std::size_t widest_gap(std::span<const Index> order, int axis, Index n_low, Index n) const
  {
    const auto size = static_cast<double>(order.size());
    const double middle = size * n_low / n, slack = size * greatest_slack / std::max(2.0, std::pow(n, 1.0 / dim_));
    const auto wanted = std::clamp<std::size_t>(std::lround(middle), 1, order.size() - 1);
    std::size_t best = wanted;
    double most = -1;
    for (std::size_t k = 1; k < order.size(); ++k)
    {
      const double off = std::abs(static_cast<double>(k) - middle) / slack;
      const double gap = (places_[order[k]][axis] - places_[order[k - 1]][axis]) * (1 - 0.5 * off);
      if (off <= 1 && gap > most)
      {
        most = gap;
        best = k;
      }
    }
    return best;
  }

  std::vector<Place> places_;
  int dim_;
  std::vector<Index> part_;
};
} // namespace

std::vector<Index> bisect_cells(const Mesh &mesh, const std::vector<Index> &cells, Index n)
{
  return Bisection(centres(mesh, cells), mesh.dim).divide(n);
}
} // namespace amontons
