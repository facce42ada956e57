#pragma once
#include "amontons/bulk/mesh.h"
#include "temporary_folder.h"

#include <Eigen/Dense>
#include <array>
#include <string>
#include <vector>

namespace amontons::test
{
/// Gmsh's numbers of the shapes.
enum ElementType
{
  line = 1,
  triangle = 2,
  quadrilateral = 3,
  tetrahedron = 4,
  hexahedron = 5,
  prism = 6,
  line_of_degree_2 = 8,
  triangle_of_degree_2 = 9,
  point = 15
};

/// A .msh written by hand, in version 2.2, ASCII: nodes and elements numbered from 1 in their order.
struct HandMesh
{
  struct Element
  {
    int type;
    int group; ///< position in `groups`, from 1; also its elementary entity
    std::vector<int> nodes;
  };

  std::vector<std::array<std::string, 3>> nodes;
  std::vector<std::pair<int, std::string>> groups; ///< dimension and name
  std::vector<Element> elements;

  [[nodiscard]] std::string text() const
  {
    std::string out = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    if (!groups.empty())
      out += "$PhysicalNames\n" + std::to_string(groups.size()) + "\n";
    for (std::size_t g = 0; g < groups.size(); ++g)
      out += std::to_string(groups[g].first) + " " + std::to_string(g + 1) + " \"" + groups[g].second + "\"\n";
    out += groups.empty() ? "" : "$EndPhysicalNames\n";
    out += "$Nodes\n" + std::to_string(nodes.size()) + "\n";
    for (std::size_t n = 0; n < nodes.size(); ++n)
      out += std::to_string(n + 1) + " " + nodes[n][0] + " " + nodes[n][1] + " " + nodes[n][2] + "\n";
    out += "$EndNodes\n$Elements\n" + std::to_string(elements.size()) + "\n";
    for (std::size_t e = 0; e < elements.size(); ++e)
    {
      const std::string group = std::to_string(elements[e].group);
      out += std::to_string(e + 1) + " " + std::to_string(elements[e].type) + " 2 " + group + " " + group;
      for (const int node : elements[e].nodes)
        out += " " + std::to_string(node);
      out += "\n";
    }
    return out + "$EndElements\n";
  }
};

inline MeshOptions options_for(const std::filesystem::path &file, Kinematics kinematics = Kinematics::plane_strain)
{
  MeshOptions options;
  options.file = file.string();
  options.kinematics = kinematics;
  options.where = {"deck.yaml", 2, 14};
  return options;
}

inline Mesh read_hand_mesh(const HandMesh &mesh, Kinematics kinematics = Kinematics::plane_strain)
{
  const TemporaryFolder folder;
  return read_mesh(options_for(folder.write("mesh.msh", mesh.text()), kinematics));
}

/// The message of a UserError that the call throws, without the temporary folder's name; "no error" without.
template<typename Call>
std::string message_of(Call &&call)
{
  try
  {
    call();
  }
  catch (const UserError &error)
  {
    std::string message = error.what();
    const std::size_t begin = message.find(std::filesystem::temp_directory_path().string() + "/amontons-test-");
    if (begin != std::string::npos)
      message.erase(begin, message.find("/", message.find("amontons-test-", begin)) + 1 - begin);
    return message;
  }
  return "no error";
}

inline Eigen::Vector3d place(const Mesh &mesh, Index node)
{
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int c = 0; c < mesh.dim; ++c)
    x[c] = mesh.points[static_cast<std::size_t>(node) * mesh.dim + c];
  return x;
}

/// Signed area or volume of a cell; a hexahedron from the tetrahedra between its centre and its faces' triangles.
double cell_volume(const Mesh &mesh, std::span<const Index> cell);

/// Sum over the cells of a group, or of the mesh.
double volume(const Mesh &mesh, const std::string &group = "");

/// Unit square (plane) or cube meshed by Gmsh into two halves, of quadrilaterals and triangles, or hexahedra and
/// tetrahedra apart from each other. Groups: "regular", "free", "all" (both); facets "bottom" (of both), "shell" (all
/// facets of both); "corner", a point. Written in the given format.
std::filesystem::path write_two_blocks(const TemporaryFolder &folder, int dim, double version, bool binary);
} // namespace amontons::test
