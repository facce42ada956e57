"""Stick radius, load, slip and tractions under the rigid flat punch of examples/punch."""
import math

from contact_figures import stick_radius_by_slip
from stick_radius import EXACT
from suite import Row
from svg import Plot

TITLE = "Rigid flat punch with friction"
DECK = "examples/punch/punch.yaml"
TIED = "{name: interface, impactor: halfspace_top, target: punch_bottom, tied: true}"
APPROACH = 0.01  # delta of the deck; a = 1, E = 1


def settings(n, nu, mu, domain=100, growth=1.1):
    return {"mesh.parameters.n": n, "mesh.parameters.domain": domain, "mesh.parameters.growth": growth,
            "bodies.0.material.poisson": nu, "contact.0.friction.coefficient": mu}


def load(run):
    return -run.contact()["normal_force"][1]


def slip_at(run, radius):
    """Inward slip of the node nearest to a radius over delta; the punch does not move sideways, so it is -u_x."""
    node = min(run.nodes(), key=lambda candidate: abs(candidate["x"] - radius))
    return -node["ux"] / APPROACH if node["status"] == "slip" else 0.0


def boussinesq(force, r):
    """Pressure under a frictionless flat punch of radius 1 (Boussinesq 1885; Johnson, Contact Mechanics, eq. 3.34)."""
    return force / (2 * math.pi * math.sqrt(1 - r * r))


def adhesive_ratio(nu):
    """Load under full adhesion over that without friction (Mossakovskii 1954; Spence 1968)."""
    return (1 - nu) * math.log(3 - 4 * nu) / (1 - 2 * nu)


def friction_rows(nu, mu, meshes, solved):
    exact_c, exact_ratio, exact_slip = EXACT[nu, mu]
    n, run, smooth = meshes[-1], solved[meshes[-1], nu, mu], solved[meshes[-1], nu, 0.0]
    label = f"nu {nu}, mu {mu}, n {n}"
    # The bottom of a finite domain makes the approach that the contact sees larger, by this factor.
    seen = load(smooth) * (1 - nu * nu) / (2 * APPROACH)
    return [Row(f"c/a, {label}", exact_c, stick_radius_by_slip(run.nodes()), 3e-3 if n >= 400 else 6e-3, runs=[run]),
            Row(f"P/P(mu = 0), {label}", exact_ratio, load(run) / load(smooth), 1e-3),
            Row(f"slip at 0.95 a / delta, {label}", exact_slip, slip_at(run, 0.95) / seen, 2e-3, scale=1)]


def frictionless_rows(nu, n, run):
    nodes = [node for node in run.nodes() if node["x"] <= 0.9]
    ratios = [node["pressure"] / boussinesq(load(run), node["x"]) for node in nodes]
    return [Row(f"p(r), mu = 0, r <= 0.9 a: worst p / Boussinesq, nu {nu}, n {n}", 1,
                max(ratios, key=lambda ratio: abs(ratio - 1)), 1e-2 if n >= 200 else 2e-2, runs=[run])]


def convergence_plot(cases, meshes, solved):
    plot = Plot("Punch: error of the stick radius against the number of contact nodes", "contact nodes", "error of c/a, %",
                log_x=True, log_y=True)
    for nu, mu in cases:
        plot.add(f"nu {nu}, mu {mu}", [(n + 1, abs(100 * (stick_radius_by_slip(solved[n, nu, mu].nodes()) / EXACT[nu, mu][0] - 1)))
                                       for n in meshes], "line points")
    return plot.add("greatest published with this method", [(400, 10)], "points")


def profile_plot(nu, mu, run, smooth):
    nodes = sorted(run.nodes(), key=lambda node: node["x"])
    mean = load(run) / math.pi
    shown = [node for node in nodes if node["x"] <= 0.99]
    plot = Plot(f"Punch: tractions over the mean pressure, nu {nu}, mu {mu}, c/a {EXACT[nu, mu][0]}", "r/a", "traction")
    plot.add("p", [(node["x"], node["pressure"] / mean) for node in shown])
    plot.add("|q|", [(node["x"], abs(node["traction_1"]) / mean) for node in shown])
    plot.add("mu p", [(node["x"], mu * node["pressure"] / mean) for node in shown], "dashed")
    return plot.add("p without friction, Boussinesq",
                    [(node["x"], boussinesq(load(smooth), node["x"]) * math.pi / load(smooth)) for node in shown], "dashed")


def domain_rows(bench, n, nu, mu):
    """c/a against the size of the domain, in units of a, with cells outside the punch that grow half as fast."""
    sizes = [30, 100, 300, 1000]
    radii = [stick_radius_by_slip(run.nodes())
             for run in bench.run_all([(DECK, settings(n, nu, mu, size, 1.05)) for size in sizes])]
    exact = EXACT[nu, mu][0]
    bench.plot("domain", Plot(f"Punch: stick radius against the size of the domain, nu {nu}, mu {mu}, n {n}",
                              "radius and depth of the domain over a", "error of c/a, %", log_x=True)
               .add("", [(size, 100 * (c / exact - 1)) for size, c in zip(sizes, radii)], "line points"))
    return [Row(f"c/a, domain {size} a, nu {nu}, mu {mu}, n {n}", exact, c, 1e-2 if size < 100 else 3e-3)
            for size, c in zip(sizes, radii)]


def verify(bench):
    cases = bench.choose([(0.0, 0.3)], list(EXACT))
    meshes = bench.choose([50, 100], [50, 100, 200, 400], [50, 100, 200, 400, 800])
    poisson = sorted({nu for nu, _ in cases})
    points = [(n, nu, mu) for n in reversed(meshes) for nu, mu in [*cases, *((nu, 0.0) for nu in poisson)]]
    solved = dict(zip(points, bench.run_all([(DECK, settings(*point)) for point in points])))
    tied = bench.run_all([(DECK, {"mesh.parameters.n": 100, "bodies.0.material.poisson": nu,
                                  "contact.0": TIED}) for nu in poisson])

    rows = [row for nu, mu in cases for row in friction_rows(nu, mu, meshes, solved)]
    rows += [row for nu in poisson for row in frictionless_rows(nu, meshes[-1], solved[meshes[-1], nu, 0.0])]
    rows += [Row(f"P(full adhesion)/P(mu = 0), nu {nu}, n 100", adhesive_ratio(nu), load(run) / load(solved[100, nu, 0.0]), 2e-3,
                 runs=[run]) for nu, run in zip(poisson, tied)]
    bench.plot("convergence", convergence_plot(cases, meshes, solved))
    for nu, mu in (case for case in cases if case in [(0.0, 0.3), (0.3, 0.2)]):
        bench.plot(f"tractions-nu{nu}-mu{mu}", profile_plot(nu, mu, solved[meshes[-1], nu, mu], solved[meshes[-1], nu, 0.0]))
    if bench.level == "fine":
        rows += domain_rows(bench, 100, 0.0, 0.2)
    return rows
