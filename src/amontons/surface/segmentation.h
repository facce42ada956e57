#pragma once
#include "amontons/surface/projection.h"

#include <vector>

namespace amontons
{
/// A point of the impactor face and the point of the target face that it sees.
struct OverlapPoint
{
  LocalPoint impactor{0, 0}, target{0, 0};
  double weight = 0; ///< of integration over the impactor face: length in the plane, area in 3D
  double gap = 0;    ///< from the target to the impactor along minus the impactor's normal; > 0 open
};

/// The part of an impactor face that sees a target face, with Gauss points to integrate over it.
struct FaceOverlap
{
  double size = 0; ///< length or area of that part
  std::vector<OverlapPoint> points;
};

/// Whether a face faces the impactor's normal, within 80 degrees.
bool faces_each_other(const Eigen::Vector3d &impactor_normal, const FaceCoordinates &target);

/// In the plane: the part of the impactor's segment between the projections of the target's ends on it, along the
/// impactor's normal interpolated between those at its ends (Yang, Laursen, Meng 2005; Popp, Gee, Wall 2009); the
/// projections are exact roots. The rule is exact for polynomials of degree 7.
/// @param normals outward ones at the impactor's ends, unit length
/// Empty where the faces do not face each other, within 80 degrees, or do not overlap.
FaceOverlap overlap_of_segments(const FaceCoordinates &impactor, const std::array<Eigen::Vector3d, 2> &normals,
                                const FaceCoordinates &target);

/// In 3D: both faces are projected on the plane through the impactor's centre normal to it there, the common polygon is
/// found by clipping one with the other (Sutherland, Hodgman 1974) and cut into triangles (Puso, Laursen 2004). Areas
/// are those of the plane. The rule is exact for the products of two shape functions of plane triangles and
/// parallelograms, and good to about 1e-10 on other quadrilaterals, whose shape functions are no polynomials. A
/// target's edge within 1e-10 of the impactor's size of one of its edges counts as on it. Empty where the faces do not
/// face each other, within 80 degrees, do not overlap, or where the target seen along the normal is not convex.
/// @throws NumericalFailure if the impactor face is not convex
FaceOverlap overlap_of_faces(const FaceCoordinates &impactor, const FaceCoordinates &target);
} // namespace amontons
