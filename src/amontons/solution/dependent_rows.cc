#include "amontons/solution/dependent_rows.h"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace amontons
{
namespace
{
/// Share of a row's length that must be left, after what other rows hold is taken away, for the row to count.
constexpr double independent_share = 1e-2;

double dot(const std::map<Index, double> &a, const std::map<Index, double> &b)
{
  double sum = 0;
  for (const auto &[i, v] : a)
    if (const auto it = b.find(i); it != b.end())
      sum += v * it->second;
  return sum;
}
} // namespace

template<class Row>
DependentRows::SparseRow DependentRows::on_unknowns(const ConstraintPattern &pattern, const Row &row) const
{
  SparseRow out;
  for (int k = 0; k < pattern.n_nodal(); ++k)
    for (const Term &term : layout_.terms(pattern.nodal[k]))
      out[term.unknown] += term.coefficient * row[k];
  return out;
}

DependentRows::SparseRow DependentRows::without_taken(SparseRow row) const
{
  for (const SparseRow &other : taken_)
  {
    const double factor = dot(row, other);
    for (const auto &[i, v] : other)
      row[i] -= factor * v;
  }
  return row;
}

bool DependentRows::take(SparseRow row, double full_length)
{
  row = without_taken(std::move(row));
  const double length = std::sqrt(dot(row, row));
  if (length <= independent_share * full_length)
    return false;
  for (auto &[i, v] : row)
    v /= length;
  taken_.push_back(std::move(row));
  return true;
}

void DependentRows::filter_normal(ContactElement &e, const ConstraintPattern &pattern, const Multipliers &lambda,
                                  double r)
{
  if (!take(on_unknowns(pattern, e.constraint_by_position.row(0)), e.constraint_by_position.row(0).norm()))
  {
    e.constraint_by_position.row(0).setZero();
    e.constraint_by_multiplier.row(0).setZero();
    e.constraint_by_multiplier(0, 0) = -1 / r;
    e.constraint[0] = -lambda.normal / r;
  }
}

/// The rows of the tangent plane are turned into principal directions, strongest first: a direction with no unknown of
/// its own behind it carries no multiplier.
void DependentRows::filter_sticking(ContactElement &e, const ConstraintPattern &pattern, const Multipliers &lambda,
                                    double r)
{
  const Eigen::Index n = e.constraint_by_position.rows() - 1;
  std::vector<SparseRow> rows;
  for (Eigen::Index a = 0; a < n; ++a)
    rows.push_back(without_taken(on_unknowns(pattern, e.constraint_by_position.row(1 + a))));
  Eigen::MatrixXd gram(n, n);
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b)
      gram(a, b) = dot(rows[a], rows[b]);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  const Eigen::MatrixXd u = eigen.eigenvectors().rowwise().reverse();
  const Eigen::MatrixXd by_position = u.transpose() * e.constraint_by_position.bottomRows(n);
  const Eigen::VectorXd constraint = u.transpose() * e.constraint.tail(n);
  const Eigen::Map<const Eigen::VectorXd> tangential(lambda.tangential.data(), n);
  for (Eigen::Index k = 0; k < n; ++k)
  {
    const Eigen::Index row = 1 + k;
    e.constraint_by_multiplier.row(row).setZero();
    if (take(on_unknowns(pattern, by_position.row(k)), by_position.row(k).norm()))
    {
      e.constraint_by_position.row(row) = by_position.row(k);
      e.constraint[row] = constraint[k];
      continue;
    }
    e.constraint_by_position.row(row).setZero();
    e.constraint_by_multiplier.block(row, 1, 1, n) = -u.col(k).transpose() / r;
    e.constraint[row] = -u.col(k).dot(tangential) / r;
  }
}
} // namespace amontons
