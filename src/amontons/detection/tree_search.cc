#include "amontons/detection/box_tree.h"
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
    const Surface &surface = target.surface();
    boxes_.resize(surface.face_ids.size());
    for (Index f = 0; f < surface.n_faces(); ++f)
    {
      auto &box = boxes_[f];
      for (int c = 0; c < dim; ++c)
      {
        box[c] = std::numeric_limits<double>::infinity();
        box[c + dim] = -box[c];
      }
      for (const Index node : surface.face(f))
        for (int c = 0; c < dim; ++c)
        {
          const double x = target.coordinates()[static_cast<std::size_t>(node) * dim + c];
          box[c] = std::min(box[c], x);
          box[c + dim] = std::max(box[c + dim], x);
        }
    }
    tree_.fill(boxes_);
  }

  void closest(const Target &target, const Query &query, std::span<Candidate> result, Timers &timers) override
  {
    const auto time = timers.measure("nearest");
    const Surface &surface = target.surface();
    Index last = -1; // nodes that follow one another are often close
    for (const Index node : query.nodes)
    {
      const Vector3d x = point_of(query.x, dim, node);
      Candidate best{-1, {0, 0}, query.w * query.w};
      const Index hint = result[node].face >= 0 ? result[node].face : last;
      if (hint >= 0)
        consider(target, surface, hint, x, best);
      tree_.visit_within(as_array(x), best.squared_distance,
                         [&](Index f)
                         {
                           if (f != hint)
                             consider(target, surface, f, x, best);
                         });
      result[node] = best;
      if (best.face >= 0)
        last = best.face;
    }
  }

  void within(const Target &target, const Query &query, Index node, std::vector<Candidate> &result) override
  {
    const Vector3d x = point_of(query.x, dim, node);
    const double bound = query.w * query.w;
    tree_.visit_within(as_array(x), bound,
                       [&](Index f)
                       {
                         if (const Candidate candidate = candidate_on(target, f, x);
                             candidate.squared_distance <= bound)
                           result.push_back(candidate);
                       });
  }

private:
  static std::array<double, dim> as_array(const Vector3d &x)
  {
    std::array<double, dim> result;
    for (int c = 0; c < dim; ++c)
      result[c] = x[c];
    return result;
  }

  static void consider(const Target &target, const Surface &surface, Index f, const Vector3d &x, Candidate &best)
  {
    const Candidate candidate = candidate_on(target, f, x);
    if (candidate.squared_distance <= best.squared_distance &&
        (best.face < 0 || comes_before(surface, candidate, best)))
      best = candidate;
  }

  std::vector<typename BoxTree<dim>::Box> boxes_;
  BoxTree<dim> tree_;
};

} // namespace

std::unique_ptr<Search> make_tree_search(int dim)
{
  if (dim == 2)
    return std::make_unique<TreeSearch<2>>();
  return std::make_unique<TreeSearch<3>>();
}
} // namespace amontons
