#pragma once
#include "amontons/algebra/constraint_elimination.h"
#include "amontons/algebra/constraint_rows.h"
#include "amontons/algebra/node_blocks.h"
#include "amontons/algebra/sparse_matrix.h"

#include <span>
#include <vector>

namespace amontons
{
/// The reduced matrix W^T K T of the condensed form, K the bodies' stiffness with the contacts' remaining one and the
/// dense blocks of the unknowns. Slaves, and rows without an unknown, are rows of their own with a diagonal entry only,
/// so that blocks stay whole.
///
/// The pattern holds whatever statuses the constraints take: each impactor node may be a slave of the nodes of its
/// face. Only rows of contact nodes and their neighbours are made anew when constraints change.
///
/// Over several processes each makes W^T K_p T of its part K_p of the stiffness, to which its constraints belong, and
/// dense blocks and diagonal entries of rows that it owns. The reduced matrix is the sum. A slave of which several
/// processes have a copy may follow nodes that some of these do not have: they take in foreign blocks.
class CondensedMatrix
{
public:
  CondensedMatrix(const Layout &layout, std::span<const SubdomainMatrix> subdomains)
    : layout_(layout)
    , subdomains_(subdomains)
  {
  }

  [[nodiscard]] const NodeBlocks &blocks() const { return blocks_; }
  /// To take in rows that slaves follow; update() shares them.
  [[nodiscard]] NodeBlocks &blocks() { return blocks_; }
  [[nodiscard]] const SparseMatrix &matrix() const { return matrix_; }

  /// Takes the present layout, and makes the pattern anew at the next update(). The spans must stay. Collective.
  /// @param patterns, constraints of this process
  void set_constraints(std::span<const ConstraintPattern> patterns, std::span<const ConstraintRows> constraints,
                       std::span<const std::vector<Index>> dense_unknowns,
                       std::span<const Eigen::MatrixXd> dense_blocks);
  /// Diagonal entries that are added, of the size of the stiffness. @param rows of unknowns; -1 for another process's
  void set_pins(std::vector<Index> rows);
  [[nodiscard]] double pin_stiffness() const { return mean_diagonal_; }

  /// Brings the values to the present ones. @param everything the bodies' stiffness (or the layout's coefficients)
  /// changed, not the constraints alone @return whether the pattern is a new one; the same on all. Collective.
  bool update(const ConstraintElimination &elimination, bool everything);

  /// K motion over the unknowns, before elimination: whole on every copy. Collective.
  [[nodiscard]] std::vector<double> multiply(std::span<const double> motion) const;

private:
  void make_values(const ConstraintElimination &elimination, bool everything);
  void take_layout();
  void share_masters();
  bool extend_fill(const ConstraintElimination &elimination);
  void build_pattern();
  void collect_columns(Index block, std::vector<Index> &columns);
  void add_column(Index block, std::vector<Index> &columns);
  void add_block(Index block, std::vector<Index> &columns);
  void add_dense(Index block, std::vector<Index> &columns);
  void add_neighbours(Index node, std::vector<Index> &columns);
  void prepare_columns(const ConstraintElimination &elimination);
  void make_row(Index row, const ConstraintElimination &elimination);
  void add_row_of(Index unknown, double weight, const ConstraintElimination &elimination);
  void add_at(Index column, double value);
  void add_nodal(Index nodal, double value, const ConstraintElimination &elimination);
  void add_unknown(Index unknown, double value, const ConstraintElimination &elimination);
  void find_mean_diagonal();
  template<class Emit>
  void visit_contact_row(Index nodal, Emit &&emit) const;

  const Layout &layout_;
  std::span<const SubdomainMatrix> subdomains_;
  NodeBlocks blocks_;
  std::span<const ConstraintPattern> patterns_;
  std::span<const ConstraintRows> constraints_;
  std::vector<Index> counted_dense_; ///< here
  std::span<const std::vector<Index>> dense_unknowns_;
  std::span<const Eigen::MatrixXd> dense_blocks_;
  std::vector<std::vector<Index>> constraints_of_node_;

  SparseMatrix matrix_;
  bool pattern_stands_ = false;
  std::vector<std::vector<Index>> masters_; ///< [n_blocks] blocks that a slave of the block may follow
  std::vector<std::vector<Index>> slaves_;  ///< [n_blocks] the other way round
  std::vector<Index> affected_;             ///< blocks whose rows change with the constraints
  std::vector<Index> pins_, old_pins_;
  std::vector<Index> mark_; ///< [n_blocks] = stamp_ for columns that are in the present row
  Index stamp_ = 0;

  std::vector<Index> direct_;              ///< [n_nodal] row that a nodal component is, or -1
  std::vector<std::vector<Term>> feeding_; ///< [n_rows] slaves whose equilibrium a row takes a part of
  std::vector<Index> fed_, indirect_;      ///< entries of feeding_ and direct_ that were changed
  std::vector<Index> place_;               ///< [n_rows] of a column in the row that is being made
  double mean_diagonal_ = 1;
};
} // namespace amontons
