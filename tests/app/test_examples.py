"""Every example by every form and solver that it allows: the same forces and statuses in every increment.

Long examples are shortened: coarser meshes, fewer increments. Nothing else of a deck changes but the tolerance.
"""
import os
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).parents[2] / "scripts"))
from results import run  # noqa: E402

PROGRAM = os.environ["AMONTONS"]
EXAMPLES = Path(__file__).parents[2] / "examples"
SAME = 1e-8

# The first one is what the others are held against.
SOLVERS = {"coupled, direct": ("coupled", "direct"), "condensed, direct": ("condensed", "direct"),
           "condensed, amg": ("condensed", "amg"), "feti": ("condensed", "feti")}

# deck: what shortens it
SMALL_STRAIN = {
    "patch-tests/plane-matching": [],
    "patch-tests/plane-non-matching": [],
    "patch-tests/plane-mortar": [],
    "patch-tests/space-matching": [],
    "patch-tests/space-non-matching": [],
    "patch-tests/space-mortar": [],
    "press-fit/press-fit": ["mesh.parameters.n_inner=48", "mesh.parameters.n_outer=36"],
    "press-fit/interference": ["mesh.parameters.n_inner=32", "mesh.parameters.n_outer=32"],
    "hertz-cylinder/hertz-cylinder": ["mesh.parameters.n_cylinder=16", "mesh.parameters.n_block=8"],
    "hertz-sphere/hertz-sphere": ["mesh.parameters.n=20"],
    "hertz-sphere/friction": ["mesh.parameters.n=20", "loading.increments=12"],
    "punch/punch": ["mesh.parameters.n=40"],
}
FINITE_STRAIN = {
    # An odd number of cells: nodes on an edge of the target, in exact symmetry, go to one side or the other by round-off.
    "blocks-3d/blocks-3d": ["mesh.parameters.n_small=5", "mesh.parameters.n_large=3", "loading.end=1.5",
                            "loading.increments=10"],
    "ironing/ironing": ["mesh.parameters.n_block=60", "mesh.parameters.n_indenter=6", "loading.end=1.04",
                        "loading.increments=52"],
    "self-contact/ring": ["mesh.parameters.n=20", "loading.end=1.6", "loading.increments=40"],
}


class Examples(unittest.TestCase):
    def solve(self, deck, solver, overrides):
        multipliers, linear = SOLVERS[solver]
        folder = tempfile.mkdtemp(prefix="amontons-")
        self.addCleanup(shutil.rmtree, folder)
        finished = run(PROGRAM, str(EXAMPLES / f"{deck}.yaml"),
                       [*overrides, f"solver.multipliers={multipliers}", f"solver.linear={linear}",
                        "solver.tolerance=1e-10", "output.every=0"], folder)
        self.assertTrue(finished.converged, finished.record.get("failure"))
        return finished

    def expect_same_sums(self, a, b):
        """Of every contact after every increment, forces relative to the contact's greatest one so far."""
        self.assertEqual([i["time"] for i in a.increments], [i["time"] for i in b.increments])
        scale = {}
        for of_a, of_b in zip(a.increments, b.increments):
            for x, y in zip(of_a["contacts"], of_b["contacts"]):
                where = f"{x['name']} at t = {of_a['time']}"
                for count in ("n_active", "n_stick", "n_slip"):
                    self.assertEqual(x[count], y[count], f"{count} of {where}")
                name = x["name"]
                scale[name] = max([scale.get(name, 0), *map(abs, x["normal_force"])])
                for force in ("normal_force", "tangential_force"):
                    for p, q in zip(x[force], y[force]):
                        self.assertLessEqual(abs(p - q), SAME * scale[name], f"{force} of {where}: {p} and {q}")

    def expect_same_nodes(self, a, b):
        """At the end: statuses, and forces relative to the contact's greatest one on a node."""
        for contact in a.increments[-1]["contacts"]:
            rows = list(zip(a.nodes(contact["name"]), b.nodes(contact["name"])))
            axes = [axis for axis in ("fx", "fy", "fz") if axis in rows[0][0]]
            scale = max(abs(x[axis]) for x, _ in rows for axis in axes)
            for x, y in rows:
                where = f"node {x['id']:.0f} of {contact['name']}"
                self.assertEqual((x["id"], x["status"]), (y["id"], y["status"]), where)
                for axis in axes:
                    self.assertLessEqual(abs(x[axis] - y[axis]), SAME * scale, f"{axis} of {where}")

    def expect_same(self, deck, solvers, overrides):
        reference, *others = solvers
        a = self.solve(deck, reference, overrides)
        self.assertGreater(sum(c["n_active"] for c in a.increments[-1]["contacts"]), 0)
        for solver in others:
            with self.subTest(deck=deck, solver=solver):
                b = self.solve(deck, solver, overrides)
                self.expect_same_sums(a, b)
                self.expect_same_nodes(a, b)

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
