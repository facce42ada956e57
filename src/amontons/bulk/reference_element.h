#pragma once
#include "amontons/bulk/mesh.h"

#include <vector>

namespace amontons
{
/// Linear shape functions of a cell or facet at the points of a quadrature rule on its reference shape.
///
/// Nodes in the order of Gmsh and VTK; segment, square and cube are [0,1]^dim, triangle and tetrahedron the unit
/// simplex.
struct ReferenceElement
{
  int dim = 0;
  int n_nodes = 0;
  int n_points = 0;
  std::vector<double> weights;   ///< [n_points], they add up to the measure of the reference shape
  std::vector<double> values;    ///< [n_points * n_nodes]
  std::vector<double> gradients; ///< [n_points * n_nodes * dim], by the reference coordinates
};

/// @param order points per direction of Gauss's rule; on simplices 1 is the centroid, 2 a rule exact to degree 3 (4
/// points on a
///        triangle, 6 in a tetrahedron)
ReferenceElement reference_element(CellShape shape, int order);

/// Dimension of a shape and its number of nodes.
constexpr int dimension(CellShape shape)
{
  return shape == CellShape::segment ? 1 : shape == CellShape::triangle || shape == CellShape::quadrilateral ? 2 : 3;
}
constexpr int n_nodes(CellShape shape)
{
  constexpr int counts[] = {2, 3, 4, 4, 8};
  return counts[static_cast<int>(shape)];
}
} // namespace amontons
