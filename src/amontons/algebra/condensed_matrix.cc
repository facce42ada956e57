#include "amontons/algebra/condensed_matrix.h"

#include "amontons/algebra/linear_solver_failure.h"
#include "amontons/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace amontons
{
void CondensedMatrix::set_pins(std::vector<Index> rows)
{
  old_pins_.insert(old_pins_.end(), pins_.begin(), pins_.end());
  pins_ = std::move(rows);
  std::erase(pins_, -1);
}

void CondensedMatrix::find_mean_diagonal()
{
  std::array<double, 2> sum_and_count{};
  auto &[sum, n] = sum_and_count;
  for (const SubdomainMatrix &matrix : subdomains_)
    for (Index row = 0; row < matrix.n_rows(); ++row)
    {
      const auto begin = matrix.col.begin() + matrix.row_ptr[row], end = matrix.col.begin() + matrix.row_ptr[row + 1];
      sum += std::abs(matrix.values[std::lower_bound(begin, end, row) - matrix.col.begin()]);
      ++n;
    }
  layout_.sharing().sum_over_processes(sum_and_count);
  mean_diagonal_ = sum > 0 ? sum / n : 1;
}

void CondensedMatrix::prepare_columns(const ConstraintElimination &elimination)
{
  for (const Index nodal : indirect_)
    direct_[nodal] = blocks_.row(layout_.terms(nodal)[0].unknown);
  indirect_.clear();
  for (const Index row : fed_)
    feeding_[row].clear();
  fed_.clear();
  feeding_.resize(static_cast<std::size_t>(blocks_.n_rows()));
  for (const Index slave : elimination.slaves())
  {
    if (const Index nodal = blocks_.nodal_of_unknown(slave)[0]; direct_[nodal] >= 0)
    {
      direct_[nodal] = -1;
      indirect_.push_back(nodal);
    }
    for (const auto &[row, coefficient] : elimination.weights(slave))
    {
      feeding_[row].push_back({slave, coefficient});
      fed_.push_back(row);
    }
  }
}

bool CondensedMatrix::update(const ConstraintElimination &elimination, bool everything)
{
  if (everything)
    find_mean_diagonal();
  // Foreign blocks may be there that an elimination took in and that then failed.
  const bool grown = extend_fill(elimination) || blocks_.n_blocks() != blocks_.sharing().size();
  const bool rebuild = !layout_.sharing().true_on_all(pattern_stands_ && !grown);
  if (rebuild)
    blocks_.share_foreign();
  agree_on_failures(layout_.sharing(),
                    [&]
                    {
                      if (rebuild)
                        build_pattern();
                      make_values(elimination, everything || rebuild);
                    });
  return rebuild;
}

void CondensedMatrix::make_values(const ConstraintElimination &elimination, bool everything)
{
  prepare_columns(elimination);
  const int n = blocks_.block_size();
  if (everything)
    for (Index row = 0; row < blocks_.n_rows(); ++row)
      make_row(row, elimination);
  else
  {
    for (const Index block : affected_)
      for (int c = 0; c < n; ++c)
        make_row(block * n + c, elimination);
    for (const auto &pins : {old_pins_, pins_})
      for (const Index row : pins)
        make_row(row, elimination);
  }
  old_pins_.clear();
  for (const Index row : pins_)
  {
    const auto begin = matrix_.col.begin() + matrix_.row_ptr[row], end = matrix_.col.begin() + matrix_.row_ptr[row + 1];
    matrix_.values[std::lower_bound(begin, end, row) - matrix_.col.begin()] += mean_diagonal_;
  }
}

void CondensedMatrix::make_row(Index row, const ConstraintElimination &elimination)
{
  const Index begin = matrix_.row_ptr[row], end = matrix_.row_ptr[row + 1];
  std::fill(matrix_.values.begin() + begin, matrix_.values.begin() + end, 0.0);
  for (Index k = begin; k < end; ++k)
    place_[matrix_.col[k]] = k;
  const Index unknown = blocks_.unknown(row);
  if (unknown >= 0 && !elimination.is_slave(unknown))
    add_row_of(unknown, 1, elimination);
  else if (blocks_.is_own_row(row))
    matrix_.values[place_[row]] = mean_diagonal_;
  for (const Term &slave : feeding_[row])
    add_row_of(slave.unknown, slave.coefficient, elimination);
  for (Index k = begin; k < end; ++k)
    place_[matrix_.col[k]] = -1;
}

/// Calls emit(nodal column, value) for what the contacts' stiffness has in the row of a nodal component.
template<class Emit>
void CondensedMatrix::visit_contact_row(Index nodal, Emit &&emit) const
{
  for (const Index k : constraints_of_node_[nodal / blocks_.block_size()])
  {
    const Eigen::MatrixXd &stiffness = constraints_[k].stiffness;
    if (stiffness.size() == 0)
      continue;
    const auto begin = patterns_[k].nodal.begin(), end = patterns_[k].nodal.end();
    for (auto a = std::find(begin, end, nodal); a != end; a = std::find(a + 1, end, nodal))
      for (int b = 0; b < patterns_[k].n_nodal(); ++b)
        emit(patterns_[k].nodal[b], stiffness(a - begin, b));
  }
}

void CondensedMatrix::add_row_of(Index unknown, double weight, const ConstraintElimination &elimination)
{
  const int n = blocks_.block_size();
  for (const Index nodal : blocks_.nodal_of_unknown(unknown))
    for (const Term &term : layout_.terms(nodal))
    {
      if (term.unknown != unknown)
        continue;
      const double factor = weight * term.coefficient;
      for (const auto &[s, local] : blocks_.copies(nodal / n))
      {
        const SubdomainMatrix &matrix = subdomains_[s];
        const Index row = local * n + nodal % n;
        for (Index k = matrix.row_ptr[row]; k < matrix.row_ptr[row + 1]; ++k)
          add_nodal(matrix.nodes[matrix.col[k] / n] * n + matrix.col[k] % n, factor * matrix.values[k], elimination);
      }
      visit_contact_row(nodal, [&](Index column, double value) { add_nodal(column, factor * value, elimination); });
    }
  for (const Index d : counted_dense_)
    for (std::size_t i = 0; i < dense_unknowns_[d].size(); ++i)
      if (dense_unknowns_[d][i] == unknown)
        for (std::size_t j = 0; j < dense_unknowns_[d].size(); ++j)
          add_unknown(dense_unknowns_[d][j],
                      weight * dense_blocks_[d](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)),
                      elimination);
}

/// To the row that is being made.
void CondensedMatrix::add_at(Index column, double value)
{
  AMONTONS_ASSERT(place_[column] >= 0);
  matrix_.values[place_[column]] += value;
}

void CondensedMatrix::add_nodal(Index nodal, double value, const ConstraintElimination &elimination)
{
  if (const Index column = direct_[nodal]; column >= 0)
  {
    add_at(column, value);
    return;
  }
  for (const Term &term : layout_.terms(nodal))
    add_unknown(term.unknown, value * term.coefficient, elimination);
}

void CondensedMatrix::add_unknown(Index unknown, double value, const ConstraintElimination &elimination)
{
  if (!elimination.is_slave(unknown))
  {
    add_at(blocks_.row(unknown), value);
    return;
  }
  for (const auto &[row, coefficient] : elimination.motion(unknown))
    add_at(row, value * coefficient);
}

std::vector<double> CondensedMatrix::multiply(std::span<const double> motion) const
{
  std::vector<double> nodal(direct_.size(), 0.0), nodal_forces(direct_.size(), 0.0), forces(motion.size(), 0.0);
  for (Index i = 0; i < layout_.n_nodal(); ++i)
    for (const Term &term : layout_.terms(i))
      nodal[i] += term.coefficient * motion[term.unknown];
  for (const SubdomainMatrix &matrix : subdomains_)
    multiply_add(matrix, nodal, nodal_forces);
  for (std::size_t k = 0; k < constraints_.size(); ++k)
    if (const Eigen::MatrixXd &stiffness = constraints_[k].stiffness; stiffness.size() > 0)
      for (int a = 0; a < patterns_[k].n_nodal(); ++a)
        for (int b = 0; b < patterns_[k].n_nodal(); ++b)
          nodal_forces[patterns_[k].nodal[a]] += stiffness(a, b) * nodal[patterns_[k].nodal[b]];
  layout_.gather(nodal_forces, forces);
  for (const Index d : counted_dense_)
    for (std::size_t i = 0; i < dense_unknowns_[d].size(); ++i)
      for (std::size_t j = 0; j < dense_unknowns_[d].size(); ++j)
        forces[dense_unknowns_[d][i]] += dense_blocks_[d](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *
                                         motion[dense_unknowns_[d][j]];
  layout_.sharing().sum(forces);
  return forces;
}
} // namespace amontons
