#include "amontons/bulk/material.h"

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
} // namespace amontons
