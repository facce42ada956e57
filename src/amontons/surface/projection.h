#pragma once
#include "amontons/base/ids.h"

#include <Eigen/Geometry>

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
inline FaceCoordinates gather_face(int dim, std::span<const Index> nodes, std::span<const double> coordinates)
{
  FaceCoordinates face;
  face.n_nodes = static_cast<int>(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const double *x = coordinates.data() + static_cast<std::ptrdiff_t>(nodes[i]) * dim;
    face.x[i] = Eigen::Vector3d(x[0], x[1], dim == 3 ? x[2] : 0.0);
  }
  return face;
}

/// N_i(xi); entries beyond the face's nodes are zero.
std::array<double, 4> shape_functions(int n_nodes, LocalPoint xi);
/// [a][i] = dN_i / dxi_a.
std::array<std::array<double, 4>, 2> shape_gradients(int n_nodes, LocalPoint xi);

inline Eigen::Vector3d face_point(const FaceCoordinates &face, LocalPoint xi)
{
  const auto [s, t] = xi;
  const auto &x = face.x;
  if (face.n_nodes == 2)
    return x[0] + s * (x[1] - x[0]);
  if (face.n_nodes == 3)
    return x[0] + s * (x[1] - x[0]) + t * (x[2] - x[0]);
  return (1 - t) * ((1 - s) * x[0] + s * x[1]) + t * (s * x[2] + (1 - s) * x[3]);
}

/// dx/dxi_a; the second is e_z on a segment, so that (second) x (first) or the cross product below gives the normal.
inline std::array<Eigen::Vector3d, 2> face_tangents(const FaceCoordinates &face, LocalPoint xi)
{
  const auto [s, t] = xi;
  const auto &x = face.x;
  if (face.n_nodes == 2)
    return {x[1] - x[0], Eigen::Vector3d::UnitZ()};
  if (face.n_nodes == 3)
    return {x[1] - x[0], x[2] - x[0]};
  return {(1 - t) * (x[1] - x[0]) + t * (x[2] - x[3]), (1 - s) * (x[3] - x[0]) + s * (x[2] - x[1])};
}

/// The middle of the local coordinates.
inline LocalPoint face_centre(const FaceCoordinates &face)
{
  return face.n_nodes == 3 ? LocalPoint{1.0 / 3, 1.0 / 3} : LocalPoint{0.5, 0.5};
}

/// Outward unit normal: a segment's on the right hand of its direction, a 3D face's by its counter-clockwise nodes.
/// Zero on a face of no area.
inline Eigen::Vector3d face_normal(const FaceCoordinates &face, LocalPoint xi)
{
  const auto tangents = face_tangents(face, xi);
  return tangents[0].cross(tangents[1]).normalized();
}

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
inline FeatureOfFace feature_at(int n_nodes, LocalPoint xi, double tolerance)
{
  const auto [s, t] = xi;
  if (n_nodes == 2)
  {
    if (s <= tolerance || s >= 1 - tolerance)
      return {FaceFeature::vertex, s <= tolerance ? 0 : 1};
    return {};
  }
  // On which edges, in the order of the vertices they start from.
  std::array<bool, 4> on{};
  if (n_nodes == 3)
    on = {t <= tolerance, s + t >= 1 - tolerance, s <= tolerance, false};
  else
    on = {t <= tolerance, s >= 1 - tolerance, t >= 1 - tolerance, s <= tolerance};
  for (int k = 0; k < n_nodes; ++k)
    if (on[k] && on[(k + n_nodes - 1) % n_nodes])
      return {FaceFeature::vertex, k};
  for (int k = 0; k < n_nodes; ++k)
    if (on[k])
      return {FaceFeature::edge, k};
  return {};
}

/// Whether xi lies in the face grown by `tolerance` (in xi).
bool in_face(int n_nodes, LocalPoint xi, double tolerance);
} // namespace amontons
