#pragma once
#include "amontons/base/ids.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace amontons
{
/// Which nodal components and multipliers a constraint couples.
struct ConstraintPattern
{
  std::vector<Index> nodal;         ///< the impactor node's components first
  std::array<Index, 3> multipliers; ///< positions among the multipliers of this process
  int n_multipliers = 0;

  [[nodiscard]] int n_nodal() const { return static_cast<int>(nodal.size()); }
};

/// Values of one constraint: the tangent blocks of a contact element over its pattern, whoever made them.
struct ConstraintValues
{
  Eigen::Ref<const Eigen::MatrixXd> stiffness;                ///< [n_nodal x n_nodal]
  Eigen::Ref<const Eigen::MatrixXd> force_by_multiplier;      ///< [n_nodal x n_multipliers]
  Eigen::Ref<const Eigen::MatrixXd> constraint_by_position;   ///< [n_multipliers x n_nodal]
  Eigen::Ref<const Eigen::MatrixXd> constraint_by_multiplier; ///< [n_multipliers x n_multipliers]
  /// The r of the augmented Lagrangian (force per length): the part r force_by_multiplier constraint_by_position of
  /// `stiffness` is known to vanish with the constraint.
  double augmentation;
};

/// What forms cost, for the run record.
struct FormCounters
{
  std::int64_t n_pattern_builds = 0;
  std::int64_t n_factorizations = 0; ///< direct factorisations, of the whole or of a subdomain
  std::int64_t n_preconditioner_setups = 0;
  std::int64_t n_iterations = 0; ///< of an iterative solver
};

/// The system of one Newton iteration in the way it is solved:
///     [ K + sum S   F ] [ du      ]
///     [ C           D ] [ dlambda ] = right side,
/// K by subdomain over the nodal components, S, F, C and D constraint by constraint, all of it seen through the Layout;
/// optionally bordered by rows that hold a motion of the whole (held modes). Every form gives the same step.
///
/// Order of calls: set_constraints and set_held_modes when they change; prepare(); the values that changed since (all
/// of them after prepare() returned true); solve(). Collective.
///
/// Over several processes (Layout) each gives the stiffness of its own subdomains, their sum being K, and constraints
/// of its own: a constraint is given by the owner of its impactor node and of the unknowns that this node has of its
/// own (not a rigid body's), who has a copy of all its other nodes. A process may give none. Dense blocks are given by
/// all, the same on all; held modes by each over the unknowns it has. A right side has its whole value on every copy of
/// a displacement unknown, a solution the same, bit by bit; of multipliers each process has its own constraints'.
class SystemForm
{
public:
  virtual ~SystemForm() = default;

  /// A layout may have changed since the last call, with other copies of nodes that no subdomain here has: then held
  /// modes have to be set anew too. FetiForm knows the first layout only.
  /// @param constraints of this process
  /// @param dense_blocks sets of displacement unknowns that are coupled fully (rigid bodies)
  virtual void set_constraints(std::vector<ConstraintPattern> constraints,
                               std::vector<std::vector<Index>> dense_blocks) = 0;
  /// Rows that hold sum_i mode_i du_i = 0, each over the displacement unknowns. Empty: none.
  /// @return whether there were or are any: prepare() is needed then
  virtual bool set_held_modes(std::vector<std::vector<double>> modes) = 0;

  /// Makes ready for values. @return whether all values have to be given anew
  virtual bool prepare() = 0;
  /// Takes the subdomains' present values (and the layout's present coefficients).
  virtual void update_subdomains() = 0;
  /// @param k among the constraints of this process
  virtual void update_constraint(std::size_t k, const ConstraintValues &values) = 0;
  virtual void update_dense_block(std::size_t k, const Eigen::MatrixXd &values) = 0;

  /// Factorises or sets up what the present values need; what did not change is kept.
  virtual void factorize() = 0;
  /// @param rhs, solution [n_unknowns]
  /// @param tolerance an iterative form stops where the residual forces are below this part of the right side's; a
  ///        direct one takes no notice
  /// @throws NumericalFailure if the system is singular, or an iteration does not converge
  virtual void solve(std::span<const double> rhs, std::span<double> solution, double tolerance) = 0;

  /// Reactions of the held modes in the last solution. The same on all processes.
  [[nodiscard]] virtual std::span<const double> mode_reactions() const = 0;
  /// Of this process.
  [[nodiscard]] virtual const std::vector<ConstraintPattern> &constraints() const = 0;
  [[nodiscard]] virtual FormCounters counters() const = 0;
};
} // namespace amontons
