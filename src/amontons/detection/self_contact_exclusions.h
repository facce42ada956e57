#pragma once
#include "amontons/surface/surface.h"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace amontons
{
/// Which faces of its own surface a node does not see, where one surface is impactor and target at once:
///
/// - **near**: its own faces, and those with a node within the *self-distance* of it along the surface, in the
///   reference. Along the surface means along the edges of faces (and the diagonals of quadrilaterals), so it is never
///   less than the geodesic distance, and on usual meshes at most 1.15 (triangles) or 1.08 (quadrilaterals) times it.
///   Found once, about 100 bytes per node in space for the default distance.
/// - **facing its way** now: the normals of node and face make an angle of less than 60 degrees.
/// - **the far side of its own wall**: node and face lie behind each other, in the reference as now, and about as deep.
///   A node that has come through another part of the body is not so: there it was in front, or much farther off.
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
    return faces_its_way(node, face) || is_near(node, face) || is_own_wall(node, face);
  }

  /// Whether the face is within the self-distance of the node.
  [[nodiscard]] bool is_near(Index node, Index face) const;
  /// Faces within the self-distance of the node, by increasing index.
  [[nodiscard]] std::span<const Index> near(Index node) const
  {
    return {near_faces_.data() + near_offsets_[node], near_offsets_[node + 1] - near_offsets_[node]};
  }
  /// Node-face pairs within the self-distance.
  [[nodiscard]] std::size_t n_near() const { return near_faces_.size(); }
  /// Normals of the nodes now, the mean of their faces'; zero without faces.
  [[nodiscard]] std::span<const Eigen::Vector3f> node_normals() const { return now_.node; }

private:
  struct Normals
  {
    std::vector<Eigen::Vector3f> node, face;
  };
  [[nodiscard]] Normals normals(std::span<const double> x) const;
  [[nodiscard]] bool faces_its_way(Index node, Index face) const
  {
    return now_.node[node].dot(now_.face[face]) > same_way;
  }
  [[nodiscard]] bool is_own_wall(Index node, Index face) const;
  [[nodiscard]] double edge_length(Index a, Index b) const;
  void find_near(std::optional<double> self_distance);

  // Cosine above which normals point the same way.
  static constexpr float same_way = 0.5F;

  const Surface &surface_;
  std::span<const double> x_;
  std::vector<double> size_; ///< longest edge of each node's own faces, reference
  Normals reference_, now_;
  std::vector<std::size_t> near_offsets_; ///< [n_nodes + 1]
  std::vector<Index> near_faces_;
};
} // namespace amontons
