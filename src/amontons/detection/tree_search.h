#pragma once
#include "amontons/detection/box_tree.h"
#include "amontons/detection/near_faces.h"
#include "amontons/detection/near_leaves.h"
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
/// Search in a tree of boxes. Nodes are taken in blocks: the leaves near a block are found once, or known from the last
/// search; the faces in them are gathered, and sixteen nodes at a time are held against these; the projections that are
/// left to do are put together. Each node is sought within a radius, that of a face known to be near or what its
/// predecessors needed: where nothing is found in it, it grows up to w.
template<int dim>
class TreeSearch : public Search
{
public:
  void fill(const Target &target, const Query &query) override;
  void closest(const Target &target, const Query &query, const Taker &take, Timers &timers) override;
  void minima(const Target &target, const Query &query, Index node, double radius,
              std::vector<Candidate> &result) override;

private:
  static constexpr int block_size = Query::block_size, most_leaves = 256;
  static constexpr int group_size = PointGroup<dim>::most_points;
  static constexpr Index most_in_run = 4;
  // How much farther than needed leaves are collected, so that the next search needs no others, in edges of a face.
  static constexpr double margin = 0.3;

  /// A node being sought; what is known of its closest face stands in found_.
  struct Sought
  {
    std::array<double, dim> x;
    double radius = 0;            ///< faces within it have been or are looked at
    double bound = 0;             ///< nothing farther is asked for: the distance of the closest so far, or w
    std::uint32_t slot = no_slot; ///< closest so far
    bool is_crowded = false;      ///< there were too many boxes within the radius
    bool is_done = false;
    [[nodiscard]] bool is_found() const { return slot != no_slot; }
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
    int n_pairs = 0;
  };

  void order(const Target &target);
  void refit();
  void seek(const Query &query, std::size_t block, std::span<const Index> nodes);
  [[nodiscard]] static std::span<const Index> block_of(const Query &query, std::size_t block);
  void expect(const Query &query, std::size_t block) const;
  void start(const Query &query, std::span<const Index> nodes);
  void expect(std::span<const std::uint32_t> leaves) const;
  void seek_once(const Query &query, std::span<const int> places);
  [[nodiscard]] Region<dim> region_of(std::span<const int> places) const;
  bool collect(const Region<dim> &needed, double beyond);
  void seek_group(const Query &query, std::span<const int> places);
  void measure(std::span<const int> places, const Region<dim> &needed);
  bool gather(const Region<dim> &needed);
  void part_crowd(const Query &query, std::span<const int> places);
  [[nodiscard]] std::size_t widest_step(std::span<const int> places) const;
  void guess(const Query &query, std::span<const int> places);
  void look_around(const Query &query, std::span<const int> places);
  [[nodiscard]] static bool is_done(Sought &sought, double w);
  void expect_alike(const Query &query, int n_nodes);
  void descend(const Query &query, int place);
  void add(const Query &query, int place, std::uint32_t slot);
  void project(Batch &batch);
  void project_all();
  void consider(int place, std::uint32_t slot, const Candidate &candidate);
  [[nodiscard]] GlobalIndex id(std::uint32_t slot) const { return surface_->face_ids[tree_.order()[slot]]; }
  [[nodiscard]] double shortest_edge(std::uint32_t slot) const;

  BoxTree<dim> tree_;
  SortedFaces<dim> faces_;
  NearLeaves<dim> near_;
  LargeVector<std::uint32_t> hints_; ///< per impactor node the slot of the face that was closest; no_slot: none
  const Surface *surface_ = nullptr;
  double usual_radius_ = 0, usual_margin_ = 0; ///< of the last block
  // Of the block being sought.
  std::span<const Index> nodes_;
  std::array<Sought, block_size> block_;
  std::array<Candidate, block_size> found_;
  Region<dim> region_ = Region<dim>::none(); ///< in which the leaves have been collected
  std::array<std::uint32_t, most_leaves> leaves_;
  int n_leaves_ = 0;
  NearFaces<dim> near_faces_;
  bool is_front_of_block_ = false; ///< the region is about all of the block
  PointGroup<dim> group_;
  std::array<std::uint32_t, group_size> likeliest_;
  std::array<std::uint16_t, PointGroup<dim>::capacity> in_reach_;
  std::array<Batch, 2> batches_{Batch{FaceBatch(dim == 2 ? 2 : 3), {}}, Batch{FaceBatch(4), {}}};

  NormalCones cones_;
  bool cones_are_current_ = false;
  std::size_t n_looked_at_ = 0; ///< faces, in the search for minima since the last fill
};
} // namespace amontons
