#pragma once
#include "amontons/algebra/system_form.h"
#include "amontons/solution/model.h"

#include <memory>

namespace amontons
{
/// The form in which the model's systems are solved: what `solver` of the deck says, or what is fastest for its size,
/// dimension and strain. The model must outlive it. Collective.
std::unique_ptr<SystemForm> make_form(const Model &model);

/// The subdomain of each cell that the form wants, or nothing where one subdomain will do.
std::vector<Index> make_partition(const ProblemOptions &options, const Mesh &mesh);
} // namespace amontons
