#include "amontons/surface/segmentation.h"

#include "amontons/surface/flat_overlap.h"
#include "amontons/surface/segment_overlap.h"

#include <cmath>
#include <numbers>

namespace amontons
{
namespace
{
using Eigen::Vector2d;
using Eigen::Vector3d;

Segment<double> segment(const Vector3d &start, const Vector3d &end)
{
  return {start.head<2>(), end.head<2>()};
}
} // namespace

bool faces_each_other(const Vector3d &impactor_normal, const FaceCoordinates &target)
{
  static const double least = std::cos(80 * std::numbers::pi / 180);
  return face_normal(target, face_centre(target)).dot(impactor_normal) <= -least;
}

FaceOverlap overlap_of_segments(const FaceCoordinates &impactor, const std::array<Vector3d, 2> &normals,
                                const FaceCoordinates &target)
{
  FaceOverlap out;
  if (!faces_each_other(face_normal(impactor, {0, 0}), target))
    return out;
  out.size = visit_overlap<double>(segment(impactor.x[0], impactor.x[1]), segment(normals[0], normals[1]),
                                   segment(target.x[0], target.x[1]),
                                   [&](const SegmentPoint<double> &point) {
                                     out.points.push_back({{point.xi, 0}, {point.eta, 0}, point.weight, point.gap});
                                   });
  return out;
}

FaceOverlap overlap_of_faces(const FaceCoordinates &impactor, const FaceCoordinates &target)
{
  FaceOverlap out;
  const ProjectionPlane plane(impactor);
  if (!faces_each_other(plane.normal(), target))
    return out;
  const FlatFace other = plane.flat(target);
  const FlatPolygon common = shared_part(plane.own(), other);
  out.size = common.area();
  const int n = n_along_side(plane.own(), other, false);
  for (int i = 2; i < common.n; ++i)
  {
    const FlatTriangle triangle = common.triangle(i);
    for (const TrianglePoint &point : triangle_rule(n))
    {
      const Vector2d x = triangle.at(point.share);
      const FlatShape mine = plane.own().shape(x, false), others = other.shape(x, false);
      out.points.push_back({mine.xi, others.xi, point.weight * triangle.twice_area,
                            other.height_at(others) - plane.own().height_at(mine)});
    }
  }
  return out;
}
} // namespace amontons
