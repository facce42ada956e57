#pragma once
#include "amontons/surface/surface.h"

#include <vector>

namespace amontons
{
/// The nodes along a space-filling curve, by their reference coordinates, where the surface's own numbering scatters
/// neighbours over memory, so that its nodes are better numbered anew; empty where it does not.
std::vector<Index> numbering_order(const Surface &surface);

/// The order in which to visit the nodes, so that some that follow one another lie in a patch and not in a row: along
/// the curve; empty where their numbers serve as well (in the plane, or without reference coordinates).
std::vector<Index> visiting_order(const Surface &surface);
} // namespace amontons
