#include "amontons/solution/contact_assembly.h"

#include "amontons/algebra/linear_solver_failure.h"
#include "amontons/solution/dependent_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace amontons
{
namespace
{
Multipliers multipliers_of(const State &state, const ContactInterface &contact, Index i, int dim)
{
  const double *lambda = state.multipliers.data() + contact.multiplier(i);
  return {lambda[0], {lambda[1], dim == 3 ? lambda[2] : 0}};
}

/// A node without a pair: its multipliers are zero. @param n_nodal components that its pattern has, from when it had
/// one
ContactElement unpaired_element(const Multipliers &lambda, int dim, double r, int n_nodal)
{
  ContactElement out;
  out.force.setZero(n_nodal);
  out.stiffness.setZero(n_nodal, n_nodal);
  out.force_by_multiplier.setZero(n_nodal, dim);
  out.constraint_by_position.setZero(dim, n_nodal);
  out.constraint_by_multiplier = -Eigen::MatrixXd::Identity(dim, dim) / r;
  out.constraint.resize(dim);
  out.constraint[0] = -lambda.normal / r;
  for (int a = 1; a < dim; ++a)
    out.constraint[a] = -lambda.tangential[a - 1] / r;
  return out;
}
} // namespace

ContactAssembly::ContactAssembly(Model &model, SystemForm &form)
  : model_(model)
  , form_(form)
{
  find_shared_nodes();
}

void ContactAssembly::find_shared_nodes()
{
  special_.assign(static_cast<std::size_t>(model_.n_state_nodes()), 0);
  std::vector<int> n_contacts(special_.size(), 0);
  for (const ContactInterface &contact : model_.contacts())
    for (Index i = 0; i < contact.n_nodes(); ++i)
      if (++n_contacts[contact.node(i)] > 1)
        special_[contact.node(i)] = 1;
  for (const HeldComponent &held : model_.supports().held())
    special_[held.nodal / model_.dim()] = 1;
  for (std::size_t node = 0; node < special_.size(); ++node)
    if (model_.rigid_of_node()[node] >= 0)
      special_[node] = 1;
}

void ContactAssembly::rebuild_pattern()
{
  std::vector<ConstraintPattern> patterns;
  first_block_.clear();
  const int dim = model_.dim();
  for (const ContactInterface &contact : model_.contacts())
  {
    first_block_.push_back(patterns.size());
    for (Index i = 0; i < contact.n_nodes(); ++i)
    {
      ConstraintPattern pattern;
      if (const std::vector<Index> nodes = contact.nodes(i); nodes.size() > 1)
        for (const Index node : nodes)
          for (int c = 0; c < dim; ++c)
            pattern.nodal.push_back(node * dim + c);
      for (int m = 0; m < dim; ++m)
        pattern.multipliers[pattern.n_multipliers++] = contact.multiplier(i) + m;
      patterns.push_back(pattern);
    }
  }
  std::vector<std::vector<Index>> rotations;
  for (const RigidBody &body : model_.rigid().bodies())
  {
    rotations.emplace_back();
    for (const RigidComponent &component : body.rotation)
      if (component.unknown >= 0)
        rotations.back().push_back(component.unknown);
  }
  form_.set_constraints(std::move(patterns), std::move(rotations));
}

/// What sigma decides, but for a node whose slip would turn back within one step: it sticks for an iteration, since
/// between slip one way and slip the other lies stick.
ContactStatus ContactAssembly::decide_status(const ContactInterface &contact, Index i, std::size_t block,
                                             const ContactLinearisation &now, const Multipliers &lambda)
{
  const ContactStatus status = contact.status(i, now, lambda);
  const double r = contact.augmentation(i);
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  if (status == ContactStatus::slip && contact.options().friction_coefficient > 0)
    for (int a = 0; a < now.n_tangents(); ++a)
      direction += (lambda.tangential[a] + r * now.slip[a]) * now.tangent[a];
  trial_direction_[block] = direction;
  if (slip_direction_.empty() || direction.dot(slip_direction_[block]) >= 0)
    return status;
  trial_direction_[block].setZero();
  return ContactStatus::stick;
}

ContactAssembly::Work ContactAssembly::make_element(int c, Index i, std::size_t block, const State &state,
                                                    const Motions &motions, bool forced, bool first)
{
  ContactInterface &contact = model_.contacts()[c];
  const int dim = model_.dim();
  const double r = contact.augmentation(i);
  const Multipliers lambda = multipliers_of(state, contact, i, dim);
  Work work{c, i, block, {}};
  if (!contact.paired(i))
  {
    work.element = unpaired_element(lambda, dim, r, form_.constraints()[block].n_nodal());
    return work;
  }
  const ContactLinearisation now = contact.linearise(i, motions.now, motions.start);
  const double mu = contact.options().friction_coefficient;
  ContactStatus status = decide_status(contact, i, block, now, lambda);
  if (first && !contact.options().tied && status != ContactStatus::open &&
      contact.committed_status(i) != ContactStatus::open)
    status = contact.committed_status(i);
  const bool force_closed = forced && status == ContactStatus::open;
  // Where forces move bodies, what closes first must not hold them sideways as well.
  const bool sticks = mu > 0 && !record_nodes_;
  work.element = force_closed ? contact_element(now, lambda, 0, r, sticks ? ContactStatus::stick : ContactStatus::slip)
                              : contact_element(now, lambda, mu, r, status);
  if (!record_nodes_)
    return work;
  if (work.element.status == ContactStatus::open)
  {
    double gap = now.gap;
    const ConstraintPattern &pattern = form_.constraints()[block];
    for (int k = 0; k < pattern.n_nodal() && !motions.pending.empty(); ++k)
      gap += now.gap_gradient[k] * motions.pending[pattern.nodal[k]];
    candidates_.push_back({c, i, gap, now.gap_gradient});
    return work;
  }
  holding_.push_back({c, i, now.gap_gradient});
  if (work.element.status == ContactStatus::stick)
    for (int a = 0; a < now.n_tangents(); ++a)
      holding_.push_back({c, i, now.slip_gradient[a]});
  return work;
}

void ContactAssembly::drop_dependent_rows(std::span<Work *const> works, const State &state) const
{
  DependentRows rows(model_.layout());
  const auto filter = [&](Work &work, auto which)
  {
    const ContactInterface &contact = model_.contacts()[work.contact];
    (rows.*which)(work.element, form_.constraints()[work.block],
                  multipliers_of(state, contact, work.node, model_.dim()), contact.augmentation(work.node));
  };
  for (Work *work : works)
    if (work->element.status != ContactStatus::open)
      filter(*work, &DependentRows::filter_normal);
  for (Work *work : works)
    if (work->element.status == ContactStatus::stick)
      filter(*work, &DependentRows::filter_sticking);
}

void ContactAssembly::write(std::size_t block, const ContactElement &e, double r)
{
  form_.update_constraint(
      block, {e.stiffness, e.force_by_multiplier, e.constraint_by_position, e.constraint_by_multiplier, r});
}

void ContactAssembly::add(const Work &work, std::span<const double> pending, ContactContribution &out)
{
  const ContactElement &e = work.element;
  const ContactInterface &contact = model_.contacts()[work.contact];
  const ConstraintPattern &pattern = form_.constraints()[work.block];
  AMONTONS_ASSERT(e.force.size() == pattern.n_nodal());
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(pattern.n_nodal());
  if (!pending.empty())
    for (int k = 0; k < pattern.n_nodal(); ++k)
      motion[k] = pending[pattern.nodal[k]];
  const bool moves = motion.size() > 0 && !motion.isZero(0);
  for (int k = 0; k < pattern.n_nodal(); ++k)
    out.force[pattern.nodal[k]] += e.force[k];
  out.force_norm2 += e.force.squaredNorm();
  for (int m = 0; m < pattern.n_multipliers; ++m)
  {
    out.constraint[pattern.multipliers[m]] = e.constraint[m];
    // -lambda / r and the like are forces over r; the rest are lengths.
    const double force_per_length =
        e.constraint_by_multiplier(m, m) != 0 ? contact.augmentation(work.node) : contact.stiffness(work.node);
    out.constraint_norm2 += std::pow(force_per_length * e.constraint[m], 2);
  }
  if (moves)
  {
    const Eigen::VectorXd force = e.stiffness * motion, gap = e.constraint_by_position * motion;
    for (int k = 0; k < pattern.n_nodal(); ++k)
      out.prescribed_force[pattern.nodal[k]] += force[k];
    for (int m = 0; m < pattern.n_multipliers; ++m)
      out.prescribed_gap[pattern.multipliers[m]] += gap[m];
  }
  write(work.block, e, contact.augmentation(work.node));
}

ContactContribution ContactAssembly::evaluate(const State &state, std::span<const double> start,
                                              std::span<const double> pending,
                                              std::span<const std::pair<int, Index>> forced, bool first)
{
  ContactContribution out;
  out.force.assign(static_cast<std::size_t>(model_.n_nodal()), 0);
  out.prescribed_force.assign(out.force.size(), 0);
  out.constraint.assign(static_cast<std::size_t>(model_.layout().n_multipliers()), 0);
  out.prescribed_gap.assign(out.constraint.size(), 0);
  Motions motions{model_.with_halo(state.displacement), model_.with_halo(start), {}};
  if (!pending.empty())
    motions.pending = model_.with_halo(pending);
  agree_on_failures(model_.nodes(), [&] { make_elements(state, motions, forced, first, out); });
  add_up(!pending.empty(), out);
  return out;
}

void ContactAssembly::make_elements(const State &state, const Motions &motions,
                                    std::span<const std::pair<int, Index>> forced, bool first, ContactContribution &out)
{
  holding_.clear();
  candidates_.clear();
  trial_direction_.assign(form_.constraints().size(), Eigen::Vector3d::Zero());
  std::map<Index, std::vector<Work>> special;
  for (int c = 0; c < static_cast<int>(model_.contacts().size()); ++c)
  {
    model_.contacts()[c].move_to(motions.now);
    for (Index i = 0; i < model_.contacts()[c].n_nodes(); ++i)
    {
      const bool force = std::binary_search(forced.begin(), forced.end(), std::pair{c, i});
      Work work = make_element(c, i, first_block_[c] + i, state, motions, force, first);
      out.status.push_back(work.element.status);
      const Index node = model_.contacts()[c].node(i);
      if (special_[node])
        special[node].push_back(std::move(work));
      else
        add(work, motions.pending, out);
    }
  }
  for (auto &[node, works] : special)
  {
    std::vector<Work *> pointers;
    for (Work &work : works)
      pointers.push_back(&work);
    drop_dependent_rows(pointers, state);
    for (const Work &work : works)
      add(work, motions.pending, out);
  }
}

/// What the elements of all processes do.
void ContactAssembly::add_up(bool pending, ContactContribution &out) const
{
  const Sharing &nodes = model_.nodes();
  nodes.sum(out.force, model_.dim());
  if (pending)
    nodes.sum(out.prescribed_force, model_.dim());
  std::array<double, 2> norms{out.constraint_norm2, out.force_norm2};
  nodes.sum_over_processes(norms);
  out.constraint_norm2 = norms[0];
  out.force_norm2 = norms[1];
}
} // namespace amontons
