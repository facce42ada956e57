#pragma once
#include "amontons/algebra/entangled_rows.h"
#include "amontons/algebra/layout.h"
#include "amontons/algebra/node_blocks.h"

#include <span>
#include <vector>

namespace amontons
{
/// The rows of one constraint over the unknowns, with the forces of their multipliers.
struct RowGroup
{
  std::vector<std::vector<Term>> positions; ///< [row] sum coefficient du = g
  std::vector<std::vector<Term>> forces;    ///< [row] the forces that a unit of its multiplier puts on the unknowns
  std::vector<Index> own; ///< unknowns to be eliminated by preference: the impactor node's, owned by this process
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
///
/// Over several processes each eliminates its own constraints, and those to be resolved together are resolved by all
/// alike. Of every slave that a process has a copy of it knows T and W, H and F_s^-1 if it owns it.
class ConstraintElimination
{
public:
  struct Entry
  {
    Index row; ///< of the reduced matrix
    double coefficient;
  };

  /// Collective.
  /// @param unknowns of the displacements @param blocks takes in the rows that slaves follow
  /// @param groups of this process @param symmetric F = C^T: then W = T; the same on all
  void compute(const Sharing &unknowns, NodeBlocks &blocks, std::span<const RowGroup> groups, bool symmetric);

  [[nodiscard]] bool is_slave(Index unknown) const { return position_of_[unknown] >= 0; }
  /// Of which there is a copy here.
  [[nodiscard]] std::span<const Index> slaves() const { return slaves_; }
  /// T's row of a slave: du_slave = sum coefficient du_row + ...
  [[nodiscard]] std::span<const Entry> motion(Index slave) const { return motion_[position_of_[slave]].of_rows; }
  /// W's row of a slave: what of its equilibrium goes to which row.
  [[nodiscard]] std::span<const Entry> weights(Index slave) const
  {
    return side(symmetric_)[position_of_[slave]].of_rows;
  }

  /// H g of every slave, zero for the other unknowns. Collective.
  /// @param right_side g of the rows of this process's groups
  [[nodiscard]] std::vector<double> offset(const Sharing &unknowns, std::vector<double> right_side) const;
  /// y of the rows of this process's groups. Collective. @param residual f - K du over the unknowns
  [[nodiscard]] std::vector<double> reactions(const Sharing &unknowns, std::span<const double> residual) const;

private:
  struct Expansion
  {
    std::vector<Entry> of_rows;        ///< of the reduced matrix
    std::vector<Entry> of_constraints; ///< of constraint rows: the groups' own, then others' entangled ones
  };

  [[nodiscard]] const std::vector<Expansion> &side(bool of_motion) const { return of_motion ? motion_ : weights_; }
  void count_users(const Sharing &unknowns, std::span<const RowGroup> groups);
  bool eliminate_locally(const NodeBlocks &blocks, const RowGroup &group, Index first_row);
  std::vector<EntangledRow> eliminate_groups(const Sharing &unknowns, const NodeBlocks &blocks,
                                             std::span<const RowGroup> groups);
  std::vector<std::size_t> take_resolved(NodeBlocks &blocks, std::span<const ResolvedSlave> resolved);
  [[nodiscard]] Expansion local(NodeBlocks &blocks, const WholeExpansion &whole) const;
  template<class ExpansionOf>
  void substitute(const Sharing &unknowns, NodeBlocks &blocks, std::vector<Expansion> &side,
                  ExpansionOf &&resolved) const;
  void share_expansions(const Sharing &unknowns, NodeBlocks &blocks);
  void add_slave(Index unknown, Expansion motion, Expansion weights);
  void name_entangled(std::size_t n, std::size_t first_own);
  void sum_entangled(const Sharing &processes, std::span<double> of_constraints) const;

  Index n_rows_ = 0;        ///< of the groups
  Index n_known_rows_ = 0;  ///< with others' entangled ones
  std::size_t n_local_ = 0; ///< slaves that were eliminated locally: the first ones
  bool symmetric_ = true;
  std::vector<Index> position_of_; ///< [n_unknowns] position among the slaves, or -1
  std::vector<double> n_users_;    ///< [n_unknowns] constraints with this unknown, over all processes
  std::vector<Index> slaves_;
  std::vector<Expansion> motion_, weights_;
  std::vector<Index> entangled_; ///< [entangled row of the whole] constraint row of an Expansion
};
} // namespace amontons
