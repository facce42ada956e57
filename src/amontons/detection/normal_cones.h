#pragma once
#include "amontons/detection/target.h"

#include <optional>
#include <vector>

namespace amontons
{
/// Tells which parts of the target can hold a local minimum of the distance from a point, so that a search for minima
/// other than the closest need not look at every face in reach (Johnson, Cohen 2001: spatialised normal cone
/// hierarchies). Groups of sixteen successive faces in a given order, sixteen groups, and so on, as in BoxTree; each
/// with a sphere that holds it and a cone that holds the normals of its faces and of those attached to them.
class NormalCones
{
public:
  /// @param order the faces, slot by slot
  void build(const Target &target, const std::vector<Index> &order);

  /// Whether a point of the group may be a local minimum of the distance from x: not if the directions to x from all of
  /// its sphere lie outside the cone and its opposite. Where the target ends the direction may leave the cone as far
  /// as the extension past the end allows.
  /// @param level -1 for one face, 0 for sixteen, ...
  /// @param extension length; absent: default_extension
  /// @param ends_anywhere whether the target may end, for this node, at any edge (self-contact)
  [[nodiscard]] bool may_hold_minimum(int level, std::size_t index, const Eigen::Vector3d &x,
                                      std::optional<double> extension, bool ends_anywhere = false) const;

private:
  struct Cone
  {
    Eigen::Vector3f centre{0, 0, 0};
    float radius = 0;
    Eigen::Vector3f axis{0, 0, 0};
    float half_angle = 0;
    float face_radius = 0;  ///< of the largest face
    bool is_at_end = false; ///< the target ends at one of its nodes
  };
  static Cone around(std::span<const Cone> parts);
  static std::vector<Cone> cones_of_faces(const Target &target);
  std::vector<Cone> cones_of_nodes(const Target &target) const;
  void find_ends(const Target &target);

  std::vector<char> is_end_; ///< of the target, per node; found once

  Eigen::Vector3d origin_{0, 0, 0};
  std::vector<std::vector<Cone>> levels_; ///< faces, groups of 16, of 256, ...
};
} // namespace amontons
