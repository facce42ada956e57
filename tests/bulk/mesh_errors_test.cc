#include "bulk/mesh_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
HandMesh square()
{
  HandMesh hand;
  hand.nodes = {{"0", "0", "0"}, {"1", "0", "0"}, {"1", "1", "0"}, {"0", "1", "0"}};
  hand.groups = {{2, "body"}};
  hand.elements = {{quadrilateral, 1, {1, 2, 3, 4}}};
  return hand;
}

HandMesh cube()
{
  HandMesh hand;
  for (const char *z : {"0", "1"})
    for (const auto &[x, y] : {std::pair{"0", "0"}, std::pair{"1", "0"}, std::pair{"1", "1"}, std::pair{"0", "1"}})
      hand.nodes.push_back({x, y, z});
  hand.groups = {{3, "body"}};
  hand.elements = {{hexahedron, 1, {1, 2, 3, 4, 5, 6, 7, 8}}};
  return hand;
}

std::string error_of(const HandMesh &hand, Kinematics kinematics = Kinematics::plane_strain)
{
  return message_of([&] { read_hand_mesh(hand, kinematics); });
}

std::string error_of_file(const std::string &name, const std::string &text)
{
  const TemporaryFolder folder;
  return message_of([&] { read_mesh(options_for(folder.write(name, text))); });
}

constexpr Kinematics solid = Kinematics::three_dimensional;
} // namespace

TEST(MeshError, NoneInAGoodMesh)
{
  EXPECT_EQ(error_of(square()), "no error");
  EXPECT_EQ(error_of(cube(), solid), "no error");
}

TEST(MeshError, InvertedCell)
{
  HandMesh hand = cube();
  hand.elements[0].nodes = {5, 6, 7, 8, 1, 2, 3, 4};
  EXPECT_EQ(error_of(hand, solid),
            "deck.yaml:2:14: mesh.msh: the hexahedron 1 (nodes 5 6 7 8 1 2 3 4, the first at (0, 0, 1)) is inverted: "
            "its Jacobian is not positive at every vertex");
  hand.elements[0] = {tetrahedron, 1, {1, 4, 2, 5}};
  EXPECT_THAT(error_of(hand, solid), testing::HasSubstr("the tetrahedron 1 (nodes 1 4 2 5, the first at (0, 0, 0)) is "
                                                        "inverted"));
}

TEST(MeshError, DegenerateCell)
{
  HandMesh hand = square();
  hand.elements[0] = {triangle, 1, {1, 2, 3}};
  hand.nodes[2] = {"3", "0", "0"};
  EXPECT_EQ(error_of(hand),
            "deck.yaml:2:14: mesh.msh: the triangle 1 (nodes 1 2 3, the first at (0, 0)) is degenerate: "
            "its Jacobian is not positive at every vertex");
  hand = cube();
  hand.elements[0] = {tetrahedron, 1, {1, 2, 3, 4}};
  EXPECT_THAT(error_of(hand, solid), testing::HasSubstr("the tetrahedron 1 (nodes 1 2 3 4"));
  hand.elements[0] = {hexahedron, 1, {1, 2, 3, 3, 5, 6, 7, 7}};
  EXPECT_THAT(error_of(hand, solid), testing::HasSubstr("is degenerate or not convex"));
  hand = square();
  hand.nodes.assign(4, {"1", "1", "0"});
  EXPECT_THAT(error_of(hand), testing::HasSubstr("is degenerate"));
}

TEST(MeshError, SizeDoesNotMakeACellDegenerate)
{
  HandMesh hand = square();
  hand.nodes = {{"0", "0", "0"}, {"1e-9", "0", "0"}, {"1e-9", "1e-13", "0"}, {"0", "1e-13", "0"}};
  EXPECT_EQ(error_of(hand), "no error");
}

TEST(MeshError, CellThatIsNotConvex)
{
  HandMesh hand = square();
  hand.nodes[2] = {"0.2", "0.2", "0"};
  EXPECT_THAT(error_of(hand), testing::HasSubstr("the quadrilateral 1 (nodes 1 2 3 4, the first at (0, 0)) is "
                                                 "degenerate or not convex"));
  hand = square();
  hand.elements[0].nodes = {1, 3, 2, 4};
  EXPECT_THAT(error_of(hand), testing::HasSubstr("is degenerate or not convex"));
}

TEST(MeshError, CoordinateThatIsNotANumber)
{
  for (const char *bad : {"nan", "inf", "-nan"})
  {
    HandMesh hand = square();
    hand.nodes[1][1] = bad;
    EXPECT_EQ(error_of(hand), "deck.yaml:2:14: mesh.msh: node 2 has a coordinate that is not a number") << bad;
  }
}

TEST(MeshError, OutOfThePlane)
{
  HandMesh hand = square();
  hand.nodes[2][2] = "0.5";
  EXPECT_EQ(error_of(hand), "deck.yaml:2:14: mesh.msh: node 3 has z = 0.5; a mesh for the plane or axisymmetry lies in "
                            "z = 0 (kinematics: 3d otherwise)");
}

TEST(MeshError, NegativeRadius)
{
  HandMesh hand = square();
  hand.nodes[0][0] = "-0.1";
  EXPECT_EQ(error_of(hand, Kinematics::axisymmetric), "deck.yaml:2:14: mesh.msh: node 1 has x = -0.1; in axisymmetry x "
                                                      "is the radius, which is not negative");
  EXPECT_EQ(error_of(hand, Kinematics::plane_strain), "no error");
}

TEST(MeshError, WrongDimension)
{
  EXPECT_EQ(error_of(cube()),
            "deck.yaml:2:14: mesh.msh: has named volumes, but kinematics asks for a mesh of the plane "
            "(kinematics: 3d otherwise)");
  EXPECT_EQ(error_of(square(), solid),
            "deck.yaml:2:14: mesh.msh: has no named group of volumes, the bodies of this kinematics");
}

TEST(MeshError, ElementsNotSupported)
{
  HandMesh hand = square();
  hand.nodes.insert(hand.nodes.end(), {{"0.5", "0", "0"}, {"1", "0.5", "0"}, {"0.5", "0.5", "0"}});
  hand.elements = {{triangle_of_degree_2, 1, {1, 2, 3, 5, 6, 7}}};
  EXPECT_EQ(error_of(hand),
            "deck.yaml:2:14: mesh.msh: has elements of type 'Triangle 6', of degree 2; only degree 1 is "
            "supported: mesh with `Mesh.ElementOrder = 1`");
  hand = square();
  hand.nodes.push_back({"0.5", "0", "0"});
  hand.groups.push_back({1, "bottom"});
  hand.elements.push_back({line_of_degree_2, 2, {1, 2, 5}});
  EXPECT_THAT(error_of(hand), testing::HasSubstr("type 'Line 3', of degree 2"));
  hand = cube();
  hand.elements = {{prism, 1, {1, 2, 3, 5, 6, 7}}};
  EXPECT_EQ(error_of(hand, solid), "deck.yaml:2:14: mesh.msh: has elements of type 'Prism 6'; supported are triangles, "
                                   "quadrilaterals, tetrahedra and hexahedra of degree 1");
}

TEST(MeshError, PhysicalNames)
{
  HandMesh hand = square();
  hand.groups.clear();
  EXPECT_THAT(error_of(hand), testing::StartsWith("deck.yaml:2:14: mesh.msh: has no physical group with a name"));
  hand = square();
  hand.groups.push_back({1, "body"});
  hand.elements.push_back({line, 2, {1, 2}});
  EXPECT_EQ(error_of(hand), "deck.yaml:2:14: mesh.msh: has two physical groups named 'body' (of dimension 1 and 2); "
                            "names must be unique");
}

TEST(MeshError, GroupsThatShareAnEntityInMsh2)
{
  HandMesh hand = square();
  hand.nodes.insert(hand.nodes.end(), {{"2", "0", "0"}, {"2", "1", "0"}});
  hand.groups.push_back({2, "other"});
  hand.elements.push_back({quadrilateral, 2, {2, 5, 6, 3}});
  EXPECT_EQ(error_of(hand), "no error");
  std::string text = hand.text();
  const std::string own_entity = "2 3 2 2 2 ", shared_entity = "2 3 2 2 1 ";
  text.replace(text.find(own_entity), own_entity.size(), shared_entity);
  EXPECT_EQ(error_of_file("mesh.msh", text),
            "deck.yaml:2:14: mesh.msh: elements of the elementary entity 1 (dimension 2) belong to different physical "
            "groups; give each group its own elementary tag, or save the mesh as .msh 4.1");
}

TEST(MeshError, FilesThatAreNone)
{
  EXPECT_EQ(error_of_file("mesh.vtk", ""), "deck.yaml:2:14: mesh.vtk: is neither a .msh nor a .geo");
  EXPECT_EQ(message_of([] { read_mesh(options_for("/nowhere/mesh.msh")); }),
            "deck.yaml:2:14: /nowhere/mesh.msh: no such file");
  EXPECT_THAT(error_of_file("mesh.msh", "hello"), testing::StartsWith("deck.yaml:2:14: mesh.msh: "));
  EXPECT_THAT(error_of_file("mesh.msh", ""), testing::StartsWith("deck.yaml:2:14: mesh.msh: "));
  EXPECT_THAT(error_of_file("mesh.geo", "Point(1) = {0, 0, 0};\nPoint(2) = {0;\n"),
              testing::HasSubstr("line 2: syntax error"));
  EXPECT_THAT(error_of_file("mesh.geo", "Plane Surface(1) = {7};"), testing::StartsWith("deck.yaml:2:14: mesh.geo: "));
  const std::string whole = square().text();
  EXPECT_THAT(error_of_file("mesh.msh", whole.substr(0, whole.find("$Elements") + 14)),
              testing::StartsWith("deck.yaml:2:14: mesh.msh: "));
  HandMesh hand = square();
  hand.elements[0].nodes[2] = 99;
  EXPECT_THAT(error_of(hand), testing::StartsWith("deck.yaml:2:14: mesh.msh: "));
}

TEST(MeshError, ParametersForAMesh)
{
  const TemporaryFolder folder;
  MeshOptions options = options_for(folder.write("mesh.msh", square().text()));
  options.parameters["n"] = 3;
  EXPECT_EQ(message_of([&] { read_mesh(options); }),
            "deck.yaml:2:14: mesh.msh: is a mesh, which takes no parameters; a .geo does");
}
} // namespace amontons::test
