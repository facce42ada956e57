#include "amontons/algebra/subdomain_factor.h"

#include "amontons/algebra/linear_solver_failure.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <cblas.h>

#include <algorithm>

extern "C"
{
  void spotrf_(const char *uplo, const int *n, float *a, const int *lda, int *info);
  void spotri_(const char *uplo, const int *n, float *a, const int *lda, int *info);
}

namespace amontons
{
namespace
{
/// A motion is in the kernel if its stiffness, over the largest on the diagonal, is round-off.
constexpr double round_off = 1e-12;

std::vector<float> packed_lower(const std::vector<float> &dense, int n)
{
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(n) * (n + 1) / 2);
  for (int j = 0; j < n; ++j)
    out.insert(out.end(), dense.begin() + static_cast<std::ptrdiff_t>(j) * n + j,
               dense.begin() + static_cast<std::ptrdiff_t>(j + 1) * n);
  return out;
}
} // namespace

SubdomainFactor::SubdomainFactor(CholmodSession &session, const SubdomainMatrix &matrix, std::vector<Index> boundary,
                                 const Eigen::MatrixXd &motions)
  : matrix_(matrix)
  , boundary_(std::move(boundary))
  , motions_(motions)
  , session_(&session)
{
  split();
}

void SubdomainFactor::split()
{
  place_.assign(static_cast<std::size_t>(matrix_.n_rows()), -1);
  for (std::size_t k = 0; k < boundary_.size(); ++k)
    place_[boundary_[k]] = static_cast<Index>(k);
  for (Index i = 0; i < matrix_.n_rows(); ++i)
    if (place_[i] < 0)
    {
      place_[i] = -1 - static_cast<Index>(interior_.size());
      interior_.push_back(i);
    }
  work_.resize(interior_.size());
  x_.resize(boundary_.size());
  y_.resize(boundary_.size());
}

void SubdomainFactor::factorize_interior()
{
  std::vector<double> values;
  SymmetricPattern pattern;
  for (const Index i : interior_)
  {
    for (Index k = matrix_.row_ptr[i]; k < matrix_.row_ptr[i + 1]; ++k)
      if (const Index j = matrix_.col[k]; place_[j] < 0 && j <= i)
      {
        pattern.rows.push_back(-1 - place_[j]);
        values.push_back(matrix_.values[k]);
      }
    pattern.offsets.push_back(static_cast<Index>(pattern.rows.size()));
  }
  if (!inner_)
  {
    inner_.emplace(*session_);
    inner_->analyze(pattern);
  }
  if (!inner_->factorize(pattern, values))
    throw LinearSolverFailure("a subdomain's stiffness is not positive definite");
}

/// S, its lower triangle by columns. [n_boundary * n_boundary]
std::vector<double> SubdomainFactor::schur_complement()
{
  const Index n_i = static_cast<Index>(interior_.size()), n_b = n_boundary();
  std::vector<double> S(static_cast<std::size_t>(n_b) * n_b, 0);
  for (const Index i : boundary_)
    for (Index k = matrix_.row_ptr[i]; k < matrix_.row_ptr[i + 1]; ++k)
      if (const Index j = matrix_.col[k]; place_[j] >= 0)
        S[static_cast<std::size_t>(place_[j]) * n_b + place_[i]] = matrix_.values[k];
  if (n_i == 0)
    return S;
  factorize_interior();
  const std::span<const int> order = inner_->order();
  std::vector<double> coupling(static_cast<std::size_t>(n_i) * n_b, 0);
  for (Index row = 0; row < n_i; ++row)
    for (Index i = interior_[order[row]], k = matrix_.row_ptr[i]; k < matrix_.row_ptr[i + 1]; ++k)
      if (const Index j = place_[matrix_.col[k]]; j >= 0)
        coupling[static_cast<std::size_t>(j) * n_i + row] = matrix_.values[k];
  const double *X = inner_->solve_half(coupling, n_b);
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, n_b, n_i, -1, X, n_i, 1, S.data(), n_b);
  return S;
}

/// Springs make K resist some of the motions, or all.
void SubdomainFactor::find_kernel()
{
  const Eigen::Index n = motions_.cols();
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(motions_.rows(), n);
  double largest = 0;
  for (Index i = 0; i < matrix_.n_rows(); ++i)
    for (Index k = matrix_.row_ptr[i]; k < matrix_.row_ptr[i + 1]; ++k)
    {
      product.row(i) += matrix_.values[k] * motions_.row(matrix_.col[k]);
      if (matrix_.col[k] == i)
        largest = std::max(largest, matrix_.values[k]);
    }
  const Eigen::MatrixXd lengths = motions_.transpose() * motions_, resistance = motions_.transpose() * product;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(resistance, lengths);
  Eigen::Index n_kernel = 0;
  while (n_kernel < n && eigen.eigenvalues()[n_kernel] <= round_off * largest)
    ++n_kernel;
  const Eigen::MatrixXd on_boundary = motions_(boundary_, Eigen::all) * eigen.eigenvectors().leftCols(n_kernel);
  kernel_ = Eigen::MatrixXd::Identity(n_boundary(), n_kernel);
  if (n_kernel > 0)
    kernel_ = Eigen::HouseholderQR<Eigen::MatrixXd>(on_boundary).householderQ() * kernel_;
}

void SubdomainFactor::invert(std::vector<float> &dense)
{
  const int n = n_boundary();
  int info = 0;
  spotrf_("L", &n, dense.data(), &n, &info);
  if (info == 0)
    spotri_("L", &n, dense.data(), &n, &info);
  if (info != 0)
    throw LinearSolverFailure("a subdomain's stiffness has a kernel beyond rigid motions");
}

void SubdomainFactor::factorize()
{
  const std::vector<double> S = schur_complement();
  find_kernel();
  const Index n = n_boundary();
  std::vector<float> dense(S.begin(), S.end());
  stiffness_ = packed_lower(dense, n);
  if (kernel_.cols() > 0)
  {
    double mean = 0;
    for (Index k = 0; k < n; ++k)
      mean += S[static_cast<std::size_t>(k) * n + k] / n;
    const Eigen::MatrixXf q = kernel_.cast<float>();
    cblas_ssyrk(CblasColMajor, CblasLower, CblasNoTrans, n, static_cast<int>(q.cols()), static_cast<float>(mean),
                q.data(), n, 1, dense.data(), n);
  }
  invert(dense);
  flexibility_ = packed_lower(dense, n);
}

void SubdomainFactor::apply_flexibility(const double *x, double *y) const
{
  std::copy_n(x, x_.size(), x_.begin());
  cblas_sspmv(CblasColMajor, CblasLower, n_boundary(), 1, flexibility_.data(), x_.data(), 1, 0, y_.data(), 1);
  std::copy_n(y_.begin(), y_.size(), y);
}

void SubdomainFactor::apply_stiffness(const double *x, double *y) const
{
  std::copy_n(x, x_.size(), x_.begin());
  cblas_sspmv(CblasColMajor, CblasLower, n_boundary(), 1, stiffness_.data(), x_.data(), 1, 0, y_.data(), 1);
  std::copy_n(y_.begin(), y_.size(), y);
}

void SubdomainFactor::apply_boundary_stiffness(const double *x, double *y) const
{
  for (Index a = 0; a < n_boundary(); ++a)
  {
    double sum = 0;
    for (Index k = matrix_.row_ptr[boundary_[a]]; k < matrix_.row_ptr[boundary_[a] + 1]; ++k)
      if (const Index b = place_[matrix_.col[k]]; b >= 0)
        sum += matrix_.values[k] * x[b];
    y[a] = sum;
  }
}

void SubdomainFactor::condense(std::span<const double> force, double *condensed)
{
  for (std::size_t k = 0; k < interior_.size(); ++k)
    work_[k] = force[interior_[k]];
  const bool loaded = std::any_of(work_.begin(), work_.end(), [](double f) { return f != 0; });
  if (loaded)
    inner_->solve(work_);
  for (Index a = 0; a < n_boundary(); ++a)
  {
    double sum = force[boundary_[a]];
    if (loaded)
      for (Index k = matrix_.row_ptr[boundary_[a]]; k < matrix_.row_ptr[boundary_[a] + 1]; ++k)
        if (const Index i = place_[matrix_.col[k]]; i < 0)
          sum -= matrix_.values[k] * work_[-1 - i];
    condensed[a] = sum;
  }
}

void SubdomainFactor::expand(std::span<const double> force, const double *boundary_displacement,
                             std::span<double> displacement)
{
  for (Index a = 0; a < n_boundary(); ++a)
    displacement[boundary_[a]] = boundary_displacement[a];
  for (std::size_t i = 0; i < interior_.size(); ++i)
  {
    const Index row = interior_[i];
    double sum = force.empty() ? 0 : force[row];
    for (Index k = matrix_.row_ptr[row]; k < matrix_.row_ptr[row + 1]; ++k)
      if (const Index b = place_[matrix_.col[k]]; b >= 0)
        sum -= matrix_.values[k] * boundary_displacement[b];
    work_[i] = sum;
  }
  if (!interior_.empty())
    inner_->solve(work_);
  for (std::size_t i = 0; i < interior_.size(); ++i)
    displacement[interior_[i]] = work_[i];
}
} // namespace amontons
