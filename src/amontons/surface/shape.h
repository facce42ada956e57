#pragma once
#include <array>
#include <string>

namespace amontons
{
enum class ShapeType
{
  plane,
  circle,   ///< dim 2: a disc; the rigid solid is inside
  cylinder, ///< dim 3: infinite, about `axis`
  sphere,   ///< dim 3, or axisymmetric with its centre on the axis
  cone      ///< dim 3 about `axis`, or axisymmetric about y; `axis` points from the apex into the solid
};

/// A rigid solid bounded by an analytic surface, at its reference place.
struct Shape
{
  ShapeType type = ShapeType::plane;
  std::array<double, 3> point{0, 0, 0}; ///< a point of the plane, a centre, a point of the axis, or the apex
  std::array<double, 3> axis{0, 1, 0};  ///< outward normal of the plane; axis of the cylinder or cone; unit length
  double radius = 0;                    ///< circle, cylinder, sphere
  double half_angle = 0;                ///< cone: angle between axis and surface, radians, in (0, pi/2)
};
} // namespace amontons
