#pragma once
#include "amontons/surface/surface.h"

#include <vector>

namespace amontons
{
/// The order in which to visit the nodes of a surface: as they are numbered where nodes that follow one another are
/// mostly close, else along a Hilbert curve through their reference coordinates.
std::vector<Index> visiting_order(const Surface &surface);
} // namespace amontons
