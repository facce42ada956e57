#include "amontons/detection/search.h"

namespace amontons
{
namespace
{
class BruteSearch : public Search
{
public:
  void fill(const Target &target, const Query &) override
  {
    faces_.resize(target.surface().face_ids.size());
    for (Index f = 0; f < target.surface().n_faces(); ++f)
      faces_[f] = target.face(f);
  }

  void closest(const Target &target, const Query &query, const Taker &take, Timers &timers) override
  {
    std::vector<Candidate> found;
    found.reserve(query.nodes.size());
    {
      const auto time = timers.measure("nearest");
      for (const Index node : query.nodes)
        found.push_back(closest(target.surface(), query, node));
    }
    take(query.nodes, found);
  }

  void minima(const Target &target, const Query &query, Index node, double radius,
              std::vector<Candidate> &result) override
  {
    const Eigen::Vector3d x = point_of(query.x, target.surface().dim, node);
    for (Index f = 0; f < target.surface().n_faces(); ++f)
      if (Candidate candidate = on(f, x); candidate.squared_distance <= radius * radius && query.sees(node, f))
      {
        candidate.gap = gap_at(faces_[f], candidate.xi, x);
        result.push_back(candidate);
      }
  }

private:
  [[nodiscard]] Candidate closest(const Surface &surface, const Query &query, Index node) const
  {
    const Eigen::Vector3d x = point_of(query.x, surface.dim, node);
    Candidate best{-1, {0, 0}, query.w * query.w};
    for (Index f = 0; f < surface.n_faces(); ++f)
    {
      const Candidate candidate = on(f, x);
      if (candidate.squared_distance <= best.squared_distance &&
          (best.face < 0 || comes_before(surface, candidate, best)) && query.sees(node, f))
        best = candidate;
    }
    if (best.face >= 0)
      best.gap = gap_at(faces_[best.face], best.xi, x);
    return best;
  }

  // Without the gap.
  [[nodiscard]] Candidate on(Index f, const Eigen::Vector3d &x) const
  {
    const ClosestPoint closest = closest_point(faces_[f], x);
    return {f, closest.xi, closest.squared_distance};
  }

  std::vector<FaceCoordinates> faces_;
};
} // namespace

std::unique_ptr<Search> make_brute_search()
{
  return std::make_unique<BruteSearch>();
}
} // namespace amontons
