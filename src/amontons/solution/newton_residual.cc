#include "amontons/base/hash.h"
#include "amontons/solution/newton_iterate.h"
#include "amontons/solution/start.h"

#include <array>

namespace amontons
{
namespace
{
/// Of the internal forces, over what the displacement would meet if nodes moved alone.
constexpr double round_off = 1e-13;

/// Forces that a displacement meets at the nodes' own stiffness: round-off in the internal forces is a part of them.
/// @param stiffness nodal, see diagonal_stiffness()
double resisted_force(const Model &model, std::span<const double> stiffness, std::span<const double> displacement)
{
  double sum = 0;
  for (std::size_t i = 0; i < displacement.size(); ++i)
    if (model.nodes().is_own(static_cast<Index>(i) / model.dim()))
      sum += std::pow(stiffness[i] * displacement[i], 2);
  model.nodes().sum_over_processes({&sum, 1});
  return std::sqrt(sum);
}

/// Identifies a set of statuses and faces, of all processes.
std::uint64_t signature(std::span<const ContactStatus> statuses, const Model &model)
{
  Hash hash;
  hash.add(statuses);
  for (const ContactInterface &contact : model.contacts())
    for (const Pair &pair : contact.pairing())
      hash.add(pair.face);
  // Sums of halves are whole numbers that a double holds.
  const std::uint64_t own = hash.value();
  std::array<double, 2> halves{static_cast<double>(own >> 32), static_cast<double>(own & 0xFFFFFFFF)};
  model.nodes().sum_over_processes(halves);
  return (static_cast<std::uint64_t>(halves[0]) << 32) + static_cast<std::uint64_t>(halves[1]);
}
} // namespace

void Newton::prepare_matrix(const State &state, double time)
{
  const auto scope = timers_.measure("bulk_assembly");
  model_.update_layout(state);
  bool fresh = form_->prepare();
  if (!tangent_assembled_ || !model_.tangent_is_constant())
  {
    if (!model_.nodes().true_on_all(model_.bodies().assemble_tangent(model_.mesh_part(state.displacement), time)))
      throw NumericalFailure("a cell turned inside out");
    ++counters_.n_bulk_assemblies;
    diagonal_ = diagonal_stiffness(model_);
    tangent_assembled_ = true;
    fresh = true;
  }
  if (fresh)
    form_->update_subdomains();
}

void Newton::compute_residual(Evaluation &out, const State &state, double time,
                              const ContactContribution &contact) const
{
  std::vector<double> internal(contact.force.size(), 0.0), external(internal);
  const Sharing &nodes = model_.nodes();
  const int dim = model_.dim();
  out.valid = nodes.true_on_all(model_.bodies().forces(model_.mesh_part(state.displacement), time,
                                                       model_.mesh_part(internal), model_.mesh_part(external)));
  nodes.sum(internal, dim);
  nodes.sum(external, dim);
  out.residual.resize(internal.size());
  for (std::size_t i = 0; i < internal.size(); ++i)
    out.residual[i] = internal[i] - external[i] + contact.force[i];

  const Layout &layout = model_.layout();
  std::vector<double> forces(static_cast<std::size_t>(layout.n_unknowns()), 0.0), with_pending(out.residual);
  std::vector<double> rigid(static_cast<std::size_t>(model_.rigid().n_unknowns()), 0.0);
  model_.rigid().add_forces(time, rigid);
  layout.gather(out.residual, forces);
  for (std::size_t i = 0; i < rigid.size(); ++i)
    forces[i] -= rigid[i];
  const auto on_displacements = std::span(forces).first(static_cast<std::size_t>(layout.n_displacement_unknowns()));
  out.norm = std::sqrt(layout.sharing().dot(on_displacements, on_displacements) + contact.constraint_norm2);
  out.scale = std::sqrt(std::max(
      {nodes.dot(internal, internal, dim), nodes.dot(external, external, dim), contact.force_norm2, norm2(rigid)}));
  // Bodies that travel freely bear no force but round-off.
  out.scale = std::max(out.scale, round_off / model_.options().solver.tolerance *
                                      resisted_force(model_, diagonal_, state.displacement));
  if (!std::isfinite(out.norm))
    out.valid = false;

  if (out.pending_motion > 0)
  {
    std::vector<double> resisted(internal.size(), 0.0);
    for (const SubdomainMatrix &matrix : model_.bodies().subdomains())
      multiply_add(matrix, out.pending, resisted);
    nodes.sum(resisted, dim);
    for (std::size_t i = 0; i < with_pending.size(); ++i)
      with_pending[i] += resisted[i] + contact.prescribed_force[i];
  }
  out.rhs.assign(forces.size(), 0.0);
  layout.gather(with_pending, out.rhs);
  for (std::size_t i = 0; i < rigid.size(); ++i)
    out.rhs[i] -= rigid[i];
  for (Index m = 0; m < layout.n_multipliers(); ++m)
    out.rhs[layout.multiplier(m)] = contact.constraint[m] + contact.prescribed_gap[m];
  for (double &value : out.rhs)
    value = -value;
}

Newton::Evaluation Newton::evaluate(const State &state, const State &start, double time,
                                    std::span<const std::pair<int, Index>> forced, bool first)
{
  Evaluation out;
  try
  {
    prepare_matrix(state, time);
  }
  catch (const NumericalFailure &)
  {
    return out;
  }
  const State target = model_.prescribe(state, time, 1);
  out.pending.resize(state.displacement.size());
  for (std::size_t i = 0; i < out.pending.size(); ++i)
    out.pending[i] = target.displacement[i] - state.displacement[i];
  out.pending_motion = model_.nodes().maximum_over_processes(largest(out.pending));

  const auto scope = timers_.measure("contact_assembly");
  ++counters_.n_contact_updates;
  const ContactContribution contact = contacts_.evaluate(
      state, start.displacement,
      out.pending_motion > 0 ? std::span<const double>(out.pending) : std::span<const double>{}, forced, first);
  out.status = contact.status;
  out.signature = signature(out.status, model_);
  update_rigid_blocks(state, contact.force);
  compute_residual(out, state, time, contact);
  return out;
}

/// Second derivative of the places of a rigid body's nodes in its spins, times the contact forces on them:
/// delta theta . (r f^T - (r . f) I) Delta theta for spins added one after the other.
void Newton::update_rigid_blocks(const State &state, std::span<const double> contact_force)
{
  const int dim = model_.dim();
  const auto bodies = model_.rigid().bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    if (!model_.small_strain())
      for (const Index node : bodies[b].nodes)
      {
        Eigen::Vector3d f = Eigen::Vector3d::Zero();
        for (int c = 0; c < dim; ++c)
          f[c] = contact_force[static_cast<std::size_t>(node) * dim + c];
        const Eigen::Vector3d arm = state.rigid[b].rotation * (model_.reference(node) - bodies[b].point);
        moment += arm * f.transpose() - arm.dot(f) * Eigen::Matrix3d::Identity();
      }
    std::vector<int> axes;
    for (int axis = 0; axis < 3; ++axis)
      if (bodies[b].rotation[axis].unknown >= 0)
        axes.push_back(axis);
    form_->update_dense_block(b, moment(axes, axes));
  }
}

void Newton::restrain(Evaluation &at, const State &state, const State &start, double time, bool first)
{
  if (!free_motions_.any())
    return;
  const FreeMotions::Decision decision = free_motions_.decide(model_.with_halo(state.displacement), contacts_.holding(),
                                                              contacts_.candidates(), at.residual, time, at.scale);
  const bool bordered = form_->set_held_modes(decision.held_modes);
  if (decision.closes || bordered)
    at = evaluate(state, start, time, decision.closed, first);
}
} // namespace amontons
