#include "amontons/algebra/feti_dual.h"

#include "amontons/algebra/linear_solver_failure.h"

#include <algorithm>
#include <cmath>

/// FetiDual: what changes with the bodies' values, and with the contact's rows.
namespace amontons
{
void FetiDual::update_bodies()
{
  agree_on_failures(setup_processes_, [&] { factorize_subdomains(); });
  interface_->update_shares();
  build_kernel();
  glue_ = interface_->glue();
  glue_gram_.clear();
  inverse_stiffness_ = interface_->inverse_stiffness();
  const Index first = interface_->first_own_column(), end = interface_->end_of_own_columns();
  double n = end - first;
  setup_processes_.sum_over_processes({&n, 1});
  mean_inverse_stiffness_ = 0;
  for (Index column = first; column < end; ++column)
    mean_inverse_stiffness_ += inverse_stiffness_[column] / (n + interface_->n_rigid());
  setup_processes_.sum_over_processes({&mean_inverse_stiffness_, 1});
  given_ = contact_ = {};
}

void FetiDual::factorize_subdomains()
{
  for (SubdomainFactor &factor : factors_)
  {
    factor.factorize();
    ++n_factorizations_;
  }
}

/// Own subdomains know their kernels; of others' come the rows of the columns that are known here.
void FetiDual::build_kernel()
{
  FetiCopies &copies = interface_->copies();
  const auto first_own = static_cast<std::size_t>(copies.first_own_subdomain());
  std::vector<double> sizes(static_cast<std::size_t>(copies.n_subdomains()), 0.0);
  for (std::size_t s = 0; s < factors_.size(); ++s)
    sizes[first_own + s] = static_cast<double>(factors_[s].kernel().cols());
  setup_processes_.sum_over_processes(sizes);
  std::vector<Eigen::MatrixXd> bases(sizes.size());
  for (std::size_t t = 0; t < bases.size(); ++t)
    bases[t] = t >= first_own && t - first_own < factors_.size()
                   ? factors_[t - first_own].kernel()
                   : Eigen::MatrixXd::Zero(interface_->first_of(t + 1) - interface_->first_of(t),
                                           static_cast<Eigen::Index>(sizes[t]));
  const int dim = interface_->dim(), width = 6 * dim;
  const auto rows = [&](const FetiCopy &copy)
  {
    Eigen::MatrixXd &basis = bases[copy.subdomain];
    return basis.middleRows(copy.column - interface_->first_of(copy.subdomain), dim);
  };
  copies.hand_over(
      width,
      [&](const FetiCopy &copy, double *values)
      {
        if (copy.column >= 0)
          Eigen::Map<Eigen::MatrixXd>(values, dim, bases[copy.subdomain].cols()) = rows(copy);
      },
      [&](const FetiCopy &copy, const double *values)
      {
        if (copy.column >= 0)
          rows(copy) = Eigen::Map<const Eigen::MatrixXd>(values, dim, bases[copy.subdomain].cols());
      });
  kernel_.clear();
  for (const Eigen::MatrixXd &basis : bases)
    kernel_.add_owner(basis);
  for (Index k = 0; k < interface_->n_rigid(); ++k)
    kernel_.add_owner(Eigen::MatrixXd::Ones(1, 1));
}

void FetiDual::set_couplings(const std::vector<std::span<const Index>> &nodal_sets,
                             const std::vector<std::span<const Index>> &rigid_sets)
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
    for (const std::span<const Index> unknowns : rigid_sets)
    {
      entries.clear();
      for (const Index unknown : unknowns)
        entries.emplace_back(interface_->rigid_column(unknown), 1);
      finish(entries);
    }
  };
  coarse_->set_pattern(couple, setup_processes_);
  glue_gram_ = coarse_->zeros();
  coarse_->add(glue_, glue_gram_, interface_->n_glue_rows_of_others());
  setup_processes_.sum_over_processes(glue_gram_);
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
  inverse_stiffness_.resize(static_cast<std::size_t>(interface_->n_columns()));
  for (const double spring : contact_.springs)
    inverse_stiffness_.push_back(1 / std::abs(spring));
  row_scale_.clear();
  for (Index row = 0; row < contact_.rows.size(); ++row)
  {
    double length2 = 0, plain = 0;
    for (const auto &[column, value] : contact_.rows[row])
    {
      length2 += value * value * inverse_stiffness_[column];
      plain += value * value * mean_inverse_stiffness_;
    }
    const double scale = 1 / std::sqrt(length2 > 0 ? length2 : plain);
    row_scale_.push_back(scale);
    contact_.rows.scale(row, scale);
    contact_.forces.scale(row, scale);
  }
}

void FetiDual::set_rows(FetiContactRows contact, const std::vector<std::vector<double>> &modes)
{
  if (setup_processes_.true_on_all(contact == given_ && modes == modes_))
    return;
  ++n_setups_;
  given_ = {};
  given_.symmetric = false; // differs from whatever comes, should this fail
  contact_ = contact;
  const Index of_others = interface_->n_glue_rows_of_others();
  directions_.start(glue_.size() + contact_.rows.size(), of_others,
                    glue_.size() - of_others + (counts_common() ? contact_.rows.size() : 0), processes_);
  agree_on_failures(setup_processes_, [&] { build_contact_problem(static_cast<Index>(modes.size())); });
  set_modes(modes);
  given_ = std::move(contact);
}

/// What depends on the contact rows, which all processes know: each for itself.
void FetiDual::build_contact_problem(Index n_modes)
{
  kernel_.drop_columns(interface_->n_columns());
  kernel_.add_columns(static_cast<Index>(contact_.springs.size()));
  scale_rows();
  build_scaling(contact_.rows, scaling_);
  std::vector<double> values = glue_gram_;
  coarse_->add(contact_.rows, values);
  singular_ = coarse_->factorize(std::move(values), n_modes);
  if (contact_.symmetric)
    return;
  build_scaling(contact_.forces, scaling_forces_);
  if (!coarse_forces_)
    coarse_forces_.emplace(session_, kernel_).copy_pattern(*coarse_);
  values = glue_gram_;
  coarse_forces_->add(contact_.forces, values);
  if (coarse_forces_->factorize(std::move(values), n_modes) != singular_)
    throw NumericalFailure("the tangent matrix is singular: friction holds a motion that contact does not, or turns");
}
} // namespace amontons
