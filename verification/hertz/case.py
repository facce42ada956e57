"""Spheres without friction: a rigid one on a half-space and two equal elastic ones, axisymmetric and a quarter in space."""
import math

import mesh
from contact_figures import hertz_fit
from suite import ELEMENTS, Row, order
from svg import Plot

TITLE = "Spheres and cylinder of Hertz"
RADIUS, POISSON, EDGE = 1.0, 0.3, 0.01  # of each sphere, E = 1; contact radius at the end
INSIDE = 1.25 * EDGE  # as far as cells are uniform
DOMAIN = {2: 1000 * EDGE, 3: 2000 * EDGE}


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


def profile(equal, *across):
    """Height of a sphere's paraboloid at this place beside the axis, up to 2 EDGE; none on a half-space that a rigid sphere meets."""
    return min(sum(c * c for c in across), (2 * EDGE) ** 2) / (2 * RADIUS) if equal else 0.0


def bodies(path, equal, n):
    """The axisymmetric half-space, flat or with the paraboloid, and its mirror image where there are two."""
    h = EDGE / n
    across = mesh.spaced(0, INSIDE, math.ceil(1.25 * n)) + [INSIDE + c for c in mesh.graded(h, DOMAIN[2] - INSIDE, 1.1)[1:]]
    down = mesh.graded(h, DOMAIN[2], 1.1)
    made = mesh.Mesh(2)
    made.add("lower", across, [-y for y in reversed(down)], moved=lambda x, y: (x, y - profile(equal, x)))
    if equal:
        made.add("upper", across, down, moved=lambda x, y: (x, y + profile(equal, x)))
    return made.write(path)


def along_rays(n):
    """Distances from INSIDE to DOMAIN whose steps grow with their power 4/3: what a step's error does to the approach falls with the distance, so
    that steps of equal weight grow by ever more."""
    places = [INSIDE]
    while places[-1] < DOMAIN[3]:
        places.append(places[-1] * (1 + 1.2 / n * (places[-1] / INSIDE) ** (1 / 3)))
    scale = math.log(DOMAIN[3] / INSIDE) / math.log(places[-1] / INSIDE)
    return [INSIDE * (place / INSIDE) ** scale for place in places[:-1]] + [DOMAIN[3]]


def bodies_in_space(path, equal, n):
    """A quarter of the half-space, and its mirror image where there are two: a cube of uniform cells round the contact, and from its three free
    sides cells along rays from the origin to a hemisphere."""
    core, rays = mesh.spaced(0, INSIDE, math.ceil(1.25 * n)), along_rays(n)
    made = mesh.Mesh(3)

    def placed(x, y, z):
        """Beyond the cube, one of the three tells how far along the ray through a point of the cube's surface."""
        foot = [min(x, INSIDE), min(y, INSIDE), max(min(z, INSIDE), -INSIDE)]
        share = (max(x, y, abs(z), INSIDE) - INSIDE) / (DOMAIN[3] - INSIDE)
        if share:
            foot = [c * (1 + (DOMAIN[3] / math.hypot(*foot) - 1) * share) for c in foot]
        height = profile(equal, *foot[:2])
        return foot[0], foot[1], foot[2] + (height if up else -height)

    for up, name in enumerate(("lower", "upper") if equal else ("lower",)):
        face, far = ("z0", "z1") if up else ("z1", "z0")
        deep, deeper = [axis if up else [-z for z in reversed(axis)] for axis in (core, rays)]
        made.add(name, core, core, deep, moved=placed, sides={"x0": "x0", "y0": "y0", face: face})
        made.add(name, rays, core, deep, moved=placed, sides={"x1": far, "y0": "y0", face: face})
        made.add(name, core, rays, deep, moved=placed, sides={"x0": "x0", "y1": far, face: face})
        made.add(name, core, core, deeper, moved=placed, sides={"x0": "x0", "y0": "y0", far: far})
    return made.write(path)


def deck(bench, dimension, equal, n):
    """Deck and settings of a run."""
    name = ("equal" if equal else "rigid") + ("-space" if dimension == 3 else "")
    made = (bodies_in_space if dimension == 3 else bodies)(bench.path(f"{name}-{n}.msh"), equal, n)
    return f"{name}.yaml", {"mesh.file": made, f"boundary.0.displacement.{'z' if dimension == 3 else 'y'}": f"{-Pair(equal).approach(EDGE)}*t"}


def radial(run):
    """Nodes by their radius, which is put in place of x."""
    nodes = [{**node, "x": math.hypot(node["x"], node["y"] if "z" in node else 0)} for node in run.nodes()]
    return sorted(nodes, key=lambda node: node["x"])


def force(run, sectors, increment=-1):
    return sectors * abs(run.contact(increment=increment)["normal_force"][-1])


def errors(run, pair, sectors):
    """Figures over their references by name: at the end against Hertz at the computed force, F(approach) at the worst of all increments.

    A nodal pressure is a mean over the cells round the node, which falls short of the pressure within a cell or so of the edge: in space, where cells
    are coarser, the fit stays so much farther inside.
    """
    total, nodes = force(run, sectors), radial(run)
    edge, peak = pair.edge(total), pair.peak(total)
    approach = pair.approach(EDGE)
    laws = [force(run, sectors, i) / pair.force(approach * step["time"]) for i, step in enumerate(run.increments)]
    inner = [node["pressure"] / peak - math.sqrt(1 - (node["x"] / edge) ** 2) for node in nodes if node["x"] <= 0.95 * edge]
    return {"greatest nodal pressure / p0": max(node["pressure"] for node in nodes) / peak,
            "contact radius / a": hertz_fit(nodes, *((0.5, 0.9) if sectors == 4 else ()))[0] / edge,
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


def profile_plot(run, pair, sectors, title):
    total, nodes = force(run, sectors), [node for node in radial(run) if node["x"] <= 1.25 * EDGE]
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
    space = bench.choose([], [5, 10], [10, 20])
    finest = (5e-3, 5e-3, 2e-2, 1e-2)
    tolerances = {2: bench.choose((1e-2, 1e-2, 2e-2, 1e-2), finest), 3: bench.choose((), (5e-3, 5e-3, 4e-2, 2e-2), finest)}
    found = []
    for equal, label in ((False, "rigid sphere on half-space"), (True, "equal spheres")):
        pair = Pair(equal)
        runs = bench.run_all([deck(bench, 2, equal, n) for n in axisymmetric])
        found += rows(f"{label}, axisymmetric", runs, axisymmetric, pair, 1, tolerances[2])
        bench.plot("equal-pressure" if equal else "rigid-pressure",
                   profile_plot(runs[-1], pair, 1, f"Hertz, {label}: pressure, n {axisymmetric[-1]}"))
        if not equal:
            approach = [pair.approach(EDGE) * step["time"] for step in runs[-1].increments]
            bench.plot("force", Plot(f"Hertz, {label}: force against approach", "approach / R", "F / (E R^2)")
                       .add("computed", [(d, force(runs[-1], 1, i)) for i, d in enumerate(approach)], "points")
                       .add("Hertz", [(d * k / 50, pair.force(d * k / 50)) for d in approach[-1:] for k in range(51)]))
        if space:
            runs = [bench.run(*deck(bench, 3, equal, n)) for n in space]  # one at a time, for their memory
            found += rows(f"{label}, quarter in space", runs, space, pair, 4, tolerances[3])
            if not equal:
                bench.plot("space-pressure", profile_plot(runs[-1], pair, 4, f"Hertz, {label} in space: pressure, n {space[-1]}"))
    return found + cylinder_rows(bench, bench.choose(16, 60))
