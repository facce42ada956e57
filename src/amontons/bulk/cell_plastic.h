#pragma once
#include "amontons/bulk/cell_geometry.h"
#include "amontons/bulk/material_von_mises.h"

namespace amontons
{
/// Strain at one point of a cell in small strain; zero across the plane.
template<class Cell, typename Scalar>
SymmetricTensor<Scalar> small_strain(const CellPoint<Cell> &point, const typename Cell::template NodalValues<Scalar> &u)
{
  const Eigen::Matrix<Scalar, Cell::dim, Cell::dim> gradient = u * point.gradients.transpose();
  SymmetricTensor<Scalar> strain = SymmetricTensor<Scalar>::Zero();
  for (int i = 0; i < Cell::dim; ++i)
    strain[i] = gradient(i, i);
  if constexpr (Cell::axisymmetric)
    strain[2] = (u.row(0).array() * point.hoop.array()).sum();
  strain[3] = 0.5 * (gradient(0, 1) + gradient(1, 0));
  if constexpr (Cell::dim == 3)
  {
    strain[4] = 0.5 * (gradient(1, 2) + gradient(2, 1));
    strain[5] = 0.5 * (gradient(0, 2) + gradient(2, 0));
  }
  return strain;
}

/// t : grad v by unknown, v the displacement.
template<class Cell, typename Scalar>
typename Cell::template Vector<Scalar> work_by_unknown(const SymmetricTensor<Scalar> &t, const CellPoint<Cell> &point)
{
  Eigen::Matrix<Scalar, Cell::dim, Cell::dim> tensor;
  if constexpr (Cell::dim == 2)
    tensor << t[0], t[3], t[3], t[1];
  else
    tensor << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
  return by_unknown<Cell, Scalar>(tensor * point.gradients, point, t[2]);
}

/// A cell of von Mises' law in small strain over an increment. Its plastic strain has no trace, so mean dilatation is
/// that of the elastic cell: the pressure is of the cell's mean volumetric strain (Nagtegaal, Parks, Rice 1974).
/// @tparam Scalar double, or complex for derivatives of the force by complex steps
template<class Cell, typename Scalar>
class PlasticCell
{
public:
  using NodalValues = typename Cell::template NodalValues<Scalar>;
  using Vector = typename Cell::template Vector<Scalar>;
  using Matrix = typename Cell::template Matrix<Scalar>;

  /// @param start [Cell::points] history at the increment's beginning
  PlasticCell(const CellPoints<Cell> &points, const ElasticModuli &moduli, const Hardening &law, bool mean_dilatation,
              const PlasticHistory<double> *start, const NodalValues &u)
    : points_(points)
    , bulk_(moduli.bulk)
    , mean_dilatation_(mean_dilatation)
  {
    Scalar volume_change = 0;
    for (int q = 0; q < Cell::points; ++q)
    {
      const SymmetricTensor<Scalar> strain = small_strain<Cell, Scalar>(points[q], u);
      if constexpr (Cell::plane_stress)
      {
        const PlaneStressVonMises<Scalar> plane(moduli, law, start[q], strain);
        laws_[q] = plane;
        dilatation_[q] = plane.dilatation;
      }
      else
      {
        laws_[q] = VonMises<Scalar>(moduli.shear, law, start[q], strain);
        dilatation_[q] = strain.template head<3>().sum();
      }
      volume_ += points[q].weight;
      volume_change += points[q].weight * dilatation_[q];
    }
    if (mean_dilatation)
      dilatation_.fill(volume_change / volume_);
  }

  [[nodiscard]] Vector force() const
  {
    Vector sum = Vector::Zero();
    for (int q = 0; q < Cell::points; ++q)
      sum += points_[q].weight * work_by_unknown<Cell, Scalar>(stress(q), points_[q]);
    return sum;
  }

  [[nodiscard]] Matrix tangent() const
  {
    TangentSum<Cell, 2> sum;
    Vector dilatation = Vector::Zero();
    for (int q = 0; q < Cell::points; ++q)
    {
      const CellPoint<Cell> &point = points_[q];
      const Vector divergence = by_unknown<Cell, Scalar>(point.gradients, point, 1.0);
      PointTangent<Scalar> A = laws_[q].tangent;
      if (!mean_dilatation_)
        A.hh += bulk_;
      sum.set(q, point, A, point.gradients, divergence, work_by_unknown<Cell, Scalar>(laws_[q].normal, point), 1.0);
      dilatation += point.weight * divergence;
    }
    Matrix K = sum.total();
    if (mean_dilatation_)
      K.noalias() += (bulk_ / volume_ * dilatation) * dilatation.transpose();
    return K;
  }

  /// Mean stress of the cell.
  [[nodiscard]] SymmetricTensor<Scalar> stress() const
  {
    SymmetricTensor<Scalar> sum = SymmetricTensor<Scalar>::Zero();
    for (int q = 0; q < Cell::points; ++q)
      sum += points_[q].weight * stress(q);
    return sum / volume_;
  }

  /// Of a point, at the increment's end.
  [[nodiscard]] const PlasticHistory<Scalar> &history(int q) const { return laws_[q].history; }

private:
  [[nodiscard]] SymmetricTensor<Scalar> stress(int q) const
  {
    SymmetricTensor<Scalar> out = laws_[q].stress;
    out.template head<3>().array() += bulk_ * dilatation_[q];
    return out;
  }

  const CellPoints<Cell> &points_;
  double bulk_, volume_ = 0;
  bool mean_dilatation_;
  std::array<VonMises<Scalar>, Cell::points> laws_;
  std::array<Scalar, Cell::points> dilatation_;
};
} // namespace amontons
