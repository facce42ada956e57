#include "amontons/detection/search.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

// The paper's grid: cells of at least 2w about the target's nodes, counted and sorted by cell (THEORY.md section 4,
// steps 1 to 3; Yastrebov, Cailletaud, Feyel 2011).
class NearestNodeSearch : public Search
{
public:
  void fill(const Target &target, const Query &query) override;
  void closest(const Target &target, const Query &query, std::span<Candidate> result, Timers &timers) override;
  void minima(const Target &target, const Query &query, Index node, double radius,
              std::vector<Candidate> &result) override;

private:
  struct SortedNode
  {
    Vector3d x;
    Index node;
  };

  void size_cells(const Target &target, const Query &query);
  [[nodiscard]] double cell_position(const Vector3d &x, int axis) const { return (x[axis] - low_[axis]) / cell_[axis]; }
  [[nodiscard]] Index cell_of(const Vector3d &x) const;
  [[nodiscard]] Index nearest(const Query &query, Index node, const Surface &surface) const;

  int dim_ = 2;
  Vector3d low_, cell_;
  std::array<Index, 3> n_cells_{1, 1, 1};
  std::vector<Index> cell_begin_;  ///< [product of n_cells + 1]
  std::vector<SortedNode> sorted_; ///< target nodes, cell by cell
  std::vector<Index> cells_, order_, next_;
  std::vector<Index> nearest_; ///< target node per impactor node
};

void NearestNodeSearch::size_cells(const Target &target, const Query &query)
{
  dim_ = target.surface().dim;
  Vector3d high = Vector3d::Constant(-INFINITY);
  low_ = Vector3d::Constant(INFINITY);
  for (Index i = 0; i < target.surface().n_nodes(); ++i)
  {
    low_ = low_.cwiseMin(target.node(i));
    high = high.cwiseMax(target.node(i));
  }
  low_.array() -= query.w;
  high.array() += query.w;
  // Never more cells than a few per node: a surface that folds through a large box would leave most of them empty.
  const double most = 64.0 + 4.0 * (target.surface().n_nodes() + static_cast<double>(query.nodes.size()));
  double size = 2 * query.w, product = 0;
  std::array<double, 3> counts{1, 1, 1};
  while (true)
  {
    product = 1;
    for (int c = 0; c < dim_; ++c)
    {
      counts[c] = std::max(std::floor((high[c] - low_[c]) / size), 1.0);
      product *= counts[c];
    }
    if (product <= most)
      break;
    size *= 1.26;
  }
  for (int c = 0; c < 3; ++c)
  {
    n_cells_[c] = static_cast<Index>(counts[c]);
    cell_[c] = (high[c] - low_[c]) / counts[c];
  }
}

Index NearestNodeSearch::cell_of(const Vector3d &x) const
{
  Index cell = 0;
  for (int c = 0; c < dim_; ++c)
    cell = cell * n_cells_[c] + std::clamp(static_cast<Index>(cell_position(x, c)), 0, n_cells_[c] - 1);
  return cell;
}

void NearestNodeSearch::fill(const Target &target, const Query &query)
{
  size_cells(target, query);
  const auto n_cells = static_cast<std::size_t>(n_cells_[0]) * n_cells_[1] * n_cells_[2];
  const Index n_nodes = target.surface().n_nodes();
  cell_begin_.assign(n_cells + 1, 0);
  cells_.resize(n_nodes);
  sorted_.resize(n_nodes);
  for (Index i = 0; i < n_nodes; ++i)
    ++cell_begin_[(cells_[i] = cell_of(target.node(i))) + 1];
  for (std::size_t cell = 0; cell < n_cells; ++cell)
    cell_begin_[cell + 1] += cell_begin_[cell];
  next_.assign(cell_begin_.begin(), cell_begin_.end() - 1);
  for (Index i = 0; i < n_nodes; ++i)
    sorted_[next_[cells_[i]]++] = {target.node(i), i};

  // Impactor nodes too, so that those of one cell are treated together.
  cells_.resize(query.nodes.size());
  order_.resize(query.nodes.size());
  next_.assign(n_cells + 1, 0);
  for (std::size_t i = 0; i < query.nodes.size(); ++i)
    ++next_[(cells_[i] = cell_of(point_of(query.x, dim_, query.nodes[i]))) + 1];
  for (std::size_t cell = 0; cell < n_cells; ++cell)
    next_[cell + 1] += next_[cell];
  for (std::size_t i = 0; i < query.nodes.size(); ++i)
    order_[next_[cells_[i]]++] = query.nodes[i];
}

// Among the node's own cell and those on its side of it: its ball of radius w reaches no others.
Index NearestNodeSearch::nearest(const Query &query, Index node, const Surface &surface) const
{
  const Vector3d x = point_of(query.x, dim_, node);
  const auto sees_a_face_of = [&](Index other)
  {
    const auto faces = surface.faces_of_node(other);
    return std::any_of(faces.begin(), faces.end(), [&](Index f) { return query.sees(node, f); });
  };
  std::array<Index, 3> first{0, 0, 0}, last{0, 0, 0};
  for (int c = 0; c < dim_; ++c)
  {
    const double position = cell_position(x, c);
    const Index cell = std::clamp(static_cast<Index>(position), 0, n_cells_[c] - 1);
    const bool lower_half = position - cell < 0.5;
    first[c] = std::max(lower_half ? cell - 1 : cell, 0);
    last[c] = std::min(lower_half ? cell : cell + 1, n_cells_[c] - 1);
  }
  double best = query.w * query.w;
  Index result = -1;
  for (Index i = first[0]; i <= last[0]; ++i)
    for (Index j = first[1]; j <= last[1]; ++j)
      for (Index k = first[2]; k <= last[2]; ++k)
      {
        const Index cell = dim_ == 2 ? i * n_cells_[1] + j : (i * n_cells_[1] + j) * n_cells_[2] + k;
        for (Index s = cell_begin_[cell]; s < cell_begin_[cell + 1]; ++s)
        {
          const double squared_distance = (x - sorted_[s].x).squaredNorm();
          if (squared_distance > best)
            continue;
          if (result >= 0 && squared_distance == best && surface.node_ids[sorted_[s].node] > surface.node_ids[result])
            continue;
          if (query.exclusions && !sees_a_face_of(sorted_[s].node))
            continue;
          result = sorted_[s].node;
          best = squared_distance;
        }
      }
  return result;
}

void NearestNodeSearch::closest(const Target &target, const Query &query, std::span<Candidate> result, Timers &timers)
{
  const Surface &surface = target.surface();
  nearest_.resize(result.size());
  {
    const auto time = timers.measure("nearest");
    for (const Index node : order_)
      nearest_[node] = nearest(query, node, surface);
  }
  const auto time = timers.measure("projection");
  for (const Index node : order_)
  {
    result[node].face = -1;
    if (nearest_[node] < 0)
      continue;
    const Vector3d x = point_of(query.x, dim_, node);
    for (const Index f : surface.faces_of_node(nearest_[node]))
      if (const Candidate candidate = candidate_on(target, f, x);
          (result[node].face < 0 || comes_before(surface, candidate, result[node])) && query.sees(node, f))
        result[node] = candidate;
  }
}

void NearestNodeSearch::minima(const Target &target, const Query &query, Index node, double radius,
                               std::vector<Candidate> &result)
{
  if (nearest_[node] < 0)
    return;
  const Vector3d x = point_of(query.x, dim_, node);
  for (const Index f : target.surface().faces_of_node(nearest_[node]))
    if (const Candidate candidate = candidate_on(target, f, x);
        candidate.squared_distance <= radius * radius && query.sees(node, f))
      result.push_back(candidate);
}
} // namespace

std::unique_ptr<Search> make_nearest_node_search()
{
  return std::make_unique<NearestNodeSearch>();
}
} // namespace amontons
