#include "bulk/mesh_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace amontons::test
{
struct Format
{
  int dim;
  double version;
  bool binary;
};
void PrintTo(const Format &f, std::ostream *out)
{
  *out << f.dim << "D, " << f.version << (f.binary ? ", binary" : ", ASCII");
}

class MeshFormat : public testing::TestWithParam<Format>
{
protected:
  [[nodiscard]] Mesh read(const Format &f) const
  {
    const TemporaryFolder folder;
    return read_mesh(options_for(write_two_blocks(folder, f.dim, f.version, f.binary),
                                 f.dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional));
  }
};

/// Cells of a group as sorted coordinates of their nodes, to the digits that ASCII files keep: what does not depend on
/// any numbering.
std::vector<std::vector<std::vector<double>>> placed_cells(const Mesh &mesh, const std::string &group)
{
  std::vector<std::vector<std::vector<double>>> cells;
  const Connectivity &entities = mesh.groups.at(group).entities;
  for (Index e = 0; e < entities.size(); ++e)
  {
    std::vector<std::vector<double>> nodes;
    for (const Index node : entities[e])
      for (nodes.emplace_back(); const double x : place(mesh, node))
        nodes.back().push_back(std::round(x * 1e12) * 1e-12);
    std::sort(nodes.begin(), nodes.end());
    cells.push_back(nodes);
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

TEST_P(MeshFormat, IsReadWhole)
{
  const Mesh mesh = read(GetParam());
  const bool plane = mesh.dim == 2;
  EXPECT_NEAR(volume(mesh), 1, 1e-12);
  EXPECT_NEAR(volume(mesh, "regular"), 0.5, 1e-12);
  EXPECT_NEAR(volume(mesh, "free"), 0.5, 1e-12);
  EXPECT_NEAR(volume(mesh, "all"), 1, 1e-12);
  const auto &groups = mesh.groups;
  EXPECT_EQ(groups.size(), 6u);
  EXPECT_EQ(groups.at("regular").entities.size(), plane ? 9 : 12);
  EXPECT_EQ(groups.at("all").cells.size(), static_cast<std::size_t>(mesh.cells.size()));
  EXPECT_EQ(groups.at("bottom").dim, mesh.dim - 1);
  EXPECT_EQ(groups.at("corner").dim, 0);
  ASSERT_EQ(groups.at("corner").entities.size(), 1);
  EXPECT_EQ(place(mesh, groups.at("corner").entities[0][0]).norm(), 0);
  EXPECT_EQ(mesh.cell_tags.size(), static_cast<std::size_t>(mesh.cells.size()));
  EXPECT_TRUE(std::is_sorted(mesh.node_tags.begin(), mesh.node_tags.end()));
  for (const std::string name : {"regular", "free", "all"})
    for (Index e = 0; e < groups.at(name).entities.size(); ++e)
      EXPECT_TRUE(std::ranges::equal(groups.at(name).entities[e],
                                     mesh.cells[groups.at(name).cells[static_cast<std::size_t>(e)]]));
}

TEST_P(MeshFormat, IsTheSameMeshInAll)
{
  const Mesh mesh = read(GetParam()), other = read({GetParam().dim, 4.1, false});
  EXPECT_EQ(mesh.n_nodes(), other.n_nodes());
  for (const auto &[name, group] : other.groups)
    EXPECT_TRUE(placed_cells(mesh, name) == placed_cells(other, name)) << name;
}

TEST_P(MeshFormat, IsReadTheSameTwice)
{
  const Mesh mesh = read(GetParam()), again = read(GetParam());
  EXPECT_EQ(mesh.points, again.points);
  EXPECT_EQ(mesh.node_tags, again.node_tags);
  EXPECT_EQ(mesh.cells.nodes, again.cells.nodes);
}

INSTANTIATE_TEST_SUITE_P(All, MeshFormat,
                         testing::Values(Format{2, 2.2, false}, Format{2, 2.2, true}, Format{2, 4.1, false},
                                         Format{2, 4.1, true}, Format{3, 2.2, false}, Format{3, 2.2, true},
                                         Format{3, 4.1, false}, Format{3, 4.1, true}));

const std::string parametric = R"(// DefineConstant[ ghost = 3 ];
/* DefineConstant[ spirit = 3 ]; */
DefineConstant[ n = 2, h = {1, Name "Sizes/h, height"}, k ];
Include "more.geo";
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, h, 0}; Point(4) = {0, h, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = n + 1; Transfinite Curve {2, 4} = m + 1;
Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("body") = {1}; Physical Curve("bottom") = {1};
unset = 7;
)";

class GeoParameters : public testing::Test
{
protected:
  Mesh read(const std::map<std::string, double> &parameters)
  {
    folder_.write("more.geo", "DefineConstant[ m = 1 ];\n");
    MeshOptions options = options_for(folder_.write("mesh.geo", parametric));
    options.parameters = parameters;
    return read_mesh(options);
  }

private:
  TemporaryFolder folder_;
};

TEST_F(GeoParameters, HaveTheFilesDefaults)
{
  EXPECT_EQ(read({}).cells.size(), 2);
}

TEST_F(GeoParameters, AreSet)
{
  const Mesh mesh = read({{"n", 5}, {"m", 3}, {"h", 0.1 + 0.2}});
  EXPECT_EQ(mesh.cells.size(), 15);
  EXPECT_EQ(mesh.groups.at("bottom").entities.size(), 5);
  EXPECT_NEAR(volume(mesh), 0.3, 1e-15);
  // To the last bit: 0.1 + 0.2 is not 0.3.
  EXPECT_EQ(*std::max_element(mesh.points.begin() + 2, mesh.points.end()), 1);
  EXPECT_NE(std::find(mesh.points.begin(), mesh.points.end(), 0.1 + 0.2), mesh.points.end());
}

TEST_F(GeoParameters, DoNotLastFromOneMeshToTheNext)
{
  EXPECT_EQ(read({{"n", 5}}).cells.size(), 5);
  EXPECT_EQ(read({}).cells.size(), 2);
}

TEST_F(GeoParameters, MustBeDeclared)
{
  const std::string declared = "; declared with DefineConstant[...]: n, h, k, m";
  EXPECT_EQ(message_of(
                [&] {
                  read({{"nn", 5}});
                }),
            "deck.yaml:2:14: mesh.geo: has no parameter 'nn' (did you mean 'n'?)" + declared);
  for (const std::string name : {"ghost", "spirit", "unset", "height", "Name"})
    EXPECT_EQ(message_of(
                  [&] {
                    read({{name, 5}});
                  }),
              "deck.yaml:2:14: mesh.geo: has no parameter '" + name + "'" + declared);
}

TEST_F(GeoParameters, AreSetInSilence)
{
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  read({{"n", 3}});
  EXPECT_EQ(testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr(), "");
}

TEST(MeshReading, KeepsOnlyNodesOfCellsAndGroups)
{
  HandMesh hand;
  hand.nodes = {{"9", "9", "0"}, {"0", "0", "0"}, {"1", "0", "0"}, {"0", "1", "0"}, {"2", "2", "0"}};
  hand.groups = {{2, "body"}, {0, "far"}};
  hand.elements = {{triangle, 1, {2, 3, 4}}, {point, 2, {5}}};
  const Mesh mesh = read_hand_mesh(hand);
  EXPECT_EQ(mesh.node_tags, (std::vector<GlobalIndex>{2, 3, 4, 5}));
  EXPECT_EQ(mesh.points, (std::vector<double>{0, 0, 1, 0, 0, 1, 2, 2}));
}

TEST(MeshReading, TurnsClockwiseCells)
{
  HandMesh hand;
  hand.nodes = {{"0", "0", "0"}, {"1", "0", "0"}, {"1", "1", "0"}, {"0", "1", "0"}, {"2", "0", "0"}, {"2", "1", "0"}};
  hand.groups = {{2, "square"}, {2, "corner"}};
  hand.elements = {{quadrilateral, 1, {1, 4, 3, 2}}, {triangle, 2, {2, 3, 5}}, {triangle, 2, {3, 5, 6}}};
  const Mesh mesh = read_hand_mesh(hand);
  for (Index c = 0; c < mesh.cells.size(); ++c)
    EXPECT_GT(cell_volume(mesh, mesh.cells[c]), 0.4);
  for (const auto &[name, group] : mesh.groups)
    for (Index e = 0; e < group.entities.size(); ++e)
      EXPECT_TRUE(std::ranges::equal(group.entities[e], mesh.cells[group.cells[static_cast<std::size_t>(e)]]));
}

TEST(MeshReading, PutsRoundOffOnThePlaneAndTheAxis)
{
  HandMesh hand;
  hand.nodes = {{"-1e-17", "0", "1e-17"}, {"1", "0", "0"}, {"0", "1", "0"}};
  hand.groups = {{2, "body"}};
  hand.elements = {{triangle, 1, {1, 2, 3}}};
  EXPECT_EQ(read_hand_mesh(hand, Kinematics::axisymmetric).points[0], 0);
  EXPECT_EQ(read_hand_mesh(hand).points[0], -1e-17);
}
} // namespace amontons::test
