#pragma once
#include "amontons/algebra/feti_cholmod.h"
#include "amontons/algebra/subdomain_matrix.h"

#include <Eigen/Core>

#include <optional>

namespace amontons
{
/// The stiffness K of one floating subdomain, condensed on its boundary unknowns.
///
/// With i the interior and b the boundary unknowns, S = K_bb - K_bi K_ii^-1 K_ib is the Schur complement. Its kernel
/// are the rigid motions R_b that K resists not; with Q their orthonormal basis on the boundary, (S + rho Q Q^T)^-1 is
/// an exact generalised inverse of S (it equals S^+ + Q Q^T / rho), and the boundary part of one of K. No pivot is
/// guessed at. Both dense matrices are stored in single precision, packed: whoever iterates with them corrects by
/// residuals in double precision.
class SubdomainFactor
{
public:
  /// @param matrix symmetric positive semidefinite; must outlive this
  /// @param boundary local unknowns, ascending
  /// @param motions [n_rows x n] motions among which the kernel is, linearly independent on the boundary
  SubdomainFactor(CholmodSession &session, const SubdomainMatrix &matrix, std::vector<Index> boundary,
                  const Eigen::MatrixXd &motions);

  /// Takes the matrix's present values. @throws NumericalFailure if K has a kernel beyond the motions
  void factorize();

  [[nodiscard]] Index n_boundary() const { return static_cast<Index>(boundary_.size()); }
  [[nodiscard]] std::span<const Index> boundary() const { return boundary_; }
  /// Q, [n_boundary x n_kernel]
  [[nodiscard]] const Eigen::MatrixXd &kernel() const { return kernel_; }

  /// y = (S + rho Q Q^T)^-1 x on the boundary.
  void apply_flexibility(const double *x, double *y) const;
  /// y = S x (for the Dirichlet preconditioner).
  void apply_stiffness(const double *x, double *y) const;
  /// y = K_bb x (for the lumped preconditioner).
  void apply_boundary_stiffness(const double *x, double *y) const;

  /// f_b - K_bi K_ii^-1 f_i. @param force [n_rows] @param condensed [n_boundary]
  void condense(std::span<const double> force, double *condensed);
  /// Boundary displacement to that of all unknowns: u_i = K_ii^-1 (f_i - K_ib u_b). @param displacement [n_rows]
  void expand(std::span<const double> force, const double *boundary_displacement, std::span<double> displacement);

private:
  void split();
  void factorize_interior();
  [[nodiscard]] std::vector<double> schur_complement();
  void find_kernel();
  void invert(std::vector<float> &dense);

  const SubdomainMatrix &matrix_;
  std::vector<Index> boundary_, interior_;
  std::vector<Index> place_; ///< [n_rows] place among the boundary unknowns, or -1 - place among the interior ones
  Eigen::MatrixXd motions_, kernel_;
  std::optional<SparseCholesky> inner_;
  CholmodSession *session_;
  std::vector<float> flexibility_, stiffness_; ///< packed lower triangles, by columns
  mutable std::vector<float> x_, y_;
  std::vector<double> work_;
};
} // namespace amontons
