#include "amontons/bulk/surface_extraction.h"
#include "bulk/mesh_files.h"

#include <gtest/gtest.h>
#include <set>

namespace amontons::test
{
namespace
{
const SourceLocation here{"deck.yaml", 7, 3};

Mesh read_blocks(int dim, int refine = 0)
{
  const TemporaryFolder folder;
  MeshOptions options = options_for(write_two_blocks(folder, dim, 4.1, true),
                                    dim == 2 ? Kinematics::plane_stress : Kinematics::three_dimensional);
  options.refine = refine;
  return read_mesh(options);
}

Eigen::Vector3d node_place(const Surface &surface, Index node)
{
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int c = 0; c < surface.dim; ++c)
    x[c] = surface.reference[static_cast<std::size_t>(node) * surface.dim + c];
  return x;
}

/// Outward normal times area of a plane face, by the orientation that surface.h states.
Eigen::Vector3d area_vector(const Surface &surface, Index f)
{
  const auto face = surface.face(f);
  const Eigen::Vector3d a = node_place(surface, face[0]), b = node_place(surface, face[1]);
  if (surface.dim == 2)
    return {b.y() - a.y(), -(b.x() - a.x()), 0};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < face.size(); ++i)
    sum += (node_place(surface, face[i]) - a).cross(node_place(surface, face[i + 1]) - a) / 2;
  return sum;
}

/// A square cell above another; the segment (2, 1) runs against its owner.
HandMesh stacked()
{
  HandMesh hand;
  hand.nodes = {{"0", "0", "0"}, {"1", "0", "0"}, {"1", "1", "0"}, {"0", "1", "0"}, {"1", "2", "0"}, {"0", "2", "0"}};
  hand.groups = {{2, "lower"}, {2, "upper"}, {1, "bottom"}, {1, "between"}, {1, "top"}, {1, "side"}};
  hand.elements = {{quadrilateral, 1, {1, 2, 3, 4}},
                   {quadrilateral, 2, {4, 3, 5, 6}},
                   {line, 3, {2, 1}},
                   {line, 4, {3, 4}},
                   {line, 5, {6, 5}},
                   {line, 6, {2, 3}}};
  return hand;
}
} // namespace

class Extraction : public testing::TestWithParam<int>
{
};

/// The divergence theorem tells the volume inside a closed surface only if every face looks outwards.
TEST_P(Extraction, FacesLookOutwards)
{
  for (const int refine : {0, 1})
  {
    const Mesh mesh = read_blocks(GetParam(), refine);
    const Surface shell = extract_surface(mesh, "shell", here);
    double inside = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (Index f = 0; f < shell.n_faces(); ++f)
    {
      const Eigen::Vector3d area = area_vector(shell, f);
      sum += area;
      inside += area.dot(node_place(shell, shell.face(f)[0])) / mesh.dim;
    }
    EXPECT_NEAR(inside, volume(mesh), 1e-12);
    EXPECT_NEAR(sum.norm(), 0, 1e-12);
    const Surface bottom = extract_surface(mesh, "bottom", here);
    for (Index f = 0; f < bottom.n_faces(); ++f)
      EXPECT_NEAR(area_vector(bottom, f).normalized()[mesh.dim - 1], -1, 1e-12);
  }
}

TEST_P(Extraction, KnowsNodesOfTheMesh)
{
  const Mesh mesh = read_blocks(GetParam());
  const Surface surface = extract_surface(mesh, "bottom", here);
  EXPECT_EQ(surface.dim, mesh.dim);
  const Group &group = mesh.groups.at("bottom");
  const std::set<GlobalIndex> expected(group.entities.nodes.begin(), group.entities.nodes.end());
  EXPECT_EQ((std::set<GlobalIndex>(surface.node_ids.begin(), surface.node_ids.end())), expected);
  EXPECT_EQ(surface.node_ids.size(), expected.size());
  for (Index n = 0; n < surface.n_nodes(); ++n)
    EXPECT_EQ(node_place(surface, n), place(mesh, static_cast<Index>(surface.node_ids[static_cast<std::size_t>(n)])));
  ASSERT_EQ(surface.n_faces(), group.entities.size());
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    std::set<GlobalIndex> nodes, facet;
    for (const Index n : surface.face(f))
      nodes.insert(surface.node_ids[static_cast<std::size_t>(n)]);
    for (const Index n : group.entities[static_cast<Index>(surface.face_ids[static_cast<std::size_t>(f)])])
      facet.insert(n);
    EXPECT_EQ(nodes, facet);
  }
  ASSERT_EQ(surface.node_face_offsets.size(), surface.node_ids.size() + 1) << "adjacency is built";
}

INSTANTIATE_TEST_SUITE_P(PlaneAndSpace, Extraction, testing::Values(2, 3));

TEST(SurfaceOfGroup, TurnsFacetsToTheirCell)
{
  const Mesh mesh = read_hand_mesh(stacked());
  EXPECT_EQ(area_vector(extract_surface(mesh, "bottom", here), 0), Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(area_vector(extract_surface(mesh, "top", here), 0), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(area_vector(extract_surface(mesh, "side", here), 0), Eigen::Vector3d(1, 0, 0));
}

TEST(SurfaceOfGroup, LeavesFacetsWithoutCell)
{
  HandMesh hand = stacked();
  hand.nodes.insert(hand.nodes.end(), {{"0", "5", "0"}, {"1", "5", "0"}});
  hand.groups.insert(hand.groups.end(), {{1, "tool"}, {1, "turned_tool"}});
  hand.elements.insert(hand.elements.end(), {{line, 7, {7, 8}}, {line, 8, {8, 7}}});
  const Mesh mesh = read_hand_mesh(hand);
  EXPECT_EQ(area_vector(extract_surface(mesh, "tool", here), 0), Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(area_vector(extract_surface(mesh, "turned_tool", here), 0), Eigen::Vector3d(0, 1, 0));
}

TEST(SurfaceOfGroup, BetweenTwoCellsIsAnError)
{
  const Mesh mesh = read_hand_mesh(stacked());
  EXPECT_EQ(message_of([&] { extract_surface(mesh, "between", here); }),
            "deck.yaml:7:3: the facet of 'between' with node 3 at (1, 1) and node 4 at (0, 1) lies between two cells "
            "(1 and 2); a contact surface bounds one body: were two bodies meshed with common nodes?");
}

TEST(SurfaceOfGroup, MissingOrOfWrongDimension)
{
  const Mesh mesh = read_hand_mesh(stacked());
  EXPECT_EQ(message_of([&] { extract_surface(mesh, "botom", here); }),
            "deck.yaml:7:3: no physical group 'botom' in the mesh (did you mean 'bottom'?); groups of curves: between, "
            "bottom, side, top");
  EXPECT_EQ(message_of([&] { extract_surface(mesh, "lower", here); }),
            "deck.yaml:7:3: the physical group 'lower' is one of surfaces; one of curves is wanted here; groups of "
            "curves: between, bottom, side, top");
  EXPECT_EQ(message_of([&] { find_group(mesh, "uper", 2, here); }),
            "deck.yaml:7:3: no physical group 'uper' in the mesh (did you mean 'upper'?); groups of surfaces: lower, "
            "upper");
  EXPECT_EQ(message_of([&] { find_group(mesh, "p", 0, here); }),
            "deck.yaml:7:3: no physical group 'p' in the mesh; the mesh has no groups of points");
  EXPECT_EQ(find_group(mesh, "upper", -1, here).dim, 2);
}

TEST(Owners, AreTheCellsThatAFacetBounds)
{
  const Mesh mesh = read_hand_mesh(stacked());
  const auto owner = [&](const std::string &group) { return facet_owners(mesh, mesh.groups.at(group)).at(0); };
  EXPECT_EQ(owner("bottom").cell, 0);
  EXPECT_EQ(owner("bottom").local_facet, 0);
  EXPECT_EQ(owner("bottom").other_cell, -1);
  EXPECT_EQ(owner("side").local_facet, 1);
  EXPECT_EQ(owner("top").cell, 1);
  EXPECT_EQ(owner("between").cell, 0);
  EXPECT_EQ(owner("between").other_cell, 1);
}

TEST(WeldedBodies, AreRefused)
{
  const Mesh mesh = read_hand_mesh(stacked());
  const Surface bottom = extract_surface(mesh, "bottom", here), side = extract_surface(mesh, "side", here),
                top = extract_surface(mesh, "top", here);
  EXPECT_EQ(message_of([&] { check_not_welded(mesh, bottom, side, "bottom", "side", here); }),
            "deck.yaml:7:3: 'bottom' and 'side' share 1 node of the mesh, the first node 2 at (1, 0): the bodies are "
            "welded there; mesh each body with its own points and curves");
  EXPECT_EQ(message_of([&] { check_not_welded(mesh, bottom, top, "bottom", "top", here); }), "no error");
}
} // namespace amontons::test
