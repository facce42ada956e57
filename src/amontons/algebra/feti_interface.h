#pragma once
#include "amontons/algebra/feti_copies.h"
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
  Sharing nodes{};                  ///< of the process's nodes; where processes share none it may be left out
};

/// Copies of the unknowns in subdomains, and which of them are boundary unknowns.
///
/// Columns of the gluing matrix B: the boundary unknowns of each subdomain, one subdomain after the other, then the
/// rigid unknowns (those of rigid bodies, which are no nodal component of their own). Where a node has copies, each
/// bears the share of its stiffness in the sum of the copies' (for one material and even cells: multiplicity scaling).
///
/// Over several processes a process has, of the subdomains of others, the columns of the nodes that it has too: those
/// of its neighbours' copies, and of all nodes of its constraints. So it knows every gluing row whole that touches an
/// own column, and the rows of its constraints. The order of columns is the same on all processes that have them; rigid
/// unknowns are on all.
class FetiInterface
{
public:
  /// Nodes that several subdomains share, that are held or move with a rigid body, and contact nodes are boundary; so
  /// are a few more where those would not show every rigid motion. Collective.
  FetiInterface(const Layout &layout, std::span<const SubdomainMatrix> subdomains, const FetiOptions &options);

  /// Takes the subdomains' present values, for the shares. Collective.
  void update_shares();

  [[nodiscard]] int dim() const { return dim_; }
  [[nodiscard]] FetiCopies &copies() { return copies_; }
  [[nodiscard]] const FetiCopies &copies() const { return copies_; }
  [[nodiscard]] Index n_columns() const { return first_column_.back() + static_cast<Index>(rigid_unknowns_.size()); }
  /// Of an own subdomain.
  [[nodiscard]] Index first_column(std::size_t s) const { return first_of(copies_.first_own_subdomain() + s); }
  /// Of one counted over all processes; one past the last gives the end.
  [[nodiscard]] Index first_of(std::size_t subdomain) const { return first_column_[subdomain]; }
  [[nodiscard]] Index first_own_column() const { return first_column(0); }
  [[nodiscard]] Index end_of_own_columns() const { return first_column(subdomains_.size()); }
  [[nodiscard]] Index first_rigid_column() const { return first_column_.back(); }
  [[nodiscard]] Index n_rigid() const { return static_cast<Index>(rigid_unknowns_.size()); }
  /// What a column is on every process: a subdomain, counted over all processes, and a local unknown of it.
  struct Place
  {
    Index subdomain, unknown;
  };
  /// Of a column before the rigid ones.
  [[nodiscard]] Place place(Index column) const
  {
    const Place &first = places_[column / dim_];
    return {first.subdomain, first.unknown + column % dim_};
  }
  /// Of a place on the boundary of an own subdomain.
  [[nodiscard]] Index own_column(const Place &place) const;
  /// Local unknowns of a subdomain's boundary, ascending.
  [[nodiscard]] const std::vector<Index> &boundary(std::size_t s) const { return boundary_[s]; }
  [[nodiscard]] bool on_boundary(Index node) const { return is_boundary_[node] != 0; }
  /// Rigid motions of a subdomain, [n_rows x 6], 3 in the plane, 1 in axisymmetry.
  [[nodiscard]] Eigen::MatrixXd motions(std::size_t s) const;
  /// 1/d of each column, d the mean of the copy's diagonal; zero for rigid unknowns, which give way to nothing.
  [[nodiscard]] std::vector<double> inverse_stiffness() const;

  /// Rows that glue copies, hold what is held and tie nodes to rigid bodies: u = 0 on each. They are orthonormal in the
  /// inner product of inverse_stiffness(), and orthogonal to every row made of append().
  ///
  /// A process has the rows of its own copies. Each row is one process's own: first come others', then its own.
  [[nodiscard]] FetiRows glue() const;
  [[nodiscard]] Index n_glue_rows_of_others() const { return n_glue_rows_of_others_; }
  /// Which processes have which gluing rows.
  [[nodiscard]] const Sharing &glue_sharing() const { return glue_sharing_; }
  /// Adds coefficient * (nodal component) to a row, spread over the copies.
  void append(Index nodal, double coefficient, std::vector<FetiRows::Entry> &row) const;
  [[nodiscard]] Index rigid_column(Index unknown) const { return first_rigid_column() + rigid_of_unknown_[unknown]; }

  /// Forces on unknowns to forces on own copies. @param local unknowns of all subdomains, one after the other [n_local]
  /// @param rigid [n_rigid]
  void distribute(std::span<const double> unknowns, std::span<double> local, std::span<double> rigid) const;
  /// Displacements of copies, averaged by their shares, to unknowns; the same on all processes. Collective.
  /// @param unknowns overwritten
  void average(std::span<const double> local, std::span<const double> rigid, std::span<double> unknowns) const;
  [[nodiscard]] Index first_local(std::size_t s) const { return first_local_[s]; }
  [[nodiscard]] Index n_local() const { return first_local_.back(); }

private:
  void find_rigid_unknowns();
  void find_boundary();
  void show_motions();
  void number_columns();
  void share_glue();
  [[nodiscard]] bool is_free(Index nodal) const;
  /// Calls row(nodal, k) for the gluing row of the k-th copy, row after row.
  template<class Row>
  void for_each_glue_row(bool own, Row &&row) const;
  /// Of an own copy, among the local unknowns of all own subdomains.
  [[nodiscard]] std::size_t place_of(const FetiCopy &copy) const
  {
    return static_cast<std::size_t>(first_local_[copy.subdomain - copies_.first_own_subdomain()]) + copy.node * dim_;
  }

  const Layout &layout_;
  std::span<const SubdomainMatrix> subdomains_;
  const FetiOptions &options_;
  int dim_;
  FetiCopies copies_;
  std::vector<Index> rigid_unknowns_, rigid_of_unknown_;
  std::vector<char> is_boundary_;            ///< by node
  std::vector<std::vector<Index>> boundary_; ///< by subdomain
  std::vector<Index> first_column_;          ///< by subdomain, over all processes
  std::vector<Place> places_;                ///< of the first component of each boundary node's copy, by column
  std::vector<Index> first_local_;           ///< by own subdomain
  Sharing glue_sharing_;
  Index n_glue_rows_of_others_ = 0;
};
} // namespace amontons
