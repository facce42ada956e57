"""Sphere on a rigid plane with friction, whose contact grows with the load: its stick radius at every time."""
import glob
import math
import os

from contact_figures import hertz_fit, stick_radius_by_traction
from stick_radius import EXACT
from suite import Row
from svg import Plot
from vtu import vtu_arrays

TITLE = "Sphere with friction, self-similar"
DECK = "examples/hertz-sphere/friction.yaml"
STATUS = ("open", "stick", "slip")


def pictured(path):
    """Nodes of a picture of the contact as rows of the table at the end would have them."""
    arrays = vtu_arrays(path)
    n = len(arrays["pressure"])
    traction, points = arrays["traction"], arrays["Points"]
    width = len(traction) // n
    return [{"x": points[3 * i], "pressure": arrays["pressure"][i], "status": STATUS[int(arrays["status"][i])],
             "traction_1": math.hypot(*traction[width * i:width * (i + 1)])} for i in range(n)]


def ratio(nodes, mu):
    """c/a: c from the tractions, a at the edge, the only part where p^2 is still linear in r^2."""
    return stick_radius_by_traction(nodes, mu) / hertz_fit(nodes, 0.1, 0.4)[0]


def history(run, mu):
    """(t, c/a) of each picture of the second half of the loading."""
    pictures = sorted(glob.glob(os.path.join(run.directory, "contact_interface_*.vtu")))
    times = [i / (len(pictures) - 1) for i in range(len(pictures))]
    return [(t, ratio(pictured(picture), mu)) for t, picture in zip(times, pictures) if t > 0.49]


def verify(bench):
    cases = bench.choose([(0.3, 0.2)], [(0.3, 0.2), (0.0, 0.3)])
    n = bench.choose(40, 60, 120)
    runs = bench.run_all([(DECK, {"mesh.parameters.n": n, "loading.increments": n, "bodies.0.material.poisson": nu,
                                  "contact.0.friction.coefficient": mu}, n // 10) for nu, mu in cases])
    rows = []
    plot = Plot(f"Sphere with friction: stick radius while it is loaded, n {n}", "t", "c/a")
    for (nu, mu), run in zip(cases, runs):
        found, exact = history(run, mu), EXACT[nu, mu][0]
        values = [value for _, value in found]
        rows += [Row(f"c/a at the end, nu {nu}, mu {mu}, n {n}", exact, values[-1], bench.choose(3e-2, 1e-2), runs=[run]),
                 Row(f"c/a, greatest less least from t = 0.5 on, nu {nu}, mu {mu}, n {n}", 0, max(values) - min(values),
                     bench.choose(3e-2, 2e-2), scale=exact)]
        plot.add(f"nu {nu}, mu {mu}", found, "line points")
        plot.add(f"flat punch (Spence), nu {nu}, mu {mu}", [(0.5, exact), (1, exact)], "dashed")
    bench.plot("history", plot)
    return rows
