#include "input/deck_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace amontons::test
{
/// What is changed in plane_deck, and what the reader says of it.
struct BadDeck
{
  const char *name;
  const char *part;
  const char *by;
  const char *message;
};

void PrintTo(const BadDeck &bad, std::ostream *out)
{
  *out << bad.name;
}

class DeckError : public testing::TestWithParam<BadDeck>
{
};

TEST_P(DeckError, SaysWhatAndWhere)
{
  const BadDeck &bad = GetParam();
  EXPECT_EQ(error_of(replaced(plane_deck, bad.part, bad.by)), bad.message);
}

const BadDeck words[]{
    {"UnknownKey", "young", "yuong",
     "deck.yaml:6:37: unknown key 'yuong' in bodies.0.material (did you mean 'young'?); allowed here: law, young, "
     "poisson, yield-stress, isotropic-hardening, saturation-gain, saturation-rate, kinematic-hardening"},
    {"UnknownTopKey", "loading", "lodaing",
     "deck.yaml:20:1: unknown key 'lodaing' (did you mean 'loading'?); allowed here: title, mesh, strain, bodies, "
     "contact, boundary, loading, detection, solver, output"},
    {"UnknownKeyFarFromAll", "title", "colour",
     "deck.yaml:1:1: unknown key 'colour'; allowed here: title, mesh, strain, bodies, contact, boundary, loading, "
     "detection, solver, output"},
    {"Underscore", "increments: 10", "min_increment: 0.1",
     "deck.yaml:20:11: unknown key 'min_increment' in loading (did you mean 'min-increment'?); allowed here: end, "
     "increments, fixed, min-increment, max-increment"},
    {"Choice", "linear-elastic", "linear-elastik",
     "deck.yaml:6:21: bodies.0.material.law: must be one of linear-elastic, neo-hookean, von-mises, rigid, not "
     "'linear-elastik' (did you mean 'linear-elastic'?)"},
    {"CoupledMultigrid", "loading:", "solver: {linear: amg, multipliers: coupled}\nloading:",
     "deck.yaml:20:36: solver.multipliers: must be condensed with linear: amg or feti; coupled goes with linear: "
     "direct "
     "or auto"},
    {"DuplicateKey", "    region: punch\n", "    region: punch\n    region: block\n",
     "deck.yaml:9:5: the key 'region' stands twice in the same place; first at deck.yaml:8:5"},
    {"MissingKey", "poisson: 0.3", "",
     "deck.yaml:6:15: bodies.0.material: the key 'poisson' is missing (required unless "
     "the law is rigid)"},
    {"MissingRegion", "    region: block\n", "",
     "deck.yaml:4:5: bodies.0: one of the keys 'region' (a meshed body) and 'shape' (an analytic one) is missing"},
    {"MissingKinematics", ", kinematics: plane-strain", "",
     "deck.yaml:2:7: mesh: the key 'kinematics' is missing (what the mesh stands for; axisymmetric: x is the radius, y "
     "the axis; in the plane all forces are per unit thickness)"},
    {"NoCoefficient", ", coefficient: 0.2", "",
     "deck.yaml:14:15: contact.0.friction: the key 'coefficient' is missing (required with law: coulomb)"},
    {"CoefficientWithoutFriction", "law: coulomb", "law: none",
     "deck.yaml:14:40: contact.0.friction.coefficient: has no meaning with law: none"},
    {"YieldStressOfElastic", "poisson: 0.3", "poisson: 0.3, yield-stress: 1",
     "deck.yaml:6:78: bodies.0.material.yield-stress: has a meaning with law: von-mises only"},
    {"NoYieldStress", "linear-elastic", "von-mises",
     "deck.yaml:6:15: bodies.0.material: the key 'yield-stress' is missing (required with law: von-mises)"},
    {"HalfOfVoce", "linear-elastic, ", "von-mises, yield-stress: 1, saturation-gain: 2, ",
     "deck.yaml:6:15: bodies.0.material: the keys 'saturation-gain' and 'saturation-rate' go together"},
    {"RigidWithYoung", "{law: rigid}", "{law: rigid, young: 1}",
     "deck.yaml:9:35: bodies.1.material.young: has no meaning with law: rigid"},
};

const BadDeck types[]{
    {"NumberIsText", "1000", "stiff", "deck.yaml:6:44: bodies.0.material.young: must be a number, not 'stiff'"},
    {"NumberInQuotes", "1000", "'1000'",
     "deck.yaml:6:44: bodies.0.material.young: must be a number, not the text '1000'"},
    {"NumberWithUnit", "1000", "1000 MPa", "deck.yaml:6:44: bodies.0.material.young: must be a number, not '1000 MPa'"},
    {"NumberIsNan", "1000", "nan", "deck.yaml:6:44: bodies.0.material.young: must be a number, not 'nan'"},
    {"NumberIsInfinite", "1000", "1e999", "deck.yaml:6:44: bodies.0.material.young: must be a number, not '1e999'"},
    {"NumberIsList", "1000", "[1000]", "deck.yaml:6:44: bodies.0.material.young: must be a number, not a list"},
    {"NumberIsMissing", "1000", "", "deck.yaml:6:44: bodies.0.material.young: must be a number, not nothing"},
    {"NegativeYoung", "1000", "-1", "deck.yaml:6:44: bodies.0.material.young: must be greater than 0, not -1"},
    {"Poisson", "0.3", "0.5",
     "deck.yaml:6:59: bodies.0.material.poisson: must be greater than -1 and less than 0.5, not 0.5"},
    {"NegativeFriction", "0.2", "-0.2",
     "deck.yaml:14:43: contact.0.friction.coefficient: must be at least 0, not -0.2"},
    {"IncrementsNotWhole", "increments: 10", "increments: 2.5",
     "deck.yaml:20:23: loading.increments: must be a whole number, not '2.5'"},
    {"NoIncrements", "increments: 10", "increments: 0",
     "deck.yaml:20:23: loading.increments: must be at least 1, not 0"},
    {"Boolean", "increments: 10", "fixed: 1", "deck.yaml:20:18: loading.fixed: must be true or false, not '1'"},
    {"MapIsScalar", "{law: rigid}", "rigid",
     "deck.yaml:9:15: bodies.1.material: must be a map of the keys law, young, poisson, "
     "yield-stress, isotropic-hardening, saturation-gain, saturation-rate, kinematic-hardening, not 'rigid'"},
    {"ListIsMap", "contact:\n  - name", "contact:\n    name",
     "deck.yaml:11:5: contact: must be a list of entries, not a map of keys"},
    {"EmptyList", "fix: [x, y]", "fix: []",
     "deck.yaml:17:10: boundary.0.fix: must be a list of components, not an "
     "empty one"},
    {"TextIsMap", "title: A punch", "title: {a: b}", "deck.yaml:1:8: title: must be text, not a map of keys"},
    {"DistanceWord", "loading:", "detection: {distance: automatic}\nloading:",
     "deck.yaml:20:23: detection.distance: must be a number or auto, not 'automatic'"},
    {"Refine", "plane-strain}", "plane-strain, refine: 30}",
     "deck.yaml:2:58: mesh.refine: must be at least 0 and at most 8, not 30"},
    {"ExpressionIsList", "\"-0.01*t\"", "[1]",
     "deck.yaml:19:29: boundary.1.displacement.y: must be a number or an expression of t, x, y, z, not a list"},
};

const BadDeck components[]{
    {"NoZInThePlane", "[x, y]", "[x, z]",
     "deck.yaml:17:14: boundary.0.fix: no component 'z' here; the components are x, y"},
    {"ComponentTwice", "[x, y]", "[x, x]", "deck.yaml:17:14: boundary.0.fix.1: the component 'x' stands twice"},
    {"NoSuchComponent", "{x: 0,", "{r: 0,",
     "deck.yaml:19:20: boundary.1.displacement: no component 'r' here; the components are x, y"},
    {"RotationInThePlane", "displacement: {x: 0, y: \"-0.01*t\"}", "rotation: {x: 0}",
     "deck.yaml:19:16: boundary.1.rotation: no component 'x' here; the components are z"},
    {"SaysNothing", "    fix: [x, y]\n", "",
     "deck.yaml:16:5: boundary.0: says nothing about 'block_bottom'; give one of fix, displacement, rotation, "
     "traction, "
     "pressure, spring, force, moment, body-force"},
};

const BadDeck conflicts[]{
    {"ImpactorIsTarget", "target: punch_bottom", "target: block_top",
     "deck.yaml:13:13: contact.0.target: the impactor and the target are the same, 'block_top'; a contact pair has two "
     "sides. Where a surface touches itself, write 'surface: block_top' instead of both"},
    {"SurfaceAndTarget", "impactor: block_top", "surface: block_top",
     "deck.yaml:13:13: contact.0.target: has no meaning with 'surface', which is both sides of its own contact"},
    {"NoImpactor", "    impactor: block_top\n", "",
     "deck.yaml:11:5: contact.0: the key 'impactor' is missing (a contact has impactor and target, or, where a surface "
     "touches itself, 'surface')"},
    {"SelfDistanceOfAPair", "target: punch_bottom", "target: punch_bottom\n    self-distance: 1",
     "deck.yaml:14:20: contact.0.self-distance: has a meaning with 'surface' only, where a surface touches itself"},
    {"BodyNameTwice", "name: punch", "name: block",
     "deck.yaml:7:11: bodies.1.name: 'block' is taken already, at deck.yaml:4:11"},
    {"RegionTwice", "region: punch", "region: block",
     "deck.yaml:8:13: bodies.1.region: 'block' is taken already, at deck.yaml:5:13"},
    {"ContactNameTwice", "boundary:", "  - {name: interface, impactor: a, target: b}\nboundary:",
     "deck.yaml:15:12: contact.1.name: 'interface' is taken already, at deck.yaml:11:11"},
    {"PairTwice", "boundary:", "  - {name: again, impactor: punch_bottom, target: block_top}\nboundary:",
     "deck.yaml:15:51: contact.1.target: 'punch_bottom' and 'block_top' are already a pair, in 'interface'"},
    {"ContactNameIsNoFile", "name: interface", "name: a/b",
     "deck.yaml:11:11: contact.0.name: must be of letters, digits, '-', '_' and '.', not 'a/b'"},
    {"FixAndDisplacement", "    fix: [x, y]\n", "    fix: [x, y]\n    displacement: {x: 1}\n",
     "deck.yaml:18:23: displacement x on 'block_bottom' contradicts fix x at deck.yaml:17:11; a component can be given "
     "once"},
    {"DisplacementTwice", "loading", "  - {region: punch, displacement: {y: 2}}\nloading",
     "deck.yaml:20:39: displacement y on 'punch' contradicts displacement y at deck.yaml:19:29; a component can be "
     "given "
     "once"},
    {"DisplacementAndForce", "loading", "  - {region: punch, force: {y: -5}}\nloading",
     "deck.yaml:20:32: force y on 'punch' contradicts displacement y at deck.yaml:19:29; a component can be given "
     "once"},
    {"MomentAndRotation", "displacement: {x: 0, y: \"-0.01*t\"}", "moment: {z: 0}\n    rotation: {z: 0}",
     "deck.yaml:19:17: moment z on 'punch' contradicts rotation z at deck.yaml:20:19; a component can be given once"},
    {"RotationOfDeformable", "fix: [x, y]", "rotation: {z: 0.1}",
     "deck.yaml:17:15: boundary.0.rotation: is for rigid bodies, and 'block_bottom' is none; rigid bodies: punch"},
    {"PressureOnRigid", "displacement: {x: 0, y: \"-0.01*t\"}", "pressure: 1",
     "deck.yaml:19:15: boundary.1.pressure: cannot act on the rigid body 'punch'; give its force or its displacement"},
    {"TractionOnWholeBody", "region: block_bottom\n    fix: [x, y]", "region: block\n    traction: {x: 1}",
     "deck.yaml:17:15: boundary.0.traction: acts on a group of faces or points, and 'block' is the cells of a body"},
    {"MortarNormals", "    friction:", "    discretization: mortar\n    normals: smoothed\n    friction:",
     "deck.yaml:15:14: contact.0.normals: is for discretization: node-to-face; mortar takes the mean normal at each "
     "node"},
    {"MortarMethod", "    friction: {law: coulomb, coefficient: 0.2}",
     "    discretization: mortar\ndetection: {method: exact}",
     "deck.yaml:15:21: detection.method: is for discretization: node-to-face; mortar finds all faces that lie over "
     "each other within the distance"},
    {"ElasticInFiniteStrain", "loading", "strain: finite\nloading",
     "deck.yaml:6:21: bodies.0.material.law: linear-elastic holds in strain: small only; use neo-hookean with strain: "
     "finite"},
    {"HyperelasticInSmallStrain", "linear-elastic", "neo-hookean",
     "deck.yaml:6:21: bodies.0.material.law: neo-hookean wants strain: finite; use linear-elastic with strain: small"},
    {"PlasticInFiniteStrain", "bodies:\n  - name: block\n    region: block\n    material: {law: linear-elastic, ",
     "strain: finite\nbodies:\n  - name: block\n    region: block\n    material: {law: von-mises, yield-stress: 1, ",
     "deck.yaml:7:21: bodies.0.material.law: von-mises holds in strain: small only"},
    {"MeanDilatationInPlaneStress", "plane-strain}\nbodies:\n  - name: block",
     "plane-stress}\nbodies:\n  - name: block\n    mean-dilatation: true",
     "deck.yaml:5:22: bodies.0.mean-dilatation: must be false in plane stress, where nothing locks"},
    {"FixedWithLimits", "increments: 10", "fixed: true, max-increment: 1",
     "deck.yaml:20:39: loading.max-increment: has no meaning with fixed: true"},
    {"LeastAboveFirst", "increments: 10", "increments: 10, min-increment: 0.2",
     "deck.yaml:20:42: loading.min-increment: must be at most the first increment, end / increments = 0.1"},
};

const BadDeck files[]{
    {"NoMesh", "mesh.msh", "nowhere.msh", "deck.yaml:2:14: mesh.file: there is no file 'nowhere.msh'"},
    {"NotAMesh", "mesh.msh", "mesh.vtk", "deck.yaml:2:14: mesh.file: must name a .msh or a .geo, not 'mesh.vtk'"},
    {"Syntax", "{law: rigid}", "{law: rigid", "deck.yaml:10:8: not readable as YAML: end of map flow not found"},
    {"TwoDocuments", "contact:", "---\ncontact:", "deck.yaml:11:1: a second document; a deck is one"},
};

std::string name_of(const testing::TestParamInfo<BadDeck> &info)
{
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Words, DeckError, testing::ValuesIn(words), name_of);
INSTANTIATE_TEST_SUITE_P(Types, DeckError, testing::ValuesIn(types), name_of);
INSTANTIATE_TEST_SUITE_P(Components, DeckError, testing::ValuesIn(components), name_of);
INSTANTIATE_TEST_SUITE_P(Conflicts, DeckError, testing::ValuesIn(conflicts), name_of);
INSTANTIATE_TEST_SUITE_P(Files, DeckError, testing::ValuesIn(files), name_of);

TEST(DeckError, OfAFileThatIsNoDeck)
{
  EXPECT_EQ(error_of(""), "deck.yaml: the deck is empty");
  EXPECT_EQ(error_of("- a\n- b\n"), "deck.yaml:1:1: the deck must be a map of keys, not a list");
  EXPECT_THROW(read_deck("/nowhere/deck.yaml"), UserError);
  EXPECT_THROW(read_deck(std::filesystem::temp_directory_path()), UserError);
}

TEST(DeckError, FixTwiceIsNoConflict)
{
  const std::string twice = replaced(plane_deck, "loading", "  - {region: block_bottom, fix: [x]}\nloading");
  EXPECT_EQ(error_of(twice), "no error");
}

TEST(DeckError, KeysOfAListThatFeedsItself)
{
  EXPECT_THAT(error_of("contact: &a [*a]\n"), testing::HasSubstr("nested deeper"));
}
} // namespace amontons::test
