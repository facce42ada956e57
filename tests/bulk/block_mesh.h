#pragma once
#include "amontons/bulk/assembly.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include <array>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace amontons
{
/// A unit square or cube cut into n[0] x n[1] (x n[2]) cells and then moved by `map`.
///
/// Groups: "body" (all cells), "left", "right" (x), "bottom", "top" (y), "back", "front" (z), "boundary" (all facets,
/// every second one turned the wrong way) and "corner" (the point that was the origin).
struct BlockMesh
{
  CellShape shape = CellShape::quadrilateral;
  std::array<int, 3> n{2, 2, 2};
  double jitter = 0; ///< random shift of inner nodes, in widths of a cell
  std::function<Eigen::Vector3d(const Eigen::Vector3d &)> map = [](const Eigen::Vector3d &x) { return x; };

  [[nodiscard]] Mesh make() const;
};

inline Eigen::Vector3d point_of(const std::vector<double> &points, int dim, Index node)
{
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int d = 0; d < dim; ++d)
    x[d] = points[static_cast<std::size_t>(node) * dim + d];
  return x;
}

inline BodyOptions elastic_body(MaterialLaw law, double young, double poisson,
                                std::optional<bool> mean_dilatation = std::nullopt)
{
  BodyOptions body;
  body.name = "block";
  body.region = "body";
  body.material = {law, young, poisson};
  body.mean_dilatation = mean_dilatation;
  body.where = {"deck.yaml", 3, 5};
  return body;
}

/// Stiffness over all nodal unknowns, subdomains added.
Eigen::SparseMatrix<double> global_matrix(const Mesh &mesh, const BodyAssembly &assembly);

/// Newton's method with some unknowns held at the values they have in `u`; returns the iterations, or -1.
int solve(const Mesh &mesh, BodyAssembly &assembly, const std::vector<bool> &held, double time, std::vector<double> &u);

/// Unknowns of all nodes on which `on` holds, for the components given.
std::vector<bool> hold(const Mesh &mesh, const std::vector<int> &components,
                       const std::function<bool(const Eigen::Vector3d &)> &on);

/// Nodes of the boundary.
std::vector<bool> boundary_nodes(const Mesh &mesh);

/// A field at all nodes.
std::vector<double> nodal_field(const Mesh &mesh, const std::function<Eigen::Vector3d(const Eigen::Vector3d &)> &field);
} // namespace amontons
