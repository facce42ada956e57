#include "amontons/bulk/mesh_check.h"

#include <Eigen/Dense>
#include <algorithm>
#include <sstream>

namespace amontons
{
namespace
{
constexpr double least_relative_jacobian = 1e-12;

Eigen::Vector3d point(const Mesh &mesh, Index node)
{
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int c = 0; c < mesh.dim; ++c)
    x[c] = mesh.points[static_cast<std::size_t>(node) * mesh.dim + c];
  return x;
}

/// For each vertex its neighbours along the edges of the cell, such that the edges (first, second, third) of a
/// well-shaped cell are right-handed.
std::span<const std::array<int, 3>> corner_neighbours(CellShape shape)
{
  static constexpr std::array<std::array<int, 3>, 3> triangle{{{1, 2, -1}, {2, 0, -1}, {0, 1, -1}}};
  static constexpr std::array<std::array<int, 3>, 4> quadrilateral{{{1, 3, -1}, {2, 0, -1}, {3, 1, -1}, {0, 2, -1}}};
  static constexpr std::array<std::array<int, 3>, 1> tetrahedron{{{1, 2, 3}}};
  static constexpr std::array<std::array<int, 3>, 8> hexahedron{
      {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};
  switch (shape)
  {
  case CellShape::triangle:
    return triangle;
  case CellShape::quadrilateral:
    return quadrilateral;
  case CellShape::tetrahedron:
    return tetrahedron;
  case CellShape::hexahedron:
    return hexahedron;
  case CellShape::segment:
    break;
  }
  throw InternalError("a segment is no cell");
}

/// Least and greatest Jacobian at the vertices over (distance of the vertex farthest from the first)^dim; zero for a
/// cell without extent.
std::array<double, 2> relative_jacobians(const Mesh &mesh, std::span<const Index> cell)
{
  double least = std::numeric_limits<double>::infinity(), greatest = -least, size = 0;
  const auto corners = corner_neighbours(cell_shape(mesh.dim, cell.size()));
  for (std::size_t v = 0; v < corners.size(); ++v)
  {
    Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();
    for (int e = 0; e < mesh.dim; ++e)
      edges.col(e) = point(mesh, cell[corners[v][e]]) - point(mesh, cell[v]);
    const double jacobian = edges.determinant();
    least = std::min(least, jacobian);
    greatest = std::max(greatest, jacobian);
  }
  for (std::size_t v = 1; v < cell.size(); ++v)
    size = std::max(size, (point(mesh, cell[v]) - point(mesh, cell[0])).norm());
  const double scale = size > 0 ? std::pow(size, -mesh.dim) : 0;
  return {least * scale, greatest * scale};
}

std::string described(const Mesh &mesh, Index cell)
{
  static const char *const names[]{"segment", "triangle", "quadrilateral", "tetrahedron", "hexahedron"};
  std::ostringstream text;
  text << names[static_cast<int>(cell_shape(mesh.dim, mesh.cells[cell].size()))] << " " << mesh.cell_tags[cell]
       << " (nodes";
  for (const Index node : mesh.cells[cell])
    text << " " << mesh.node_tags[node];
  const Eigen::Vector3d x = point(mesh, mesh.cells[cell][0]);
  text << ", the first at (" << x[0] << ", " << x[1];
  if (mesh.dim == 3)
    text << ", " << x[2];
  text << "))";
  return text.str();
}

void reverse(Connectivity &entities, Index e)
{
  std::reverse(entities.nodes.begin() + entities.offsets[e] + 1, entities.nodes.begin() + entities.offsets[e + 1]);
}
} // namespace

void turn_clockwise_cells(Mesh &mesh)
{
  if (mesh.dim != 2)
    return;
  std::vector<bool> turned(static_cast<std::size_t>(mesh.cells.size()));
  for (Index c = 0; c < mesh.cells.size(); ++c)
    if (relative_jacobians(mesh, mesh.cells[c])[1] < 0)
    {
      reverse(mesh.cells, c);
      turned[static_cast<std::size_t>(c)] = true;
    }
  for (auto &[name, group] : mesh.groups)
    for (std::size_t e = 0; e < group.cells.size(); ++e)
      if (turned[static_cast<std::size_t>(group.cells[e])])
        reverse(group.entities, static_cast<Index>(e));
}

void check_cells(const Mesh &mesh, const SourceLocation &where)
{
  for (Index c = 0; c < mesh.cells.size(); ++c)
  {
    const auto [least, greatest] = relative_jacobians(mesh, mesh.cells[c]);
    if (least >= least_relative_jacobian)
      continue;
    std::string what = "is degenerate or not convex";
    if (greatest < -least_relative_jacobian)
      what = "is inverted";
    else if (greatest < least_relative_jacobian)
      what = "is degenerate";
    throw UserError(where, mesh.file + ": the " + described(mesh, c) + " " + what +
                               ": its Jacobian is not positive at every vertex");
  }
}
} // namespace amontons
