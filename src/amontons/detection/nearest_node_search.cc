#include "amontons/detection/node_grid.h"
#include "amontons/detection/pair_batch.h"
#include "amontons/detection/search.h"

#include <algorithm>
#include <array>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

// The paper's rule (THEORY.md section 4, steps 3 and 4): the closest of the faces attached to the nearest target node.
class NearestNodeSearch : public Search
{
public:
  void fill(const Target &target, const Query &query) override { grid_.fill(target, query.w); }

  void closest(const Target &target, const Query &query, const Taker &take, Timers &timers) override
  {
    nearest_.resize(query.x.size() / target.surface().dim);
    found_.resize(nearest_.size());
    {
      const auto time = timers.measure("nearest");
      const NodeGrid::Node *nearby = nullptr;
      for (const Index node : query.nodes)
        nearest_[node] = nearest(target.surface(), query, node, nearby);
    }
    {
      const auto time = timers.measure("projection");
      project(target, query);
    }
    take_in_blocks(query.nodes, take);
  }

  void minima(const Target &target, const Query &query, Index node, double radius,
              std::vector<Candidate> &result) override
  {
    if (nearest_[node] < 0)
      return;
    const Vector3d x = point_of(query.x, target.surface().dim, node);
    for (const Index f : target.surface().faces_of_node(nearest_[node]))
      if (const Candidate candidate = candidate_on(target.face(f), f, x);
          candidate.squared_distance <= radius * radius && query.sees(node, f))
        result.push_back(candidate);
  }

private:
  // The target node within w, of those with a face that the impactor node sees; equally near ones go by their ids.
  // @param nearby a node that may be near, or null: the impactor nodes' neighbours follow one another mostly
  [[nodiscard]] Index nearest(const Surface &surface, const Query &query, Index node,
                              const NodeGrid::Node *&nearby) const
  {
    const Vector3d x = point_of(query.x, surface.dim, node);
    if (query.exclusions)
      return nearest_by_rule(surface, query, node, x);
    double best = query.w * query.w;
    const NodeGrid::Node *result = nullptr;
    if (nearby && (x - nearby->x).squaredNorm() <= best)
    {
      result = nearby;
      best = (x - nearby->x).squaredNorm();
    }
    bool tied = false;
    grid_.visit_near(x, best,
                     [&](std::span<const NodeGrid::Node> nodes)
                     {
                       for (const NodeGrid::Node &other : nodes) // no branch: it could not be foreseen
                       {
                         const double squared_distance = (x - other.x).squaredNorm();
                         const bool nearer = squared_distance < best;
                         tied |= squared_distance == best && &other != result;
                         best = nearer ? squared_distance : best;
                         result = nearer ? &other : result;
                       }
                     });
    nearby = result;
    if (tied)
      return nearest_by_rule(surface, query, node, x);
    return result ? result->node : -1;
  }

  [[nodiscard]] Index nearest_by_rule(const Surface &surface, const Query &query, Index node, const Vector3d &x) const
  {
    const auto sees_a_face_of = [&](Index other)
    {
      const auto faces = surface.faces_of_node(other);
      return std::any_of(faces.begin(), faces.end(), [&](Index f) { return query.sees(node, f); });
    };
    double best = query.w * query.w;
    Index result = -1;
    const auto comes_first = [&](double squared_distance, Index other)
    {
      return squared_distance < best ||
             (squared_distance == best && (result < 0 || surface.node_ids[other] < surface.node_ids[result]));
    };
    grid_.visit_near(x, best,
                     [&](std::span<const NodeGrid::Node> nodes)
                     {
                       for (const NodeGrid::Node &other : nodes)
                         if (const double squared_distance = (x - other.x).squaredNorm();
                             comes_first(squared_distance, other.node) && sees_a_face_of(other.node))
                         {
                           best = squared_distance;
                           result = other.node;
                         }
                     });
    return result;
  }

  void project(const Target &target, const Query &query)
  {
    const Surface &surface = target.surface();
    const std::span<const double> target_x = target.coordinates();
    PairBatch segments(surface, target_x, 2), triangles(surface, target_x, 3), quadrilaterals(surface, target_x, 4);
    const std::array<PairBatch *, 5> batches{nullptr, nullptr, &segments, &triangles, &quadrilaterals};
    for (const Index node : query.nodes)
    {
      found_[node].face = -1;
      if (nearest_[node] < 0)
        continue;
      const double *x = query.x.data() + static_cast<std::ptrdiff_t>(node) * surface.dim;
      for (const Index f : surface.faces_of_node(nearest_[node]))
        if (query.sees(node, f))
          batches[surface.face(f).size()]->add(node, f, x, found_);
    }
    for (PairBatch *batch : {&segments, &triangles, &quadrilaterals})
      batch->project(found_);
  }

  void take_in_blocks(std::span<const Index> nodes, const Taker &take) const
  {
    std::array<Candidate, 256> found;
    for (std::size_t first = 0; first < nodes.size(); first += found.size())
    {
      const auto block = nodes.subspan(first, std::min(found.size(), nodes.size() - first));
      for (std::size_t i = 0; i < block.size(); ++i)
        found[i] = found_[block[i]];
      take(block, std::span<const Candidate>(found).first(block.size()));
    }
  }

  NodeGrid grid_;
  std::vector<Index> nearest_; ///< target node per impactor node
  std::vector<Candidate> found_;
};
} // namespace

std::unique_ptr<Search> make_nearest_node_search()
{
  return std::make_unique<NearestNodeSearch>();
}
} // namespace amontons
