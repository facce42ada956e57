#include "amontons/detection/tree_search.h"

#include <bit>

namespace amontons
{
// Fills found_ for the nodes.
template<int dim>
void TreeSearch<dim>::seek(const Query &query, std::size_t block, std::span<const Index> nodes)
{
  start(query, nodes);
  region_ = near_.region(block);
  n_leaves_ = static_cast<int>(near_.leaves(block).size());
  std::copy_n(near_.leaves(block).data(), n_leaves_, leaves_.data());
  is_front_of_block_ = true;
  near_faces_.clear();
  std::array<int, block_size> pending;
  int n_pending = static_cast<int>(nodes.size());
  for (int place = 0; place < n_pending; ++place)
    pending[place] = place;
  while (n_pending > 0)
  {
    const std::span<const int> places(pending.data(), static_cast<std::size_t>(n_pending));
    seek_once(query, places);
    int n_left = 0;
    for (const int place : places)
      if (!is_done(block_[place], query.w))
        pending[n_left++] = place;
    n_pending = n_left;
  }
  if (is_front_of_block_)
    near_.keep(block, region_, std::span(leaves_).first(static_cast<std::size_t>(n_leaves_)));
  else
    near_.forget(block);
  for (std::size_t place = 0; place < nodes.size(); ++place)
  {
    const Sought &sought = block_[place];
    hints_[nodes[place]] = sought.slot;
    const bool is_within = sought.is_found() && found_[place].squared_distance <= query.w * query.w;
    found_[place].face = is_within ? tree_.order()[sought.slot] : -1;
  }
  expect_alike(query, static_cast<int>(nodes.size()));
}

// Sets the radius to look in first: a face known from before bounds it, or what the predecessors needed.
template<int dim>
void TreeSearch<dim>::start(const Query &query, std::span<const Index> nodes)
{
  nodes_ = nodes;
  const int n = static_cast<int>(nodes.size());
  for (int place = 0; place < n; ++place)
  {
    Sought &sought = block_[place];
    const double *x = query.x.data() + static_cast<std::ptrdiff_t>(nodes[place]) * dim;
    for (std::size_t c = 0; c < dim; ++c)
      sought.x[c] = x[c];
    sought.bound = query.w;
    sought.slot = no_slot;
    sought.is_crowded = sought.is_done = false;
  }
  for (int place = 0; place < n; ++place)
    if (const std::uint32_t hint = hints_[nodes[place]]; hint != no_slot)
      add(query, place, hint);
  project_all();
  for (int place = 0; place < n; ++place) // a face known from before may be far by now
    block_[place].radius = std::min(usual_radius_, block_[place].bound);
}

template<int dim>
void TreeSearch<dim>::expect(std::span<const std::uint32_t> leaves) const
{
  for (const std::uint32_t leaf : leaves)
    for (std::uint32_t i = 0; i < BoxTree<dim>::width; i += dim == 2 ? 8 : 4) // a line of memory holds as many
      faces_.expect(leaf * BoxTree<dim>::width + i);
}

// Looks for each node within its radius.
template<int dim>
void TreeSearch<dim>::seek_once(const Query &query, std::span<const int> places)
{
  const Region<dim> needed = region_of(places);
  if (!region_.covers(needed))
  {
    std::array<int, block_size> all;
    for (int place = 0; place < static_cast<int>(nodes_.size()); ++place)
      all[place] = place;
    Region<dim> block = region_of(std::span(all).first(nodes_.size()));
    block.reach = needed.reach;
    is_front_of_block_ = collect(block, usual_margin_);
  }
  if (region_.covers(needed))
    gather(needed);
  for (std::size_t first = 0; first < places.size(); first += group_size)
    seek_group(query, places.subspan(first, std::min<std::size_t>(group_size, places.size() - first)));
  project_all();
}

// The nodes and the largest of their radii.
template<int dim>
Region<dim> TreeSearch<dim>::region_of(std::span<const int> places) const
{
  Region<dim> result = Region<dim>::none();
  double radius = 0;
  for (const int place : places)
  {
    result.extend(block_[place].x);
    radius = std::max(radius, block_[place].radius);
  }
  result.reach = radius + faces_.motion();
  return result;
}

// Collects the leaves of a region. @return false if they are too many
template<int dim>
bool TreeSearch<dim>::collect(const Region<dim> &needed, double beyond)
{
  region_ = needed;
  region_.reach += beyond;
  n_leaves_ = tree_.collect(tree_.relative(region_.low.data()), tree_.relative(region_.high.data()),
                            region_.reach * region_.reach, leaves_.data(), most_leaves);
  if (n_leaves_ <= most_leaves)
  {
    expect(std::span(leaves_).first(static_cast<std::size_t>(n_leaves_)));
    return true;
  }
  region_ = Region<dim>::none();
  n_leaves_ = 0;
  return false;
}

template<int dim>
void TreeSearch<dim>::seek_group(const Query &query, std::span<const int> places)
{
  const Region<dim> needed = region_of(places);
  if (!near_faces_.hold(needed))
  {
    if (!region_.covers(needed))
    {
      is_front_of_block_ = false;
      if (!collect(needed, 0))
        return part_crowd(query, places);
    }
    if (!gather(needed))
      return part_crowd(query, places);
  }
  measure(places, needed);
  guess(query, places);
  look_around(query, places);
}

template<int dim>
bool TreeSearch<dim>::gather(const Region<dim> &needed)
{
  return near_faces_.gather(tree_, faces_, std::span(leaves_).first(static_cast<std::size_t>(n_leaves_)), needed);
}

// Holds the nodes against the faces near them. All are seen as far as the farthest of them looks.
template<int dim>
void TreeSearch<dim>::measure(std::span<const int> places, const Region<dim> &needed)
{
  bool all_known = true;
  for (const int place : places)
    all_known = all_known && block_[place].is_found() && block_[place].bound <= block_[place].radius;
  const double reach = needed.reach - faces_.motion();
  near_faces_.measure(
      static_cast<int>(places.size()), [&](int i) -> const auto & { return block_[places[i]].x; }, reach, group_,
      all_known ? nullptr : likeliest_.data());
  if (all_known)
    likeliest_.fill(no_slot);
  for (const int place : places)
    block_[place].radius = std::max(block_[place].radius, reach);
}

// Projects on the likeliest face of each node that has none yet within its radius.
template<int dim>
void TreeSearch<dim>::guess(const Query &query, std::span<const int> places)
{
  for (std::size_t i = 0; i < places.size(); ++i)
    if (const Sought &sought = block_[places[i]]; likeliest_[i] != no_slot && likeliest_[i] != sought.slot &&
                                                  (!sought.is_found() || sought.bound > sought.radius))
      add(query, places[i], likeliest_[i]);
  project_all();
}

// Projects on all that may be closer.
template<int dim>
void TreeSearch<dim>::look_around(const Query &query, std::span<const int> places)
{
  alignas(64) std::array<float, group_size> bounds;
  alignas(64) std::array<std::uint32_t, group_size> known;
  bounds.fill(-1);
  known.fill(no_slot);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const Sought &sought = block_[places[i]];
    bounds[i] = near_faces_.squared_bound(std::min(sought.bound, sought.radius));
    known[i] = sought.slot;
  }
  box_kernels<dim>().select(group_, bounds.data(), known.data(), in_reach_.data());
  for (int k = 0; k < group_.n_slots; ++k)
    for (unsigned left = in_reach_[k]; left != 0; left &= left - 1)
      add(query, places[std::countr_zero(left)], group_.slots[k]);
}

// If not, sets the radius to look in next.
template<int dim>
bool TreeSearch<dim>::is_done(Sought &sought, double w)
{
  if (sought.is_done || sought.bound <= sought.radius)
    return true;
  sought.radius = sought.is_found() ? sought.bound : std::min(2 * sought.radius, w);
  return false;
}

// What the last nodes needed the next will mostly need too.
template<int dim>
void TreeSearch<dim>::expect_alike(const Query &query, int n_nodes)
{
  double radius = 1e-3 * query.w;
  for (const Sought &sought : std::span(block_).first(static_cast<std::size_t>(n_nodes)))
    radius = std::max(radius, 1.2 * sought.bound);
  usual_radius_ = std::min(radius, query.w);
  if (const std::uint32_t slot = block_[n_nodes - 1].slot; slot != no_slot)
    usual_margin_ = margin * shortest_edge(slot);
}

// Too many faces for all: the radius is taken for too large, then the nodes for too far apart.
template<int dim>
void TreeSearch<dim>::part_crowd(const Query &query, std::span<const int> places)
{
  bool is_first = false;
  for (const int place : places)
    if (Sought &sought = block_[place]; !sought.is_found() && !sought.is_crowded)
      sought.is_crowded = is_first = true;
  if (is_first)
    for (const int place : places)
    {
      Sought &sought = block_[place];
      sought.radius *= sought.is_found() ? 1 : 0.25;
    }
  if (places.size() == 1 && !is_first)
    return descend(query, places[0]);
  if (is_first)
    return seek_group(query, places);
  const std::size_t half = widest_step(places);
  seek_group(query, places.first(half));
  seek_group(query, places.subspan(half));
}

// Where to split nodes that follow one another.
template<int dim>
std::size_t TreeSearch<dim>::widest_step(std::span<const int> places) const
{
  std::size_t result = places.size() / 2;
  double widest = 0;
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    double squared = 0;
    for (int c = 0; c < dim; ++c)
    {
      const double step = block_[places[i]].x[c] - block_[places[i - 1]].x[c];
      squared += step * step;
    }
    if (squared > widest)
    {
      widest = squared;
      result = i;
    }
  }
  return result;
}

// One by one, the nearest first: where many faces are within the radius.
template<int dim>
void TreeSearch<dim>::descend(const Query &query, int place)
{
  Sought &sought = block_[place];
  const auto squared_reach = [&] { return (sought.bound + faces_.motion()) * (sought.bound + faces_.motion()); };
  double bound = squared_reach();
  const Index node = nodes_[place];
  const Eigen::Vector3d x = point_of(query.x, dim, node);
  tree_.visit_within(
      sought.x.data(), bound,
      [&](Index slot)
      {
        if (!query.sees(node, tree_.order()[slot]))
          return;
        const auto own = static_cast<std::uint32_t>(slot);
        consider(place, own, candidate_on(faces_.face(own), -1, x));
        bound = squared_reach();
      },
      [](int, std::size_t) { return true; });
  sought.is_done = true;
}

template void TreeSearch<2>::seek(const Query &, std::size_t, std::span<const Index>);
template void TreeSearch<3>::seek(const Query &, std::size_t, std::span<const Index>);
} // namespace amontons
