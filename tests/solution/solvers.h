#pragma once
#include "problem.h"

namespace amontons::test
{
/// A form of the linear system and who solves it.
struct Solver
{
  LinearSolverType linear;
  MultiplierForm multipliers;
};

inline const std::vector<Solver> all_solvers{{LinearSolverType::direct, MultiplierForm::coupled},
                                             {LinearSolverType::direct, MultiplierForm::condensed},
                                             {LinearSolverType::amg, MultiplierForm::condensed},
                                             {LinearSolverType::feti, MultiplierForm::condensed}};

/// Solves tightly, and expects convergence.
inline Record solve_by(Problem problem, const Solver &solver)
{
  problem.options.solver.linear = solver.linear;
  problem.options.solver.multipliers = solver.multipliers;
  problem.options.solver.tolerance = 1e-11;
  return problem.converge();
}
} // namespace amontons::test
