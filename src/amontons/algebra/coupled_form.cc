#include "amontons/algebra/coupled_form.h"

#include "amontons/algebra/linear_solver_failure.h"

#include <algorithm>
#include <numeric>

namespace amontons
{
CoupledForm::CoupledForm(const Layout &layout, std::span<const SubdomainMatrix> subdomains,
                         std::unique_ptr<LinearSolver> solver)
  : layout_(layout)
  , subdomains_(subdomains)
  , solver_(std::move(solver))
{
}

/// Calls emit(row unknown, column unknown, factor, value) for every entry of the subdomains, always in the same order.
template<class Emit>
void CoupledForm::visit_subdomains(Emit &&emit) const
{
  for (const SubdomainMatrix &matrix : subdomains_)
  {
    const int n = matrix.n_components;
    const auto nodal = [&](Index local) { return matrix.nodes[local / n] * n + local % n; };
    for (Index row = 0; row < matrix.n_rows(); ++row)
      for (const Term &i : layout_.terms(nodal(row)))
        for (Index k = matrix.row_ptr[row]; k < matrix.row_ptr[row + 1]; ++k)
          for (const Term &j : layout_.terms(nodal(matrix.col[k])))
            emit(i.unknown, j.unknown, i.coefficient * j.coefficient, matrix.values[k]);
  }
}

/// Calls emit(row unknown, column unknown, factor, which block, row, column within the block).
template<class Emit>
void CoupledForm::visit_constraint(const ConstraintPattern &p, Emit &&emit) const
{
  for (int a = 0; a < p.n_nodal(); ++a)
    for (const Term &i : layout_.terms(p.nodal[a]))
    {
      for (int b = 0; b < p.n_nodal(); ++b)
        for (const Term &j : layout_.terms(p.nodal[b]))
          emit(i.unknown, j.unknown, i.coefficient * j.coefficient, 0, a, b);
      for (int m = 0; m < p.n_multipliers; ++m)
      {
        const Index multiplier = layout_.multiplier(p.multipliers[m]);
        emit(i.unknown, multiplier, i.coefficient, 1, a, m);
        emit(multiplier, i.unknown, i.coefficient, 2, m, a);
      }
    }
  for (int m = 0; m < p.n_multipliers; ++m)
    for (int k = 0; k < p.n_multipliers; ++k)
      emit(layout_.multiplier(p.multipliers[m]), layout_.multiplier(p.multipliers[k]), 1.0, 3, m, k);
}

void CoupledForm::set_constraints(std::vector<ConstraintPattern> constraints,
                                  std::vector<std::vector<Index>> dense_blocks)
{
  constraints_ = std::move(constraints);
  dense_blocks_ = std::move(dense_blocks);
  counts_dense_block_.clear();
  for (const auto &block : dense_blocks_)
    counts_dense_block_.push_back(!block.empty() && layout_.sharing().is_own(block.front()));
  pattern_built_ = false;
}

bool CoupledForm::set_held_modes(std::vector<std::vector<double>> modes)
{
  if (modes.empty() && modes_.empty())
    return false;
  modes_ = std::move(modes);
  pattern_built_ = false;
  return true;
}

void CoupledForm::build_pattern()
{
  std::vector<Index> rows, cols;
  const auto add = [&](Index i, Index j)
  {
    rows.push_back(i);
    cols.push_back(j);
  };
  visit_subdomains([&](Index i, Index j, double, double) { add(i, j); });
  constraint_offsets_.clear();
  for (std::size_t k = 0; k < constraints_.size(); ++k)
  {
    constraint_offsets_.push_back(rows.size());
    visit_constraint(constraints_[k], [&](Index i, Index j, double, int, int, int) { add(i, j); });
  }
  dense_offsets_.clear();
  for (std::size_t k = 0; k < dense_blocks_.size(); ++k)
  {
    dense_offsets_.push_back(rows.size());
    if (counts_dense_block_[k] != 0)
      for (const Index i : dense_blocks_[k])
        for (const Index j : dense_blocks_[k])
          add(i, j);
  }
  entries_.assign(rows.size(), 0);
  for (std::size_t m = 0; m < modes_.size(); ++m)
  {
    const Index border = layout_.n_unknowns() + static_cast<Index>(m);
    for (Index i = 0; i < layout_.n_displacement_unknowns(); ++i)
      if (modes_[m][i] != 0 && layout_.sharing().is_own(i))
      {
        add(i, border);
        add(border, i);
        entries_.insert(entries_.end(), 2, modes_[m][i]);
      }
  }
  positions_ = make_pattern(matrix_, layout_.n_unknowns() + static_cast<Index>(modes_.size()), rows, cols);
}

/// Multipliers are numbered behind the unknowns, process after process, held modes behind these.
void CoupledForm::share_rows()
{
  const Sharing &unknowns = layout_.sharing();
  if (!unknowns.is_distributed())
  {
    rows_ = Sharing(matrix_.n_rows());
    return;
  }
  std::vector<double> n_multipliers(static_cast<std::size_t>(unknowns.n_processes()), 0.0);
  n_multipliers[unknowns.rank()] = layout_.n_multipliers();
  unknowns.sum_over_processes(n_multipliers);
  const auto counted = [&](auto end)
  { return static_cast<GlobalIndex>(std::accumulate(n_multipliers.begin(), end, 0.0)); };
  const GlobalIndex first = unknowns.n_global() + counted(n_multipliers.begin() + unknowns.rank()),
                    border = unknowns.n_global() + counted(n_multipliers.end());
  std::vector<GlobalIndex> ids;
  std::vector<char> preferred(static_cast<std::size_t>(matrix_.n_rows()), 0);
  for (Index i = 0; i < unknowns.size(); ++i)
  {
    ids.push_back(unknowns.number(i));
    preferred[i] = unknowns.is_own(i);
  }
  for (Index m = 0; m < layout_.n_multipliers(); ++m)
    ids.push_back(first + m);
  for (std::size_t m = 0; m < modes_.size(); ++m)
    ids.push_back(border + static_cast<GlobalIndex>(m));
  rows_ = Sharing(unknowns.messages(), "linear system", ids, preferred);
}

bool CoupledForm::prepare()
{
  if (pattern_built_)
    return false;
  agree_on_failures(layout_.sharing(), [&] { build_pattern(); });
  share_rows();
  solver_->set_matrix(matrix_, rows_);
  pattern_built_ = true;
  return true;
}

void CoupledForm::update_subdomains()
{
  std::size_t k = 0;
  visit_subdomains([&](Index, Index, double factor, double value) { entries_[k++] = factor * value; });
}

void CoupledForm::update_constraint(std::size_t constraint, const ConstraintValues &v)
{
  std::size_t k = constraint_offsets_[constraint];
  const std::array<const Eigen::Ref<const Eigen::MatrixXd> *, 4> blocks{
      &v.stiffness, &v.force_by_multiplier, &v.constraint_by_position, &v.constraint_by_multiplier};
  visit_constraint(constraints_[constraint], [&](Index, Index, double factor, int block, int i, int j)
                   { entries_[k++] = factor * (*blocks[block])(i, j); });
}

void CoupledForm::update_dense_block(std::size_t block, const Eigen::MatrixXd &values)
{
  if (counts_dense_block_[block] == 0)
    return;
  std::size_t k = dense_offsets_[block];
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (Eigen::Index j = 0; j < values.cols(); ++j)
      entries_[k++] = values(i, j);
}

void CoupledForm::factorize()
{
  std::fill(matrix_.values.begin(), matrix_.values.end(), 0.0);
  for (std::size_t k = 0; k < entries_.size(); ++k)
    matrix_.values[positions_[k]] += entries_[k];
  solver_->factorize();
}

void CoupledForm::solve(std::span<const double> rhs, std::span<double> solution, double /*tolerance*/)
{
  if (modes_.empty())
  {
    solver_->solve(rhs, solution, 0);
    mode_reactions_.clear();
    return;
  }
  std::vector<double> b(rhs.begin(), rhs.end()), x(rhs.size() + modes_.size());
  b.resize(x.size(), 0.0);
  solver_->solve(b, x, 0);
  std::copy_n(x.begin(), solution.size(), solution.begin());
  mode_reactions_.assign(x.begin() + static_cast<std::ptrdiff_t>(solution.size()), x.end());
}

FormCounters CoupledForm::counters() const
{
  return {solver_->n_pattern_builds(), solver_->n_factorizations(), 0, solver_->n_iterations()};
}
} // namespace amontons
