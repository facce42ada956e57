#include "amontons/base/error.h"
#include "amontons/bulk/mesh_distribution.h"

#include <metis.h>

#include <algorithm>
#include <array>

namespace amontons
{
namespace
{
/// Units that have common nodes, in METIS's form, with the number of nodes as weight and that of cells as size.
struct UnitGraph
{
  std::vector<idx_t> offsets{0}, adjacent, common, sizes;
};

UnitGraph graph_of(const Mesh &mesh, std::span<const Index> unit_of_cell, Index n_units)
{
  std::vector<std::vector<Index>> units_of_node(static_cast<std::size_t>(mesh.n_nodes())),
      nodes_of_unit(static_cast<std::size_t>(n_units));
  UnitGraph graph;
  graph.sizes.assign(static_cast<std::size_t>(n_units), 0);
  for (Index cell = 0; cell < mesh.cells.size(); ++cell)
  {
    const Index unit = unit_of_cell[cell];
    if (unit < 0)
      continue;
    ++graph.sizes[unit];
    for (const Index node : mesh.cells[cell])
      if (auto &units = units_of_node[node]; std::find(units.begin(), units.end(), unit) == units.end())
      {
        units.push_back(unit);
        nodes_of_unit[unit].push_back(node);
      }
  }
  std::vector<Index> others;
  for (Index unit = 0; unit < n_units; ++unit)
  {
    others.clear();
    for (const Index node : nodes_of_unit[unit])
      for (const Index other : units_of_node[node])
        if (other != unit)
          others.push_back(other);
    std::sort(others.begin(), others.end());
    for (std::size_t k = 0; k < others.size(); ++k)
      if (k == 0 || others[k] != others[k - 1])
      {
        graph.adjacent.push_back(others[k]);
        graph.common.push_back(1);
      }
      else
        ++graph.common.back();
    graph.offsets.push_back(static_cast<idx_t>(graph.adjacent.size()));
  }
  return graph;
}
} // namespace

std::vector<Rank> processes_of_cells(const Mesh &mesh, std::span<const Index> subdomain_of_cell,
                                     const std::vector<bool> &is_rigid, int n_processes)
{
  std::vector<Index> unit(static_cast<std::size_t>(mesh.cells.size()), -1);
  Index n_units = 0;
  for (Index cell = 0; cell < mesh.cells.size(); ++cell)
    if (!is_rigid[cell])
    {
      unit[cell] = subdomain_of_cell.empty() ? n_units : subdomain_of_cell[cell];
      n_units = std::max(n_units, unit[cell] + 1);
    }
  if (n_units < n_processes)
    throw UserError("the mesh has " + std::to_string(n_units) +
                    (subdomain_of_cell.empty() ? " deformable cells" : " subdomains") + " for " +
                    std::to_string(n_processes) + " processes; take fewer");
  UnitGraph graph = graph_of(mesh, unit, n_units);
  std::array<idx_t, METIS_NOPTIONS> options;
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  idx_t n = n_units, n_constraints = 1, n_parts = n_processes, cut = 0;
  std::vector<idx_t> part(static_cast<std::size_t>(n_units), 0);
  if (n_processes > 1 && METIS_PartGraphRecursive(&n, &n_constraints, graph.offsets.data(), graph.adjacent.data(),
                                                  graph.sizes.data(), nullptr, graph.common.data(), &n_parts, nullptr,
                                                  nullptr, options.data(), &cut, part.data()) != METIS_OK)
    throw InternalError("METIS could not divide the mesh among " + std::to_string(n_processes) + " processes");
  std::vector<Index> n_units_of(static_cast<std::size_t>(n_processes), 0);
  for (const idx_t p : part)
    ++n_units_of[p];
  if (std::find(n_units_of.begin(), n_units_of.end(), 0) != n_units_of.end()) // METIS is no help with few units
    for (Index u = 0; u < n_units; ++u)
      part[u] = static_cast<idx_t>(static_cast<GlobalIndex>(u) * n_processes / n_units);
  std::vector<Rank> out(unit.size(), 0);
  for (std::size_t cell = 0; cell < unit.size(); ++cell)
    if (unit[cell] >= 0)
      out[cell] = static_cast<Rank>(part[unit[cell]]);
  return out;
}
} // namespace amontons
