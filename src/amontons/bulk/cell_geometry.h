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
/// With G_a = dN_a/dX, g_a = H G_a and f_a = F G_a (columns of `spatial` and `pushed`) each term is an outer product,
/// so that no matrix of the size (components of F) x unknowns is ever formed; the term with indices exchanged is summed
/// as an outer product too and each block transposed at the end.
template<class Cell, typename Scalar>
class TangentSum
{
public:
  using NodalValues = typename Cell::template NodalValues<Scalar>;
  using Vector = typename Cell::template Vector<Scalar>;
  using Matrix = typename Cell::template Matrix<Scalar>;

  TangentSum()
  {
    dense_.setZero();
    exchanged_.setZero();
    nodal_.setZero();
    radial_.setZero();
  }

  /// @param divergence H : dF by unknown, the columns of `spatial` and in axisymmetry the hoop's part
  /// @param hoop_stretch F33; used in axisymmetry
  void add(const CellPoint<Cell> &point, const PointTangent<Scalar> &A, const NodalValues &spatial,
           const Vector &divergence, const Scalar &hoop_stretch)
  {
    const double w = point.weight;
    const Vector scaled = (w * A.hh) * divergence;
    dense_.noalias() += divergence * scaled.transpose();
    const Eigen::Map<const Vector> column(spatial.data());
    const Vector scaled_column = (w * A.swap) * column;
    exchanged_.noalias() += column * scaled_column.transpose();
    nodal_.noalias() += (w * A.id) * (point.gradients.transpose() * point.gradients);
    if constexpr (Cell::axisymmetric)
    {
      const Scalar factor = w * (A.id + A.swap / (hoop_stretch * hoop_stretch));
      radial_.noalias() += factor * (point.hoop.transpose() * point.hoop);
    }
  }

  /// The terms with F : dF by unknown.
  void add_stretch(double w, const PointTangent<Scalar> &A, const Vector &stretch, const Vector &divergence)
  {
    const Vector scaled = (w * A.ff) * stretch + (w * A.fh) * divergence;
    const Vector other = (w * A.fh) * stretch;
    dense_.noalias() += stretch * scaled.transpose();
    dense_.noalias() += divergence * other.transpose();
  }

  void add_outer_product(const Scalar &factor, const Vector &v)
  {
    const Vector scaled = factor * v;
    dense_.noalias() += v * scaled.transpose();
  }

  [[nodiscard]] Matrix total() const
  {
    constexpr int dim = Cell::dim;
    Matrix sum = dense_;
    for (int b = 0; b < Cell::nodes; ++b)
      for (int a = 0; a < Cell::nodes; ++a)
      {
        sum.template block<dim, dim>(a * dim, b * dim) +=
            exchanged_.template block<dim, dim>(a * dim, b * dim).transpose();
        for (int i = 0; i < dim; ++i)
          sum(a * dim + i, b * dim + i) += nodal_(a, b);
        if constexpr (Cell::axisymmetric)
          sum(a * dim, b * dim) += radial_(a, b);
      }
    return sum;
  }

private:
  Matrix dense_, exchanged_;
  Eigen::Matrix<Scalar, Cell::nodes, Cell::nodes> nodal_, radial_;
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
