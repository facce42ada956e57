#pragma once
#include "amontons/base/ids.h"

#include <array>
#include <span>
#include <vector>

namespace amontons
{
/// A contact surface of one process: nodes by global id, reference coordinates, faces. Knows no unknowns.
///
/// Faces are segments (dim 2; axisymmetry too, then x is the radius), triangles or quadrilaterals (dim 3), stored one
/// after another: face f has the local nodes `face_nodes[face_offsets[f] .. face_offsets[f+1])`.
/// Orientation: seen from outside the body a 3D face runs counter-clockwise; a segment (a, b) has its outward normal on
/// the right hand of a -> b, n = (t_y, -t_x).
/// Local coordinates xi: segment [0,1], N = (1-xi, xi); triangle xi1, xi2 >= 0, xi1+xi2 <= 1, N = (1-xi1-xi2, xi1,
/// xi2); quadrilateral [0,1]^2, N = ((1-xi1)(1-xi2), xi1(1-xi2), xi1 xi2, (1-xi1)xi2).
struct Surface
{
  int dim = 2;
  std::vector<GlobalIndex> node_ids;  ///< [n_nodes]
  std::vector<double> reference;      ///< [n_nodes * dim], node by node
  std::vector<Index> face_offsets{0}; ///< [n_faces + 1]
  std::vector<Index> face_nodes;      ///< local node indices
  std::vector<GlobalIndex> face_ids;  ///< [n_faces]; ties between faces go to the smaller id

  /// Which body each face bounds, [n_faces]; empty: all bound the same. Only self-contact asks.
  std::vector<Index> face_bodies;

  /// Faces attached to each node, made by build_adjacency().
  std::vector<Index> node_face_offsets; ///< [n_nodes + 1]
  std::vector<Index> node_faces;

  [[nodiscard]] Index n_nodes() const { return static_cast<Index>(node_ids.size()); }
  [[nodiscard]] Index n_faces() const { return static_cast<Index>(face_offsets.size()) - 1; }
  [[nodiscard]] std::span<const Index> face(Index f) const
  {
    return {face_nodes.data() + face_offsets[f], static_cast<std::size_t>(face_offsets[f + 1] - face_offsets[f])};
  }
  [[nodiscard]] std::span<const Index> faces_of_node(Index node) const
  {
    return {node_faces.data() + node_face_offsets[node],
            static_cast<std::size_t>(node_face_offsets[node + 1] - node_face_offsets[node])};
  }

  void build_adjacency();
};

/// Tributary area of each node, the integral of N_i over the faces in the reference geometry: per unit thickness in the
/// plane; with `axisymmetric`, of N_i 2 pi r (not zero on the axis). [n_nodes]
std::vector<double> tributary_areas(const Surface &surface, bool axisymmetric);
} // namespace amontons
