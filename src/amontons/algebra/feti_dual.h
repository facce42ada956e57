#pragma once
#include "amontons/algebra/feti_coarse.h"
#include "amontons/algebra/feti_directions.h"
#include "amontons/algebra/feti_interface.h"
#include "amontons/algebra/subdomain_factor.h"

#include <memory>
#include <optional>

namespace amontons
{
/// Rows of B beyond the gluing: contact, and small stiffnesses taken as springs of their own.
struct FetiContactRows
{
  FetiRows rows, forces;       ///< of B and of B_f; columns of FetiInterface, then one column per spring
  std::vector<double> springs; ///< stiffness of each spring, of either sign
  bool symmetric = true;       ///< forces equal rows

  friend bool operator==(const FetiContactRows &, const FetiContactRows &) = default;
};

/// What a solution gives.
struct FetiStep
{
  std::vector<double> unknowns; ///< [n_displacement_unknowns]
  std::vector<double> rows;     ///< multiplier of each contact row
  std::vector<double> modes;    ///< reaction of each held mode
};

/// Total FETI (Dostal, Horak, Kucera 2006; Farhat, Roux 1991) with contact rows in B:
///     [ K  B_f^T ] [ u      ]   [ f ]
///     [ B  0     ] [ lambda ] = [ g ],
/// K block-diagonal over floating subdomains, eliminated by u = F (f - B_f^T lambda) + R alpha, F the subdomains'
/// flexibilities, R their kernels. With G = B R and G_f = B_f R the residual B u - g is projected by I - G (G^T G)^-1
/// G^T and the multipliers by I - G_f (G_f^T G_f)^-1 G_f^T, so that u exists and alpha drops out; both coarse matrices
/// are symmetric positive definite, with friction too. Rows are scaled such that B D^-1 B^T, D the boundary's diagonal,
/// is the identity but for contact rows among each other; the preconditioner is
///     (B_f D^-1 B_f^T)^-1 B_f D^-1 S D^-1 B^T (B D^-1 B^T)^-1.
/// A change of contact rows touches no subdomain. Held modes are dense rows over the displacement unknowns.
///
/// Over several processes each works on its own subdomains. A vector over the rows has, on each process, the gluing
/// rows that touch its subdomains and all contact rows, copies equal bit by bit; contact rows and springs are given by
/// all alike. An iteration costs two exchanges of gluing rows with the neighbours, and six reductions: one of the
/// contact rows and the coarse problem's right side together, one of that right side and a norm, one of the contact
/// rows, three of inner products. The coarse problem is solved by every process. All calls are collective.
class FetiDual
{
public:
  /// @throws LinearSolverFailure, NumericalFailure as all members: the same on all processes
  FetiDual(const Layout &layout, std::span<const SubdomainMatrix> subdomains, FetiOptions options);

  [[nodiscard]] const FetiInterface &interface() const { return *interface_; }
  [[nodiscard]] const FetiOptions &options() const { return options_; }

  /// Factorises the subdomains' present values.
  void update_bodies();
  /// @param nodal_sets nodal components that a contact row may couple, whatever the status
  /// @param rigid_sets rigid unknowns that one may
  void set_couplings(const std::vector<std::span<const Index>> &nodal_sets,
                     const std::vector<std::span<const Index>> &rigid_sets);
  /// @param modes each over the displacement unknowns
  void set_rows(FetiContactRows contact, const std::vector<std::vector<double>> &modes);

  /// @param forces [n_displacement_unknowns] @param gaps of the contact rows @param motions of the held modes
  /// @param reduction the residual forces' norm over what it is at the start, where the iteration may stop
  /// @param target or the norm itself
  [[nodiscard]] FetiStep solve(std::span<const double> forces, std::span<const double> gaps,
                               std::span<const double> motions, double reduction, double target);

  [[nodiscard]] Index n_contact_rows() const { return contact_.rows.size(); }
  [[nodiscard]] std::int64_t n_factorizations() const { return n_factorizations_; }
  [[nodiscard]] std::int64_t n_setups() const { return n_setups_; }
  [[nodiscard]] std::int64_t n_iterations() const { return n_iterations_; }

private:
  /// (B D^-1 B^T)^-1 among contact rows.
  struct Scaling
  {
    std::optional<SparseCholesky> factor;
  };
  void factorize_subdomains();
  void build_kernel();
  void build_contact_problem(Index n_modes);
  void build_scaling(const FetiRows &rows, Scaling &scaling);
  void scale_rows();
  void set_modes(const std::vector<std::vector<double>> &modes);
  [[nodiscard]] Eigen::MatrixXd mode_products(const std::vector<std::span<const double>> &vectors) const;
  [[nodiscard]] FetiStep solve_regular(std::span<const double> forces, std::span<const double> gaps, double reduction,
                                       double target);
  [[nodiscard]] FetiStep solve_free(std::vector<double> forces, std::span<const double> gaps,
                                    std::span<const double> motions, double reduction, double target);
  [[nodiscard]] FetiStep solve_bordered(std::span<const double> forces, std::span<const double> gaps,
                                        std::span<const double> motions, double reduction, double target);
  void iterate(std::vector<double> &multipliers, std::vector<double> &z, double reduction, double target);

  [[nodiscard]] std::vector<double> condense(std::span<const double> forces);
  [[nodiscard]] std::vector<double> expand(std::span<const double> boundary);
  [[nodiscard]] std::vector<double> kernel_loads(std::span<const double> condensed) const;
  /// B v, B_f v with `forces`: on all processes where v is known on all columns, else the part of those it is known on.
  [[nodiscard]] std::vector<double> rows_of(std::span<const double> v, bool forces = false) const;
  /// B v - gaps of the contact rows, and G^T of it, for v known on own columns.
  struct Jump
  {
    std::vector<double> rows, loads;
  };
  [[nodiscard]] Jump jump(std::span<const double> v, std::span<const double> row_gaps) const;
  /// B^T lambda, or with B_f.
  [[nodiscard]] std::vector<double> pull(std::span<const double> multipliers, bool forces) const;
  /// The norm of B_f^T z, and G_f^T z.
  struct Pull
  {
    double norm;
    std::vector<double> loads;
  };
  [[nodiscard]] Pull measure(std::span<const double> z) const;
  [[nodiscard]] std::vector<double> flexibility(std::span<const double> v) const;
  [[nodiscard]] std::vector<double> precondition(std::vector<double> r);
  /// x - G (G^T G)^-1 G^T x, or with G_f. @param loads G^T x
  void project(std::vector<double> &x, std::vector<double> loads, bool forces);
  [[nodiscard]] FetiCoarse &coarse(bool forces) { return forces && !contact_.symmetric ? *coarse_forces_ : *coarse_; }
  [[nodiscard]] Index n_columns() const
  {
    return interface_->n_columns() + static_cast<Index>(contact_.springs.size());
  }
  /// What all processes know is counted by the first.
  [[nodiscard]] bool counts_common() const { return processes_.rank() == 0; }

  const Layout &layout_;
  std::span<const SubdomainMatrix> subdomains_;
  FetiOptions options_;
  Sharing processes_, setup_processes_; ///< for sums over them, counted by phase
  CholmodSession session_;
  std::unique_ptr<FetiInterface> interface_;
  std::vector<SubdomainFactor> factors_;
  FetiKernel kernel_;
  std::optional<FetiCoarse> coarse_, coarse_forces_;
  std::vector<double> glue_gram_; ///< the gluing rows' part of G^T G
  FetiRows glue_;
  FetiContactRows given_, contact_; ///< as given, and scaled
  std::vector<double> row_scale_, inverse_stiffness_;
  double mean_inverse_stiffness_ = 0;
  Scaling scaling_, scaling_forces_;
  std::vector<std::vector<double>> modes_, mode_loads_; ///< mode_loads_: R^T of the condensed modes
  std::vector<std::vector<double>> free_motions_;       ///< over the unknowns
  bool singular_ = false;
  FetiDirections directions_;
  std::vector<double> local_, rigid_;
  std::int64_t n_factorizations_ = 0, n_setups_ = 0, n_iterations_ = 0;
};
} // namespace amontons
