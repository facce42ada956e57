#pragma once
#include "amontons/contact/element.h"

#include <cstdint>

namespace amontons
{
/// What a contact remembers of one impactor node; keyed by (contact, global node id). A solver keeps one of the last
/// converged increment and works on a copy, so that going back is an assignment.
struct ContactState
{
  Multipliers lambda; ///< along `normal` and `tangent`
  ContactStatus status = ContactStatus::open;

  /// Frame in which the tangential multipliers stand, as in ContactLinearisation; carry_tangential() takes them over
  /// when the node meets another face.
  Eigen::Vector3d normal{0, 0, 0};
  std::array<Eigen::Vector3d, max_tangents> tangent{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};

  /// Where this increment's slip starts. Finite sliding: a point of space at tau, [dim]. Small strain: the relative
  /// displacement u_1 - sum N_i u_i then, [dim]. The node's own at tau where it was closed; of the instant of closing
  /// where it was open.
  Eigen::Vector3d slip_origin{0, 0, 0};
  bool closed_at_start = false; ///< whether the gap was closed at tau

  /// Slip since the beginning while in contact: increments' slips summed along e_1, e_2, length.
  std::array<double, max_tangents> total_slip{0, 0};

  std::int64_t face_id = -1; ///< global id of the target face last met; -1: none, or an analytic target
  std::array<double, 2> xi{0, 0};
};
} // namespace amontons
