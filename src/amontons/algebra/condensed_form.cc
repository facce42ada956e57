#include "amontons/algebra/condensed_form.h"

#include "amontons/algebra/linear_solver_failure.h"
#include "amontons/algebra/rigid_modes.h"
#include "amontons/base/error.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
/// A row over the element's positions as a row over the unknowns.
template<class Row>
std::vector<Term> over_unknowns(const Layout &layout, const ConstraintPattern &pattern, const Row &row)
{
  std::vector<Term> out;
  for (int a = 0; a < pattern.n_nodal(); ++a)
    if (row[a] != 0)
      for (const Term &term : layout.terms(pattern.nodal[a]))
        out.push_back({term.unknown, row[a] * term.coefficient});
  return out;
}

bool same(const ConstraintRows &a, const ConstraintRows &b)
{
  return a.rows.rows() == b.rows.rows() && a.rows.cols() == b.rows.cols() && a.stiffness.rows() == b.stiffness.rows() &&
         a.rows == b.rows && a.forces == b.forces && a.stiffness == b.stiffness;
}
} // namespace

CondensedForm::CondensedForm(const Layout &layout, std::span<const SubdomainMatrix> subdomains,
                             std::unique_ptr<LinearSolver> solver, const std::vector<double> &reference)
  : layout_(layout)
  , solver_(std::move(solver))
  , reference_(reference)
  , matrix_(layout, subdomains)
{
}

void CondensedForm::set_constraints(std::vector<ConstraintPattern> constraints,
                                    std::vector<std::vector<Index>> dense_blocks)
{
  patterns_ = std::move(constraints);
  rows_.assign(patterns_.size(), {});
  refused_.clear();
  augmentation_.assign(patterns_.size(), 0);
  dense_unknowns_ = std::move(dense_blocks);
  dense_blocks_.clear();
  for (const auto &unknowns : dense_unknowns_)
    dense_blocks_.emplace_back(
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(unknowns.size()), static_cast<Eigen::Index>(unknowns.size())));
  matrix_.set_constraints(patterns_, rows_, dense_unknowns_, dense_blocks_);
  prepared_ = false;
  constraints_changed_ = true;
}

bool CondensedForm::set_held_modes(std::vector<std::vector<double>> modes)
{
  if (modes.empty() && modes_.empty())
    return false;
  modes_ = std::move(modes);
  modes_changed_ = true;
  return true;
}

bool CondensedForm::prepare()
{
  return !std::exchange(prepared_, true);
}

/// What one process alone is given must not throw here: factorize() does, on all.
void CondensedForm::update_constraint(std::size_t k, const ConstraintValues &values)
{
  try
  {
    ConstraintRows rows = reduce_constraint(values);
    constraints_changed_ |= !same(rows, rows_[k]);
    rows_[k] = std::move(rows);
    refused_.erase(k);
  }
  catch (const NumericalFailure &)
  {
    refused_[k] = std::current_exception();
    constraints_changed_ = true;
  }
  augmentation_[k] = values.augmentation;
}

void CondensedForm::update_dense_block(std::size_t k, const Eigen::MatrixXd &values)
{
  constraints_changed_ |= values != dense_blocks_[k];
  dense_blocks_[k] = values;
}

void CondensedForm::eliminate()
{
  agree_on_failures(layout_.sharing(),
                    [&]
                    {
                      if (!refused_.empty())
                        std::rethrow_exception(refused_.begin()->second);
                    });
  bool symmetric = true;
  const int n = matrix_.blocks().block_size();
  std::vector<RowGroup> groups(rows_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k)
  {
    symmetric = symmetric && rows_[k].symmetric;
    for (Eigen::Index r = 0; r < rows_[k].n_rows(); ++r)
    {
      groups[k].positions.push_back(over_unknowns(layout_, patterns_[k], rows_[k].rows.row(r)));
      groups[k].forces.push_back(over_unknowns(layout_, patterns_[k], rows_[k].forces.col(r)));
    }
    for (int a = 0; a < std::min(n, patterns_[k].n_nodal()); ++a)
      for (const Term &term : layout_.terms(patterns_[k].nodal[a]))
        if (!matrix_.blocks().is_shared(term.unknown) && layout_.sharing().is_own(term.unknown))
          groups[k].own.push_back(term.unknown);
  }
  elimination_.compute(layout_.sharing(), matrix_.blocks(), groups, layout_.sharing().true_on_all(symmetric));
}

/// The unknown that moves most, of equal ones that of the lowest number, the same on all processes. @return -1 for
/// another process's
Index CondensedForm::choose_pin(std::span<const double> mode) const
{
  const Sharing &unknowns = layout_.sharing();
  Index best = -1;
  for (Index i = 0; i < unknowns.size(); ++i)
    if (unknowns.is_own(i) && (best < 0 || std::abs(mode[i]) > std::abs(mode[best])))
      best = i;
  const double most = unknowns.maximum_over_processes(best < 0 ? 0 : std::abs(mode[best]));
  const bool is_candidate = best >= 0 && std::abs(mode[best]) == most;
  const auto number = static_cast<double>(is_candidate ? unknowns.number(best) : unknowns.n_global());
  const double lowest = -unknowns.maximum_over_processes(-number);
  return is_candidate && number == lowest ? best : -1;
}

/// As many unknowns as there are modes, on which the modes are independent: the largest ones left, one after the other.
void CondensedForm::place_pins()
{
  pins_.clear();
  std::vector<std::vector<double>> rest;
  for (const auto &mode : modes_)
  {
    AMONTONS_ASSERT(mode.size() == static_cast<std::size_t>(layout_.n_displacement_unknowns()));
    rest.push_back(mode);
    for (Index i = 0; i < layout_.n_displacement_unknowns(); ++i)
      if (elimination_.is_slave(i))
        rest.back()[i] = 0;
  }
  for (std::size_t m = 0; m < rest.size(); ++m)
  {
    const Index pin = choose_pin(rest[m]);
    std::vector<double> at_pin(rest.size(), 0.0);
    for (std::size_t k = m; k < rest.size() && pin >= 0; ++k)
      at_pin[k] = rest[k][pin];
    layout_.sharing().sum_over_processes(at_pin);
    if (at_pin[m] == 0)
      throw NumericalFailure("the tangent matrix is singular: the motions to be held depend on each other");
    for (std::size_t k = m + 1; k < rest.size(); ++k)
    {
      const double factor = at_pin[k] / at_pin[m];
      for (std::size_t i = 0; i < rest[k].size(); ++i)
        rest[k][i] -= factor * rest[m][i];
    }
    pins_.push_back(pin < 0 ? -1 : matrix_.blocks().row(pin));
  }
  matrix_.set_pins(pins_);
}

void CondensedForm::set_smooth_modes()
{
  auto modes = rigid_modes(layout_, matrix_.blocks(), reference_);
  for (auto &mode : modes)
    for (const Index slave : elimination_.slaves())
      mode[matrix_.blocks().row(slave)] = 0;
  solver_->set_smooth_modes(std::move(modes));
}

void CondensedForm::factorize()
{
  constraints_changed_ = !layout_.sharing().true_on_all(!constraints_changed_);
  if (!subdomains_changed_ && !constraints_changed_ && !modes_changed_)
    return;
  if (subdomains_changed_ || constraints_changed_)
    eliminate();
  if (modes_changed_ || !modes_.empty())
    place_pins();
  if (matrix_.update(elimination_, subdomains_changed_))
    solver_->set_matrix(matrix_.matrix(), matrix_.blocks().sharing());
  if (solver_->wants_smooth_modes())
    set_smooth_modes();
  subdomains_changed_ = constraints_changed_ = modes_changed_ = true; // should it fail
  solver_->factorize();
  subdomains_changed_ = constraints_changed_ = modes_changed_ = false;
}

FormCounters CondensedForm::counters() const
{
  return {solver_->n_pattern_builds(), solver_->n_factorizations(), solver_->n_preconditioner_setups(),
          solver_->n_iterations()};
}
} // namespace amontons
