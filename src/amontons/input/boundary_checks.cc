#include "amontons/base/suggestion.h"
#include "amontons/input/deck_checks.h"

#include <algorithm>

namespace amontons
{
namespace
{
/// The rigid body that a region means, by the body's name or its own region.
const BodyOptions *rigid_body(const Deck &deck, const std::string &region)
{
  for (const BodyOptions &body : deck.bodies)
    if (body.material.law == MaterialLaw::rigid && (body.name == region || body.region == region))
      return &body;
  return nullptr;
}

bool is_region_of_deformable_body(const Deck &deck, const std::string &region)
{
  return std::any_of(deck.bodies.begin(), deck.bodies.end(),
                     [&](const BodyOptions &body)
                     { return body.material.law != MaterialLaw::rigid && body.region == region; });
}

/// Keys that a rigid body, or a deformable region, does not take, as far as the deck tells: what a name of the mesh
/// means is seen with the mesh.
void check_suits(const Value &entry, const Deck &deck)
{
  const Value &region = *entry.find("region");
  const BodyOptions *rigid = rigid_body(deck, region.text);
  const auto refuse = [&](const std::vector<std::string> &keys, const std::string &why)
  {
    for (const std::string &key : keys)
      if (const Value *value = entry.find(key))
        value->fail(why);
  };
  if (!rigid)
  {
    std::vector<std::string> names;
    for (const BodyOptions &body : deck.bodies)
      if (body.material.law == MaterialLaw::rigid)
        names.push_back(body.name);
    refuse({"rotation", "moment"}, "is for rigid bodies, and '" + region.text + "' is none" +
                                       did_you_mean(region.text, names) +
                                       (names.empty() ? "; the deck has none" : "; rigid bodies: " + joined(names)));
    if (is_region_of_deformable_body(deck, region.text))
      refuse({"traction", "pressure", "spring", "force"},
             "acts on a group of faces or points, and '" + region.text + "' is the cells of a body");
    return;
  }
  refuse({"traction", "pressure", "spring", "body-force"},
         "cannot act on the rigid body '" + rigid->name + "'; give its force or its displacement");
  if (rigid->shape)
    refuse({"rotation", "moment"}, "'" + rigid->name + "' is an analytic body, which moves without turning");
}

/// What an entry says of one component of one region.
struct Claim
{
  std::string what; ///< "fix x", "force y"
  SourceLocation where;
};

/// All entries' claims on the motion of a region. Two on the same component contradict each other, except fix and fix.
class Claims
{
public:
  void add(const std::string &region, const std::string &motion, int component, const std::string &key,
           const SourceLocation &where)
  {
    static const char *const axes[]{"x", "y", "z"};
    const Claim claim{key + " " + axes[component], where};
    const auto [other, is_new] = claims_.try_emplace({region, motion, component}, claim);
    if (is_new || (claim.what == other->second.what && key == "fix"))
      return;
    throw UserError(where, claim.what + " on '" + region + "' contradicts " + other->second.what + " at " +
                               other->second.where.text() + "; a component can be given once");
  }

private:
  std::map<std::tuple<std::string, std::string, int>, Claim> claims_;
};
} // namespace

void check_boundary(const Value &root, const Deck &deck)
{
  Claims claims;
  for (std::size_t i = 0; i < deck.boundary.size(); ++i)
  {
    const BoundaryOptions &entry = deck.boundary[i];
    const Value &value = root.find("boundary")->items[i];
    check_suits(value, deck);
    const BodyOptions *rigid = rigid_body(deck, entry.region);
    const std::string region = rigid ? rigid->name : entry.region;
    for (std::size_t k = 0; k < entry.fix.size(); ++k)
      claims.add(region, "translation", entry.fix[k], "fix", value.find("fix")->items[k].where);
    for (const auto &[c, expression] : entry.displacement)
      claims.add(region, "translation", c, "displacement", expression.where);
    for (const auto &[c, expression] : entry.force)
      claims.add(region, "translation", c, "force", expression.where);
    for (const auto &[c, expression] : entry.rotation)
      claims.add(region, "rotation", c, "rotation", expression.where);
    for (const auto &[c, expression] : entry.moment)
      claims.add(region, "rotation", c, "moment", expression.where);
  }
}
} // namespace amontons
