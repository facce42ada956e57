#include "amontons/input/deck_keys.h"

#include <algorithm>

namespace amontons
{
namespace
{
const Section<MaterialOptions>::Choices<MaterialLaw> laws{{"linear-elastic", MaterialLaw::linear_elastic},
                                                          {"neo-hookean", MaterialLaw::neo_hookean},
                                                          {"von-mises", MaterialLaw::von_mises},
                                                          {"rigid", MaterialLaw::rigid}};

void check_plasticity(const Value &value, const MaterialOptions &material)
{
  const bool plastic = material.law == MaterialLaw::von_mises;
  for (const char *name :
       {"yield-stress", "isotropic-hardening", "saturation-gain", "saturation-rate", "kinematic-hardening"})
    if (const Value *constant = value.find(name); constant && !plastic)
      constant->fail("has a meaning with law: von-mises only");
  if (plastic && !value.find("yield-stress"))
    value.fail("the key 'yield-stress' is missing (required with law: von-mises)");
  if (!value.find("saturation-gain") != !value.find("saturation-rate"))
    value.fail("the keys 'saturation-gain' and 'saturation-rate' go together");
}

Section<MaterialOptions> material_keys()
{
  Section<MaterialOptions> keys;
  keys.choice(
      "law", &MaterialOptions::law, laws, required,
      "linear-elastic and von-mises (plastic) go with strain: small, neo-hookean with strain: finite, rigid with both");
  keys.number("young", &MaterialOptions::young, positive, "stress", otherwise("required unless rigid"),
              "Young's modulus, in finite strain that of the undeformed material");
  keys.number("poisson", &MaterialOptions::poisson, {-1, 0.5}, "1", otherwise("required unless rigid"),
              "Poisson's ratio");
  keys.number("yield-stress", &MaterialOptions::yield_stress, positive, "stress", otherwise("required with von-mises"),
              "uniaxial stress at which the virgin material yields");
  keys.number("isotropic-hardening", &MaterialOptions::isotropic_hardening, not_negative, "stress", optional,
              "von-mises: growth of the yield stress with the equivalent plastic strain p, linear part");
  keys.number("saturation-gain", &MaterialOptions::saturation_gain, not_negative, "stress", optional,
              "von-mises: the yield stress grows by saturation-gain (1 - exp(-saturation-rate p)) besides (Voce)");
  keys.number("saturation-rate", &MaterialOptions::saturation_rate, positive, "1",
              otherwise("required with saturation-gain"), "see saturation-gain");
  keys.number("kinematic-hardening", &MaterialOptions::kinematic_hardening, not_negative, "stress", optional,
              "von-mises: growth of the back stress with the plastic strain in uniaxial stress (Prager)");
  keys.check(
      [](const Value &value, MaterialOptions &material, ReadContext &)
      {
        for (const char *name : {"young", "poisson"})
        {
          const Value *constant = value.find(name);
          if (material.law == MaterialLaw::rigid && constant)
            constant->fail("has no meaning with law: rigid");
          if (material.law != MaterialLaw::rigid && !constant)
            value.fail("the key '" + std::string(name) + "' is missing (required unless the law is rigid)");
        }
        check_plasticity(value, material);
      });
  return keys;
}

void check_body(const Value &value, BodyOptions &body, ReadContext &context)
{
  const Value *region = value.find("region"), *shape = value.find("shape");
  if (region && shape)
    shape->fail("a body is either meshed (region) or analytic (shape), not both");
  if (!region && !shape)
    value.fail("one of the keys 'region' (a meshed body) and 'shape' (an analytic one) is missing");
  if (shape && body.material.law != MaterialLaw::rigid)
    value.find("material")->find("law")->fail("must be rigid for a body given by its shape");
  body.where = region ? region->where : shape->where;
  const Value *mean = value.find("mean-dilatation");
  if (mean && body.material.law == MaterialLaw::rigid)
    mean->fail("has no meaning for a rigid body");
  if (mean && *body.mean_dilatation && context.kinematics == Kinematics::plane_stress)
    mean->fail("must be false in plane stress, where nothing locks");
}
} // namespace

Section<BodyOptions> body_keys()
{
  Section<BodyOptions> keys;
  keys.text("name", &BodyOptions::name, required, "to speak of the body in the deck, messages and outputs; unique");
  keys.text("region", &BodyOptions::region, otherwise("required without `shape`"),
            "physical group of the body's cells; for a rigid body also of its surface alone");
  keys.map<Shape>("shape", shape_keys(), otherwise("none"), "an analytic rigid body, which needs no mesh",
                  [](BodyOptions &body, Shape shape) { body.shape = shape; });
  keys.map<MaterialOptions>("material", material_keys(), required, "what the body is made of",
                            [](BodyOptions &body, MaterialOptions material) { body.material = material; });
  keys.boolean("mean-dilatation", &BodyOptions::mean_dilatation,
               otherwise("true for quadrilaterals and hexahedra, but not in plane stress"),
               "one pressure per cell, against locking of nearly incompressible materials");
  keys.check(check_body);
  return keys;
}
} // namespace amontons
