"""Stick radius, load and slip under the rigid punch against exact values.   validate_punch.py PROGRAM [n ...]

For nu = 0 and 0.3 with mu = 0.2, 0.3, 0.4 on meshes of n cells on [0, a] (default 100, 200 and 400): the stick radius c/a, the
load P over that of the same mesh without friction, and the inward slip at r = 0.95 a over the approach delta. Exit code 1
where, on a mesh of 400 cells, c/a is off by more than 1 % or P/P(mu = 0) by more than 0.5 %.
"""
import os
import shutil
import sys

from contact_figures import stick_radius_by_slip
from results import run, table

# Exact coupled solution (Spence 1975), by boundary elements with two independent algorithms.
# (nu, mu): c/a, P/P(mu = 0), inward slip at 0.95 a over delta.
EXACT = {
    (0.0, 0.2): (0.22086, 1.03595, 0.14434),
    (0.0, 0.3): (0.50316, 1.05240, 0.10416),
    (0.0, 0.4): (0.69819, 1.06546, 0.07043),
    (0.3, 0.2): (0.69828, 1.01927, 0.03663),
    (0.3, 0.3): (0.89596, 1.02430, 0.00877),
    (0.3, 0.4): (0.96111, 1.02661, 0.0),
}
DECK = os.path.join(os.path.dirname(__file__), "..", "examples", "punch", "punch.yaml")
APPROACH = 0.01  # delta of the deck
RADIUS = 1.0  # a of the mesh
YOUNG = 1.0


def solve(program, n, nu, mu):
    """Load and surface nodes by radius."""
    finished = run(program, DECK, [f"mesh.parameters.n={n}", f"bodies.0.material.poisson={nu}",
                                   f"contact.0.friction.coefficient={mu}", "output.every=0"])
    if not finished.converged:
        raise RuntimeError(f"n = {n}, nu = {nu}, mu = {mu}: not converged")
    load = -finished.contact()["normal_force"][1]
    nodes = sorted(finished.nodes(), key=lambda node: node["x"])
    iterations = finished.newton_iterations()
    shutil.rmtree(finished.directory)
    return load, nodes, iterations


def slip_at(nodes, radius):
    """Inward slip of the node nearest to a radius; the punch does not move sideways, so it is -u_x."""
    node = min(nodes, key=lambda candidate: abs(candidate["x"] - radius))
    return -node["ux"] if node["status"] == "slip" else 0.0


def percent(value, exact):
    return f"{100 * (value / exact - 1):+.3f}"


def main():
    program = sys.argv[1]
    meshes = [int(argument) for argument in sys.argv[2:]] or [100, 200, 400]
    rows = []
    within = True
    for nu in (0.0, 0.3):
        half_space = 2 * YOUNG / (1 - nu * nu) * RADIUS * APPROACH  # P of the unbounded half-space, mu = 0
        frictionless = {n: solve(program, n, nu, 0)[0] for n in meshes}
        for mu in (0.2, 0.3, 0.4):
            exact_c, exact_load, exact_slip = EXACT[nu, mu]
            for n in meshes:
                load, nodes, iterations = solve(program, n, nu, mu)
                c = stick_radius_by_slip(nodes) / RADIUS
                ratio = load / frictionless[n]
                slip = slip_at(nodes, 0.95 * RADIUS) / APPROACH
                # The finite domain is stiffer than the half-space: the approach that the contact sees is larger.
                seen = slip * half_space / frictionless[n]
                rows.append([f"{nu}", f"{mu}", f"{n}", f"{c:.5f}", f"{exact_c:.5f}", percent(c, exact_c),
                             f"{ratio:.5f}", f"{exact_load:.5f}", percent(ratio, exact_load),
                             f"{slip:.5f}", f"{seen:.5f}", f"{exact_slip:.5f}", f"{seen - exact_slip:+.5f}",
                             f"{max(iterations)}"])
                print(f"n = {n}, nu = {nu}, mu = {mu}: c/a = {c:.5f}", file=sys.stderr, flush=True)
                if n >= 400:
                    within &= abs(c / exact_c - 1) <= 0.01 and abs(ratio / exact_load - 1) <= 0.005
    print(table(["nu", "mu", "n", "c/a", "exact", "error %", "P/P0", "exact", "error %", "slip/delta",
                 "/delta seen", "exact", "error", "Newton"], rows))
    print("slip: inward, at r = 0.95 a; 'delta seen' is delta times P(mu = 0) over that of the unbounded half-space")
    return 0 if within else 1


if __name__ == "__main__":
    sys.exit(main())
