#include "amontons/bulk/partition.h"

#include "amontons/bulk/bisection.h"

#include <metis.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace amontons
{
namespace
{
/// Parts below this share of the wanted size are joined to a neighbour.
constexpr double least_share = 0.25;

/// Local nodes of the facets of a cell, corners only.
std::vector<std::vector<int>> local_facets(CellShape shape)
{
  switch (shape)
  {
  case CellShape::triangle:
    return {{0, 1}, {1, 2}, {2, 0}};
  case CellShape::quadrilateral:
    return {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  case CellShape::tetrahedron:
    return {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}};
  case CellShape::hexahedron:
    return {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  default:
    return {};
  }
}

/// Deformable body of each cell, -1 for none.
std::vector<Index> deformable_bodies(const Mesh &mesh, const std::vector<BodyOptions> &bodies)
{
  std::vector<Index> out(static_cast<std::size_t>(mesh.cells.size()), -1);
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].material.law != MaterialLaw::rigid)
      for (const Index c : find_group(mesh, bodies[b].region, mesh.dim, bodies[b].where).cells)
        out[c] = static_cast<Index>(b);
  return out;
}

/// Cells of the same body that share a facet with each cell.
Connectivity facet_neighbours(const Mesh &mesh, const std::vector<Index> &body_of_cell)
{
  struct Facet
  {
    std::array<Index, 4> nodes;
    Index cell;
  };
  std::vector<Facet> facets;
  for (Index c = 0; c < mesh.cells.size(); ++c)
    if (body_of_cell[c] >= 0)
      for (const std::vector<int> &local : local_facets(cell_shape(mesh.dim, mesh.cells[c].size())))
      {
        Facet facet{{-1, -1, -1, -1}, c};
        std::transform(local.begin(), local.end(), facet.nodes.begin(), [&](int a) { return mesh.cells[c][a]; });
        std::sort(facet.nodes.begin(), facet.nodes.end());
        facets.push_back(facet);
      }
  std::sort(facets.begin(), facets.end(),
            [](const Facet &a, const Facet &b) { return std::tie(a.nodes, a.cell) < std::tie(b.nodes, b.cell); });
  std::vector<std::vector<Index>> neighbours(body_of_cell.size());
  for (std::size_t k = 1; k < facets.size(); ++k)
    if (const Facet &a = facets[k - 1], &b = facets[k];
        a.nodes == b.nodes && body_of_cell[a.cell] == body_of_cell[b.cell])
    {
      neighbours[a.cell].push_back(b.cell);
      neighbours[b.cell].push_back(a.cell);
    }
  Connectivity out;
  for (const std::vector<Index> &row : neighbours)
    out.push_back(row);
  return out;
}

/// Sets of cells of one colour that hang together, as a new colour of each cell; -1 stays.
std::vector<Index> connected_parts(const Connectivity &neighbours, const std::vector<Index> &colour, Index &n_parts)
{
  std::vector<Index> part(colour.size(), -1), front;
  n_parts = 0;
  for (std::size_t seed = 0; seed < colour.size(); ++seed)
  {
    if (colour[seed] < 0 || part[seed] >= 0)
      continue;
    part[seed] = n_parts;
    front.assign(1, static_cast<Index>(seed));
    while (!front.empty())
    {
      const Index cell = front.back();
      front.pop_back();
      for (const Index other : neighbours[cell])
        if (colour[other] == colour[cell] && part[other] < 0)
        {
          part[other] = n_parts;
          front.push_back(other);
        }
    }
    ++n_parts;
  }
  return part;
}

std::vector<std::vector<Index>> cells_of_parts(const std::vector<Index> &part, Index n_parts)
{
  std::vector<std::vector<Index>> cells(static_cast<std::size_t>(n_parts));
  for (std::size_t c = 0; c < part.size(); ++c)
    if (part[c] >= 0)
      cells[part[c]].push_back(static_cast<Index>(c));
  return cells;
}

/// Graph of some cells alone, in METIS's form.
struct CellGraph
{
  CellGraph(const Connectivity &neighbours, const std::vector<Index> &cells)
  {
    std::vector<idx_t> local(static_cast<std::size_t>(neighbours.size()), -1);
    for (std::size_t k = 0; k < cells.size(); ++k)
      local[cells[k]] = static_cast<idx_t>(k);
    for (const Index cell : cells)
    {
      for (const Index other : neighbours[cell])
        if (local[other] >= 0)
          adjacent.push_back(local[other]);
      offsets.push_back(static_cast<idx_t>(adjacent.size()));
    }
  }

  [[nodiscard]] idx_t size() const { return static_cast<idx_t>(offsets.size()) - 1; }
  /// Pairs of neighbours in different parts, each counted twice.
  [[nodiscard]] std::size_t cut(const std::vector<Index> &part) const
  {
    std::size_t n = 0;
    for (idx_t k = 0; k < size(); ++k)
      n += static_cast<std::size_t>(std::count_if(adjacent.begin() + offsets[k], adjacent.begin() + offsets[k + 1],
                                                  [&](idx_t other) { return part[other] != part[k]; }));
    return n;
  }

  std::vector<idx_t> offsets{0}, adjacent;
};

std::vector<Index> divide_by_metis(CellGraph &graph, Index n)
{
  std::array<idx_t, METIS_NOPTIONS> options;
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  std::vector<idx_t> out(static_cast<std::size_t>(graph.size()));
  idx_t n_cells = graph.size(), n_constraints = 1, n_parts = n, cut = 0;
  if (METIS_PartGraphKway(&n_cells, &n_constraints, graph.offsets.data(), graph.adjacent.data(), nullptr, nullptr,
                          nullptr, &n_parts, nullptr, nullptr, options.data(), &cut, out.data()) != METIS_OK)
    throw InternalError("METIS could not divide " + std::to_string(n_cells) + " cells into " + std::to_string(n));
  return {out.begin(), out.end()};
}

/// Divides connected cells into n parts: colours first, first + 1, ... Flat cuts where the mesh lies in layers, METIS
/// where it does not: whichever cuts fewer facets.
void divide(const Mesh &mesh, const Connectivity &neighbours, const std::vector<Index> &cells, Index n, Index first,
            std::vector<Index> &colour)
{
  CellGraph graph(neighbours, cells);
  std::vector<Index> part = bisect_cells(mesh, cells, n);
  if (std::vector<Index> other = divide_by_metis(graph, n); graph.cut(other) < graph.cut(part))
    part = std::move(other);
  for (std::size_t k = 0; k < cells.size(); ++k)
    colour[cells[k]] = first + part[k];
}

/// Joins parts of fewer cells than `least` to the neighbour they share most facets with.
void join_small(const Connectivity &neighbours, std::vector<Index> &part, Index n_parts, std::size_t least)
{
  std::vector<std::vector<Index>> cells = cells_of_parts(part, n_parts);
  for (Index p = 0; p < n_parts; ++p)
  {
    if (cells[p].size() >= least)
      continue;
    std::map<Index, int> shared;
    for (const Index cell : cells[p])
      for (const Index other : neighbours[cell])
        if (part[other] != p)
          ++shared[part[other]];
    if (shared.empty())
      continue;
    const Index to =
        std::max_element(shared.begin(), shared.end(), [](const auto &a, const auto &b) { return a.second < b.second; })
            ->first;
    for (const Index cell : cells[p])
      part[cell] = to;
    cells[to].insert(cells[to].end(), cells[p].begin(), cells[p].end());
    cells[p].clear();
  }
}

/// Unknowns of n cells cut out as a lump: of the cells, and of one layer of nodes more along each axis.
Index cells_for(const Mesh &mesh, const std::vector<Index> &cells, int n_unknowns)
{
  std::vector<Index> nodes;
  for (const Index c : cells)
    nodes.insert(nodes.end(), mesh.cells[c].begin(), mesh.cells[c].end());
  std::sort(nodes.begin(), nodes.end());
  const auto n_nodes = std::unique(nodes.begin(), nodes.end()) - nodes.begin();
  const double nodes_per_cell = std::min(1., static_cast<double>(n_nodes) / static_cast<double>(cells.size()));
  const double along_axis = std::pow(static_cast<double>(n_unknowns) / mesh.dim, 1.0 / mesh.dim);
  return std::max<Index>(1, static_cast<Index>(std::pow(std::max(along_axis - 1, 1.), mesh.dim) / nodes_per_cell));
}
} // namespace

std::vector<Index> partition_cells(const Mesh &mesh, const std::vector<BodyOptions> &bodies, int n_unknowns)
{
  const std::vector<Index> body = deformable_bodies(mesh, bodies);
  const Connectivity neighbours = facet_neighbours(mesh, body);
  Index n_whole = 0, n_colours = 0;
  const std::vector<Index> whole = connected_parts(neighbours, body, n_whole);
  std::vector<Index> colour(body.size(), -1);
  std::size_t least = 0;
  for (const std::vector<Index> &cells : cells_of_parts(whole, n_whole))
  {
    const Index wanted = cells_for(mesh, cells, n_unknowns);
    const Index n = std::max<Index>(1, (static_cast<Index>(cells.size()) + wanted / 2) / wanted);
    least = std::max(least, static_cast<std::size_t>(least_share * wanted));
    if (n > 1)
      divide(mesh, neighbours, cells, n, n_colours, colour);
    else
      for (const Index c : cells)
        colour[c] = n_colours;
    n_colours += n;
  }
  Index n_parts = 0;
  std::vector<Index> part = connected_parts(neighbours, colour, n_parts);
  join_small(neighbours, part, n_parts, least);
  part = connected_parts(neighbours, part, n_parts);
  for (Index &p : part)
    p = std::max(p, 0);
  return part;
}
} // namespace amontons
