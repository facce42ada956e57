#include "amontons/algebra/feti_directions.h"

#include <cblas.h>

#include <cmath>

namespace amontons
{
namespace
{
/// Directions kept, in bytes of p and q together; at least so many.
constexpr std::size_t max_bytes = std::size_t{1} << 29;
constexpr std::size_t least_kept = 40;
/// An image that loses all but this share of its length when the others are taken out is dependent on them.
constexpr double least_share = 1e-10;
/// One that loses less than this leaves no round-off worth a second orthogonalisation (Daniel et al. 1976).
constexpr double lossless_share = 0.1;

double dot(std::span<const double> a, std::span<const double> b)
{
  return cblas_ddot(static_cast<int>(a.size()), a.data(), 1, b.data(), 1);
}

void add_multiple(double factor, std::span<const double> a, std::span<double> b)
{
  cblas_daxpy(static_cast<int>(a.size()), factor, a.data(), 1, b.data(), 1);
}
} // namespace

void FetiDirections::clear()
{
  p_.clear();
  q_.clear();
}

void FetiDirections::step(std::size_t k, std::span<double> x, std::span<double> r) const
{
  const double factor = dot(q_[k], r);
  add_multiple(factor, p_[k], x);
  add_multiple(-factor, q_[k], r);
}

void FetiDirections::project(std::span<double> x, std::span<double> r) const
{
  for (std::size_t k = 0; k < p_.size(); ++k)
    step(k, x, r);
}

bool FetiDirections::add(std::vector<double> p, std::vector<double> q, std::span<double> x, std::span<double> r)
{
  const double length = std::sqrt(dot(q, q));
  double left = length;
  for (int round = 0; round == 0 || (round == 1 && left < lossless_share * length); ++round)
  {
    for (std::size_t k = 0; k < p_.size(); ++k)
    {
      const double factor = dot(q_[k], q);
      add_multiple(-factor, p_[k], p);
      add_multiple(-factor, q_[k], q);
    }
    left = std::sqrt(dot(q, q));
  }
  if (!(left > least_share * length))
    return false;
  for (std::vector<double> *v : {&p, &q})
    cblas_dscal(static_cast<int>(v->size()), 1 / left, v->data(), 1);
  if (p_.size() >= least_kept && (p_.size() + 1) * 2 * p.size() * sizeof(double) > max_bytes)
  {
    p_.erase(p_.begin());
    q_.erase(q_.begin());
  }
  p_.push_back(std::move(p));
  q_.push_back(std::move(q));
  step(p_.size() - 1, x, r);
  return true;
}
} // namespace amontons
