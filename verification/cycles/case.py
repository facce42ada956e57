"""Two like cylinders under a constant normal load and an oscillating tangential one: the loop of Cattaneo and Mindlin."""
import glob
import math
import os

import mesh
from suite import Row
from svg import Plot
from vtu import vtu_arrays

TITLE = "Cycles of tangential load"
RADIUS, POISSON, MU, EDGE = 1.0, 0.3, 0.3, 0.01  # of each cylinder, E = 1; half-width of the contact, about
DOMAIN = 100  # over EDGE, to each side and in depth
MODULUS = 1 / (2 * (1 - POISSON**2))  # of the pair, E*
LOAD = math.pi * MODULUS * EDGE**2 / (4 * RADIUS / 2)  # per length, for that half-width (Hertz; Johnson 1985, eq. 4.43)


def bodies(path, n):
    """Two half-spaces with the parabola of a cylinder up to 2 EDGE; their nodes match."""
    h = EDGE / n
    fine = mesh.spaced(0, 1.25 * EDGE, math.ceil(1.25 * n))
    side = fine + [fine[-1] + c for c in mesh.graded(h, DOMAIN * EDGE - fine[-1], 1.15)[1:]]
    across, down = [-x for x in reversed(side[1:])] + side, mesh.graded(h, DOMAIN * EDGE, 1.15)

    def profile(x):
        return min(x * x, (2 * EDGE) ** 2) / (2 * RADIUS)

    made = mesh.Mesh(2)
    made.add("lower", across, [-y for y in reversed(down)], moved=lambda x, y: (x, y - profile(x)))
    made.add("upper", across, down, moved=lambda x, y: (x, y + profile(x)))
    return made.write(path)


def wave(amplitude):
    """Displacement: 0 at t = 1, amplitude at 2, -amplitude at 4, amplitude at 6."""
    return f"{amplitude!r}*(max(t-1,0)-2*max(t-2,0)+2*max(t-4,0))"


def displacement(amplitude, t):
    return amplitude * (max(t - 1, 0) - 2 * max(t - 2, 0) + 2 * max(t - 4, 0))


def forces(run):
    """(t, tangential force on the upper body, normal force) after each increment."""
    contacts = [(increment["time"], increment["contacts"][0]) for increment in run.increments]
    return [(t, c["tangential_force"][0] + c["normal_force"][0], c["normal_force"][1] + c["tangential_force"][1])
            for t, c in contacts]


def dissipated(history, amplitude):
    """Work of the grip over the closed cycle from t = 2 to 6, by the trapezoidal rule."""
    work = 0.0
    for (t, before, _), (now, after, _) in zip(history, history[1:]):
        if t >= 2 - 1e-9:
            work -= (before + after) / 2 * (displacement(amplitude, now) - displacement(amplitude, t))
    return work


def loop_energy(q, limit):
    """Energy dissipated per cycle between -q and q, `limit` = mu P, per unit length (README: Masing's rule on the first loading).

    Tangential approach of the first loading: linear part + limit/(pi E*) (1 - s) ln(1 - s), s = Q/limit.
    """
    s = q / limit
    left = 1 - s
    integral = -0.25 - left**2 / 2 * math.log(left) + left**2 / 4  # of (1 - s) ln(1 - s) from 0 to s
    return 8 * limit**2 / (math.pi * MODULUS) * (s / 2 * left * math.log(left) - integral)


def nodes_at(run, t):
    """Nodes of the contact at t, where slip has a sign."""
    pictures = sorted(glob.glob(os.path.join(run.directory, "contact_interface_*.vtu")))
    increment = min(range(len(run.increments)), key=lambda i: abs(run.increments[i]["time"] - t))
    arrays = vtu_arrays(pictures[increment + 1])
    n = len(arrays["pressure"])
    traction = arrays["traction"]
    return sorted(({"x": arrays["Points"][3 * i], "pressure": arrays["pressure"][i], "status": int(arrays["status"][i]),
                    "q": traction[i * (len(traction) // n)]} for i in range(n)), key=lambda node: node["x"])


def stick_width(nodes, h):
    """Half the width of the zone that sticks; its edges are taken half a cell outside its last nodes."""
    sticking = [node["x"] for node in nodes if node["status"] == 1]
    return (max(sticking) - min(sticking) + h) / 2 if sticking else 0.0


def half_width(normal):
    return math.sqrt(2 * normal * RADIUS / (math.pi * MODULUS))


def cattaneo(x, a, c, peak):
    """|q| at the first greatest load: mu p less that of a contact of half-width c (Cattaneo 1938; Johnson 1985, eq. 7.28)."""
    full, inner = (math.sqrt(max(1 - (x / r) ** 2, 0)) for r in (a, c))
    return MU * peak * (full - c / a * inner)


def calibrated(bench, path):
    """Approach for LOAD, and the tangential stiffness with all sticking: both depend on the domain."""
    down, aside = 5.5e-4, 1e-6
    run = bench.run("cycles.yaml", {"mesh.file": path, "contact.0.friction.coefficient": 10, "boundary.1.displacement.y": f"-{down}*min(t,1)",
                                    "boundary.1.displacement.x": f"{aside}*max(t-1,0)", "loading.end": 2, "loading.increments": 4})
    _, tangential, normal = forces(run)[-1]
    return down * LOAD / normal, abs(tangential) / aside


def partial_slip_rows(run, amplitude, n):
    history, h = forces(run), EDGE / n
    at = {t: min(history, key=lambda step: abs(step[0] - t)) for t in (2, 3, 4, 6)}
    q, normal = abs(at[2][1]), at[2][2]
    a, limit = half_width(normal), MU * normal
    peak = 2 * normal / (math.pi * a)
    c, returning = a * math.sqrt(1 - q / limit), a * math.sqrt(1 - (q - abs(at[3][1])) / (2 * limit))
    nodes = nodes_at(run, 2)
    wrong = [abs(abs(node["q"]) - cattaneo(node["x"], a, c, peak)) for node in nodes if abs(node["x"]) < 0.95 * a]
    label = f"Q/(mu P) = {q / limit:.3f}, n {n}"
    return [Row(f"{label}: half-width that sticks at the greatest load, over a", c / a, stick_width(nodes, h) / a, 1 / n, scale=1, runs=[run]),
            Row(f"{label}: the same on the way back at displacement 0", returning / a, stick_width(nodes_at(run, 3), h) / a, 1 / n, scale=1),
            Row(f"{label}: mean of ||q| - Cattaneo| at the greatest load, over mu p0", 0, sum(wrong) / len(wrong) / (MU * peak), 0.4 / n),
            Row(f"{label}: energy dissipated per cycle", loop_energy(q, limit), dissipated(history, amplitude), 1e-2),
            Row(f"{label}: Q after a cycle over Q before", 1, abs(at[6][1]) / q, 1e-3),
            Row(f"{label}: P, greatest less least over its mean", 0, spread([normal for t, _, normal in history if t >= 1]), 1e-3)]


def spread(values):
    return (max(values) - min(values)) / (sum(values) / len(values))


def full_slip_rows(run, n):
    history, rows = forces(run), []
    for t in (2, 4, 6):
        _, tangential, normal = min(history, key=lambda step: abs(step[0] - t))
        rows.append(Row(f"beyond full slip, n {n}, t = {t}: |Q|/(mu P)", 1, abs(tangential) / (MU * normal), 1e-3, runs=[run] if t == 2 else ()))
        rows.append(Row(f"beyond full slip, n {n}, t = {t}: nodes that stick", 0, sum(node["status"] == 1 for node in nodes_at(run, t)), 0))
    first = min(t for t, _, _ in history if t > 2 + 1e-9)
    nodes = nodes_at(run, first)
    closed = sum(node["status"] > 0 for node in nodes)
    return rows + [Row(f"beyond full slip, n {n}, first increment back: nodes that stick / closed", 1,
                       sum(node["status"] == 1 for node in nodes) / closed, 0.3)]


def verify(bench):
    n, increments = bench.choose((10, 60), (40, 120), (80, 240))
    approach, stiffness = calibrated(bench, bodies(bench.path("calibration.msh"), 5))
    path = bodies(bench.path(f"cylinders-{n}.msh"), n)
    amplitudes = [share * MU * LOAD / stiffness for share in (0.75, 1.3)]
    partial, full = bench.run_all([("cycles.yaml", {
        "mesh.file": path, "boundary.1.displacement.y": f"-{approach!r}*min(t,1)", "boundary.1.displacement.x": wave(amplitude),
        "loading.increments": increments, "loading.fixed": "true"}, 1) for amplitude in amplitudes])
    plot = Plot(f"Cycles: tangential load against displacement, n {n}", "displacement / 1e-6", "Q/(mu P)")
    for label, run, amplitude in (("partial slip", partial, amplitudes[0]), ("beyond full slip", full, amplitudes[1])):
        plot.add(label, [(1e6 * displacement(amplitude, t), -q / (MU * normal)) for t, q, normal in forces(run) if t >= 1])
    bench.plot("loop", plot)
    return partial_slip_rows(partial, amplitudes[0], n) + full_slip_rows(full, n)
