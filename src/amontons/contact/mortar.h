#pragma once
#include "amontons/surface/surface.h"

#include <Eigen/Geometry>

#include <functional>
#include <span>
#include <vector>

namespace amontons
{
/// The derivatives of normals and weights with respect to the positions of the nodes of both sides: those of the
/// numbers themselves, of the rule of integration and of the ends of the overlaps. Data are which faces see each other,
/// which node stands in for another, and, for the normal at a sharp edge, the share of a face that is covered in part.
/// Where an edge of the target lies on one of the impactor's the overlap ends at the impactor's: within the surfaces
/// that is the derivative, at their rims it is that of a target that grows.
struct MortarGradients
{
  std::vector<Index> offsets; ///< [n impactor nodes + 1]
  /// Impactor nodes on which n_j and weight_jk depend: offsets[j] .. offsets[j + 1], node j itself first. None for a
  /// node that sees nothing.
  std::vector<Index> impactors;
  std::vector<Eigen::MatrixXd> normal; ///< d n_j/dx, [n impactor nodes], each [dim x dim * n_impactors of j]
  /// d weight_jk/dx, [n impactor nodes], each [n_targets of j x dim * (n_impactors of j + n_targets of j)]; columns:
  /// j's impactors, then j's targets, dim components each
  std::vector<Eigen::MatrixXd> weight;

  [[nodiscard]] std::span<const Index> impactors_of(Index j) const
  {
    return {impactors.data() + offsets[j], static_cast<std::size_t>(offsets[j + 1] - offsets[j])};
  }
};

/// Surface-to-surface coupling: each impactor node against a weighted mean of target nodes. With dual shape functions
/// Phi_j for the multipliers (Wohlmuth 2000: the integral of Phi_j N_k over the impactor is D_jj for k = j and else 0),
///     g_j = n_j . (x_j - sum_k weight_jk x_k),   weight_jk = M_jk / D_jj,   M_jk = integral of Phi_j N_k(target),
/// is the mean gap at node j. The multiplier of g_j is the nodal force, D_jj times the traction.
///
/// Integrals run over the part of the impactor that sees the target (surface/overlap_integrals.h), D too; on a face
/// that is covered in part the dual functions are those of that part (Cichosz, Bischoff 2011; Popp, Seitz, Gee, Wall
/// 2013), so that a uniform pressure and a linear motion pass exactly.
struct MortarCoupling
{
  std::vector<double> area; ///< D_jj, [n impactor nodes], area covered; axisymmetry: of the ring; 0: sees nothing
  /// n_j, [n impactor nodes], unit: minus the impactor's own normal, averaged over the faces that see the target
  std::vector<Eigen::Vector3d> normal;
  std::vector<Index> offsets; ///< [n impactor nodes + 1]
  /// Local target nodes of node j: offsets[j] .. offsets[j + 1], ascending; with gradients those too whose weight
  /// vanishes here but may change.
  std::vector<Index> targets;
  std::vector<double> weight; ///< with them; their sum is 1 for each node that sees the target
  Index n_overlaps = 0;       ///< pairs of faces that see each other
  MortarGradients gradients;  ///< empty unless asked for

  [[nodiscard]] bool sees_target(Index j) const { return area[j] > 0; }
  [[nodiscard]] std::span<const Index> targets_of(Index j) const
  {
    return {targets.data() + offsets[j], static_cast<std::size_t>(offsets[j + 1] - offsets[j])};
  }
  [[nodiscard]] std::span<const double> weights_of(Index j) const
  {
    return {weight.data() + offsets[j], static_cast<std::size_t>(offsets[j + 1] - offsets[j])};
  }
};

/// A surface and where its nodes are: x is [n_nodes * dim].
struct PlacedSurface
{
  const Surface &surface;
  std::span<const double> x;
};

/// Replaces `faces` by all target faces whose boxes meet a box, ascending (detection/face_boxes.h does it).
using FacesInBox = std::function<void(const Eigen::AlignedBox3d &box, std::vector<Index> &faces)>;

/// What of a coupling is wanted.
struct MortarScope
{
  /// [n impactor nodes], not 0: this node's; the others see nothing. Empty: all. Faces that have no wanted node are not
  /// looked at.
  std::span<const char> nodes;
  bool gradients = false;
};

/// @param axisymmetric integrals over the ring, 2 pi r
/// @param w pairs of faces that nowhere come within this distance of each other do not count, length. Where an impactor
/// face sees more than its own size, of target layers behind one another, the nearer counts.
/// Round a node at a sharp edge a face that faces the target less than half as well as the best does not count there:
/// it hardly sees anything but aslant and far away, as the sides of a block see the floor.
/// A node of which a face covers less than 1e-6 of its share carries no multiplier there: the best covered node of that
/// face stands in for it, for values extrapolated from a sliver would be noise.
/// The impactor's adjacency must be built. @throws NumericalFailure if an impactor face is not convex
MortarCoupling couple_mortar(const PlacedSurface &impactor, const PlacedSurface &target, bool axisymmetric, double w,
                             const FacesInBox &faces_in_box, const MortarScope &scope = {});
} // namespace amontons
