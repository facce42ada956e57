#include "amontons/bulk/cell_pattern.h"

#include <algorithm>
#include <limits>

namespace amontons
{
namespace
{
/// Cells of each subdomain, ascending.
std::vector<std::vector<Index>> cells_by_subdomain(const Mesh &mesh, const std::vector<bool> &taken,
                                                   std::span<const Index> subdomain_of_cell)
{
  Index n_subdomains = 1;
  for (const Index s : subdomain_of_cell)
    n_subdomains = std::max(n_subdomains, s + 1);
  std::vector<std::vector<Index>> cells(static_cast<std::size_t>(n_subdomains));
  for (Index c = 0; c < mesh.cells.size(); ++c)
    if (taken[c])
      cells[subdomain_of_cell.empty() ? 0 : subdomain_of_cell[c]].push_back(c);
  return cells;
}

/// Local nodes that share a cell with each local node, itself included, ascending.
Connectivity neighbours(const Mesh &mesh, std::span<const Index> cells, std::span<const Index> local_of_node,
                        std::size_t n_local)
{
  std::vector<std::vector<Index>> cells_of(n_local);
  for (const Index c : cells)
    for (const Index node : mesh.cells[c])
      cells_of[local_of_node[node]].push_back(c);
  Connectivity out;
  std::vector<Index> row;
  std::vector<Index> seen_by(n_local, -1);
  for (std::size_t a = 0; a < n_local; ++a)
  {
    row.clear();
    for (const Index c : cells_of[a])
      for (const Index node : mesh.cells[c])
      {
        const Index b = local_of_node[node];
        if (seen_by[b] != static_cast<Index>(a))
          row.push_back(b);
        seen_by[b] = static_cast<Index>(a);
      }
    std::sort(row.begin(), row.end());
    out.push_back(row);
  }
  return out;
}

void expand(const Connectivity &rows, int dim, SubdomainMatrix &matrix)
{
  const std::size_t n_entries = rows.nodes.size() * dim * dim;
  if (n_entries > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw UserError("the stiffness of one subdomain has " + std::to_string(n_entries) +
                    " entries, more than an index of 32 bits can count: take more subdomains");
  matrix.n_components = dim;
  matrix.row_ptr.assign(1, 0);
  matrix.col.reserve(n_entries);
  for (Index a = 0; a < rows.size(); ++a)
    for (int i = 0; i < dim; ++i)
    {
      for (const Index b : rows[a])
        for (int k = 0; k < dim; ++k)
          matrix.col.push_back(b * dim + k);
      matrix.row_ptr.push_back(static_cast<Index>(matrix.col.size()));
    }
  matrix.values.assign(n_entries, 0);
}
} // namespace

std::vector<SubdomainMatrix> make_patterns(const Mesh &mesh, const std::vector<bool> &taken,
                                           std::span<const Index> subdomain_of_cell)
{
  AMONTONS_ASSERT(subdomain_of_cell.empty() || static_cast<Index>(subdomain_of_cell.size()) == mesh.cells.size());
  std::vector<SubdomainMatrix> matrices;
  std::vector<Index> local_of_node(static_cast<std::size_t>(mesh.n_nodes()), -1);
  for (const std::vector<Index> &cells : cells_by_subdomain(mesh, taken, subdomain_of_cell))
  {
    SubdomainMatrix &matrix = matrices.emplace_back();
    for (const Index c : cells)
      for (const Index node : mesh.cells[c])
      {
        if (local_of_node[node] < 0)
          matrix.nodes.push_back(node);
        local_of_node[node] = 0;
      }
    std::sort(matrix.nodes.begin(), matrix.nodes.end());
    for (std::size_t a = 0; a < matrix.nodes.size(); ++a)
      local_of_node[matrix.nodes[a]] = static_cast<Index>(a);
    expand(neighbours(mesh, cells, local_of_node, matrix.nodes.size()), mesh.dim, matrix);
    for (const Index node : matrix.nodes)
      local_of_node[node] = -1;
  }
  return matrices;
}

BlockPositions::BlockPositions(const SubdomainMatrix &matrix, std::span<const Index> nodes, int n_entity_nodes)
{
  const int dim = matrix.n_components;
  std::vector<Index> local;
  for (const Index node : nodes)
  {
    const auto found = std::lower_bound(matrix.nodes.begin(), matrix.nodes.end(), node);
    AMONTONS_ASSERT(found != matrix.nodes.end() && *found == node);
    local.push_back(static_cast<Index>(found - matrix.nodes.begin()));
    rows_.push_back(local.back() * dim);
  }
  columns_.reserve(local.size() * n_entity_nodes);
  for (std::size_t first = 0; first < local.size(); first += n_entity_nodes)
    for (int a = 0; a < n_entity_nodes; ++a)
      for (int b = 0; b < n_entity_nodes; ++b)
      {
        const auto begin = matrix.col.begin() + matrix.row_ptr[rows_[first + a]];
        const auto end = matrix.col.begin() + matrix.row_ptr[rows_[first + a] + 1];
        const auto found = std::lower_bound(begin, end, local[first + b] * dim);
        AMONTONS_ASSERT(found != end && *found == local[first + b] * dim);
        AMONTONS_ASSERT(found - begin <= std::numeric_limits<std::uint16_t>::max());
        columns_.push_back(static_cast<std::uint16_t>(found - begin));
      }
}
} // namespace amontons
