#include "amontons/surface/shape_projection.h"

#include "amontons/base/error.h"

#include <Eigen/Geometry>

#include <cmath>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

Vector3d in_space(int dim, std::span<const double> x)
{
  AMONTONS_ASSERT(static_cast<int>(x.size()) >= dim);
  return {x[0], x[1], dim == 3 ? x[2] : 0.0};
}

// Unit vector along v, or the fallback where v vanishes.
Vector3d direction_or(const Vector3d &v, const Vector3d &fallback)
{
  const double length = v.norm();
  return length > 0 ? Vector3d(v / length) : fallback;
}

// A direction across the axis, where none is distinguished: in the plane the one with x > 0.
Vector3d across(int dim, const Vector3d &axis)
{
  if (dim == 3)
    return axis.unitOrthogonal();
  const Vector3d right(axis.y(), -axis.x(), 0);
  return right.x() < 0 ? Vector3d(-right) : right;
}

ShapeProjection project_on_ball(const Vector3d &offset, const Vector3d &fallback, double radius, const Vector3d &x)
{
  ShapeProjection result;
  result.normal = direction_or(offset, fallback);
  result.gap = offset.norm() - radius;
  result.point = x - result.gap * result.normal;
  return result;
}

// In the half-plane (rho, h) of distance to the axis and height from the tip into the solid, the surface is the ray
// along (sin, cos) of the half-angle.
ShapeProjection project_on_cone(int dim, const Shape &shape, const Vector3d &axis, const Vector3d &tip,
                                const Vector3d &x)
{
  const Vector3d offset = x - tip;
  const double h = offset.dot(axis);
  const Vector3d across_axis = offset - h * axis;
  const double rho = across_axis.norm();
  const Vector3d outward = direction_or(across_axis, across(dim, axis));
  const double sine = std::sin(shape.half_angle), cosine = std::cos(shape.half_angle);
  const double along = rho * sine + h * cosine;
  ShapeProjection result;
  if (along > 0)
  {
    result.normal = cosine * outward - sine * axis;
    result.gap = rho * cosine - h * sine;
    result.point = tip + along * (sine * outward + cosine * axis);
    return result;
  }
  result.kind = PairKind::vertex;
  result.point = tip;
  result.gap = offset.norm();
  result.normal = direction_or(offset, -axis);
  return result;
}
} // namespace

ShapeProjection project_on_shape(int dim, bool axisymmetric, const Shape &shape, std::span<const double> shape_point,
                                 std::span<const double> x)
{
  const Vector3d point = in_space(dim, shape_point), node = in_space(dim, x), offset = node - point;
  Vector3d axis(shape.axis[0], shape.axis[1], dim == 3 ? shape.axis[2] : 0.0);
  axis = direction_or(axis, Vector3d::UnitY());
  AMONTONS_ASSERT(!axisymmetric || dim == 2);
  switch (shape.type)
  {
  case ShapeType::plane:
  {
    const double gap = offset.dot(axis);
    return {node - gap * axis, axis, gap, PairKind::face};
  }
  case ShapeType::circle:
  case ShapeType::sphere:
    return project_on_ball(offset, axis, shape.radius, node);
  case ShapeType::cylinder:
    return project_on_ball(offset - offset.dot(axis) * axis, across(dim, axis), shape.radius, node);
  case ShapeType::cone:
    return project_on_cone(dim, shape, axis, point, node);
  }
  fail_assertion("a known shape", __FILE__, __LINE__);
}
} // namespace amontons
