#pragma once
#include <Eigen/Core>

#include <array>
#include <cmath>

namespace amontons
{
/// A number with its derivatives with respect to n variables: forward-mode differentiation without allocation.
template<int n>
struct Dual
{
  /// Padded with zeros to whole vector registers, which halves the cost on a bilinear face (n = 15).
  static constexpr int n_stored = n + n % 2;
  double value;
  alignas(16) std::array<double, n_stored> gradient;

  Dual()
    : Dual(0)
  {
  }
  Dual(double constant) // NOLINT(google-explicit-constructor): constants mix freely with variables
    : value(constant)
    , gradient{}
  {
  }
  /// The i-th variable.
  static Dual variable(double value, int i)
  {
    Dual out(value);
    out.gradient[i] = 1;
    return out;
  }
  /// f(a) and f(a, b) by the chain rule, from the value and the partial derivatives of f.
  static Dual chain(double f, double df_da, const Dual &a)
  {
    Dual out(f);
    for (int i = 0; i < n_stored; ++i)
      out.gradient[i] = df_da * a.gradient[i];
    return out;
  }
  static Dual chain(double f, double df_da, const Dual &a, double df_db, const Dual &b)
  {
    Dual out(f);
    for (int i = 0; i < n_stored; ++i)
      out.gradient[i] = df_da * a.gradient[i] + df_db * b.gradient[i];
    return out;
  }

  Dual &operator+=(const Dual &b) { return *this = *this + b; }
  Dual &operator-=(const Dual &b) { return *this = *this - b; }
  Dual &operator*=(const Dual &b) { return *this = *this * b; }
  Dual &operator/=(const Dual &b) { return *this = *this / b; }

  friend Dual operator-(const Dual &a) { return chain(-a.value, -1, a); }
  friend Dual operator+(const Dual &a, const Dual &b) { return chain(a.value + b.value, 1, a, 1, b); }
  friend Dual operator-(const Dual &a, const Dual &b) { return chain(a.value - b.value, 1, a, -1, b); }
  friend Dual operator*(const Dual &a, const Dual &b) { return chain(a.value * b.value, b.value, a, a.value, b); }
  friend Dual operator/(const Dual &a, const Dual &b)
  {
    return chain(a.value / b.value, 1 / b.value, a, -a.value / (b.value * b.value), b);
  }
  friend Dual operator+(const Dual &a, double b) { return chain(a.value + b, 1, a); }
  friend Dual operator-(const Dual &a, double b) { return chain(a.value - b, 1, a); }
  friend Dual operator*(const Dual &a, double b) { return chain(a.value * b, b, a); }
  friend Dual operator/(const Dual &a, double b) { return chain(a.value / b, 1 / b, a); }
  friend Dual operator+(double a, const Dual &b) { return b + a; }
  friend Dual operator-(double a, const Dual &b) { return chain(a - b.value, -1, b); }
  friend Dual operator*(double a, const Dual &b) { return b * a; }
  friend Dual operator/(double a, const Dual &b) { return chain(a / b.value, -a / (b.value * b.value), b); }
  friend Dual sqrt(const Dual &a)
  {
    const double root = std::sqrt(a.value);
    return chain(root, 0.5 / root, a);
  }
};

inline double value_of(double x)
{
  return x;
}
template<int n>
double value_of(const Dual<n> &x)
{
  return x.value;
}
} // namespace amontons

template<int n>
struct Eigen::NumTraits<amontons::Dual<n>> : Eigen::NumTraits<double>
{
  using Real = amontons::Dual<n>;
  using NonInteger = amontons::Dual<n>;
  using Nested = amontons::Dual<n>;
  enum
  {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = n + 1,
    AddCost = n + 1,
    MulCost = 2 * (n + 1)
  };
};
template<int n, typename BinaryOp>
struct Eigen::ScalarBinaryOpTraits<amontons::Dual<n>, double, BinaryOp>
{
  using ReturnType = amontons::Dual<n>;
};
template<int n, typename BinaryOp>
struct Eigen::ScalarBinaryOpTraits<double, amontons::Dual<n>, BinaryOp>
{
  using ReturnType = amontons::Dual<n>;
};
