#pragma once
#include "amontons/parallel/sharing.h"

#include <span>
#include <vector>

namespace amontons
{
/// Search directions p with their images q = A p, the q orthonormal: generalised conjugate residuals (Eisenstat, Elman,
/// Schultz 1983), which in exact arithmetic is GMRES. While A stands, the directions of former solves serve every new
/// right side: the residual is first freed of all that they span.
///
/// Over several processes each has the vectors' entries that it knows, and counts some of them as its own in inner
/// products, each entry being one process's own. What is known to several is changed by all alike.
class FetiDirections
{
public:
  /// @param max_bytes of p and q together, beyond which the oldest direction gives way; a few dozen are kept anyway
  explicit FetiDirections(std::size_t max_bytes = std::size_t{1} << 29)
    : max_bytes_(max_bytes)
  {
  }

  /// Forgets all directions. Collective. @param length of the vectors to come
  /// @param first_own entries from here on are own, [0, n_own) of them
  void start(std::size_t length, std::size_t first_own, std::size_t n_own, const Sharing &processes);
  /// x += sum (q . r) p and r -= sum (q . r) q, over all directions. Collective.
  void project(std::span<double> x, std::span<double> r) const;
  /// Takes a direction and makes a step along it. The oldest gives way when there are too many. Collective.
  /// @return false if its image is a combination of those already there
  bool add(std::vector<double> p, std::vector<double> q, std::span<double> x, std::span<double> r);

private:
  [[nodiscard]] double own_dot(std::span<const double> a, std::span<const double> b) const;
  [[nodiscard]] double dot(std::span<const double> a, std::span<const double> b) const;
  template<class Take>
  double for_each_product(std::span<const double> v, Take &&take) const;

  std::vector<std::vector<double>> p_, q_;
  std::size_t max_bytes_;
  std::size_t max_kept_ = 0; ///< the same on all processes
  std::size_t first_own_ = 0, n_own_ = 0;
  const Sharing *processes_ = nullptr;
};
} // namespace amontons
