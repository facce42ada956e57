#include "amontons/algebra/feti_dual.h"

#include "amontons/algebra/linear_solver_failure.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
constexpr int max_iterations = 500;
} // namespace

FetiDual::FetiDual(const Layout &layout, std::span<const SubdomainMatrix> subdomains, FetiOptions options)
  : layout_(layout)
  , subdomains_(subdomains)
  , options_(std::move(options))
  , processes_(options_.nodes.counted_as(feti_phase))
  , setup_processes_(options_.nodes.counted_as(feti_setup_phase))
  , interface_(std::make_unique<FetiInterface>(layout, subdomains, options_))
  , contact_(*interface_, kernel_, setup_processes_)
{
  AMONTONS_ASSERT(processes_.is_distributed() == layout.sharing().is_distributed());
  factors_.reserve(subdomains.size());
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    factors_.emplace_back(session_, subdomains[s], interface_->boundary(s), interface_->motions(s));
  local_.resize(static_cast<std::size_t>(interface_->n_local()));
  rigid_.resize(static_cast<std::size_t>(interface_->n_rigid()));
}

/// Forces on unknowns to the own columns of B; leaves the copies' forces in local_.
std::vector<double> FetiDual::condense(std::span<const double> forces)
{
  interface_->distribute(forces, local_, rigid_);
  std::vector<double> out(static_cast<std::size_t>(n_columns()), 0.0);
  for (std::size_t s = 0; s < factors_.size(); ++s)
    factors_[s].condense(
        {local_.data() + interface_->first_local(s), static_cast<std::size_t>(subdomains_[s].n_rows())},
        out.data() + interface_->first_column(s));
  if (counts_common())
    std::copy(rigid_.begin(), rigid_.end(), out.begin() + interface_->first_rigid_column());
  return out;
}

/// Displacements of the columns of B to unknowns, with the copies' forces in local_.
std::vector<double> FetiDual::expand(std::span<const double> boundary)
{
  std::vector<double> displacement(local_.size());
  for (std::size_t s = 0; s < factors_.size(); ++s)
  {
    const auto n = static_cast<std::size_t>(subdomains_[s].n_rows());
    factors_[s].expand({local_.data() + interface_->first_local(s), n}, boundary.data() + interface_->first_column(s),
                       {displacement.data() + interface_->first_local(s), n});
  }
  std::copy_n(boundary.begin() + interface_->first_rigid_column(), rigid_.size(), rigid_.begin());
  std::vector<double> out(static_cast<std::size_t>(layout_.n_displacement_unknowns()));
  interface_->average(displacement, rigid_, out);
  return out;
}

/// R^T of what condense() gives. [kernel_.size()]
std::vector<double> FetiDual::kernel_loads(std::span<const double> condensed) const
{
  std::vector<double> out(static_cast<std::size_t>(kernel_.size()));
  kernel_.restrict(condensed, out);
  setup_processes_.sum_over_processes(out);
  return out;
}

std::vector<double> FetiDual::part_of_rows(std::span<const double> v, bool forces) const
{
  const FetiRows &contact = contact_.rows(forces);
  std::vector<double> out(static_cast<std::size_t>(glue_.size() + contact.size()));
  glue_.multiply(v, out.data());
  contact.multiply(v, out.data() + glue_.size());
  return out;
}

std::vector<double> FetiDual::rows_of_motions(std::span<const double> alpha, bool forces) const
{
  std::vector<double> v(static_cast<std::size_t>(n_columns()), 0.0);
  kernel_.expand_add(alpha, v);
  std::vector<double> out(static_cast<std::size_t>(glue_.size() + contact_.size()));
  glue_.multiply(v, out.data());
  contact_.motions(forces).multiply(alpha, out.data() + glue_.size());
  return out;
}

void FetiDual::sum_rows(std::vector<double> &parts) const
{
  interface_->glue_sharing().sum(std::span(parts).first(static_cast<std::size_t>(glue_.size())));
  contact_.sum(contact_part(parts));
}

FetiDual::Jump FetiDual::jump(std::span<const double> v, std::span<const double> row_gaps) const
{
  Jump out{part_of_rows(v, false), std::vector<double>(static_cast<std::size_t>(kernel_.size()))};
  const std::span<double> contact = contact_part(out.rows);
  for (std::size_t i = 0; i < row_gaps.size(); ++i) // own rows come first
    contact[i] -= contact_.row_scale()[i] * row_gaps[i];
  // G^T of the parts, so that only loads have to be summed over all processes.
  std::vector<double> pulled(static_cast<std::size_t>(n_columns()), 0.0);
  glue_.multiply_transposed_add(out.rows.data(), pulled);
  kernel_.restrict(pulled, out.loads);
  contact_.motions(false).multiply_transposed_add(contact.data(), out.loads);
  processes_.sum_over_processes(out.loads);
  sum_rows(out.rows);
  return out;
}

/// Zero on columns of other processes' subdomains; on rigid columns each process's part.
std::vector<double> FetiDual::pull(std::span<const double> multipliers, bool forces) const
{
  std::vector<double> out(static_cast<std::size_t>(n_columns()), 0.0);
  glue_.multiply_transposed_add(multipliers.data(), out);
  contact_.rows(forces).multiply_transposed_add(multipliers.data() + glue_.size(), out);
  std::fill_n(out.begin(), interface_->first_own_column(), 0.0);
  std::fill(out.begin() + interface_->end_of_own_columns(), out.begin() + interface_->first_rigid_column(), 0.0);
  return out;
}

FetiDual::Pull FetiDual::measure(std::span<const double> z) const
{
  std::vector<double> v = pull(z, true);
  std::vector<double> loads(static_cast<std::size_t>(kernel_.size()));
  kernel_.restrict(v, loads);
  std::fill_n(v.begin() + interface_->first_rigid_column(), interface_->n_rigid(), 0.0);
  double sum = 0;
  for (const double x : v)
    sum += x * x;
  loads.push_back(sum);
  processes_.sum_over_processes(loads);
  sum = loads.back();
  loads.pop_back();
  // Loads of rigid unknowns, the last ones, are their columns.
  for (auto load = loads.end() - interface_->n_rigid(); load != loads.end(); ++load)
    sum += *load * *load;
  return {std::sqrt(sum), std::move(loads)};
}

std::vector<double> FetiDual::flexibility(std::span<const double> v) const
{
  std::vector<double> out(v.size(), 0.0);
  for (std::size_t s = 0; s < factors_.size(); ++s)
    factors_[s].apply_flexibility(v.data() + interface_->first_column(s), out.data() + interface_->first_column(s));
  for (std::size_t k = 0; k < contact_.springs().size(); ++k)
    out[interface_->n_columns() + k] = v[interface_->n_columns() + k] / contact_.springs()[k];
  return out;
}

std::vector<double> FetiDual::precondition(std::vector<double> r)
{
  contact_.apply_scaling(contact_part(r), false);
  std::vector<double> v = pull(r, false), forces(v.size(), 0.0);
  for (std::size_t i = 0; i < v.size(); ++i)
    v[i] *= inverse_stiffness_[i];
  for (std::size_t s = 0; s < factors_.size(); ++s)
  {
    const double *x = v.data() + interface_->first_column(s);
    double *y = forces.data() + interface_->first_column(s);
    if (options_.lumped)
      factors_[s].apply_boundary_stiffness(x, y);
    else
      factors_[s].apply_stiffness(x, y);
  }
  for (std::size_t k = 0; k < contact_.springs().size(); ++k)
    forces[interface_->n_columns() + k] = v[interface_->n_columns() + k] * contact_.springs()[k];
  for (std::size_t i = 0; i < v.size(); ++i)
    forces[i] *= inverse_stiffness_[i];
  std::vector<double> z = part_of_rows(forces, true);
  sum_rows(z);
  contact_.apply_scaling(contact_part(z), true);
  return z;
}

void FetiDual::project(std::vector<double> &x, std::vector<double> loads, bool forces)
{
  coarse(forces).solve(loads);
  const std::vector<double> taken = rows_of_motions(loads, forces);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] -= taken[i];
}

/// From the preconditioned residual z at `multipliers` on, until the forces that it stands for are small.
void FetiDual::iterate(std::vector<double> &multipliers, std::vector<double> &z, double reduction, double target)
{
  const double limit = std::max(target, reduction * measure(z).norm);
  directions_.project(multipliers, z);
  for (int iteration = 0;; ++iteration)
  {
    Pull forces = measure(z);
    if (!(forces.norm > limit))
      return;
    if (iteration == max_iterations)
      throw LinearSolverFailure("the iteration over the subdomains' forces does not converge");
    ++n_iterations_;
    std::vector<double> p = z;
    project(p, std::move(forces.loads), true);
    Jump q = jump(flexibility(pull(p, true)), {});
    project(q.rows, std::move(q.loads), false);
    if (!directions_.add(std::move(p), precondition(std::move(q.rows)), multipliers, z))
      return;
  }
}

FetiStep FetiDual::solve_regular(std::span<const double> forces, std::span<const double> row_gaps, double reduction,
                                 double target)
{
  const std::vector<double> load = condense(forces);
  std::vector<double> alpha = kernel_loads(load), v;
  coarse(true).solve(alpha);
  std::vector<double> multipliers = rows_of_motions(alpha, true);

  const auto residual = [&](std::vector<double> &u)
  {
    std::vector<double> out = pull(multipliers, true);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = load[i] - out[i];
    u = flexibility(out);
    return jump(u, row_gaps);
  };
  Jump start = residual(v);
  project(start.rows, std::move(start.loads), false);
  std::vector<double> z = precondition(std::move(start.rows));
  iterate(multipliers, z, reduction, target);

  alpha = residual(v).loads;
  coarse(false).solve(alpha);
  for (double &a : alpha)
    a = -a;
  kernel_.expand_add(alpha, v);
  FetiStep step{expand(v), {}, {}};
  for (std::size_t i = 0; i < row_gaps.size(); ++i)
    step.rows.push_back(contact_.row_scale()[i] * multipliers[glue_.size() + i]);
  return step;
}
} // namespace amontons
