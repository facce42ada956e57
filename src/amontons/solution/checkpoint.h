#pragma once
#include "amontons/solution/contact_interface.h"
#include "amontons/solution/options.h"
#include "amontons/solution/predictor.h"
#include "amontons/solution/results.h"
#include "amontons/solution/state.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace amontons
{
/// A converged state with all that the increments after it depend on: a run that goes on from it comes to the same end
/// as one that was never interrupted, to the tolerance of its solvers.
struct Checkpoint
{
  std::uint64_t problem_key = 0; ///< of the problem it belongs to
  int increment = 0;
  double time = 0;
  double next_step = 0;   ///< length of the next increment
  double last_motion = 0; ///< largest displacement of the last increment
  State state;
  std::optional<LastIncrement> last;
  std::vector<ContactHistory> contacts;
  CellHistories cells;
  Counters counters;
};

/// Tells problems apart whose checkpoints do not fit each other: by the mesh, bit by bit, kinematics and strain, the
/// laws of bodies, the sides and kinds of contacts. Loads, constants, tolerances and solvers are not in it.
std::uint64_t problem_key(const ProblemOptions &options, const Mesh &mesh);
} // namespace amontons
