#pragma once
#include "amontons/base/error.h"
#include "amontons/parallel/sharing.h"

#include <functional>

namespace amontons
{
/// An iterative linear solver did not get there, or its method does not fit the matrix: another solver may.
class LinearSolverFailure : public NumericalFailure
{
public:
  using NumericalFailure::NumericalFailure;
};

/// agree_on_errors() that keeps LinearSolverFailure what it is. Collective, but `work` itself must be local; where
/// nothing is distributed it is just done.
void agree_on_failures(const Sharing &processes, const std::function<void()> &work);
} // namespace amontons
