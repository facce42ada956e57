#pragma once
#include "amontons/bulk/mesh.h"

#include <array>

namespace amontons
{
/// The cell that a facet bounds, and the facet as that cell sees it.
struct FacetOwner
{
  Index cell = -1;       ///< -1: bounds no cell
  Index other_cell = -1; ///< a second cell: the facet lies between two
  int local_facet = -1;  ///< position among facets_of(cell's shape)
};

/// Local vertex numbers of each facet of a cell, outwards: counter-clockwise from outside in 3D, in the plane with the
/// outward normal on the right hand. A triangle of a hexahedron does not occur; unused entries are -1.
std::span<const std::array<int, 4>> facets_of(CellShape shape);

/// Owners of a group's facets (group.dim == mesh.dim - 1), in the order of group.entities. Cells of smaller position
/// come first.
std::vector<FacetOwner> facet_owners(const Mesh &mesh, const Group &group);

/// Which body each face of a surface bounds: parts of the mesh whose cells have common nodes are one body, named by its
/// smallest node. [n_faces] @param surface as from extract_surface()
std::vector<Index> bodies_of_faces(const Mesh &mesh, const Surface &surface);

/// Some nodes and faces of a surface, numbered in this order; without adjacency.
/// @param nodes all nodes of these faces among them
Surface share_of_surface(const Surface &surface, std::span<const Index> nodes, std::span<const Index> faces);

/// Bodies must meet by contact, not by common nodes.
/// @param impactor, target as from extract_surface(), named in the message
/// @throws UserError where they share a node
void check_not_welded(const Mesh &mesh, const Surface &impactor, const Surface &target,
                      const std::string &impactor_name, const std::string &target_name, const SourceLocation &where);
} // namespace amontons
