"""Runs the examples and compares their figures of merit with references.   validate_examples.py PROGRAM [name ...]

Names: beginnings of the cases' names (`patch-tests`, `press-fit/interference`); default all. Exit code 1 where an example
does not converge or a figure is out of its bounds.
"""
import math
import os
import shutil
import sys
import time

from contact_figures import hertz_fit, stick_radius_by_slip, stick_radius_by_traction
from results import run, table

EXAMPLES = os.path.join(os.path.dirname(__file__), "..", "examples")


class Figure:
    """A number, what it should be, and how far it may be off (relative; None: stated, not judged)."""

    def __init__(self, name, value, reference, bound=None):
        self.name, self.value, self.reference, self.bound = name, value, reference, bound

    @property
    def error(self):
        return abs(self.value / self.reference - 1)

    @property
    def good(self):
        return self.bound is None or self.error <= self.bound

    def row(self, case):
        judged = "stated" if self.bound is None else f"{self.bound:.0e}"
        return [case, self.name, f"{self.value:.8g}", f"{self.reference:.8g}", f"{self.error:.1e}", judged,
                "" if self.good else "OUT"]


def worst(values, reference):
    return max(values, key=lambda value: abs(value - reference))


def patch(bound):
    def figures(finished):
        nodes = finished.nodes()
        down = "uz" if "uz" in nodes[0] else "uy"
        return [Figure("worst pressure", worst([node["pressure"] for node in nodes], 1e5), 1e5, bound),
                Figure("worst displacement", worst([node[down] for node in nodes], -0.05), -0.05, bound)]
    return figures


def rings(pressure, bound):
    def figures(finished):
        nodes = finished.nodes("fit")
        area = sum(node["area"] for node in nodes)
        mean = sum(node["pressure"] * node["area"] for node in nodes) / area
        return [Figure("mean pressure", mean, pressure, bound),
                Figure("worst pressure", worst([node["pressure"] for node in nodes], pressure), pressure, bound)]
    return figures


def lame_composite(pressure, inner, fit, outer):
    """Radial pressure at r = fit of one ring under outer pressure (Lame 1852): two rings of one material that fit exactly."""
    return pressure * outer**2 / (outer**2 - inner**2) * (1 - inner**2 / fit**2)


def lame_interference(young, interference, inner, fit, outer):
    """Pressure between two rings of one material that overlap radially by `interference` at rest."""
    return (young * interference * (fit**2 - inner**2) * (outer**2 - fit**2)
            / (2 * fit**3 * (outer**2 - inner**2)))


def hertz_sphere(finished):
    """Sphere of radius 1, E = 1, nu = 0.3 on a rigid plane, at the computed force (Hertz 1882; Johnson 1985, 4.22 to 4.24)."""
    force = finished.contact()["normal_force"][1]
    modulus = 1 / (1 - 0.3**2)
    radius, _ = hertz_fit(finished.nodes())
    return [Figure("peak pressure", finished.contact()["max_pressure"],
                   (6 * force * modulus**2 / math.pi**3) ** (1 / 3), 0.01),
            Figure("contact radius", radius, (3 * force / (4 * modulus)) ** (1 / 3), 0.01)]


def sphere_with_friction(finished):
    """The stick radius of a growing contact is that of the flat punch (Spence 1975), up to terms in a/R."""
    nodes = finished.nodes()
    return [Figure("c/a", stick_radius_by_traction(nodes, 0.2) / hertz_fit(nodes, 0.1, 0.4)[0], 0.69828, 0.02)]


def hertz_cylinder(bound):
    """Cylinder of radius 1, E = 1, nu = 0.3 on a block, E = 2, nu = 0.25, at the computed force (Johnson 1985, 4.43 to 4.45)."""
    def figures(finished):
        force = 2 * finished.contact()["normal_force"][1]  # the model is one half
        modulus = 1 / ((1 - 0.3**2) / 1 + (1 - 0.25**2) / 2)
        width, _ = hertz_fit(finished.nodes())
        return [Figure("peak pressure", finished.contact()["max_pressure"],
                       math.sqrt(force * modulus / math.pi), bound),
                Figure("half-width", width, math.sqrt(4 * force / (math.pi * modulus)), bound)]
    return figures


def punch(finished):
    """Spence's stick radius at nu = 0.3, mu = 0.2; validate-punch.sh has all six."""
    return [Figure("c/a", stick_radius_by_slip(finished.nodes()), 0.69828, 0.01)]


def sliding_blocks(finished):
    """Once all of the interface slides, the forces are in Coulomb's ratio up to the tilt of the surface."""
    contact = finished.contact()
    return [Figure("|T|/|N| at the end", math.hypot(*contact["tangential_force"]) / math.hypot(*contact["normal_force"]),
                   0.3, 0.05)]


def ironing(finished):
    """Fx/Fy on the block at t = 1.5: published values spread from 0.30 to 0.53, so the middle +- 28 %."""
    at = min(range(len(finished.increments)), key=lambda i: abs(finished.increments[i]["time"] - 1.5))
    contact = finished.contact(increment=at)
    fx, fy = (contact["normal_force"][c] + contact["tangential_force"][c] for c in (0, 1))
    return [Figure("Fx/Fy at t = 1.5", abs(fx / fy), 0.415, 0.115 / 0.415),
            Figure("Fy at t = 1.5", abs(fy), abs(fy)),
            Figure("Fx at t = 1.5", abs(fx), abs(fx))]


def ring_on_itself(finished):
    """What the roller presses and the contact within does not carry, the folds bear: as much as without that contact."""
    within, above = finished.contact("within"), finished.contact("above")
    borne = [sum(contact[force][1] for force in ("normal_force", "tangential_force")) for contact in (above, within)]
    return [Figure("borne by the folds", abs(borne[0] - borne[1]), 0.3916, 0.03)]


COMPOSITE = lame_composite(1e6, 0.2, 0.6, 1.0)
SHRUNK = lame_interference(1e9, 6e-4, 0.2, 0.6, 1.0)
# name, deck, overrides, figures
CASES = [
    ("patch-tests/plane, matching", "patch-tests/plane-matching.yaml", [], patch(1e-10)),
    ("patch-tests/plane, non-matching", "patch-tests/plane-non-matching.yaml", [], patch(None)),
    ("patch-tests/space, matching", "patch-tests/space-matching.yaml", [], patch(1e-10)),
    ("patch-tests/space, non-matching", "patch-tests/space-non-matching.yaml", [], patch(None)),
    ("press-fit/pressure, 192:192", "press-fit/press-fit.yaml", [], rings(COMPOSITE, 0.005)),
    ("press-fit/pressure, 64:64", "press-fit/press-fit.yaml",
     ["mesh.parameters.n_inner=64", "mesh.parameters.n_outer=64"], rings(COMPOSITE, None)),
    ("press-fit/pressure, 192:144", "press-fit/press-fit.yaml", ["mesh.parameters.n_outer=144"],
     rings(COMPOSITE, None)),
    ("press-fit/pressure, 192:96", "press-fit/press-fit.yaml", ["mesh.parameters.n_outer=96"], rings(COMPOSITE, None)),
    ("press-fit/interference", "press-fit/interference.yaml", [], rings(SHRUNK, 0.01)),
    ("hertz-cylinder", "hertz-cylinder/hertz-cylinder.yaml", [], hertz_cylinder(0.01)),
    ("hertz-cylinder, 60:45", "hertz-cylinder/hertz-cylinder.yaml", ["mesh.parameters.n_block=45"],
     hertz_cylinder(None)),
    ("hertz-sphere/frictionless", "hertz-sphere/hertz-sphere.yaml", [], hertz_sphere),
    ("hertz-sphere/friction", "hertz-sphere/friction.yaml", [], sphere_with_friction),
    ("punch", "punch/punch.yaml", [], punch),
    ("blocks-3d", "blocks-3d/blocks-3d.yaml", [], sliding_blocks),
    ("self-contact", "self-contact/ring.yaml", [], ring_on_itself),
    ("ironing", "ironing/ironing.yaml", [], ironing),
]


def main():
    program, names = sys.argv[1], sys.argv[2:]
    costs, figures, good = [], [], True
    for name, deck, overrides, measure in CASES:
        if names and not any(name.startswith(wanted) for wanted in names):
            continue
        start = time.time()
        try:
            finished = run(program, os.path.join(EXAMPLES, deck), overrides)
        except RuntimeError as error:
            print(error, file=sys.stderr, flush=True)
            costs.append([name, "no record", "", "", "", "", ""])
            good = False
            continue
        iterations = finished.newton_iterations()
        mean = sum(iterations) / len(iterations) if iterations else 0
        costs.append([name, finished.record["status"], f"{finished.record['n_dofs']}", f"{len(iterations)}",
                      f"{mean:.1f} / {max(iterations, default=0)}", f"{finished.cutbacks()}",
                      f"{time.time() - start:.1f}"])
        print("  ".join(costs[-1]), file=sys.stderr, flush=True)
        if finished.converged:
            measured = measure(finished)
            figures += [figure.row(name) for figure in measured]
            good &= all(figure.good for figure in measured)
        good &= finished.converged
        shutil.rmtree(finished.directory)
    print(table(["example", "status", "unknowns", "increments", "Newton mean / max", "cutbacks", "wall s"], costs))
    print()
    print(table(["example", "figure", "computed", "reference", "error", "bound", ""], figures))
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
