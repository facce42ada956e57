#pragma once
#include "amontons/bulk/mesh.h"
#include "amontons/parallel/message_exchange.h"

#include <span>
#include <vector>

namespace amontons
{
/// What one process has of the problem's mesh.
///
/// Its nodes are, in this order: those that every process has (of rigid bodies, for one; they have the same positions
/// everywhere), then those of its own cells, each part in the order of the whole mesh. An entity of a group of lower
/// dimension, and a contact surface's face, is where the first deformable cell is that has all its nodes; what belongs
/// to no such cell is on process 0.
struct MeshPart
{
  Mesh mesh;
  std::vector<Index> subdomain_of_cell; ///< [n_cells], 0 .. n-1; empty: one subdomain
  /// Of each contact surface the process's faces, and all nodes that it has. Ids are positions in the whole mesh.
  std::vector<Surface> surfaces;
  std::vector<Surface> whole_surfaces; ///< that every process has all of
};

/// Which process shall have each cell: subdomains (cells, where there are none) in connected lumps of about equal
/// numbers of cells (METIS). Local. @param subdomain_of_cell empty or [n_cells]
/// @param is_rigid [n_cells] cells of rigid bodies, which go to process 0
/// @throws UserError if there are fewer subdomains, or cells, than processes
std::vector<Rank> processes_of_cells(const Mesh &mesh, std::span<const Index> subdomain_of_cell,
                                     const std::vector<bool> &is_rigid, int n_processes);

/// Gives each process its part. Collective.
/// @param whole on process 0; elsewhere not looked at
/// @param process_of_cell, is_rigid [n_cells] on process 0
/// @param everywhere positions in the whole mesh of nodes that all are to have
MeshPart distribute(MessageExchange &messages, const MeshPart &whole, std::span<const Rank> process_of_cell,
                    const std::vector<bool> &is_rigid, std::span<const Index> everywhere);
} // namespace amontons
