#include "amontons/detection/tree_search.h"

#include <limits>

namespace amontons
{
using Eigen::Vector3d;

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

// Faces that follow one another on the surface mostly lie side by side: runs of them are sorted, not each, unless that
// makes poor leaves.
template<int dim>
void TreeSearch<dim>::order(const Target &target)
{
  const auto x = target.coordinates();
  const Index n_faces = surface_->n_faces();
  double squared_steps = 0, squared_edges = 0;
  const auto corner = [&](Index f, int k)
  {
    return Eigen::Map<const Eigen::Matrix<double, dim, 1>>(x.data() +
                                                           static_cast<std::ptrdiff_t>(surface_->face(f)[k]) * dim);
  };
  constexpr Index sample = 16;
  for (Index f = 0; f + 1 < n_faces; f += sample)
  {
    squared_steps += (corner(f + 1, 0) - corner(f, 0)).squaredNorm();
    squared_edges += (corner(f, 1) - corner(f, 0)).squaredNorm();
  }
  const Index run = squared_steps <= 4 * squared_edges ? most_in_run : 1;
  LargeVector<std::array<double, dim>> centres((static_cast<std::size_t>(n_faces) + run - 1) / run);
  for (std::size_t i = 0; i < centres.size(); ++i)
  {
    const Index first = static_cast<Index>(i) * run, last = std::min(first + run, n_faces) - 1;
    for (int c = 0; c < dim; ++c)
      centres[i][c] = 0.5 * (corner(first, 0)[c] + corner(last, dim - 1)[c]);
  }
  tree_.order_by(centres, n_faces, run);
  faces_.number(*surface_, tree_.order());
  near_.clear();
  hints_.clear();
}

template<int dim>
void TreeSearch<dim>::refit()
{
  near_.shrink(faces_.motion());
  tree_.refit(faces_.box_of_all(), [this](std::size_t slot) { return faces_.box(static_cast<std::uint32_t>(slot)); });
  faces_.mark();
}

template<int dim>
void TreeSearch<dim>::closest(const Target &, const Query &query, const Taker &take, Timers &timers)
{
  if (const std::size_t n_nodes = query.x.size() / dim; hints_.size() != n_nodes)
    hints_.assign(n_nodes, no_slot);
  const std::size_t n_blocks = query.block_begins.size() - 1;
  near_.begin(n_blocks);
  usual_radius_ = query.w;
  usual_margin_ = 0;
  for (std::size_t block = 0; block < n_blocks; ++block)
  {
    const auto nodes = block_of(query, block);
    if (nodes.empty())
    {
      near_.forget(block);
      continue;
    }
    {
      const auto time = timers.measure("nearest");
      if (block + 1 < n_blocks)
        expect(query, block + 1);
      seek(query, block, nodes);
    }
    take(nodes, std::span<const Candidate>(found_).first(nodes.size()));
  }
}

template<int dim>
std::span<const Index> TreeSearch<dim>::block_of(const Query &query, std::size_t block)
{
  return query.nodes.subspan(query.block_begins[block], query.block_begins[block + 1] - query.block_begins[block]);
}

// Fetches ahead what a block begins with.
template<int dim>
void TreeSearch<dim>::expect(const Query &query, std::size_t block) const
{
  for (const Index node : block_of(query, block))
  {
    __builtin_prefetch(query.x.data() + static_cast<std::ptrdiff_t>(node) * dim);
    __builtin_prefetch(hints_.data() + node);
  }
  for (const std::uint32_t leaf : near_.leaves(block))
    tree_.expect_leaf(leaf);
}

template<int dim>
void TreeSearch<dim>::add(const Query &query, int place, std::uint32_t slot)
{
  if (query.exclusions && !query.sees(nodes_[place], tree_.order()[slot]))
    return;
  Batch &batch = batches_[faces_.n_nodes(slot) == 4 ? 1 : 0];
  batch.pairs[batch.n_pairs++] = {place, slot};
  faces_.expect_corners(slot);
  if (batch.n_pairs == FaceBatch::capacity)
    project(batch);
}

template<int dim>
void TreeSearch<dim>::project(Batch &batch)
{
  batch.faces.clear();
  for (const auto &[place, slot] : std::span(batch.pairs).first(static_cast<std::size_t>(batch.n_pairs)))
    batch.faces.template add<dim>(faces_.corners(slot), block_[place].x.data());
  batch.faces.project_with_gaps();
  for (int i = 0; i < batch.n_pairs; ++i)
  {
    const auto [place, slot] = batch.pairs[i];
    consider(place, slot, {-1, batch.faces.xi(i), batch.faces.squared_distance(i), batch.faces.gap(i)});
  }
  batch.n_pairs = 0;
}

template<int dim>
void TreeSearch<dim>::project_all()
{
  for (Batch &batch : batches_)
    if (batch.n_pairs > 0)
      project(batch);
}

template<int dim>
void TreeSearch<dim>::consider(int place, std::uint32_t slot, const Candidate &candidate)
{
  Sought &sought = block_[place];
  Candidate &found = found_[place];
  if (sought.is_found() && (candidate.squared_distance > found.squared_distance ||
                            (candidate.squared_distance == found.squared_distance && id(slot) >= id(sought.slot))))
    return;
  sought.slot = slot;
  sought.bound = std::min(sought.bound, std::sqrt(candidate.squared_distance));
  found = candidate;
}

template<int dim>
double TreeSearch<dim>::shortest_edge(std::uint32_t slot) const
{
  const auto corners = faces_.corners(slot);
  const int n = faces_.n_nodes(slot);
  double shortest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < n; ++k)
  {
    double squared_length = 0;
    for (int c = 0; c < dim; ++c)
      squared_length += (corners[(k + 1) % n][c] - corners[k][c]) * (corners[(k + 1) % n][c] - corners[k][c]);
    shortest = std::min(shortest, squared_length);
  }
  return std::sqrt(shortest);
}

template<int dim>
void TreeSearch<dim>::minima(const Target &target, const Query &query, Index node, double radius,
                             std::vector<Candidate> &result)
{
  // The cones cost as much as looking at half of the faces: made where that much has been spent without them.
  if (!cones_are_current_ && n_looked_at_ > tree_.order().size() / 2)
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
        if (const Candidate candidate = candidate_on(faces_.face(static_cast<std::uint32_t>(slot)), face, x);
            candidate.squared_distance <= radius * radius)
          result.push_back(candidate);
      },
      [&](int level, std::size_t index) {
        return !cones_are_current_ || cones_.may_hold_minimum(level, index, x, query.extension, query.ends_anywhere);
      });
}

template class TreeSearch<2>;
template class TreeSearch<3>;

std::unique_ptr<Search> make_tree_search(int dim)
{
  if (dim == 2)
    return std::make_unique<TreeSearch<2>>();
  return std::make_unique<TreeSearch<3>>();
}
} // namespace amontons
