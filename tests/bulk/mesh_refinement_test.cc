#include "amontons/bulk/surface_extraction.h"
#include "bulk/mesh_files.h"

#include <gtest/gtest.h>
#include <map>

namespace amontons::test
{
namespace
{
Mesh read_blocks(int dim, int refine)
{
  const TemporaryFolder folder;
  MeshOptions options = options_for(write_two_blocks(folder, dim, 4.1, false),
                                    dim == 2 ? Kinematics::plane_stress : Kinematics::three_dimensional);
  options.refine = refine;
  return read_mesh(options);
}

/// How often each facet occurs among the cells.
std::map<std::vector<Index>, int> facet_counts(const Mesh &mesh)
{
  std::map<std::vector<Index>, int> counts;
  for (Index c = 0; c < mesh.cells.size(); ++c)
    for (const auto &facet : facets_of(cell_shape(mesh.dim, mesh.cells[c].size())))
    {
      std::vector<Index> nodes;
      for (const int v : facet)
        if (v >= 0)
          nodes.push_back(mesh.cells[c][static_cast<std::size_t>(v)]);
      std::sort(nodes.begin(), nodes.end());
      ++counts[nodes];
    }
  return counts;
}
} // namespace

class Refinement : public testing::TestWithParam<int>
{
};

TEST_P(Refinement, SplitsEveryCellAndGroup)
{
  const int dim = GetParam();
  const Mesh coarse = read_blocks(dim, 0), fine = read_blocks(dim, 2);
  EXPECT_EQ(fine.cells.size(), coarse.cells.size() << (2 * dim));
  for (const auto &[name, group] : coarse.groups)
  {
    const Group &refined = fine.groups.at(name);
    EXPECT_EQ(refined.entities.size(), group.entities.size() << (2 * group.dim)) << name;
    EXPECT_EQ(refined.cells.size(), group.cells.size() << (2 * dim)) << name;
    for (std::size_t e = 0; e < refined.cells.size(); ++e)
      EXPECT_TRUE(std::ranges::equal(refined.entities[static_cast<Index>(e)], fine.cells[refined.cells[e]]));
  }
  const auto n_vertices = fine.cells[fine.groups.at("regular").cells[0]].size();
  EXPECT_EQ(n_vertices, dim == 2 ? 4u : 8u) << "quadrilaterals and hexahedra stay what they are";
}

TEST_P(Refinement, FillsTheSameSpace)
{
  const Mesh coarse = read_blocks(GetParam(), 0), fine = read_blocks(GetParam(), 1);
  for (const std::string name : {"regular", "free"})
    EXPECT_NEAR(volume(fine, name), volume(coarse, name), 1e-13);
  for (Index c = 0; c < fine.cells.size(); ++c)
    EXPECT_NEAR(cell_volume(fine, fine.cells[c]) / cell_volume(coarse, coarse.cells[c >> GetParam()]),
                std::pow(0.5, GetParam()), 1e-10);
}

TEST_P(Refinement, Conforms)
{
  const int dim = GetParam();
  const Mesh fine = read_blocks(dim, 2);
  Index n_boundary = 0;
  for (const auto &[facet, count] : facet_counts(fine))
  {
    ASSERT_LE(count, 2);
    n_boundary += count == 1;
  }
  EXPECT_EQ(n_boundary, fine.groups.at("shell").entities.size());
  for (const FacetOwner &owner : facet_owners(fine, fine.groups.at("shell")))
  {
    EXPECT_GE(owner.cell, 0);
    EXPECT_EQ(owner.other_cell, -1);
  }
  std::map<std::vector<double>, int> places;
  for (Index n = 0; n < fine.n_nodes(); ++n)
    ++places[{fine.points.begin() + n * dim, fine.points.begin() + (n + 1) * dim}];
  EXPECT_EQ(places.size(), static_cast<std::size_t>(fine.n_nodes())) << "a place has one node";
}

INSTANTIATE_TEST_SUITE_P(PlaneAndSpace, Refinement, testing::Values(2, 3));

/// A general hexahedron and tetrahedron, so that the order of vertices counts.
TEST(RefinementOfOneCell, ChildrenAreRightHanded)
{
  HandMesh hand;
  hand.nodes = {{"0", "0", "0"},     {"2", "0.1", "0"},   {"2.2", "1.9", "0.2"}, {"-0.1", "2", "0.1"},
                {"0.2", "0.1", "3"}, {"2", "0", "2.8"},   {"2", "2", "3"},       {"0", "1.8", "3.1"},
                {"5", "0", "0"},     {"7", "0.3", "0.1"}, {"5.5", "2", "-0.2"},  {"6", "0.5", "2"}};
  hand.groups = {{3, "hexahedron"}, {3, "tetrahedron"}};
  hand.elements = {{hexahedron, 1, {1, 2, 3, 4, 5, 6, 7, 8}}, {tetrahedron, 2, {9, 10, 11, 12}}};
  const TemporaryFolder folder;
  MeshOptions options = options_for(folder.write("mesh.msh", hand.text()), Kinematics::three_dimensional);
  const Mesh coarse = read_mesh(options);
  options.refine = 1;
  const Mesh fine = read_mesh(options);
  EXPECT_EQ(fine.n_nodes(), 27 + 10);
  const double tetrahedron_child = volume(coarse, "tetrahedron") / 8;
  for (const Index c : fine.groups.at("tetrahedron").cells)
    EXPECT_NEAR(cell_volume(fine, fine.cells[c]), tetrahedron_child, 1e-13);
  for (const Index c : fine.groups.at("hexahedron").cells)
    EXPECT_GT(cell_volume(fine, fine.cells[c]), 0.5);
}

TEST(RefinementOfAGeometry, PutsNewNodesOnIt)
{
  const TemporaryFolder folder;
  MeshOptions options = options_for(folder.write("disc.geo", R"(
Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {0, 2, 0};
Line(1) = {1, 2}; Circle(2) = {2, 1, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Transfinite Curve {1, 2, 3} = 4;
Physical Surface("disc") = {1}; Physical Curve("rim") = {2};
)"));
  options.refine = 2;
  const Mesh mesh = read_mesh(options);
  const Group &rim = mesh.groups.at("rim");
  EXPECT_EQ(rim.entities.size(), 12);
  for (const Index node : rim.entities.nodes)
    EXPECT_NEAR(place(mesh, node).norm(), 2, 1e-12);
  for (const FacetOwner &owner : facet_owners(mesh, rim))
    EXPECT_GE(owner.cell, 0);
}
} // namespace amontons::test
