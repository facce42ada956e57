#pragma once
#include "amontons/bulk/rigid_bodies.h"

#include <vector>

namespace amontons
{
/// What Newton's iterations move: everything that a failed increment has to give back.
struct State
{
  std::vector<double> displacement; ///< [n_nodal]: nodes of the mesh, then the points of analytic bodies, dim each
  std::vector<RigidState> rigid;
  std::vector<double> multipliers; ///< [n_multipliers], per contact, impactor node and direction (n, e_1[, e_2])
};
} // namespace amontons
