#pragma once
#include "amontons/algebra/subdomain_matrix.h"
#include "amontons/bulk/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace amontons
{
/// One matrix per subdomain, values zero: every two nodes of a cell are coupled, local nodes ascend with the mesh's.
/// @param taken [n_cells] whether the cell has stiffness
/// @param subdomain_of_cell [n_cells], or empty for one subdomain
std::vector<SubdomainMatrix> make_patterns(const Mesh &mesh, const std::vector<bool> &taken,
                                           std::span<const Index> subdomain_of_cell);

/// Where the matrices of cells or facets with equal numbers of nodes go in the matrix of their subdomain.
class BlockPositions
{
public:
  /// @param nodes [n_entities * n_entity_nodes] nodes of the mesh, coupled in the pattern of `matrix`
  BlockPositions(const SubdomainMatrix &matrix, std::span<const Index> nodes, int n_entity_nodes);

  /// values += K at the place of an entity.
  /// @param K matrix over the entity's unknowns, node by node, with K(row, column)
  /// @param n_entity_nodes and dim may be of a type std::integral_constant, for loops of fixed length
  template<class Matrix, class Nodes, class Dimension>
  void add(SubdomainMatrix &matrix, std::size_t entity, const Matrix &K, Nodes n_entity_nodes, Dimension dim) const
  {
    const Index *rows = rows_.data() + entity * n_entity_nodes;
    const std::uint16_t *columns = columns_.data() + entity * n_entity_nodes * n_entity_nodes;
    for (int a = 0; a < n_entity_nodes; ++a)
      for (int i = 0; i < dim; ++i)
      {
        double *row = matrix.values.data() + matrix.row_ptr[rows[a] + i];
        for (int b = 0; b < n_entity_nodes; ++b)
        {
          double *entry = row + columns[a * n_entity_nodes + b];
          for (int k = 0; k < dim; ++k)
            entry[k] += K(a * dim + i, b * dim + k);
        }
      }
  }

private:
  std::vector<Index> rows_;            ///< [n_entities * n_entity_nodes] first row of the node
  std::vector<std::uint16_t> columns_; ///< [.. * n_entity_nodes] distance of the column from the row's start
};
} // namespace amontons
