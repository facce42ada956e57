#pragma once
#include "amontons/bulk/cell_geometry.h"

namespace amontons
{
/// Stiffness of a cell in small strain linear elasticity. With mean dilatation the volumetric strain is the cell's mean
/// (Nagtegaal, Parks, Rice 1974): K = sum w (deviatoric) + bulk/V d d^T, d the derivative of the cell's volume.
template<class Cell>
typename Cell::template Matrix<double> small_strain_stiffness(const CellPoints<Cell> &points,
                                                              const ElasticModuli &moduli, bool mean_dilatation)
{
  PointTangent<double> A;
  A.id = A.swap = moduli.shear;
  A.hh = mean_dilatation ? -2 * moduli.shear / 3 : Cell::plane_stress ? moduli.lame_plane_stress() : moduli.lame();
  TangentSum<Cell, 1> sum;
  typename Cell::template Vector<double> dilatation = Cell::template Vector<double>::Zero();
  double volume = 0;
  for (int q = 0; q < Cell::points; ++q)
  {
    const CellPoint<Cell> &point = points[q];
    const auto divergence = by_unknown<Cell, double>(point.gradients, point, 1.0);
    sum.set(q, point, A, point.gradients, divergence, divergence, 1.0);
    dilatation += point.weight * divergence;
    volume += point.weight;
  }
  typename Cell::template Matrix<double> K = sum.total();
  if (mean_dilatation)
    K.noalias() += (moduli.bulk / volume * dilatation) * dilatation.transpose();
  return K;
}

/// Mean stress of the cell: xx, yy, zz, xy, yz, xz.
template<class Cell>
Eigen::Matrix<double, 6, 1> small_strain_stress(const CellPoints<Cell> &points, const ElasticModuli &moduli,
                                                const typename Cell::template NodalValues<double> &u)
{
  // The stress is linear in the displacement gradient, so the mean of the one is the stress of the mean of the other,
  // with mean dilatation or without.
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  double volume = 0;
  for (const CellPoint<Cell> &point : points)
  {
    gradient.topLeftCorner<Cell::dim, Cell::dim>() += point.weight * u * point.gradients.transpose();
    if constexpr (Cell::axisymmetric)
      gradient(2, 2) += point.weight * point.hoop.dot(u.row(0));
    volume += point.weight;
  }
  gradient /= volume;
  if constexpr (Cell::plane_stress)
    gradient(2, 2) = -moduli.lame() / (moduli.lame() + 2 * moduli.shear) * gradient.trace();
  const Eigen::Matrix3d s =
      moduli.lame() * gradient.trace() * Eigen::Matrix3d::Identity() + moduli.shear * (gradient + gradient.transpose());
  return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
}
} // namespace amontons
