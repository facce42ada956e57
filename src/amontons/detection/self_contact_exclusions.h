#pragma once
#include "amontons/surface/surface.h"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace amontons
{
/// Unit normals of a surface: of its faces at their middles, and of its nodes the mean of their faces', zero without.
struct SurfaceNormals
{
  std::vector<Eigen::Vector3f> node, face;
};
/// @param x coordinates, [n_nodes * dim]
SurfaceNormals surface_normals(const Surface &surface, std::span<const double> x);

/// Which faces of its own surface a node does not see, where one surface is impactor and target at once:
///
/// - **near**: its own faces, and those with a node within the *self-distance* of it along the surface, in the
///   reference. Along the surface means along the edges of faces (and the diagonals of quadrilaterals), so it is never
///   less than the geodesic distance, and on usual meshes at most 1.15 (triangles) or 1.08 (quadrilaterals) times it.
///   Found once, about 100 bytes per node in space for the default distance.
/// - **turned away** now: the normals of node and face make an angle of less than 100 degrees. Two surfaces that touch
///   face each other; the tip of a wedge of 30 degrees still faces what lies flat on its flank.
/// - **the far side of its own wall**: the node lies behind the face, in the reference as now, and about as deep. Where
///   it has come through another part of the body it was in front, or much farther off.
///
/// Surfaces that already pass through each other in the reference cannot be told from a wall and see nothing, if they
/// bound one body (Surface::face_bodies); of two bodies they are seen.
class Exclusions
{
public:
  /// Self-distance where none is given, in units of the longest edge of the node's own faces.
  static constexpr double default_edges = 2;

  /// @param self_distance length in the reference, >= 0; absent: `default_edges` of the local edges
  /// @throws UserError if it is negative or not finite
  Exclusions(const Surface &surface, std::optional<double> self_distance);

  /// @param x current coordinates, [n_nodes * dim]; they must outlive their use
  void move_to(std::span<const double> x);

  /// Whether the node must not see the face, where they are now.
  [[nodiscard]] bool excluded(Index node, Index face) const
  {
    return is_turned_away(node, face) || is_near(node, face) || is_own_wall(node, face);
  }

  [[nodiscard]] bool is_turned_away(Index node, Index face) const
  {
    return now_.node[node].dot(now_.face[face]) > turned_away;
  }
  /// Whether the face is within the self-distance of the node.
  [[nodiscard]] bool is_near(Index node, Index face) const;
  /// Distance to the nearest face within the self-distance that the node faces, as in a crease; infinity without one.
  [[nodiscard]] double distance_in_crease(Index node) const;
  /// Whether the face is the far side of the node's own wall: not turned away, and no neighbour.
  [[nodiscard]] bool is_far_side(Index node, Index face) const
  {
    return !is_turned_away(node, face) && is_own_wall(node, face) && !is_near(node, face);
  }
  /// Faces within the self-distance of the node, by increasing index.
  [[nodiscard]] std::span<const Index> near(Index node) const
  {
    return {near_faces_.data() + near_offsets_[node], near_offsets_[node + 1] - near_offsets_[node]};
  }
  /// Node-face pairs within the self-distance.
  [[nodiscard]] std::size_t n_near() const { return near_faces_.size(); }
  [[nodiscard]] double self_distance(Index node) const { return self_distance_.value_or(default_edges * size_[node]); }
  /// Normals of the nodes now, the mean of their faces'; zero without faces.
  [[nodiscard]] std::span<const Eigen::Vector3f> node_normals() const { return now_.node; }

private:
  [[nodiscard]] bool is_own_wall(Index node, Index face) const;
  [[nodiscard]] double edge_length(Index a, Index b) const;
  void find_near();

  // Cosine of the angle between normals of surfaces that do not face each other; of 100 degrees.
  static constexpr float turned_away = -0.1736F;

  const Surface &surface_;
  std::optional<double> self_distance_;
  std::span<const double> x_;
  std::vector<double> size_; ///< longest edge of each node's own faces, reference
  SurfaceNormals reference_, now_;
  std::vector<std::size_t> near_offsets_; ///< [n_nodes + 1]
  std::vector<Index> near_faces_;
};

/// What one node sees of a surface; without exclusions, all.
struct Sight
{
  const Exclusions *exclusions = nullptr;
  Index node = -1;
  [[nodiscard]] bool sees(Index face) const { return !exclusions || !exclusions->excluded(node, face); }
};
} // namespace amontons
