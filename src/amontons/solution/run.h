#pragma once
#include "amontons/base/timer.h"
#include "amontons/detection/report.h"
#include "amontons/parallel/communicator.h"
#include "amontons/solution/observer.h"
#include "amontons/solution/options.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace amontons
{
/// Outcome of a run.
struct RunResult
{
  bool converged = false;
  std::string failure; ///< named cause; empty when converged
};

/// Solves a problem to its end and tells the observers, every process its own. Collective.
/// @param from where an earlier run left off, on process 0; elsewhere only whether there is one; null: from t = 0
/// @throws UserError for what only the mesh can tell is wrong (check_problem finds the same), and for a checkpoint of
///         another problem
RunResult run(const ProblemOptions &options, std::span<Observer *const> observers, const Checkpoint *from = nullptr,
              const Communicator &communicator = Communicator::alone());

/// What can be known of a contact before solving.
struct ContactCheck
{
  std::string name;
  Index n_impactor_nodes = 0;
  Index n_target_faces = 0; ///< 0 for an analytic target
  DetectionReport detection;
};

struct ProblemCheck
{
  Index n_nodes = 0;
  Index n_cells = 0;
  std::int64_t n_dofs = 0;
  std::vector<ContactCheck> contacts;
  std::vector<std::string> warnings;
};

/// Builds the problem and detects once, without solving. Local. @throws UserError as run().
ProblemCheck check_problem(const ProblemOptions &options);
} // namespace amontons
