#pragma once
#include "amontons/bulk/options.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace amontons
{
/// Moduli of an isotropic elastic solid, stress.
struct ElasticModuli
{
  double shear = 0;
  double bulk = 0;

  [[nodiscard]] double lame() const { return bulk - 2 * shear / 3; }
  /// Lame's first parameter of plane stress, once the strain across is eliminated.
  [[nodiscard]] double lame_plane_stress() const { return 2 * lame() * shear / (lame() + 2 * shear); }
};

/// @throws UserError for a Young's modulus or Poisson's ratio out of range, or a law that does not go with `strain`
ElasticModuli elastic_moduli(const BodyOptions &body, Strain strain);

inline double real_part(double value)
{
  return value;
}
inline double real_part(const std::complex<double> &value)
{
  return value.real();
}

/// P = f F + h H with H = F^-T: the first Piola-Kirchhoff stress of any law W(I1, J), I1 = tr F^T F, J = det F.
template<typename Scalar>
struct PointStress
{
  Scalar f{}, h{};
};

/// Its derivative, with the same H:
/// A_iJkL = id d_ik d_JL + ff F_iJ F_kL + fh (F_iJ H_kL + H_iJ F_kL) + hh H_iJ H_kL + swap H_iL H_kJ.
/// Linear elasticity is the case F = H = 1, id = swap = G, hh = lambda.
template<typename Scalar>
struct PointTangent
{
  Scalar id{}, ff{}, fh{}, hh{}, swap{};
};

/// Pressure-like derivative U' of U(J) = bulk/2 ((J^2 - 1)/2 - ln J) and U''.
template<typename Scalar>
struct VolumetricResponse
{
  VolumetricResponse(double bulk, const Scalar &J)
    : first(bulk / 2 * (J - 1.0 / J))
    , second(bulk / 2 * (1.0 + 1.0 / (J * J)))
  {
  }
  Scalar first, second;
};

/// Compressible neo-Hooke W = shear/2 (J^(-2/3) I1 - 3) + U(J) (Simo, Taylor, Pister 1985, with tr C scaled by
/// Flory's split), at one point.
///
/// U' and U'' are given apart, because mean dilatation takes U' from the cell and has no pointwise U''.
template<typename Scalar>
struct NeoHooke
{
  NeoHooke(double shear, const Scalar &I1, const Scalar &J, const Scalar &pressure, const Scalar &pressure_slope)
  {
    using std::pow;
    const Scalar a = shear * pow(J, -2.0 / 3);
    stress.f = a;
    stress.h = pressure * J - a * I1 / 3.0;
    tangent.id = a;
    tangent.fh = -2.0 / 3 * a;
    tangent.hh = 2.0 / 9 * a * I1 + pressure * J + pressure_slope * J * J;
    tangent.swap = a * I1 / 3.0 - pressure * J;
  }

  PointStress<Scalar> stress;
  PointTangent<Scalar> tangent;
};

/// Neo-Hooke in plane stress: the stretch across, F33, follows from P33 = 0 and is eliminated from the tangent, which
/// keeps the form of PointTangent with the in-plane F and H.
template<typename Scalar>
class PlaneStressNeoHooke
{
public:
  /// @param I1_plane tr F^T F and J_plane det F of the 2x2 deformation gradient
  PlaneStressNeoHooke(const ElasticModuli &moduli, const Scalar &I1_plane, const Scalar &J_plane)
    : stretch(find_stretch(moduli, I1_plane, J_plane))
  {
    const NeoHooke<Scalar> law = at(moduli, I1_plane, J_plane, stretch);
    stress = law.stress;
    tangent = law.tangent;
    const Scalar along_f = tangent.ff * stretch + tangent.fh / stretch;
    const Scalar along_h = tangent.fh * stretch + tangent.hh / stretch;
    const Scalar across = slope(tangent, stretch);
    tangent.ff -= along_f * along_f / across;
    tangent.fh -= along_f * along_h / across;
    tangent.hh -= along_h * along_h / across;
  }

  Scalar stretch;
  PointStress<Scalar> stress;
  PointTangent<Scalar> tangent;

private:
  static NeoHooke<Scalar> at(const ElasticModuli &moduli, const Scalar &I1_plane, const Scalar &J_plane,
                             const Scalar &stretch)
  {
    const Scalar J = J_plane * stretch;
    const VolumetricResponse<Scalar> volumetric(moduli.bulk, J);
    return {moduli.shear, I1_plane + stretch * stretch, J, volumetric.first, volumetric.second};
  }

  /// dP33/dF33
  static Scalar slope(const PointTangent<Scalar> &t, const Scalar &stretch)
  {
    const Scalar square = stretch * stretch;
    return t.id + t.ff * square + 2.0 * t.fh + (t.hh + t.swap) / square;
  }

  /// W is strictly convex in F33 and grows without bound at both ends, so there is one root; a step changes F33 by a
  /// factor of at most two, which keeps Newton's method inside (0, oo) from any start.
  static Scalar find_stretch(const ElasticModuli &moduli, const Scalar &I1_plane, const Scalar &J_plane)
  {
    using std::pow;
    const double lame = moduli.lame();
    Scalar stretch = pow(J_plane, -lame / (lame + 2 * moduli.shear)); // exact to first order
    for (int iteration = 0; iteration < 100; ++iteration)
    {
      const NeoHooke<Scalar> law = at(moduli, I1_plane, J_plane, stretch);
      const Scalar force = law.stress.f * stretch + law.stress.h / stretch;
      const Scalar step = -force / slope(law.tangent, stretch);
      const double relative = real_part(step) / real_part(stretch);
      stretch += relative < -0.5 ? -0.5 * stretch : relative > 1 ? stretch : step;
      if (std::abs(step) < 1e-9 * std::abs(stretch)) // the error is now of the order of the square
        break;
    }
    return stretch;
  }
};
} // namespace amontons
