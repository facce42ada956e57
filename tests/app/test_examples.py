"""Every example by every form and solver that it allows: the same forces and statuses in every increment.

Long examples are shortened (scripts/examples.py). Nothing else of a deck changes but the tolerance.
"""
import os
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).parents[2] / "scripts"))
from examples import EXAMPLES, FINITE_STRAIN, SMALL_STRAIN, deck_of, differences  # noqa: E402
from results import run  # noqa: E402

PROGRAM = os.environ["AMONTONS"]
# Other solvers may take other iterations.
SAME = {"increments": 0, "times": 0, "statuses": 0, "forces": 1e-8, "node_forces": 1e-8}

# The first one is what the others are held against.
SOLVERS = {"coupled, direct": ("coupled", "direct"), "condensed, direct": ("condensed", "direct"),
           "condensed, amg": ("condensed", "amg"), "feti": ("condensed", "feti")}


class Examples(unittest.TestCase):
    def solve(self, deck, solver, overrides):
        multipliers, linear = SOLVERS[solver]
        folder = tempfile.mkdtemp(prefix="amontons-")
        self.addCleanup(shutil.rmtree, folder)
        finished = run(PROGRAM, deck_of(deck),
                       [*overrides, f"solver.multipliers={multipliers}", f"solver.linear={linear}",
                        "solver.tolerance=1e-10", "output.every=0"], folder)
        self.assertTrue(finished.converged, finished.record.get("failure"))
        return finished

    def expect_same(self, deck, solvers, overrides):
        reference, *others = solvers
        a = self.solve(deck, reference, overrides)
        self.assertGreater(sum(c["n_active"] for c in a.increments[-1]["contacts"]), 0)
        for solver in others:
            with self.subTest(deck=deck, solver=solver):
                b = self.solve(deck, solver, overrides)
                for quantity, where, difference in differences(a, b):
                    if quantity in SAME:
                        self.assertLessEqual(difference, SAME[quantity], f"{quantity}: {where}")

    def test_small_strain(self):
        for deck, overrides in SMALL_STRAIN.items():
            self.expect_same(deck, list(SOLVERS), overrides)

    def test_finite_strain(self):
        for deck, overrides in FINITE_STRAIN.items():
            self.expect_same(deck, [solver for solver in SOLVERS if solver != "feti"], overrides)

    def test_feti_refuses_finite_strain(self):
        for deck, overrides in FINITE_STRAIN.items():
            with self.subTest(deck=deck), self.assertRaisesRegex(RuntimeError, "exit code 2\n(.*\n)*.*small strain"):
                self.solve(deck, "feti", overrides)

    def test_every_example_is_here(self):
        decks = {str(deck.relative_to(EXAMPLES).with_suffix("")) for deck in EXAMPLES.glob("*/*.yaml")}
        self.assertEqual(decks, set(SMALL_STRAIN) | set(FINITE_STRAIN))


if __name__ == "__main__":
    unittest.main()
