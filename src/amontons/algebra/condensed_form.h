#pragma once
#include "amontons/algebra/condensed_matrix.h"
#include "amontons/algebra/linear_solver.h"
#include "amontons/algebra/system_form.h"

#include <exception>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace amontons
{
/// The condensed form: constraint rows eliminated exactly (ConstraintElimination), a matrix in displacements alone,
/// symmetric and positive definite but for slip, friction and compression in finite strain. The step is that of the
/// coupled form to round-off.
///
/// Held modes border the reduced matrix A, which may be singular without them. A + alpha P P^T with as many pinned
/// unknowns P as there are modes is regular; what the pins do is taken back by a small dense system for the reactions
/// and the pinned motions (Sherman, Morrison, Woodbury): exact, and A's pattern and symmetry stay.
///
/// Over several processes each eliminates its own constraints, and makes its part of the matrix (CondensedMatrix).
class CondensedForm : public SystemForm
{
public:
  /// @param reference places of the nodal components [n_nodal], length: rigid motions for multigrid, looked at whenever
  ///        set up. Stays the caller's, who keeps it with the layout. Not looked at with a direct solver
  CondensedForm(const Layout &layout, std::span<const SubdomainMatrix> subdomains, std::unique_ptr<LinearSolver> solver,
                const std::vector<double> &reference);

  void set_constraints(std::vector<ConstraintPattern> constraints,
                       std::vector<std::vector<Index>> dense_blocks) override;
  bool set_held_modes(std::vector<std::vector<double>> modes) override;
  bool prepare() override;
  void update_subdomains() override { subdomains_changed_ = true; }
  void update_constraint(std::size_t k, const ConstraintValues &values) override;
  void update_dense_block(std::size_t k, const Eigen::MatrixXd &values) override;
  void factorize() override;
  void solve(std::span<const double> rhs, std::span<double> solution, double tolerance) override;
  [[nodiscard]] std::span<const double> mode_reactions() const override { return mode_reactions_; }
  [[nodiscard]] const std::vector<ConstraintPattern> &constraints() const override { return patterns_; }
  [[nodiscard]] FormCounters counters() const override;

private:
  void eliminate();
  void place_pins();
  void set_smooth_modes();
  [[nodiscard]] Index choose_pin(std::span<const double> mode) const;
  [[nodiscard]] Eigen::VectorXd at_pins(std::span<const double> reduced) const;
  [[nodiscard]] double reduced_dot(std::span<const double> a, std::span<const double> b) const;
  enum class Side
  {
    motion, ///< T
    forces, ///< W
  };
  [[nodiscard]] std::vector<double> reduced(std::span<const double> of_unknowns, Side side = Side::forces) const;
  [[nodiscard]] std::vector<double> solve_reduced(std::span<const double> forces, double tolerance);
  [[nodiscard]] std::vector<double> solve_bordered(std::span<const double> forces, std::span<const double> offset,
                                                   double tolerance);
  struct RightSide
  {
    std::vector<double> forces;  ///< on the unknowns, without what the constraints' eliminated multipliers take
    std::vector<double> of_rows; ///< of the constraint rows of this process
    double size2 = 0;            ///< squared, as forces
  };
  [[nodiscard]] RightSide make_right_side(std::span<const double> rhs) const;
  [[nodiscard]] Eigen::VectorXd of_multipliers(std::size_t constraint, std::span<const double> unknowns) const;
  void find_multipliers(std::span<const double> rhs, std::span<const double> reactions,
                        std::span<double> solution) const;
  void expand(std::span<const double> reduced, std::span<double> motion) const;

  const Layout &layout_;
  std::unique_ptr<LinearSolver> solver_;
  const std::vector<double> &reference_;
  CondensedMatrix matrix_;
  std::vector<ConstraintPattern> patterns_;
  std::vector<ConstraintRows> rows_;
  std::map<std::size_t, std::exception_ptr> refused_; ///< by constraint whose values have no proper rows
  std::vector<double> augmentation_;                  ///< by constraint
  std::vector<std::vector<Index>> dense_unknowns_;
  std::vector<Eigen::MatrixXd> dense_blocks_;
  ConstraintElimination elimination_;
  std::vector<std::vector<double>> modes_;
  std::vector<Index> pins_; ///< rows of the reduced matrix; -1 for another process's
  std::vector<double> mode_reactions_;
  bool prepared_ = false, subdomains_changed_ = true, constraints_changed_ = true, modes_changed_ = false;
};
} // namespace amontons
