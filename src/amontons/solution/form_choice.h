#pragma once
#include "amontons/algebra/system_form.h"
#include "amontons/solution/model.h"

#include <memory>

namespace amontons
{
/// What `solver: {linear: ...}` stands for. For `auto` the fastest for size, dimension, strain and materials comes
/// first; each of the others takes over where the one before it fails. @throws UserError where the deck's forms do not
/// go together
std::vector<LinearSolverType> linear_solvers(const ProblemOptions &options, const Mesh &mesh);

/// The form in which the model's systems are solved. The model must outlive it. Collective.
/// @param linear one of linear_solvers()
std::unique_ptr<SystemForm> make_form(const Model &model, LinearSolverType linear);

/// The subdomain of each cell of the whole mesh that the first of linear_solvers() wants, at least as many as there are
/// processes; or nothing where one subdomain to a process will do. Local.
std::vector<Index> make_partition(const ProblemOptions &options, const Mesh &mesh, int n_processes);
} // namespace amontons
