#include "amontons/base/disjoint_sets.h"
#include "amontons/solution/free_motions.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

/// FreeMotions: which nodes hang together, over all processes.
namespace amontons
{
/// A number of a node, the greater the lower its position in the whole.
double FreeMotions::name_of(Index node) const
{
  return static_cast<double>(model_.mesh().n_global_nodes + model_.rigid().n_extra_nodes() - model_.node_id(node));
}

/// What hangs together on this process, by a node for each, and the body of every node that can move, or -1.
void FreeMotions::join_nodes(std::vector<int> &parent, std::vector<int> &body_of_node) const
{
  const Mesh &mesh = model_.mesh();
  const auto body_of_cell = model_.bodies().body_of_cell();
  for (Index cell = 0; cell < mesh.cells.size(); ++cell)
  {
    const int body = body_of_cell[cell];
    if (body < 0 || model_.options().bodies[body].material.law == MaterialLaw::rigid)
      continue;
    for (const Index node : mesh.cells[cell])
    {
      parent[find_root(parent, node)] = find_root(parent, mesh.cells[cell][0]);
      body_of_node[node] = std::max(body_of_node[node], body);
    }
  }
  for (const RigidBody &body : model_.rigid().bodies())
  {
    const auto is_free = [](const RigidComponent &c) { return c.kind == RigidComponent::Kind::free; };
    if (std::none_of(body.translation.begin(), body.translation.end(), is_free) &&
        std::none_of(body.rotation.begin(), body.rotation.end(), is_free))
      continue;
    for (const Index node : body.nodes)
    {
      parent[find_root(parent, node)] = find_root(parent, body.nodes[0]);
      body_of_node[node] = body.option;
    }
  }
}

/// The lowest number of a node in the part that each node hangs together with, over all processes, counted from the
/// end of all numbers; -1 for nodes that cannot move. [n_nodes]
std::vector<double> FreeMotions::names_of_parts(std::vector<int> &parent, const std::vector<double> &body) const
{
  std::vector<double> label(parent.size(), -1), of_root(parent.size(), -1);
  for (std::size_t node = 0; node < label.size(); ++node)
    if (body[node] >= 0)
      label[node] = name_of(static_cast<Index>(node));
  for (bool changed = true; changed;)
  {
    model_.nodes().maximum(label);
    changed = false;
    for (std::size_t node = 0; node < label.size(); ++node)
      if (double &greatest = of_root[find_root(parent, static_cast<int>(node))]; label[node] > greatest)
      {
        greatest = label[node];
        changed = true;
      }
    for (std::size_t node = 0; node < label.size(); ++node)
      if (label[node] >= 0)
        label[node] = of_root[find_root(parent, static_cast<int>(node))];
    changed = !model_.nodes().true_on_all(!changed);
  }
  return label;
}

void FreeMotions::find_parts()
{
  const auto n = model_.rigid_of_node().size();
  std::vector<int> parent(n), own_body(n, -1);
  std::iota(parent.begin(), parent.end(), 0);
  join_nodes(parent, own_body);
  std::vector<double> body(own_body.begin(), own_body.end());
  model_.nodes().maximum(body);
  const std::vector<double> label = names_of_parts(parent, body);

  // The node that gives its number to a part tells all processes of it.
  std::vector<std::pair<double, double>> parts;
  for (std::size_t node = 0; node < n; ++node)
    if (label[node] >= 0 && model_.nodes().is_own(static_cast<Index>(node)) &&
        label[node] == name_of(static_cast<Index>(node)))
      parts.emplace_back(label[node], body[node]);
  gather_parts(parts);
  std::sort(parts.begin(), parts.end(), std::greater<>());
  part_of_node_.assign(n, -1);
  constexpr double none = -std::numeric_limits<double>::infinity();
  for (std::size_t node = 0; node < n; ++node)
    if (label[node] >= 0)
      part_of_node_[node] = static_cast<int>(
          std::lower_bound(parts.begin(), parts.end(), std::pair{label[node], -none}, std::greater<>()) -
          parts.begin());
  for (const auto &[name, body_of_part] : parts)
    body_of_part_.push_back(static_cast<int>(body_of_part));
  center_ = centres({});
  find_sizes();
}

template<class Add>
void FreeMotions::over_own_nodes(Add &&add) const
{
  for (Index node = 0; node < model_.n_state_nodes(); ++node)
    if (const int part = part_of_node_[node];
        part >= 0 && model_.nodes().is_own(node) &&
        model_.rigid_of_node()[node] == model_.rigid().of_option(body_of_part_[part]))
      add(part, node);
}

std::vector<Eigen::Vector3d> FreeMotions::centres(Displacement displacement) const
{
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(4, static_cast<Eigen::Index>(body_of_part_.size()));
  over_own_nodes(
      [&](int part, Index node)
      {
        sums.col(part).head<3>() += place(displacement, node);
        sums(3, part) += 1;
      });
  model_.nodes().sum_over_processes({sums.data(), static_cast<std::size_t>(sums.size())});
  std::vector<Eigen::Vector3d> out;
  for (Eigen::Index part = 0; part < sums.cols(); ++part)
    out.emplace_back(sums.col(part).head<3>() / std::max(sums(3, part), 1.0));
  return out;
}

/// Of parts whose nodes fill a box evenly, its diagonal.
void FreeMotions::find_sizes()
{
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(2, static_cast<Eigen::Index>(body_of_part_.size()));
  over_own_nodes([&](int part, Index node)
                 { sums.col(part) += Eigen::Vector2d((model_.reference(node) - center_[part]).squaredNorm(), 1); });
  model_.nodes().sum_over_processes({sums.data(), static_cast<std::size_t>(sums.size())});
  for (Eigen::Index part = 0; part < sums.cols(); ++part)
    size_.push_back(std::max(std::sqrt(12 * sums(0, part) / std::max(sums(1, part), 1.0)), 1e-300));
}

/// Those of all processes.
void FreeMotions::gather_parts(std::vector<std::pair<double, double>> &parts) const
{
  const Sharing &nodes = model_.nodes();
  std::vector<double> counts(static_cast<std::size_t>(nodes.n_processes()), 0.0);
  counts[nodes.rank()] = static_cast<double>(parts.size());
  nodes.sum_over_processes(counts);
  const auto before = static_cast<std::size_t>(std::accumulate(counts.begin(), counts.begin() + nodes.rank(), 0.0));
  std::vector<double> all(2 * static_cast<std::size_t>(std::accumulate(counts.begin(), counts.end(), 0.0)), 0.0);
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    all[2 * (before + p)] = parts[p].first;
    all[2 * (before + p) + 1] = parts[p].second;
  }
  nodes.sum_over_processes(all);
  parts.clear();
  for (std::size_t k = 0; k < all.size(); k += 2)
    parts.emplace_back(all[k], all[k + 1]);
}
} // namespace amontons
