#pragma once
#include "amontons/base/ids.h"
#include "amontons/bulk/options.h"
#include "amontons/surface/surface.h"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace amontons
{
enum class CellShape : unsigned char
{
  segment,
  triangle,
  quadrilateral,
  tetrahedron,
  hexahedron
};

/// Cells or facets of one kind of dimension, one after another: entity e has the nodes
/// `nodes[offsets[e] .. offsets[e+1])` in the order of Gmsh and VTK.
struct Connectivity
{
  std::vector<Index> offsets{0};
  std::vector<Index> nodes;

  [[nodiscard]] Index size() const { return static_cast<Index>(offsets.size()) - 1; }
  [[nodiscard]] std::span<const Index> operator[](Index e) const
  {
    return {nodes.data() + offsets[e], static_cast<std::size_t>(offsets[e + 1] - offsets[e])};
  }
  void push_back(std::span<const Index> entity)
  {
    nodes.insert(nodes.end(), entity.begin(), entity.end());
    offsets.push_back(static_cast<Index>(nodes.size()));
  }
};

/// Shape of a cell or facet from its dimension and its number of nodes.
CellShape cell_shape(int dim, std::size_t n_nodes);

/// "points", "curves", "surfaces" or "volumes", as Gmsh calls physical groups of dimension 0 to 3.
std::string dimension_word(int dim);

/// A physical group of the mesh file.
struct Group
{
  int dim = 0;                    ///< 0 points, 1 curves, 2 surfaces, 3 volumes
  Connectivity entities;          ///< cells, facets, edges or points of the group
  std::vector<Index> cells;       ///< for dim == Mesh::dim: positions in Mesh::cells, in the order of `entities`
  std::vector<Index> other_nodes; ///< nodes of entities that other processes have

  /// Its nodes that are in the mesh, each once, in the order of the mesh.
  [[nodiscard]] std::vector<Index> nodes() const;
};

/// The mesh, or what a process has of it (mesh_distribution.h): degree 1, right-handed cells. Of the mesh as read only
/// nodes of some cell or named group are kept, by increasing tag; cells are those of the named groups of dimension
/// `dim`, each once.
struct Mesh
{
  int dim = 2;
  std::vector<double> points;         ///< [n_nodes * dim], reference coordinates
  std::vector<GlobalIndex> node_tags; ///< [n_nodes], numbers in the mesh file, for messages and outputs
  Connectivity cells;                 ///< cells of dimension dim
  std::vector<GlobalIndex> cell_tags; ///< [n_cells]
  std::map<std::string, Group> groups;
  std::string file;
  std::vector<GlobalIndex> node_ids; ///< [n_nodes], positions in the whole mesh
  std::vector<GlobalIndex> cell_ids; ///< [n_cells], the same
  GlobalIndex n_global_nodes = 0, n_global_cells = 0;

  [[nodiscard]] Index n_nodes() const { return static_cast<Index>(node_tags.size()); }
};

/// The mesh is the whole. Makes its ids.
void number_whole(Mesh &mesh);

/// Reads a .msh (2.2 or 4.1, ASCII or binary) or meshes a .geo with the given parameters, then refines: each cell into
/// 2^dim of its shape; new nodes lie on the curved geometry of a .geo, midway between the old ones of a .msh.
/// Physical groups without a name are passed over. Coordinates that leave the plane, or the axisymmetric half-plane, by
/// round-off only (1e-10 of the mesh's size) are put on it. The same input gives the same mesh. Local.
/// @throws UserError: unreadable file, a parameter that the .geo does not declare, no named group or two of one name,
///         cells of a degree above 1 or of a shape not known or of the wrong dimension, inverted or degenerate cells
///         (clockwise 2D cells are turned, not refused), NaN coordinates, negative radius in axisymmetry.
Mesh read_mesh(const MeshOptions &options);

/// Facets of a physical group as a contact surface, oriented outwards from the cells they bound. node_ids are node
/// indices of the mesh, face_ids positions in the group.
///        A facet that bounds no cell keeps the orientation of the file (rigid surfaces meshed without volume).
/// @throws UserError: no such group (with what was probably meant), wrong dimension, a facet between two cells.
Surface extract_surface(const Mesh &mesh, const std::string &group, const SourceLocation &where);

/// The group of that name, or a UserError that lists the groups of dimension `dim` and the likeliest.
/// @param dim required dimension, or -1 for any.
const Group &find_group(const Mesh &mesh, const std::string &name, int dim, const SourceLocation &where);
} // namespace amontons
