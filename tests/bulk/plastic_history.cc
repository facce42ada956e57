// What a plastic body remembers, and what beside it is kept.
#include "plastic_body.h"

#include <gmock/gmock.h>

namespace amontons
{
namespace
{
TEST(PlasticHistory, OnlyCommittedDisplacementsLeaveATrace)
{
  const Mesh mesh = BlockMesh{CellShape::quadrilateral, {3, 3, 1}, 0.2}.make();
  BodyAssembly tried(mesh, Kinematics::plane_strain, Strain::small, {plastic_body(0.1, 0.1)}, {});
  BodyAssembly clean(mesh, Kinematics::plane_strain, Strain::small, {plastic_body(0.1, 0.1)}, {});
  const auto field = [&](double size)
  { return nodal_field(mesh, [=](const auto &X) { return Eigen::Vector3d(size * X[1], size * X[0] * X[1], 0); }); };
  std::vector<double> internal(mesh.points.size()), external(internal), of_clean(internal);
  for (BodyAssembly *assembly : {&tried, &clean})
    assembly->commit(field(5 * yield));
  ASSERT_TRUE(tried.assemble_tangent(field(-20 * yield), 0) &&
              tried.forces(field(30 * yield), 0, internal, external)); // an attempt that failed
  ASSERT_TRUE(tried.assemble_tangent(field(8 * yield), 0) && clean.assemble_tangent(field(8 * yield), 0));
  ASSERT_TRUE(tried.forces(field(8 * yield), 0, internal, external) &&
              clean.forces(field(8 * yield), 0, of_clean, external));
  EXPECT_EQ(internal, of_clean);
  EXPECT_EQ(global_matrix(mesh, tried).toDense(), global_matrix(mesh, clean).toDense());
  for (BodyAssembly *assembly : {&tried, &clean})
    assembly->commit(field(8 * yield));
  EXPECT_EQ(tried.plastic_strain(), clean.plastic_strain());
}

/// Left half elastic, right half plastic: the sum of what they are alone, however often it is assembled.
TEST(PlasticHistory, AnElasticBodyBesideAPlasticOneIsKept)
{
  Mesh mesh = BlockMesh{CellShape::hexahedron, {4, 2, 2}, 0.2}.make();
  for (const std::string name : {"west", "east"})
  {
    Group &group = mesh.groups[name];
    group.dim = 3;
    for (Index c = 0; c < mesh.cells.size(); ++c)
      if ((point_of(mesh.points, 3, mesh.cells[c][0])[0] < 0.4) == (name == "west"))
      {
        group.entities.push_back(mesh.cells[c]);
        group.cells.push_back(c);
      }
  }
  const auto body = [&](const std::string &name, MaterialLaw law)
  {
    BodyOptions out = plastic_body(0.1);
    out.name = out.region = name;
    out.material.law = law;
    return out;
  };
  constexpr auto solid = Kinematics::three_dimensional;
  BodyAssembly mixed(mesh, solid, Strain::small,
                     {body("west", MaterialLaw::linear_elastic), body("east", MaterialLaw::von_mises)}, {});
  EXPECT_FALSE(mixed.tangent_is_constant());
  const auto field = [&](double size)
  { return nodal_field(mesh, [=](const auto &X) { return Eigen::Vector3d(size * X[1] * X[2], size * X[0], 0); }); };
  for (const double size : {0.1 * yield, 20 * yield, -10 * yield})
  {
    BodyAssembly fresh(mesh, solid, Strain::small,
                       {body("west", MaterialLaw::linear_elastic), body("east", MaterialLaw::von_mises)}, {});
    ASSERT_TRUE(mixed.assemble_tangent(field(size), 0) && fresh.assemble_tangent(field(size), 0));
    EXPECT_EQ(global_matrix(mesh, mixed).toDense(), global_matrix(mesh, fresh).toDense());
    std::vector<double> internal(mesh.points.size()), by_cells(internal), external(internal);
    const BodyAssembly never_assembled(
        mesh, solid, Strain::small, {body("west", MaterialLaw::linear_elastic), body("east", MaterialLaw::von_mises)},
        {});
    ASSERT_TRUE(mixed.forces(field(size), 0, internal, external) &&
                never_assembled.forces(field(size), 0, by_cells, external));
    for (std::size_t i = 0; i < internal.size(); ++i)
      EXPECT_NEAR(internal[i], by_cells[i], 1e-13 * yield);
  }
  for (Index c = 0; c < mesh.cells.size(); ++c)
    EXPECT_EQ(mixed.plastic_strain()[c], 0);
  mixed.commit(field(20 * yield));
  const std::vector<double> plastic = mixed.plastic_strain();
  for (const Index c : mesh.groups.at("west").cells)
    EXPECT_EQ(plastic[c], 0);
  for (const Index c : mesh.groups.at("east").cells)
    EXPECT_GT(plastic[c], 0);
}

TEST(PlasticBodies, WhatCannotBeIsRefused)
{
  const Mesh mesh = BlockMesh{}.make();
  const auto message = [&](const BodyOptions &body, Kinematics kinematics, Strain strain) -> std::string
  {
    try
    {
      const BodyAssembly assembly(mesh, kinematics, strain, {body}, {});
    }
    catch (const UserError &error)
    {
      return error.what();
    }
    return "";
  };
  using testing::HasSubstr;
  EXPECT_THAT(message(plastic_body(), Kinematics::plane_strain, Strain::finite), HasSubstr("small strain only"));
  EXPECT_THAT(message(plastic_body(-1), Kinematics::plane_strain, Strain::small), HasSubstr("must not be negative"));
  BodyOptions body = plastic_body();
  body.material.yield_stress = 0;
  EXPECT_THAT(message(body, Kinematics::plane_strain, Strain::small), HasSubstr("yield-stress must be positive"));
  EXPECT_EQ(message(plastic_body(), Kinematics::plane_strain, Strain::small), "");
}
} // namespace
} // namespace amontons
