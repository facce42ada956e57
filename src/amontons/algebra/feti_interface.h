#pragma once
#include "amontons/algebra/feti_rows.h"
#include "amontons/algebra/layout.h"
#include "amontons/algebra/subdomain_matrix.h"

#include <Eigen/Core>

namespace amontons
{
/// What FETI has to know of the bodies besides their stiffness.
struct FetiOptions
{
  std::vector<double> points;       ///< [n_nodes * n_components] reference coordinates of the subdomains' nodes
  bool axisymmetric = false;        ///< x is the radius: only a motion along y strains nothing
  std::vector<Index> contact_nodes; ///< nodes that may come into contact: boundary from the start
  bool lumped = false;              ///< the lumped preconditioner instead of Dirichlet's
};

/// Copies of the unknowns in subdomains, and which of them are boundary unknowns.
///
/// Columns of the gluing matrix B: the boundary unknowns of each subdomain, one subdomain after the other, then the
/// rigid unknowns (those of rigid bodies, which are no nodal component of their own). Where a node has copies, each
/// bears the share of its stiffness in the sum of the copies' (for one material and even cells: multiplicity scaling).
class FetiInterface
{
public:
  /// Nodes that several subdomains share, that are held or move with a rigid body, and contact nodes are boundary; so
  /// are a few more where those would not show every rigid motion.
  FetiInterface(const Layout &layout, std::span<const SubdomainMatrix> subdomains, const FetiOptions &options);

  /// Takes the subdomains' present values, for the shares.
  void update_shares();

  [[nodiscard]] Index n_columns() const { return first_column_.back() + static_cast<Index>(rigid_unknowns_.size()); }
  [[nodiscard]] Index first_column(std::size_t s) const { return first_column_[s]; }
  [[nodiscard]] Index first_rigid_column() const { return first_column_.back(); }
  [[nodiscard]] Index n_rigid() const { return static_cast<Index>(rigid_unknowns_.size()); }
  /// Local unknowns of a subdomain's boundary, ascending.
  [[nodiscard]] const std::vector<Index> &boundary(std::size_t s) const { return boundary_[s]; }
  [[nodiscard]] bool on_boundary(Index node) const { return is_boundary_[node] != 0; }
  /// Rigid motions of a subdomain, [n_rows x 6], 3 in the plane, 1 in axisymmetry.
  [[nodiscard]] Eigen::MatrixXd motions(std::size_t s) const;
  /// 1/d of each column, d the mean of the copy's diagonal; zero for rigid unknowns, which give way to nothing.
  [[nodiscard]] std::vector<double> inverse_stiffness() const;

  /// Rows that glue copies, hold what is held and tie nodes to rigid bodies: u = 0 on each. They are orthonormal in the
  /// inner product of inverse_stiffness(), and orthogonal to every row made of append().
  [[nodiscard]] FetiRows glue() const;
  /// Adds coefficient * (nodal component) to a row, spread over the copies.
  void append(Index nodal, double coefficient, std::vector<FetiRows::Entry> &row) const;
  [[nodiscard]] Index rigid_column(Index unknown) const { return first_rigid_column() + rigid_of_unknown_[unknown]; }

  /// Forces on unknowns to forces on copies. @param local unknowns of all subdomains, one after the other [n_local]
  /// @param rigid [n_rigid]
  void distribute(std::span<const double> unknowns, std::span<double> local, std::span<double> rigid) const;
  /// Displacements of copies, averaged by their shares, to unknowns. @param unknowns overwritten
  void average(std::span<const double> local, std::span<const double> rigid, std::span<double> unknowns) const;
  [[nodiscard]] Index first_local(std::size_t s) const { return first_local_[s]; }
  [[nodiscard]] Index n_local() const { return first_local_.back(); }

private:
  struct Copy
  {
    Index subdomain, node; ///< local node
    double stiffness = 0, share = 1;
  };
  void find_copies();
  void find_rigid_unknowns();
  void find_boundary();
  void number_columns();
  [[nodiscard]] bool is_free(Index nodal) const;
  [[nodiscard]] std::span<const Copy> copies(Index node) const
  {
    return {copies_.data() + copy_offsets_[node],
            static_cast<std::size_t>(copy_offsets_[node + 1] - copy_offsets_[node])};
  }
  [[nodiscard]] Index column(const Copy &copy, int component) const
  {
    return place_[first_local_[copy.subdomain] + copy.node * dim_ + component];
  }

  const Layout &layout_;
  std::span<const SubdomainMatrix> subdomains_;
  const FetiOptions &options_;
  int dim_;
  std::vector<Index> copy_offsets_;
  std::vector<Copy> copies_;
  std::vector<Index> rigid_unknowns_, rigid_of_unknown_;
  std::vector<char> is_boundary_;            ///< by node
  std::vector<std::vector<Index>> boundary_; ///< by subdomain
  std::vector<Index> first_column_, first_local_;
  std::vector<Index> place_; ///< [n_local] column, -1 for interior unknowns
};
} // namespace amontons
