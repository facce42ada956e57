#include "amontons/detection/tree_search.h"

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
  std::vector<std::array<double, dim>> centres((static_cast<std::size_t>(n_faces) + run - 1) / run);
  for (std::size_t i = 0; i < centres.size(); ++i)
  {
    const Index first = static_cast<Index>(i) * run, last = std::min(first + run, n_faces) - 1;
    for (int c = 0; c < dim; ++c)
      centres[i][c] = 0.5 * (corner(first, 0)[c] + corner(last, dim - 1)[c]);
  }
  tree_.order_by(centres, n_faces, run);
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
  const auto in_blocks = [&](std::span<const Index> nodes, auto look)
  {
    for (std::size_t first = 0; first < nodes.size(); first += block_size)
      (this->*look)(query, nodes.subspan(first, std::min<std::size_t>(block_size, nodes.size() - first)), result);
  };
  if (!near_.knows_faces())
    return in_blocks(query.nodes, &TreeSearch::seek);
  in_blocks(query.nodes, &TreeSearch::verify);
  in_blocks(unproven_, &TreeSearch::seek);
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
    {
      const auto reach = static_cast<float>((bound + motion[place]) * (bound + motion[place])) * (1 + 1e-5F);
      const std::uint32_t known = sought.slot;
      for (const auto &[slot, squared_distance] : near_.faces(sought.node))
        if (slot != known && squared_distance <= reach)
          add(query, place, slot);
    }
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
double TreeSearch<dim>::shortest_edge(std::uint32_t slot) const
{
  const auto corners = faces_.corners(slot);
  const auto squared_length = [&](int i, int j)
  {
    double result = 0;
    for (int c = 0; c < dim; ++c)
      result += (corners[j][c] - corners[i][c]) * (corners[j][c] - corners[i][c]);
    return result;
  };
  double shortest = squared_length(0, 1);
  if constexpr (dim == 3)
  {
    shortest = std::min(shortest, squared_length(1, 2)); // a quadrilateral's other two are much like these
    if (faces_.n_nodes(slot) == 3)
      shortest = std::min(shortest, squared_length(2, 0));
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
        const ClosestPoint closest = closest_point(faces_.face(static_cast<std::uint32_t>(slot)), x);
        if (closest.squared_distance <= radius * radius)
          result.push_back({face, closest.xi, closest.squared_distance});
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
