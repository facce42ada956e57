#pragma once
#include "amontons/base/ids.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace amontons
{
/// The given points along the Hilbert curve of their bounding cube, of 2^(60/dim) cells a side (at most 2^30): indices
/// in that order (Skilling 2004, AIP Conf. Proc. 707: the coordinates are turned in place into the bits of the
/// position, axis by axis). Where more than a few points share a cell of a coarser curve they are sorted by the finer
/// one; else they stay as they come.
template<int dim>
std::vector<Index> curve_order(std::span<const std::array<double, static_cast<std::size_t>(dim)>> points);
} // namespace amontons
