#include "amontons/solution/predictor.h"

#include "amontons/algebra/linear_solver_failure.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace amontons
{
namespace
{
/// Cosine between two changes of the loads from which on the second goes on with the first.
constexpr double same_direction = 0.98;
/// How much the ratios of prescribed displacements and of forces may differ, over the larger.
constexpr double same_ratio = 0.05;

struct Change
{
  bool moves = false;
  bool goes_on = true;
  double ratio = 1; ///< of the second change to the first
};

/// Squares and product of the changes from the first to the second and on to the third.
struct Products
{
  double first2 = 0, second2 = 0, product = 0;
};

void add_products(Products &out, double start, double now, double next)
{
  const double first = now - start, second = next - now;
  out.first2 += first * first;
  out.second2 += second * second;
  out.product += first * second;
}

Products nodal_products(const Sharing &nodes, int dim, std::span<const double> start, std::span<const double> now,
                        std::span<const double> next)
{
  Products out;
  for (Index node = 0; node < nodes.size(); ++node)
    if (nodes.is_own(node))
      for (Index i = node * dim; i < (node + 1) * dim; ++i)
        add_products(out, start[i], now[i], next[i]);
  std::array<double, 3> sums{out.first2, out.second2, out.product};
  nodes.sum_over_processes(sums);
  return {sums[0], sums[1], sums[2]};
}

Change compare(const Products &products)
{
  const auto &[first2, second2, product] = products;
  if (first2 == 0 && second2 == 0)
    return {};
  if (first2 == 0 || second2 == 0 || product < same_direction * std::sqrt(first2) * std::sqrt(second2))
    return {true, false, 1};
  return {true, true, product / first2};
}
} // namespace

Predictor::Loads Predictor::loads(const State &state, double time)
{
  Loads out;
  out.displacement = model_.prescribe(model_.initial_state(), time, 1).displacement;
  std::vector<double> internal(static_cast<std::size_t>(model_.n_nodal()), 0.0);
  out.force.assign(internal.size(), 0.0);
  (void)model_.bodies().forces(model_.mesh_part(state.displacement), time, model_.mesh_part(internal),
                               model_.mesh_part(out.force));
  model_.nodes().sum(out.force, model_.dim());
  out.on_rigid.assign(static_cast<std::size_t>(model_.rigid().n_unknowns()), 0.0);
  model_.rigid().add_forces(time, out.on_rigid);
  return out;
}

std::optional<double> Predictor::load_ratio(const State &now, double from, double to)
{
  const Loads start = loads(now, last_->from), middle = loads(now, from), end = loads(now, to);
  const Sharing &nodes = model_.nodes();
  const Change motion =
      compare(nodal_products(nodes, model_.dim(), start.displacement, middle.displacement, end.displacement));
  Products forces = nodal_products(nodes, model_.dim(), start.force, middle.force, end.force);
  for (std::size_t i = 0; i < start.on_rigid.size(); ++i)
    add_products(forces, start.on_rigid[i], middle.on_rigid[i], end.on_rigid[i]);
  const Change force = compare(forces);
  if (!motion.goes_on || !force.goes_on || (!motion.moves && !force.moves))
    return {};
  if (motion.moves && force.moves &&
      std::abs(motion.ratio - force.ratio) > same_ratio * std::max(motion.ratio, force.ratio))
    return {};
  return motion.moves ? motion.ratio : force.ratio;
}

std::optional<State> Predictor::guess(const State &now, double from, double to)
{
  if (!last_ || from != last_->to)
    return {};
  const std::optional<double> ratio = load_ratio(now, from, to);
  if (!ratio)
    return {};
  State out = now;
  for (std::size_t i = 0; i < out.displacement.size(); ++i)
    out.displacement[i] += *ratio * (now.displacement[i] - last_->start.displacement[i]);
  for (std::size_t i = 0; i < out.multipliers.size(); ++i)
    out.multipliers[i] += *ratio * (now.multipliers[i] - last_->start.multipliers[i]);
  for (std::size_t b = 0; b < out.rigid.size(); ++b)
  {
    const RigidState &before = last_->start.rigid[b];
    RigidState &body = out.rigid[b];
    body.translation += *ratio * (body.translation - before.translation);
    body.rotation_vector += *ratio * (body.rotation_vector - before.rotation_vector);
    Eigen::AngleAxisd turn(body.rotation * before.rotation.transpose());
    turn.angle() *= *ratio;
    body.rotation = turn * body.rotation;
  }
  return model_.prescribe(std::move(out), to, 1);
}
State Predictor::approach(const State &now, double to) const
{
  const auto dim = static_cast<std::size_t>(model_.dim());
  const Mesh &mesh = model_.mesh();
  State out = model_.prescribe(now, to, 1);
  std::vector<double> body(model_.rigid_of_node().size(), -1);
  const std::span<const Index> body_of_cell = model_.bodies().body_of_cell();
  for (std::size_t cell = 0; cell < body_of_cell.size(); ++cell)
    for (const Index node : mesh.cells[cell])
      body[node] = std::max(body[node], static_cast<double>(body_of_cell[cell]));
  model_.nodes().maximum(body);
  std::vector<double> sum(model_.options().bodies.size() * dim, 0.0), count(sum);
  for (const HeldComponent &held : model_.supports().held())
    if (const auto b = static_cast<Index>(body[held.nodal / dim]); b >= 0 && model_.nodes().is_own(held.nodal / dim))
    {
      sum[b * dim + held.nodal % dim] += out.displacement[held.nodal] - now.displacement[held.nodal];
      ++count[b * dim + held.nodal % dim];
    }
  model_.nodes().sum_over_processes(sum);
  model_.nodes().sum_over_processes(count);
  for (std::size_t node = 0; node * dim < out.displacement.size(); ++node)
    if (body[node] >= 0 && model_.rigid_of_node()[node] < 0)
      for (std::size_t i = node * dim, k = static_cast<std::size_t>(body[node]) * dim; i < (node + 1) * dim; ++i, ++k)
        out.displacement[i] = now.displacement[i] + sum[k] / std::max(count[k], 1.0);
  return out;
}

std::vector<std::pair<int, Index>> Predictor::touching(const State &now, const State &approach)
{
  std::vector<std::pair<int, Index>> out;
  const std::vector<double> before = model_.with_halo(now.displacement),
                            after = model_.with_halo(approach.displacement);
  const auto closes = [&](const ContactInterface &contact, Index i)
  { return contact.paired(i) && !contact.options().tied && contact.gap(i, before) > 0 && contact.gap(i, after) < 0; };
  agree_on_failures(model_.nodes(),
                    [&]
                    {
                      for (std::size_t c = 0; c < model_.contacts().size(); ++c)
                        for (Index i = 0; i < model_.contacts()[c].n_nodes(); ++i)
                          if (closes(model_.contacts()[c], i))
                            out.emplace_back(static_cast<int>(c), i);
                    });
  return out;
}
} // namespace amontons
