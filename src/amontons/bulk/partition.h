#pragma once
#include "amontons/bulk/mesh.h"
#include "amontons/bulk/options.h"

#include <vector>

namespace amontons
{
/// Divides the deformable bodies into subdomains of about n_unknowns unknowns each (nodes shared by two counted in
/// both): by flat cuts (bisection.h), or by METIS on the graph of cells that share a facet (Karypis, Kumar 1998),
/// whichever cuts fewer facets of a body.
///
/// A subdomain lies within one body, and its cells hang together by facets, so that its stiffness has no kernel but the
/// rigid motions. The same mesh gives the same partition. Local.
/// @return [n_cells] subdomain, 0 .. n-1 without holes; 0 for cells of rigid bodies, which count for none
/// @throws UserError: unknown region
std::vector<Index> partition_cells(const Mesh &mesh, const std::vector<BodyOptions> &bodies, int n_unknowns);
} // namespace amontons
