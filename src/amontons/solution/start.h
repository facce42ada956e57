#pragma once
#include "amontons/solution/model.h"

#include <string>
#include <utility>
#include <vector>

namespace amontons
{
/// How far the surfaces of a contact are apart, by their boxes, and how large they are. Collective, as all here.
std::pair<double, double> separation_and_extent(const Model &model, const ContactInterface &contact);

/// Mean stiffness of each nodal component, for r: the tangent's diagonal, [n_nodal].
std::vector<double> diagonal_stiffness(const Model &model);

/// r of all contacts. @param diagonal see diagonal_stiffness() @throws UserError where both sides are rigid
void set_augmentation(Model &model, std::span<const double> diagonal);

/// First detection of all contacts, in the reference geometry.
void detect_first(Model &model, State &state);

/// What the user should know of the contacts as they are first found: no pair, overlaps.
std::vector<std::string> initial_warnings(const Model &model);
} // namespace amontons
