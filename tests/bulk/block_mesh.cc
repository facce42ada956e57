#include "block_mesh.h"

#include <Eigen/SparseLU>

#include <algorithm>
#include <map>

namespace amontons
{
namespace
{
struct Builder
{
  const BlockMesh &block;
  Mesh mesh;
  std::vector<Eigen::Vector3d> unit; ///< place of each node in the unit block

  [[nodiscard]] int cells(int d) const { return d < mesh.dim ? block.n[d] : 0; }
  [[nodiscard]] Index node(int i, int j, int k) const { return i + (cells(0) + 1) * (j + (cells(1) + 1) * k); }

  void add_nodes()
  {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-block.jitter, block.jitter);
    for (int k = 0; k <= cells(2); ++k)
      for (int j = 0; j <= cells(1); ++j)
        for (int i = 0; i <= cells(0); ++i)
        {
          Eigen::Vector3d x(double(i) / cells(0), double(j) / cells(1), mesh.dim == 3 ? double(k) / cells(2) : 0);
          unit.push_back(x);
          for (int d = 0; d < mesh.dim; ++d)
            if (x[d] > 1e-9 && x[d] < 1 - 1e-9)
              x[d] += shift(random) / cells(d);
          x = block.map(x);
          mesh.points.insert(mesh.points.end(), x.data(), x.data() + mesh.dim);
          mesh.node_tags.push_back(static_cast<GlobalIndex>(mesh.node_tags.size()) + 1);
        }
  }

  void add_cell(std::vector<Index> nodes)
  {
    if (block.shape == CellShape::tetrahedron)
    {
      const auto x = [&](int a) { return unit[nodes[a]]; };
      if ((x(1) - x(0)).cross(x(2) - x(0)).dot(x(3) - x(0)) < 0)
        std::swap(nodes[2], nodes[3]);
    }
    mesh.cells.push_back(nodes);
    mesh.cell_tags.push_back(static_cast<GlobalIndex>(mesh.cell_tags.size()) + 1);
  }

  void add_square(int i, int j)
  {
    const Index a = node(i, j, 0), b = node(i + 1, j, 0), c = node(i + 1, j + 1, 0), d = node(i, j + 1, 0);
    if (block.shape == CellShape::quadrilateral)
      add_cell({a, b, c, d});
    else if ((i + j) % 2 == 0)
      add_cell({a, b, c}), add_cell({a, c, d});
    else
      add_cell({a, b, d}), add_cell({b, c, d});
  }

  /// A cube, or its six tetrahedra along the ways from one corner to the opposite one.
  void add_cube(int i, int j, int k)
  {
    const auto corner = [&](const std::array<int, 3> &c) { return node(i + c[0], j + c[1], k + c[2]); };
    if (block.shape == CellShape::hexahedron)
      return add_cell({corner({0, 0, 0}), corner({1, 0, 0}), corner({1, 1, 0}), corner({0, 1, 0}), corner({0, 0, 1}),
                       corner({1, 0, 1}), corner({1, 1, 1}), corner({0, 1, 1})});
    std::array<int, 3> order{0, 1, 2};
    do
    {
      std::array<int, 3> c{0, 0, 0};
      std::vector<Index> nodes{corner(c)};
      for (const int d : order)
      {
        c[d] = 1;
        nodes.push_back(corner(c));
      }
      add_cell(nodes);
    } while (std::next_permutation(order.begin(), order.end()));
  }

  void add_cells()
  {
    if (mesh.dim == 2)
      for (int j = 0; j < cells(1); ++j)
        for (int i = 0; i < cells(0); ++i)
          add_square(i, j);
    else
      for (int k = 0; k < cells(2); ++k)
        for (int j = 0; j < cells(1); ++j)
          for (int i = 0; i < cells(0); ++i)
            add_cube(i, j, k);
    Group &body = mesh.groups["body"];
    body.dim = mesh.dim;
    body.entities = mesh.cells;
    for (Index c = 0; c < mesh.cells.size(); ++c)
      body.cells.push_back(c);
  }

  [[nodiscard]] std::vector<std::vector<int>> facets_of_cell() const
  {
    switch (block.shape)
    {
    case CellShape::triangle:
      return {{0, 1}, {1, 2}, {2, 0}};
    case CellShape::quadrilateral:
      return {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    case CellShape::tetrahedron:
      return {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
    default:
      return {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    }
  }

  void add_facet_groups()
  {
    std::map<std::vector<Index>, std::pair<int, std::vector<Index>>> count;
    for (Index c = 0; c < mesh.cells.size(); ++c)
      for (const auto &local : facets_of_cell())
      {
        std::vector<Index> nodes;
        for (const int a : local)
          nodes.push_back(mesh.cells[c][a]);
        std::vector<Index> key = nodes;
        std::sort(key.begin(), key.end());
        ++count[key].first;
        count[key].second = nodes;
      }
    const std::array<std::string, 6> names{"left", "right", "bottom", "top", "back", "front"};
    for (int d = 0; d < 2 * mesh.dim; ++d)
      mesh.groups[names[d]].dim = mesh.dim - 1;
    mesh.groups["boundary"].dim = mesh.dim - 1;
    bool turn = false;
    for (auto &[key, facet] : count)
    {
      if (facet.first != 1)
        continue;
      if (turn = !turn; turn)
        std::reverse(facet.second.begin(), facet.second.end());
      mesh.groups["boundary"].entities.push_back(facet.second);
      for (int d = 0; d < 2 * mesh.dim; ++d)
        if (std::all_of(key.begin(), key.end(), [&](Index a) { return std::abs(unit[a][d / 2] - d % 2) < 1e-9; }))
          mesh.groups[names[d]].entities.push_back(facet.second);
    }
    mesh.groups["corner"].entities.push_back(std::vector<Index>{0});
  }
};
} // namespace

Mesh BlockMesh::make() const
{
  Builder builder{*this, {}, {}};
  builder.mesh.file = "block.msh";
  builder.mesh.dim = shape == CellShape::triangle || shape == CellShape::quadrilateral ? 2 : 3;
  builder.add_nodes();
  builder.add_cells();
  builder.add_facet_groups();
  return builder.mesh;
}

Eigen::SparseMatrix<double> global_matrix(const Mesh &mesh, const BodyAssembly &assembly)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (const SubdomainMatrix &matrix : assembly.subdomains())
  {
    const int dim = matrix.n_components;
    const auto global = [&](Index local) { return matrix.nodes[local / dim] * dim + local % dim; };
    for (Index row = 0; row < matrix.n_rows(); ++row)
      for (Index k = matrix.row_ptr[row]; k < matrix.row_ptr[row + 1]; ++k)
        entries.emplace_back(global(row), global(matrix.col[k]), matrix.values[k]);
  }
  const auto n = static_cast<Eigen::Index>(mesh.points.size());
  Eigen::SparseMatrix<double> K(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

int solve(const Mesh &mesh, BodyAssembly &assembly, const std::vector<bool> &held, double time, std::vector<double> &u)
{
  std::vector<double> internal(u.size()), external(u.size());
  for (int iteration = 0; iteration < 30; ++iteration)
  {
    if (!assembly.assemble_tangent(u, time) || !assembly.forces(u, time, internal, external))
      return -1;
    Eigen::VectorXd rhs(static_cast<Eigen::Index>(u.size()));
    double scale = 0;
    for (std::size_t i = 0; i < u.size(); ++i)
    {
      rhs[static_cast<Eigen::Index>(i)] = held[i] ? 0 : external[i] - internal[i];
      scale = std::max(scale, std::abs(internal[i]));
    }
    if (iteration > 0 && rhs.lpNorm<Eigen::Infinity>() <= 1e-13 * scale)
      return iteration;
    Eigen::SparseMatrix<double> K = global_matrix(mesh, assembly);
    K.prune([&](Eigen::Index i, Eigen::Index j, double) { return i == j || (!held[i] && !held[j]); });
    Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(K);
    if (solver.info() != Eigen::Success)
      return -1;
    const Eigen::VectorXd du = solver.solve(rhs);
    double largest = 0;
    for (std::size_t i = 0; i < u.size(); ++i)
    {
      u[i] += du[static_cast<Eigen::Index>(i)];
      largest = std::max(largest, std::abs(u[i]));
    }
    if (iteration > 0 && du.lpNorm<Eigen::Infinity>() <= 1e-8 * largest) // the next would be of the size of its square
      return iteration;
  }
  return -1;
}

std::vector<bool> hold(const Mesh &mesh, const std::vector<int> &components,
                       const std::function<bool(const Eigen::Vector3d &)> &on)
{
  std::vector<bool> held(mesh.points.size(), false);
  for (Index node = 0; node < mesh.n_nodes(); ++node)
    if (on(point_of(mesh.points, mesh.dim, node)))
      for (const int c : components)
        held[node * mesh.dim + c] = true;
  return held;
}

std::vector<bool> boundary_nodes(const Mesh &mesh)
{
  std::vector<bool> held(mesh.points.size(), false);
  for (const Index node : mesh.groups.at("boundary").entities.nodes)
    for (int c = 0; c < mesh.dim; ++c)
      held[node * mesh.dim + c] = true;
  return held;
}

std::vector<double> nodal_field(const Mesh &mesh, const std::function<Eigen::Vector3d(const Eigen::Vector3d &)> &field)
{
  std::vector<double> values;
  for (Index node = 0; node < mesh.n_nodes(); ++node)
  {
    const Eigen::Vector3d v = field(point_of(mesh.points, mesh.dim, node));
    values.insert(values.end(), v.data(), v.data() + mesh.dim);
  }
  return values;
}
} // namespace amontons
