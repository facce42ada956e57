#include "amontons/solution/predictor.h"

#include "amontons/algebra/linear_solver_failure.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace amontons
{
namespace
{
/// Cosine between two changes of the loads from which on the second goes on with the first.
constexpr double same_direction = 0.98;
/// How much the ratios of prescribed displacements and of forces may differ, over the larger.
constexpr double same_ratio = 0.05;
/// Changes of loads, and motion still to come, below this part of their size are nothing, where the motion of a frame
/// was taken out of them.
constexpr double round_off = 1e-12;

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

/// @param nothing2 square of a change that counts as none
Change compare(const Products &products, double nothing2)
{
  const auto &[first2, second2, product] = products;
  if (first2 <= nothing2 && second2 <= nothing2)
    return {};
  if (first2 <= nothing2 || second2 <= nothing2 || product < same_direction * std::sqrt(first2) * std::sqrt(second2))
    return {true, false, 1};
  return {true, true, product / first2};
}
/// Of a contact's own nodes in a configuration; not a number where there is no pair.
std::vector<double> gaps(ContactInterface &contact, std::span<const double> displacement)
{
  contact.move_to(displacement);
  std::vector<double> out;
  for (Index i = 0; i < contact.n_nodes(); ++i)
    out.push_back(contact.paired(i) ? contact.gap(i, displacement) : std::numeric_limits<double>::quiet_NaN());
  return out;
}
} // namespace

Predictor::Loads Predictor::loads(const State &now, double time, const RigidMotion &carried)
{
  Loads out;
  const auto dim = static_cast<std::size_t>(model_.dim());
  out.displacement = given_.moved(model_.prescribe(model_.initial_state(), time, 1), carried).displacement;
  if (!carried.is_nil())
    for (std::size_t i = 0; i < out.displacement.size(); ++i)
      if (!given_.is_held()[i / dim])
        out.displacement[i] = 0;

  const State then = given_.moved(now, carried.inverse());
  std::vector<double> internal(static_cast<std::size_t>(model_.n_nodal()), 0.0);
  out.force.assign(internal.size(), 0.0);
  (void)model_.bodies().forces(model_.mesh_part(then.displacement), time, model_.mesh_part(internal),
                               model_.mesh_part(out.force));
  model_.nodes().sum(out.force, model_.dim());
  out.on_rigid.assign(static_cast<std::size_t>(model_.rigid().n_unknowns()), 0.0);
  model_.rigid().add_forces(time, out.on_rigid);
  turn(out, carried.rotation);
  return out;
}

void Predictor::turn(Loads &loads, const Eigen::Matrix3d &rotation) const
{
  if (rotation.isIdentity(0))
    return;
  const int dim = model_.dim();
  for (double *force = loads.force.data(); force != loads.force.data() + loads.force.size(); force += dim)
  {
    Eigen::Vector3d turned = Eigen::Vector3d::Zero();
    std::copy_n(force, dim, turned.data());
    turned = rotation * turned;
    std::copy_n(turned.data(), dim, force);
  }
  for (const RigidBody &body : model_.rigid().bodies())
    for (const auto *components : {&body.translation, &body.rotation})
    {
      Eigen::Vector3d turned = Eigen::Vector3d::Zero();
      for (int c = 0; c < 3; ++c)
        if (const Index unknown = (*components)[c].unknown; unknown >= 0)
          turned += rotation.col(c) * loads.on_rigid[unknown];
      for (int c = 0; c < 3; ++c)
        if (const Index unknown = (*components)[c].unknown; unknown >= 0)
          loads.on_rigid[unknown] = turned[c];
    }
}

std::optional<double> Predictor::load_ratio(const State &now, double from, double to)
{
  const RigidMotion still, last = given_.of_observer(last_->start, now),
                           next = given_.of_observer(now, model_.prescribe(now, to, 1));
  const Loads start = loads(now, last_->from, last), middle = loads(now, from, still),
              end = loads(now, to, next.inverse());
  const Sharing &nodes = model_.nodes();
  const int dim = model_.dim();
  const double error2 = last.is_nil() && next.is_nil() ? 0 : round_off * round_off;
  const Change motion = compare(nodal_products(nodes, dim, start.displacement, middle.displacement, end.displacement),
                                error2 * nodes.dot(model_.points(), model_.points(), dim));
  Products forces = nodal_products(nodes, dim, start.force, middle.force, end.force);
  double force2 = nodes.dot(middle.force, middle.force, dim);
  for (std::size_t i = 0; i < start.on_rigid.size(); ++i)
  {
    add_products(forces, start.on_rigid[i], middle.on_rigid[i], end.on_rigid[i]);
    force2 += std::pow(middle.on_rigid[i], 2);
  }
  const Change force = compare(forces, error2 * force2);
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
  // Seen from the bodies themselves, as they are now.
  const bool turns = !model_.small_strain();
  const State end = model_.prescribe(now, to, 1);
  const State then = turns ? given_.moved(last_->start, given_.of_bodies(last_->start, now)) : last_->start;
  State out = now;
  for (std::size_t i = 0; i < out.displacement.size(); ++i)
    out.displacement[i] += *ratio * (now.displacement[i] - then.displacement[i]);
  for (std::size_t i = 0; i < out.multipliers.size(); ++i)
    out.multipliers[i] += *ratio * (now.multipliers[i] - then.multipliers[i]);
  for (std::size_t b = 0; b < out.rigid.size(); ++b)
  {
    const RigidState &before = then.rigid[b];
    RigidState &body = out.rigid[b];
    body.translation += *ratio * (body.translation - before.translation);
    body.rotation_vector += *ratio * (body.rotation_vector - before.rotation_vector);
    Eigen::AngleAxisd turn(body.rotation * before.rotation.transpose());
    turn.angle() *= *ratio;
    body.rotation = turn * body.rotation;
  }
  if (turns)
    out = given_.moved(std::move(out), given_.of_bodies(now, end));
  return model_.prescribe(std::move(out), to, 1);
}

State Predictor::carried(const State &now, double to) const
{
  const RigidMotion motion = given_.of_observer(now, model_.prescribe(now, to, 1));
  if (motion.is_nil())
    return now;
  State out = given_.moved(now, motion);
  // What supports leave of round-off must not count as motion still to come.
  State end = model_.prescribe(out, to, 1);
  double size = 0, pending = 0;
  for (std::size_t i = 0; i < end.displacement.size(); ++i)
  {
    size = std::max({size, std::abs(model_.points()[i]), std::abs(end.displacement[i])});
    pending = std::max(pending, std::abs(end.displacement[i] - out.displacement[i]));
  }
  std::array<double, 2> largest{size, pending};
  model_.nodes().maximum_over_processes(largest);
  return largest[1] <= round_off * largest[0] ? end : out;
}

State Predictor::approach(const State &now, double to) const
{
  const auto dim = static_cast<std::size_t>(model_.dim());
  const State end = model_.prescribe(now, to, 1);
  State out = given_.moved(now, given_.of_bodies(now, end));
  out.rigid = end.rigid;
  for (std::size_t i = 0; i < out.displacement.size(); ++i)
    if (model_.rigid_of_node()[i / dim] >= 0)
      out.displacement[i] = end.displacement[i];
  return out;
}

std::vector<std::pair<int, Index>> Predictor::touching(const State &now, const State &approach)
{
  std::vector<std::pair<int, Index>> out;
  const std::vector<double> before = model_.with_halo(now.displacement),
                            after = model_.with_halo(approach.displacement);
  agree_on_failures(model_.nodes(),
                    [&]
                    {
                      for (std::size_t c = 0; c < model_.contacts().size(); ++c)
                      {
                        ContactInterface &contact = model_.contacts()[c];
                        if (contact.options().tied)
                          continue;
                        const std::vector<double> gap_before = gaps(contact, before), gap_after = gaps(contact, after);
                        for (Index i = 0; i < contact.n_nodes(); ++i)
                          if (gap_before[i] > 0 && gap_after[i] < 0)
                            out.emplace_back(static_cast<int>(c), i);
                      }
                    });
  return out;
}
} // namespace amontons
