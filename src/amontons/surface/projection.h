#pragma once
#include "amontons/base/ids.h"

#include <Eigen/Core>

#include <array>
#include <span>

namespace amontons
{
/// Local coordinates on a face, as Surface defines them; on a segment only the first counts.
using LocalPoint = std::array<double, 2>;

/// Positions of the nodes of one face, in space; in the plane z = 0.
struct FaceCoordinates
{
  int n_nodes = 0; ///< 2 segment, 3 triangle, 4 bilinear quadrilateral
  std::array<Eigen::Vector3d, 4> x;
};

/// @param coordinates of all nodes of the surface, [n_nodes * dim]
FaceCoordinates gather_face(int dim, std::span<const Index> nodes, std::span<const double> coordinates);

/// N_i(xi); entries beyond the face's nodes are zero.
std::array<double, 4> shape_functions(int n_nodes, LocalPoint xi);
/// [a][i] = dN_i / dxi_a.
std::array<std::array<double, 4>, 2> shape_gradients(int n_nodes, LocalPoint xi);

Eigen::Vector3d face_point(const FaceCoordinates &face, LocalPoint xi);
/// dx/dxi_a; the second is e_z on a segment, so that (second) x (first) or the cross product below gives the normal.
std::array<Eigen::Vector3d, 2> face_tangents(const FaceCoordinates &face, LocalPoint xi);
/// Outward unit normal: a segment's on the right hand of its direction, a 3D face's by its counter-clockwise nodes.
/// Zero on a face of no area.
Eigen::Vector3d face_normal(const FaceCoordinates &face, LocalPoint xi);

/// Closest point of a face, the face's border included.
struct ClosestPoint
{
  LocalPoint xi{0, 0}; ///< in the face; exactly on its border where the border is closest
  Eigen::Vector3d point{0, 0, 0};
  double squared_distance = 0;
};

/// The closest point of the (closed) face, right for any face and any x: on a quadrilateral Newton's method serves
/// where the squared distance is proven convex over the face, else the stationary points are all found as the roots of
/// a polynomial of degree 5 (quadrilateral.h).
ClosestPoint closest_point(const FaceCoordinates &face, const Eigen::Vector3d &x);

/// Projection on the face extended beyond its border.
struct FaceProjection
{
  LocalPoint xi{0, 0}; ///< may lie outside the face
  Eigen::Vector3d point{0, 0, 0};
  Eigen::Vector3d normal{0, 0, 0}; ///< outward, unit
  double gap = 0;                  ///< (x - point) . normal
};

/// Orthogonal projection on the extended face: x - point is along the normal. On a quadrilateral it is the local
/// minimum of the distance that Newton's method reaches from `start`; where that leaves the neighbourhood of the face
/// ([-1, 2]^2) or does not converge, the face is extended by its tangent plane at the closest point of its own.
FaceProjection project_on_face(const FaceCoordinates &face, const Eigen::Vector3d &x, LocalPoint start);
/// The same from the closest point of the face.
FaceProjection project_on_face(const FaceCoordinates &face, const Eigen::Vector3d &x);

/// Where in a face a local point lies.
enum class FaceFeature : unsigned char
{
  interior,
  edge,  ///< 3D only
  vertex ///< ends of segments too
};
struct FeatureOfFace
{
  FaceFeature type = FaceFeature::interior;
  int index = 0; ///< vertex k, or the edge from vertex k to the next
};
/// @param xi in the face; less than `tolerance` (in xi) from an edge counts as on it
FeatureOfFace feature_at(int n_nodes, LocalPoint xi, double tolerance);
/// Whether xi lies in the face grown by `tolerance` (in xi).
bool in_face(int n_nodes, LocalPoint xi, double tolerance);
} // namespace amontons
