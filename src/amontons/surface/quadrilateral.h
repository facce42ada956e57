#pragma once
#include "amontons/surface/projection.h"

namespace amontons
{
/// closest_point() of a bilinear quadrilateral by a polynomial alone, with no iteration that could go astray: for fixed
/// xi1 the face is a straight line in xi2, so xi2 can be eliminated from the two equations of a stationary distance,
/// which leaves a quintic in xi1; its roots in [0, 1] are isolated by the signs of its derivatives. Several times
/// slower.
ClosestPoint closest_point_by_quintic(const FaceCoordinates &face, const Eigen::Vector3d &x);

/// Newton's method for a stationary distance on the extended quadrilateral.
/// @param xi start, and where it ended @return whether it converged, to a local minimum within [-1, 2]^2
bool newton_on_quadrilateral(const FaceCoordinates &face, const Eigen::Vector3d &x, LocalPoint &xi);
} // namespace amontons
