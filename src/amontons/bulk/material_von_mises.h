#pragma once
#include "amontons/bulk/material.h"

#include <Eigen/Core>

#include <limits>

namespace amontons
{
/// Components xx, yy, zz, xy, yz, xz of a symmetric tensor; shear strains are the tensor's, half the engineer's.
template<typename Scalar>
using SymmetricTensor = Eigen::Matrix<Scalar, 6, 1>;

/// a : b
template<typename Scalar>
Scalar contract(const SymmetricTensor<Scalar> &a, const SymmetricTensor<Scalar> &b)
{
  return (a.template head<3>().array() * b.template head<3>().array()).sum() +
         2.0 * (a.template tail<3>().array() * b.template tail<3>().array()).sum();
}

/// Hardening of von Mises' law: the yield stress against the equivalent plastic strain p is
/// yield + isotropic p + gain (1 - exp(-rate p)) (Voce 1955), and the yield surface is centred at the back stress
/// 2/3 kinematic e_p (Prager 1956). Stress, but for the rate.
struct Hardening
{
  double yield = 0, isotropic = 0, gain = 0, rate = 0, kinematic = 0;

  template<typename Scalar>
  [[nodiscard]] Scalar yield_stress(const Scalar &p) const
  {
    using std::exp;
    return yield + isotropic * p + gain * (1.0 - exp(-rate * p));
  }
  template<typename Scalar>
  [[nodiscard]] Scalar slope(const Scalar &p) const
  {
    using std::exp;
    return isotropic + gain * rate * exp(-rate * p);
  }
};

/// @throws UserError for a constant out of range, or finite strain, for which the law is not made
Hardening hardening(const BodyOptions &body, Strain strain);

/// What a point remembers: its plastic strain (traceless) and the equivalent plastic strain, int sqrt(2/3 de_p : de_p).
template<typename Scalar>
struct PlasticHistory
{
  SymmetricTensor<Scalar> strain = SymmetricTensor<Scalar>::Zero();
  Scalar equivalent = 0;
};

/// Stress deviator of von Mises' law in small strain, implicit in the increment (radial return: Wilkins 1964, Simo,
/// Taylor 1985), as a function of the strain at its end and of the history at its beginning.
///
/// The tangent is the derivative of that function, A_ijkl = id d_ik d_jl + swap d_il d_jk + hh d_ij d_kl + ff n_ij
/// n_kl: PointTangent with the unit normal n of the yield surface in the place of F. The pressure is not in it.
/// @tparam Scalar double, or complex for derivatives by complex steps
template<typename Scalar>
struct VonMises
{
  using Tensor = SymmetricTensor<Scalar>;

  VonMises() = default;
  /// @param strain whole, or its deviator: the same
  VonMises(double shear, const Hardening &law, const PlasticHistory<double> &start, const Tensor &strain)
  {
    history.strain = start.strain.template cast<Scalar>();
    history.equivalent = start.equivalent;
    stress = 2 * shear * (strain - history.strain);
    stress.template head<3>().array() -= 2 * shear / 3 * strain.template head<3>().sum();
    tangent.id = tangent.swap = shear;
    tangent.hh = -2 * shear / 3;
    const Tensor relative = stress - 2.0 / 3 * law.kinematic * history.strain;
    const double size = std::sqrt(real_part(contract(relative, relative)));
    const double limit = root * law.yield_stress(start.equivalent);
    if (size - limit > round_off * limit)
      flow(shear, law, relative);
  }

  Tensor stress = Tensor::Zero(), normal = Tensor::Zero();
  PointTangent<Scalar> tangent;
  PlasticHistory<Scalar> history; ///< at the increment's end

private:
  static constexpr double root = 0.816496580927726; ///< sqrt(2/3)
  /// An excess below this part of the yield stress is round-off, not flow.
  static constexpr double round_off = 1e-12;

  /// @param relative trial stress over the back stress
  void flow(double shear, const Hardening &law, const Tensor &relative)
  {
    using std::sqrt;
    const Scalar size = sqrt(contract(relative, relative));
    const double stiffness = 2 * shear + 2.0 / 3 * law.kinematic;
    const Scalar amount = multiplier(law, stiffness, size);
    normal = relative / size;
    stress -= 2 * shear * amount * normal;
    history.strain += amount * normal;
    history.equivalent += root * amount;
    const Scalar turn = 2 * shear * amount / size;
    const Scalar along = 2 * shear / (stiffness + 2.0 / 3 * law.slope(history.equivalent));
    tangent.id -= shear * turn;
    tangent.swap = tangent.id;
    tangent.hh = -2.0 / 3 * tangent.id;
    tangent.ff = -2 * shear * (along - turn);
  }

  /// The norm of the plastic strain's increment. The excess over the yield stress is a convex, falling function of it,
  /// so Newton's method climbs to the root from below; it has arrived when it climbs no more.
  Scalar multiplier(const Hardening &law, double stiffness, const Scalar &size) const
  {
    Scalar amount = 0;
    for (int iteration = 0; iteration < 100; ++iteration)
    {
      const Scalar p = history.equivalent + root * amount;
      const Scalar excess = size - stiffness * amount - root * law.yield_stress(p);
      const Scalar step = excess / (stiffness + 2.0 / 3 * law.slope(p));
      const Scalar next = amount + step;
      const bool arrived = iteration > 0 && !(real_part(next) > real_part(amount));
      amount = next;
      if (arrived)
        break;
    }
    return amount;
  }
};

/// The same in plane stress: the strain across follows from sigma_33 = 0, and is eliminated from the tangent, to which
/// the bulk modulus is still to be added (to hh), as it is to that of VonMises.
template<typename Scalar>
class PlaneStressVonMises : public VonMises<Scalar>
{
public:
  using Tensor = typename VonMises<Scalar>::Tensor;

  /// @param strain in the plane; the component zz is not read
  PlaneStressVonMises(const ElasticModuli &moduli, const Hardening &law, const PlasticHistory<double> &start,
                      Tensor strain)
  {
    strain[2] = 0;
    find_strain(moduli, law, start, strain);
    dilatation = strain.template head<3>().sum();
    PointTangent<Scalar> &t = this->tangent;
    const Scalar along_unit = t.hh + moduli.bulk, along_normal = t.ff * this->normal[2], across = slope(moduli);
    t.hh -= along_unit * along_unit / across;
    t.fh -= along_unit * along_normal / across;
    t.ff -= along_normal * along_normal / across;
  }

  Scalar dilatation; ///< volumetric strain

private:
  /// dsigma_33 / de_33
  [[nodiscard]] Scalar slope(const ElasticModuli &moduli) const
  {
    const PointTangent<Scalar> &t = this->tangent;
    return t.id + t.swap + t.hh + moduli.bulk + t.ff * this->normal[2] * this->normal[2];
  }

  /// sigma_33 grows with e_33 at a slope between bulk and bulk + 4/3 shear, so there is one root. Newton's method, but
  /// by halves where it would leave the bounds met so far.
  void find_strain(const ElasticModuli &moduli, const Hardening &law, const PlasticHistory<double> &start,
                   Tensor &strain)
  {
    double size = law.yield / moduli.bulk;
    for (const int i : {0, 1, 3})
      size += std::abs(strain[i]);
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    bool arrived = false;
    for (int iteration = 0; iteration < 100; ++iteration)
    {
      static_cast<VonMises<Scalar> &>(*this) = VonMises<Scalar>(moduli.shear, law, start, strain);
      if (arrived)
        break;
      const Scalar across = this->stress[2] + moduli.bulk * strain.template head<3>().sum();
      (real_part(across) < 0 ? low : high) = real_part(strain[2]);
      const Scalar step = -across / slope(moduli);
      arrived = std::abs(step) <= 1e-13 * size;
      strain[2] += step;
      if (const double next = real_part(strain[2]); !arrived && (next <= low || next >= high))
        strain[2] = (low + high) / 2;
    }
  }
};
} // namespace amontons
