#pragma once
#include "amontons/algebra/layout.h"

#include <span>
#include <vector>

namespace amontons
{
/// The rows of one constraint over the unknowns, with the forces of their multipliers.
struct RowGroup
{
  std::vector<std::vector<Term>> positions; ///< [row] sum coefficient du = g
  std::vector<std::vector<Term>> forces;    ///< [row] the forces that a unit of its multiplier puts on the unknowns
  std::vector<Index> own;                   ///< unknowns to be eliminated by preference: the impactor node's
};

/// Exact elimination of the constraint rows  C du = g  from  K du + F y = f.
///
/// Each row takes one unknown, its slave. With the slaves s and the rest m,
///     du_s = T du_m + H g,   T = -C_s^-1 C_m,        H = C_s^-1,
///     row_m + W^T row_s free of y,   W = -F_s^-T F_m^T,
///     y = F_s^-1 (f - K du)_s.
/// Slaves of a constraint are unknowns of its own impactor node where no other constraint touches these; then the
/// elimination is local. The other constraints (an impactor node that is also a target node, two contacts on a node, an
/// impactor that supports or a rigid body hold) are resolved together, over all their unknowns, chains substituted. The
/// slave of a row is the unknown with the largest coefficient and force, so that T and W stay small. Of rows that
/// depend on each other the later ones take no slave and carry no force.
class ConstraintElimination
{
public:
  /// @param symmetric F = C^T: then W = T
  void compute(Index n_unknowns, std::span<const RowGroup> groups, bool symmetric);

  [[nodiscard]] bool is_slave(Index unknown) const { return position_of_[unknown] >= 0; }
  [[nodiscard]] std::span<const Index> slaves() const { return slaves_; }
  [[nodiscard]] Index n_rows() const { return n_rows_; }
  /// T's row of a slave: du_slave = sum coefficient du_unknown + ...
  [[nodiscard]] std::span<const Term> motion(Index slave) const { return part(motion_, slave, true); }
  /// H's row of a slave: ... + sum coefficient g_row (`unknown` is the row).
  [[nodiscard]] std::span<const Term> offset(Index slave) const { return part(motion_, slave, false); }
  /// W's row of a slave: what of its equilibrium goes to which unknown.
  [[nodiscard]] std::span<const Term> weights(Index slave) const { return part(weights_, slave, true); }
  /// y_row += coefficient (f - K du)_slave (`unknown` is the row).
  [[nodiscard]] std::span<const Term> reactions(Index slave) const { return part(weights_, slave, false); }

private:
  struct Expansion
  {
    std::vector<Term> of_unknowns, of_rows;
  };
  /// One row and its forces, the unit of its right side included as an unknown behind the others.
  struct Pending
  {
    std::vector<Term> position, force;
    std::vector<Index> own;
  };

  [[nodiscard]] std::span<const Term> part(const std::vector<Expansion> &side, Index slave, bool unknowns) const
  {
    const Expansion &expansion = (symmetric_ ? motion_ : side)[position_of_[slave]];
    return unknowns ? expansion.of_unknowns : expansion.of_rows;
  }
  void count_users(std::span<const RowGroup> groups);
  bool eliminate_locally(const RowGroup &group, Index first_row);
  void eliminate_together(std::vector<Pending> pending);
  void add_slave(Index unknown, Expansion motion, Expansion weights);
  void substitute(std::vector<Expansion> &side, std::size_t from) const;

  Index n_unknowns_ = 0, n_rows_ = 0;
  bool symmetric_ = true;
  std::vector<Index> position_of_; ///< [n_unknowns] position among the slaves, or -1
  std::vector<Index> n_users_;     ///< [n_unknowns] constraints with this unknown
  std::vector<Index> slaves_;
  std::vector<Expansion> motion_, weights_;
};
} // namespace amontons
