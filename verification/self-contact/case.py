"""A ring pressed onto itself (examples/self-contact): how deep its parts are in each other, and the balance of its forces."""
import math

from suite import Row, order

TITLE = "Self-contact"
DECK = "examples/self-contact/ring.yaml"
THICKNESS = 0.1
APART = 0.5  # along the undeformed side: parts nearer than that do not count as opposite


def depth(run):
    """Greatest depth of a node of the inside behind another part of it, measured on the polygon of the nodes where they are.

    Nodes in the order of their angle from the bottom, counter-clockwise: the hole is on the left of each segment.
    """
    nodes = sorted(run.nodes("within"), key=lambda node: math.atan2(node["x"], -node["y"]))
    rest = [(node["x"], node["y"]) for node in nodes]
    place = [(node["x"] + node["ux"], node["y"] + node["uy"]) for node in nodes]
    greatest = 0.0
    for i, (x, y) in enumerate(place):
        for k, ((x0, y0), (x1, y1)) in enumerate(zip(place, place[1:])):
            length = math.hypot(x1 - x0, y1 - y0)
            along = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / length**2
            height = ((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) / length
            if 0 <= along <= 1 and -THICKNESS / 2 < height < 0 and min(math.dist(rest[i], rest[j]) for j in (k, k + 1)) > APART:
                greatest = max(greatest, -height)
    return greatest


def vertical(run, name):
    return sum(run.contact(name)[force][1] for force in ("normal_force", "tangential_force"))


def verify(bench):
    sizes = bench.choose([20], [20, 40], [20, 40, 80])
    runs = bench.run_all([(DECK, {"mesh.parameters.n": n}) for n in sizes])
    depths = [depth(run) for run in runs]
    return [Row(f"n {sizes[-1]}: greatest depth of a node in the other part, over the thickness", 0, depths[-1] / THICKNESS,
                bench.choose(1e-1, 2e-2), order=order(*depths[-2:]) if len(sizes) > 1 else None, runs=[runs[-1]]),
            Row(f"n {sizes[-1]}: force of roller and floor, sum over the roller's", 0,
                (vertical(runs[-1], "above") + vertical(runs[-1], "below")) / vertical(runs[-1], "above"), 1e-6),
            Row(f"n {sizes[-1]}: nodes that touch within, at least one", 1, min(1, runs[-1].contact("within")["n_active"]), 0)]
