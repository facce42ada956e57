#pragma once
#include "amontons/contact/linearisation.h"
#include "amontons/surface/shape.h"

#include <array>
#include <span>

namespace amontons
{
/// Finite sliding: everything of the current geometry.
/// @param impactor current position, [dim]
/// @param face current positions of the face's nodes, [n_face_nodes * dim], 2 nodes in the plane, 3 or 4 in 3D
/// @param slip_origin where the node's slip over this increment started: a point of space at the increment's beginning
///        tau (the impactor node's position then, or the point where it closed), [dim]
/// @param face_at_start positions of the same face's nodes at tau, [n_face_nodes * dim]
/// @param xi_guess start of the projection, from the pairing
/// Slip: g_t = tangential part of xbar(xi) - xbar(alpha), two points of the face as it is now, alpha the projection of
/// `slip_origin` on the (extended) face as it was at tau and a datum when differentiating. On segments and triangles
/// that is sum_a a_a (xi^a - alpha^a) (THEORY.md section 3; the paper, section 2); on bilinear faces it stays exact in
/// a plane.
/// @param normals_at_start unit normals at the face's nodes at tau, [n_face_nodes * dim]; they turn with the face. The
///        forces act along the normal interpolated between them; gap and slip are measured on the face as ever. Empty:
///        the face's own normal.
/// @throws NumericalFailure if the face has collapsed
ContactLinearisation linearise_finite(int dim, std::span<const double> impactor, std::span<const double> face,
                                      std::span<const double> slip_origin, std::span<const double> face_at_start,
                                      std::array<double, 2> xi_guess, std::span<const double> normals_at_start = {});

/// Small strain: normal, tangents and xi of the reference geometry.
/// @param reference_impactor, reference_face reference coordinates, laid out as above
/// @param displacement of the impactor, then of the face's nodes, [(1 + n_face_nodes) * dim]
/// @param slip_origin relative displacement u_1 - sum N_i u_i at the increment's beginning (or when the node closed),
/// [dim]
ContactLinearisation linearise_small(int dim, std::span<const double> reference_impactor,
                                     std::span<const double> reference_face, std::span<const double> displacement,
                                     std::span<const double> slip_origin, std::array<double, 2> xi);

/// Small strain, against a weighted mean of target nodes (contact/mortar.h).
/// @param normal n, unit @param reference_targets, weights of the target nodes, [n_targets * dim] and [n_targets]
/// @param displacement of the impactor, then of the targets, [(1 + n_targets) * dim]
/// @param slip_origin relative displacement u_1 - sum w_k u_k at the increment's beginning, [dim]
/// In 3D e_1 is made from an axis of coordinates.
ContactLinearisation linearise_mean(int dim, const Eigen::Vector3d &normal, std::span<const double> reference_impactor,
                                    std::span<const double> reference_targets, std::span<const double> weights,
                                    std::span<const double> displacement, std::span<const double> slip_origin);

/// Finite sliding against a weighted mean of target nodes (contact/mortar.h): g_n = n . (x_0 - sum w_k x_k), and the
/// slip over the increment is the chord between two points of the target as it is now, g_t,c = e_c . sum_k (w_k - w0_k)
/// x_k (Yang, Laursen, Meng 2005, IJNME 62; Gitterle, Popp, Gee, Wall 2010, IJNME 84), w0 a datum: frame indifferent.
/// Dofs: the impactors, then the targets. Forces act along n (e_c) on x_0 and along -w_k n (-w_k e_c) on the targets;
/// the gradients of gap and slip are whole, those of n, e_c and w included.
/// @param normal n, unit @param normal_gradient [dim x dim * n_impactors]
/// @param impactors positions of the node itself, then of those its normal and weights depend on, [n_impactors * dim]
/// @param targets positions, [n_targets * dim]
/// @param weights w, [n_targets], their sum 1 @param weight_gradient [n_targets x dim * (n_impactors + n_targets)]
/// @param origin_weights w0, where the slip started, on the same targets, [n_targets], their sum 1
/// @param ends in 3D e_1 is the part normal to n of impactors[ends[1]] - impactors[ends[0]]; in the plane (-n_y, n_x)
/// @throws NumericalFailure if that part vanishes
ContactLinearisation linearise_mortar(int dim, const Eigen::Vector3d &normal, const Eigen::MatrixXd &normal_gradient,
                                      std::span<const double> impactors, std::span<const double> targets,
                                      std::span<const double> weights, const Eigen::MatrixXd &weight_gradient,
                                      std::span<const double> origin_weights, const std::array<int, 2> &ends);

/// Analytic rigid target that translates with its point (Shape::point).
/// Dofs: impactor, then the shape's point. `slip_origin` is a position at tau, `shape_point_at_start` the point's then.
/// Slip: the chord from where the slip started to where the node is, both relative to the shape's point, projected on
/// the tangent plane at the closest point. A cone is extended beyond its apex. e_1 lies along the axis of a cylinder,
/// the generator of a cone; on a plane it is made from an axis of coordinates, on a sphere from a fixed direction.
/// @throws NumericalFailure if the node lies at the centre of a circle or sphere or on the axis of a cylinder
ContactLinearisation linearise_shape(int dim, bool axisymmetric, const Shape &shape, std::span<const double> impactor,
                                     std::span<const double> shape_point, std::span<const double> slip_origin,
                                     std::span<const double> shape_point_at_start);

/// The small-strain counterpart: normal and closest point of the reference geometry.
ContactLinearisation linearise_shape_small(int dim, bool axisymmetric, const Shape &shape,
                                           std::span<const double> reference_impactor,
                                           std::span<const double> displacement, std::span<const double> slip_origin);

/// Fraction of the increment, in [0, 1], at which the gap vanished, interpolated linearly: 0 where it was closed at
/// tau, 1 where it is not closed now.
double closing_fraction(double gap_start, double gap_now);

/// Where a node that was open at tau (gap_start > 0) and is found closed (gap_now <= 0) in a trial state takes its slip
/// from: the point of its way, interpolated linearly in the gap, at which the gap vanished, carried back to the
/// target's geometry at tau. Same arguments and frame as linearise_finite. @return slip_origin, [dim]
Eigen::Vector3d closing_origin_finite(int dim, std::span<const double> impactor, std::span<const double> face,
                                      std::span<const double> impactor_at_start, std::span<const double> face_at_start,
                                      std::array<double, 2> xi_guess);

/// The same for an analytic target; arguments as in linearise_shape.
Eigen::Vector3d closing_origin_shape(int dim, bool axisymmetric, const Shape &shape, std::span<const double> impactor,
                                     std::span<const double> shape_point, std::span<const double> impactor_at_start,
                                     std::span<const double> shape_point_at_start);
} // namespace amontons
