// The files are read back with zlib and base64 undone (vtu_reader.h).
#include "fixture.h"
#include "vtu_reader.h"

#include "amontons/output/pictures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace amontons
{
namespace
{
const std::vector<BodyOptions> bodies = []
{
  std::vector<BodyOptions> list(3);
  list[0].region = "floor";
  list[1].region = "";
  list[2].region = "block";
  return list;
}();
const std::vector<OutputField> all_fields{OutputField::displacement, OutputField::stress, OutputField::plastic_strain};

TEST(BodyGrid, HoldsCellsOfEveryShapeAndRigidFacets)
{
  const Example example;
  const VtuReader vtu(body_grid(example.state, bodies, all_fields).text());
  EXPECT_EQ(vtu.integers<unsigned char>("types"), (std::vector<unsigned char>{9, 5, 5, 3}));
  EXPECT_EQ(vtu.integers<std::int64_t>("offsets"), (std::vector<std::int64_t>{4, 7, 10, 12}));
  EXPECT_EQ(vtu.integers<std::int64_t>("connectivity"),
            (std::vector<std::int64_t>{0, 1, 4, 3, 1, 2, 5, 1, 5, 4, 6, 7}));
  EXPECT_EQ(vtu.integers<std::int64_t>("body"), (std::vector<std::int64_t>{-1, 2, 2, 0}));
  EXPECT_EQ(vtu.integers<std::int64_t>("node"), example.mesh.node_tags);
}

TEST(BodyGrid, PutsThePlaneInSpace)
{
  const Example example;
  const VtuReader vtu(body_grid(example.state, bodies, all_fields).text());
  const auto points = vtu.numbers("Points"), displacement = vtu.numbers("displacement");
  ASSERT_EQ(points.size(), 24u);
  ASSERT_EQ(displacement.size(), 24u);
  for (int node = 0; node < 8; ++node)
    for (int c = 0; c < 3; ++c)
    {
      EXPECT_EQ(points[node * 3 + c], c < 2 ? example.mesh.points[node * 2 + c] : 0);
      EXPECT_EQ(displacement[node * 3 + c], c < 2 ? example.state.displacement[node * 2 + c] : 0);
    }
}

TEST(BodyGrid, GivesStressWithItsComponentsAndVonMises)
{
  const Example example;
  const VtuReader vtu(body_grid(example.state, bodies, all_fields).text());
  auto expected = example.state.stress;
  expected.resize(24, 0);
  EXPECT_EQ(vtu.numbers("stress"), expected);
  for (const char *component : {"ComponentName0=\"xx\"", "ComponentName3=\"xy\"", "ComponentName5=\"xz\""})
    EXPECT_NE(vtu.text().find(component), std::string::npos) << component;
  const auto equivalent = vtu.numbers("von_mises");
  EXPECT_DOUBLE_EQ(equivalent[0], std::sqrt(0.5 * (1 + 1 + 4) + 3 * (16 + 25 + 36)));
  EXPECT_DOUBLE_EQ(equivalent[1], 10);           // uniaxial
  EXPECT_DOUBLE_EQ(equivalent[2], std::sqrt(3)); // pure shear
  EXPECT_EQ(equivalent[3], 0);
}

TEST(BodyGrid, GivesPlasticStrainWhereABodyIsPlastic)
{
  Example example;
  EXPECT_EQ(body_grid(example.state, bodies, all_fields).text().find("plastic_strain"), std::string::npos);
  std::vector<BodyOptions> plastic = bodies;
  plastic[2].material.law = MaterialLaw::von_mises;
  example.state.plastic_strain = {0.25, 0, 0.5};
  const VtuReader vtu(body_grid(example.state, plastic, all_fields).text());
  EXPECT_EQ(vtu.numbers("plastic_strain"), (std::vector<double>{0.25, 0, 0.5, 0}));
  example.state.plastic_strain = {}; // all plastic cells are on another process
  EXPECT_EQ(VtuReader(body_grid(example.state, plastic, all_fields).text()).numbers("plastic_strain"),
            (std::vector<double>{0, 0, 0, 0}));
}

TEST(BodyGrid, WritesOnlyTheFieldsAskedFor)
{
  const Example example;
  const std::string text = body_grid(example.state, bodies, {OutputField::displacement}).text();
  EXPECT_NE(text.find("\"displacement\""), std::string::npos);
  EXPECT_EQ(text.find("\"stress\""), std::string::npos);
  EXPECT_EQ(text.find("\"von_mises\""), std::string::npos);
}

TEST(ContactGrid, HoldsEverythingOfTheContact)
{
  const Example example;
  const ContactResult &contact = example.state.contacts[0];
  const VtuReader vtu(contact_grid(contact, example.state).text());
  EXPECT_EQ(vtu.integers<unsigned char>("types"), (std::vector<unsigned char>{3, 3}));
  EXPECT_EQ(vtu.integers<std::int64_t>("connectivity"), (std::vector<std::int64_t>{1, 0, 2, 1}));
  EXPECT_EQ(vtu.integers<std::int64_t>("node"), (std::vector<std::int64_t>{13, 12, 11}));
  EXPECT_EQ(vtu.integers<std::int64_t>("status"), (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(vtu.numbers("displacement"), (std::vector<double>{0.5, 0.6, 0, 0.3, 0.4, 0, 0.1, 0.2, 0}));
  EXPECT_EQ(vtu.numbers("pressure"), contact.pressure);
  EXPECT_EQ(vtu.numbers("traction"), contact.traction);
  EXPECT_EQ(vtu.numbers("slip"), contact.slip);
  EXPECT_EQ(vtu.numbers("area"), contact.area);
  EXPECT_EQ(vtu.numbers("force"), in_space(2, contact.force));
  const auto gap = vtu.numbers("gap");
  EXPECT_EQ(gap[0], 0.125);
  EXPECT_EQ(gap[1], -1e-17);
  EXPECT_TRUE(std::isnan(gap[2]));
}

TEST(Vtu, SurvivesArraysOfSeveralBlocks)
{
  std::vector<double> points(3 * 150000); // 3.6 MB: three full blocks and a part
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = std::sin(static_cast<double>(i));
  VtuGrid grid(3, points);
  EXPECT_EQ(VtuReader(grid.text()).numbers("Points"), points);
  points.resize(3 * (1 << 17)); // three whole blocks, none in part
  EXPECT_EQ(VtuReader(VtuGrid(3, points).text()).numbers("Points"), points);
}

TEST(Pictures, AreWrittenEveryNthTimeAndAtTheEnd)
{
  const TemporaryFolder temporary;
  const ResultFolder folder(temporary.path(), Communicator::alone());
  Example example;
  Pictures pictures(folder, {all_fields, 2}, bodies);
  pictures.start(example.state, 0);
  for (int increment = 1; increment <= 3; ++increment)
  {
    example.state.increment = increment;
    example.state.time = 0.1 * increment;
    pictures.accepted({}, example.state);
  }
  pictures.finish(example.state, {}, {}, "");
  EXPECT_EQ(content_of(folder.path() / "solution.pvd"),
            pvd_text(std::vector<std::pair<double, std::string>>{
                {0, "solution_00000.vtu"}, {0.1 * 2, "solution_00002.vtu"}, {0.1 * 3, "solution_00003.vtu"}}));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "solution_00001.vtu"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "contact_block_floor_00003.vtu"));
  EXPECT_NE(content_of(folder.path() / "contact_block_floor.pvd").find("timestep=\"0\" file=\"contact_block_floor_0"),
            std::string::npos);
}

TEST(Pictures, OfTheLastIncrementAreWrittenOnce)
{
  const TemporaryFolder temporary;
  const ResultFolder folder(temporary.path(), Communicator::alone());
  Example example;
  Pictures pictures(folder, {all_fields, 1}, bodies);
  example.state.increment = 1;
  pictures.accepted({}, example.state);
  pictures.finish(example.state, {}, {}, "");
  const std::string pvd = content_of(folder.path() / "solution.pvd");
  EXPECT_EQ(pvd.find("DataSet"), pvd.rfind("DataSet"));
}

TEST(Pictures, CanBeLeftOut)
{
  const TemporaryFolder temporary;
  const ResultFolder folder(temporary.path(), Communicator::alone());
  const Example example;
  Pictures pictures(folder, {all_fields, 0}, bodies);
  pictures.start(example.state, 0);
  pictures.accepted({}, example.state);
  pictures.finish(example.state, {}, {}, "");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}
} // namespace
} // namespace amontons
