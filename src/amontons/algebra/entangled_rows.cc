#include "amontons/algebra/entangled_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace amontons
{
namespace
{
/// Below this part of the original row nothing is left of it: it depends on others.
constexpr double dependent = 1e-10;
/// Unknowns of the impactor node come first, if their coefficients are not much smaller.
constexpr double preference = 10;

/// Right sides enter as unknowns behind all others that are never eliminated.
constexpr GlobalIndex right_side = std::numeric_limits<GlobalIndex>::max();
WholeUnknown unit_of(std::size_t row)
{
  return {right_side, static_cast<GlobalIndex>(row)};
}
bool is_unit(const WholeUnknown &unknown)
{
  return unknown.number == right_side;
}

using SparseRow = std::map<WholeUnknown, double>;

double largest(const SparseRow &row)
{
  double out = 0;
  for (auto it = row.begin(); it != row.end() && !is_unit(it->first); ++it)
    out = std::max(out, std::abs(it->second));
  return out;
}

double value(const SparseRow &row, const WholeUnknown &unknown)
{
  const auto it = row.find(unknown);
  return it == row.end() ? 0 : it->second;
}

/// row := row with unknown = sum of expansion.
void replace(SparseRow &row, const WholeUnknown &unknown, const SparseRow &expansion)
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
SparseRow solved_for(const SparseRow &row, const WholeUnknown &unknown)
{
  SparseRow out(row);
  out.erase(unknown);
  const double pivot = row.at(unknown);
  for (auto &[u, c] : out)
    c /= -pivot;
  return out;
}

/// What is resolved is kept free of slaves.
class Side
{
public:
  [[nodiscard]] const std::map<WholeUnknown, SparseRow> &resolved() const { return resolved_; }

  /// sum of terms - the unit of the row's right side = 0
  [[nodiscard]] SparseRow equation(const std::vector<WholeTerm> &terms, std::size_t row) const
  {
    SparseRow out;
    for (const WholeTerm &term : terms)
      if (const auto it = resolved_.find(term.unknown); it == resolved_.end())
        out[term.unknown] += term.coefficient;
      else
        for (const auto &[u, c] : it->second)
          out[u] += term.coefficient * c;
    out[unit_of(row)] -= 1;
    return out;
  }
  void resolve(const WholeUnknown &slave, const SparseRow &row)
  {
    SparseRow expansion = solved_for(row, slave);
    for (const WholeUnknown &user : users_[slave])
      replace(resolved_[user], slave, expansion);
    for (const auto &[u, c] : expansion)
    {
      users_[u].insert(users_[slave].begin(), users_[slave].end());
      users_[u].insert(slave);
    }
    users_.erase(slave);
    resolved_[slave] = std::move(expansion);
  }

private:
  std::map<WholeUnknown, SparseRow> resolved_;
  std::map<WholeUnknown, std::set<WholeUnknown>> users_; ///< slaves whose expansion has (or had) an unknown
};

/// @return nullptr where the row leaves none
const WholeUnknown *choose_slave(const EntangledRow &row, const SparseRow &position, const SparseRow &force)
{
  const double position_scale = largest(position), force_scale = largest(force);
  double size = 1;
  for (const WholeTerm &term : row.position)
    size = std::max(size, std::abs(term.coefficient));
  if (position_scale <= dependent * size)
    return nullptr;
  const WholeUnknown *slave = nullptr;
  double best = 0;
  for (const auto &[u, coefficient] : position)
  {
    const bool own = std::find(row.own.begin(), row.own.end(), u) != row.own.end();
    const double share = std::min(std::abs(coefficient) / position_scale, std::abs(value(force, u)) / force_scale) *
                         (own ? preference : 1);
    if (!is_unit(u) && share > best)
    {
      best = share;
      slave = &u;
    }
  }
  return slave;
}

WholeExpansion list(const SparseRow &row)
{
  WholeExpansion out;
  for (const auto &[u, coefficient] : row)
    if (coefficient != 0 && is_unit(u))
      out.of_rows.push_back({static_cast<std::size_t>(u.row), coefficient});
    else if (coefficient != 0)
      out.of_unknowns.push_back({u, coefficient});
  return out;
}
} // namespace

std::vector<EntangledRow> gather_rows(const Sharing &processes, std::vector<EntangledRow> own, std::size_t &first_own)
{
  first_own = 0;
  if (!processes.is_distributed())
    return own;
  ByteWriter writer;
  for (const EntangledRow &row : own)
  {
    writer.add_array(row.position);
    writer.add_array(row.force);
    writer.add_array(row.own);
  }
  const Bytes bytes = writer.take();
  std::vector<Message> messages;
  for (Rank rank = 0; rank < processes.n_processes() && !own.empty(); ++rank)
    messages.push_back({rank, bytes});
  std::vector<EntangledRow> all;
  for (const Message &message : processes.messages()->exchange("condensation", std::move(messages)))
  {
    if (message.rank == processes.rank())
      first_own = all.size();
    ByteReader reader(message.bytes);
    while (!reader.is_at_end())
    {
      EntangledRow &row = all.emplace_back();
      row.position = reader.get_array<WholeTerm>();
      row.force = reader.get_array<WholeTerm>();
      row.own = reader.get_array<WholeUnknown>();
    }
  }
  return all;
}

std::vector<ResolvedSlave> resolve(std::span<const EntangledRow> rows)
{
  Side motion, force;
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    const SparseRow c = motion.equation(rows[k].position, k), f = force.equation(rows[k].force, k);
    if (const WholeUnknown *slave = choose_slave(rows[k], c, f))
    {
      motion.resolve(*slave, c);
      force.resolve(*slave, f);
    }
  }
  std::vector<ResolvedSlave> out;
  for (const auto &[slave, expansion] : motion.resolved())
    out.push_back({slave, list(expansion), list(force.resolved().at(slave))});
  return out;
}
} // namespace amontons
