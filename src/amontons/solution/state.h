#pragma once
#include "amontons/bulk/rigid_bodies.h"

#include <vector>

namespace amontons
{
/// What Newton's iterations move: everything that a failed increment has to give back.
struct State
{
  std::vector<double> displacement; ///< nodes of the mesh, then the points of analytic bodies, dim each
  std::vector<RigidState> rigid;
  std::vector<double> multipliers; ///< [n_multipliers], per contact, own impactor node and direction (n, e_1[, e_2])
};

/// A motion of a state.
struct Step
{
  std::vector<double> rigid;        ///< [n_unknowns of rigid bodies]
  std::vector<double> displacement; ///< as State::displacement, zero at nodes of rigid bodies
  std::vector<double> multipliers;
};
} // namespace amontons
