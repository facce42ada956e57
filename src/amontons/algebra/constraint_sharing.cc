#include "amontons/algebra/constraint_elimination.h"

#include "amontons/parallel/holders.h"

/// What processes tell each other of the constraints that they eliminate.
namespace amontons
{
/// Slaves that were eliminated here become slaves of whoever has a copy of them.
void ConstraintElimination::share_expansions(const Sharing &unknowns, NodeBlocks &blocks)
{
  struct WholeEntry
  {
    GlobalIndex row;
    double coefficient;
  };
  const auto tell = [&](std::span<const Entry> entries, ByteWriter &writer)
  {
    std::vector<WholeEntry> out;
    for (const Entry &entry : entries)
      out.push_back({blocks.number(entry.row), entry.coefficient});
    writer.add_array(out);
  };
  const auto hear = [&](ByteReader &reader)
  {
    Expansion out;
    for (const auto &[row, coefficient] : reader.get_array<WholeEntry>())
      out.of_rows.push_back({blocks.take_row(row), coefficient});
    return out;
  };
  const auto n_local = static_cast<Index>(n_local_);
  tell_holders(
      unknowns, "condensation", [&](Index i) { return is_slave(i) && position_of_[i] < n_local; },
      [&](Index slave, ByteWriter &writer)
      {
        tell(motion(slave), writer);
        if (!symmetric_)
          tell(weights(slave), writer);
      },
      [&](Index slave, ByteReader &reader)
      {
        Expansion of_motion = hear(reader);
        add_slave(slave, std::move(of_motion), symmetric_ ? Expansion() : hear(reader));
      });
}

/// Entangled rows of other processes come behind the groups' own.
void ConstraintElimination::name_entangled(std::size_t n, std::size_t first_own)
{
  const std::vector<Index> own = std::move(entangled_);
  entangled_.clear();
  for (std::size_t k = 0; k < n; ++k)
    entangled_.push_back(k >= first_own && k < first_own + own.size() ? own[k - first_own] : n_known_rows_++);
}

/// Makes the entries of entangled rows sums over the processes.
void ConstraintElimination::sum_entangled(const Sharing &processes, std::span<double> of_constraints) const
{
  if (entangled_.empty() || !processes.is_distributed())
    return;
  std::vector<double> sums;
  for (const Index row : entangled_)
    sums.push_back(of_constraints[row]);
  processes.sum_over_processes(sums);
  for (std::size_t k = 0; k < sums.size(); ++k)
    of_constraints[entangled_[k]] = sums[k];
}

std::vector<double> ConstraintElimination::offset(const Sharing &unknowns, std::vector<double> right_side) const
{
  right_side.resize(static_cast<std::size_t>(n_known_rows_), 0.0);
  sum_entangled(unknowns, right_side);
  std::vector<double> out(position_of_.size(), 0.0);
  for (const Index slave : slaves_)
    if (unknowns.is_own(slave))
      for (const Entry &entry : motion_[position_of_[slave]].of_constraints)
        out[slave] += entry.coefficient * right_side[entry.row];
  unknowns.take_owners(out);
  return out;
}

std::vector<double> ConstraintElimination::reactions(const Sharing &unknowns, std::span<const double> residual) const
{
  std::vector<double> out(static_cast<std::size_t>(n_known_rows_), 0.0);
  for (const Index slave : slaves_)
    if (unknowns.is_own(slave))
      for (const Entry &entry : side(symmetric_)[position_of_[slave]].of_constraints)
        out[entry.row] += entry.coefficient * residual[slave];
  sum_entangled(unknowns, out);
  out.resize(static_cast<std::size_t>(n_rows_));
  return out;
}
} // namespace amontons
