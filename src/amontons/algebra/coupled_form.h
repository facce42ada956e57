#pragma once
#include "amontons/algebra/layout.h"
#include "amontons/algebra/linear_solver.h"
#include "amontons/algebra/subdomain_matrix.h"
#include "amontons/algebra/system_form.h"

#include <memory>
#include <span>
#include <vector>

namespace amontons
{
/// The coupled form: displacements and multipliers in one indefinite matrix
///     [ K + K_c   B_f ]
///     [ B         D   ],
/// optionally bordered by the held modes. Over several processes the matrix is the sum of what each adds: its
/// subdomains and constraints, dense blocks and a mode's entries of unknowns that it owns.
class CoupledForm : public SystemForm
{
public:
  CoupledForm(const Layout &layout, std::span<const SubdomainMatrix> subdomains, std::unique_ptr<LinearSolver> solver);

  void set_constraints(std::vector<ConstraintPattern> constraints,
                       std::vector<std::vector<Index>> dense_blocks) override;
  bool set_held_modes(std::vector<std::vector<double>> modes) override;
  bool prepare() override;
  void update_subdomains() override;
  void update_constraint(std::size_t k, const ConstraintValues &values) override;
  void update_dense_block(std::size_t k, const Eigen::MatrixXd &values) override;
  void factorize() override;
  void solve(std::span<const double> rhs, std::span<double> solution, double tolerance) override;
  [[nodiscard]] std::span<const double> mode_reactions() const override { return mode_reactions_; }
  [[nodiscard]] const std::vector<ConstraintPattern> &constraints() const override { return constraints_; }
  [[nodiscard]] FormCounters counters() const override;

private:
  template<class Emit>
  void visit_subdomains(Emit &&emit) const;
  template<class Emit>
  void visit_constraint(const ConstraintPattern &pattern, Emit &&emit) const;
  void build_pattern();
  void share_rows();

  const Layout &layout_;
  std::span<const SubdomainMatrix> subdomains_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<ConstraintPattern> constraints_;
  std::vector<std::vector<Index>> dense_blocks_;
  std::vector<std::vector<double>> modes_;
  std::vector<char> counts_dense_block_; ///< whether it is counted here
  std::vector<std::size_t> constraint_offsets_, dense_offsets_;
  std::vector<double> entries_;  ///< in the order in which they are visited
  std::vector<Index> positions_; ///< of the entries among the matrix's values
  SparseMatrix matrix_;
  Sharing rows_;
  std::vector<double> mode_reactions_;
  bool pattern_built_ = false;
};
} // namespace amontons
