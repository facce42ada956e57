#include "amontons/algebra/feti_directions.h"

#include <cblas.h>

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
/// Directions kept in any case.
constexpr std::size_t least_kept = 40;
/// An image that loses all but this share of its length when the others are taken out is dependent on them.
constexpr double least_share = 1e-10;
/// One that loses less than this leaves no round-off worth a second orthogonalisation (Daniel et al. 1976).
constexpr double lossless_share = 0.1;

void add_multiple(double factor, std::span<const double> a, std::span<double> b)
{
  cblas_daxpy(static_cast<int>(a.size()), factor, a.data(), 1, b.data(), 1);
}
} // namespace

void FetiDirections::start(std::size_t length, std::size_t first_own, std::size_t n_own, const Sharing &processes)
{
  p_.clear();
  q_.clear();
  const auto longest = static_cast<std::size_t>(processes.maximum_over_processes(static_cast<double>(length)));
  max_kept_ = std::max(least_kept, max_bytes_ / (2 * sizeof(double) * std::max<std::size_t>(longest, 1)));
  first_own_ = first_own;
  n_own_ = n_own;
  processes_ = &processes;
}

double FetiDirections::own_dot(std::span<const double> a, std::span<const double> b) const
{
  return cblas_ddot(static_cast<int>(n_own_), a.data() + first_own_, 1, b.data() + first_own_, 1);
}

double FetiDirections::dot(std::span<const double> a, std::span<const double> b) const
{
  double out = own_dot(a, b);
  processes_->sum_over_processes({&out, 1});
  return out;
}

/// take(k, q_k . v) for all k. Where `take` changes v, one process has the products with what is left of v (modified
/// Gram-Schmidt); several have them with v as it was, since they are summed together (classical). @return |v| as it was
template<class Take>
double FetiDirections::for_each_product(std::span<const double> v, Take &&take) const
{
  const std::size_t n = q_.size(), n_together = processes_->is_distributed() ? std::max<std::size_t>(n, 1) : 1;
  double length2 = 0;
  std::vector<double> products;
  for (std::size_t first = 0; first == 0 || first < n; first += n_together)
  {
    const std::size_t end = std::min(n, first + n_together);
    products.clear();
    for (std::size_t k = first; k < end; ++k)
      products.push_back(own_dot(q_[k], v));
    if (first == 0)
      products.push_back(own_dot(v, v));
    processes_->sum_over_processes(products);
    if (first == 0)
      length2 = products.back();
    for (std::size_t k = first; k < end; ++k)
      take(k, products[k - first]);
  }
  return std::sqrt(length2);
}

void FetiDirections::project(std::span<double> x, std::span<double> r) const
{
  for_each_product(r,
                   [&](std::size_t k, double factor)
                   {
                     add_multiple(factor, p_[k], x);
                     add_multiple(-factor, q_[k], r);
                   });
}

bool FetiDirections::add(std::vector<double> p, std::vector<double> q, std::span<double> x, std::span<double> r)
{
  const auto take_out = [&](std::size_t k, double factor)
  {
    add_multiple(-factor, p_[k], p);
    add_multiple(-factor, q_[k], q);
  };
  const double length = for_each_product(q, take_out);
  double left = std::sqrt(dot(q, q));
  if (left < lossless_share * length)
  {
    for_each_product(q, take_out);
    left = std::sqrt(dot(q, q));
  }
  if (!(left > least_share * length))
    return false;
  for (std::vector<double> *v : {&p, &q})
    cblas_dscal(static_cast<int>(v->size()), 1 / left, v->data(), 1);
  if (p_.size() >= max_kept_)
  {
    p_.erase(p_.begin());
    q_.erase(q_.begin());
  }
  p_.push_back(std::move(p));
  q_.push_back(std::move(q));
  const double factor = dot(q_.back(), r);
  add_multiple(factor, p_.back(), x);
  add_multiple(-factor, q_.back(), r);
  return true;
}
} // namespace amontons
