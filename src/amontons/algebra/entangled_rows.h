#pragma once
#include "amontons/base/ids.h"
#include "amontons/parallel/sharing.h"

#include <compare>
#include <span>
#include <vector>

namespace amontons
{
/// An unknown as all processes know it, in the order of its number.
struct WholeUnknown
{
  GlobalIndex number; ///< Sharing::number
  GlobalIndex row;    ///< of the reduced matrix (NodeBlocks::number)
  auto operator<=>(const WholeUnknown &) const = default;
};

struct WholeTerm
{
  WholeUnknown unknown;
  double coefficient;
};

/// A constraint row that cannot be eliminated within its constraint: sum position du = g, with the forces of its
/// multiplier.
struct EntangledRow
{
  std::vector<WholeTerm> position, force;
  std::vector<WholeUnknown> own; ///< unknowns to be eliminated by preference
};

/// du_slave = sum of_unknowns du + sum of_rows g; the same shape for forces.
struct WholeExpansion
{
  struct RowTerm
  {
    std::size_t row; ///< position among the entangled rows
    double coefficient;
  };
  std::vector<WholeTerm> of_unknowns;
  std::vector<RowTerm> of_rows;
};

struct ResolvedSlave
{
  WholeUnknown slave;
  WholeExpansion motion, force;
};

/// The rows of all processes on each of them, process after process. Traffic is with all, so they should be few; where
/// there are none nothing is sent. Collective.
/// @param first_own position of the process's first one
std::vector<EntangledRow> gather_rows(const Sharing &processes, std::vector<EntangledRow> own, std::size_t &first_own);

/// Gauss-Jordan elimination row by row. Each row takes a slave, the unknown with the largest coefficient and force, but
/// a row that depends on those before it takes none and carries no force.
/// @return by the slave's number, expansions free of slaves
std::vector<ResolvedSlave> resolve(std::span<const EntangledRow> rows);
} // namespace amontons
