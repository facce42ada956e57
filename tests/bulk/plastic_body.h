#pragma once
#include "block_mesh.h"

namespace amontons
{
inline constexpr double young = 1, poisson = 0.3, yield = 1e-3;

/// A body of von Mises' law with linear hardening, named as elastic_body names it.
inline BodyOptions plastic_body(double isotropic = 0, double kinematic = 0, double nu = poisson)
{
  BodyOptions body = elastic_body(MaterialLaw::von_mises, young, nu);
  body.material.yield_stress = yield;
  body.material.isotropic_hardening = isotropic;
  body.material.kinematic_hardening = kinematic;
  return body;
}
} // namespace amontons
