#include "amontons/surface/projection.h"

#include "amontons/surface/closest_point_lanes.h"
#include "amontons/surface/quadrilateral.h"

#include <Eigen/Dense>

#include <algorithm>

namespace amontons
{
std::array<double, 4> shape_functions(int n_nodes, LocalPoint xi)
{
  const auto [s, t] = xi;
  if (n_nodes == 2)
    return {1 - s, s, 0, 0};
  if (n_nodes == 3)
    return {1 - s - t, s, t, 0};
  return {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
}

std::array<std::array<double, 4>, 2> shape_gradients(int n_nodes, LocalPoint xi)
{
  const auto [s, t] = xi;
  if (n_nodes == 2)
    return {{{-1, 1, 0, 0}, {0, 0, 0, 0}}};
  if (n_nodes == 3)
    return {{{-1, 1, 0, 0}, {-1, 0, 1, 0}}};
  return {{{t - 1, 1 - t, t, -t}, {s - 1, -s, s, 1 - s}}};
}

namespace
{
// Parameter of the closest point of the line through a and b.
double on_line(const Eigen::Vector3d &a, const Eigen::Vector3d &b, const Eigen::Vector3d &x)
{
  const Eigen::Vector3d direction = b - a;
  const double length2 = direction.squaredNorm();
  return length2 > 0 ? (x - a).dot(direction) / length2 : 0.0;
}

LocalPoint on_triangle_plane(const FaceCoordinates &face, const Eigen::Vector3d &x)
{
  const Eigen::Vector3d a = face.x[1] - face.x[0], b = face.x[2] - face.x[0], e = x - face.x[0];
  const double aa = a.dot(a), ab = a.dot(b), bb = b.dot(b), ea = e.dot(a), eb = e.dot(b);
  const double det = aa * bb - ab * ab;
  if (!(det > 0))
    return {-1, -1};
  return {(bb * ea - ab * eb) / det, (aa * eb - ab * ea) / det};
}

// The nodes relative to x, as the batched projections take them.
template<int dim>
std::array<baseline::Vec<double, dim>, 4> relative_nodes(const FaceCoordinates &face, const Eigen::Vector3d &x)
{
  std::array<baseline::Vec<double, dim>, 4> result{};
  for (int k = 0; k < face.n_nodes; ++k)
    for (int c = 0; c < dim; ++c)
      result[k].c[c] = face.x[k][c] - x[c];
  return result;
}

ClosestPoint closest_point_on_quadrilateral(const FaceCoordinates &face, const Eigen::Vector3d &x)
{
  bool certain = false;
  const auto nodes = relative_nodes<3>(face, x);
  const auto [s, t, squared_distance] = baseline::closest_on_quadrilateral<double>(nodes.data(), certain);
  if (certain)
    return {{s, t}, face_point(face, {s, t}), squared_distance};
  FaceCoordinates relative = face;
  for (Eigen::Vector3d &node : relative.x)
    node -= x;
  ClosestPoint result = closest_point_by_quintic(relative, Eigen::Vector3d::Zero());
  result.point = face_point(face, result.xi);
  return result;
}

FaceProjection projection_at(const FaceCoordinates &face, LocalPoint xi, const Eigen::Vector3d &x)
{
  FaceProjection result{xi, face_point(face, xi), face_normal(face, xi), 0};
  result.gap = (x - result.point).dot(result.normal);
  return result;
}

// The face continued by its tangent plane at xi.
FaceProjection project_on_tangent_plane(const FaceCoordinates &face, LocalPoint xi, const Eigen::Vector3d &x)
{
  FaceProjection result = projection_at(face, xi, x);
  const auto [a, b] = face_tangents(face, xi);
  const Eigen::Vector3d e = x - result.point;
  const double aa = a.dot(a), ab = a.dot(b), bb = b.dot(b), det = aa * bb - ab * ab;
  if (det > 0)
  {
    result.xi[0] += (bb * e.dot(a) - ab * e.dot(b)) / det;
    result.xi[1] += (aa * e.dot(b) - ab * e.dot(a)) / det;
  }
  result.point = x - result.gap * result.normal;
  return result;
}
} // namespace

ClosestPoint closest_point(const FaceCoordinates &face, const Eigen::Vector3d &x)
{
  if (face.n_nodes == 4)
    return closest_point_on_quadrilateral(face, x);
  const auto nodes = relative_nodes<3>(face, x);
  const auto [s, t, squared_distance] = face.n_nodes == 2 ? baseline::closest_on_segment<double, 3>(nodes.data())
                                                          : baseline::closest_on_triangle<double>(nodes.data());
  return {{s, t}, face_point(face, {s, t}), squared_distance};
}

FaceProjection project_on_face(const FaceCoordinates &face, const Eigen::Vector3d &x, LocalPoint start)
{
  if (face.n_nodes == 2)
    return projection_at(face, {on_line(face.x[0], face.x[1], x), 0}, x);
  if (face.n_nodes == 3)
    return projection_at(face, on_triangle_plane(face, x), x);
  if (newton_on_quadrilateral(face, x, start))
    return projection_at(face, start, x);
  return project_on_tangent_plane(face, closest_point(face, x).xi, x);
}

FaceProjection project_on_face(const FaceCoordinates &face, const Eigen::Vector3d &x)
{
  return project_on_face(face, x, face.n_nodes == 4 ? closest_point(face, x).xi : LocalPoint{0, 0});
}

bool in_face(int n_nodes, LocalPoint xi, double tolerance)
{
  const auto [s, t] = xi;
  if (n_nodes == 2)
    return s >= -tolerance && s <= 1 + tolerance;
  if (n_nodes == 3)
    return s >= -tolerance && t >= -tolerance && s + t <= 1 + tolerance;
  return s >= -tolerance && t >= -tolerance && s <= 1 + tolerance && t <= 1 + tolerance;
}
} // namespace amontons
