#pragma once
#include <span>
#include <vector>

namespace amontons
{
/// Search directions p with their images q = A p, the q orthonormal: generalised conjugate residuals (Eisenstat, Elman,
/// Schultz 1983), which in exact arithmetic is GMRES. While A stands, the directions of former solves serve every new
/// right side: the residual is first freed of all that they span.
class FetiDirections
{
public:
  void clear();
  [[nodiscard]] bool empty() const { return p_.empty(); }
  /// x += sum (q . r) p and r -= sum (q . r) q, over all directions.
  void project(std::span<double> x, std::span<double> r) const;
  /// Takes a direction and makes a step along it. The oldest gives way when there are too many.
  /// @return false if its image is a combination of those already there
  bool add(std::vector<double> p, std::vector<double> q, std::span<double> x, std::span<double> r);

private:
  void step(std::size_t k, std::span<double> x, std::span<double> r) const;

  std::vector<std::vector<double>> p_, q_;
};
} // namespace amontons
