#pragma once
#include "amontons/parallel/sharing.h"
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
/// as one that was never interrupted, to the tolerance of its solvers. Of the whole problem, whatever the number of
/// processes, or what one process has of it.
struct Checkpoint
{
  std::uint64_t problem_key = 0; ///< of the problem it belongs to
  int increment = 0;
  double time = 0;
  double next_step = 0;                                         ///< length of the next increment
  double last_motion = 0;                                       ///< largest displacement of the last increment
  LinearSolverType linear_solver = LinearSolverType::automatic; ///< that is at work
  State state;
  std::optional<LastIncrement> last;
  std::vector<ContactHistory> contacts;
  CellHistories cells;
  Counters counters; ///< of the whole
};

/// Tells problems apart whose checkpoints do not fit each other: by the mesh, bit by bit, kinematics and strain, the
/// laws of bodies, the sides and kinds of contacts. Loads, constants, tolerances and solvers are not in it.
/// @param mesh the whole
std::uint64_t problem_key(const ProblemOptions &options, const Mesh &mesh);

/// The checkpoint of the whole from the processes' parts, on process 0; of no use elsewhere. Collective.
/// @param local cells as in `mesh`, nodal vectors and contacts of the process, everything else the same on all
/// @param nodes those of the mesh, then the points of analytic bodies, and perhaps more behind those of a state
Checkpoint gathered(const Checkpoint &local, const Mesh &mesh, const Sharing &nodes);

/// A process's part of the checkpoint of the whole. Of the counters, those that each process has for itself go to
/// process 0. Collective.
/// @param whole on process 0; elsewhere not looked at
/// @param problem_key of the problem to go on with
/// @param n_state_nodes of the mesh and of analytic bodies @param contact_nodes own impactor nodes, by contact
/// @throws UserError, on all processes, for a checkpoint of another problem
Checkpoint part_of(const Checkpoint &whole, std::uint64_t problem_key, const Mesh &mesh, const Sharing &nodes,
                   Index n_state_nodes, const std::vector<std::vector<GlobalIndex>> &contact_nodes);

/// Positions of rigid bodies as numbers, 15 for a body, and back.
std::vector<double> to_numbers(const std::vector<RigidState> &bodies);
std::vector<RigidState> to_rigid_states(const std::vector<double> &numbers);
} // namespace amontons
