#pragma once
#include "amontons/algebra/feti_cholmod.h"
#include "amontons/algebra/feti_rows.h"
#include "amontons/parallel/sharing.h"

#include <Eigen/Core>

#include <functional>

namespace amontons
{
/// Kernels of all subdomains, R, over the columns of B: each column belongs to one owner (a subdomain, a rigid unknown)
/// or to none, and has a row of its owner's basis. Owners are counted over all processes.
class FetiKernel
{
public:
  void clear();
  /// The next columns: an owner with this basis on them. @param basis [n_columns x n_kernel], may have no column
  void add_owner(const Eigen::MatrixXd &basis);
  /// Columns without an owner.
  void add_columns(Index n) { owner_.insert(owner_.end(), static_cast<std::size_t>(n), -1); }
  void drop_columns(Index n_left) { owner_.resize(static_cast<std::size_t>(n_left)); }

  [[nodiscard]] Index n_owners() const { return static_cast<Index>(first_.size()) - 1; }
  [[nodiscard]] Index size() const { return first_.back(); }
  [[nodiscard]] Index first(Index owner) const { return first_[owner]; }
  [[nodiscard]] Index size(Index owner) const { return first_[owner + 1] - first_[owner]; }
  [[nodiscard]] Index owner(Index column) const { return owner_[column]; }
  [[nodiscard]] const double *basis(Index column) const { return basis_.data() + basis_offset_[column]; }

  /// v += R alpha
  void expand_add(std::span<const double> alpha, std::span<double> v) const;
  /// alpha = R^T v
  void restrict(std::span<const double> v, std::span<double> alpha) const;
  /// The row b R of G for a row b of B. @param out overwritten, by coarse unknowns ascending
  void restrict_row(std::span<const FetiRows::Entry> row, std::vector<FetiRows::Entry> &out) const;
  /// Of these columns, each once, ascending.
  [[nodiscard]] std::vector<Index> owners_of(std::span<const FetiRows::Entry> row) const;
  /// The owner of a coarse unknown.
  [[nodiscard]] Index owner_of_unknown(Index unknown) const;

private:
  std::vector<Index> owner_; ///< [n_columns]
  std::vector<Index> first_{0};
  std::vector<std::size_t> basis_offset_; ///< by column
  std::vector<double> basis_;
};

/// The coarse problem E = G^T G, G = B R, factorised sparse; over several processes by each of them.
///
/// Where rows of B do not hold every motion, E is singular. Its kernel N is then found with the number of its
/// dimensions given, as many entries are pinned, and solutions are exact for right sides orthogonal to N.
class FetiCoarse
{
public:
  FetiCoarse(CholmodSession &session, const FetiKernel &kernel)
    : kernel_(kernel)
    , factor_(session)
  {
  }

  /// Collective. @param couple calls back with every set of owners that a row of this process may couple
  void set_pattern(const std::function<void(const std::function<void(std::span<const Index>)> &)> &couple,
                   const Sharing &processes);
  void copy_pattern(const FetiCoarse &other);
  [[nodiscard]] std::vector<double> zeros() const { return std::vector<double>(pattern_.rows.size(), 0.0); }
  /// values += g g^T, g a row of G with its coarse unknowns ascending.
  void add(std::span<const FetiRows::Entry> g, std::span<double> values) const;
  /// @param n_free dimensions of the kernel that is expected
  /// @return whether E has that kernel (n_free > 0); false if it is regular
  /// @throws NumericalFailure if E is singular and n_free = 0
  bool factorize(std::vector<double> values, Index n_free);
  /// x = E^-1 x
  void solve(std::span<double> x);
  /// N, [size x n_free]
  [[nodiscard]] const Eigen::MatrixXd &free_motions() const { return free_; }

private:
  void lay_out(const std::vector<std::vector<Index>> &lower);
  [[nodiscard]] std::vector<Index> choose_pins(std::span<const double> values, Index n_free);
  [[nodiscard]] bool find_free_motions(std::vector<double> &values, Index n_free);
  [[nodiscard]] Eigen::MatrixXd product(std::span<const double> values, const Eigen::MatrixXd &x) const;
  [[nodiscard]] Index diagonal(Index i) const { return pattern_.offsets[i + 1] - 1; }

  const FetiKernel &kernel_;
  SparseCholesky factor_;
  SymmetricPattern pattern_;
  std::vector<std::vector<std::pair<Index, Index>>> neighbours_; ///< by owner: lower owners, place in the column
  std::vector<double> scale_;
  Eigen::MatrixXd free_;
};
} // namespace amontons
