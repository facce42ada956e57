"""Neo-Hookean bodies in contact at large strain, against the same law solved by hand, as an ordinary equation or by other codes.

W = G/2 (J^(-2/3) I1 - 3) + K/2 ((J^2 - 1)/2 - ln J), so the principal first Piola-Kirchhoff stress along a stretch l is
P = G J^(-2/3) (l - I1/(3 l)) + K/2 (J^2 - 1)/l.
"""
import math

import mesh
from suite import ELEMENTS, Row, order
from svg import Plot

TITLE = "Finite strain"


class NeoHooke:
    def __init__(self, young, poisson):
        self.shear, self.bulk = young / (2 * (1 + poisson)), young / (3 * (1 - 2 * poisson))

    def stress(self, along, *others):
        """First Piola-Kirchhoff stress along the first of three principal stretches."""
        volume = along * others[0] * others[1]
        squares = along**2 + others[0] ** 2 + others[1] ** 2
        return (self.shear * volume ** (-2 / 3) * (along - squares / (3 * along))
                + self.bulk / 2 * (volume**2 - 1) / along)


def root(function, low, high):
    """Zero of a function that grows, by bisection."""
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return (low + high) / 2


def compressed(law, stretch, dimension):
    """Stretch across and nominal pressure of a bar with free sides, in plane strain or space, shortened to `stretch`."""
    def others(across):
        return (across, 1.0) if dimension == 2 else (across, across)

    across = root(lambda a: law.stress(a, stretch, others(a)[1]), 0.5, 3)
    return across, -law.stress(stretch, *others(across))


def bar_rows(bench):
    """Two blocks between frictionless rigid planes, shortened to 60 %: a uniform state, on matching meshes and, surface to surface, on any."""
    law, rows = NeoHooke(1.0, 0.3), []
    for dimension, deck in ((2, "bar-plane.yaml"), (3, "bar-space.yaml")):
        across, pressure = compressed(law, 0.6, dimension)
        for n_upper, meshes, element in ((3, "matching", "node-to-face"), (4, "not matching", "mortar")):
            made = mesh.Mesh(dimension)
            for body, n, low in (("lower", 3, 0), ("upper", n_upper, 1)):
                made.add(body, *[mesh.spaced(0, 1, n)] * (dimension - 1), mesh.spaced(low, low + 1, n))
            run = bench.run(deck, {"mesh.file": made.write(bench.path(f"bar-{dimension}-{n_upper}.msh")), "contact.0.discretization": element})
            label = f"{('plane strain', 'space')[dimension - 2]}, {meshes}, {element}, shortened to 60 %"
            nodes = run.nodes()
            corner = max(nodes, key=lambda node: node["x"] + node["y"])
            rows += [Row(f"{label}: worst pressure, over the reference area", pressure,
                         max((node["pressure"] for node in nodes), key=lambda p: abs(p - pressure)), 1e-8, runs=[run]),
                     Row(f"{label}: stretch across", across, 1 + corner["ux"], 1e-8)]
    return rows


INNER, MIDDLE, OUTER, INWARD = 1.0, 2.0, 3.0, 0.6  # reference radii of two tubes, displacement of the outside
STEPS = 20  # of Runge and Kutta's method in each tube, of fourth order: far beyond the digits held against
TUBES = (NeoHooke(1.0, 0.3), NeoHooke(2.0, 0.2))


def tubes(bore):
    """Place of the outside, of the fit, and the stress P_rR there, if the bore has the radius `bore`.

    Equilibrium d(P_rR)/dR = (P_tT - P_rR)/R in plane strain with r(R), stretches r', r/R, 1; by Runge and Kutta's method.
    """
    def radial(law, radius, place, stress):
        return root(lambda stretch: law.stress(stretch, place / radius, 1.0) - stress, 0.05, 5)

    def slope(law, radius, place, stress):
        stretch = radial(law, radius, place, stress)
        return stretch, (law.stress(place / radius, stretch, 1.0) - stress) / radius

    radius, place, stress, fit = INNER, bore, 0.0, None
    for law, end in zip(TUBES, (MIDDLE, OUTER)):
        h = (end - radius) / STEPS
        for _ in range(STEPS):
            a = slope(law, radius, place, stress)
            b = slope(law, radius + h / 2, place + h / 2 * a[0], stress + h / 2 * a[1])
            c = slope(law, radius + h / 2, place + h / 2 * b[0], stress + h / 2 * b[1])
            d = slope(law, radius + h, place + h * c[0], stress + h * c[1])
            place += h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0])
            stress += h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])
            radius += h
        fit = fit or (place, stress)
    return place, fit


def tube_rows(bench):
    """Two tubes of unlike materials one in the other, the outside pressed in by 20 %."""
    bore = root(lambda b: tubes(b)[0] - (OUTER - INWARD), 0.1, INNER)
    place, stress = tubes(bore)[1]
    rows, sizes, errors = [], bench.choose([4, 8], [8, 16], [16, 32]), []
    for n in sizes:
        made = mesh.Mesh(2)
        made.add("inner", mesh.spaced(INNER, MIDDLE, n), mesh.spaced(0, 0.5, 2)).add("outer", mesh.spaced(MIDDLE, OUTER, n), mesh.spaced(0, 0.5, 2))
        run = bench.run("tubes.yaml", {"mesh.file": made.write(bench.path(f"tubes-{n}.msh")), "boundary.1.displacement.x": f"-{INWARD}*t"})
        pressures = [node["pressure"] for node in run.nodes()]
        errors.append((max(pressures, key=lambda p: abs(p + stress)), run.nodes()[0]["ux"]))
    found = [order(*(abs(error[k] - exact) for error in errors[-2:])) for k, exact in ((0, -stress), (1, place - MIDDLE))]
    rows.append(Row(f"tubes pressed in by 20 %, n {n}: worst pressure, over the reference area", -stress, errors[-1][0],
                    bench.choose(1e-2, 2e-3), order=found[0], runs=[run]))
    rows.append(Row(f"tubes pressed in by 20 %, n {n}: displacement of the fit", place - MIDDLE, errors[-1][1], bench.choose(1e-2, 2e-3),
                    order=found[1]))
    return rows


GETFEM = {0.1: 0.100984, 0.2: 0.277370, 0.3: 0.527819, 0.4: 0.867224}  # depth: force / (E radius), by block_getfem.py, 40 cells


def block_rows(bench):
    """A block pressed by a rigid cylinder to 60 % of its height, against another code."""
    sizes, curves = bench.choose([10, 20], [20, 40], [20, 40, 80]), []
    plot = Plot("Neo-Hookean block under a rigid cylinder", "pressed in / height", "force / (E radius)")
    for n in sizes:
        made = mesh.Mesh(2)
        made.add("block", mesh.spaced(0, 2, 2 * n), mesh.spaced(-1, 0, n))
        run = bench.run("block.yaml", {"mesh.file": made.write(bench.path(f"block-{n}.msh"))})
        curves.append({round(0.4 * step["time"], 6): -2 * step["contacts"][0]["normal_force"][1] for step in run.increments})
    plot.add(f"n {n}", list(curves[-1].items()), "line").add("GetFEM, quadratic cells", list(GETFEM.items()), "points")
    bench.plot("block", plot)
    return [Row(f"block under a rigid cylinder, {100 * depth:.0f} %, n {n}: force / (E radius)", GETFEM[depth], curves[-1][depth],
                bench.choose(5e-3, 2e-3), runs=[run], order=order(*(abs(curve[depth] - GETFEM[depth]) for curve in curves[-2:])))
            for depth in (0.2, 0.4)]


DEPTHS = (2.5, 5.0)  # mm
# Force, N, on a quarter of two hollow half spheres at these depths; README.md has the sources.
SPHERES = {0.0: {"Puso, Laursen": (0.899, 2.322), "Areias and others": (0.888, 2.241), "FEBio": (0.978, 2.441),
                 "Abaqus": (1.025, 2.402), "solids4foam": (0.999, 2.300)},
           0.5: {"Areias and others": (0.932, 2.343), "FEBio": (1.045, 2.586), "Abaqus": (1.032, 2.576), "solids4foam": (1.070, 2.382)}}


def sphere_rows(bench):
    """Two hollow half spheres, one over the other, pressed flat: within what five codes have published."""
    n, rows = bench.choose(4, 16, 32), []
    made = mesh.Mesh(2)
    for name, inside, along in (("inner", 10, 9 * n), ("outer", 12, 10 * n)):
        made.add(name, mesh.spaced(0, math.pi / 2, along), mesh.spaced(inside, inside + 2, n),
                 moved=lambda angle, radius: (radius * math.sin(angle), radius * math.cos(angle)))
    file = made.write(bench.path("spheres.msh"))
    runs = bench.run_all([("spheres.yaml", {"mesh.file": file, "contact.0.friction.coefficient": mu}) for mu in SPHERES])
    plot = Plot("Two hollow half spheres pressed flat: force on a quarter", "displacement, mm", "force, N")
    for (mu, published), run in zip(SPHERES.items(), runs):
        curve = {round(5 * step["time"], 6): abs(run.contact("top", i)["normal_force"][1]) / 4 for i, step in enumerate(run.increments)}
        plot.add(f"mu {mu}", list(curve.items()), "line")
        plot.add(f"published, mu {mu}", [(depth, figures[k]) for k, depth in enumerate(DEPTHS) for figures in published.values()], "points")
        for k, depth in enumerate(DEPTHS):
            found = [figures[k] for figures in published.values()]
            middle, half = (max(found) + min(found)) / 2, (max(found) - min(found)) / 2
            rows.append(Row(f"hollow spheres, mu {mu}, n {n}: force at {depth} mm, middle of {len(found)} codes", middle, curve[depth],
                            bench.choose(6e-2, half / middle), runs=[run] if k == 0 else []))
    bench.plot("spheres", plot)
    return rows


def quarter_ring(made, name, radii, along, above=0.0, **sides):
    """A quarter of a ring beside the axis x = 0: the upper one of a ring round the origin, or the lower one of a ring whose centre is `above` it.
    Cells lie between the radii, which the upper ring has with a minus: so both keep their orientation."""
    sign = -1 if above else 1
    made.add(name, mesh.spaced(0, math.pi / 2, along), sorted(sign * radius for radius in radii), sides=sides,
             moved=lambda angle, radius: (sign * radius * math.sin(angle), above + radius * math.cos(angle)))


RINGS = (("lower", 0.6, 1.0, 0.0, "y1"), ("upper", 0.5, 0.8, 1.8, "y0"))  # inner and outer radius, height of the centre, outer side
# Friction: depth: force / (E radius of the lower ring), by rings_getfem.py, 16 cells in 0.3.
CRUSHED = {0.0: {0.3: 0.0179499, 0.6: 0.0344594}, 0.3: {0.3: 0.0179874, 0.6: 0.0346183}}


def reaction(step, region):
    """Upward reaction of a boundary at the end of an increment."""
    return next(found["force"][1] for found in step["reactions"] if found["region"] == region)


def ring_rows(bench):
    """Two unlike rings crushed against each other, against another code."""
    n, rows = bench.choose(8, 16, 32), []
    made = mesh.Mesh(2)
    for name, inner, outer, above, outside in RINGS:
        quarter_ring(made, name, mesh.spaced(inner, outer, round(n * (outer - inner) / 0.3)),
                     round(n * math.pi / 4 * (inner + outer) / 0.3), above, x0="axis", x1="middle", **{outside: "outside"})
    file = made.write(bench.path("rings.msh"))
    cases = [(mu, element) for element in ELEMENTS for mu in CRUSHED]
    runs = bench.run_all([("rings.yaml", {"mesh.file": file, "contact.0.friction.coefficient": mu, **ELEMENTS[element][0]}) for mu, element in cases])
    plot = Plot("Two neo-Hookean rings crushed against each other", "approach / radius", "force / (E radius)")
    for (mu, element), run in zip(cases, runs):
        curve = {round(0.6 * step["time"], 6): 2 * reaction(step, "lower_middle") for step in run.increments}
        if element == "node-to-face":
            plot.add(f"mu {mu}, n {n}", list(curve.items()), "line").add(f"GetFEM, mu {mu}", list(CRUSHED[mu].items()), "points")
        rows += [Row(f"two rings crushed, {element}, mu {mu}, approach {depth}, n {n}: force / (E radius)", figure, curve[depth],
                     bench.choose(5e-3, 1e-3), runs=[run] if depth == 0.3 else []) for depth, figure in CRUSHED[mu].items()]
    bench.plot("rings", plot)
    return rows


# Of a half, N, at these shares of the way: force of the contact, by like_rings_getfem.py with our law; and the force and what holds the outermost
# node of the middle, as Code_Aster's test SSNP501 has published them for Saint-Venant and Kirchhoff's law.
LIKE_RINGS = {0.25: 6.78469, 0.5: 12.75966, 1.0: 25.29690}
CODE_ASTER = {0.25: 8.78259567222, 0.5: 16.8013028173}


def like_ring_rows(bench):
    """Two like rings pressed against each other, each as if against a plate: published figures of another code, on its mesh."""
    made, (along, radii) = mesh.Mesh(2), (40, mesh.spaced(4.15, 6.35, 6))
    quarter_ring(made, "lower", radii[:-1], along, x0="axis", x1="middle")
    quarter_ring(made, "lower", radii[-2:], along, x0="axis", y1="outside")
    quarter_ring(made, "upper", radii, along, 2 * radii[-1], x0="axis", x1="middle", y0="outside")
    made.point("lower_end", "lower", (radii[-1] * math.sin(math.pi / 2), radii[-1] * math.cos(math.pi / 2)))
    run = bench.run("like-rings.yaml", {"mesh.file": made.write(bench.path("like-rings.msh"))})
    forces, sums = {}, {}
    for step in run.increments:
        share, force = round(step["time"], 6), abs(step["contacts"][0]["normal_force"][1])
        forces[share], sums[share] = force, force - reaction(step, "lower_end")
    return ([Row(f"two like rings, {100 * share:.0f} % of 4.45 cm: force, N, GetFEM's", figure, forces[share], 2e-3, runs=[run] if share == 0.25 else [])
             for share, figure in LIKE_RINGS.items()]
            + [Row(f"two like rings, {100 * share:.0f} % of 4.45 cm: force and a node's support, N, Code_Aster's by another law", figure, sums[share], 2e-2)
               for share, figure in CODE_ASTER.items()])


def verify(bench):
    return bar_rows(bench) + tube_rows(bench) + block_rows(bench) + sphere_rows(bench) + ring_rows(bench) + like_ring_rows(bench)
