#pragma once
#include "amontons/surface/overlap_integrals.h"
#include "amontons/surface/quadrature.h"
#include "amontons/surface/segment_overlap.h"

#include <vector>

/// The points by which the library integrates over an overlap, to be looked at one by one.
namespace amontons::test
{
/// A point of the impactor face and the point of the target face that it sees.
struct OverlapPoint
{
  LocalPoint impactor{0, 0}, target{0, 0};
  double weight = 0; ///< of integration over the impactor face: length in the plane, area in 3D
  double gap = 0;    ///< from the target to the impactor along minus the impactor's normal; > 0 open
};

struct FaceOverlap
{
  double size = 0; ///< length or area of the overlap
  std::vector<OverlapPoint> points;
};

inline FaceOverlap overlap_of_segments(const FaceCoordinates &impactor, const std::array<Eigen::Vector3d, 2> &normals,
                                       const FaceCoordinates &target)
{
  FaceOverlap out;
  const auto segment = [](const Eigen::Vector3d &start, const Eigen::Vector3d &end) {
    return Segment<double>{start.head<2>(), end.head<2>()};
  };
  out.size = visit_overlap<double>(segment(impactor.x[0], impactor.x[1]), segment(normals[0], normals[1]),
                                   segment(target.x[0], target.x[1]),
                                   [&](const SegmentPoint<double> &point) {
                                     out.points.push_back({{point.xi, 0}, {point.eta, 0}, point.weight, point.gap});
                                   });
  return out;
}

inline FaceOverlap overlap_of_faces(const FaceCoordinates &impactor, const FaceCoordinates &target)
{
  FaceOverlap out;
  const ProjectionPlane plane(impactor);
  if (!faces_each_other(plane.normal(), target))
    return out;
  const FlatFace other = plane.flat(target);
  const FlatPolygon part = shared_part(plane.own(), other);
  out.size = part.area();
  for (int i = 2; i < part.n; ++i)
    for (const TrianglePoint &point : triangle_rule(n_along_side(plane.own(), other, false)))
    {
      const FlatTriangle triangle = part.triangle(i);
      const Eigen::Vector2d x = triangle.at(point.share);
      const FlatShape mine = plane.own().shape(x, false), others = other.shape(x, false);
      out.points.push_back({mine.xi, others.xi, point.weight * triangle.twice_area,
                            other.height_at(others) - plane.own().height_at(mine)});
    }
  return out;
}
} // namespace amontons::test
