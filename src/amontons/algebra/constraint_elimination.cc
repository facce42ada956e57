#include "amontons/algebra/constraint_elimination.h"

#include "amontons/algebra/linear_solver_failure.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <map>

namespace amontons
{
namespace
{
/// Least part of a row's largest coefficient (and force) that a slave of the impactor node must have.
constexpr double local_pivot = 0.1;

using DenseRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Rows of a constraint over its distinct unknowns, with their units: [C | I].
struct LocalRows
{
  LocalRows(const std::vector<std::vector<Term>> &rows, const std::vector<Index> &unknowns)
  {
    const auto n = static_cast<Eigen::Index>(rows.size()), m = static_cast<Eigen::Index>(unknowns.size());
    values = DenseRows::Zero(n, m + n);
    for (Eigen::Index r = 0; r < n; ++r)
    {
      for (const Term &term : rows[r])
        values(r, std::lower_bound(unknowns.begin(), unknowns.end(), term.unknown) - unknowns.begin()) +=
            term.coefficient;
      values(r, m + r) = 1;
    }
    scale = values.leftCols(m).cwiseAbs().rowwise().maxCoeff();
  }
  void eliminate(Eigen::Index row, Eigen::Index col)
  {
    values.row(row) /= values(row, col);
    for (Eigen::Index r = 0; r < values.rows(); ++r)
      if (r != row && values(r, col) != 0)
        values.row(r) -= values(r, col) * values.row(row).eval();
  }
  DenseRows values;
  Eigen::VectorXd scale;
};

std::vector<Index> distinct_unknowns(const RowGroup &group)
{
  std::vector<Index> out;
  for (const auto *side : {&group.positions, &group.forces})
    for (const auto &row : *side)
      for (const Term &term : row)
        out.push_back(term.unknown);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}
} // namespace

void ConstraintElimination::count_users(const Sharing &unknowns, std::span<const RowGroup> groups)
{
  n_users_.assign(static_cast<std::size_t>(unknowns.size()), 0);
  for (const RowGroup &group : groups)
    if (!group.positions.empty())
      for (const Index unknown : distinct_unknowns(group))
        ++n_users_[unknown];
  unknowns.sum(n_users_);
}

void ConstraintElimination::add_slave(Index unknown, Expansion motion, Expansion weights)
{
  position_of_[unknown] = static_cast<Index>(slaves_.size());
  slaves_.push_back(unknown);
  motion_.push_back(std::move(motion));
  if (!symmetric_)
    weights_.push_back(std::move(weights));
}

bool ConstraintElimination::eliminate_locally(const NodeBlocks &blocks, const RowGroup &group, Index first_row)
{
  const std::vector<Index> unknowns = distinct_unknowns(group);
  const auto n = static_cast<Eigen::Index>(group.positions.size()), m = static_cast<Eigen::Index>(unknowns.size());
  std::vector<Eigen::Index> candidates;
  for (Eigen::Index k = 0; k < m; ++k)
    if (n_users_[unknowns[k]] == 1 && std::find(group.own.begin(), group.own.end(), unknowns[k]) != group.own.end())
      candidates.push_back(k);
  if (static_cast<Eigen::Index>(candidates.size()) < n)
    return false;
  LocalRows c(group.positions, unknowns), f(group.forces, unknowns);
  std::vector<Eigen::Index> slave(static_cast<std::size_t>(n), -1);
  for (Eigen::Index step = 0; step < n; ++step)
  {
    double best = local_pivot;
    Eigen::Index best_row = -1, best_col = -1;
    for (Eigen::Index row = 0; row < n; ++row)
      for (const Eigen::Index col : candidates)
        if (const double share =
                std::min(std::abs(c.values(row, col)) / c.scale[row], std::abs(f.values(row, col)) / f.scale[row]);
            slave[row] < 0 && std::find(slave.begin(), slave.end(), col) == slave.end() && share > best)
        {
          best = share;
          best_row = row;
          best_col = col;
        }
    if (best_row < 0)
      return false;
    slave[best_row] = best_col;
    c.eliminate(best_row, best_col);
    f.eliminate(best_row, best_col);
  }
  const auto expansion = [&](const LocalRows &rows, Eigen::Index row)
  {
    Expansion out;
    for (Eigen::Index k = 0; k < m; ++k)
      if (rows.values(row, k) != 0 && std::find(slave.begin(), slave.end(), k) == slave.end())
        out.of_rows.push_back({blocks.row(unknowns[k]), -rows.values(row, k)});
    for (Eigen::Index k = 0; k < n; ++k)
      if (rows.values(row, m + k) != 0)
        out.of_constraints.push_back({first_row + static_cast<Index>(k), rows.values(row, m + k)});
    return out;
  };
  for (Eigen::Index row = 0; row < n; ++row)
    add_slave(unknowns[slave[row]], expansion(c, row), expansion(f, row));
  return true;
}

/// @return rows of constraints that do not allow it
std::vector<EntangledRow> ConstraintElimination::eliminate_groups(const Sharing &unknowns, const NodeBlocks &blocks,
                                                                  std::span<const RowGroup> groups)
{
  const auto whole = [&](Index unknown) {
    return WholeUnknown{unknowns.number(unknown), blocks.number(blocks.row(unknown))};
  };
  const auto over_whole = [&](const std::vector<Term> &terms)
  {
    std::vector<WholeTerm> out;
    for (const Term &term : terms)
      out.push_back({whole(term.unknown), term.coefficient});
    return out;
  };
  std::vector<EntangledRow> entangled;
  for (const RowGroup &group : groups)
  {
    if (!group.positions.empty() && !eliminate_locally(blocks, group, n_rows_))
      for (std::size_t r = 0; r < group.positions.size(); ++r)
      {
        entangled_.push_back(n_rows_ + static_cast<Index>(r));
        EntangledRow &row =
            entangled.emplace_back(EntangledRow{over_whole(group.positions[r]), over_whole(group.forces[r]), {}});
        for (const Index unknown : group.own)
          row.own.push_back(whole(unknown));
      }
    n_rows_ += static_cast<Index>(group.positions.size());
  }
  return entangled;
}

ConstraintElimination::Expansion ConstraintElimination::local(NodeBlocks &blocks, const WholeExpansion &whole) const
{
  Expansion out;
  for (const WholeTerm &term : whole.of_unknowns)
    out.of_rows.push_back({blocks.take_row(term.unknown.row), term.coefficient});
  for (const auto &[row, coefficient] : whole.of_rows)
    out.of_constraints.push_back({entangled_[row], coefficient});
  return out;
}

/// Those with a copy here. @return their positions among the resolved ones
std::vector<std::size_t> ConstraintElimination::take_resolved(NodeBlocks &blocks,
                                                              std::span<const ResolvedSlave> resolved)
{
  std::vector<std::size_t> taken;
  for (std::size_t k = 0; k < resolved.size(); ++k)
    if (const Index row = blocks.find_row(resolved[k].slave.row); row >= 0 && blocks.unknown(row) >= 0)
    {
      add_slave(blocks.unknown(row), local(blocks, resolved[k].motion), local(blocks, resolved[k].force));
      taken.push_back(k);
    }
  return taken;
}

/// Slaves that were eliminated locally may still depend on slaves that were resolved together.
/// @param resolved gives the expansion of a slave by its position
template<class ExpansionOf>
void ConstraintElimination::substitute(const Sharing &unknowns, NodeBlocks &blocks, std::vector<Expansion> &side,
                                       ExpansionOf &&resolved) const
{
  for (std::size_t s = 0; s < std::min(n_local_, side.size()); ++s)
  {
    Expansion &expansion = side[s];
    const auto depends = [&](const Entry &entry) { return is_slave(blocks.unknown(entry.row)); };
    if (std::none_of(expansion.of_rows.begin(), expansion.of_rows.end(), depends))
      continue;
    std::map<WholeUnknown, double> of_unknowns;
    std::map<Index, double> of_constraints;
    for (const Entry &entry : expansion.of_constraints)
      of_constraints[entry.row] += entry.coefficient;
    for (const Entry &entry : expansion.of_rows)
    {
      const Index unknown = blocks.unknown(entry.row);
      if (!depends(entry))
      {
        of_unknowns[{unknowns.number(unknown), blocks.number(entry.row)}] += entry.coefficient;
        continue;
      }
      const WholeExpansion &other = resolved(static_cast<std::size_t>(position_of_[unknown]));
      for (const WholeTerm &term : other.of_unknowns)
        of_unknowns[term.unknown] += entry.coefficient * term.coefficient;
      for (const auto &[row, coefficient] : other.of_rows)
        of_constraints[entangled_[row]] += entry.coefficient * coefficient;
    }
    expansion = {};
    for (const auto &[unknown, coefficient] : of_unknowns)
      expansion.of_rows.push_back({blocks.take_row(unknown.row), coefficient});
    for (const auto &[row, coefficient] : of_constraints)
      expansion.of_constraints.push_back({row, coefficient});
  }
}

void ConstraintElimination::compute(const Sharing &unknowns, NodeBlocks &blocks, std::span<const RowGroup> groups,
                                    bool symmetric)
{
  symmetric_ = symmetric;
  position_of_.assign(static_cast<std::size_t>(unknowns.size()), -1);
  slaves_.clear();
  motion_.clear();
  weights_.clear();
  entangled_.clear();
  n_rows_ = 0;
  count_users(unknowns, groups);
  std::vector<EntangledRow> rows;
  agree_on_failures(unknowns, [&] { rows = eliminate_groups(unknowns, blocks, groups); });
  n_local_ = slaves_.size();
  n_known_rows_ = n_rows_;
  std::size_t first_own = 0;
  rows = gather_rows(unknowns, std::move(rows), first_own);
  if (!rows.empty())
    agree_on_failures(unknowns,
                      [&]
                      {
                        name_entangled(rows.size(), first_own);
                        const std::vector<ResolvedSlave> resolved = resolve(rows);
                        const std::vector<std::size_t> taken = take_resolved(blocks, resolved);
                        substitute(unknowns, blocks, motion_,
                                   [&](std::size_t position) -> const WholeExpansion &
                                   { return resolved[taken[position - n_local_]].motion; });
                        substitute(unknowns, blocks, weights_,
                                   [&](std::size_t position) -> const WholeExpansion &
                                   { return resolved[taken[position - n_local_]].force; });
                      });
  share_expansions(unknowns, blocks);
}
} // namespace amontons
