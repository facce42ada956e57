#pragma once
#include "amontons/algebra/linear_solver.h"

namespace amontons
{
/// Krylov iteration (CG for a symmetric matrix, else GMRES) with algebraic multigrid by smoothed aggregation (PETSc's
/// GAMG). The hierarchy is kept while values change, until it takes measurably more iterations
/// per digit than it did when it was new; then it is made anew for the next solve, or within the solve if that is
/// hopeless.
std::unique_ptr<LinearSolver> make_amg_solver();
} // namespace amontons
