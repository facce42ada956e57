#pragma once
#include "amontons/algebra/node_blocks.h"

#include <span>
#include <vector>

namespace amontons
{
/// Rigid motions of the whole, 3 in the plane and 6 in 3D, over the rows of the blocks; zero on rows without an
/// unknown. Unknowns that move many nodes (of a rigid body) take the motion that fits their nodes best.
/// @param reference places of the nodal components [n_nodal], length
std::vector<std::vector<double>> rigid_modes(const Layout &layout, const NodeBlocks &blocks,
                                             std::span<const double> reference);
} // namespace amontons
