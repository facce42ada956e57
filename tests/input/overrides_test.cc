#include "input/deck_files.h"

#include <gtest/gtest.h>

namespace amontons::test
{
TEST(Overrides, ReplaceAndAdd)
{
  const Deck deck = read_text(plane_deck, {"bodies.0.material.poisson=0.1", "contact.0.friction.coefficient=0.7",
                                           "solver.tolerance=1e-6", "boundary.0.fix=[y]", "title=b = c",
                                           "boundary.1.displacement.y=-t^2", "contact.0.augmentation=2"});
  EXPECT_EQ(deck.bodies[0].material.poisson, 0.1);
  EXPECT_EQ(deck.bodies[0].material.young, 1000);
  EXPECT_EQ(deck.contact[0].friction_coefficient, 0.7);
  EXPECT_EQ(deck.contact[0].augmentation, 2);
  EXPECT_EQ(deck.solver.tolerance, 1e-6);
  EXPECT_EQ(deck.boundary[0].fix, std::vector<int>{1});
  EXPECT_EQ(deck.boundary[1].displacement.at(1).text, "-t^2");
  EXPECT_EQ(deck.boundary[1].displacement.at(1).where.text(), "--set boundary.1.displacement.y=-t^2");
  EXPECT_EQ(deck.title, "b = c");
}

TEST(Overrides, TheLastOneHolds)
{
  EXPECT_EQ(read_text(plane_deck, {"loading.end=2", "loading.end=3"}).loading.end, 3);
}

TEST(Overrides, ErrorsNameThem)
{
  EXPECT_EQ(error_of(plane_deck, {"bodies.0.material.poisson=0.7"}),
            "--set bodies.0.material.poisson=0.7: bodies.0.material.poisson: must be greater than -1 and less than "
            "0.5, not 0.7");
  EXPECT_EQ(error_of(plane_deck, {"bodies.0.material.poison=0.2"}),
            "--set bodies.0.material.poison=0.2: unknown key 'poison' in bodies.0.material (did you mean 'poisson'?); "
            "allowed here: law, young, poisson, "
            "yield-stress, isotropic-hardening, saturation-gain, saturation-rate, kinematic-hardening");
  EXPECT_EQ(error_of(plane_deck, {"solvr.tolerance=0.2"}),
            "--set solvr.tolerance=0.2: unknown key 'solvr' (did you mean 'solver'?); allowed here: title, mesh, "
            "strain, bodies, contact, boundary, loading, detection, solver, output");
  EXPECT_EQ(error_of(plane_deck, {"bodies.2.name=c"}),
            "--set bodies.2.name=c: 'bodies' is a list of 2; its items are named by position from 0, not '2'");
  EXPECT_EQ(error_of(plane_deck, {"bodies.block.name=c"}),
            "--set bodies.block.name=c: 'bodies' is a list of 2; its items are named by position from 0, not 'block'");
  EXPECT_EQ(error_of(plane_deck, {"title.size=3"}), "--set title.size=3: 'title' is 'A punch' and has no key 'size'");
  EXPECT_EQ(error_of(plane_deck, {"title"}),
            "--set title: must be key.path=value, as in bodies.0.material.poisson=0.3");
  EXPECT_EQ(error_of(plane_deck, {"=3"}), "--set =3: must be key.path=value, as in bodies.0.material.poisson=0.3");
  EXPECT_EQ(error_of(plane_deck, {"loading..end=3"}),
            "--set loading..end=3: must be key.path=value; there is an empty key in the path");
  EXPECT_EQ(error_of(plane_deck, {"boundary.0.fix=[x"}),
            "--set boundary.0.fix=[x: not readable as YAML: end of sequence flow not found");
  EXPECT_EQ(error_of(plane_deck, {"loading.end="}), "--set loading.end=: loading.end: must be a number, not nothing");
}
} // namespace amontons::test
