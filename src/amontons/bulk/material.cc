#include "amontons/bulk/material_von_mises.h"

namespace amontons
{
ElasticModuli elastic_moduli(const BodyOptions &body, Strain strain)
{
  const MaterialOptions &material = body.material;
  if (material.law == MaterialLaw::linear_elastic && strain == Strain::finite)
    throw UserError(body.where, "body '" + body.name +
                                    "': linear-elastic holds in small strain only; with 'strain: finite' use the law "
                                    "neo-hookean, which has the same moduli at small strain");
  if (!(material.young > 0) || !std::isfinite(material.young))
    throw UserError(body.where, "body '" + body.name + "': young must be positive");
  if (!(material.poisson > -1 && material.poisson < 0.5))
    throw UserError(body.where, "body '" + body.name +
                                    "': poisson must lie in (-1, 0.5); for a nearly incompressible body take 0.499 or "
                                    "0.4999 with mean dilatation");
  return {material.young / (2 * (1 + material.poisson)), material.young / (3 * (1 - 2 * material.poisson))};
}

Hardening hardening(const BodyOptions &body, Strain strain)
{
  const auto fail = [&](const std::string &what) { throw UserError(body.where, "body '" + body.name + "': " + what); };
  if (strain == Strain::finite)
    fail("von-mises holds in small strain only; finite strain has the law neo-hookean, which is elastic");
  const MaterialOptions &material = body.material;
  if (!(material.yield_stress > 0) || !std::isfinite(material.yield_stress))
    fail("yield-stress must be positive");
  for (const double constant :
       {material.isotropic_hardening, material.saturation_gain, material.saturation_rate, material.kinematic_hardening})
    if (!(constant >= 0) || !std::isfinite(constant))
      fail("constants of hardening must not be negative");
  return {material.yield_stress, material.isotropic_hardening, material.saturation_gain, material.saturation_rate,
          material.kinematic_hardening};
}
} // namespace amontons
