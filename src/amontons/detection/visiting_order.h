#pragma once
#include "amontons/surface/surface.h"

#include <vector>

namespace amontons
{
/// The nodes of a surface along a Hilbert curve through their reference coordinates; empty where nodes that follow one
/// another are mostly close as they are numbered.
std::vector<Index> visiting_order(const Surface &surface);
} // namespace amontons
