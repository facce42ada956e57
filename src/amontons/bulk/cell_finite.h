#pragma once
#include "amontons/bulk/cell_geometry.h"

#include <optional>

namespace amontons
{
/// Deformation at one point. F and H = F^-T are the in-plane parts in two dimensions.
template<class Cell, typename Scalar>
struct Deformation
{
  using Tensor = Eigen::Matrix<Scalar, Cell::dim, Cell::dim>;

  Deformation() = default;
  Deformation(const CellPoint<Cell> &point, const typename Cell::template NodalValues<Scalar> &u)
    : F(Tensor::Identity() + u * point.gradients.transpose())
    , H(F.inverse().transpose())
    , J(F.determinant())
    , I1(F.array().square().sum())
  {
    if constexpr (Cell::axisymmetric)
      across += (u.row(0).array() * point.hoop.array()).sum();
    if constexpr (Cell::dim == 2 && !Cell::plane_stress)
    {
      J *= across;
      I1 += across * across;
    }
  }

  /// det F > 0 and, in axisymmetry, a positive current radius: J alone would be positive with both negative.
  [[nodiscard]] bool right_way_out() const { return real_part(J) > 0 && real_part(across) > 0; }

  Tensor F, H;
  Scalar across = 1; ///< F33 in axisymmetry, else 1
  Scalar J{}, I1{};  ///< of the whole F; in plane stress of its in-plane part
};

/// A cell of compressible neo-Hookean material in finite strain, total Lagrangian.
///
/// Its energy is sum_q w_q W(F_q); with mean dilatation sum_q w_q W_iso(F_q) + V U(Jbar), Jbar = sum_q w_q J_q / V,
/// V = sum_q w_q (Nagtegaal, Parks, Rice 1974; Simo, Taylor, Pister 1985), which has a symmetric tangent.
/// @tparam Scalar double, or complex for derivatives of the force by complex steps
template<class Cell, typename Scalar>
class FiniteStrainCell
{
public:
  using NodalValues = typename Cell::template NodalValues<Scalar>;
  using Vector = typename Cell::template Vector<Scalar>;
  using Matrix = typename Cell::template Matrix<Scalar>;

  FiniteStrainCell(const CellPoints<Cell> &points, const ElasticModuli &moduli, bool mean_dilatation,
                   const NodalValues &u)
    : points_(points)
    , moduli_(moduli)
  {
    Scalar current_volume = 0;
    for (std::size_t q = 0; q < points.size(); ++q)
    {
      deformations_[q] = Deformation<Cell, Scalar>(points[q], u);
      valid_ = valid_ && deformations_[q].right_way_out();
      volume_ += points[q].weight;
      current_volume += points[q].weight * deformations_[q].J;
    }
    if (mean_dilatation && valid_)
      mean_.emplace(moduli.bulk, current_volume / volume_);
  }

  /// False: a point is turned inside out, and nothing else may be asked.
  [[nodiscard]] bool valid() const { return valid_; }

  [[nodiscard]] Vector force() const
  {
    Vector sum = Vector::Zero();
    for (std::size_t q = 0; q < points_.size(); ++q)
    {
      const Deformation<Cell, Scalar> &d = deformations_[q];
      const PointStress<Scalar> stress = response(d).stress;
      const double w = points_[q].weight;
      sum += (w * stress.f) * stretch(q) + (w * stress.h) * divergence(q, NodalValues(d.H * points_[q].gradients));
    }
    return sum;
  }

  [[nodiscard]] Matrix tangent() const
  {
    TangentSum<Cell, 2> sum;
    Vector dilatation = Vector::Zero();
    for (std::size_t q = 0; q < points_.size(); ++q)
    {
      const Deformation<Cell, Scalar> &d = deformations_[q];
      const NodalValues spatial = d.H * points_[q].gradients;
      const Vector along_h = divergence(q, spatial);
      sum.set(static_cast<int>(q), points_[q], response(d).tangent, spatial, along_h, stretch(q), d.across);
      dilatation += (points_[q].weight * d.J) * along_h;
    }
    Matrix K = sum.total();
    if (mean_)
      K.noalias() += (mean_->second / volume_ * dilatation) * dilatation.transpose();
    return K;
  }

  /// Mean Cauchy stress over the current volume: xx, yy, zz, xy, yz, xz.
  [[nodiscard]] Eigen::Matrix<Scalar, 6, 1> stress() const
  {
    using Tensor = Eigen::Matrix<Scalar, 3, 3>;
    Tensor kirchhoff = Tensor::Zero();
    Scalar current_volume = 0;
    for (std::size_t q = 0; q < points_.size(); ++q)
    {
      const Deformation<Cell, Scalar> &d = deformations_[q];
      const Response law = response(d);
      Tensor F = Tensor::Identity();
      F.template topLeftCorner<Cell::dim, Cell::dim>() = d.F;
      if constexpr (Cell::dim == 2)
        F(2, 2) = law.across;
      kirchhoff += points_[q].weight * (law.stress.f * (F * F.transpose()) + law.stress.h * Tensor::Identity());
      current_volume += points_[q].weight * F.determinant();
    }
    const Tensor s = kirchhoff / current_volume;
    return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
  }

private:
  struct Response
  {
    PointStress<Scalar> stress;
    PointTangent<Scalar> tangent;
    Scalar across;
  };

  [[nodiscard]] Response response(const Deformation<Cell, Scalar> &d) const
  {
    if constexpr (Cell::plane_stress)
    {
      const PlaneStressNeoHooke<Scalar> law(moduli_, d.I1, d.J);
      return {law.stress, law.tangent, law.stretch};
    }
    else
    {
      const VolumetricResponse<Scalar> local(moduli_.bulk, d.J);
      const NeoHooke<Scalar> law(moduli_.shear, d.I1, d.J, mean_ ? mean_->first : local.first,
                                 mean_ ? Scalar(0) : local.second);
      return {law.stress, law.tangent, d.across};
    }
  }

  /// F : dF by unknown.
  [[nodiscard]] Vector stretch(std::size_t q) const
  {
    const NodalValues pushed = deformations_[q].F * points_[q].gradients;
    return by_unknown<Cell, Scalar>(pushed, points_[q], deformations_[q].across);
  }

  /// H : dF by unknown.
  [[nodiscard]] Vector divergence(std::size_t q, const NodalValues &spatial) const
  {
    return by_unknown<Cell, Scalar>(spatial, points_[q], Scalar(1) / deformations_[q].across);
  }

  const CellPoints<Cell> &points_;
  const ElasticModuli &moduli_;
  std::array<Deformation<Cell, Scalar>, Cell::points> deformations_;
  std::optional<VolumetricResponse<Scalar>> mean_;
  double volume_ = 0;
  bool valid_ = true;
};
} // namespace amontons
