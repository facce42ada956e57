#pragma once
#include "amontons/bulk/mesh.h"

#include <span>
#include <string>
#include <vector>

namespace amontons
{
/// Cells or facets of one shape whose matrices go to one subdomain.
struct EntityBlock
{
  CellShape shape;
  Index subdomain = 0;
  std::vector<Index> nodes; ///< [n_entities * n_nodes(shape)], in the order of the mesh
};

/// What the regions of boundary entries mean, for loads on deformable bodies.
class LoadRegions
{
public:
  /// @param body_of_cell [n_cells], -1 in rigid bodies
  /// @param subdomain_of_cell [n_cells], or empty for one subdomain
  LoadRegions(const Mesh &mesh, const std::vector<BodyOptions> &bodies, std::span<const Index> deformable_body_of_cell,
              std::span<const Index> subdomain_of_cell);

  /// The entry names a rigid body, or the region of one.
  [[nodiscard]] bool is_rigid(const BoundaryOptions &entry) const;

  /// Facets of a group, each with the subdomain of the deformable cell it bounds (the first, if there are two).
  /// @param one_sided turn the facets outwards from their cell, and refuse one between two cells
  /// @throws UserError: no such group of facets, a facet that bounds no deformable cell
  [[nodiscard]] std::vector<EntityBlock> facets(const BoundaryOptions &entry, bool one_sided) const;

  /// Cells of a body, or deformable cells of a group. @throws UserError: neither of them
  [[nodiscard]] std::vector<EntityBlock> cells(const BoundaryOptions &entry) const;

  /// Nodes of a group of points. @throws UserError: no such group, a point of no deformable cell
  [[nodiscard]] std::vector<Index> points(const BoundaryOptions &entry) const;

private:
  [[nodiscard]] const BodyOptions *find_body(const std::string &name) const;
  [[nodiscard]] std::vector<Index> owners(std::span<const Index> facet,
                                          const std::vector<std::vector<Index>> &cells_of_node) const;
  [[nodiscard]] std::vector<std::vector<Index>> deformable_cells_of(const Group &group) const;
  [[nodiscard]] bool faces_outwards(std::span<const Index> facet, Index cell) const;
  [[nodiscard]] std::string describe(std::span<const Index> nodes) const;
  [[nodiscard]] Index subdomain(Index cell) const { return subdomain_of_cell_.empty() ? 0 : subdomain_of_cell_[cell]; }

  const Mesh &mesh_;
  const std::vector<BodyOptions> &bodies_;
  std::span<const Index> body_of_cell_, subdomain_of_cell_;
};
} // namespace amontons
