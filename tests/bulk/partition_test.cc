#include "amontons/bulk/bisection.h"
#include "amontons/bulk/partition.h"
#include "block_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace amontons
{
namespace
{
struct Lattice
{
  CellShape shape;
  int n;
};

class PartitionTest : public testing::TestWithParam<Lattice>
{
protected:
  static Mesh make_mesh()
  {
    BlockMesh block;
    block.shape = GetParam().shape;
    block.n = {GetParam().n, GetParam().n, GetParam().n};
    Mesh mesh = block.make();
    // Two bodies: the cells whose first node is left or right of the middle.
    Group left, right;
    left.dim = right.dim = mesh.dim;
    for (Index c = 0; c < mesh.cells.size(); ++c)
    {
      Group &group = mesh.points[static_cast<std::size_t>(mesh.cells[c][0]) * mesh.dim] < 0.45 ? left : right;
      group.entities.push_back(mesh.cells[c]);
      group.cells.push_back(c);
    }
    mesh.groups["left_body"] = left;
    mesh.groups["right_body"] = right;
    return mesh;
  }
  static std::vector<BodyOptions> bodies()
  {
    std::vector<BodyOptions> out(2, elastic_body(MaterialLaw::linear_elastic, 1, 0.3));
    out[0].region = "left_body";
    out[1].region = "right_body";
    return out;
  }
};

/// Nodes that two cells share, counted by hand.
std::size_t n_shared(const Mesh &mesh, Index a, Index b)
{
  const std::set<Index> of_a(mesh.cells[a].begin(), mesh.cells[a].end());
  return static_cast<std::size_t>(
      std::count_if(mesh.cells[b].begin(), mesh.cells[b].end(), [&](Index node) { return of_a.count(node) > 0; }));
}

TEST_P(PartitionTest, PartsLieInOneBodyAndHangTogetherByFacets)
{
  const Mesh mesh = make_mesh();
  const std::vector<Index> part = partition_cells(mesh, bodies(), 150);
  ASSERT_EQ(static_cast<Index>(part.size()), mesh.cells.size());
  const Index n_parts = *std::max_element(part.begin(), part.end()) + 1;
  EXPECT_GT(n_parts, 4);
  const std::set<Index> left(mesh.groups.at("left_body").cells.begin(), mesh.groups.at("left_body").cells.end());
  const std::size_t facet_nodes = mesh.dim == 2 ? 2 : GetParam().shape == CellShape::tetrahedron ? 3 : 4;
  for (Index p = 0; p < n_parts; ++p)
  {
    std::vector<Index> cells, reached;
    for (Index c = 0; c < mesh.cells.size(); ++c)
      if (part[c] == p)
        cells.push_back(c);
    ASSERT_FALSE(cells.empty());
    for (const Index c : cells)
      EXPECT_EQ(left.count(c), left.count(cells[0]));
    std::set<Index> rest(cells.begin() + 1, cells.end());
    reached.push_back(cells[0]);
    for (std::size_t k = 0; k < reached.size(); ++k)
      for (auto it = rest.begin(); it != rest.end();)
        if (n_shared(mesh, reached[k], *it) >= facet_nodes)
        {
          reached.push_back(*it);
          it = rest.erase(it);
        }
        else
          ++it;
    EXPECT_TRUE(rest.empty()) << "part " << p << " falls apart";
  }
}

TEST_P(PartitionTest, PartsHaveAboutTheSizeAskedFor)
{
  const Mesh mesh = make_mesh();
  const int wanted = 150;
  const std::vector<Index> part = partition_cells(mesh, bodies(), wanted);
  const Index n_parts = *std::max_element(part.begin(), part.end()) + 1;
  std::vector<std::set<Index>> nodes(static_cast<std::size_t>(n_parts));
  for (Index c = 0; c < mesh.cells.size(); ++c)
    nodes[part[c]].insert(mesh.cells[c].begin(), mesh.cells[c].end());
  double mean = 0;
  for (const auto &set : nodes)
  {
    mean += static_cast<double>(set.size()) * mesh.dim / n_parts;
    EXPECT_LT(static_cast<double>(set.size()) * mesh.dim, 2.5 * wanted);
  }
  EXPECT_GT(mean, 0.5 * wanted);
  EXPECT_LT(mean, 1.5 * wanted);
  EXPECT_EQ(part, partition_cells(mesh, bodies(), wanted)) << "the same mesh gives the same parts";
}

INSTANTIATE_TEST_SUITE_P(All, PartitionTest,
                         testing::Values(Lattice{CellShape::quadrilateral, 24}, Lattice{CellShape::triangle, 20},
                                         Lattice{CellShape::hexahedron, 10}, Lattice{CellShape::tetrahedron, 8}));

TEST(Bisection, LayersOfCellsAreNotCutThrough)
{
  BlockMesh block;
  block.shape = CellShape::hexahedron;
  block.n = {12, 12, 12};
  const Mesh mesh = block.make();
  std::vector<Index> cells(static_cast<std::size_t>(mesh.cells.size()));
  for (std::size_t c = 0; c < cells.size(); ++c)
    cells[c] = static_cast<Index>(c);
  const std::vector<Index> part = bisect_cells(mesh, cells, 27);
  std::vector<std::set<Index>> nodes(27);
  for (std::size_t c = 0; c < cells.size(); ++c)
    nodes[part[c]].insert(mesh.cells[cells[c]].begin(), mesh.cells[cells[c]].end());
  for (const std::set<Index> &of_part : nodes)
    EXPECT_EQ(of_part.size(), 125U) << "no cube of 4 x 4 x 4 cells";
}

/// Two squares that meet in one node are no subdomain, however small.
TEST(Partition, PartsJoinedByOneNodeAreApart)
{
  Mesh mesh;
  mesh.dim = 2;
  mesh.points = {0, 0, 1, 0, 1, 1, 0, 1, 2, 1, 2, 2, 1, 2};
  mesh.node_tags = {1, 2, 3, 4, 5, 6, 7};
  const std::vector<Index> first{0, 1, 2, 3}, second{2, 4, 5, 6};
  Group body;
  body.dim = 2;
  for (const auto &cell : {first, second})
  {
    mesh.cells.push_back(cell);
    body.entities.push_back(cell);
    body.cells.push_back(mesh.cells.size() - 1);
  }
  mesh.cell_tags = {1, 2};
  mesh.groups["body"] = body;
  const std::vector<Index> part = partition_cells(mesh, {elastic_body(MaterialLaw::linear_elastic, 1, 0.3)}, 1000);
  EXPECT_NE(part[0], part[1]);
}
} // namespace
} // namespace amontons
