#include "input/deck_files.h"

#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
std::string error_of_shape(const std::string &kinematics, const std::string &shape, const std::string &law = "rigid")
{
  return error_of("mesh: {file: mesh.msh, kinematics: " + kinematics + "}\nbodies:\n- name: tool\n  shape: " + shape +
                  "\n  material: {law: " + law + "}\n");
}
} // namespace

TEST(ShapeError, WrongKinematics)
{
  EXPECT_EQ(error_of_shape("3d", "{type: circle, point: [0, 0, 0], radius: 1}"),
            "deck.yaml:4:17: bodies.0.shape.type: a circle goes with kinematics: plane-strain or plane-stress");
  EXPECT_EQ(error_of_shape("plane-strain", "{type: sphere, point: [0, 0], radius: 1}"),
            "deck.yaml:4:17: bodies.0.shape.type: a sphere goes with kinematics: 3d or axisymmetric");
  EXPECT_EQ(error_of_shape("axisymmetric", "{type: cylinder, point: [0, 0], axis: [0, 1], radius: 1}"),
            "deck.yaml:4:17: bodies.0.shape.type: a cylinder goes with kinematics: 3d");
  EXPECT_EQ(error_of_shape("plane-stress", "{type: circle, point: [0, 0], radius: 1}"), "no error");
  EXPECT_EQ(error_of_shape("axisymmetric", "{type: cone, point: [0, 1], axis: [0, 5], half-angle: 80}"), "no error");
}

TEST(ShapeError, WrongKeys)
{
  EXPECT_EQ(error_of_shape("3d", "{type: sphere, point: [0, 0, 0]}"),
            "deck.yaml:4:10: bodies.0.shape: the key 'radius' is missing; a sphere has the keys type, point, radius");
  EXPECT_EQ(error_of_shape("3d", "{type: sphere, point: [0, 0, 0], radius: 1, axis: [0, 0, 1]}"),
            "deck.yaml:4:60: bodies.0.shape.axis: has no meaning for a sphere, which has the keys type, point, radius");
  EXPECT_EQ(error_of_shape("3d", "{type: plane, point: [0, 0], normal: [0, 0, 1]}"),
            "deck.yaml:4:31: bodies.0.shape.point: must be a list of 3 numbers, not of 2");
  EXPECT_EQ(error_of_shape("3d", "{type: plane, point: [0, 0, a], normal: [0, 0, 1]}"),
            "deck.yaml:4:38: bodies.0.shape.point.2: must be a number, not 'a'");
  EXPECT_EQ(error_of_shape("3d", "{type: plane, point: [0, 0, 0], normal: [0, 0, 0]}"),
            "deck.yaml:4:50: bodies.0.shape.normal: must be a direction, not zero");
  EXPECT_EQ(error_of_shape("3d", "{type: cone, point: [0, 0, 0], axis: [0, 0, 1], half-angle: 90}"),
            "deck.yaml:4:70: bodies.0.shape.half-angle: must be greater than 0 and less than 90, not 90");
}

TEST(ShapeError, OffTheAxisOfSymmetry)
{
  EXPECT_EQ(error_of_shape("axisymmetric", "{type: plane, point: [3, 0], normal: [1, 1]}"),
            "deck.yaml:4:47: bodies.0.shape.normal: must lie along y, the axis of symmetry; an oblique plane would be "
            "a cone");
  EXPECT_EQ(error_of_shape("axisymmetric", "{type: sphere, point: [1, 0], radius: 1}"),
            "deck.yaml:4:32: bodies.0.shape.point: must lie on the axis of symmetry, x = 0");
}

TEST(ShapeError, OfItsBody)
{
  const std::string plane = "{type: plane, point: [0, 0], normal: [0, 1]}";
  EXPECT_EQ(error_of_shape("plane-strain", plane, "linear-elastic, young: 1, poisson: 0"),
            "deck.yaml:5:19: bodies.0.material.law: must be rigid for a body given by its shape");
  EXPECT_EQ(error_of_shape("plane-strain", plane + "\n  region: a"),
            "deck.yaml:4:10: bodies.0.shape: a body is either meshed (region) or analytic (shape), not both");
}

TEST(ShapeError, OfItsContactAndMotion)
{
  const std::string deck = R"(mesh: {file: mesh.msh, kinematics: plane-strain}
bodies:
- {name: block, region: block, material: {law: linear-elastic, young: 1, poisson: 0}}
- {name: floor, shape: {type: plane, point: [0, 0], normal: [0, 1]}, material: {law: rigid}}
)";
  EXPECT_EQ(error_of(deck + "contact: [{name: c, impactor: bottom, target: floor}]\n"), "no error");
  EXPECT_EQ(error_of(deck + "contact: [{name: c, impactor: floor, target: bottom}]\n"),
            "deck.yaml:5:31: contact.0.impactor: 'floor' is an analytic body, which has no nodes; make it the target");
  EXPECT_EQ(error_of(deck + "boundary: [{region: floor, displacement: {y: t}}]\n"), "no error");
  EXPECT_EQ(error_of(deck + "boundary: [{region: floor, rotation: {z: t}}]\n"),
            "deck.yaml:5:38: boundary.0.rotation: 'floor' is an analytic body, which moves without turning");
  EXPECT_EQ(error_of(deck + "boundary: [{region: floor, traction: {y: 1}}]\n"),
            "deck.yaml:5:38: boundary.0.traction: cannot act on the rigid body 'floor'; give its force or its "
            "displacement");
}
} // namespace amontons::test
