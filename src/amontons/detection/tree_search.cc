#include "amontons/detection/box_tree.h"
#include "amontons/detection/normal_cones.h"
#include "amontons/detection/search.h"

#include <algorithm>
#include <limits>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

template<int dim>
class TreeSearch : public Search
{
public:
  void fill(const Target &target, const Query &) override
  {
    cones_are_current_ = false;
    n_looked_at_ = 0;
    const Surface &surface = target.surface();
    if (tree_.order().size() != surface.face_ids.size())
      order(target);
    pack(target);
    if (tree_.is_poor())
    {
      order(target);
      pack(target);
    }
  }

  void closest(const Target &target, const Query &query, std::span<Candidate> result, Timers &timers) override
  {
    const auto time = timers.measure("nearest");
    // Nodes that follow one another are mostly close: they share the way down the tree.
    for (std::size_t first = 0; first < query.nodes.size(); first += group_size)
      closest_of_group(target, query, query.nodes.subspan(first, std::min(group_size, query.nodes.size() - first)),
                       result);
  }

  void minima(const Target &target, const Query &query, Index node, double radius,
              std::vector<Candidate> &result) override
  {
    // The cones cost as much as looking at every face once: made where that much has been spent without them.
    if (!cones_are_current_ && n_looked_at_ > tree_.order().size())
    {
      cones_.build(target, tree_.order());
      cones_are_current_ = true;
    }
    const Vector3d x = point_of(query.x, dim, node);
    const double bound = radius * radius;
    tree_.visit_within(
        as_array(x), bound, nullptr,
        [&](Index slot)
        {
          ++n_looked_at_;
          if (const Candidate candidate = candidate_in(slot, tree_.order()[slot], x);
              candidate.squared_distance <= bound && query.sees(node, candidate.face))
            result.push_back(candidate);
        },
        [&](int level, std::size_t index)
        { return !cones_are_current_ || cones_.may_hold_minimum(level, index, x, query.extension); });
  }

private:
  static constexpr std::size_t group_size = 16;

  void closest_of_group(const Target &target, const Query &query, std::span<const Index> nodes,
                        std::span<Candidate> result)
  {
    typename BoxTree<dim>::Box box;
    std::fill_n(box.begin(), dim, std::numeric_limits<double>::infinity());
    std::fill_n(box.begin() + dim, dim, -std::numeric_limits<double>::infinity());
    double largest = 0;
    for (const Index node : nodes)
    {
      const Vector3d x = point_of(query.x, dim, node);
      for (int c = 0; c < dim; ++c)
      {
        box[c] = std::min(box[c], x[c]);
        box[c + dim] = std::max(box[c + dim], x[c]);
      }
      // The face of the last detection bounds the distance.
      Candidate best{-1, {0, 0}, query.w * query.w};
      if (result[node].face >= 0)
        consider(target.surface(), query, node, candidate_on(target, result[node].face, x), best);
      result[node] = best;
      largest = std::max(largest, best.squared_distance);
    }
    const bool shared = tree_.collect(box, largest, front_);
    for (const Index node : nodes)
    {
      const Vector3d x = point_of(query.x, dim, node);
      Candidate &best = result[node];
      const Index known = best.face;
      tree_.visit_within(
          as_array(x), best.squared_distance, shared ? &front_ : nullptr,
          [&](Index slot)
          {
            if (const Index f = tree_.order()[slot]; f != known)
              consider(target.surface(), query, node, candidate_in(slot, f, x), best);
          },
          [](int, std::size_t) { return true; });
    }
  }

  static std::array<double, dim> as_array(const Vector3d &x)
  {
    std::array<double, dim> result;
    for (int c = 0; c < dim; ++c)
      result[c] = x[c];
    return result;
  }

  static void consider(const Surface &surface, const Query &query, Index node, const Candidate &candidate,
                       Candidate &best)
  {
    if (candidate.squared_distance <= best.squared_distance &&
        (best.face < 0 || comes_before(surface, candidate, best)) && query.sees(node, candidate.face))
      best = candidate;
  }

  void order(const Target &target)
  {
    std::vector<std::array<double, dim>> centres(target.surface().face_ids.size());
    for (std::size_t f = 0; f < centres.size(); ++f)
    {
      const FaceCoordinates face = target.face(static_cast<Index>(f));
      Vector3d sum = Vector3d::Zero();
      for (int k = 0; k < face.n_nodes; ++k)
        sum += face.x[k];
      centres[f] = as_array(sum / face.n_nodes);
    }
    tree_.order_by(centres);
  }

  // Copies the faces' coordinates in the order of the tree, so that faces visited one after another lie so in memory.
  void pack(const Target &target)
  {
    faces_.resize(tree_.order().size());
    boxes_.resize(faces_.size());
    for (std::size_t slot = 0; slot < faces_.size(); ++slot)
    {
      const FaceCoordinates face = target.face(tree_.order()[slot]);
      Vector3d low = face.x[0], high = face.x[0];
      for (int k = 0; k < face.n_nodes; ++k)
      {
        faces_[slot][k] = as_array(face.x[k]);
        low = low.cwiseMin(face.x[k]);
        high = high.cwiseMax(face.x[k]);
      }
      if (dim == 3 && face.n_nodes == 3)
        faces_[slot][3] = no_node;
      for (int c = 0; c < dim; ++c)
      {
        boxes_[slot][c] = low[c];
        boxes_[slot][c + dim] = high[c];
      }
    }
    tree_.refit(boxes_);
  }

  [[nodiscard]] Candidate candidate_in(Index slot, Index f, const Vector3d &x) const
  {
    FaceCoordinates face;
    face.n_nodes = dim == 2 ? 2 : faces_[slot][max_nodes - 1] == no_node ? 3 : 4;
    for (int k = 0; k < face.n_nodes; ++k)
      face.x[k] = Vector3d(faces_[slot][k][0], faces_[slot][k][1], dim == 3 ? faces_[slot][k][dim - 1] : 0.0);
    const ClosestPoint closest = closest_point(face, x);
    return {f, closest.xi, closest.squared_distance};
  }

  static constexpr int max_nodes = dim == 2 ? 2 : 4;
  static constexpr std::array<double, dim> no_node = []
  {
    std::array<double, dim> result;
    result.fill(std::numeric_limits<double>::infinity());
    return result;
  }();

  std::vector<std::array<std::array<double, dim>, max_nodes>> faces_; ///< nodes' coordinates, slot by slot
  std::vector<typename BoxTree<dim>::Box> boxes_;
  BoxTree<dim> tree_;
  typename BoxTree<dim>::Front front_;
  NormalCones cones_;
  bool cones_are_current_ = false;
  std::size_t n_looked_at_ = 0; ///< faces, in the search for minima since the last fill
};
} // namespace

std::unique_ptr<Search> make_tree_search(int dim)
{
  if (dim == 2)
    return std::make_unique<TreeSearch<2>>();
  return std::make_unique<TreeSearch<3>>();
}
} // namespace amontons
