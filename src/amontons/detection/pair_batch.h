#pragma once
#include "amontons/detection/search.h"
#include "amontons/surface/face_batch.h"

#include <array>
#include <span>

namespace amontons
{
/// Node-face pairs whose closest points are found many at a time, of faces with the same number of nodes.
class PairBatch
{
public:
  /// @param x current coordinates of the surface's nodes @param n_nodes of each face
  PairBatch(const Surface &surface, std::span<const double> x, int n_nodes)
    : surface_(surface)
    , x_(x)
    , batch_(n_nodes)
  {
  }

  /// Looks at the face for the node, in due course: what comes before result[node] (or -1 there) replaces it.
  /// @param x of the node, [dim] @param result [n_nodes], the same in all calls until project()
  void add(Index node, Index face, const double *x, std::span<Candidate> result)
  {
    std::array<const double *, 4> corners{};
    const auto nodes = surface_.face(face);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      corners[k] = x_.data() + static_cast<std::ptrdiff_t>(nodes[k]) * surface_.dim;
    const int place = surface_.dim == 2 ? batch_.add<2>(corners, x) : batch_.add<3>(corners, x);
    pairs_[place] = {node, face};
    if (batch_.full())
      project(result);
  }

  /// Looks at the pairs that still wait.
  void project(std::span<Candidate> result)
  {
    batch_.project_with_gaps();
    for (int i = 0; i < batch_.size(); ++i)
    {
      const auto [node, face] = pairs_[i];
      const Candidate candidate{face, batch_.xi(i), batch_.squared_distance(i), batch_.gap(i)};
      if (result[node].face < 0 || comes_before(surface_, candidate, result[node]))
        result[node] = candidate;
    }
    batch_.clear();
  }

private:
  struct NodeAndFace
  {
    Index node, face;
  };
  const Surface &surface_;
  std::span<const double> x_;
  FaceBatch batch_;
  std::array<NodeAndFace, FaceBatch::capacity> pairs_{};
};
} // namespace amontons
