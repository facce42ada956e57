#include "amontons/algebra/constraint_elimination.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace amontons
{
namespace
{
/// Least part of a row's largest coefficient (and force) that a slave of the impactor node must have.
constexpr double local_pivot = 0.1;
/// Below this part of the original row nothing is left of it: it depends on others.
constexpr double dependent = 1e-10;
/// Unknowns of the impactor node come first, if their coefficients are not much smaller.
constexpr double preference = 10;

using DenseRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using SparseRow = std::map<Index, double>;

double largest(const SparseRow &row, Index below)
{
  double out = 0;
  for (auto it = row.begin(); it != row.end() && it->first < below; ++it)
    out = std::max(out, std::abs(it->second));
  return out;
}

double value(const SparseRow &row, Index unknown)
{
  const auto it = row.find(unknown);
  return it == row.end() ? 0 : it->second;
}

/// row := row with unknown = sum of expansion.
void replace(SparseRow &row, Index unknown, const SparseRow &expansion)
{
  const auto it = row.find(unknown);
  if (it == row.end())
    return;
  const double factor = it->second;
  row.erase(it);
  for (const auto &[u, c] : expansion)
    row[u] += factor * c;
}

/// unknown = sum of what the equation `row` = 0 says.
SparseRow solved_for(const SparseRow &row, Index unknown)
{
  SparseRow out(row);
  out.erase(unknown);
  const double pivot = row.at(unknown);
  for (auto &[u, c] : out)
    c /= -pivot;
  return out;
}

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

void ConstraintElimination::count_users(std::span<const RowGroup> groups)
{
  n_users_.assign(static_cast<std::size_t>(n_unknowns_), 0);
  for (const RowGroup &group : groups)
    if (!group.positions.empty())
      for (const Index unknown : distinct_unknowns(group))
        ++n_users_[unknown];
}

void ConstraintElimination::add_slave(Index unknown, Expansion motion, Expansion weights)
{
  position_of_[unknown] = static_cast<Index>(slaves_.size());
  slaves_.push_back(unknown);
  motion_.push_back(std::move(motion));
  if (!symmetric_)
    weights_.push_back(std::move(weights));
}

bool ConstraintElimination::eliminate_locally(const RowGroup &group, Index first_row)
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
        out.of_unknowns.push_back({unknowns[k], -rows.values(row, k)});
    for (Eigen::Index k = 0; k < n; ++k)
      if (rows.values(row, m + k) != 0)
        out.of_rows.push_back({first_row + static_cast<Index>(k), rows.values(row, m + k)});
    return out;
  };
  for (Eigen::Index row = 0; row < n; ++row)
    add_slave(unknowns[slave[row]], expansion(c, row), expansion(f, row));
  return true;
}

/// Gauss-Jordan elimination row by row: what is resolved is kept free of slaves.
void ConstraintElimination::eliminate_together(std::vector<Pending> pending)
{
  struct Side
  {
    std::map<Index, SparseRow> resolved;
    std::map<Index, std::set<Index>> users; ///< slaves whose expansion has (or had) an unknown
    [[nodiscard]] SparseRow substituted(const std::vector<Term> &terms) const
    {
      SparseRow row;
      for (const Term &term : terms)
        if (const auto it = resolved.find(term.unknown); it == resolved.end())
          row[term.unknown] += term.coefficient;
        else
          for (const auto &[u, c] : it->second)
            row[u] += term.coefficient * c;
      return row;
    }
    void resolve(Index slave, const SparseRow &row)
    {
      SparseRow expansion = solved_for(row, slave);
      for (const Index user : users[slave])
        replace(resolved[user], slave, expansion);
      for (const auto &[u, c] : expansion)
      {
        users[u].insert(users[slave].begin(), users[slave].end());
        users[u].insert(slave);
      }
      users.erase(slave);
      resolved[slave] = std::move(expansion);
    }
  };
  Side c, f;
  for (const Pending &row : pending)
  {
    const SparseRow position = c.substituted(row.position), force = f.substituted(row.force);
    const double position_scale = largest(position, n_unknowns_), force_scale = largest(force, n_unknowns_);
    Index slave = -1;
    double best = 0;
    for (const auto &[u, coefficient] : position)
    {
      const bool own = std::find(row.own.begin(), row.own.end(), u) != row.own.end();
      const double share = std::min(std::abs(coefficient) / position_scale, std::abs(value(force, u)) / force_scale) *
                           (own ? preference : 1);
      if (u < n_unknowns_ && share > best)
      {
        best = share;
        slave = u;
      }
    }
    const auto size = [](const std::vector<Term> &terms)
    {
      double out = 0;
      for (const Term &term : terms)
        out = std::max(out, std::abs(term.coefficient));
      return out;
    };
    if (slave < 0 || position_scale <= dependent * size(row.position))
      continue;
    c.resolve(slave, position);
    f.resolve(slave, force);
  }
  const auto expansion = [&](const SparseRow &row)
  {
    Expansion out;
    for (const auto &[u, coefficient] : row)
      if (coefficient != 0)
        (u < n_unknowns_ ? out.of_unknowns : out.of_rows)
            .push_back({u < n_unknowns_ ? u : u - n_unknowns_, coefficient});
    return out;
  };
  for (const auto &[slave, row] : c.resolved)
    add_slave(slave, expansion(row), expansion(f.resolved[slave]));
}

/// Slaves that were eliminated locally may still depend on slaves that were resolved together.
void ConstraintElimination::substitute(std::vector<Expansion> &side, std::size_t from) const
{
  for (std::size_t s = 0; s < std::min(from, side.size()); ++s)
  {
    Expansion &expansion = side[s];
    const auto depends = [&](const Term &term) { return is_slave(term.unknown); };
    if (std::none_of(expansion.of_unknowns.begin(), expansion.of_unknowns.end(), depends))
      continue;
    SparseRow unknowns, rows;
    for (const Term &term : expansion.of_rows)
      rows[term.unknown] += term.coefficient;
    for (const Term &term : expansion.of_unknowns)
    {
      if (!depends(term))
      {
        unknowns[term.unknown] += term.coefficient;
        continue;
      }
      const Expansion &other = side[position_of_[term.unknown]];
      for (const Term &t : other.of_unknowns)
        unknowns[t.unknown] += term.coefficient * t.coefficient;
      for (const Term &t : other.of_rows)
        rows[t.unknown] += term.coefficient * t.coefficient;
    }
    const auto list = [](const SparseRow &row)
    {
      std::vector<Term> out;
      for (const auto &[u, coefficient] : row)
        out.push_back({u, coefficient});
      return out;
    };
    expansion = {list(unknowns), list(rows)};
  }
}

void ConstraintElimination::compute(Index n_unknowns, std::span<const RowGroup> groups, bool symmetric)
{
  n_unknowns_ = n_unknowns;
  symmetric_ = symmetric;
  position_of_.assign(static_cast<std::size_t>(n_unknowns), -1);
  slaves_.clear();
  motion_.clear();
  weights_.clear();
  count_users(groups);
  std::vector<Pending> pending;
  n_rows_ = 0;
  for (const RowGroup &group : groups)
  {
    if (!group.positions.empty() && !eliminate_locally(group, n_rows_))
      for (std::size_t r = 0; r < group.positions.size(); ++r)
      {
        // C du - g = 0, with g as an unknown that is never eliminated.
        const Index right_side = n_unknowns_ + n_rows_ + static_cast<Index>(r);
        pending.push_back({group.positions[r], group.forces[r], group.own});
        pending.back().position.push_back({right_side, -1});
        pending.back().force.push_back({right_side, -1});
      }
    n_rows_ += static_cast<Index>(group.positions.size());
  }
  const std::size_t n_local = slaves_.size();
  if (pending.empty())
    return;
  eliminate_together(std::move(pending));
  substitute(motion_, n_local);
  substitute(weights_, n_local);
}
} // namespace amontons
