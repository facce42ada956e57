#pragma once
#include "amontons/algebra/constraint_rows.h"
#include "amontons/algebra/feti_dual.h"
#include "amontons/algebra/system_form.h"

namespace amontons
{
/// The system solved by total FETI with the contact's rows in B (FetiDual): constraints are reduced to their proper
/// rows (constraint_rows.h), and what stiffness is left becomes springs.
///
/// Subdomains are factorised when their values change, and not when statuses or pairs do. Its iterations work on
/// matrices in single precision; the residual of the system itself, in double precision, is corrected until it is as
/// small as asked for.
class FetiForm : public SystemForm
{
public:
  /// @param subdomains each hanging together by facets, of a stiffness without kernel but rigid motions and springs
  FetiForm(const Layout &layout, std::span<const SubdomainMatrix> subdomains, FetiOptions options);

  void set_constraints(std::vector<ConstraintPattern> constraints,
                       std::vector<std::vector<Index>> dense_blocks) override;
  bool set_held_modes(std::vector<std::vector<double>> modes) override;
  bool prepare() override;
  void update_subdomains() override { bodies_changed_ = true; }
  void update_constraint(std::size_t k, const ConstraintValues &values) override;
  void update_dense_block(std::size_t k, const Eigen::MatrixXd &values) override { dense_values_[k] = values; }
  void factorize() override;
  /// @param tolerance at least 1e-10 is asked for where it is zero
  void solve(std::span<const double> rhs, std::span<double> solution, double tolerance) override;
  [[nodiscard]] std::span<const double> mode_reactions() const override { return mode_reactions_; }
  [[nodiscard]] const std::vector<ConstraintPattern> &constraints() const override { return constraints_; }
  [[nodiscard]] FormCounters counters() const override;

private:
  /// Residuals, or a right side, of the system that FetiDual solves.
  struct Residual
  {
    std::vector<double> forces, gaps, motions;
    double norm = 0; ///< as forces
  };
  [[nodiscard]] FetiContactRows contact_rows() const;
  void append_row(FetiContactRows &out, const ConstraintPattern &pattern, const Eigen::VectorXd &row,
                  const Eigen::VectorXd &force, double spring) const;
  void append_dense_block(FetiContactRows &out, std::size_t block) const;
  [[nodiscard]] std::vector<double> sum_forces(std::span<const double> whole,
                                               std::span<const double> nodal_parts) const;
  [[nodiscard]] Residual reduced_right_side(std::span<const double> rhs) const;
  [[nodiscard]] Residual residual(const Residual &right_side, const FetiStep &step) const;
  void subtract_constraints(std::span<const double> nodal, const FetiStep &step, std::span<double> nodal_forces,
                            Residual &out) const;
  void measure(Residual &residual) const;
  [[nodiscard]] Eigen::VectorXd on_pattern(const ConstraintPattern &pattern, std::span<const double> nodal) const;
  [[nodiscard]] std::vector<double> nodal(std::span<const double> unknowns) const;
  void recover(std::span<const double> rhs, const FetiStep &step, std::span<double> solution) const;

  const Layout &layout_;
  std::span<const SubdomainMatrix> subdomains_;
  std::unique_ptr<FetiDual> dual_;
  std::vector<ConstraintPattern> constraints_;
  std::vector<ConstraintRows> reduced_; ///< by constraint
  std::vector<double> augmentation_;    ///< by constraint
  std::vector<std::vector<Index>> dense_blocks_;
  std::vector<Eigen::MatrixXd> dense_values_;
  std::vector<std::vector<double>> modes_;
  std::vector<double> mode_reactions_;
  std::int64_t n_pattern_builds_ = 0, n_earlier_factorizations_ = 0;
  bool first_ = true, bodies_changed_ = true, pattern_changed_ = true;
};
} // namespace amontons
