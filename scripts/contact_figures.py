"""Figures of merit from the nodes of an axisymmetric or plane contact: radii of contact and of stick."""
import math


def line_zero(points):
    """Where the least-squares line through (x, y) points crosses zero, and its value at x = 0."""
    n = len(points)
    mean_x = sum(x for x, _ in points) / n
    mean_y = sum(y for _, y in points) / n
    slope = (sum((x - mean_x) * (y - mean_y) for x, y in points)
             / sum((x - mean_x) ** 2 for x, _ in points))
    return mean_x - mean_y / slope, mean_y - slope * mean_x


def hertz_fit(nodes, low=0.3, high=0.8):
    """Contact radius (or half-width) and peak pressure of a smooth contact centred on x = 0.

    Hertz's pressure obeys p^2 = p0^2 (1 - r^2/a^2), so p^2 is fitted by a line in r^2 over the nodes with `low` to `high` of
    the largest pressure. The default, 0.6 a to 0.95 a, leaves out the last nodes, where one cell smears the root, and the
    axis, where an axisymmetric nodal pressure is least exact. With friction only the edge has that shape: 0.1 to 0.4.
    """
    largest = max(node["pressure"] for node in nodes)
    square, intercept = line_zero([(node["x"] ** 2, node["pressure"] ** 2) for node in nodes
                                   if low <= node["pressure"] / largest <= high])
    return math.sqrt(square), math.sqrt(intercept)


def stick_radius_by_slip(nodes):
    """Stick radius where every node closed at the same time.

    |slip|^(2/3) is linear next to the stick zone: the zero of the line through its 2nd and 4th slipping node. Without so
    many, through the nodes there are; without slip, the outermost node.
    """
    sliding = [(node["x"], abs(node["slip_1"]) ** (2 / 3)) for node in sorted(nodes, key=lambda node: node["x"])
               if node["status"] == "slip"]
    if len(sliding) < 2:
        return max(node["x"] for node in nodes if node["status"] != "open")
    return line_zero([sliding[1], sliding[3]] if len(sliding) > 3 else sliding[-2:])[0]


def stick_radius_by_traction(nodes, mu):
    """Stick radius where the contact grew while it was loaded, so that sticking nodes have slip of earlier times.

    The growth of |q| falls behind that of mu p like a square root of the distance from the stick zone's edge, |q| itself
    like its power 3/2: the zero of the line through (1 - |q|/(mu p))^(2/3) at the 2nd and 4th sticking node from that edge.
    """
    sticking = [(node["x"], max(1 - abs(node["traction_1"]) / (mu * node["pressure"]), 0) ** (2 / 3))
                for node in sorted(nodes, key=lambda node: -node["x"]) if node["status"] == "stick"]
    return line_zero([sticking[1], sticking[3]])[0]
