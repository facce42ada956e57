#include "amontons/bulk/mesh_refinement.h"

#include <algorithm>
#include <array>

namespace amontons
{
namespace
{
/// Nodes of the finer mesh: old ones first, then one for the middle of each set of corners asked for.
class Midpoints
{
public:
  explicit Midpoints(Mesh &mesh)
    : mesh_(mesh)
    , next_tag_(mesh.node_tags.empty() ? 1 : *std::max_element(mesh.node_tags.begin(), mesh.node_tags.end()) + 1)
  {
  }

  /// Node in the middle of the corners: the same for the same corners in any order.
  Index operator()(std::span<const Index> corners)
  {
    Corners key;
    key.fill(-1);
    std::copy(corners.begin(), corners.end(), key.begin());
    std::sort(key.begin(), key.begin() + static_cast<std::ptrdiff_t>(corners.size()));
    const auto [found, is_new] = nodes_.try_emplace(key, mesh_.n_nodes());
    if (is_new)
      append(key, corners.size());
    return found->second;
  }

private:
  using Corners = std::array<Index, 8>;

  /// Summed in the order of `key`, so that the sum does not depend on which cell asks.
  void append(const Corners &key, std::size_t n_corners)
  {
    for (int c = 0; c < mesh_.dim; ++c)
    {
      double sum = 0;
      for (std::size_t i = 0; i < n_corners; ++i)
        sum += mesh_.points[static_cast<std::size_t>(key[i]) * mesh_.dim + c];
      mesh_.points.push_back(sum / static_cast<double>(n_corners));
    }
    mesh_.node_tags.push_back(next_tag_++);
  }

  Mesh &mesh_;
  GlobalIndex next_tag_;
  std::map<Corners, Index> nodes_;
};

double squared_distance(const Mesh &mesh, Index a, Index b)
{
  double sum = 0;
  for (int c = 0; c < mesh.dim; ++c)
  {
    const double d = mesh.points[static_cast<std::size_t>(a) * mesh.dim + c] -
                     mesh.points[static_cast<std::size_t>(b) * mesh.dim + c];
    sum += d * d;
  }
  return sum;
}

void split_triangle(std::span<const Index> n, Midpoints &middle, Connectivity &out)
{
  const Index a = middle({{n[0], n[1]}}), b = middle({{n[1], n[2]}}), c = middle({{n[2], n[0]}});
  for (const std::array<Index, 3> &child :
       {std::array{n[0], a, c}, std::array{a, n[1], b}, std::array{c, b, n[2]}, std::array{a, b, c}})
    out.push_back(child);
}

void split_tetrahedron(const Mesh &mesh, std::span<const Index> n, Midpoints &middle, Connectivity &out)
{
  const auto m = [&](int i, int j) { return middle({{n[i], n[j]}}); };
  const Index m01 = m(0, 1), m02 = m(0, 2), m03 = m(0, 3), m12 = m(1, 2), m13 = m(1, 3), m23 = m(2, 3);
  for (const std::array<Index, 4> &corner : {std::array{n[0], m01, m02, m03}, std::array{m01, n[1], m12, m13},
                                             std::array{m02, m12, n[2], m23}, std::array{m03, m13, m23, n[3]}})
    out.push_back(corner);
  // Each diagonal with the ring of the other four midpoints, right-handed about the diagonal from first to second.
  struct Diagonal
  {
    std::array<Index, 2> ends;
    std::array<Index, 4> ring;
  };
  const std::array<Diagonal, 3> diagonals{
      {{{m01, m23}, {m02, m12, m13, m03}}, {{m02, m13}, {m01, m03, m23, m12}}, {{m03, m12}, {m01, m13, m23, m02}}}};
  const auto length = [&](const Diagonal &d) { return squared_distance(mesh, d.ends[0], d.ends[1]); };
  const Diagonal &shortest = *std::min_element(
      diagonals.begin(), diagonals.end(), [&](const Diagonal &a, const Diagonal &b) { return length(a) < length(b); });
  for (int i = 0; i < 4; ++i)
    out.push_back(std::array{shortest.ends[0], shortest.ring[(i + 1) % 4], shortest.ring[i], shortest.ends[1]});
}

/// Children of the quadrilateral or hexahedron: the cells of the lattice of 3^dim nodes.
void split_lattice(int dim, std::span<const Index> n, Midpoints &middle, Connectivity &out)
{
  static constexpr std::array<std::array<int, 3>, 8> vertex{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  // Lattice coordinate 0 and 2: the vertex's side; 1: both sides.
  const auto node = [&](const std::array<int, 3> &at)
  {
    std::array<Index, 8> corners{};
    std::size_t n_corners = 0;
    for (std::size_t v = 0; v < n.size(); ++v)
      if (std::equal(at.begin(), at.begin() + dim, vertex[v].begin(),
                     [](int place, int side) { return place == 1 || place == 2 * side; }))
        corners[n_corners++] = n[v];
    return n_corners == 1 ? corners[0] : middle({corners.data(), n_corners});
  };
  for (std::size_t child = 0; child < n.size(); ++child)
  {
    std::array<Index, 8> nodes{};
    for (std::size_t v = 0; v < n.size(); ++v)
      nodes[v] =
          node({vertex[child][0] + vertex[v][0], vertex[child][1] + vertex[v][1], vertex[child][2] + vertex[v][2]});
    out.push_back({nodes.data(), n.size()});
  }
}

Connectivity split(const Mesh &mesh, int dim, const Connectivity &entities, Midpoints &middle)
{
  if (dim == 0)
    return entities;
  Connectivity out;
  for (Index e = 0; e < entities.size(); ++e)
  {
    const std::span<const Index> nodes = entities[e];
    switch (cell_shape(dim, nodes.size()))
    {
    case CellShape::segment:
      out.push_back(std::array{nodes[0], middle(nodes)});
      out.push_back(std::array{middle(nodes), nodes[1]});
      break;
    case CellShape::triangle:
      split_triangle(nodes, middle, out);
      break;
    case CellShape::tetrahedron:
      split_tetrahedron(mesh, nodes, middle, out);
      break;
    case CellShape::quadrilateral:
    case CellShape::hexahedron:
      split_lattice(dim, nodes, middle, out);
      break;
    }
  }
  return out;
}
} // namespace

void refine_uniformly(Mesh &mesh)
{
  Midpoints middle(mesh);
  mesh.cells = split(mesh, mesh.dim, mesh.cells, middle);
  mesh.cell_tags.resize(static_cast<std::size_t>(mesh.cells.size()));
  for (std::size_t c = 0; c < mesh.cell_tags.size(); ++c)
    mesh.cell_tags[c] = static_cast<GlobalIndex>(c) + 1;
  const Index n_children = 1 << mesh.dim;
  for (auto &[name, group] : mesh.groups)
  {
    group.entities = split(mesh, group.dim, group.entities, middle);
    std::vector<Index> children;
    for (const Index parent : group.cells)
      for (Index child = 0; child < n_children; ++child)
        children.push_back(parent * n_children + child);
    group.cells = std::move(children);
  }
}
} // namespace amontons
