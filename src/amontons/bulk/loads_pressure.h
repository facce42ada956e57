#pragma once
#include "amontons/bulk/reference_element.h"

#include <Eigen/Dense>

#include <array>
#include <numbers>

namespace amontons
{
/// Sizes of a facet of one shape in its space, known to the compiler.
template<CellShape shape_, bool axisymmetric_ = false>
struct FacetType
{
  static constexpr CellShape shape = shape_;
  static constexpr bool axisymmetric = axisymmetric_;
  static constexpr int dim = dimension(shape) + 1;
  static constexpr int nodes = n_nodes(shape);
  static constexpr int unknowns = dim * nodes; ///< node by node
  static constexpr int points = shape == CellShape::triangle ? 4 : nodes;

  template<typename Scalar>
  using NodalValues = Eigen::Matrix<Scalar, dim, nodes>; ///< a column per node
  template<typename Scalar>
  using Vector = Eigen::Matrix<Scalar, unknowns, 1>;
  using Matrix = Eigen::Matrix<double, unknowns, unknowns>;
};

/// Force of a pressure on one facet, f_a = - int p N_a n da, and its exact derivative, at given current places.
///
/// n da = dx/dxi1 x dx/dxi2 (in the plane the edge turned by a right angle) is a polynomial in the places, so that no
/// unit normal is ever formed (Bonet and Wood, Nonlinear Continuum Mechanics, section 9.5.2). In axisymmetry n da holds
/// 2 pi r, r the current radius.
template<class Facet>
class PressureKernel
{
public:
  template<typename Scalar>
  using NodalValues = typename Facet::template NodalValues<Scalar>;
  using Pressures = std::array<double, Facet::points>; ///< at the quadrature points

  PressureKernel()
  {
    const ReferenceElement element = reference_element(Facet::shape, 2);
    AMONTONS_ASSERT(element.n_points == Facet::points && element.n_nodes == Facet::nodes);
    for (int q = 0; q < Facet::points; ++q)
    {
      weights_[q] = element.weights[q];
      N_[q] = Eigen::Map<const ShapeValues>(&element.values[q * Facet::nodes]);
      dN_[q] = Eigen::Map<const ShapeGradients>(&element.gradients[q * Facet::nodes * (Facet::dim - 1)]);
    }
  }

  /// Place of a quadrature point.
  [[nodiscard]] Eigen::Matrix<double, Facet::dim, 1> place(const NodalValues<double> &x, int q) const
  {
    return x * N_[q];
  }

  template<typename Scalar>
  [[nodiscard]] typename Facet::template Vector<Scalar> force(const NodalValues<Scalar> &x,
                                                              const Pressures &pressures) const
  {
    typename Facet::template Vector<Scalar> sum = Facet::template Vector<Scalar>::Zero();
    for (int q = 0; q < Facet::points; ++q)
    {
      const auto tangents = Tangents<Scalar>(x * dN_[q].transpose());
      const Eigen::Matrix<Scalar, Facet::dim, 1> area = area_vector(tangents) * ring(x, q);
      for (int a = 0; a < Facet::nodes; ++a)
        sum.template segment<Facet::dim>(a * Facet::dim) -= pressures[q] * weights_[q] * N_[q][a] * area;
    }
    return sum;
  }

  /// d(force)/dx, column by unknown; not symmetric facet by facet.
  [[nodiscard]] typename Facet::Matrix derivative(const NodalValues<double> &x, const Pressures &pressures) const
  {
    typename Facet::Matrix sum = Facet::Matrix::Zero();
    for (int q = 0; q < Facet::points; ++q)
    {
      const Tangents<double> tangents = x * dN_[q].transpose();
      for (int b = 0; b < Facet::nodes; ++b)
      {
        Eigen::Matrix<double, Facet::dim, Facet::dim> change = area_change(tangents, dN_[q].col(b)) * ring(x, q);
        if constexpr (Facet::axisymmetric)
          change.col(0) += 2 * std::numbers::pi * N_[q][b] * area_vector(tangents);
        for (int a = 0; a < Facet::nodes; ++a)
          sum.template block<Facet::dim, Facet::dim>(a * Facet::dim, b * Facet::dim) -=
              pressures[q] * weights_[q] * N_[q][a] * change;
      }
    }
    return sum;
  }

private:
  using ShapeValues = Eigen::Matrix<double, Facet::nodes, 1>;
  using ShapeGradients = Eigen::Matrix<double, Facet::dim - 1, Facet::nodes>;
  template<typename Scalar>
  using Tangents = Eigen::Matrix<Scalar, Facet::dim, Facet::dim - 1>;

  template<typename Scalar>
  static Eigen::Matrix<Scalar, Facet::dim, 1> area_vector(const Tangents<Scalar> &t)
  {
    if constexpr (Facet::dim == 2)
      return {t(1, 0), -t(0, 0)};
    else // written out: Eigen's cross product of complex vectors conjugates, which is of no use for a complex step
      return {t(1, 0) * t(2, 1) - t(2, 0) * t(1, 1), t(2, 0) * t(0, 1) - t(0, 0) * t(2, 1),
              t(0, 0) * t(1, 1) - t(1, 0) * t(0, 1)};
  }

  /// d(area vector)/dx_b, dN the gradient of the shape function of node b.
  static Eigen::Matrix<double, Facet::dim, Facet::dim> area_change(const Tangents<double> &t,
                                                                   const Eigen::Matrix<double, Facet::dim - 1, 1> &dN)
  {
    Eigen::Matrix<double, Facet::dim, Facet::dim> change;
    if constexpr (Facet::dim == 2)
      change << 0, dN[0], -dN[0], 0;
    else
      for (int k = 0; k < 3; ++k)
      {
        const Eigen::Vector3d e = Eigen::Vector3d::Unit(k);
        change.col(k) = dN[0] * e.cross(t.col(1)) + dN[1] * t.col(0).cross(e);
      }
    return change;
  }

  template<typename Scalar>
  [[nodiscard]] Scalar ring(const NodalValues<Scalar> &x, int q) const
  {
    if constexpr (Facet::axisymmetric)
      return 2 * std::numbers::pi * (x.row(0) * N_[q])(0);
    else
      return 1;
  }

  std::array<double, Facet::points> weights_;
  std::array<ShapeValues, Facet::points> N_;
  std::array<ShapeGradients, Facet::points> dN_;
};
} // namespace amontons
