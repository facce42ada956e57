#include "bulk/mesh_files.h"

#include <gmsh.h>

namespace amontons::test
{
namespace
{
double tetrahedron_volume(const Eigen::Vector3d &a, const Eigen::Vector3d &b, const Eigen::Vector3d &c,
                          const Eigen::Vector3d &d)
{
  return (b - a).cross(c - a).dot(d - a) / 6;
}

constexpr const char *plane_blocks = R"(
Point(1) = {0, 0, 0}; Point(2) = {0.5, 0, 0}; Point(3) = {0.5, 1, 0}; Point(4) = {0, 1, 0};
Point(5) = {0.6, 0, 0}; Point(6) = {1.1, 0, 0}; Point(7) = {1.1, 1, 0}; Point(8) = {0.6, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(1) = {1:4}; Curve Loop(2) = {-8, -7, -6, -5};
Plane Surface(1) = {1}; Plane Surface(2) = {2};
Transfinite Curve {1:8} = 4; Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("regular") = {1}; Physical Surface("free") = {2}; Physical Surface("all") = {1, 2};
Physical Curve("bottom") = {1, 5}; Physical Curve("shell") = {1:8}; Physical Point("corner") = {1};
)";

constexpr const char *solid_blocks = R"(
Point(1) = {0, 0, 0}; Point(2) = {0.5, 0, 0}; Point(3) = {0.5, 1, 0}; Point(4) = {0, 1, 0};
Point(5) = {0.6, 0, 0}; Point(6) = {1.1, 0, 0}; Point(7) = {1.1, 1, 0}; Point(8) = {0.6, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(1) = {1:4}; Curve Loop(2) = {-8, -7, -6, -5};
Plane Surface(1) = {1}; Plane Surface(2) = {2};
Transfinite Curve {1:8} = 3; Transfinite Surface {1}; Recombine Surface {1};
a[] = Extrude {0, 0, 1} { Surface{1}; Layers{3}; Recombine; };
b[] = Extrude {0, 0, 1} { Surface{2}; };
Physical Volume("regular") = {a[1]}; Physical Volume("free") = {b[1]}; Physical Volume("all") = {a[1], b[1]};
Physical Surface("bottom") = {1, 2};
Physical Surface("shell") = {1, a[0], a[2], a[3], a[4], a[5], 2, b[0], b[2], b[3], b[4], b[5]};
Physical Point("corner") = {1};
)";
} // namespace

double cell_volume(const Mesh &mesh, std::span<const Index> cell)
{
  std::vector<Eigen::Vector3d> x;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Index node : cell)
  {
    x.push_back(place(mesh, node));
    centre += x.back() / static_cast<double>(cell.size());
  }
  double sum = 0;
  if (mesh.dim == 2)
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += (x[i] - centre).cross(x[(i + 1) % x.size()] - centre).z() / 2;
  else if (cell.size() == 4)
    sum = tetrahedron_volume(x[0], x[1], x[2], x[3]);
  else
    for (const std::array<int, 4> &f : {std::array{0, 3, 2, 1}, std::array{4, 5, 6, 7}, std::array{0, 1, 5, 4},
                                        std::array{1, 2, 6, 5}, std::array{2, 3, 7, 6}, std::array{3, 0, 4, 7}})
      sum +=
          tetrahedron_volume(centre, x[f[0]], x[f[1]], x[f[2]]) + tetrahedron_volume(centre, x[f[0]], x[f[2]], x[f[3]]);
  return sum;
}

double volume(const Mesh &mesh, const std::string &group)
{
  double sum = 0;
  if (group.empty())
    for (Index c = 0; c < mesh.cells.size(); ++c)
      sum += cell_volume(mesh, mesh.cells[c]);
  else
    for (const Index c : mesh.groups.at(group).cells)
      sum += cell_volume(mesh, mesh.cells[c]);
  return sum;
}

std::filesystem::path write_two_blocks(const TemporaryFolder &folder, int dim, double version, bool binary)
{
  const auto geometry = folder.write("blocks.geo", dim == 2 ? plane_blocks : solid_blocks);
  const auto file = folder.path() / "blocks.msh";
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("Mesh.MshFileVersion", version);
  gmsh::option::setNumber("Mesh.Binary", binary ? 1 : 0);
  gmsh::open(geometry.string());
  gmsh::model::mesh::generate(dim);
  gmsh::write(file.string());
  gmsh::finalize();
  return file;
}
} // namespace amontons::test
