"""Two concentric rings, pressed together from outside or by an interference, against Lame's solutions."""
from suite import Row, order
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
RIPPLE = "constraints at nodes do not pass on a uniform pressure where meshes do not match; mean and forces do converge"


def verify(bench):
    n = bench.choose(48, 192, 384)
    exact, fit = composite(1e6), shrunk(INTERFERENCE)
    rings, tubes = "examples/press-fit/press-fit.yaml", "tubes.yaml"

    def cells(inner, outer, **more):
        return {"mesh.parameters.n_inner": inner, "mesh.parameters.n_outer": outer,
                **{f"mesh.parameters.{key}": value for key, value in more.items()}}

    half, full, fine_inner, other, forced = bench.run_all([
        (rings, cells(n // 2, n // 2)), (rings, cells(n, n)), (rings, cells(n, n // 2)), (rings, cells(n, 3 * n // 4)),
        ("examples/press-fit/interference.yaml", cells(n, n, interference=INTERFERENCE))])
    coarse_tube, tube, forced_tube = bench.run_all([
        (tubes, {"mesh.parameters.n": 20}), (tubes, {"mesh.parameters.n": 40}),
        (tubes, {"mesh.parameters.n": 40, "mesh.parameters.interference": INTERFERENCE, "boundary.1.pressure": 0})])

    def error(run):
        return abs(worst(run, exact) / exact - 1)

    def pair(name, run, reference, reason, convergence=None):
        return [Row(f"{name}: mean pressure", reference, mean(run), 1e-3, runs=[run]),
                Row(f"{name}: worst node", reference, worst(run, reference), 1e-3, order=convergence, reason=reason)]

    rows = pair(f"rings under pressure, {n}:{n}", full, exact, CORNERS, order(error(half), error(full)))
    rows += pair(f"rings under pressure, {n}:{n // 2}", fine_inner, exact, RIPPLE)
    rows += pair(f"rings under pressure, {n}:{3 * n // 4}", other, exact, RIPPLE)
    rows += pair(f"rings shrunk together, {n}:{n}", forced, fit, CORNERS)
    rows += pair("tubes under pressure, axisymmetric", tube, exact, "", order(error(coarse_tube), error(tube)))
    rows += pair("tubes shrunk together, axisymmetric", forced_tube, fit, "")
    bench.plot("pressure", Plot(f"Rings under outer pressure, {n} cells of the inner one: nodal pressure over Lame's",
                                "x", "pressure over exact")
               .add(f"{n} of the outer", [(node["x"], node["pressure"] / exact) for node in full.nodes("fit")], "points")
               .add(f"{n // 2}", [(node["x"], node["pressure"] / exact) for node in fine_inner.nodes("fit")], "points")
               .add(f"{3 * n // 4}", [(node["x"], node["pressure"] / exact) for node in other.nodes("fit")], "points"))
    return rows
