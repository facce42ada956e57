#include "amontons/base/suggestion.h"
#include "amontons/bulk/gmsh_session.h"
#include "amontons/bulk/mesh.h"
#include "amontons/bulk/mesh_check.h"
#include "amontons/bulk/mesh_refinement.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>

namespace amontons
{
namespace
{
using RawNodes = std::vector<std::pair<GlobalIndex, std::array<double, 3>>>;

/// How far out of the plane, relative to the mesh's size, a coordinate counts as round-off.
constexpr double round_off = 1e-10;

bool is_geometry(const MeshOptions &options)
{
  return std::filesystem::path(options.file).extension() == ".geo";
}

void check_parameters(const MeshOptions &options)
{
  if (options.parameters.empty())
    return;
  if (!is_geometry(options))
    throw std::runtime_error("is a mesh, which takes no parameters; a .geo does");
  const std::vector<std::string> declared = geo_parameters(options.file);
  for (const auto &[name, value] : options.parameters)
    if (std::find(declared.begin(), declared.end(), name) == declared.end())
      throw std::runtime_error("has no parameter '" + name + "'" + did_you_mean(name, declared) +
                               (declared.empty() ? "; it declares none with DefineConstant[...]"
                                                 : "; declared with DefineConstant[...]: " + joined(declared)));
}

void check_file(const MeshOptions &options)
{
  const std::filesystem::path path(options.file);
  if (path.extension() != ".msh" && path.extension() != ".geo")
    throw std::runtime_error("is neither a .msh nor a .geo");
  if (!std::filesystem::is_regular_file(path))
    throw std::runtime_error("no such file");
}

/// Groups and cells with node *tags* still kept apart from the mesh, whose connectivity wants positions.
class MeshBuilder
{
public:
  MeshBuilder(Mesh &mesh, const GmshSession &session, const std::map<std::string, GmshSession::PhysicalGroup> &groups)
    : mesh_(mesh)
    , session_(session)
    , groups_(groups)
  {
    for (const auto &[name, group] : groups)
      for (const int entity : group.entities)
        if (!elements_.contains({group.dim, entity}))
          elements_[{group.dim, entity}] = session_.elements(group.dim, entity);
  }

  void build(Kinematics kinematics)
  {
    take_nodes(kinematics);
    for (const auto &[dim_entity, elements] : elements_)
      if (dim_entity.first == mesh_.dim)
        take_cells(dim_entity.second, elements);
    for (const auto &[name, group] : groups_)
      take_group(name, group);
  }

private:
  [[nodiscard]] std::vector<Index> positions(const std::vector<GlobalIndex> &tags) const
  {
    std::vector<Index> nodes;
    nodes.reserve(tags.size());
    for (const GlobalIndex tag : tags)
      nodes.push_back(static_cast<Index>(std::lower_bound(mesh_.node_tags.begin(), mesh_.node_tags.end(), tag) -
                                         mesh_.node_tags.begin()));
    return nodes;
  }

  void take_nodes(Kinematics kinematics)
  {
    std::vector<GlobalIndex> used;
    for (const auto &[dim_entity, elements] : elements_)
      for (const auto &nodes : elements.nodes)
        used.insert(used.end(), nodes.begin(), nodes.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    RawNodes nodes;
    for (const auto &node : session_.nodes())
      if (std::binary_search(used.begin(), used.end(), node.first))
        nodes.push_back(node);
    if (nodes.size() != used.size())
      throw std::runtime_error("has elements on nodes that it does not define");
    check_coordinates(nodes, kinematics);
    mesh_.node_tags = std::move(used);
    for (const auto &[tag, x] : nodes)
      mesh_.points.insert(mesh_.points.end(), x.begin(), x.begin() + mesh_.dim);
  }

  void check_coordinates(RawNodes &nodes, Kinematics kinematics) const
  {
    double size = 0;
    for (const auto &[tag, x] : nodes)
      for (const double value : x)
      {
        if (!std::isfinite(value))
          throw std::runtime_error("node " + std::to_string(tag) + " has a coordinate that is not a number");
        size = std::max(size, std::abs(value));
      }
    for (auto &[tag, x] : nodes)
    {
      if (mesh_.dim == 2 && std::abs(x[2]) > round_off * size)
        throw std::runtime_error("node " + std::to_string(tag) + " has z = " + text(x[2]) +
                                 "; a mesh for the plane or axisymmetry lies in z = 0 (kinematics: 3d otherwise)");
      if (kinematics != Kinematics::axisymmetric || x[0] > round_off * size)
        continue;
      if (x[0] < -round_off * size)
        throw std::runtime_error("node " + std::to_string(tag) + " has x = " + text(x[0]) +
                                 "; in axisymmetry x is the radius, which is not negative");
      x[0] = 0;
    }
  }

  static std::string text(double value)
  {
    std::ostringstream out;
    out << value;
    return out.str();
  }

  void take_cells(int entity, const GmshSession::Elements &elements)
  {
    first_cell_[entity] = mesh_.cells.size();
    for (const auto &nodes : elements.nodes)
      mesh_.cells.push_back(positions(nodes));
    mesh_.cell_tags.insert(mesh_.cell_tags.end(), elements.tags.begin(), elements.tags.end());
  }

  void take_group(const std::string &name, const GmshSession::PhysicalGroup &raw)
  {
    Group &group = mesh_.groups[name];
    group.dim = raw.dim;
    for (const int entity : raw.entities)
    {
      const GmshSession::Elements &elements = elements_.at({raw.dim, entity});
      for (std::size_t e = 0; e < elements.nodes.size(); ++e)
      {
        group.entities.push_back(positions(elements.nodes[e]));
        if (raw.dim == mesh_.dim)
          group.cells.push_back(first_cell_.at(entity) + static_cast<Index>(e));
      }
    }
    if (group.entities.size() == 0)
      throw std::runtime_error("the physical group '" + name + "' has no elements");
  }

  Mesh &mesh_;
  const GmshSession &session_;
  const std::map<std::string, GmshSession::PhysicalGroup> &groups_;
  std::map<std::pair<int, int>, GmshSession::Elements> elements_; ///< by dimension and entity
  std::map<int, Index> first_cell_;
};

void check_groups(const std::map<std::string, GmshSession::PhysicalGroup> &groups, int dim)
{
  if (groups.empty())
    throw std::runtime_error("has no physical group with a name; the deck finds bodies and surfaces by the names of "
                             "physical groups, as in Physical Surface(\"body\") = {1};");
  int greatest = 0;
  for (const auto &[name, group] : groups)
    greatest = std::max(greatest, group.dim);
  if (greatest > dim)
    throw std::runtime_error("has named volumes, but kinematics asks for a mesh of the plane (kinematics: 3d "
                             "otherwise)");
  if (greatest < dim)
    throw std::runtime_error("has no named group of " + dimension_word(dim) + ", the bodies of this kinematics");
}

Mesh read_unchecked(const MeshOptions &options)
{
  check_file(options);
  check_parameters(options);
  GmshSession session(options.parameters);
  session.open(options.file);
  Mesh mesh;
  mesh.file = options.file;
  mesh.dim = options.kinematics == Kinematics::three_dimensional ? 3 : 2;
  if (is_geometry(options))
    session.generate(mesh.dim, options.refine);
  const auto groups = session.named_groups();
  check_groups(groups, mesh.dim);
  MeshBuilder(mesh, session, groups).build(options.kinematics);
  turn_clockwise_cells(mesh);
  return mesh;
}
} // namespace

Mesh read_mesh(const MeshOptions &options)
{
  Mesh mesh;
  try
  {
    mesh = read_unchecked(options);
  }
  catch (const std::runtime_error &error)
  {
    throw UserError(options.where, options.file + ": " + error.what());
  }
  check_cells(mesh, options.where);
  if (!is_geometry(options))
    for (int i = 0; i < options.refine; ++i)
      refine_uniformly(mesh);
  number_whole(mesh);
  return mesh;
}
} // namespace amontons
