#pragma once
#include "bulk/mesh_files.h"

#include <functional>

namespace amontons::test
{
using Point = Eigen::Vector3d;
using Map = std::function<Point(const Point &)>;

/// A mesh of bodies cut into quadrilaterals or hexahedra, each with nodes of its own.
class Blocks
{
public:
  explicit Blocks(int dim)
    : dim_(dim)
  {
  }

  /// A rectangle or cuboid of n cells along each axis, moved by `map`. Groups: `name` (cells), and of its facets
  /// name_left, name_right (x), name_bottom, name_top (the last axis), in 3D name_front, name_back (y).
  void add(
      const std::string &name, const Point &low, const Point &size, std::array<int, 3> n,
      const Map &map = [](const Point &x) { return x; });

  /// A surface without a body behind: in the plane a polyline, its outer side on the right of its direction.
  void add_line(const std::string &name, const std::vector<Point> &points, int n_per_part = 1);

  /// In 3D, a parallelogram of n cells spanned by two sides; its outer side is where first x second points.
  void add_sheet(const std::string &name, const Point &corner, const Point &first, const Point &second,
                 std::array<int, 2> n);

  /// A group of facets that other groups hold: of each those that `take` says by their mean place.
  void add_union(
      const std::string &name, const std::vector<std::string> &groups,
      const std::function<bool(const Point &middle)> &take = [](const Point &) { return true; });

  /// Group of the one node nearest to a place.
  void add_point(const std::string &name, const Point &place);

  [[nodiscard]] const HandMesh &mesh() const { return mesh_; }

private:
  int add_node(const Point &x);
  int add_group(int dim, const std::string &name);

  int dim_;
  std::vector<Point> points_;
  HandMesh mesh_;
};
} // namespace amontons::test
