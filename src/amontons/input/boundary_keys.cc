#include "amontons/input/deck_keys.h"

#include <algorithm>

namespace amontons
{
namespace
{
using Keys = Section<BoundaryOptions>;
using Components = std::map<int, Expression>;

const std::vector<std::string> axes{"x", "y", "z"};

/// Names of translations in this kinematics, or of rotations (about z in the plane, none in axisymmetry).
std::vector<std::string> component_names(const ReadContext &context, bool rotations)
{
  if (!rotations)
    return {axes.begin(), axes.begin() + context.dim()};
  if (context.kinematics == Kinematics::axisymmetric)
    return {};
  return context.dim() == 3 ? axes : std::vector<std::string>{"z"};
}

int to_component(const std::string &name, const SourceLocation &where, const std::string &path,
                 const ReadContext &context, bool rotations)
{
  const std::vector<std::string> names = component_names(context, rotations);
  if (names.empty())
    throw UserError(where, path + ": nothing turns in axisymmetry");
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw UserError(where, path + ": no component '" + name + "' here; the components are " + joined(names));
  return static_cast<int>(std::find(axes.begin(), axes.end(), name) - axes.begin());
}

Expression to_expression(const Value &value)
{
  if (value.kind != Value::Kind::scalar || value.text.empty())
    value.fail("must be a number or an expression of t, x, y, z, not " + value.described());
  return {value.text, value.where};
}

void add_components(Keys &keys, const std::string &name, Components BoundaryOptions::*member, const std::string &unit,
                    bool rotations, const std::string &meaning)
{
  keys.key(Keys::row(name, "map of component to expression", unit,
                     rotations ? "x, y, z in 3D; z in the plane" : "x, y; z in 3D", otherwise("none"), "", meaning,
                     [=](const Value &value, BoundaryOptions &out, ReadContext &context)
                     {
                       require_map(value, "component to number or expression");
                       for (const Value &item : value.items)
                       {
                         const int c = to_component(item.key, item.key_where, value.path, context, rotations);
                         (out.*member)[c] = to_expression(item);
                       }
                     }));
}

void read_fix(const Value &value, BoundaryOptions &out, ReadContext &context)
{
  require_list(value, "components");
  for (const Value &item : value.items)
  {
    const int c = to_component(to_text(item), item.where, value.path, context, false);
    if (std::find(out.fix.begin(), out.fix.end(), c) != out.fix.end())
      item.fail("the component '" + item.text + "' stands twice");
    out.fix.push_back(c);
  }
}
} // namespace

Section<BoundaryOptions> boundary_keys()
{
  Keys keys;
  keys.text("region", &BoundaryOptions::region, required, "physical group or a body's name");
  keys.key(Keys::row("fix", "list of components", "", "x, y; z in 3D", otherwise("none"), "",
                     "components of the displacement held at zero", read_fix));
  add_components(keys, "displacement", &BoundaryOptions::displacement, "length", false,
                 "components of the displacement prescribed");
  add_components(keys, "rotation", &BoundaryOptions::rotation, "radians", true, "rigid bodies: rotation prescribed");
  add_components(keys, "traction", &BoundaryOptions::traction, "force per reference area", false,
                 "force on a surface, of fixed direction");
  keys.key(Keys::row("pressure", "expression", "force per area", "", otherwise("none"), "",
                     "pushes on a surface where positive; in finite strain it follows the surface",
                     [](const Value &value, BoundaryOptions &out, ReadContext &)
                     { out.pressure = to_expression(value); }));
  add_components(keys, "spring", &BoundaryOptions::spring, "force per length and reference area", false,
                 "stiffness against displacement of a surface from its reference place");
  add_components(keys, "force", &BoundaryOptions::force, "force", false,
                 "rigid bodies: total force (in axisymmetry over the whole ring), which frees that component; groups "
                 "of points: force on each node");
  add_components(keys, "moment", &BoundaryOptions::moment, "force times length", true,
                 "rigid bodies: moment, which frees that rotation");
  add_components(keys, "body-force", &BoundaryOptions::body_force, "force per reference volume", false,
                 "on the volume of a body or of a group of cells");
  keys.check(
      [](const Value &value, BoundaryOptions &out, ReadContext &)
      {
        out.where = value.find("region")->where;
        if (value.items.size() == 1)
          value.fail("says nothing about '" + out.region + "'; give one of " +
                     joined({"fix", "displacement", "rotation", "traction", "pressure", "spring", "force", "moment",
                             "body-force"}));
      });
  return keys;
}
} // namespace amontons
