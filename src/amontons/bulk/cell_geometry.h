#pragma once
#include "amontons/bulk/material.h"
#include "amontons/bulk/reference_element.h"

#include <Eigen/Dense>

#include <array>
#include <numbers>

namespace amontons
{
/// Sizes of a cell of one shape under one kinematics, known to the compiler.
template<CellShape shape_, Kinematics kinematics_>
struct CellType
{
  static constexpr CellShape shape = shape_;
  static constexpr bool axisymmetric = kinematics_ == Kinematics::axisymmetric;
  static constexpr bool plane_stress = kinematics_ == Kinematics::plane_stress;
  static constexpr bool simplex = shape == CellShape::triangle || shape == CellShape::tetrahedron;
  static constexpr int dim = dimension(shape);
  static constexpr int nodes = n_nodes(shape);
  static constexpr int unknowns = dim * nodes; ///< node by node
  /// The strain of a simplex is constant, but for the hoop strain.
  static constexpr int order = simplex && !axisymmetric ? 1 : 2;
  static constexpr int points = simplex ? (axisymmetric ? 4 : 1) : nodes;

  template<typename Scalar>
  using NodalValues = Eigen::Matrix<Scalar, dim, nodes>; ///< a column per node
  template<typename Scalar>
  using Vector = Eigen::Matrix<Scalar, unknowns, 1>;
  template<typename Scalar>
  using Matrix = Eigen::Matrix<Scalar, unknowns, unknowns>;
};

/// One quadrature point of a cell in the reference configuration.
template<class Cell>
struct CellPoint
{
  typename Cell::template NodalValues<double> gradients; ///< dN_a/dX, a column per node
  Eigen::Matrix<double, 1, Cell::nodes> hoop;            ///< N_a / R; zero but in axisymmetry
  double weight; ///< volume: times 1 (thickness) in the plane, 2 pi R in axisymmetry
};

template<class Cell>
using CellPoints = std::array<CellPoint<Cell>, Cell::points>;

/// Shape functions of a cell at its quadrature points, in matrices of fixed size.
template<class Cell>
class CellTables
{
public:
  CellTables()
  {
    const ReferenceElement element = reference_element(Cell::shape, Cell::order);
    AMONTONS_ASSERT(element.n_points == Cell::points && element.n_nodes == Cell::nodes);
    for (int q = 0; q < Cell::points; ++q)
    {
      weights_[q] = element.weights[q];
      values_[q] = Eigen::Map<const Eigen::Matrix<double, 1, Cell::nodes>>(&element.values[q * Cell::nodes]);
      gradients_[q] = Eigen::Map<const typename Cell::template NodalValues<double>>(
          &element.gradients[q * Cell::nodes * Cell::dim]);
    }
  }

  /// @param X reference coordinates of the cell's nodes
  [[nodiscard]] CellPoints<Cell> at(const typename Cell::template NodalValues<double> &X) const
  {
    CellPoints<Cell> points;
    for (int q = 0; q < Cell::points; ++q)
    {
      CellPoint<Cell> &point = points[q];
      const Eigen::Matrix<double, Cell::dim, Cell::dim> jacobian = X * gradients_[q].transpose();
      point.gradients.noalias() = jacobian.inverse().transpose() * gradients_[q];
      point.weight = weights_[q] * jacobian.determinant();
      point.hoop.setZero();
      if constexpr (Cell::axisymmetric)
      {
        const double radius = X.row(0).dot(values_[q]);
        point.hoop = values_[q] / radius;
        point.weight *= 2 * std::numbers::pi * radius;
      }
    }
    return points;
  }

private:
  std::array<double, Cell::points> weights_;
  std::array<Eigen::Matrix<double, 1, Cell::nodes>, Cell::points> values_;
  std::array<typename Cell::template NodalValues<double>, Cell::points> gradients_;
};

/// Sum of the contributions  dF : A : dF  of the points of a cell to its tangent, A in the form of PointTangent.
///
/// With G_a = dN_a/dX, g_a = H G_a and f_a = F G_a each term is an outer product of vectors by unknown, so that no
/// matrix of the size (components of F) x unknowns is ever formed. The vectors of all points are gathered as columns
/// and multiplied once; the term with indices exchanged has each node block transposed afterwards.
/// @tparam terms columns per point: 1 without F : dF (small strain), 2 with it
template<class Cell, int terms>
class TangentSum
{
public:
  using NodalValues = typename Cell::template NodalValues<double>;
  using Vector = typename Cell::template Vector<double>;
  using Matrix = typename Cell::template Matrix<double>;

  /// Sets the contribution of point q; every point must be set.
  /// @param spatial g_a, a column per node
  /// @param divergence H : dF by unknown: the columns of `spatial` and in axisymmetry the hoop's part
  /// @param stretch F : dF by unknown; not read with one term
  /// @param hoop_stretch F33 in axisymmetry
  void set(int q, const CellPoint<Cell> &point, const PointTangent<double> &A, const NodalValues &spatial,
           const Vector &divergence, const Vector &stretch, double hoop_stretch)
  {
    const double w = point.weight;
    left_.col(terms * q) = divergence;
    right_.col(terms * q) = (w * A.hh) * divergence;
    if constexpr (terms == 2)
    {
      right_.col(terms * q) += (w * A.fh) * stretch;
      left_.col(terms * q + 1) = stretch;
      right_.col(terms * q + 1) = (w * A.fh) * divergence + (w * A.ff) * stretch;
    }
    spatial_.col(q) = Eigen::Map<const Vector>(spatial.data());
    scaled_spatial_.col(q) = (w * A.swap) * spatial_.col(q);
    nodal_.noalias() += (w * A.id) * (point.gradients.transpose() * point.gradients);
    if constexpr (Cell::axisymmetric)
      radial_.noalias() +=
          (w * (A.id + A.swap / (hoop_stretch * hoop_stretch))) * (point.hoop.transpose() * point.hoop);
  }

  [[nodiscard]] Matrix total() const
  {
    constexpr int dim = Cell::dim;
    Matrix sum = product(left_, right_);
    const Matrix exchanged = product(spatial_, scaled_spatial_);
    for (int b = 0; b < Cell::nodes; ++b)
      for (int a = 0; a < Cell::nodes; ++a)
      {
        sum.template block<dim, dim>(a * dim, b * dim) +=
            exchanged.template block<dim, dim>(a * dim, b * dim).transpose();
        for (int i = 0; i < dim; ++i)
          sum(a * dim + i, b * dim + i) += nodal_(a, b);
        if constexpr (Cell::axisymmetric)
          sum(a * dim, b * dim) += radial_(a, b);
      }
    return sum;
  }

private:
  template<int n>
  using Columns = Eigen::Matrix<double, Cell::unknowns, n>;

  /// A blocked product pays from the size of a hexahedron on.
  template<int n>
  static Matrix product(const Columns<n> &left, const Columns<n> &right)
  {
    if constexpr (Cell::unknowns > 12)
      return left * right.transpose();
    else
      return left.lazyProduct(right.transpose());
  }

  Columns<terms * Cell::points> left_, right_;
  Columns<Cell::points> spatial_, scaled_spatial_;
  Eigen::Matrix<double, Cell::nodes, Cell::nodes> nodal_ = decltype(nodal_)::Zero(), radial_ = nodal_;
};

/// H : dF by unknown in the reference configuration, and the like: the columns of a nodal matrix one after another,
/// plus `factor` times the hoop values on the radial unknowns.
template<class Cell, typename Scalar>
typename Cell::template Vector<Scalar> by_unknown(const typename Cell::template NodalValues<Scalar> &columns,
                                                  const CellPoint<Cell> &point, const Scalar &factor)
{
  typename Cell::template Vector<Scalar> out = Eigen::Map<const typename Cell::template Vector<Scalar>>(columns.data());
  if constexpr (Cell::axisymmetric)
    for (int a = 0; a < Cell::nodes; ++a)
      out[a * Cell::dim] += factor * point.hoop[a];
  return out;
}
} // namespace amontons
