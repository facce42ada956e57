#pragma once
#include "amontons/base/error.h"

namespace amontons
{
/// An iterative linear solver did not get there, or its method does not fit the matrix: another solver may.
class LinearSolverFailure : public NumericalFailure
{
public:
  using NumericalFailure::NumericalFailure;
};
} // namespace amontons
