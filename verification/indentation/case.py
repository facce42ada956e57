"""A rigid sphere pressed into an elastic and perfectly plastic half-space: from Hertz to the plateau of hardness."""
import glob
import math
import os

import vtu
from suite import Row
from svg import Plot

TITLE = "Indentation of a plastic half-space by a sphere"
DECK = "indentation.yaml"
POISSON, RADIUS = 0.3, 1.0  # E* = 1, which is the unit of stress
EDGE = 0.01  # contact radius at the end, about


def onset(nu):
    """Peak pressure of Hertz over the yield stress when the first point yields: on the axis, where the radial and the hoop
    stress are equal, von Mises' and Tresca's stresses are |sigma_z - sigma_r| (Huber 1904; Johnson 1985, eq. 3.45).
    """
    def difference(z):
        return abs(1 / (1 + z * z) - ((1 + nu) * (1 - z * math.atan(1 / z)) - 0.5 / (1 + z * z)))
    return 1 / max(difference(k * 1e-4) for k in range(1, 30000))


def cavity(x, nu):
    """p_m / yield of the expanding cavity (Johnson 1985, section 6.3, with tan beta = a/R), x = E* a / (R yield)."""
    return 2 / 3 * (2 + math.log(((1 - nu * nu) * x + 4 * (1 - 2 * nu)) / (6 * (1 - nu))))


def settings(n, x, increments, approach):
    """x: E* a / (R yield) at the end, if the contact radius is EDGE there; approach over a^2/R."""
    return {"mesh.parameters.n": n, "mesh.parameters.a": EDGE, "bodies.0.material.yield-stress": EDGE / RADIUS / x,
            "boundary.2.displacement.y": f"{-approach * EDGE**2 / RADIUS}*t^2", "loading.increments": increments}


def edge(run):
    """Radius of the contact: the gap of the first three open nodes as a power of the distance from the edge, any power."""
    nodes = sorted(run.nodes(), key=lambda node: node["x"])
    first = next(i for i, node in enumerate(nodes) if node["status"] == "open")
    x, gaps = nodes[first]["x"], [node["gap"] for node in nodes[first:first + 3]]
    h = nodes[first + 1]["x"] - x

    def mismatch(share):  # of the two powers that the gaps tell, the edge being share * h inside the first open node
        inner = math.log(gaps[1] / gaps[0]) / math.log((1 + share) / share)
        return math.log(gaps[2] / gaps[1]) / math.log((2 + share) / (1 + share)) - inner

    shares = [k / 1000 for k in range(1, 1000)]
    return x - h * min(shares, key=lambda share: abs(mismatch(share)))


def state(run, x):
    """(E* a / (R yield), p_m / yield) at the end of a run."""
    radius, strength = edge(run), EDGE / RADIUS / x
    return radius / RADIUS / strength, -run.contact()["normal_force"][1] / (math.pi * radius**2) / strength


def first_yield(run, x):
    """Peak pressure over the yield stress, by Hertz from the force, midway between the last elastic increment and the first
    plastic one; the pictures tell where there is plastic strain.
    """
    files = sorted(glob.glob(os.path.join(run.directory, "solution_*.vtu")))
    plastic = [max(vtu.vtu_arrays(name)["plastic_strain"]) > 0 for name in files]
    step = plastic.index(True)  # files start with the initial state
    force = -sum(run.increments[step - k]["contacts"][0]["normal_force"][1] for k in (1, 2)) / 2
    return (6 * force / (math.pi**3 * RADIUS**2)) ** (1 / 3) / (EDGE / RADIUS / x)


def verify(bench):
    n = bench.choose(12, 30, 60)
    strengths = bench.choose([100], [5, 10, 20, 40, 80, 160])
    # The contact radius of Hertz is sqrt(R approach), that of a plastic half-space about 1.65 times it.
    elastic, onsets, *plastic = bench.run_all(
        [(DECK, settings(n, 1, 1, 1.0)), (DECK, settings(n, 3, bench.choose(30, 60), 1.0), 1)]
        + [(DECK, settings(n, x, bench.choose(10, 20), 0.5 if x < 20 else 0.38)) for x in strengths])
    points = [state(run, x) for run, x in zip(plastic, strengths)]
    x, mean = state(elastic, 1)
    rows = [Row(f"elastic: p_m / (E* a/R), n {n}", 4 / (3 * math.pi), mean / x, bench.choose(4e-2, 1e-2), runs=[elastic]),
            Row(f"first yield: p_0 / yield, n {n}", onset(POISSON), first_yield(onsets, 3), bench.choose(4e-2, 2e-2), runs=[onsets])]
    for (x, mean), run in zip(points, plastic):
        if x > 40:  # fully plastic: 2.8 to 3
            rows.append(Row(f"plateau: p_m / yield at E* a/(R yield) = {x:.1f}, n {n}", 2.9, mean, 0.1 / 2.9, runs=[run]))
        else:
            rows.append(Row(f"expanding cavity, a model: p_m / yield at {x:.1f}, n {n}", cavity(x, POISSON), mean, 0.1, runs=[run]))
    bench.plot("pressure", Plot(f"Sphere on a plastic half-space: mean pressure, n {n}", "E* a / (R yield)", "p_m / yield", log_x=True)
               .add("computed", points, "line points")
               .add("Hertz", [(x, 4 * x / (3 * math.pi)) for x in (1, 2, 4, 6)], "dashed")
               .add("expanding cavity", [(x, cavity(x, POISSON)) for x in (3, 5, 10, 20, 40)], "dashed")
               .add("2.8", [(30, 2.8), (200, 2.8)], "dashed").add("3.0", [(30, 3.0), (200, 3.0)], "dashed"))
    return rows
