#pragma once
#include "amontons/parallel/communicator.h"

#include <functional>

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
} // namespace amontons
