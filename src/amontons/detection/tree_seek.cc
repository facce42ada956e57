#include "amontons/detection/tree_search.h"

#include <limits>

namespace amontons
{
namespace
{
// Of a node's boxes the one that probably holds its closest face.
std::uint32_t likeliest(std::span<const BoxHit> hits)
{
  return std::min_element(hits.begin(), hits.end(), [](const BoxHit &a, const BoxHit &b) { return a.score < b.score; })
      ->slot;
}
} // namespace

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
    look_closer(query, places);
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

// Projects on the likeliest face of each node, then on all that may be closer.
template<int dim>
void TreeSearch<dim>::look_closer(const Query &query, std::span<const int> places)
{
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

template void TreeSearch<2>::seek(const Query &, std::span<const Index>, std::span<Candidate>);
template void TreeSearch<3>::seek(const Query &, std::span<const Index>, std::span<Candidate>);
} // namespace amontons
