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
  , interface_(std::make_unique<FetiInterface>(layout, subdomains, options_))
{
  factors_.reserve(subdomains.size());
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    factors_.emplace_back(session_, subdomains[s], interface_->boundary(s), interface_->motions(s));
  local_.resize(static_cast<std::size_t>(interface_->n_local()));
  rigid_.resize(static_cast<std::size_t>(interface_->n_rigid()));
}

void FetiDual::update_bodies()
{
  interface_->update_shares();
  kernel_.clear();
  for (SubdomainFactor &factor : factors_)
  {
    factor.factorize();
    ++n_factorizations_;
    kernel_.add_owner(factor.kernel());
  }
  for (Index k = 0; k < interface_->n_rigid(); ++k)
    kernel_.add_owner(Eigen::MatrixXd::Ones(1, 1));
  glue_ = interface_->glue();
  glue_gram_.clear();
  given_ = contact_ = {};
  directions_.clear();
}

void FetiDual::set_couplings(const std::vector<std::span<const Index>> &nodal_sets)
{
  coarse_.emplace(session_, kernel_);
  coarse_forces_.reset();
  const auto couple = [&](const std::function<void(std::span<const Index>)> &take)
  {
    std::vector<Index> owners;
    const auto finish = [&](auto &&entries)
    {
      owners.clear();
      for (const auto &[column, coefficient] : entries)
        if (const Index owner = kernel_.owner(column); owner >= 0)
          owners.push_back(owner);
      std::sort(owners.begin(), owners.end());
      owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
      take(owners);
    };
    for (Index row = 0; row < glue_.size(); ++row)
      finish(glue_[row]);
    std::vector<FetiRows::Entry> entries;
    for (const std::span<const Index> nodal : nodal_sets)
    {
      entries.clear();
      for (const Index i : nodal)
        interface_->append(i, 1, entries);
      finish(entries);
    }
  };
  coarse_->set_pattern(couple);
  glue_gram_ = coarse_->zeros();
  coarse_->add(glue_, glue_gram_);
  given_ = {};
  given_.symmetric = false; // differs from whatever comes
}

void FetiDual::build_scaling(const FetiRows &rows, Scaling &scaling)
{
  scaling.factor.reset();
  if (rows.size() == 0)
    return;
  std::vector<std::vector<std::pair<Index, double>>> rows_of(static_cast<std::size_t>(n_columns()));
  SymmetricPattern pattern;
  std::vector<double> values, sum(static_cast<std::size_t>(rows.size()), 0.0);
  std::vector<Index> touched;
  for (Index j = 0; j < rows.size(); ++j)
  {
    touched.assign(1, j);
    for (const auto &[column, value] : rows[j])
    {
      rows_of[column].emplace_back(j, value);
      for (const auto &[i, other] : rows_of[column])
      {
        if (sum[i] == 0 && i != j)
          touched.push_back(i);
        sum[i] += value * other * inverse_stiffness_[column];
      }
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const Index i : touched)
    {
      pattern.rows.push_back(i);
      // Rows that only rigid motions tell apart leave the sum semidefinite.
      values.push_back(i == j ? (1 + 1e-6) * sum[i] : sum[i]);
      sum[i] = 0;
    }
    pattern.offsets.push_back(static_cast<Index>(pattern.rows.size()));
  }
  scaling.factor.emplace(session_);
  scaling.factor->analyze(pattern);
  if (!scaling.factor->factorize(pattern, values))
    throw NumericalFailure("the tangent matrix is singular: contact rows depend on each other");
}

/// Gives every contact row length one in the inner product of D^-1.
void FetiDual::scale_rows()
{
  inverse_stiffness_ = interface_->inverse_stiffness();
  double mean = 0;
  for (const double x : inverse_stiffness_)
    mean += x / static_cast<double>(inverse_stiffness_.size());
  for (const double spring : contact_.springs)
    inverse_stiffness_.push_back(1 / std::abs(spring));
  row_scale_.clear();
  for (Index row = 0; row < contact_.rows.size(); ++row)
  {
    double length2 = 0, plain = 0;
    for (const auto &[column, value] : contact_.rows[row])
    {
      length2 += value * value * inverse_stiffness_[column];
      plain += value * value * mean;
    }
    const double scale = 1 / std::sqrt(length2 > 0 ? length2 : plain);
    row_scale_.push_back(scale);
    contact_.rows.scale(row, scale);
    contact_.forces.scale(row, scale);
  }
}

void FetiDual::set_rows(FetiContactRows contact, const std::vector<std::vector<double>> &modes)
{
  if (contact == given_ && modes == modes_)
    return;
  ++n_setups_;
  given_ = contact;
  contact_ = std::move(contact);
  directions_.clear();
  kernel_.drop_columns(interface_->n_columns());
  kernel_.add_columns(static_cast<Index>(contact_.springs.size()));
  scale_rows();
  build_scaling(contact_.rows, scaling_);
  std::vector<double> values = glue_gram_;
  coarse_->add(contact_.rows, values);
  const auto n_modes = static_cast<Index>(modes.size());
  singular_ = coarse_->factorize(std::move(values), n_modes);
  if (!contact_.symmetric)
  {
    build_scaling(contact_.forces, scaling_forces_);
    if (!coarse_forces_)
      coarse_forces_.emplace(session_, kernel_).copy_pattern(*coarse_);
    values = glue_gram_;
    coarse_forces_->add(contact_.forces, values);
    if (coarse_forces_->factorize(std::move(values), n_modes) != singular_)
      throw NumericalFailure("the tangent matrix is singular: friction holds a motion that contact does not, or turns");
  }
  set_modes(modes);
}

/// Forces on unknowns to the columns of B; leaves the copies' forces in local_.
std::vector<double> FetiDual::condense(std::span<const double> forces)
{
  interface_->distribute(forces, local_, rigid_);
  std::vector<double> out(static_cast<std::size_t>(n_columns()), 0.0);
  for (std::size_t s = 0; s < factors_.size(); ++s)
    factors_[s].condense(
        {local_.data() + interface_->first_local(s), static_cast<std::size_t>(subdomains_[s].n_rows())},
        out.data() + interface_->first_column(s));
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

std::vector<double> FetiDual::gaps(std::span<const double> v, bool forces) const
{
  const FetiRows &contact = forces ? contact_.forces : contact_.rows;
  std::vector<double> out(static_cast<std::size_t>(glue_.size() + contact.size()));
  glue_.multiply(v, out.data());
  contact.multiply(v, out.data() + glue_.size());
  return out;
}

std::vector<double> FetiDual::pull(std::span<const double> multipliers, bool forces) const
{
  std::vector<double> out(static_cast<std::size_t>(n_columns()), 0.0);
  glue_.multiply_transposed_add(multipliers.data(), out);
  (forces ? contact_.forces : contact_.rows).multiply_transposed_add(multipliers.data() + glue_.size(), out);
  return out;
}

std::vector<double> FetiDual::flexibility(std::span<const double> v) const
{
  std::vector<double> out(v.size(), 0.0);
  for (std::size_t s = 0; s < factors_.size(); ++s)
    factors_[s].apply_flexibility(v.data() + interface_->first_column(s), out.data() + interface_->first_column(s));
  for (std::size_t k = 0; k < contact_.springs.size(); ++k)
    out[interface_->n_columns() + k] = v[interface_->n_columns() + k] / contact_.springs[k];
  return out;
}

std::vector<double> FetiDual::precondition(std::vector<double> r)
{
  const auto contact_part = [&](std::vector<double> &x) { return std::span(x).subspan(glue_.size()); };
  if (scaling_.factor)
    scaling_.factor->solve(contact_part(r));
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
  for (std::size_t k = 0; k < contact_.springs.size(); ++k)
    forces[interface_->n_columns() + k] = v[interface_->n_columns() + k] * contact_.springs[k];
  for (std::size_t i = 0; i < v.size(); ++i)
    forces[i] *= inverse_stiffness_[i];
  std::vector<double> z = gaps(forces, true);
  if (Scaling &scaling = contact_.symmetric ? scaling_ : scaling_forces_; scaling.factor)
    scaling.factor->solve(contact_part(z));
  return z;
}

void FetiDual::project(std::vector<double> &x, bool forces)
{
  std::vector<double> alpha(static_cast<std::size_t>(kernel_.size())), v(static_cast<std::size_t>(n_columns()), 0.0);
  kernel_.restrict(pull(x, forces), alpha);
  coarse(forces).solve(alpha);
  kernel_.expand_add(alpha, v);
  const std::vector<double> taken = gaps(v, forces);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] -= taken[i];
}

/// From the preconditioned residual z at `multipliers` on, until the forces that it stands for are small.
void FetiDual::iterate(std::vector<double> &multipliers, std::vector<double> &z, double reduction, double target)
{
  const auto force_norm = [&]
  {
    double sum = 0;
    for (const double x : pull(z, true))
      sum += x * x;
    return std::sqrt(sum);
  };
  const double limit = std::max(target, reduction * force_norm());
  directions_.project(multipliers, z);
  for (int iteration = 0; force_norm() > limit; ++iteration)
  {
    if (iteration == max_iterations)
      throw LinearSolverFailure("the iteration over the subdomains' forces does not converge");
    ++n_iterations_;
    std::vector<double> p = z;
    project(p, true);
    std::vector<double> q = gaps(flexibility(pull(p, true)));
    project(q, false);
    if (!directions_.add(std::move(p), precondition(std::move(q)), multipliers, z))
      return;
  }
}

FetiStep FetiDual::solve_regular(std::span<const double> forces, std::span<const double> row_gaps, double reduction,
                                 double target)
{
  const std::vector<double> load = condense(forces);
  std::vector<double> alpha(static_cast<std::size_t>(kernel_.size())), v(load.size(), 0.0);
  kernel_.restrict(load, alpha);
  coarse(true).solve(alpha);
  kernel_.expand_add(alpha, v);
  std::vector<double> multipliers = gaps(v, true);

  const auto residual = [&](std::vector<double> &u)
  {
    std::vector<double> out = pull(multipliers, true);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = load[i] - out[i];
    u = flexibility(out);
    out = gaps(u);
    for (std::size_t i = 0; i < row_gaps.size(); ++i)
      out[glue_.size() + i] -= row_scale_[i] * row_gaps[i];
    return out;
  };
  std::vector<double> z = residual(v);
  project(z, false);
  z = precondition(std::move(z));
  iterate(multipliers, z, reduction, target);

  kernel_.restrict(pull(residual(v), false), alpha);
  coarse(false).solve(alpha);
  for (double &a : alpha)
    a = -a;
  kernel_.expand_add(alpha, v);
  FetiStep step{expand(v), {}, {}};
  for (std::size_t i = 0; i < row_gaps.size(); ++i)
    step.rows.push_back(row_scale_[i] * multipliers[glue_.size() + i]);
  return step;
}
} // namespace amontons
