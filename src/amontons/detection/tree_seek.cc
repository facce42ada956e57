#include "amontons/detection/tree_search.h"

#include <limits>

namespace amontons
{
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
    block_[place].radius = std::min(usual_radius_, block_[place].bound()); // a face known from before may be far by now
  while (n_pending > 0)
  {
    n_groups_ = 0;
    const std::span<const int> places(pending.data(), static_cast<std::size_t>(n_pending));
    for (std::size_t first = 0; first < places.size(); first += group_size)
      find_fronts(query, places.subspan(first, std::min<std::size_t>(group_size, places.size() - first)));
    guess(query);
    look_around(query);
    int n_left = 0;
    for (const int place : places)
      if (is_done(block_[place], query.w))
        finish(query, place, result[block_[place].node]);
      else
        pending[n_left++] = place;
    n_pending = n_left;
  }
  expect_alike(query, std::span(block_).first(nodes.size()));
}

// If not, sets the radius to look in next.
template<int dim>
bool TreeSearch<dim>::is_done(Sought &sought, double w) const
{
  const double bound = sought.bound();
  if (sought.n_hits == Sought::all_seen || (sought.n_hits >= 0 && bound <= sought.radius))
    return true;
  if (sought.face >= 0)
    sought.radius = bound;
  else if (sought.n_hits >= 0)
    sought.radius = std::min(2 * sought.radius, w);
  return false;
}

// Projects on the likeliest face of each node that has none yet within its radius.
template<int dim>
void TreeSearch<dim>::guess(const Query &query)
{
  for (Group &group : std::span(groups_).first(n_groups_))
  {
    bool all_known = true;
    for (int i = 0; i < group.n_places; ++i)
      if (const Sought &sought = block_[group.places[i]]; sought.face < 0 || sought.bound() > sought.radius)
      {
        const double reach = sought.radius + faces_.motion();
        tree_.set_bound(group.front, i, reach * reach);
        all_known = false;
      }
    if (all_known)
      continue;
    std::array<std::uint32_t, group_size> slots;
    tree_.likeliest(group.front, slots.data());
    for (int i = 0; i < group.n_places; ++i)
      if (slots[i] != no_slot && slots[i] != block_[group.places[i]].slot)
        add(query, group.places[i], slots[i]);
  }
  project_all();
}

// Projects on all that may be closer.
template<int dim>
void TreeSearch<dim>::look_around(const Query &query)
{
  for (Group &group : std::span(groups_).first(n_groups_))
  {
    std::array<BoxHit *, group_size> room{};
    std::array<int, group_size> n_hits;
    for (int i = 0; i < group.n_places; ++i)
    {
      Sought &sought = block_[group.places[i]];
      set_reach(query, sought);
      tree_.set_bound(group.front, i, sought.reach * sought.reach);
      room[i] = hits(group.places[i]).data();
    }
    tree_.scan(group.front, room.data(), max_hits, n_hits.data());
    for (int i = 0; i < group.n_places; ++i)
    {
      Sought &sought = block_[group.places[i]];
      sought.n_hits = n_hits[i];
      if (sought.n_hits > max_hits)
      {
        descend(query, sought);
        continue;
      }
      const double to_face = std::min(sought.bound(), sought.radius) + faces_.motion();
      const auto bound = static_cast<float>(to_face * to_face) * (1 + 1e-5F);
      const std::uint32_t known = sought.slot;
      for (int k = 0; k < n_hits[i]; ++k)
        if (room[i][k].squared_distance <= bound && room[i][k].slot != known)
          add(query, group.places[i], room[i][k].slot);
    }
  }
  project_all();
}

// How far to look about a node: as far as its closest face, and the margin beyond for the list of near ones.
template<int dim>
void TreeSearch<dim>::set_reach(const Query &query, Sought &sought) const
{
  sought.margin = sought.face < 0 || query.exclusions ? 0 : margin * shortest_edge(sought.slot);
  const double near = std::min(sought.bound(), sought.radius);
  sought.reach = std::min(near + sought.margin, sought.radius + usual_margin_) + faces_.motion();
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

// The faces within the largest of the nodes' radii and margins.
template<int dim>
void TreeSearch<dim>::find_fronts(const Query &query, std::span<const int> places)
{
  Group &group = groups_[n_groups_];
  group.n_places = 0;
  double largest = 0;
  for (const int place : places)
  {
    tree_.set_point(group.front, group.n_places, block_[place].x.data());
    group.places[group.n_places++] = place;
    largest = std::max(largest, block_[place].radius);
  }
  const double reach = largest + usual_margin_ + faces_.motion();
  if (tree_.collect(group.front, group.n_places, reach * reach))
    ++n_groups_;
  else
    find_fronts_in_a_crowd(query, places);
}

// Too many faces for all: the radius is taken for too large, then the group for too wide.
template<int dim>
void TreeSearch<dim>::find_fronts_in_a_crowd(const Query &query, std::span<const int> places)
{
  bool is_first = false;
  for (const int place : places)
    if (Sought &sought = block_[place]; sought.face < 0 && !sought.is_crowded)
    {
      sought.is_crowded = is_first = true;
      sought.radius *= 0.25;
    }
  if (is_first)
    for (const int place : places)
      block_[place].n_hits = Sought::sought_again;
  else if (places.size() == 1)
    descend(query, block_[places[0]]);
  else
  {
    const std::size_t half = widest_step(places);
    find_fronts(query, places.first(half));
    find_fronts(query, places.subspan(half));
  }
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
void TreeSearch<dim>::descend(const Query &query, Sought &sought)
{
  const auto squared_reach = [&] { return (sought.bound() + faces_.motion()) * (sought.bound() + faces_.motion()); };
  double bound = squared_reach();
  const Eigen::Vector3d x = point_of(query.x, dim, sought.node);
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
  const double radius = std::min(sought.bound() + sought.margin + faces_.motion(), sought.reach);
  const auto bound = static_cast<float>(radius * radius);
  const auto near = hits(place).first(static_cast<std::size_t>(sought.n_hits));
  const auto is_listed = [bound](const BoxHit &hit) { return hit.squared_distance <= bound; };
  if (std::count_if(near.begin(), near.end(), is_listed) > most_listed)
    return near_.forget(sought.node);
  near_.start(sought.node, sought.x.data(), radius);
  for (const BoxHit &hit : near)
    if (is_listed(hit))
      near_.add(hit.slot, hit.squared_distance);
}

template void TreeSearch<2>::seek(const Query &, std::span<const Index>, std::span<Candidate>);
template void TreeSearch<3>::seek(const Query &, std::span<const Index>, std::span<Candidate>);
} // namespace amontons
