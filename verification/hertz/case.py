"""Spheres without friction: a rigid one on a half-space and two equal elastic ones, axisymmetric and a quarter in space."""
import math

import mesh
from contact_figures import hertz_fit
from suite import ELEMENTS, Row, order
from svg import Plot

TITLE = "Spheres and cylinder of Hertz"
RADIUS, POISSON, EDGE = 1.0, 0.3, 0.01  # of each sphere, E = 1; contact radius at the end
INCREMENTS = {2: 10, 3: 1}


class Pair:
    """Two bodies of one kind: what Hertz's formulas take (Hertz 1882; Johnson, Contact Mechanics, eq. 4.22 to 4.24)."""

    def __init__(self, equal):
        self.modulus = 1 / (1 - POISSON**2) / (2 if equal else 1)
        self.radius = RADIUS / (2 if equal else 1)

    def approach(self, a):
        return a * a / self.radius

    def force(self, approach):
        return 4 / 3 * self.modulus * math.sqrt(self.radius) * approach**1.5

    def edge(self, force):
        return (3 * force * self.radius / (4 * self.modulus)) ** (1 / 3)

    def peak(self, force):
        return (6 * force * self.modulus**2 / (math.pi**3 * self.radius**2)) ** (1 / 3)


def outside(bench, dimension):
    """Size of the domain over EDGE, and growth of the cells from one to the next outside of the contact."""
    return (1000, 1.1) if dimension == 2 else bench.choose((100, 1.3), (100, 1.3), (1000, 1.25))


def bodies(path, dimension, equal, n, size, growth):
    """A half-space, flat or with the paraboloid of a sphere up to 2 EDGE, and its mirror image where there are two."""
    h, domain = EDGE / n, EDGE * size
    fine = mesh.spaced(0, 1.25 * EDGE, math.ceil(1.25 * n))
    across = fine + [fine[-1] + c for c in mesh.graded(h, domain - fine[-1], growth)[1:]]
    down = mesh.graded(h, domain, growth)

    def profile(*x):
        return min(sum(c * c for c in x[:-1]), (2 * EDGE) ** 2) / (2 * RADIUS) if equal else 0.0

    made = mesh.Mesh(dimension)
    made.add("lower", *[across] * (dimension - 1), [-z for z in reversed(down)], moved=lambda *x: (*x[:-1], x[-1] - profile(*x)))
    if equal:
        made.add("upper", *[across] * (dimension - 1), down, moved=lambda *x: (*x[:-1], x[-1] + profile(*x)))
    return made.write(path)


def deck(bench, dimension, equal, n):
    """Deck and settings of a run."""
    name = ("equal" if equal else "rigid") + ("-space" if dimension == 3 else "")
    approach = -Pair(equal).approach(EDGE)
    up = "z" if dimension == 3 else "y"
    return f"{name}.yaml", {"mesh.file": bodies(bench.path(f"{name}-{n}.msh"), dimension, equal, n, *outside(bench, dimension)),
                            f"boundary.0.displacement.{up}": f"{approach}*t", "loading.increments": INCREMENTS[dimension]}


def radial(run):
    """Nodes by their radius, which is put in place of x."""
    nodes = [{**node, "x": math.hypot(node["x"], node["y"] if "z" in node else 0)} for node in run.nodes()]
    return sorted(nodes, key=lambda node: node["x"])


def force(run, sectors, increment=-1):
    return sectors * abs(run.contact(increment=increment)["normal_force"][-1])


def errors(run, pair, sectors):
    """Relative errors by name: at the end against Hertz at the computed force, F(approach) at the worst of all increments."""
    total, nodes = force(run, sectors), radial(run)
    edge, peak = pair.edge(total), pair.peak(total)
    approach = pair.approach(EDGE)
    laws = [force(run, sectors, i) / pair.force(approach * step["time"]) for i, step in enumerate(run.increments)]
    inner = [node["pressure"] / peak - math.sqrt(1 - (node["x"] / edge) ** 2) for node in nodes if node["x"] <= 0.95 * edge]
    return {"greatest nodal pressure / p0": max(node["pressure"] for node in nodes) / peak,
            "contact radius / a": hertz_fit(nodes)[0] / edge,
            "profile, worst (p - Hertz)/p0, r <= 0.95 a": max(inner, key=abs),
            f"F(approach) / Hertz, worst of {len(laws)} increments": max(laws, key=lambda law: abs(law - 1))}


def rows(label, runs, meshes, pair, sectors, tolerances):
    """Rows of the finest mesh, orders from it and the one before."""
    *_, before, last = [errors(run, pair, sectors) for run in runs]
    found = []
    for (name, ours), tolerance in zip(last.items(), tolerances):
        reference = 0 if name.startswith("profile") else 1
        found.append(Row(f"{label}, n {meshes[-1]}: {name}", reference, ours, tolerance, runs=[runs[-1]],
                         order=order(abs(before[name] - reference), abs(ours - reference), meshes[-1] / meshes[-2])))
    return found


def profile_plot(run, pair, title):
    total, nodes = force(run, 1), [node for node in radial(run) if node["x"] <= 1.25 * EDGE]
    edge, peak = pair.edge(total), pair.peak(total)
    return (Plot(title, "r/a", "p/p0").add("computed", [(node["x"] / edge, node["pressure"] / peak) for node in nodes], "points")
            .add("Hertz", [(k / 200, math.sqrt(1 - (k / 200) ** 2)) for k in range(201)]))


def cylinder_rows(bench, n):
    """Cylinder (R = 1, E = 1, nu = 0.3) on a block (E = 2, nu = 0.25), by each contact element, at the computed force per length
    (Johnson 1985, eq. 4.43 to 4.45); the model is one half."""
    modulus = 1 / ((1 - 0.3**2) / 1 + (1 - 0.25**2) / 2)
    found = []
    plot = Plot("Hertz, cylinder on block, cells 4:3 that do not match: pressure", "x/b", "p/p0")
    for element, (chosen, reason) in ELEMENTS.items():
        blocks = [n // 2, 3 * n // 4]
        runs = bench.run_all([("examples/hertz-cylinder/hertz-cylinder.yaml", {
            "mesh.parameters.n_cylinder": n, "mesh.parameters.n_block": n_block, **chosen}) for n_block in blocks])
        for n_block, run in zip(blocks, runs):
            total, nodes = force(run, 2), radial(run)
            peak, width = math.sqrt(total * modulus / math.pi), math.sqrt(4 * total / (math.pi * modulus))
            label = f"cylinder on block, {n}:{n_block}, {element}"
            found += [Row(f"{label}: greatest nodal pressure / p0", 1, max(node["pressure"] for node in nodes) / peak,
                          bench.choose(1e-2, 5e-3), runs=[run], reason=reason),
                      Row(f"{label}: half-width / b", 1, hertz_fit(nodes)[0] / width, bench.choose(1e-2, 5e-3), reason=reason)]
        plot.add(element, [(node["x"] / width, node["pressure"] / peak) for node in nodes if node["x"] < 1.1 * width], "points")
    bench.plot("cylinder", plot.add("Hertz", [(k / 200, math.sqrt(1 - (k / 200) ** 2)) for k in range(201)]))
    return found


def verify(bench):
    axisymmetric = bench.choose([8, 16], [30, 60], [30, 60, 120])
    space = bench.choose([], [4, 8], [5, 10, 20])
    finest = bench.choose((1e-2, 1e-2, 2e-2, 1e-2), (5e-3, 5e-3, 2e-2, 1e-2))
    coarse_space, fine_space = (2e-2, 2e-2, 4e-2, 3e-2), (5e-3, 5e-3, 2e-2, 1e-2)
    found = []
    for equal, label in ((False, "rigid sphere on half-space"), (True, "equal spheres")):
        pair = Pair(equal)
        runs = bench.run_all([deck(bench, 2, equal, n) for n in axisymmetric])
        found += rows(f"{label}, axisymmetric", runs, axisymmetric, pair, 1, finest)
        bench.plot("equal-pressure" if equal else "rigid-pressure",
                   profile_plot(runs[-1], pair, f"Hertz, {label}: pressure, n {axisymmetric[-1]}"))
        if not equal:
            approach = [pair.approach(EDGE) * step["time"] for step in runs[-1].increments]
            bench.plot("force", Plot(f"Hertz, {label}: force against approach", "approach / R", "F / (E R^2)")
                       .add("computed", [(d, force(runs[-1], 1, i)) for i, d in enumerate(approach)], "points")
                       .add("Hertz", [(d * k / 50, pair.force(d * k / 50)) for d in approach[-1:] for k in range(51)]))
        if sizes := space[:2] if equal else space:
            runs = bench.run_all([deck(bench, 3, equal, n) for n in sizes])
            found += rows(f"{label}, quarter in space", runs, sizes, pair, 4, fine_space if sizes[-1] > 10 else coarse_space)
    return found + cylinder_rows(bench, bench.choose(16, 60))
