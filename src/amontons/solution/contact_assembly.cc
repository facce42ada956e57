#include "amontons/solution/contact_assembly.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <map>

namespace amontons
{
namespace
{
/// Share of a row's length that must be left, after what other rows hold is taken away, for the row to count.
constexpr double independent_share = 1e-6;

using SparseRow = std::map<Index, double>;

double dot(const SparseRow &a, const SparseRow &b)
{
  double sum = 0;
  for (const auto &[i, v] : a)
    if (const auto it = b.find(i); it != b.end())
      sum += v * it->second;
  return sum;
}

void subtract(SparseRow &a, const SparseRow &b, double factor)
{
  for (const auto &[i, v] : b)
    a[i] -= factor * v;
}

void orthogonalize(SparseRow &row, const std::vector<SparseRow> &kept)
{
  for (const SparseRow &other : kept)
    subtract(row, other, dot(row, other));
}

void keep(SparseRow row, std::vector<SparseRow> &kept)
{
  const double length = std::sqrt(dot(row, row));
  for (auto &[i, v] : row)
    v /= length;
  kept.push_back(std::move(row));
}

Multipliers multipliers_of(const State &state, const ContactInterface &contact, Index i, int dim)
{
  const double *lambda = state.multipliers.data() + contact.multiplier(i);
  return {lambda[0], {lambda[1], dim == 3 ? lambda[2] : 0}};
}

/// A node without a pair: its multipliers are zero.
ContactElement unpaired_element(const Multipliers &lambda, int dim, double r)
{
  ContactElement out;
  out.force.resize(0);
  out.stiffness.resize(0, 0);
  out.force_by_multiplier.resize(0, dim);
  out.constraint_by_position.resize(dim, 0);
  out.constraint_by_multiplier = -Eigen::MatrixXd::Identity(dim, dim) / r;
  out.constraint.resize(dim);
  out.constraint[0] = -lambda.normal / r;
  for (int a = 1; a < dim; ++a)
    out.constraint[a] = -lambda.tangential[a - 1] / r;
  return out;
}
} // namespace

ContactAssembly::ContactAssembly(Model &model, CoupledForm &form)
  : model_(model)
  , form_(form)
{
  find_shared_nodes();
}

void ContactAssembly::find_shared_nodes()
{
  special_.assign(model_.rigid_of_node().size(), 0);
  std::vector<int> n_contacts(special_.size(), 0);
  for (const ContactInterface &contact : model_.contacts())
    for (const GlobalIndex node : contact.impactor().node_ids)
      if (++n_contacts[static_cast<std::size_t>(node)] > 1)
        special_[static_cast<std::size_t>(node)] = 1;
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
      std::array<Index, 5> nodes;
      if (contact.paired(i))
        for (int k = 0, n = contact.nodes(i, nodes); k < n; ++k)
          for (int c = 0; c < dim; ++c)
            pattern.nodal[pattern.n_nodal++] = nodes[k] * dim + c;
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
ContactStatus ContactAssembly::decide_status(std::size_t block, const ContactLinearisation &now,
                                             const Multipliers &lambda, double mu, double r)
{
  const ContactStatus status = contact_status(now, lambda, mu, r);
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  if (status == ContactStatus::slip && mu > 0)
    for (int a = 0; a < now.n_tangents(); ++a)
      direction += (lambda.tangential[a] + r * now.slip[a]) * now.tangent[a];
  trial_direction_[block] = direction;
  if (slip_direction_.empty() || direction.dot(slip_direction_[block]) >= 0)
    return status;
  trial_direction_[block].setZero();
  return ContactStatus::stick;
}

ContactAssembly::Work ContactAssembly::make_element(int c, Index i, std::size_t block, const State &state,
                                                    std::span<const double> start, std::span<const double> pending,
                                                    bool forced, bool first)
{
  ContactInterface &contact = model_.contacts()[c];
  const int dim = model_.dim();
  const double r = contact.augmentation(i);
  const Multipliers lambda = multipliers_of(state, contact, i, dim);
  Work work{c, i, block, {}};
  if (!contact.paired(i))
  {
    work.element = unpaired_element(lambda, dim, r);
    return work;
  }
  const ContactLinearisation now = contact.linearise(i, state.displacement, start);
  const double mu = contact.options().friction_coefficient;
  ContactStatus status = decide_status(block, now, lambda, mu, r);
  if (first && status != ContactStatus::open && contact.committed_status(i) != ContactStatus::open)
    status = contact.committed_status(i);
  const bool force_closed = forced && status == ContactStatus::open;
  work.element = force_closed ? contact_element(now, lambda, 0, r, ContactStatus::slip)
                              : contact_element(now, lambda, mu, r, status);
  if (!record_nodes_)
    return work;
  if (work.element.status == ContactStatus::open)
  {
    double gap = now.gap;
    const ConstraintPattern &pattern = form_.constraints()[block];
    for (int k = 0; k < pattern.n_nodal && !pending.empty(); ++k)
      gap += now.gap_gradient[k] * pending[pattern.nodal[k]];
    candidates_.push_back({c, i, gap, now.gap_gradient});
    return work;
  }
  holding_.push_back({c, i, now.gap_gradient});
  if (work.element.status == ContactStatus::stick)
    for (int a = 0; a < now.n_tangents(); ++a)
      holding_.push_back({c, i, now.slip_gradient[a]});
  return work;
}

void ContactAssembly::drop_dependent_rows(std::span<Work *const> works, const State &state)
{
  const int dim = model_.dim();
  std::vector<SparseRow> kept;
  const auto on_unknowns = [&](const Work &work, const auto &row)
  {
    SparseRow out;
    const ConstraintPattern &pattern = form_.constraints()[work.block];
    for (int k = 0; k < pattern.n_nodal; ++k)
      for (const Term &term : model_.layout().terms(pattern.nodal[k]))
        out[term.unknown] += term.coefficient * row[k];
    return out;
  };
  for (Work *work : works)
  {
    ContactElement &e = work->element;
    if (e.status == ContactStatus::open)
      continue;
    const ContactInterface &contact = model_.contacts()[work->contact];
    const double r = contact.augmentation(work->node);
    const Multipliers lambda = multipliers_of(state, contact, work->node, dim);
    SparseRow normal = on_unknowns(*work, e.constraint_by_position.row(0));
    const double full = e.constraint_by_position.row(0).norm();
    orthogonalize(normal, kept);
    if (std::sqrt(dot(normal, normal)) > independent_share * full)
      keep(std::move(normal), kept);
    else
    {
      e.constraint_by_position.row(0).setZero();
      e.constraint_by_multiplier.row(0).setZero();
      e.constraint_by_multiplier(0, 0) = -1 / r;
      e.constraint[0] = -lambda.normal / r;
    }
    if (e.status != ContactStatus::stick)
      continue;
    const int n = dim - 1;
    std::vector<SparseRow> rows;
    Eigen::MatrixXd gram(n, n);
    for (int a = 0; a < n; ++a)
    {
      rows.push_back(on_unknowns(*work, e.constraint_by_position.row(1 + a)));
      orthogonalize(rows.back(), kept);
    }
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        gram(a, b) = dot(rows[a], rows[b]);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
    if (eigen.eigenvalues()[0] > independent_share * independent_share * full * full)
    {
      for (auto &row : rows)
      {
        orthogonalize(row, kept);
        keep(row, kept);
      }
      continue;
    }
    // The tangent plane's directions one by one: what has no unknown behind it carries no multiplier.
    const Eigen::MatrixXd u = eigen.eigenvectors();
    const Eigen::MatrixXd by_position = u.transpose() * e.constraint_by_position.bottomRows(n);
    const Eigen::VectorXd constraint = u.transpose() * e.constraint.tail(n);
    const Eigen::Map<const Eigen::VectorXd> tangential(lambda.tangential.data(), n);
    for (int k = 0; k < n; ++k)
    {
      e.constraint_by_multiplier.row(1 + k).setZero();
      if (eigen.eigenvalues()[k] > independent_share * independent_share * full * full)
      {
        e.constraint_by_position.row(1 + k) = by_position.row(k);
        e.constraint[1 + k] = constraint[k];
        SparseRow row = on_unknowns(*work, by_position.row(k));
        orthogonalize(row, kept);
        keep(std::move(row), kept);
        continue;
      }
      e.constraint_by_position.row(1 + k).setZero();
      e.constraint_by_multiplier.block(1 + k, 1, 1, n) = -u.col(k).transpose() / r;
      e.constraint[1 + k] = -u.col(k).dot(tangential) / r;
    }
  }
}

void ContactAssembly::write(std::size_t block, const ContactElement &e)
{
  form_.update_constraint(block,
                          {e.stiffness, e.force_by_multiplier, e.constraint_by_position, e.constraint_by_multiplier});
}

void ContactAssembly::add(const Work &work, std::span<const double> pending, ContactContribution &out)
{
  const ContactElement &e = work.element;
  const ContactInterface &contact = model_.contacts()[work.contact];
  const ConstraintPattern &pattern = form_.constraints()[work.block];
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(pattern.n_nodal);
  if (!pending.empty())
    for (int k = 0; k < pattern.n_nodal; ++k)
      motion[k] = pending[pattern.nodal[k]];
  const bool moves = motion.size() > 0 && !motion.isZero(0);
  for (int k = 0; k < pattern.n_nodal; ++k)
    out.force[pattern.nodal[k]] += e.force[k];
  out.force_norm2 += e.force.squaredNorm();
  for (int m = 0; m < pattern.n_multipliers; ++m)
  {
    out.constraint[pattern.multipliers[m]] = e.constraint[m];
    out.constraint_norm2 += std::pow(contact.augmentation(work.node) * e.constraint[m], 2);
  }
  if (moves)
  {
    const Eigen::VectorXd force = e.stiffness * motion, gap = e.constraint_by_position * motion;
    for (int k = 0; k < pattern.n_nodal; ++k)
      out.prescribed_force[pattern.nodal[k]] += force[k];
    for (int m = 0; m < pattern.n_multipliers; ++m)
      out.prescribed_gap[pattern.multipliers[m]] += gap[m];
  }
  write(work.block, e);
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
  holding_.clear();
  candidates_.clear();
  trial_direction_.assign(form_.constraints().size(), Eigen::Vector3d::Zero());
  std::map<Index, std::vector<Work>> special;
  for (int c = 0; c < static_cast<int>(model_.contacts().size()); ++c)
    for (Index i = 0; i < model_.contacts()[c].n_nodes(); ++i)
    {
      const bool force = std::find(forced.begin(), forced.end(), std::pair{c, i}) != forced.end();
      Work work = make_element(c, i, first_block_[c] + i, state, start, pending, force, first);
      out.status.push_back(work.element.status);
      const auto node = static_cast<Index>(model_.contacts()[c].impactor().node_ids[i]);
      if (special_[node])
        special[node].push_back(std::move(work));
      else
        add(work, pending, out);
    }
  for (auto &[node, works] : special)
  {
    std::vector<Work *> pointers;
    for (Work &work : works)
      pointers.push_back(&work);
    drop_dependent_rows(pointers, state);
    for (const Work &work : works)
      add(work, pending, out);
  }
  return out;
}
} // namespace amontons
