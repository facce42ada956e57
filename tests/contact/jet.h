#pragma once
#include <Eigen/Core>

#include <complex>

/// An independent path to derivatives for the tests: a complex number with its gradient. The gradient gives first
/// derivatives, an imaginary perturbation of 1e-30 in one variable the second ones, both to round-off.
namespace amontons::test
{
using Complex = std::complex<double>;

struct Jet
{
  static constexpr int n = 15;
  using Gradient = Eigen::Matrix<Complex, n, 1>;
  Complex value{0};
  Gradient gradient = Gradient::Zero();

  Jet() = default;
  Jet(double constant)
    : value(constant)
  {
  }
  Jet(Complex v, Gradient g)
    : value(v)
    , gradient(std::move(g))
  {
  }
};

inline Jet operator+(const Jet &a, const Jet &b)
{
  return {a.value + b.value, a.gradient + b.gradient};
}
inline Jet operator-(const Jet &a, const Jet &b)
{
  return {a.value - b.value, a.gradient - b.gradient};
}
inline Jet operator-(const Jet &a)
{
  return Jet(0) - a;
}
inline Jet operator*(const Jet &a, const Jet &b)
{
  return {a.value * b.value, a.gradient * b.value + a.value * b.gradient};
}
inline Jet operator/(const Jet &a, const Jet &b)
{
  const Complex quotient = a.value / b.value;
  return {quotient, (a.gradient - quotient * b.gradient) / b.value};
}
inline Jet sqrt(const Jet &a)
{
  const Complex root = std::sqrt(a.value);
  return {root, a.gradient / (2. * root)};
}

/// Vectors of space; in the plane the third component is zero.
using JetPoint = std::array<Jet, 3>;

inline JetPoint operator+(const JetPoint &a, const JetPoint &b)
{
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline JetPoint operator-(const JetPoint &a, const JetPoint &b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline JetPoint operator*(const Jet &s, const JetPoint &a)
{
  return {s * a[0], s * a[1], s * a[2]};
}
inline Jet dot(const JetPoint &a, const JetPoint &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline JetPoint cross(const JetPoint &a, const JetPoint &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline JetPoint unit(const JetPoint &a)
{
  return (Jet(1) / sqrt(dot(a, a))) * a;
}
inline JetPoint constant(const Eigen::Vector3d &a)
{
  return {a[0], a[1], a[2]};
}
} // namespace amontons::test
