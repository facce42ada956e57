#include "amontons/algebra/feti_coarse.h"

#include "amontons/algebra/feti_copies.h"
#include "amontons/algebra/linear_solver_failure.h"

#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

namespace amontons
{
namespace
{
/// E is scaled to a unit diagonal: below this, a reciprocal condition number means that it is singular.
constexpr double singular_condition = 1e-14;
/// Shift under which the kernel is looked for, and what E may be on it.
constexpr double shift = 1e-7, kernel_residual = 1e-10;

void sort_each(std::vector<std::vector<Index>> &lists)
{
  for (std::vector<Index> &list : lists)
  {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

Bytes packed(const std::vector<std::vector<Index>> &lists)
{
  ByteWriter writer;
  for (std::size_t k = 0; k < lists.size(); ++k)
    if (!lists[k].empty())
    {
      writer.add(static_cast<Index>(k));
      writer.add_array(lists[k]);
    }
  return writer.take();
}

void append_packed(const Bytes &bytes, std::vector<std::vector<Index>> &lists)
{
  ByteReader reader(bytes);
  while (!reader.is_at_end())
  {
    std::vector<Index> &list = lists[reader.get<Index>()];
    const std::vector<Index> more = reader.get_array<Index>();
    list.insert(list.end(), more.begin(), more.end());
  }
  sort_each(lists);
}

/// The lists of all processes, on all: put together on the first, which sends them back.
void unite(std::vector<std::vector<Index>> &lists, const Sharing &processes)
{
  if (!processes.is_distributed())
    return;
  const bool gathers = processes.rank() == 0;
  std::vector<Rank> partners{0};
  if (gathers)
  {
    partners.resize(static_cast<std::size_t>(processes.n_processes()) - 1);
    std::iota(partners.begin(), partners.end(), 1);
  }
  for (const bool back : {false, true})
  {
    const bool sends = gathers == back;
    std::vector<Message> out;
    for (const Rank rank : partners)
      if (sends)
        out.push_back({rank, packed(lists)});
    const std::span<const Rank> sources(partners.data(), sends ? 0 : partners.size());
    for (const Message &message : processes.messages()->exchange_with(feti_setup_phase, std::move(out), sources))
      append_packed(message.bytes, lists);
  }
}
} // namespace

void FetiKernel::clear()
{
  owner_.clear();
  first_.assign(1, 0);
  basis_offset_.clear();
  basis_.clear();
}

void FetiKernel::add_owner(const Eigen::MatrixXd &basis)
{
  for (Eigen::Index i = 0; i < basis.rows(); ++i)
  {
    owner_.push_back(basis.cols() > 0 ? n_owners() : -1);
    basis_offset_.push_back(basis_.size());
    for (Eigen::Index j = 0; j < basis.cols(); ++j)
      basis_.push_back(basis(i, j));
  }
  first_.push_back(first_.back() + static_cast<Index>(basis.cols()));
}

void FetiKernel::expand_add(std::span<const double> alpha, std::span<double> v) const
{
  for (std::size_t column = 0; column < owner_.size(); ++column)
    if (const Index k = owner_[column]; k >= 0)
    {
      const double *row = basis_.data() + basis_offset_[column];
      for (Index j = first_[k]; j < first_[k + 1]; ++j)
        v[column] += *row++ * alpha[j];
    }
}

void FetiKernel::restrict(std::span<const double> v, std::span<double> alpha) const
{
  std::fill(alpha.begin(), alpha.end(), 0.0);
  for (std::size_t column = 0; column < owner_.size(); ++column)
    if (const Index k = owner_[column]; k >= 0)
    {
      const double *row = basis_.data() + basis_offset_[column];
      for (Index j = first_[k]; j < first_[k + 1]; ++j)
        alpha[j] += *row++ * v[column];
    }
}

void FetiKernel::restrict_row(std::span<const FetiRows::Entry> row, std::vector<FetiRows::Entry> &out) const
{
  out.clear();
  Index last = -1;
  for (const auto &[column, coefficient] : row)
    if (const Index k = owner_[column]; k >= 0)
    {
      if (k != std::exchange(last, k)) // columns ascend, and owners with them
        for (Index j = first_[k]; j < first_[k + 1]; ++j)
          out.emplace_back(j, 0);
      const double *basis = basis_.data() + basis_offset_[column];
      for (auto entry = out.end() - size(k); entry != out.end(); ++entry)
        entry->second += coefficient * *basis++;
    }
}

std::vector<Index> FetiKernel::owners_of(std::span<const FetiRows::Entry> row) const
{
  std::vector<Index> out;
  for (const auto &[column, coefficient] : row)
    if (owner_[column] >= 0)
      out.push_back(owner_[column]);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Index FetiKernel::owner_of_unknown(Index unknown) const
{
  return static_cast<Index>(std::upper_bound(first_.begin(), first_.end(), unknown) - first_.begin()) - 1;
}

void FetiCoarse::set_pattern(const std::function<void(const std::function<void(std::span<const Index>)> &)> &couple,
                             const Sharing &processes)
{
  std::vector<std::vector<Index>> lower(static_cast<std::size_t>(kernel_.n_owners()));
  couple(
      [&](std::span<const Index> owners)
      {
        for (const Index s : owners)
          for (const Index t : owners)
            if (s < t && (lower[t].empty() || lower[t].back() != s))
              lower[t].push_back(s);
      });
  sort_each(lower);
  unite(lower, processes);
  lay_out(lower);
  if (pattern_.size() > 0)
    factor_.analyze(pattern_);
}

/// @param lower by owner the lower ones that it is coupled with, ascending
void FetiCoarse::lay_out(const std::vector<std::vector<Index>> &lower)
{
  neighbours_.assign(lower.size(), {});
  pattern_ = {};
  for (Index t = 0; t < kernel_.n_owners(); ++t)
  {
    Index place = 0;
    for (const Index s : lower[t])
    {
      neighbours_[t].emplace_back(s, place);
      place += kernel_.size(s);
    }
    neighbours_[t].emplace_back(t, place);
    for (Index j = 0; j < kernel_.size(t); ++j)
    {
      for (const Index s : lower[t])
        for (Index i = 0; i < kernel_.size(s); ++i)
          pattern_.rows.push_back(kernel_.first(s) + i);
      for (Index i = 0; i <= j; ++i)
        pattern_.rows.push_back(kernel_.first(t) + i);
      pattern_.offsets.push_back(static_cast<Index>(pattern_.rows.size()));
    }
  }
}

void FetiCoarse::copy_pattern(const FetiCoarse &other)
{
  neighbours_ = other.neighbours_;
  pattern_ = other.pattern_;
  if (pattern_.size() > 0)
    factor_.analyze(pattern_);
}

void FetiCoarse::add(std::span<const FetiRows::Entry> g, std::span<double> values) const
{
  for (std::size_t b = 0; b < g.size(); ++b)
  {
    const auto [j, g_j] = g[b];
    const auto &lower = neighbours_[kernel_.owner_of_unknown(j)];
    double *column = values.data() + pattern_.offsets[j];
    auto block = lower.begin();
    for (std::size_t a = 0; a <= b; ++a)
    {
      const auto [i, g_i] = g[a];
      while (block != lower.end() && i >= kernel_.first(block->first) + kernel_.size(block->first))
        ++block;
      AMONTONS_ASSERT(block != lower.end() && i >= kernel_.first(block->first));
      column[block->second + i - kernel_.first(block->first)] += g_i * g_j;
    }
  }
}

Eigen::MatrixXd FetiCoarse::product(std::span<const double> values, const Eigen::MatrixXd &x) const
{
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  for (Index j = 0; j < pattern_.size(); ++j)
    for (Index k = pattern_.offsets[j]; k < pattern_.offsets[j + 1]; ++k)
    {
      const Index i = pattern_.rows[k];
      y.row(i) += values[k] * x.row(j);
      if (i != j)
        y.row(j) += values[k] * x.row(i);
    }
  return y;
}

/// Entries on which the kernel is regular: by inverse iteration, then pivots of the vectors found.
std::vector<Index> FetiCoarse::choose_pins(std::span<const double> values, Index n_free)
{
  std::vector<double> shifted(values.begin(), values.end());
  for (Index i = 0; i < pattern_.size(); ++i)
    shifted[diagonal(i)] += shift;
  if (!factor_.factorize(pattern_, shifted))
    throw LinearSolverFailure("the coarse problem of the subdomains is not positive semidefinite");
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  Eigen::MatrixXd x = Eigen::MatrixXd::NullaryExpr(pattern_.size(), n_free, [&] { return number(random); });
  for (int iteration = 0; iteration < 3; ++iteration)
  {
    for (Index j = 0; j < n_free; ++j)
      factor_.solve({x.col(j).data(), static_cast<std::size_t>(x.rows())});
    x = Eigen::HouseholderQR<Eigen::MatrixXd>(x).householderQ() * Eigen::MatrixXd::Identity(x.rows(), n_free);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(x.transpose());
  const auto &pivots = qr.colsPermutation().indices();
  return {pivots.data(), pivots.data() + n_free};
}

bool FetiCoarse::find_free_motions(std::vector<double> &values, Index n_free)
{
  if (n_free > pattern_.size())
    return false;
  const std::vector<Index> pins = choose_pins(values, n_free);
  const std::vector<double> original = values;
  for (const Index pin : pins)
    values[diagonal(pin)] += 1;
  if (!factor_.factorize(pattern_, values))
    throw NumericalFailure("the tangent matrix is singular: bodies move freely in more ways than are held");
  Eigen::MatrixXd n = Eigen::MatrixXd::Zero(pattern_.size(), n_free);
  for (Index j = 0; j < n_free; ++j)
  {
    n(pins[j], j) = 1;
    factor_.solve({n.col(j).data(), static_cast<std::size_t>(n.rows())});
  }
  if (product(original, n).norm() > kernel_residual * n.norm())
  {
    values = original;
    return false;
  }
  free_ = Eigen::Map<const Eigen::VectorXd>(scale_.data(), pattern_.size()).asDiagonal() * n;
  return true;
}

bool FetiCoarse::factorize(std::vector<double> values, Index n_free)
{
  free_.resize(pattern_.size(), 0);
  if (pattern_.size() == 0)
    return false;
  scale_.resize(static_cast<std::size_t>(pattern_.size()));
  for (Index i = 0; i < pattern_.size(); ++i)
    scale_[i] = values[diagonal(i)] > 0 ? 1 / std::sqrt(values[diagonal(i)]) : 1;
  for (Index j = 0; j < pattern_.size(); ++j)
    for (Index k = pattern_.offsets[j]; k < pattern_.offsets[j + 1]; ++k)
      values[k] *= scale_[j] * scale_[pattern_.rows[k]];
  if (n_free > 0 && find_free_motions(values, n_free))
    return true;
  if (!factor_.factorize(pattern_, values) || factor_.reciprocal_condition() < singular_condition)
    throw NumericalFailure("the tangent matrix is singular: a body moves freely");
  return false;
}

void FetiCoarse::solve(std::span<double> x)
{
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] *= scale_[i];
  factor_.solve(x);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] *= scale_[i];
}
} // namespace amontons
