#pragma once
#include "amontons/base/timer.h"
#include "amontons/detection/closest_feature.h"
#include "amontons/detection/self_contact_exclusions.h"
#include "amontons/detection/target.h"
#include "amontons/surface/face_batch.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace amontons
{
/// The impactor nodes to look for.
struct Query
{
  static constexpr int block_size = FaceBatch::capacity;

  std::span<const double> x;    ///< all nodes, [n_nodes * dim]
  std::span<const Index> nodes; ///< the nodes inside the target's box grown by w
  /// Where in `nodes` those of each block begin, and the end: of blocks of block_size successive nodes of all, the same
  /// in every detection whichever of them are inside.
  std::span<const std::uint32_t> block_begins;
  double w = 0;
  std::optional<double> extension; ///< past the target's ends, where the user gave it
  bool ends_anywhere = false; ///< self-contact: what a node sees may end at any edge, not at the target's ends alone
  const Exclusions *exclusions = nullptr; ///< self-contact: the faces that a node does not see; null: it sees all

  [[nodiscard]] bool sees(Index node, Index face) const { return Sight{exclusions, node}.sees(face); }
};

/// Finds closest faces: what the detection methods differ in. Buffers stay between calls.
class Search
{
public:
  virtual ~Search() = default;

  /// Takes in where the target is now.
  virtual void fill(const Target &target, const Query &query) = 0;

  /// What becomes of the faces that are found: called with some nodes and, for each, the closest.
  using Taker = std::function<void(std::span<const Index>, std::span<const Candidate>)>;

  /// For each node of the query the face it sees with the closest point within w, face -1 without; equal distances go
  /// to the smaller face id.
  /// @param take called for all of the query's nodes in their order, some at a time; may call minima()
  /// @param timers the phases "nearest" and, where it is a step of its own, "projection"; not the time that `take`
  /// takes
  virtual void closest(const Target &target, const Query &query, const Taker &take, Timers &timers) = 0;

  /// Appends the faces within `radius` of a node, with their closest points, that may be local minima of the distance
  /// (they need not be), of those that the method considers.
  virtual void minima(const Target &target, const Query &query, Index node, double radius,
                      std::vector<Candidate> &result) = 0;
};

std::unique_ptr<Search> make_brute_search();
std::unique_ptr<Search> make_tree_search(int dim);
std::unique_ptr<Search> make_nearest_node_search();

/// The face's closest point as a candidate.
inline Candidate candidate_on(const FaceCoordinates &coordinates, Index face, const Eigen::Vector3d &x)
{
  const ClosestPoint closest = closest_point(coordinates, x);
  return {face, closest.xi, closest.squared_distance, gap_at(coordinates, closest.xi, x)};
}

/// The order of candidates: distance, then the faces' ids. True if a comes before b.
inline bool comes_before(const Surface &surface, const Candidate &a, const Candidate &b)
{
  return a.squared_distance < b.squared_distance ||
         (a.squared_distance == b.squared_distance && surface.face_ids[a.face] < surface.face_ids[b.face]);
}

inline Eigen::Vector3d point_of(std::span<const double> x, int dim, Index node)
{
  const double *p = x.data() + static_cast<std::ptrdiff_t>(node) * dim;
  return {p[0], p[1], dim == 3 ? p[2] : 0.0};
}
} // namespace amontons
