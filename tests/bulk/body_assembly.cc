// Bodies and subdomains.
#include "block_mesh.h"

#include <gmock/gmock.h>

namespace amontons
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;

/// Two halves of a block as two groups.
Mesh halves(CellShape shape)
{
  Mesh mesh = BlockMesh{shape, {4, 3, 2}, 0.2}.make();
  for (const std::string name : {"west", "east"})
  {
    Group &group = mesh.groups[name];
    group.dim = mesh.dim;
    for (Index c = 0; c < mesh.cells.size(); ++c)
    {
      double x = 0;
      for (const Index node : mesh.cells[c])
        x += mesh.points[node * mesh.dim] / static_cast<double>(mesh.cells[c].size());
      if ((x < 0.5) == (name == "west"))
      {
        group.entities.push_back(mesh.cells[c]);
        group.cells.push_back(c);
      }
    }
  }
  return mesh;
}

BodyOptions body(const std::string &name, const std::string &region, MaterialLaw law = MaterialLaw::neo_hookean)
{
  BodyOptions out = elastic_body(law, 2, 0.3);
  out.name = name;
  out.region = region;
  return out;
}

std::vector<double> wave(const Mesh &mesh)
{
  return nodal_field(mesh,
                     [](const Eigen::Vector3d &X)
                     {
                       return Eigen::Vector3d(0.05 * std::sin(3 * X[1]), 0.04 * std::cos(2 * X[0] + X[2]),
                                              0.03 * std::sin(X[0] + 2 * X[1]));
                     });
}

TEST(Subdomains, ManyGiveTheSameMatrixAsOne)
{
  for (const CellShape shape :
       {CellShape::triangle, CellShape::quadrilateral, CellShape::tetrahedron, CellShape::hexahedron})
    for (const Strain strain : {Strain::small, Strain::finite})
    {
      const Mesh mesh = halves(shape);
      const auto kinematics = mesh.dim == 3 ? Kinematics::three_dimensional : Kinematics::axisymmetric;
      std::vector<Index> parts;
      for (Index c = 0; c < mesh.cells.size(); ++c)
        parts.push_back((c * 7) % 5);
      const std::vector<BodyOptions> bodies{body("west", "west"), body("east", "east")};
      BodyAssembly one(mesh, kinematics, strain, bodies, {}), many(mesh, kinematics, strain, bodies, {}, parts);
      ASSERT_EQ(one.subdomains().size(), 1u);
      ASSERT_EQ(many.subdomains().size(), 5u);
      const auto u = wave(mesh);
      ASSERT_TRUE(one.assemble_tangent(u, 0) && many.assemble_tangent(u, 0));
      const Eigen::SparseMatrix<double> difference = global_matrix(mesh, one) - global_matrix(mesh, many);
      EXPECT_LT(difference.norm(), 1e-14 * global_matrix(mesh, one).norm());
    }
}

TEST(Subdomains, PatternsHaveWholeNodeBlocksInAscendingOrder)
{
  const Mesh mesh = halves(CellShape::hexahedron);
  std::vector<Index> parts(static_cast<std::size_t>(mesh.cells.size()), 2);
  parts[0] = 0;
  const BodyAssembly assembly(mesh, Kinematics::three_dimensional, Strain::small, {body("block", "body")}, {}, parts);
  ASSERT_EQ(assembly.subdomains().size(), 3u);
  EXPECT_EQ(assembly.subdomains()[0].n_rows(), 24);
  EXPECT_EQ(assembly.subdomains()[1].n_rows(), 0);
  for (const SubdomainMatrix &matrix : assembly.subdomains())
  {
    EXPECT_TRUE(std::is_sorted(matrix.nodes.begin(), matrix.nodes.end()));
    for (Index row = 0; row < matrix.n_rows(); ++row)
    {
      const auto begin = matrix.col.begin() + matrix.row_ptr[row], end = matrix.col.begin() + matrix.row_ptr[row + 1];
      EXPECT_TRUE(std::is_sorted(begin, end));
      EXPECT_EQ(std::adjacent_find(begin, end), end);
      EXPECT_EQ((end - begin) % 3, 0);
      EXPECT_EQ(*begin % 3, 0);
      EXPECT_TRUE(std::binary_search(begin, end, row));
    }
  }
}

TEST(Subdomains, AssemblingTwiceGivesTheSameBits)
{
  const Mesh mesh = halves(CellShape::hexahedron);
  BodyAssembly assembly(mesh, Kinematics::three_dimensional, Strain::finite, {body("block", "body")}, {});
  const auto u = wave(mesh);
  ASSERT_TRUE(assembly.assemble_tangent(u, 0));
  const auto first = assembly.subdomains()[0].values;
  ASSERT_TRUE(assembly.assemble_tangent(u, 0));
  EXPECT_EQ(first, assembly.subdomains()[0].values);
}

TEST(Bodies, RigidCellsHaveNeitherStiffnessNorForceNorStress)
{
  const Mesh mesh = halves(CellShape::quadrilateral);
  const std::vector<BodyOptions> bodies{body("west", "west"), body("east", "east", MaterialLaw::rigid)};
  BodyAssembly assembly(mesh, Kinematics::plane_strain, Strain::finite, bodies, {});
  const auto u = wave(mesh);
  std::vector<double> internal(u.size()), external(u.size());
  ASSERT_TRUE(assembly.assemble_tangent(u, 0) && assembly.forces(u, 0, internal, external));
  const auto stress = assembly.stress(u);
  std::vector<bool> elastic(static_cast<std::size_t>(mesh.n_nodes()), false);
  for (Index c = 0; c < mesh.cells.size(); ++c)
  {
    const bool rigid = assembly.body_of_cell()[c] == 1;
    EXPECT_EQ(std::abs(stress[6 * c]) + std::abs(stress[6 * c + 1]) > 0, !rigid);
    if (!rigid)
      for (const Index node : mesh.cells[c])
        elastic[node] = true;
  }
  const auto &nodes = assembly.subdomains()[0].nodes;
  for (Index node = 0; node < mesh.n_nodes(); ++node)
  {
    EXPECT_EQ(std::binary_search(nodes.begin(), nodes.end(), node), elastic[node]);
    if (!elastic[node])
      EXPECT_EQ(std::abs(internal[2 * node]) + std::abs(internal[2 * node + 1]), 0);
  }
}

std::string refusal(const std::vector<BodyOptions> &bodies, Kinematics kinematics = Kinematics::plane_strain,
                    Strain strain = Strain::small)
{
  try
  {
    BodyAssembly assembly(halves(CellShape::quadrilateral), kinematics, strain, bodies, {});
  }
  catch (const UserError &error)
  {
    return error.what();
  }
  return "no error";
}

TEST(Bodies, RefusalsNameThePlaceAndTheReason)
{
  EXPECT_THAT(refusal({body("west", "west")}),
              AllOf(HasSubstr("block.msh"), HasSubstr("cell 3 and 5 more"), HasSubstr("no body"), HasSubstr("'east'")));
  EXPECT_THAT(refusal({body("west", "west"), body("all", "body")}),
              AllOf(HasSubstr("deck.yaml:3:5"), HasSubstr("'west' and 'all'")));
  EXPECT_THAT(refusal({body("all", "bodi")}), AllOf(HasSubstr("deck.yaml:3:5"), HasSubstr("body")));
  EXPECT_THAT(refusal({body("all", "left")}), HasSubstr("'left' is one of"));
  auto averaged = body("all", "body");
  averaged.mean_dilatation = true;
  EXPECT_THAT(refusal({averaged}, Kinematics::plane_stress), HasSubstr("plane stress"));
  EXPECT_THAT(refusal({body("all", "body", MaterialLaw::linear_elastic)}, Kinematics::plane_strain, Strain::finite),
              HasSubstr("neo-hookean"));
  auto incompressible = body("all", "body");
  incompressible.material.poisson = 0.5;
  EXPECT_THAT(refusal({incompressible}), HasSubstr("poisson"));
  EXPECT_THAT(refusal({body("all", "body")}, Kinematics::three_dimensional), HasSubstr("kinematics"));
}
} // namespace
} // namespace amontons
