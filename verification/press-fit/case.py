"""Two concentric rings, pressed together from outside or by an interference, against Lame's solutions."""
from suite import ELEMENTS, Row, order
from svg import Plot

TITLE = "Press-fit rings"
INNER, FIT, OUTER, YOUNG = 0.2, 0.6, 1.0, 1e9
INTERFERENCE = 6e-6  # small, since Lame's formula is of first order in interference / radius


def composite(pressure):
    """Radial pressure at r = FIT of one ring under outer pressure (Lame 1852): two rings of one material that fit exactly."""
    return pressure * OUTER**2 / (OUTER**2 - INNER**2) * (1 - INNER**2 / FIT**2)


def shrunk(interference):
    """Pressure between two rings of one material (Timoshenko and Goodier, Theory of Elasticity, section 28)."""
    return (YOUNG * interference * (FIT**2 - INNER**2) * (OUTER**2 - FIT**2)
            / (2 * FIT**3 * (OUTER**2 - INNER**2)))


def mean(run):
    nodes = run.nodes("fit")
    return sum(node["pressure"] * node["area"] for node in nodes) / sum(node["area"] for node in nodes)


def worst(run, reference):
    return max((node["pressure"] for node in run.nodes("fit")), key=lambda pressure: abs(pressure - reference))


CORNERS = ("every node of a ring meets a corner between two straight faces and takes the normal of one of them, half a cell's angle "
           "off the radius; the error goes with the cell's size")
SWITCHES = CORNERS + ", but for two nodes, where neighbours begin to take the face on their other side"
POLYGONS = ("two polygons that do not match leave gaps and overlaps of h^2/(8 r) between them, which averages do not take out at each node; "
            "the error goes with h")


def pair(name, run, reference, reason, convergence=None):
    """Rows of the mean and of the worst node."""
    return [Row(f"{name}: mean pressure", reference, mean(run), 1e-3, runs=[run]),
            Row(f"{name}: worst node", reference, worst(run, reference), 1e-3, order=convergence, reason=reason)]


def cells(inner, outer, **more):
    return {"mesh.parameters.n_inner": inner, "mesh.parameters.n_outer": outer,
            **{f"mesh.parameters.{key}": value for key, value in more.items()}}


def ring_rows(bench, n, slenderness, n_not, plot):
    """Rings of n cells that match, their cells so much longer in the radius, and of n_not that do not; by each contact element."""
    exact, fit, deck = composite(1e6), shrunk(INTERFERENCE), "examples/press-fit/press-fit.yaml"
    rows = []
    for element, (chosen, ripple) in ELEMENTS.items():
        half, full, forced, *others = bench.run_all([
            (deck, {**cells(n // 2, n // 2, slenderness=slenderness / 2), **chosen}),
            (deck, {**cells(n, n, slenderness=slenderness), **chosen}),
            ("examples/press-fit/interference.yaml", {**cells(n, n, slenderness=slenderness, interference=INTERFERENCE), **chosen}),
            *((deck, {**cells(n_not, outer), **chosen}) for outer in (n_not // 2, 3 * n_not // 4))])
        convergence = order(*(abs(worst(run, exact) / exact - 1) for run in (half, full)))
        rows += pair(f"{element}, rings under pressure, {n}:{n}", full, exact, ripple and CORNERS, convergence)
        rows += pair(f"{element}, rings shrunk together, {n}:{n}", forced, fit, ripple and SWITCHES)
        for outer, run in zip((n_not // 2, 3 * n_not // 4), others):
            rows += pair(f"{element}, rings under pressure, {n_not}:{outer}", run, exact, ripple or POLYGONS)
            plot.add(f"{element}, {n_not}:{outer}", [(node["x"], node["pressure"] / exact) for node in run.nodes("fit")], "points")
    return rows


def tube_rows(bench):
    exact, fit = composite(1e6), shrunk(INTERFERENCE)
    coarse, fine, forced = bench.run_all([
        ("tubes.yaml", {"mesh.parameters.n": 20}), ("tubes.yaml", {"mesh.parameters.n": 40}),
        ("tubes.yaml", {"mesh.parameters.n": 40, "mesh.parameters.interference": INTERFERENCE, "boundary.1.pressure": 0})])
    convergence = order(*(abs(worst(run, exact) / exact - 1) for run in (coarse, fine)))
    return (pair("tubes under pressure, axisymmetric", fine, exact, "", convergence)
            + pair("tubes shrunk together, axisymmetric", forced, fit, ""))


def verify(bench):
    plot = Plot("Rings under outer pressure: nodal pressure over Lame's", "x", "pressure over exact")
    rows = ring_rows(bench, bench.choose(48, 1536), bench.choose(2, 16), bench.choose(48, 384), plot) + tube_rows(bench)
    bench.plot("pressure", plot)
    return rows
