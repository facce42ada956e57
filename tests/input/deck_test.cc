#include "input/deck_files.h"

#include <gtest/gtest.h>
#include <numbers>

namespace amontons::test
{
TEST(Deck, IsReadWhole)
{
  const Deck deck = read_text(plane_deck);
  EXPECT_EQ(deck.title, "A punch");
  EXPECT_EQ(deck.mesh.kinematics, Kinematics::plane_strain);
  EXPECT_EQ(deck.mesh.where.line, 2);
  EXPECT_EQ(deck.mesh.where.column, 14);
  ASSERT_EQ(deck.bodies.size(), 2u);
  EXPECT_EQ(deck.bodies[0].name, "block");
  EXPECT_EQ(deck.bodies[0].material.law, MaterialLaw::linear_elastic);
  EXPECT_EQ(deck.bodies[0].material.young, 1000);
  EXPECT_EQ(deck.bodies[0].material.poisson, 0.3);
  EXPECT_EQ(deck.bodies[1].material.law, MaterialLaw::rigid);
  ASSERT_EQ(deck.contact.size(), 1u);
  EXPECT_EQ(deck.contact[0].name, "interface");
  EXPECT_EQ(deck.contact[0].impactor, "block_top");
  EXPECT_EQ(deck.contact[0].target, "punch_bottom");
  EXPECT_EQ(deck.contact[0].friction_coefficient, 0.2);
  EXPECT_EQ(deck.contact[0].where.line, 11);
  ASSERT_EQ(deck.boundary.size(), 2u);
  EXPECT_EQ(deck.boundary[0].fix, (std::vector<int>{0, 1}));
  EXPECT_EQ(deck.boundary[0].where.line, 16);
  EXPECT_EQ(deck.boundary[1].displacement.at(0).text, "0");
  EXPECT_EQ(deck.boundary[1].displacement.at(1).text, "-0.01*t");
  EXPECT_EQ(deck.boundary[1].displacement.at(1).where.line, 19);
  EXPECT_EQ(deck.boundary[1].displacement.at(1).where.column, 29);
  EXPECT_EQ(deck.loading.increments, 10);
}

TEST(Deck, LeavesDefaultsToTheStructs)
{
  const Deck deck = read_text(R"(
mesh: {file: mesh.msh, kinematics: 3d}
bodies: [{name: a, region: a, material: {law: linear-elastic, young: 1, poisson: 0}}]
)");
  EXPECT_EQ(deck.strain, Strain::small);
  EXPECT_EQ(deck.mesh.refine, 0);
  EXPECT_TRUE(deck.contact.empty());
  EXPECT_EQ(deck.loading.end, 1);
  EXPECT_FALSE(deck.loading.fixed);
  EXPECT_FALSE(deck.loading.min_increment.has_value());
  EXPECT_FALSE(deck.detection.distance.has_value());
  EXPECT_EQ(deck.solver.tolerance, SolverOptions{}.tolerance);
  EXPECT_EQ(deck.output.fields, OutputOptions{}.fields);
  EXPECT_FALSE(deck.bodies[0].mean_dilatation.has_value());
}

TEST(Deck, ReadsEveryOptionalKey)
{
  const Deck deck = read_text(R"(
mesh: {file: mesh.geo, kinematics: 3d, refine: 2, parameters: {n: 40, h: 2.5e-1}}
strain: finite
bodies:
  - {name: a, region: a, material: {law: neo-hookean, young: +2e5, poisson: -0.2}, mean-dilatation: false}
  - {name: r, region: r, material: {law: rigid}}
contact:
  - {name: c, impactor: a_top, target: r, friction: {law: none}, initial-overlap: adjust, augmentation: 10}
boundary:
  - {region: side, traction: {x: 1, z: sin(t)}, pressure: 2*x, spring: {y: 3}}
  - {region: a, body-force: {z: -9.81}}
  - {region: r, force: {x: 1}, moment: {y: 2}, rotation: {z: 0.1*t}, fix: [y, z]}
loading: {end: 2.5, increments: 5, min-increment: 0.01, max-increment: 1}
detection: {method: nearest-node, distance: 0.5, extension: 0, exchange: gathered}
solver: {linear: direct, multipliers: coupled, tolerance: 1e-10, max-iterations: 40}
output: {fields: [stress], every: 0}
)");
  EXPECT_EQ(deck.mesh.refine, 2);
  EXPECT_EQ(deck.mesh.parameters, (std::map<std::string, double>{{"n", 40}, {"h", 0.25}}));
  EXPECT_EQ(deck.strain, Strain::finite);
  EXPECT_EQ(deck.bodies[0].material.young, 2e5);
  EXPECT_EQ(deck.bodies[0].mean_dilatation, false);
  EXPECT_EQ(deck.contact[0].friction_coefficient, 0);
  EXPECT_EQ(deck.contact[0].initial_overlap, InitialOverlap::adjust);
  EXPECT_EQ(deck.contact[0].augmentation, 10);
  EXPECT_EQ(deck.boundary[0].traction.at(2).text, "sin(t)");
  EXPECT_EQ(deck.boundary[0].pressure->text, "2*x");
  EXPECT_EQ(deck.boundary[0].spring.at(1).text, "3");
  EXPECT_EQ(deck.boundary[1].body_force.at(2).text, "-9.81");
  EXPECT_EQ(deck.boundary[2].force.at(0).text, "1");
  EXPECT_EQ(deck.boundary[2].moment.at(1).text, "2");
  EXPECT_EQ(deck.boundary[2].rotation.at(2).text, "0.1*t");
  EXPECT_EQ(deck.loading.end, 2.5);
  EXPECT_EQ(deck.loading.min_increment, 0.01);
  EXPECT_EQ(deck.loading.max_increment, 1);
  EXPECT_EQ(deck.detection.method, DetectionMethod::nearest_node);
  EXPECT_EQ(deck.detection.distance, 0.5);
  EXPECT_EQ(deck.detection.extension, 0);
  EXPECT_EQ(deck.exchange.mode, ExchangeMode::gathered);
  EXPECT_EQ(deck.solver.linear, LinearSolverType::direct);
  EXPECT_EQ(deck.solver.max_iterations, 40);
  EXPECT_EQ(deck.output.fields, std::vector{OutputField::stress});
  EXPECT_EQ(deck.output.every, 0);
}

TEST(Deck, ReadsHardening)
{
  const std::string law = "von-mises, yield-stress: 3, isotropic-hardening: 20, saturation-gain: 1.5, "
                          "saturation-rate: 7, kinematic-hardening: 50, ";
  const MaterialOptions material = read_text(replaced(plane_deck, "linear-elastic, ", law)).bodies[0].material;
  EXPECT_EQ(material.law, MaterialLaw::von_mises);
  EXPECT_EQ(material.yield_stress, 3);
  EXPECT_EQ(material.isotropic_hardening, 20);
  EXPECT_EQ(material.saturation_gain, 1.5);
  EXPECT_EQ(material.saturation_rate, 7);
  EXPECT_EQ(material.kinematic_hardening, 50);
  const std::string perfect = replaced(plane_deck, "linear-elastic, ", "von-mises, yield-stress: 3, ");
  EXPECT_EQ(read_text(perfect).bodies[0].material.isotropic_hardening, 0);
  EXPECT_EQ(read_text(perfect + "output: {fields: [plastic-strain]}\n").output.fields,
            std::vector{OutputField::plastic_strain});
}

TEST(Deck, AutoIsTheSameAsNothing)
{
  const Deck deck = read_text(plane_deck + "detection: {distance: auto, extension: auto}\n");
  EXPECT_FALSE(deck.detection.distance.has_value());
  EXPECT_FALSE(deck.detection.extension.has_value());
}

TEST(Deck, ReadsAnalyticBodies)
{
  const Deck deck = read_text(R"(
mesh: {file: mesh.msh, kinematics: 3d}
bodies:
  - {name: a, region: a, material: {law: linear-elastic, young: 1, poisson: 0}}
  - {name: plane, shape: {type: plane, point: [0, 0, 1], normal: [0, 3, 4]}, material: {law: rigid}}
  - {name: cone, shape: {type: cone, point: [0, 0, 1], axis: [0, 0, 2], half-angle: 60}, material: {law: rigid}}
  - {name: bar, shape: {type: cylinder, point: [1, 2, 3], axis: [1, 0, 0], radius: 0.5}, material: {law: rigid}}
  - {name: ball, shape: {type: sphere, point: [1, 2, 3], radius: 2}, material: {law: rigid}}
)");
  EXPECT_EQ(deck.bodies[1].shape->type, ShapeType::plane);
  EXPECT_NEAR(deck.bodies[1].shape->axis[1], 0.6, 1e-15);
  EXPECT_NEAR(deck.bodies[1].shape->axis[2], 0.8, 1e-15);
  EXPECT_EQ(deck.bodies[1].shape->point[2], 1);
  EXPECT_NEAR(deck.bodies[2].shape->half_angle, std::numbers::pi / 3, 1e-15);
  EXPECT_EQ(deck.bodies[2].shape->axis[2], 1);
  EXPECT_EQ(deck.bodies[3].shape->radius, 0.5);
  EXPECT_EQ(deck.bodies[4].shape->type, ShapeType::sphere);
  EXPECT_EQ(deck.bodies[0].shape.has_value(), false);
}

TEST(Deck, FindsTheMeshBesideItself)
{
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "meshes");
  folder.write("meshes/m.msh", "");
  const auto file = folder.write("deck.yaml", replaced(plane_deck, "mesh.msh", "./meshes/m.msh"));
  EXPECT_EQ(read_deck(file).mesh.file, (folder.path() / "meshes" / "m.msh").string());
  EXPECT_EQ(read_deck(std::filesystem::relative(file)).mesh.file, (folder.path() / "meshes" / "m.msh").string());
}

TEST(Deck, ExamplesAreRight)
{
  const auto examples = std::filesystem::path(__FILE__).parent_path() / "../../examples";
  int n_decks = 0;
  for (const auto &entry : std::filesystem::recursive_directory_iterator(examples))
    if (entry.path().extension() == ".yaml")
    {
      EXPECT_NO_THROW(read_deck(entry.path())) << entry.path();
      ++n_decks;
    }
  EXPECT_GT(n_decks, 0);
}
} // namespace amontons::test
