#include "amontons/input/deck_keys.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace amontons
{
namespace
{
const Section<Shape>::Choices<ShapeType> shape_types{{"plane", ShapeType::plane},
                                                     {"circle", ShapeType::circle},
                                                     {"cylinder", ShapeType::cylinder},
                                                     {"sphere", ShapeType::sphere},
                                                     {"cone", ShapeType::cone}};

/// Keys that a type needs; others than these and `type` it does not take.
std::vector<std::string> needed_keys(ShapeType type)
{
  switch (type)
  {
  case ShapeType::plane:
    return {"point", "normal"};
  case ShapeType::circle:
  case ShapeType::sphere:
    return {"point", "radius"};
  case ShapeType::cylinder:
    return {"point", "axis", "radius"};
  case ShapeType::cone:
    return {"point", "axis", "half-angle"};
  }
  return {};
}

/// Where a type can be used; nothing where it can be here.
std::string wanted_kinematics(ShapeType type, Kinematics kinematics)
{
  const bool solid = kinematics == Kinematics::three_dimensional, ring = kinematics == Kinematics::axisymmetric;
  switch (type)
  {
  case ShapeType::plane:
    return "";
  case ShapeType::circle:
    return solid || ring ? "plane-strain or plane-stress" : "";
  case ShapeType::cylinder:
    return solid ? "" : "3d";
  case ShapeType::sphere:
  case ShapeType::cone:
    return solid || ring ? "" : "3d or axisymmetric";
  }
  return "";
}

std::array<double, 3> to_vector(const Value &value, int dim)
{
  const std::string wanted = std::to_string(dim) + " numbers";
  require_list(value, wanted);
  if (value.items.size() != static_cast<std::size_t>(dim))
    value.fail("must be a list of " + wanted + ", not of " + std::to_string(value.items.size()));
  std::array<double, 3> vector{0, 0, 0};
  for (std::size_t c = 0; c < value.items.size(); ++c)
    vector[c] = to_number(value.items[c], any_number);
  return vector;
}

std::array<double, 3> to_direction(const Value &value, int dim)
{
  std::array<double, 3> direction = to_vector(value, dim);
  const double length = std::hypot(direction[0], direction[1], direction[2]);
  if (length == 0)
    value.fail("must be a direction, not zero");
  for (double &component : direction)
    component /= length;
  return direction;
}

/// A solid of revolution keeps to the axis, x = 0.
void check_axisymmetric(const Value &value, const Shape &shape)
{
  const bool turned = shape.type == ShapeType::plane || shape.type == ShapeType::cone;
  if (turned && shape.axis[0] != 0)
    value.find(shape.type == ShapeType::plane ? "normal" : "axis")
        ->fail("must lie along y, the axis of symmetry" +
               std::string(shape.type == ShapeType::plane ? "; an oblique plane would be a cone" : ""));
  if (shape.type != ShapeType::plane && shape.point[0] != 0)
    value.find("point")->fail("must lie on the axis of symmetry, x = 0");
}

void check_shape(const Value &value, Shape &shape, ReadContext &context)
{
  const Value &type = *value.find("type");
  if (const std::string wanted = wanted_kinematics(shape.type, context.kinematics); !wanted.empty())
    type.fail("a " + type.text + " goes with kinematics: " + wanted);
  const std::vector<std::string> needed = needed_keys(shape.type);
  for (const std::string &name : needed)
    if (!value.find(name))
      value.fail("the key '" + name + "' is missing; a " + type.text + " has the keys type, " + joined(needed));
  for (const Value &item : value.items)
    if (item.key != "type" && std::find(needed.begin(), needed.end(), item.key) == needed.end())
      item.fail("has no meaning for a " + type.text + ", which has the keys type, " + joined(needed));
  if (context.kinematics == Kinematics::axisymmetric)
    check_axisymmetric(value, shape);
}
} // namespace

Section<Shape> shape_keys()
{
  using Keys = Section<Shape>;
  const auto direction = [](const Value &value, Shape &shape, ReadContext &context)
  { shape.axis = to_direction(value, context.dim()); };
  Keys keys;
  keys.choice("type", &Shape::type, shape_types, required,
              "the solid is behind the plane (its normal points out of it) and inside the others; circle: in the "
              "plane; cylinder: 3d; sphere and cone: 3d or axisymmetric");
  keys.key(Keys::row("point", "list of 2 or 3 numbers", "length", "", required, "",
                     "a point of the plane, the centre, a point of the cylinder's axis, the cone's apex",
                     [](const Value &value, Shape &shape, ReadContext &context)
                     { shape.point = to_vector(value, context.dim()); }));
  keys.key(Keys::row("normal", "list of 2 or 3 numbers", "1", "not zero; any length", otherwise("required for a plane"),
                     "", "outward normal of a plane", direction));
  keys.key(Keys::row("axis", "list of 2 or 3 numbers", "1", "not zero; any length",
                     otherwise("required for a cylinder or cone"), "",
                     "axis of a cylinder; of a cone, from its apex into the solid", direction));
  keys.number("radius", &Shape::radius, positive, "length", otherwise("required for a circle, cylinder or sphere"),
              "of the circle, cylinder or sphere");
  keys.key(Keys::row("half-angle", "number", "degrees", Range{0, 90}.text(), otherwise("required for a cone"), "",
                     "angle between the cone's axis and its surface",
                     [](const Value &value, Shape &shape, ReadContext &) {
                       shape.half_angle = to_number(value, {0, 90}) * std::numbers::pi / 180;
                     }));
  keys.check(check_shape);
  return keys;
}
} // namespace amontons
