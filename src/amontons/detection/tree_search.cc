#include "amontons/detection/box_tree.h"
#include "amontons/detection/near_faces.h"
#include "amontons/detection/normal_cones.h"
#include "amontons/detection/search.h"
#include "amontons/detection/sorted_faces.h"
#include "amontons/surface/face_batch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

// Of a node's boxes the one that probably holds its closest face.
std::uint32_t likeliest(std::span<const BoxHit> hits)
{
  return std::min_element(hits.begin(), hits.end(), [](const BoxHit &a, const BoxHit &b) { return a.score < b.score; })
      ->slot;
}

/// Nodes are taken in blocks, so that many projections are made at once. Each node is sought within a radius, first
/// that of a face known to be near or what its predecessors needed: where nothing is found in it, it grows up to w.
template<int dim>
class TreeSearch : public Search
{
public:
  void fill(const Target &target, const Query &query) override;
  void closest(const Target &target, const Query &query, std::span<Candidate> result, Timers &timers) override;
  void minima(const Target &target, const Query &query, Index node, double radius,
              std::vector<Candidate> &result) override;

private:
  static constexpr int block_size = FaceBatch::capacity, group_size = 16, max_hits = 128;
  static constexpr int most_listed = 24; ///< near faces kept for a node
  static constexpr std::uint32_t no_slot = ~0U;
  // What faces are listed beyond the closest one, in units of its shorter edge.
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
    double margin = 0; ///< beyond the closest face
    int n_hits = 0;    ///< in hits_; or one of the following
    int n_crowded = 0; ///< how often there were too many boxes within the radius
    static constexpr int all_seen = -1, sought_again = -2;
    [[nodiscard]] double bound() const { return face < 0 ? w : std::min(w, std::sqrt(squared_distance)); }
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
  void expect_alike(const Query &query, std::span<const Sought> block);
  void find_boxes(const Query &query, std::span<const int> places);
  void find_boxes_in_a_crowd(const Query &query, std::span<const int> places);
  void descend(const Query &query, Sought &sought);
  void finish(const Query &query, int place, Candidate &result);
  void add(const Query &query, int place, std::uint32_t slot);
  void project(Batch &batch);
  void project_all();
  void consider(Sought &sought, std::uint32_t slot, LocalPoint xi, double squared_distance);
  [[nodiscard]] double shorter_edge(std::uint32_t slot) const;
  [[nodiscard]] std::span<BoxHit> hits(int place) { return {hits_.data() + place * max_hits, max_hits}; }

  BoxTree<dim> tree_;
  SortedFaces<dim> faces_;
  NearFaces<dim> near_;
  const Surface *surface_ = nullptr;
  double usual_radius_ = 0, usual_margin_ = 0; ///< of the last block
  // Of the block being sought.
  std::array<Sought, block_size> block_;
  std::vector<BoxHit> hits_ = std::vector<BoxHit>(block_size * max_hits);
  std::array<Batch, 2> batches_{Batch{FaceBatch(dim == 2 ? 2 : 3), {}}, Batch{FaceBatch(4), {}}};
  typename BoxTree<dim>::Front front_;
  std::vector<Index> unproven_;

  NormalCones cones_;
  bool cones_are_current_ = false;
  std::size_t n_looked_at_ = 0; ///< faces, in the search for minima since the last fill
};

template<int dim>
void TreeSearch<dim>::fill(const Target &target, const Query &)
{
  surface_ = &target.surface();
  cones_are_current_ = false;
  n_looked_at_ = 0;
  if (tree_.order().size() != surface_->face_ids.size())
    order(target);
  faces_.move_to(target.coordinates());
  // The boxes stay as they are while the target has moved little: they are taken for larger by its motion.
  if (faces_.motion() > 0.1 * tree_.mean_extent())
    refit();
  if (tree_.is_poor())
  {
    order(target);
    faces_.move_to(target.coordinates());
    refit();
  }
}

template<int dim>
void TreeSearch<dim>::order(const Target &target)
{
  const auto x = target.coordinates();
  std::vector<std::array<double, dim>> centres(surface_->face_ids.size());
  for (std::size_t f = 0; f < centres.size(); ++f)
  {
    const auto nodes = surface_->face(static_cast<Index>(f));
    const double share = 1.0 / static_cast<double>(nodes.size());
    for (const Index node : nodes)
      for (int c = 0; c < dim; ++c)
        centres[f][c] += share * x[static_cast<std::size_t>(node) * dim + c];
  }
  tree_.order_by(centres);
  faces_.number(*surface_, tree_.order());
  near_ = {};
}

template<int dim>
void TreeSearch<dim>::refit()
{
  tree_.refit(faces_.box_of_all(), [this](std::size_t slot) { return faces_.box(static_cast<std::uint32_t>(slot)); });
  faces_.mark();
  near_.expire();
}

template<int dim>
void TreeSearch<dim>::closest(const Target &, const Query &query, std::span<Candidate> result, Timers &timers)
{
  const auto time = timers.measure("nearest");
  near_.resize(result.size());
  usual_radius_ = query.w;
  usual_margin_ = 0;
  unproven_.clear();
  for (std::size_t first = 0; first < query.nodes.size(); first += block_size)
    verify(query, query.nodes.subspan(first, std::min<std::size_t>(block_size, query.nodes.size() - first)), result);
  for (std::size_t first = 0; first < unproven_.size(); first += block_size)
    seek(query, std::span(unproven_).subspan(first, std::min<std::size_t>(block_size, unproven_.size() - first)),
         result);
}

// Takes the closest of the faces known to be near, where that is proven to be the closest of all.
template<int dim>
void TreeSearch<dim>::verify(const Query &query, std::span<const Index> nodes, std::span<Candidate> result)
{
  start(query, nodes);
  const int n = static_cast<int>(nodes.size());
  std::array<double, block_size> motion;
  for (int place = 0; place < n; ++place)
  {
    Sought &sought = block_[place];
    motion[place] = near_.motion(sought.node, sought.x.data(), faces_.motion());
    const double clearance = near_.clearance(sought.node, motion[place]);
    if (near_.faces(sought.node).empty() ? !(clearance > query.w) : clearance < 0)
      sought.n_hits = Sought::all_seen; // not to be proven
    else if (!near_.faces(sought.node).empty())
      add(query, place, static_cast<std::uint32_t>(near_.hint(sought.node)));
  }
  project_all();
  for (int place = 0; place < n; ++place)
  {
    Sought &sought = block_[place];
    const double bound = sought.bound();
    if (sought.n_hits < 0 || !(bound < near_.clearance(sought.node, motion[place])))
      sought.n_hits = Sought::all_seen;
    else
      for (const auto &[slot, lower] : near_.faces(sought.node))
        if (slot != sought.slot && lower - motion[place] <= bound)
          add(query, place, slot);
  }
  project_all();
  for (int place = 0; place < n; ++place)
  {
    const Sought &sought = block_[place];
    if (sought.face >= 0)
      near_.set_hint(sought.node, sought.slot);
    if (sought.n_hits < 0)
      unproven_.push_back(sought.node);
    else
      result[sought.node] = {sought.bound() < query.w || sought.squared_distance <= query.w * query.w ? sought.face
                                                                                                      : -1,
                             sought.xi, sought.squared_distance};
  }
}

template<int dim>
void TreeSearch<dim>::start(const Query &query, std::span<const Index> nodes)
{
  for (std::size_t place = 0; place < nodes.size(); ++place)
  {
    Sought &sought = block_[place] = Sought{};
    sought.node = nodes[place];
    sought.w = query.w;
    for (int c = 0; c < dim; ++c)
      sought.x[c] = query.x[static_cast<std::size_t>(sought.node) * dim + c];
  }
}

template<int dim>
void TreeSearch<dim>::seek(const Query &query, std::span<const Index> nodes, std::span<Candidate> result)
{
  start(query, nodes);
  std::array<int, block_size> pending;
  int n_pending = static_cast<int>(nodes.size());
  for (int place = 0; place < n_pending; ++place)
  {
    pending[place] = place;
    if (const std::int64_t hint = near_.hint(nodes[place]); hint >= 0)
      add(query, place, static_cast<std::uint32_t>(hint));
  }
  project_all();
  for (int place = 0; place < n_pending; ++place)
    block_[place].radius = block_[place].face < 0 ? std::min(usual_radius_, query.w) : block_[place].bound();
  while (n_pending > 0)
  {
    const std::span<const int> places(pending.data(), static_cast<std::size_t>(n_pending));
    for (std::size_t first = 0; first < places.size(); first += group_size)
      find_boxes(query, places.subspan(first, std::min<std::size_t>(group_size, places.size() - first)));
    for (const int place : places)
      if (const Sought &sought = block_[place]; sought.n_hits > 0 && sought.face < 0)
        add(query, place, likeliest(hits(place).first(sought.n_hits)));
    project_all();
    for (const int place : places)
    {
      const Sought &sought = block_[place];
      const double reach = std::min(sought.bound(), sought.radius) + faces_.motion();
      const auto bound = static_cast<float>(reach * reach) * (1 + 1e-5F);
      for (int i = 0; i < sought.n_hits; ++i)
        if (const BoxHit &hit = hits(place)[i]; hit.squared_distance <= bound && hit.slot != sought.slot)
          add(query, place, hit.slot);
    }
    project_all();
    int n_left = 0;
    for (const int place : places)
    {
      Sought &sought = block_[place];
      const double bound = sought.bound();
      if (sought.n_hits == Sought::all_seen || (sought.n_hits >= 0 && bound <= sought.radius))
      {
        sought.margin = sought.face < 0 ? usual_margin_ : margin * shorter_edge(sought.slot);
        finish(query, place, result[sought.node]);
        continue;
      }
      if (sought.face >= 0)
        sought.radius = bound;
      else if (sought.n_hits >= 0)
        sought.radius = std::min(2 * sought.radius, query.w);
      pending[n_left++] = place;
    }
    n_pending = n_left;
  }
  expect_alike(query, std::span(block_).first(nodes.size()));
}

// What the last nodes needed the next will mostly need too.
template<int dim>
void TreeSearch<dim>::expect_alike(const Query &query, std::span<const Sought> block)
{
  double radius = 1e-3 * query.w;
  usual_margin_ = 0;
  for (const Sought &sought : block.last(std::min<std::size_t>(group_size, block.size())))
  {
    radius = std::max(radius, 1.25 * sought.bound());
    usual_margin_ = std::max(usual_margin_, sought.margin);
  }
  usual_radius_ = std::min(radius, query.w);
}

// The boxes within each node's radius and margin, by way of the leaves within the largest of these.
template<int dim>
void TreeSearch<dim>::find_boxes(const Query &query, std::span<const int> places)
{
  typename BoxTree<dim>::Box box;
  std::fill_n(box.begin(), dim, std::numeric_limits<double>::infinity());
  std::fill_n(box.begin() + dim, dim, -std::numeric_limits<double>::infinity());
  double largest = 0;
  for (const int place : places)
  {
    const Sought &sought = block_[place];
    for (int c = 0; c < dim; ++c)
    {
      box[c] = std::min(box[c], sought.x[c]);
      box[c + dim] = std::max(box[c + dim], sought.x[c]);
    }
    largest = std::max(largest, sought.radius);
  }
  const double margins = usual_margin_ + faces_.motion();
  if (!tree_.collect(box, (largest + margins) * (largest + margins), front_))
    return find_boxes_in_a_crowd(query, places);
  for (const int place : places)
  {
    Sought &sought = block_[place];
    const double reach = sought.radius + margins;
    sought.n_hits = tree_.scan(front_, sought.x.data(), reach * reach, hits(place));
    if (sought.n_hits <= max_hits)
      for (int i = 0; i < sought.n_hits; ++i)
        faces_.prefetch(hits(place)[i].slot);
    else if (sought.face < 0 && sought.n_crowded < 2)
    {
      // The likeliest tells how far to look.
      add(query, place, likeliest(hits(place)));
      sought.n_crowded = 2;
      sought.n_hits = Sought::sought_again;
    }
    else
      descend(query, sought);
  }
}

// Too many leaves for all: the radius is taken for too large, then the group for too wide.
template<int dim>
void TreeSearch<dim>::find_boxes_in_a_crowd(const Query &query, std::span<const int> places)
{
  const bool is_first =
      std::all_of(places.begin(), places.end(),
                  [this](int place) { return block_[place].n_crowded == 0 && block_[place].face < 0; });
  if (is_first)
    for (const int place : places)
    {
      Sought &sought = block_[place];
      sought.n_crowded = 1;
      sought.radius *= 0.25;
      sought.n_hits = Sought::sought_again;
    }
  else if (places.size() == 1)
    descend(query, block_[places[0]]);
  else
  {
    find_boxes(query, places.first(places.size() / 2));
    find_boxes(query, places.subspan(places.size() / 2));
  }
}

// One by one, the nearest first: where many faces are within the radius.
template<int dim>
void TreeSearch<dim>::descend(const Query &query, Sought &sought)
{
  const auto squared_reach = [&] { return (sought.bound() + faces_.motion()) * (sought.bound() + faces_.motion()); };
  double bound = squared_reach();
  const Vector3d x = point_of(query.x, dim, sought.node);
  tree_.visit_within(
      sought.x.data(), bound,
      [&](Index slot)
      {
        if (!query.sees(sought.node, tree_.order()[slot]))
          return;
        const ClosestPoint closest = closest_point(faces_.face(static_cast<std::uint32_t>(slot)), x);
        consider(sought, static_cast<std::uint32_t>(slot), closest.xi, closest.squared_distance);
        bound = squared_reach();
      },
      [](int, std::size_t) { return true; });
  sought.n_hits = Sought::all_seen;
}

template<int dim>
void TreeSearch<dim>::finish(const Query &query, int place, Candidate &result)
{
  const Sought &sought = block_[place];
  const bool found = sought.face >= 0 && sought.squared_distance <= query.w * query.w;
  result = {found ? sought.face : -1, sought.xi, sought.squared_distance};
  near_.set_hint(sought.node, sought.face >= 0 ? static_cast<std::int64_t>(sought.slot) : -1);
  if (sought.n_hits < 0 || query.exclusions)
    return near_.forget(sought.node);
  const double radius = std::min(sought.bound() + sought.margin, sought.radius + usual_margin_) + faces_.motion();
  const auto bound = static_cast<float>(radius * radius);
  const auto near = hits(place).first(sought.n_hits);
  const auto is_listed = [bound](const BoxHit &hit) { return hit.squared_distance <= bound; };
  if (std::count_if(near.begin(), near.end(), is_listed) > most_listed)
    return near_.forget(sought.node);
  near_.start(sought.node, sought.x.data(), radius);
  for (const BoxHit &hit : near)
    if (is_listed(hit))
      near_.add(hit.slot, hit.squared_distance);
}

template<int dim>
void TreeSearch<dim>::add(const Query &query, int place, std::uint32_t slot)
{
  if (query.exclusions && !query.sees(block_[place].node, tree_.order()[slot]))
    return;
  Batch &batch = batches_[faces_.n_nodes(slot) == 4 ? 1 : 0];
  batch.pairs[batch.faces.template add<dim>(faces_.corners(slot), block_[place].x.data())] = {place, slot};
  if (batch.faces.full())
    project(batch);
}

template<int dim>
void TreeSearch<dim>::project(Batch &batch)
{
  batch.faces.project();
  for (int i = 0; i < batch.faces.size(); ++i)
    consider(block_[batch.pairs[i].place], batch.pairs[i].slot, batch.faces.xi(i), batch.faces.squared_distance(i));
  batch.faces.clear();
}

template<int dim>
void TreeSearch<dim>::project_all()
{
  for (Batch &batch : batches_)
    if (batch.faces.size() > 0)
      project(batch);
}

template<int dim>
void TreeSearch<dim>::consider(Sought &sought, std::uint32_t slot, LocalPoint xi, double squared_distance)
{
  const Index face = tree_.order()[slot];
  if (sought.face >= 0 &&
      (squared_distance > sought.squared_distance ||
       (squared_distance == sought.squared_distance && surface_->face_ids[face] >= surface_->face_ids[sought.face])))
    return;
  sought.slot = slot;
  sought.face = face;
  sought.xi = xi;
  sought.squared_distance = squared_distance;
}

template<int dim>
double TreeSearch<dim>::shorter_edge(std::uint32_t slot) const
{
  const auto corners = faces_.corners(slot);
  const int last = dim == 2 ? 1 : faces_.n_nodes(slot) - 1;
  double first_edge = 0, last_edge = 0;
  for (int c = 0; c < dim; ++c)
  {
    first_edge += (corners[1][c] - corners[0][c]) * (corners[1][c] - corners[0][c]);
    last_edge += (corners[last][c] - corners[0][c]) * (corners[last][c] - corners[0][c]);
  }
  return std::sqrt(std::min(first_edge, last_edge));
}

template<int dim>
void TreeSearch<dim>::minima(const Target &target, const Query &query, Index node, double radius,
                             std::vector<Candidate> &result)
{
  // The cones cost as much as looking at every face once: made where that much has been spent without them.
  if (!cones_are_current_ && n_looked_at_ > tree_.order().size())
  {
    cones_.build(target, tree_.order());
    cones_are_current_ = true;
  }
  const Vector3d x = point_of(query.x, dim, node);
  const double bound = (radius + faces_.motion()) * (radius + faces_.motion());
  tree_.visit_within(
      x.data(), bound,
      [&](Index slot)
      {
        ++n_looked_at_;
        const Index face = tree_.order()[slot];
        if (!query.sees(node, face))
          return;
        const ClosestPoint closest = closest_point(faces_.face(static_cast<std::uint32_t>(slot)), x);
        if (closest.squared_distance <= radius * radius)
          result.push_back({face, closest.xi, closest.squared_distance});
      },
      [&](int level, std::size_t index)
      { return !cones_are_current_ || cones_.may_hold_minimum(level, index, x, query.extension); });
}
} // namespace

std::unique_ptr<Search> make_tree_search(int dim)
{
  if (dim == 2)
    return std::make_unique<TreeSearch<2>>();
  return std::make_unique<TreeSearch<3>>();
}
} // namespace amontons
