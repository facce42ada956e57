#pragma once
#include "amontons/surface/flat_overlap.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace amontons
{
/// Integrals over the part of an impactor face that sees a target face, and their derivatives: the segmentation of
/// contact surfaces. None where the faces do not face each other, or do not overlap.
///
/// Variables of the derivatives, of the impactor first:
/// in space 0 to 7 the nodes' coordinates in the plane of projection, two a node, 8 and 9 the plane's tilt (how its
/// normal turns, along its two base vectors); in the plane 0 to 3 the nodes' coordinates, 4 to 7 the normals at the two
/// ends. Then, 10 to 17, the target's nodes, two coordinates each, in space those in the plane of projection. Turns and
/// shifts within the plane of projection change no integral.
struct OverlapIntegrals
{
  static constexpr int n_own = 10, n_variables = 18;
  /// Row 4 i + k for the integral (i, k); zero beyond the faces' nodes.
  using Gradient = Eigen::Matrix<double, 16, n_variables, Eigen::RowMajor>;

  double size = 0;                                            ///< length or area of that part, not of the ring; 0: none
  double ring_size = 0;                                       ///< in axisymmetry of the ring, else as `size`
  double least_gap = std::numeric_limits<double>::infinity(); ///< least distance at the points of integration
  Eigen::Matrix4d mass;                   ///< of N_i N_k, both the impactor's; zero beyond its nodes
  Eigen::Matrix4d mixed;                  ///< of N_i N_k, N_k the target's
  Gradient mass_gradient, mixed_gradient; ///< set where asked for

  /// No overlap.
  void reset(bool with_gradient)
  {
    size = ring_size = 0;
    least_gap = std::numeric_limits<double>::infinity();
    mass.setZero();
    mixed.setZero();
    if (with_gradient)
    {
      mass_gradient.setZero();
      mixed_gradient.setZero();
    }
  }
};

/// Whether a face faces the impactor's normal, within 89 degrees: by then what is seen of it is hardly anything, and it
/// goes out of sight without a jump.
inline bool faces_each_other(const Eigen::Vector3d &impactor_normal, const FaceCoordinates &target)
{
  static const double least = std::cos(89 * std::numbers::pi / 180);
  return face_normal(target, face_centre(target)).dot(impactor_normal) <= -least;
}

/// In the plane: over the part of the impactor's segment between the projections of the target's ends on it, along the
/// impactor's normal interpolated between those at its ends (Yang, Laursen, Meng 2005; Popp, Gee, Wall 2009); the
/// projections are exact roots. The rule is exact for polynomials of degree 7.
/// @param normals outward ones at the impactor's ends, unit length @param axisymmetric integrals over the ring, 2 pi r
void integrate_overlap(const FaceCoordinates &impactor, const std::array<Eigen::Vector3d, 2> &normals,
                       const FaceCoordinates &target, bool axisymmetric, bool with_gradient, OverlapIntegrals &out);

/// In space: over the plane polygon that both faces share, projected on the plane through the impactor's centre normal
/// to it there, cut into triangles (Puso, Laursen 2004); none where the target seen along the normal is not convex.
/// Areas are those of the plane. The rule is exact for plane triangles and parallelograms, and good to about 1e-10 on
/// other quadrilaterals, whose shape functions are no polynomials there. The derivatives are those of the rule of
/// integration, whose points ride on the corners of the triangles that the overlap is cut into. @throws
/// NumericalFailure if the impactor face is not convex
void integrate_overlap(const ProjectionPlane &plane, const FaceCoordinates &target, bool with_gradient,
                       OverlapIntegrals &out);
} // namespace amontons
