"""A manufactured solution of two bodies in contact all along a side that bends: orders of convergence, meshes matching or not.

u_x = A sin(pi x) cos(pi y) + D pi y sin(pi x),  u_y = -B y + C cos(pi x) sin(pi y) + D cos(pi x): no shear on y = 0 nor on the
sides x = 0 and 1, and no jump of u_y on y = 0, so with pressure > 0 it solves frictionless contact with these body forces.
"""
import glob
import math
import os

import mesh
from suite import ELEMENTS, Row, order
from svg import Plot
from vtu import vtu_arrays

TITLE = "Orders of convergence"
A, B, C, D = 0.02, 0.2, 0.01, 0.03
YOUNG, POISSON = 1.0, 0.3
LAME = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
SHEAR = YOUNG / (2 * (1 + POISSON))
STIFF = LAME + 2 * SHEAR
PI = math.pi
GAUSS = [(-math.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (math.sqrt(0.6), 5 / 9)]

UX = f"({A}*cos({PI!r}*y)+{D * PI!r}*y)*sin({PI!r}*min(x,1-x))"  # zero to the last digit on both sides
UY = f"(-{B}*y+{C}*cos({PI!r}*x)*sin({PI!r}*y)+{D}*cos({PI!r}*x))"
# Minus the divergence of the stress, by hand.
FX = (f"({PI**2 * (STIFF * A + LAME * C + SHEAR * (A + C))!r}*sin({PI!r}*x)*cos({PI!r}*y)"
      f"+{STIFF * D * PI**3!r}*y*sin({PI!r}*x))")
FY = (f"({PI**2 * (SHEAR * (A + C) + LAME * A + STIFF * C)!r}*cos({PI!r}*x)*sin({PI!r}*y)"
      f"-{LAME * D * PI**2!r}*cos({PI!r}*x))")


def displacement(x, y):
    return (A * math.sin(PI * x) * math.cos(PI * y) + D * PI * y * math.sin(PI * x),
            -B * y + C * math.cos(PI * x) * math.sin(PI * y) + D * math.cos(PI * x))


def strain(x, y):
    """Strains xx, yy and the engineering shear strain."""
    cc = math.cos(PI * x) * math.cos(PI * y)
    return (A * PI * cc + D * PI**2 * y * math.cos(PI * x), -B + C * PI * cc, -(A + C) * PI * math.sin(PI * x) * math.sin(PI * y))


def pressure(x):
    xx, yy, _ = strain(x, 0)
    return -(LAME * xx + STIFF * yy)


def energy_density(xx, yy, xy):
    """Twice the energy of these strains."""
    return STIFF * (xx * xx + yy * yy) + 2 * LAME * xx * yy + SHEAR * xy * xy


def field_errors(run):
    """Displacement in L2 and energy norm, each over the norm of the exact one. The cells are rectangles."""
    arrays = vtu_arrays(sorted(glob.glob(os.path.join(run.directory, "solution_*.vtu")))[-1])
    points, moved, cells = arrays["Points"], arrays["displacement"], arrays["connectivity"]
    sums = [0.0] * 4
    for begin in range(0, len(cells), 4):
        nodes = cells[begin:begin + 4]
        xs, ys = [points[3 * i] for i in nodes], [points[3 * i + 1] for i in nodes]
        x0, y0, dx, dy = min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys)
        signs = [(1 if x > x0 + dx / 2 else -1, 1 if y > y0 + dy / 2 else -1) for x, y in zip(xs, ys)]
        us = [(moved[3 * i], moved[3 * i + 1]) for i in nodes]
        for xi, wx in GAUSS:
            for eta, wy in GAUSS:
                weight = wx * wy * dx * dy / 4
                at = x0 + dx * (1 + xi) / 2, y0 + dy * (1 + eta) / 2
                shapes = [((1 + s * xi) * (1 + t * eta) / 4, s * (1 + t * eta) / (2 * dx), t * (1 + s * xi) / (2 * dy)) for s, t in signs]
                u, v = (sum(n * own[c] for (n, _, _), own in zip(shapes, us)) for c in (0, 1))
                xx = sum(nx * own[0] for (_, nx, _), own in zip(shapes, us))
                yy = sum(ny * own[1] for (_, _, ny), own in zip(shapes, us))
                xy = sum(ny * own[0] + nx * own[1] for (_, nx, ny), own in zip(shapes, us))
                exact, stretch = displacement(*at), strain(*at)
                for k, value in enumerate(((u - exact[0]) ** 2 + (v - exact[1]) ** 2, exact[0] ** 2 + exact[1] ** 2,
                                           energy_density(xx - stretch[0], yy - stretch[1], xy - stretch[2]), energy_density(*stretch))):
                    sums[k] += weight * value
    return math.sqrt(sums[0] / sums[1]), math.sqrt(sums[2] / sums[3])


def pressure_error(run):
    """In L2, the nodal pressures interpolated, over the norm of the exact one."""
    nodes = sorted(run.nodes(), key=lambda node: node["x"])
    found = exact = 0.0
    for left, right in zip(nodes, nodes[1:]):
        length = right["x"] - left["x"]
        for xi, weight in GAUSS:
            share = (1 + xi) / 2
            p = pressure(left["x"] + share * length)
            found += weight * length / 2 * (left["pressure"] * (1 - share) + right["pressure"] * share - p) ** 2
            exact += weight * length / 2 * p * p
    return math.sqrt(found / exact)


def deck(bench, n_lower, n_upper, chosen):
    made = mesh.Mesh(2)
    made.add("lower", mesh.spaced(0, 1, n_lower), mesh.spaced(-1, 0, n_lower))
    made.add("upper", mesh.spaced(0, 1, n_upper), mesh.spaced(0, 1, n_upper))
    settings = {"mesh.file": made.write(bench.path(f"{n_lower}-{n_upper}.msh")), "solver.tolerance": 1e-12, **chosen}
    for entry in (4, 5):
        settings |= {f"boundary.{entry}.displacement.x": f'"{UX}"', f"boundary.{entry}.displacement.y": f'"{UY}"'}
    for entry in (6, 7):
        settings |= {f"boundary.{entry}.body-force.x": f'"{FX}"', f"boundary.{entry}.body-force.y": f'"{FY}"'}
    return "convergence.yaml", settings, 1


# Norm: order of bilinear cells for a smooth solution, on meshes that match and that do not; how far off it may be.
NORMS = [("displacement, L2", 2, 2, 0.1), ("energy", 1, 1, 0.1), ("pressure, L2", 2, 1, 0.4)]


def verify(bench):
    sizes = bench.choose([4, 8, 16], [8, 16, 32], [8, 16, 32, 64])
    rows = []
    plot = Plot("Convergence, meshes that do not match (2:3): errors against the length of the cells", "h of the lower body", "relative error", log_x=True, log_y=True)
    for element, (chosen, reason) in ELEMENTS.items():
        for name, share in (("matching", 1), ("not matching, 2:3", 1.5)):
            runs = bench.run_all([deck(bench, n, round(share * n), chosen) for n in sizes])
            errors = [(*field_errors(run), pressure_error(run)) for run in runs]
            for k, (norm, *expected, tolerance) in enumerate(NORMS):
                found = order(errors[-2][k], errors[-1][k])
                rows.append(Row(f"{element}, {name}, {norm}: order from n {sizes[-2]} to {sizes[-1]} (error {errors[-1][k]:.1e})",
                                expected[share > 1], found, tolerance, scale=1, order=found, runs=[runs[-1]], reason=reason if share > 1 else ""))
                if share > 1:
                    plot.add(f"{norm}, {element}", [(1 / n, error[k]) for n, error in zip(sizes, errors)], "line points")
    bench.plot("errors", plot)
    return rows
