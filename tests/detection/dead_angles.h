#pragma once
#include "surface/surfaces.h"

namespace amontons::test
{
/// A ridge at the origin, the body below: face 0 from (1, -1) up to it, face 1 down to (-1, -1).
inline Surface roof()
{
  return chain({{1, -1}, {0, 0}, {-1, -1}});
}

/// The valley's bottom is the origin, the body below.
inline Surface valley()
{
  return chain({{1, 1}, {0, 0}, {-1, 1}});
}

/// One straight line, the body below, from x = 2 to x = 0.
inline Surface line()
{
  return chain({{2, 0}, {1, 0}, {0, 0}});
}

/// Two by two faces on [-1, 1]^2, the body below, bent along x = 0 (down by `slope` on either side) and, with `both`,
/// along y = 0 too.
inline Surface bent(double slope, bool both, bool triangles)
{
  return sheet(2, 2, triangles,
               [=](double s, double t)
               {
                 const double x = 2 * s - 1, y = 2 * t - 1;
                 return Point{x, y, -slope * (std::abs(x) + (both ? std::abs(y) : 0))};
               });
}

/// The corner of the cube [-1, 0]^3 at the origin: three faces, the first one's normal along z, then x, then y; or
/// twice as many triangles.
inline Surface cube_corner(bool triangles)
{
  Surface corner;
  corner.dim = 3;
  corner.reference = {0, 0, 0, -1, 0, 0, 0, -1, 0, 0, 0, -1, -1, -1, 0, 0, -1, -1, -1, 0, -1};
  corner.node_ids = {0, 1, 2, 3, 4, 5, 6};
  corner.face_nodes = {0, 1, 4, 2, 0, 2, 5, 3, 0, 3, 6, 1};
  corner.face_offsets = {0, 4, 8, 12};
  if (triangles)
  {
    corner.face_nodes = {0, 1, 4, 0, 4, 2, 0, 2, 5, 0, 5, 3, 0, 3, 6, 0, 6, 1};
    corner.face_offsets = {0, 3, 6, 9, 12, 15, 18};
  }
  for (std::size_t f = 0; f + 1 < corner.face_offsets.size(); ++f)
    corner.face_ids.push_back(static_cast<GlobalIndex>(f));
  corner.build_adjacency();
  return corner;
}
} // namespace amontons::test
