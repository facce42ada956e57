"""Contact patch tests: states of uniform stress that an exact contact element passes on to round-off, on any meshes."""
import glob
import os

import mesh
from suite import ELEMENTS, Row
from svg import Plot
from vtu import vtu_arrays

TITLE = "Patch tests"
EXACT = 1e-8  # tolerance; the solver's own is set below it
SOLVER = {"solver.tolerance": 1e-12}


def worst(values, reference):
    return max(values, key=lambda value: abs(value - reference))


def stresses(run, component):
    """One component (xx, yy, zz, xy, yz, xz) of the stress of every cell at the end."""
    last = sorted(glob.glob(os.path.join(run.directory, "solution_*.vtu")))[-1]
    return vtu_arrays(last)["stress"]["xx yy zz xy yz xz".split().index(component)::6]


def blocks(run, axis):
    """Two blocks, strain 0.05 in both: pressure 1e5 and interface moved by -0.05."""
    nodes = run.nodes()
    return [("worst pressure", 1e5, worst([node["pressure"] for node in nodes], 1e5)),
            ("worst displacement of the interface", -0.05, worst([node["u" + axis] for node in nodes], -0.05))]


def punch_and_foundation(run, axis):
    """The same pressure of 10 on the punch and beside it: the contact carries it on as if it were not there."""
    return [("worst pressure", 10, worst([node["pressure"] for node in run.nodes()], 10)),
            ("worst normal stress of a cell", -10, worst(stresses(run, 2 * axis), -10))]


SLOPE = {"y": (0.3, 0), "z": (0.3, 0.2)}  # of the tilted interface along x and, in space, y


def tilted(run, axis):
    """A column cut at a slope below the friction angle: uniaxial stress of E * 0.01, so traction s along the axis on the cut."""
    steepness = SLOPE[axis][0] ** 2 + SLOPE[axis][1] ** 2
    pressure, shear = 10 / (1 + steepness), 10 * steepness**0.5 / (1 + steepness)
    nodes = run.nodes()
    found = [(node["traction_1"] ** 2 + node.get("traction_2", 0) ** 2) ** 0.5 for node in nodes]
    return [("worst pressure", pressure, worst([node["pressure"] for node in nodes], pressure)),
            ("worst friction", shear, worst(found, shear)),
            ("worst stress of a cell", -10, worst(stresses(run, 2 * axis), -10))]


def tilted_mesh(path, dimension, n_lower, n_upper):
    def cut(*place):
        return 0.5 + sum(slope * (c - 0.5) for slope, c in zip(SLOPE["yz"[dimension - 2]], place[:-1]))

    made = mesh.Mesh(dimension)
    made.add("lower", *[mesh.spaced(0, 1, n_lower)] * dimension, moved=lambda *x: (*x[:-1], x[-1] * cut(*x)))
    made.add("upper", *[mesh.spaced(0, 1, n_upper)] * dimension, moved=lambda *x: (*x[:-1], cut(*x) + x[-1] * (1 - cut(*x))))
    return made.write(path)


def tests(bench):
    """Name, deck, settings for meshes that match and that do not, figures, axis of the load."""
    plane, space = [{"mesh.file": tilted_mesh(bench.path(f"tilted-{d}-{n}.msh"), d, 4, n)} for d, n in ((2, 4), (2, 6))], [
        {"mesh.file": tilted_mesh(bench.path(f"tilted-{d}-{n}.msh"), d, 3, n)} for d, n in ((3, 3), (3, 4))]
    return [("plane", "examples/patch-tests/plane-matching.yaml", [{}, {"mesh.parameters.n_upper": 6}], blocks, "y"),
            ("space", "examples/patch-tests/space-matching.yaml", [{}, {"mesh.parameters.n_upper": 4}], blocks, "z"),
            ("Taylor-Papadopoulos", "taylor-papadopoulos.yaml", [{}, {"mesh.parameters.n_punch": 5}], punch_and_foundation, "y"),
            ("tilted, plane", "tilted-plane.yaml", plane, tilted, "y"),
            ("tilted, space", "tilted-space.yaml", space, tilted, "z")]


def pressure_plot(runs):
    plot = Plot("Taylor-Papadopoulos: nodal pressure", "x", "pressure")
    for label, run in runs:
        plot.add(label, sorted((node["x"], node["pressure"]) for node in run.nodes()), "line points")
    return plot


def verify(bench):
    rows = []
    for element, (chosen, reason) in ELEMENTS.items():
        for name, deck, meshes, figures, axis in tests(bench):
            runs = [bench.run(deck, {**SOLVER, **chosen, **settings}, pictures=1) for settings in meshes]
            for run, meeting in zip(runs, ("matching", "not matching")):
                rows += [Row(f"{name}, {meeting}, {element}: {figure}", reference, ours, EXACT, runs=[run],
                             reason="" if meeting == "matching" else reason) for figure, reference, ours in figures(run, axis)]
            if name == "Taylor-Papadopoulos":
                bench.plot(f"pressure-{element}", pressure_plot(zip(("matching", "not matching"), runs)))
    return rows
