#pragma once
#include "amontons/algebra/layout.h"
#include "amontons/algebra/linear_solver.h"
#include "amontons/algebra/subdomain_matrix.h"

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

namespace amontons
{
/// Which nodal components and multipliers a constraint couples.
struct ConstraintPattern
{
  std::array<Index, 15> nodal;
  int n_nodal = 0;
  std::array<Index, 3> multipliers; ///< positions among the multipliers
  int n_multipliers = 0;
};

/// Values of one constraint: the tangent blocks of a contact element over its pattern, whoever made them.
struct ConstraintValues
{
  Eigen::Ref<const Eigen::MatrixXd> stiffness;                ///< [n_nodal x n_nodal]
  Eigen::Ref<const Eigen::MatrixXd> force_by_multiplier;      ///< [n_nodal x n_multipliers]
  Eigen::Ref<const Eigen::MatrixXd> constraint_by_position;   ///< [n_multipliers x n_nodal]
  Eigen::Ref<const Eigen::MatrixXd> constraint_by_multiplier; ///< [n_multipliers x n_multipliers]
};

/// The coupled form: displacements and multipliers in one indefinite matrix
///     [ K + K_c   B_f ]
///     [ B         D   ],
/// optionally bordered by rows that hold a motion of the whole (held modes).
class CoupledForm
{
public:
  CoupledForm(const Layout &layout, std::span<const SubdomainMatrix> subdomains, LinearSolver &solver);

  /// @param dense_blocks sets of displacement unknowns that are coupled fully (rigid bodies)
  void set_constraints(std::vector<ConstraintPattern> constraints, std::vector<std::vector<Index>> dense_blocks);
  /// Rows that hold sum_i mode_i du_i = 0, each over the displacement unknowns. Empty: none.
  /// @return whether there were or are any: prepare() is needed then
  bool set_held_modes(std::vector<std::vector<double>> modes);

  /// Builds the pattern if constraints or held modes changed; then all values have to be given anew. @return whether
  bool prepare();
  /// Takes the subdomains' present values (and the layout's present coefficients).
  void update_subdomains();
  void update_constraint(std::size_t k, const ConstraintValues &values);
  void update_dense_block(std::size_t k, const Eigen::MatrixXd &values);

  void factorize();
  /// @param rhs, solution [n_unknowns]
  void solve(std::span<const double> rhs, std::span<double> solution);
  /// Reactions of the held modes in the last solution.
  [[nodiscard]] std::span<const double> mode_reactions() const { return mode_reactions_; }

  [[nodiscard]] const std::vector<ConstraintPattern> &constraints() const { return constraints_; }

private:
  template<class Emit>
  void visit_subdomains(Emit &&emit) const;
  template<class Emit>
  void visit_constraint(const ConstraintPattern &pattern, Emit &&emit) const;
  void build_pattern();

  const Layout &layout_;
  std::span<const SubdomainMatrix> subdomains_;
  LinearSolver &solver_;
  std::vector<ConstraintPattern> constraints_;
  std::vector<std::vector<Index>> dense_blocks_;
  std::vector<std::vector<double>> modes_;
  std::vector<std::size_t> constraint_offsets_, dense_offsets_;
  std::vector<double> values_;
  std::vector<double> mode_reactions_;
  bool pattern_built_ = false;
};
} // namespace amontons
