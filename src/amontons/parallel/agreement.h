#pragma once
#include "amontons/parallel/communicator.h"
#include "amontons/parallel/sharing.h"

#include <functional>
#include <limits>
#include <string>

namespace amontons
{
/// Does `work` on every process; an error on one becomes the same error on all, so that none goes on alone to wait in a
/// collective that the others never reach. Collective, but `work` itself must be local.
///
/// Where several processes fail, the gravest kind wins (any other exception, NumericalFailure, UserError, in this
/// order), of equal ones that of the lowest rank.
/// @throws UserError, NumericalFailure or InternalError (which stands for any other), with one message on all
/// processes.
void agree_on_errors(const Communicator &communicator, const std::function<void()> &work);

/// The same for work that is itself collective: who fails may leave the others waiting for it. It gives them a few
/// seconds to come to their end too, well or badly; then the error is that of all, as above. If one does not come, it
/// tells its error on standard error and ends all processes (MPI_Abort) with the error's exit code (base/error.h).
///
/// To be put around work before what the work has built is destroyed, where destroying it is collective. One process
/// alone gets its exception as it is.
void end_together(const Communicator &communicator, const std::function<void()> &work);

/// Whether this process's candidate is the one of all with the greatest value, of equal ones that of the lowest place
/// (no two of which are equal). Collective.
/// @param value no_candidate where it has none
bool is_greatest(const Sharing &processes, double value, double place);
constexpr double no_candidate = -std::numeric_limits<double>::infinity();

/// What one process has to tell, on all; of several that of the highest rank; empty where nobody has. Collective.
std::string told_by_one(const Sharing &processes, bool tells, const std::function<std::string()> &text);
} // namespace amontons
