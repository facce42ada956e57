#pragma once
#include "amontons/bulk/mesh.h"

namespace amontons
{
/// Splits every cell, facet and edge of a group into 2^(its dimension) of its own shape, conforming, with new nodes in
/// the middle of edges, quadrilaterals and hexahedra. New nodes get tags after the greatest; cells are numbered anew.
/// Tetrahedra: the octahedron left by cutting the four corners is cut along its shortest diagonal (Zhang 1995).
void refine_uniformly(Mesh &mesh);
} // namespace amontons
