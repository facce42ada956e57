#pragma once
#include "amontons/bulk/mesh.h"

#include <vector>

namespace amontons
{
/// Divides cells into n parts of about equal number by cutting across their longest extent again and again, where the
/// cells' centres leave a wide gap: flat interfaces in meshes that lie in layers.
/// @return [n cells] part, 0 .. n-1; parts need not hang together
std::vector<Index> bisect_cells(const Mesh &mesh, const std::vector<Index> &cells, Index n);
} // namespace amontons
