#include "amontons/input/deck_keys.h"

namespace amontons
{
namespace
{
enum class FrictionLaw
{
  none,
  coulomb
};

struct FrictionOptions
{
  FrictionLaw law = FrictionLaw::coulomb;
  double coefficient = 0;
};

Section<FrictionOptions> friction_keys()
{
  Section<FrictionOptions> keys;
  keys.choice("law", &FrictionOptions::law, {{"coulomb", FrictionLaw::coulomb}, {"none", FrictionLaw::none}}, required,
              "how the surfaces hold each other");
  keys.number("coefficient", &FrictionOptions::coefficient, not_negative, "1", otherwise("required with coulomb"),
              "Coulomb's coefficient mu");
  keys.check(
      [](const Value &value, FrictionOptions &friction, ReadContext &)
      {
        const Value *coefficient = value.find("coefficient");
        if (friction.law == FrictionLaw::none && coefficient)
          coefficient->fail("has no meaning with law: none");
        if (friction.law == FrictionLaw::coulomb && !coefficient)
          value.fail("the key 'coefficient' is missing (required with law: coulomb)");
      });
  return keys;
}

/// Either both sides or the one surface that is both.
void check_sides(const Value &value, const ContactOptions &contact)
{
  const Value *impactor = value.find("impactor"), *target = value.find("target"), *surface = value.find("surface");
  if (surface && (impactor || target))
    (impactor ? impactor : target)->fail("has no meaning with 'surface', which is both sides of its own contact");
  if (!surface && !(impactor && target))
    value.fail(std::string("the key '") + (impactor ? "target" : "impactor") +
               "' is missing (a contact has impactor and target, or, where a surface touches itself, 'surface')");
  if (!surface && contact.impactor == contact.target)
    target->fail("the impactor and the target are the same, '" + contact.target +
                 "'; a contact pair has two sides. Where a surface touches itself, write 'surface: " + contact.target +
                 "' instead of both");
  if (const Value *distance = value.find("self-distance"); distance && !surface)
    distance->fail("has a meaning with 'surface' only, where a surface touches itself");
  if (const Value *tied = value.find("tied"); tied && contact.tied && surface)
    tied->fail("has no meaning where a surface touches itself");
}
} // namespace

Section<ContactOptions> contact_keys()
{
  Section<ContactOptions> keys;
  keys.text("name", &ContactOptions::name, required,
            "names the outputs of this contact; unique; letters, digits, '-', '_' and '.'");
  const Need side = otherwise("required without surface");
  keys.text("impactor", &ContactOptions::impactor, side,
            "physical group of faces whose nodes are kept from crossing the target");
  keys.text("target", &ContactOptions::target, side, "physical group of faces, or the name of an analytic rigid body");
  keys.key(Section<ContactOptions>::row(
      "surface", "text", "", "", otherwise("none: impactor and target"), "",
      "self-contact: physical group of faces that may touch each other, instead of impactor and target; which of them "
      "are which is found as they meet. It may bound several bodies",
      [](const Value &value, ContactOptions &contact, ReadContext &)
      { contact.impactor = contact.target = to_text(value); }));
  keys.number("self-distance", &ContactOptions::self_distance, not_negative, "length",
              otherwise("twice the longest edge of the node's own faces"),
              "with surface: within this distance along the undeformed surface a node touches no face");
  keys.map<FrictionOptions>(
      "friction", friction_keys(), otherwise("none: the surfaces slide freely"), "what the surfaces do when they slide",
      [](ContactOptions &contact, FrictionOptions friction) { contact.friction_coefficient = friction.coefficient; });
  keys.boolean("tied", &ContactOptions::tied, optional,
               "true: each impactor node that finds a target face at the start keeps its place on it, gap and all, and "
               "takes tension too; for bodies that are joined but whose meshes do not match");
  keys.choice("initial-overlap", &ContactOptions::initial_overlap,
              {{"resolve", InitialOverlap::resolve}, {"adjust", InitialOverlap::adjust}}, optional,
              "nodes inside the target before anything moves; resolve: a press-fit, pushed out in the first increment; "
              "adjust: the gap is measured from there and no stress comes of it");
  keys.choice("normals", &ContactOptions::normals,
              {{"faceted", TargetNormals::faceted}, {"smoothed", TargetNormals::smoothed}}, optional,
              "along which normals contact forces act on a meshed target in finite strain; smoothed: averaged at the "
              "target's nodes and interpolated, so that they do not jump where a node slides from face to face (edges "
              "sharper than 30 degrees stay sharp); faceted: of each face");
  keys.choice("discretization", &ContactOptions::discretization,
              {{"node-to-face", Discretization::node_to_face}, {"mortar", Discretization::mortar}}, optional,
              "where the gap is measured; node-to-face: at the impactor's nodes; mortar: surface to surface, in the "
              "mean over the impactor's faces, so that a uniform pressure passes exactly between meshes that do not "
              "match (two meshed sides)");
  keys.number("augmentation", &ContactOptions::augmentation, positive, "1", optional,
              "factor on the augmentation parameter, which is found from the bodies' stiffness; the solution does not "
              "depend on it");
  keys.check(
      [](const Value &value, ContactOptions &contact, ReadContext &)
      {
        contact.where = value.where;
        if (const Value *friction = value.find("friction"); friction && contact.tied)
          friction->fail("has no meaning with tied: true");
        if (const Value *overlap = value.find("initial-overlap"); overlap && contact.tied)
          overlap->fail("has no meaning with tied: true, which keeps the initial gap");
        check_sides(value, contact);
      });
  return keys;
}
} // namespace amontons
