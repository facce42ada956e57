#pragma once
#include "amontons/detection/box_tree.h"
#include "amontons/detection/near_faces.h"
#include "amontons/detection/normal_cones.h"
#include "amontons/detection/search.h"
#include "amontons/detection/sorted_faces.h"
#include "amontons/surface/face_batch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace amontons
{
/// Search in a tree of boxes. Nodes are taken in blocks, so that many projections are made at once. Each node is sought
/// within a radius, first that of a face known to be near or what its predecessors needed: where nothing is found in
/// it, it grows up to w.
template<int dim>
class TreeSearch : public Search
{
public:
  void fill(const Target &target, const Query &query) override;
  void closest(const Target &target, const Query &query, std::span<Candidate> result, Timers &timers) override;
  void minima(const Target &target, const Query &query, Index node, double radius,
              std::vector<Candidate> &result) override;

private:
  static constexpr int block_size = FaceBatch::capacity, max_hits = 64;
  static constexpr int group_size = BoxFront<dim>::most_points;
  static constexpr Index most_in_run = 4;
  static constexpr int most_listed = 24; ///< near faces kept for a node
  // What faces are listed beyond the closest one, in units of its shortest edge.
  static constexpr double margin = 0.25;

  /// A node being sought.
  struct Sought
  {
    Index node = -1;
    std::array<double, dim> x;
    double radius = 0; ///< faces within it have been or are looked at
    double w = 0;
    std::uint32_t slot = no_slot; ///< closest so far
    Index face = -1;
    LocalPoint xi{0, 0};
    double squared_distance = 0;
    double margin = 0;       ///< beyond the closest face
    double reach = 0;        ///< of the hits
    int n_hits = 0;          ///< or one of the following
    bool is_crowded = false; ///< there were too many boxes within the radius
    static constexpr int all_seen = -1, sought_again = -2;
    [[nodiscard]] double bound() const { return face < 0 ? w : std::min(w, std::sqrt(squared_distance)); }
  };
  /// Nodes that are looked for together.
  struct Group
  {
    std::array<int, group_size> places; ///< in block_
    int n_places = 0;
    BoxFront<dim> front;
  };
  struct PendingPair
  {
    int place; ///< in block_
    std::uint32_t slot;
  };
  struct Batch
  {
    FaceBatch faces;
    std::array<PendingPair, FaceBatch::capacity> pairs;
  };

  void order(const Target &target);
  void refit();
  void verify(const Query &query, std::span<const Index> nodes, std::span<Candidate> result);
  void seek(const Query &query, std::span<const Index> nodes, std::span<Candidate> result);
  void start(const Query &query, std::span<const Index> nodes);
  [[nodiscard]] std::span<BoxHit> hits(int place) { return std::span(hits_).subspan(place * max_hits, max_hits); }
  void find_fronts(const Query &query, std::span<const int> places);
  void find_fronts_in_a_crowd(const Query &query, std::span<const int> places);
  [[nodiscard]] std::size_t widest_step(std::span<const int> places) const;
  void guess(const Query &query);
  void look_around(const Query &query);
  void set_reach(const Query &query, Sought &sought) const;
  [[nodiscard]] bool is_done(Sought &sought, double w) const;
  void expect_alike(const Query &query, std::span<const Sought> block);
  void descend(const Query &query, Sought &sought);
  void finish(const Query &query, int place, Candidate &result);
  void add(const Query &query, int place, std::uint32_t slot);
  void project(Batch &batch);
  void project_all();
  void consider(Sought &sought, std::uint32_t slot, LocalPoint xi, double squared_distance);
  [[nodiscard]] double shortest_edge(std::uint32_t slot) const;

  BoxTree<dim> tree_;
  SortedFaces<dim> faces_;
  NearFaces<dim> near_;
  const Surface *surface_ = nullptr;
  double usual_radius_ = 0, usual_margin_ = 0; ///< of the last block
  // Of the block being sought.
  std::array<Sought, block_size> block_;
  std::vector<BoxHit> hits_ = std::vector<BoxHit>(block_size * max_hits);
  std::array<Batch, 2> batches_{Batch{FaceBatch(dim == 2 ? 2 : 3), {}}, Batch{FaceBatch(4), {}}};
  std::vector<Group> groups_ = std::vector<Group>(block_size);
  int n_groups_ = 0;
  std::vector<Index> unproven_;

  NormalCones cones_;
  bool cones_are_current_ = false;
  std::size_t n_looked_at_ = 0; ///< faces, in the search for minima since the last fill
};
} // namespace amontons
