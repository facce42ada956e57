"""Runs the command in a folder of its own, on decks made from a small one that is right."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).parents[2] / "scripts"))
from results import launcher  # noqa: E402

PROGRAM = os.environ["AMONTONS"]

# Two blocks with their own nodes at y = 0; the upper one is `depth` inside the lower one where that is > 0.
GEOMETRY = """
DefineConstant[ n = {4}, depth = {0} ];
Macro CellBlock
  p = newp; Point(p) = {x0, y0, 0}; Point(p+1) = {x1, y0, 0}; Point(p+2) = {x1, y1, 0}; Point(p+3) = {x0, y1, 0};
  l = newl; Line(l) = {p, p+1}; Line(l+1) = {p+1, p+2}; Line(l+2) = {p+2, p+3}; Line(l+3) = {p+3, p};
  c = newll; Curve Loop(c) = {l, l+1, l+2, l+3};
  s = news; Plane Surface(s) = {c};
  Transfinite Curve {l, l+1, l+2, l+3} = m + 1;
  Transfinite Surface {s}; Recombine Surface {s};
Return
x0 = 0; x1 = 2; y0 = -2; y1 = 0; m = 2*n; Call CellBlock;
Physical Surface("lower") = {s}; Physical Curve("lower_bottom") = {l}; Physical Curve("lower_top") = {l+2};
x0 = 0.5; x1 = 1.5; y0 = -depth; y1 = 1 - depth; m = n + 1; Call CellBlock;
Physical Surface("upper") = {s}; Physical Curve("upper_bottom") = {l}; Physical Curve("upper_top") = {l+2};
"""

DECK = """\
title: Block on block
mesh: {file: blocks.geo, kinematics: plane-strain}
bodies:
  - {name: below, region: lower, material: {law: linear-elastic, young: 1000, poisson: 0.3}}
  - {name: above, region: upper, material: {law: linear-elastic, young: 1000, poisson: 0.3}}
contact:
  - {name: interface, impactor: upper_bottom, target: lower_top, friction: {law: coulomb, coefficient: 0.3}}
boundary:
  - {region: lower_bottom, fix: [x, y]}
  - {region: upper_top, displacement: {x: "0.005*t", y: "-0.01*t"}}
loading: {increments: 2}
"""


def children(process):
    """Ids of the processes that another has started, as mpirun does."""
    return [int(child) for task in pathlib.Path(f"/proc/{process}/task").iterdir()
            for child in (task / "children").read_text(encoding="ascii").split()]


class CommandTest(unittest.TestCase):
    """Each test has a folder of its own with deck.yaml and blocks.geo, and works in it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="amontons-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "blocks.geo").write_text(GEOMETRY, encoding="utf-8")
        self.write_deck()

    def write_deck(self, *replacements):
        """The deck with each (part, by) replaced; a part must occur once."""
        text = DECK
        for part, by in replacements:
            self.assertEqual(text.count(part), 1, f"'{part}' in the deck")
            text = text.replace(part, by)
        (self.folder / "deck.yaml").write_text(text, encoding="utf-8")

    def call(self, *arguments, processes=1):
        """The finished process, with stdout and stderr as text."""
        return subprocess.run([*launcher(processes), PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True,
                              check=False, timeout=300)

    def succeed(self, *arguments, **how):
        """Standard output of a call that must succeed without a word on standard error."""
        done = self.call(*arguments, **how)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def expect_error(self, code, *arguments, **how):
        """The one line on standard error of a call that must end with that exit code."""
        done = self.call(*arguments, **how)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertRegex(done.stderr, r"^error: ")
        return done.stderr.strip()

    def record(self, results="deck-results"):
        return json.loads((self.folder / results / "record.json").read_text(encoding="utf-8"))
