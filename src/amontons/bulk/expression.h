#pragma once
#include "amontons/bulk/options.h"

#include <array>
#include <memory>

namespace amontons
{
/// A parsed expression of t, x, y, z.
class Function
{
public:
  /// @throws UserError with the place in the deck and what of the expression is not understood
  explicit Function(const Expression &expression);
  ~Function();
  Function(Function &&) noexcept;
  Function &operator=(Function &&) noexcept;

  /// @param point reference coordinates, unused ones 0
  /// @throws UserError if the value is not finite
  [[nodiscard]] double operator()(double time, const std::array<double, 3> &point) const;

  [[nodiscard]] bool depends_on_time() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
} // namespace amontons
