#pragma once
#include "amontons/algebra/feti_coarse.h"
#include "amontons/algebra/feti_contact.h"
#include "amontons/algebra/feti_directions.h"
#include "amontons/algebra/feti_interface.h"
#include "amontons/algebra/subdomain_factor.h"

#include <memory>
#include <optional>
#include <set>

namespace amontons
{
/// What a solution gives.
struct FetiStep
{
  std::vector<double> unknowns; ///< [n_displacement_unknowns]
  std::vector<double> rows;     ///< multiplier of each contact row of this process
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
///     (B_f D^-1 B_f^T)^-1 B_f D^-1 S D^-1 B^T (B D^-1 B^T)^-1,
/// the inverses being polynomials (FetiScaling).
/// A change of contact rows touches no subdomain. Held modes are dense rows over the displacement unknowns.
///
/// Over several processes each works on its own subdomains. A vector over the rows has, on each process, the gluing
/// and contact rows that touch its subdomains and the contact rows that it gives, copies equal bit by bit. An iteration
/// costs two exchanges of gluing rows with the neighbours, two of contact rows and one more for each degree of the two
/// scalings with the processes on the other side of the contact, and five reductions: one of the coarse problem's right
/// side, one of it and a norm, three of inner products. The coarse problem is solved by every process. All calls are
/// collective.
class FetiDual
{
public:
  /// @throws LinearSolverFailure, NumericalFailure as all members: the same on all processes
  FetiDual(const Layout &layout, std::span<const SubdomainMatrix> subdomains, FetiOptions options);

  [[nodiscard]] const FetiInterface &interface() const { return *interface_; }
  [[nodiscard]] const FetiOptions &options() const { return options_; }

  /// Factorises the subdomains' present values.
  void update_bodies();
  /// @param nodal_sets nodal components that a contact row of this process may couple, whatever the status
  /// @param rigid_sets rigid unknowns that one may
  void set_couplings(const std::vector<std::span<const Index>> &nodal_sets,
                     const std::vector<std::span<const Index>> &rigid_sets);
  /// @param contact of this process @param modes each over the displacement unknowns
  void set_rows(FetiContactRows contact, const std::vector<std::vector<double>> &modes);

  /// @param forces [n_displacement_unknowns] @param gaps of the contact rows of this process
  /// @param motions of the held modes
  /// @param reduction the residual forces' norm over what it is at the start, where the iteration may stop
  /// @param target or the norm itself
  [[nodiscard]] FetiStep solve(std::span<const double> forces, std::span<const double> gaps,
                               std::span<const double> motions, double reduction, double target);

  /// Of this process.
  [[nodiscard]] Index n_contact_rows() const { return contact_.n_own(); }
  [[nodiscard]] std::int64_t n_factorizations() const { return n_factorizations_; }
  [[nodiscard]] std::int64_t n_setups() const { return n_setups_; }
  [[nodiscard]] std::int64_t n_iterations() const { return n_iterations_; }

private:
  void factorize_subdomains();
  void build_kernel();
  [[nodiscard]] std::set<std::vector<Index>>
  contact_couplings(const std::vector<std::span<const Index>> &nodal_sets,
                    const std::vector<std::span<const Index>> &rigid_sets) const;
  void find_contact_entries(const std::set<std::vector<Index>> &couplings);
  [[nodiscard]] std::vector<double> gram(bool forces) const;
  void factorize_coarse(Index n_modes);
  void forget_given();
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
  /// The part of B v, or B_f v, that comes from own columns; v is zero on others.
  [[nodiscard]] std::vector<double> part_of_rows(std::span<const double> v, bool forces) const;
  /// G alpha, or G_f alpha.
  [[nodiscard]] std::vector<double> rows_of_motions(std::span<const double> alpha, bool forces) const;
  /// Sums the parts of all processes.
  void sum_rows(std::vector<double> &parts) const;
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
  [[nodiscard]] FetiCoarse &coarse(bool forces)
  {
    return forces && !contact_.is_symmetric() ? *coarse_forces_ : *coarse_;
  }
  [[nodiscard]] Index n_columns() const { return contact_.n_columns(); }
  [[nodiscard]] std::span<double> contact_part(std::vector<double> &x) const
  {
    return std::span(x).subspan(static_cast<std::size_t>(glue_.size()));
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
  std::vector<double> glue_gram_;      ///< the gluing rows' part of G^T G
  std::vector<Index> contact_entries_; ///< of G^T G, those that contact rows may change
  FetiRows glue_;
  FetiContactRows given_;
  FetiContact contact_;
  std::vector<double> inverse_stiffness_;
  double mean_inverse_stiffness_ = 0;
  std::vector<std::vector<double>> modes_, mode_loads_; ///< mode_loads_: R^T of the condensed modes
  std::vector<std::vector<double>> free_motions_;       ///< over the unknowns
  bool singular_ = false;
  FetiDirections directions_;
  std::vector<double> local_, rigid_;
  std::int64_t n_factorizations_ = 0, n_setups_ = 0, n_iterations_ = 0;
};
} // namespace amontons
