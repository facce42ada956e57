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
  forget_given();
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
  const std::set<std::vector<Index>> couplings = contact_couplings(nodal_sets, rigid_sets);
  coarse_.emplace(session_, kernel_);
  coarse_forces_.reset();
  coarse_->set_pattern(
      [&](const std::function<void(std::span<const Index>)> &take)
      {
        for (Index row = 0; row < glue_.size(); ++row)
          take(kernel_.owners_of(glue_[row]));
        for (const std::vector<Index> &owners : couplings)
          take(owners);
      },
      setup_processes_);
  find_contact_entries(couplings);
  glue_gram_ = coarse_->zeros();
  std::vector<FetiRows::Entry> g;
  for (Index row = interface_->n_glue_rows_of_others(); row < glue_.size(); ++row)
  {
    kernel_.restrict_row(glue_[row], g);
    coarse_->add(g, glue_gram_);
  }
  setup_processes_.sum_over_processes(glue_gram_);
  forget_given();
}

/// Sets of owners that contact rows of this process may couple.
std::set<std::vector<Index>> FetiDual::contact_couplings(const std::vector<std::span<const Index>> &nodal_sets,
                                                         const std::vector<std::span<const Index>> &rigid_sets) const
{
  std::set<std::vector<Index>> out;
  std::vector<FetiRows::Entry> entries;
  for (const std::span<const Index> nodal : nodal_sets)
  {
    entries.clear();
    for (const Index i : nodal)
      interface_->append(i, 1, entries);
    out.insert(kernel_.owners_of(entries));
  }
  for (const std::span<const Index> unknowns : rigid_sets)
  {
    entries.clear();
    for (const Index unknown : unknowns)
      entries.emplace_back(interface_->rigid_column(unknown), 1);
    out.insert(kernel_.owners_of(entries));
  }
  return out;
}

/// Entries of G^T G that contact rows of any process may change.
void FetiDual::find_contact_entries(const std::set<std::vector<Index>> &couplings)
{
  std::vector<double> touched = coarse_->zeros();
  std::vector<FetiRows::Entry> g;
  for (const std::vector<Index> &owners : couplings)
  {
    g.clear();
    for (const Index owner : owners)
      for (Index k = 0; k < kernel_.size(owner); ++k)
        g.emplace_back(kernel_.first(owner) + k, 1);
    coarse_->add(g, touched);
  }
  setup_processes_.sum_over_processes(touched);
  contact_entries_.clear();
  for (std::size_t k = 0; k < touched.size(); ++k)
    if (touched[k] > 0)
      contact_entries_.push_back(static_cast<Index>(k));
}

/// What comes next differs from what was given.
void FetiDual::forget_given()
{
  given_ = {};
  given_.symmetric = false;
}

void FetiDual::set_rows(FetiContactRows contact, const std::vector<std::vector<double>> &modes)
{
  if (setup_processes_.true_on_all(contact == given_ && modes == modes_))
    return;
  ++n_setups_;
  forget_given(); // should this fail
  inverse_stiffness_.resize(static_cast<std::size_t>(interface_->n_columns()));
  for (const double spring : contact.springs)
    inverse_stiffness_.push_back(1 / std::abs(spring));
  kernel_.drop_columns(interface_->n_columns());
  kernel_.add_columns(static_cast<Index>(contact.springs.size()));
  contact_.set(contact, inverse_stiffness_, mean_inverse_stiffness_);
  const Index of_others = interface_->n_glue_rows_of_others();
  directions_.start(glue_.size() + contact_.size(), of_others, glue_.size() - of_others + contact_.n_own(), processes_);
  factorize_coarse(static_cast<Index>(modes.size()));
  set_modes(modes);
  given_ = std::move(contact);
}

/// G^T G, or G_f^T G_f, of all processes' rows.
std::vector<double> FetiDual::gram(bool forces) const
{
  std::vector<double> values = coarse_->zeros(), of_contact;
  for (Index row = 0; row < contact_.n_own(); ++row)
    coarse_->add(contact_.motions(forces)[row], values);
  for (const Index k : contact_entries_)
    of_contact.push_back(values[k]);
  setup_processes_.sum_over_processes(of_contact);
  values = glue_gram_;
  for (std::size_t k = 0; k < of_contact.size(); ++k)
    values[contact_entries_[k]] += of_contact[k];
  return values;
}

void FetiDual::factorize_coarse(Index n_modes)
{
  std::vector<double> values = gram(false);
  agree_on_failures(setup_processes_, [&] { singular_ = coarse_->factorize(std::move(values), n_modes); });
  if (contact_.is_symmetric())
    return;
  if (!coarse_forces_)
    coarse_forces_.emplace(session_, kernel_).copy_pattern(*coarse_);
  values = gram(true);
  agree_on_failures(setup_processes_,
                    [&]
                    {
                      if (coarse_forces_->factorize(std::move(values), n_modes) != singular_)
                        throw NumericalFailure(
                            "the tangent matrix is singular: friction holds a motion that contact does not, or turns");
                    });
}
} // namespace amontons
