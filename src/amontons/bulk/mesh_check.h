#pragma once
#include "amontons/bulk/mesh.h"

namespace amontons
{
/// Turns clockwise 2D cells, and the same cells where groups list them, so that all run counter-clockwise.
void turn_clockwise_cells(Mesh &mesh);

/// @throws UserError for the first cell whose Jacobian at some vertex is not positive: below 1e-12 of the
///         cell's size to the power dim.
void check_cells(const Mesh &mesh, const SourceLocation &where);
} // namespace amontons
