#include "amontons/contact/mortar_face.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace amontons
{
namespace
{
/// Part of a node's share of a face that must be covered.
constexpr double least_share = 1e-6;
/// Part of a face that may be missing where it counts as covered wholly.
constexpr double least_part = 1e-9;
constexpr int max_corners = 4, n_own = OverlapIntegrals::n_own;

using CornerVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_corners, 1>;
using CornerMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_corners, max_corners>;

/// Sums over the faces seen; gradients have a row for each integral, [row i * n + k] of N_i N_k and
/// [row target * n + i] of N_i N_target.
struct FaceSums
{
  double size = 0, ring_size = 0, facing = 0;
  CornerMatrix mass;
  RowMatrix mixed; ///< [n_targets x n]
  RowMatrix mass_gradient, mixed_gradient;
};

std::vector<Index> nodes_of(std::span<const SeenFace> seen)
{
  std::vector<Index> out;
  for (const SeenFace &face : seen)
    out.insert(out.end(), face.nodes.begin(), face.nodes.end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Adds the derivatives of one integral to its row.
template<class From>
void add_gradient(const From &from, std::span<const int> places, RowMatrix &to, Eigen::Index row)
{
  to.row(row).head<n_own>() += from.template head<n_own>();
  for (std::size_t k = 0; k < places.size(); ++k)
    to.row(row).segment<2>(n_own + 2 * places[k]) += from.template segment<2>(n_own + 2 * static_cast<Eigen::Index>(k));
}

FaceSums sum(int n, std::span<const SeenFace> seen, const std::vector<Index> &targets, bool with_gradient)
{
  const auto n_targets = static_cast<Eigen::Index>(targets.size()), n_variables = n_own + 2 * n_targets;
  FaceSums out{0, 0, 0, CornerMatrix::Zero(n, n), RowMatrix::Zero(n_targets, n), {}, {}};
  if (with_gradient)
  {
    out.mass_gradient = RowMatrix::Zero(n * n, n_variables);
    out.mixed_gradient = RowMatrix::Zero(n_targets * n, n_variables);
  }
  for (const auto &[nodes, integrals, facing] : seen)
  {
    std::array<int, max_corners> places{};
    for (std::size_t k = 0; k < nodes.size(); ++k)
      places[k] = static_cast<int>(std::lower_bound(targets.begin(), targets.end(), nodes[k]) - targets.begin());
    const std::span<const int> used(places.data(), nodes.size());
    out.size += integrals.size;
    out.facing += facing * integrals.size;
    out.ring_size += integrals.ring_size;
    out.mass += integrals.mass.topLeftCorner(n, n);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      out.mixed.row(places[k]) += integrals.mixed.col(static_cast<Eigen::Index>(k)).head(n).transpose();
    if (!with_gradient)
      continue;
    for (int i = 0; i < n; ++i)
    {
      for (int k = 0; k < n; ++k)
        add_gradient(integrals.mass_gradient.row(4 * i + k), used, out.mass_gradient, i * n + k);
      for (std::size_t k = 0; k < nodes.size(); ++k)
        add_gradient(integrals.mixed_gradient.row(4 * i + static_cast<int>(k)), used, out.mixed_gradient,
                     places[k] * n + i);
    }
  }
  return out;
}

/// Where a node of the face carries no multiplier: the node that stands in for it, else the node itself.
std::array<int, max_corners> representatives(const CornerVector &covered, double face_size)
{
  std::array<int, max_corners> out{};
  Eigen::Index best = 0;
  covered.maxCoeff(&best);
  const auto n = static_cast<int>(covered.size());
  for (int i = 0; i < n; ++i)
    out[i] = covered[i] >= least_share * face_size / n ? i : static_cast<int>(best);
  return out;
}

/// With R the representatives, D = diag(R mass 1), B = (R mass R^T)^-1 R mixed and M = D B, so
/// dM = dD B + D (R mass R^T)^-1 (R dmixed - R dmass R^T B).
class Condensation
{
public:
  Condensation(int n, const FaceSums &sums, const CornerMatrix &merge, FaceCoupling &out)
    : n_(n)
    , sums_(sums)
    , merge_(merge)
    , inverse_(CornerMatrix(merge * sums.mass * merge.transpose())
                   .ldlt()
                   .solve(CornerMatrix::Identity(merge.rows(), merge.rows())))
    , means_(inverse_ * merge * sums.mixed.transpose())
    , out_(out)
  {
    out.own = merge * sums.mass.rowwise().sum();
    out.mortar = out.own.asDiagonal() * means_;
  }

  void set_gradients()
  {
    const Eigen::Index n_variables = sums_.mass_gradient.cols();
    out_.own_gradient = RowMatrix::Zero(merge_.rows(), n_variables);
    for (Eigen::Index k = 0; k < merge_.rows(); ++k)
      for (int i = 0; i < n_ * n_; ++i)
        out_.own_gradient.row(k) += merge_(k, i / n_) * sums_.mass_gradient.row(i);
    for (Eigen::Index k = 0; k < merge_.rows(); ++k)
      out_.mortar_gradient.push_back(gradient_of(k));
  }

private:
  /// Of row k of M, [n_targets x n_variables].
  [[nodiscard]] RowMatrix gradient_of(Eigen::Index k) const
  {
    // Row k of D (R mass R^T)^-1 R: what a change of each row of mass and mixed does to it.
    const Eigen::RowVectorXd by_row = out_.own[k] * inverse_.row(k) * merge_;
    RowMatrix by_mass = RowMatrix::Zero(n_, sums_.mass_gradient.cols());
    for (int i = 0; i < n_; ++i)
      by_mass += by_row[i] * sums_.mass_gradient.middleRows(static_cast<Eigen::Index>(i) * n_, n_);
    RowMatrix out = means_.row(k).transpose() * out_.own_gradient.row(k);
    out.noalias() -= (merge_.transpose() * means_).transpose() * by_mass;
    for (Eigen::Index t = 0; t < out.rows(); ++t)
      out.row(t).noalias() += by_row * sums_.mixed_gradient.middleRows(t * n_, n_);
    return out;
  }

  int n_;
  const FaceSums &sums_;
  const CornerMatrix &merge_;
  CornerMatrix inverse_;
  RowMatrix means_; ///< B
  FaceCoupling &out_;
};
} // namespace

FaceCoupling couple_face(int n_nodes, double face_size, std::span<const SeenFace> seen, bool with_gradient)
{
  FaceCoupling out;
  out.targets = nodes_of(seen);
  const FaceSums sums = sum(n_nodes, seen, out.targets, with_gradient);
  out.facing = sums.facing / sums.size;
  out.whole = sums.size >= (1 - least_part) * face_size;
  const auto stands_for = representatives(sums.mass.rowwise().sum(), face_size * sums.ring_size / sums.size);
  for (int i = 0; i < n_nodes; ++i)
    if (stands_for[i] == i)
      out.corners.push_back(i);
  CornerMatrix merge = CornerMatrix::Zero(static_cast<Eigen::Index>(out.corners.size()), n_nodes);
  for (std::size_t k = 0; k < out.corners.size(); ++k)
    for (int i = 0; i < n_nodes; ++i)
      merge(static_cast<Eigen::Index>(k), i) = stands_for[i] == out.corners[k] ? 1 : 0;
  Condensation condensation(n_nodes, sums, merge, out);
  if (with_gradient)
    condensation.set_gradients();
  return out;
}
} // namespace amontons
