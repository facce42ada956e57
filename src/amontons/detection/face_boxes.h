#pragma once
#include "amontons/detection/box_tree.h"
#include "amontons/surface/surface.h"

#include <Eigen/Geometry>

#include <variant>

namespace amontons
{
/// The boxes of a surface's faces, searched for those that meet a given box: which target faces an impactor face may
/// see, where surfaces are held together face by face and not node by node.
class FaceBoxes
{
public:
  /// @param x coordinates, [n_nodes * dim]
  FaceBoxes(const Surface &surface, std::span<const double> x);

  /// Every face whose box meets `box`, and maybe some whose box misses it by round-off. In the plane z does not count.
  /// @param faces replaced; ascending
  void meeting(const Eigen::AlignedBox3d &box, std::vector<Index> &faces) const;

private:
  std::variant<BoxTree<2>, BoxTree<3>> tree_;
};
} // namespace amontons
