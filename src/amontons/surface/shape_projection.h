#pragma once
#include "amontons/surface/pairing.h"
#include "amontons/surface/shape.h"

#include <Eigen/Core>

#include <span>

namespace amontons
{
/// Closest point of an analytic shape's surface.
struct ShapeProjection
{
  Eigen::Vector3d point{0, 0, 0};
  Eigen::Vector3d normal{0, 0, 0}; ///< outward, unit: the gradient of the gap where that exists
  double gap = 0;                  ///< signed distance, (x - point) . normal, negative inside the solid
  PairKind kind = PairKind::face;  ///< vertex outside the tip of a cone
};

/// @param shape_point where Shape::point is now, [dim]
/// @param x the point to project, [dim]; axisymmetric: (r, y), the shape's axis being the axis of symmetry
/// Where the gradient of the distance is not unique (centre of a circle or sphere, axis of a cylinder or within a cone)
/// one of the closest points is returned, always the same: for a cone in axisymmetry the one at r > 0. At the tip of a
/// cone the normal is -axis.
ShapeProjection project_on_shape(int dim, bool axisymmetric, const Shape &shape, std::span<const double> shape_point,
                                 std::span<const double> x);
} // namespace amontons
