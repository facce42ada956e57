#pragma once
#include "amontons/base/ids.h"

#include <Eigen/Geometry>

#include <array>

namespace amontons
{
inline constexpr int max_tangents = 2;

using ContactVector = Eigen::VectorXd;
using ContactMatrix = Eigen::MatrixXd;

/// Gap and slip of one impactor node against one face (or analytic shape, or, with mortar, the mean of many target
/// nodes), linearised about the current state.
///
/// Dofs are ordered node by node: the impactor node, then the nodes of the face (an analytic shape: one node, the
/// shape's point), `dim` components each; so the size is dim * n_nodes. With mortar in finite strain between them come
/// the impactor nodes that normal and weights depend on (linearise_mortar).
/// Frame: n the target's outward normal, e_1 (and e_2 in 3D) orthonormal tangents with e_1 along the face's first local
/// direction, e_2 = n x e_1. In the plane e_1 = (x_3 - x_2)/|x_3 - x_2|. With mortar e_1 is
/// made from an axis of coordinates, as on a plane shape, in finite strain from two neighbouring impactor nodes.
struct ContactLinearisation
{
  int dim = 2;
  double gap = 0;                              ///< g_n, length
  std::array<double, max_tangents> slip{0, 0}; ///< g_t over the increment, along e_1, e_2, length
  Eigen::Vector3d normal{0, 0, 0};
  std::array<Eigen::Vector3d, max_tangents> tangent;
  std::array<double, 2> xi{0, 0}; ///< local coordinates of the projection, extended
  ContactVector gap_gradient;     ///< grad g_n
  /// Virtual gap: what a unit normal force does on the nodes. grad g_n on the faces as they are; with smoothed normals
  /// along those (then the tangent has no symmetry to lose: docs/decisions).
  ContactVector gap_direction;
  ContactMatrix gap_direction_gradient; ///< (i, j) = d gap_direction(i) / d x_j; empty in small strain: zero
  std::array<ContactVector, max_tangents> slip_gradient; ///< grad g_t
  /// Virtual slip: what a unit tangential force along e_a does on the nodes. Equal to grad g_t where the slip over
  /// the increment is zero (docs/decisions); in small strain always.
  std::array<ContactVector, max_tangents> slip_direction;
  /// [a](i, j) = d slip_direction[a](i) / d x_j; empty in small strain: zero
  std::array<ContactMatrix, max_tangents> slip_direction_gradient;

  [[nodiscard]] int n_tangents() const { return dim - 1; }
  [[nodiscard]] int n_dofs() const { return static_cast<int>(gap_gradient.size()); }
};
} // namespace amontons
