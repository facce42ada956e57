#include "amontons/algebra/feti_form.h"

#include "amontons/algebra/linear_solver_failure.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
constexpr double default_tolerance = 1e-10;
/// What one round in single precision can gain at the most.
constexpr double round_reduction = 1e-5;
constexpr int max_rounds = 20, max_idle_rounds = 3;
/// Rounds that gain less than this have come to round-off, which may be this part of the right side.
constexpr double least_gain = 0.5, allowed_round_off = 1e-6;
/// By how much at most a round that gained nothing makes the next one's target smaller.
constexpr double sharper = 1e-3;
} // namespace

FetiForm::FetiForm(const Layout &layout, std::span<const SubdomainMatrix> subdomains, FetiOptions options)
  : layout_(layout)
  , subdomains_(subdomains)
  , dual_(std::make_unique<FetiDual>(layout, subdomains, std::move(options)))
{
}

void FetiForm::set_constraints(std::vector<ConstraintPattern> constraints, std::vector<std::vector<Index>> dense_blocks)
{
  constraints_ = std::move(constraints);
  dense_blocks_ = std::move(dense_blocks);
  reduced_.assign(constraints_.size(), {});
  augmentation_.assign(constraints_.size(), 1);
  dense_values_.assign(dense_blocks_.size(), {});
  pattern_changed_ = true;

  FetiOptions options = dual_->options();
  const std::size_t n_known = options.contact_nodes.size();
  const int dim = dual_->interface().dim();
  for (const ConstraintPattern &pattern : constraints_)
    for (int k = 0; k < pattern.n_nodal(); ++k)
      if (const Index node = pattern.nodal[k] / dim; !dual_->interface().on_boundary(node))
        options.contact_nodes.push_back(node);
  if (options.nodes.true_on_all(options.contact_nodes.size() == n_known))
    return;
  n_earlier_factorizations_ += dual_->n_factorizations();
  dual_ = std::make_unique<FetiDual>(layout_, subdomains_, std::move(options));
  bodies_changed_ = true;
}

bool FetiForm::set_held_modes(std::vector<std::vector<double>> modes)
{
  if (modes.empty() && modes_.empty())
    return false;
  modes_ = std::move(modes);
  return true;
}

bool FetiForm::prepare()
{
  return std::exchange(first_, false);
}

void FetiForm::update_constraint(std::size_t k, const ConstraintValues &values)
{
  reduced_[k] = reduce_constraint(values);
  augmentation_[k] = values.augmentation;
}

void FetiForm::append_row(FetiContactRows &out, const ConstraintPattern &pattern, const Eigen::VectorXd &row,
                          const Eigen::VectorXd &force, double spring) const
{
  std::array<std::vector<FetiRows::Entry>, 2> entries;
  for (int k = 0; k < pattern.n_nodal(); ++k)
    for (const bool forces : {false, true})
      if (const double coefficient = (forces ? force : row)[k]; coefficient != 0)
        dual_->interface().append(pattern.nodal[k], coefficient, entries[forces]);
  const bool on_nothing = entries[0].empty() || entries[1].empty();
  if (on_nothing && spring != 0) // between components that are held
    return;
  if (on_nothing)
    throw NumericalFailure("the tangent matrix is singular: a contact row acts on nothing");
  if (spring != 0)
  {
    const Index column = dual_->interface().n_columns() + static_cast<Index>(out.springs.size());
    for (auto &side : entries)
      side.emplace_back(column, -1);
    out.springs.push_back(spring);
  }
  out.rows.push_back(entries[0]);
  out.forces.push_back(entries[1]);
  out.impactors.push_back(pattern.nodal[0] / dual_->interface().dim());
}

void FetiForm::append_dense_block(FetiContactRows &out, std::size_t block) const
{
  const Eigen::MatrixXd &values = dense_values_[block];
  if (values.isZero(0))
    return;
  const bool symmetric = values.isApprox(values.transpose(), 1e-14);
  out.symmetric &= symmetric;
  const LowRankMatrix parts = factorise_low_rank(values, symmetric);
  for (Eigen::Index j = 0; j < parts.weight.size(); ++j)
  {
    for (const bool forces : {false, true})
    {
      std::vector<FetiRows::Entry> entries;
      for (std::size_t k = 0; k < dense_blocks_[block].size(); ++k)
        entries.emplace_back(dual_->interface().rigid_column(dense_blocks_[block][k]),
                             (forces ? parts.left : parts.right)(static_cast<Eigen::Index>(k), j));
      entries.emplace_back(dual_->interface().n_columns() + static_cast<Index>(out.springs.size()), -1);
      (forces ? out.forces : out.rows).push_back(entries);
    }
    out.springs.push_back(parts.weight[j]);
    out.impactors.push_back(-1);
  }
}

/// First the proper rows of all constraints of this process, then springs. Those of dense blocks, which all processes
/// are given, are the first one's.
FetiContactRows FetiForm::contact_rows() const
{
  FetiContactRows out;
  for (std::size_t k = 0; k < constraints_.size(); ++k)
  {
    const ConstraintRows &reduced = reduced_[k];
    out.symmetric &= reduced.symmetric;
    for (int i = 0; i < reduced.n_rows(); ++i)
      append_row(out, constraints_[k], reduced.rows.row(i), reduced.forces.col(i), 0);
  }
  for (std::size_t k = 0; k < constraints_.size(); ++k)
    if (reduced_[k].stiffness.size() > 0)
    {
      const LowRankMatrix parts = factorise_low_rank(reduced_[k].stiffness, reduced_[k].symmetric);
      for (Eigen::Index j = 0; j < parts.weight.size(); ++j)
        append_row(out, constraints_[k], parts.right.col(j), parts.left.col(j), parts.weight[j]);
    }
  if (layout_.sharing().rank() == 0)
    for (std::size_t block = 0; block < dense_blocks_.size(); ++block)
      append_dense_block(out, block);
  return out;
}

void FetiForm::factorize()
{
  if (bodies_changed_)
    dual_->update_bodies();
  if (bodies_changed_ || pattern_changed_)
  {
    std::vector<std::span<const Index>> couplings;
    for (const ConstraintPattern &pattern : constraints_)
      couplings.emplace_back(pattern.nodal);
    dual_->set_couplings(couplings, {dense_blocks_.begin(), dense_blocks_.end()});
    ++n_pattern_builds_;
  }
  bodies_changed_ = pattern_changed_ = false;
  FetiContactRows rows;
  agree_on_failures(layout_.sharing(), [&] { rows = contact_rows(); });
  dual_->set_rows(std::move(rows), modes_);
}

std::vector<double> FetiForm::nodal(std::span<const double> unknowns) const
{
  std::vector<double> out(static_cast<std::size_t>(layout_.n_nodal()), 0.0);
  for (Index i = 0; i < layout_.n_nodal(); ++i)
    for (const Term &term : layout_.terms(i))
      out[i] += term.coefficient * unknowns[term.unknown];
  return out;
}

Eigen::VectorXd FetiForm::on_pattern(const ConstraintPattern &pattern, std::span<const double> nodal) const
{
  Eigen::VectorXd out(pattern.n_nodal());
  for (int k = 0; k < pattern.n_nodal(); ++k)
    out[k] = nodal[pattern.nodal[k]];
  return out;
}

void FetiForm::measure(Residual &r) const
{
  double sum = 0;
  for (std::size_t i = 0; i < r.forces.size(); ++i)
    if (layout_.sharing().is_own(static_cast<Index>(i)))
      sum += r.forces[i] * r.forces[i];
  std::size_t i = 0;
  for (std::size_t k = 0; k < constraints_.size(); ++k)
    for (int row = 0; row < reduced_[k].n_rows(); ++row)
      sum += std::pow(augmentation_[k] * r.gaps[i++], 2);
  layout_.sharing().sum_over_processes({&sum, 1});
  r.norm = std::sqrt(sum);
}

/// `whole` forces, the same on all copies, and those on own nodes' copies that only this process knows. Collective.
std::vector<double> FetiForm::sum_forces(std::span<const double> whole, std::span<const double> nodal_parts) const
{
  std::vector<double> out(static_cast<std::size_t>(layout_.n_displacement_unknowns()), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (layout_.sharing().is_own(static_cast<Index>(i)))
      out[i] = whole[i];
  layout_.gather(nodal_parts, out);
  layout_.sharing().sum(out);
  return out;
}

FetiForm::Residual FetiForm::reduced_right_side(std::span<const double> rhs) const
{
  Residual out;
  std::vector<double> nodal_forces(static_cast<std::size_t>(layout_.n_nodal()), 0.0);
  for (std::size_t k = 0; k < constraints_.size(); ++k)
  {
    const ConstraintPattern &pattern = constraints_[k];
    Eigen::VectorXd own(pattern.n_multipliers);
    for (int m = 0; m < pattern.n_multipliers; ++m)
      own[m] = rhs[layout_.multiplier(pattern.multipliers[m])];
    const Eigen::VectorXd force = reduced_[k].right_side_force * own, gaps = reduced_[k].row_right_side * own;
    for (int i = 0; i < pattern.n_nodal(); ++i)
      nodal_forces[pattern.nodal[i]] -= force[i];
    out.gaps.insert(out.gaps.end(), gaps.data(), gaps.data() + gaps.size());
  }
  out.forces = sum_forces(rhs, nodal_forces);
  out.motions.assign(modes_.size(), 0.0);
  measure(out);
  const auto n_rows = static_cast<std::size_t>(dual_->n_contact_rows());
  out.gaps.resize(n_rows, 0.0); // springs
  return out;
}

void FetiForm::subtract_constraints(std::span<const double> displacement, const FetiStep &step,
                                    std::span<double> nodal_forces, Residual &out) const
{
  std::size_t first = 0;
  for (std::size_t k = 0; k < constraints_.size(); ++k)
  {
    const ConstraintPattern &pattern = constraints_[k];
    const ConstraintRows &reduced = reduced_[k];
    const Eigen::VectorXd du = on_pattern(pattern, displacement);
    const Eigen::Map<const Eigen::VectorXd> y(step.rows.data() + first, reduced.n_rows());
    Eigen::VectorXd force = reduced.forces * y;
    if (reduced.stiffness.size() > 0)
      force += reduced.stiffness * du;
    const Eigen::VectorXd gaps = reduced.rows * du;
    for (int i = 0; i < pattern.n_nodal(); ++i)
      nodal_forces[pattern.nodal[i]] -= force[i];
    for (int i = 0; i < reduced.n_rows(); ++i)
      out.gaps[first++] -= gaps[i];
  }
}

FetiForm::Residual FetiForm::residual(const Residual &right_side, const FetiStep &step) const
{
  Residual out = right_side;
  const std::vector<double> displacement = nodal(step.unknowns);
  std::vector<double> nodal_forces(displacement.size(), 0.0);
  for (const SubdomainMatrix &matrix : subdomains_)
    multiply_add(matrix, displacement, nodal_forces);
  for (double &force : nodal_forces)
    force = -force;
  subtract_constraints(displacement, step, nodal_forces, out);
  out.forces = sum_forces(right_side.forces, nodal_forces);
  for (std::size_t b = 0; b < dense_blocks_.size(); ++b)
    for (std::size_t i = 0; i < dense_blocks_[b].size() && dense_values_[b].size() > 0; ++i)
      for (std::size_t j = 0; j < dense_blocks_[b].size(); ++j)
        out.forces[dense_blocks_[b][i]] -=
            dense_values_[b](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *
            step.unknowns[dense_blocks_[b][j]];
  std::vector<double> moved(modes_.size(), 0.0);
  for (std::size_t m = 0; m < modes_.size(); ++m)
    for (std::size_t i = 0; i < modes_[m].size(); ++i)
    {
      out.forces[i] -= step.modes[m] * modes_[m][i];
      if (layout_.sharing().is_own(static_cast<Index>(i)))
        moved[m] += modes_[m][i] * step.unknowns[i];
    }
  layout_.sharing().sum_over_processes(moved);
  for (std::size_t m = 0; m < modes_.size(); ++m)
    out.motions[m] -= moved[m];
  measure(out);
  return out;
}

/// The multipliers of this process's constraints from those of the rows.
void FetiForm::recover(std::span<const double> rhs, const FetiStep &step, std::span<double> solution) const
{
  std::copy(step.unknowns.begin(), step.unknowns.end(), solution.begin());
  const std::vector<double> displacement = nodal(step.unknowns);
  std::size_t first = 0;
  for (std::size_t k = 0; k < constraints_.size(); ++k)
  {
    const ConstraintPattern &pattern = constraints_[k];
    const ConstraintRows &reduced = reduced_[k];
    Eigen::VectorXd own(pattern.n_multipliers);
    for (int m = 0; m < pattern.n_multipliers; ++m)
      own[m] = rhs[layout_.multiplier(pattern.multipliers[m])];
    const Eigen::Map<const Eigen::VectorXd> y(step.rows.data() + first, reduced.n_rows());
    first += static_cast<std::size_t>(reduced.n_rows());
    const Eigen::VectorXd multipliers = reduced.multiplier_by_row * y + reduced.multiplier_by_right_side * own +
                                        reduced.multiplier_by_position * on_pattern(pattern, displacement);
    for (int m = 0; m < pattern.n_multipliers; ++m)
      solution[layout_.multiplier(pattern.multipliers[m])] = multipliers[m];
  }
}

void FetiForm::solve(std::span<const double> rhs, std::span<double> solution, double tolerance)
{
  const Residual right_side = reduced_right_side(rhs);
  const double limit = (tolerance > 0 ? tolerance : default_tolerance) * right_side.norm;
  FetiStep sum{std::vector<double>(static_cast<std::size_t>(layout_.n_displacement_unknowns()), 0.0),
               std::vector<double>(right_side.gaps.size(), 0.0), std::vector<double>(modes_.size(), 0.0)};
  Residual left = right_side;
  double before = left.norm, target = 0.3 * limit;
  const auto add = [](std::vector<double> &to, const std::vector<double> &what)
  {
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] += what[i];
  };
  for (int round = 0, n_idle = 0; left.norm > limit; ++round)
  {
    const FetiStep step = dual_->solve(left.forces, left.gaps, left.motions, round_reduction, target);
    add(sum.unknowns, step.unknowns);
    add(sum.rows, step.rows);
    add(sum.modes, step.modes);
    left = residual(right_side, sum);
    const bool stagnates = left.norm > least_gain * before;
    if (round > 0 && stagnates && left.norm <= allowed_round_off * right_side.norm)
      break;
    // The iteration stops on the preconditioned residual, which may be much the smaller.
    if (stagnates)
      target *= std::max(0.3 * limit / left.norm, sharper);
    n_idle += stagnates;
    const bool gives_up = left.norm > limit && (round == max_rounds || n_idle > max_idle_rounds);
    if (gives_up || !std::isfinite(left.norm))
      throw LinearSolverFailure("the iteration over the subdomains does not converge");
    before = left.norm;
  }
  recover(rhs, sum, solution);
  mode_reactions_ = sum.modes;
}

FormCounters FetiForm::counters() const
{
  return {n_pattern_builds_, n_earlier_factorizations_ + dual_->n_factorizations(), dual_->n_setups(),
          dual_->n_iterations()};
}
} // namespace amontons
