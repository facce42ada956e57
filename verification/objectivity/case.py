"""Two bodies in finite strain pressed and dragged with friction, and the same in a frame that is turned, shifted, or moving."""
import math
import random

import mesh
from suite import Row
from svg import Plot

TITLE = "Objectivity"
TOLERANCE = 1e-9
AXES = "xyz"
END = 2  # of t: pressing until 1, then dragging
JERKS = 16 * math.pi * 1.07  # per t, radians of their phase


class Frame:
    """x -> R (x - c0) + c0 + c: turned and shifted before (R0, c0) and, with t, while loading.

    `jerks`: of the turning, in radians, forth and back about eight times per t.
    """

    def __init__(self, dimension, before, during, seed, begin=0, jerks=0.0):
        chance = random.Random(seed)
        self.dimension = dimension
        axis = [chance.gauss(0, 1) for _ in range(3)] if dimension == 3 else [0.0, 0.0, 1.0]
        length = math.sqrt(sum(a * a for a in axis))
        self.axis = [a / length for a in axis]
        self.angle = chance.uniform(0.7, 2.5) if before else 0.0
        self.shift = [chance.uniform(-2, 2) if before else 0.0 for _ in range(dimension)]
        self.begin = begin  # of the motion, in t
        self.rate = chance.uniform(0.4, 0.8) if during else 0.0  # radians per t
        self.speed = [chance.uniform(-1, 1) if during else 0.0 for _ in range(dimension)]
        self.jerks = jerks

    def _parts(self, i, j):
        """Coefficients of 1, cos and sin in the rotation's entry i, j (Rodrigues)."""
        outer = self.axis[i] * self.axis[j]
        sine = 0.0 if i == j else self.axis[3 - i - j] * (-1 if (i, j) in ((0, 1), (1, 2), (2, 0)) else 1)
        return outer, (i == j) - outer, sine

    def turned(self, vector, angle):
        return [sum((one + c * math.cos(angle) + s * math.sin(angle)) * vector[j]
                    for j, (one, c, s) in ((j, self._parts(i, j)) for j in range(self.dimension)))
                for i in range(self.dimension)]

    def start(self, *place):
        """Where a node of the mesh starts."""
        return tuple(a + b for a, b in zip(self.turned(place, self.angle), self.shift))

    def displacement(self, load):
        """Expressions of the displacement of a side that moves by `load` (expressions, one per axis) in its own frame."""
        turned = [" + ".join(f"({coefficient!r})*({part})" for coefficient, part in
                             zip(self.turned_row(i), load)) for i in range(self.dimension)]
        in_frame = [f"({AXES[i]} - ({self.shift[i]!r}) + {turned[i]})" for i in range(self.dimension)]
        time = f"max(t-{self.begin},0)"
        angle = f"({self.rate!r}*{time} + {self.jerks!r}*sin({JERKS!r}*{time}))"
        found = []
        for i in range(self.dimension):
            entries = []
            for j in range(self.dimension):
                one, c, s = self._parts(i, j)
                entries.append(f"(({one!r}) + ({c!r})*cos{angle} + ({s!r})*sin{angle})*{in_frame[j]}")
            found.append(f"{' + '.join(entries)} + ({self.shift[i]!r}) + ({self.speed[i]!r})*{time} - {AXES[i]}")
        return "{" + ", ".join(f'{AXES[i]}: "{expression}"' for i, expression in enumerate(found)) + "}"

    def turned_row(self, i):
        return [self.turned([float(j == k) for k in range(self.dimension)], self.angle)[i] for j in range(self.dimension)]

    def back(self, vector):
        """A vector at the end, seen from the bodies' own frame."""
        time = END - self.begin
        return self.turned(self.turned(vector, -self.rate * time - self.jerks * math.sin(JERKS * time)), -self.angle)


def bodies(path, dimension, frame):
    """A slab and a block on it with a rounded lower side, whose nodes are at first opposite the middles of the slab's faces."""
    n = [12, 0, 6] if dimension == 2 else [4, 3, 2]  # cells of the block
    size, corner = [1.21, 1.13, 0.7], [-0.57, -0.52, 0.0]
    cell = [length / max(count, 1) for length, count in zip(size, n)]
    made, axes = mesh.Mesh(dimension), [0, 1, 2] if dimension == 3 else [0, 2]

    def beneath(axis):
        """Coordinates of the slab: two more cells than the block on each side, half a cell out of step."""
        if axis == 2:
            return mesh.spaced(-0.8, 0, n[2])
        return [corner[axis] + (i - 2.5) * cell[axis] for i in range(n[axis] + 6)]

    def rounded(*x):
        return frame.start(*x[:-1], x[-1] + (1 - x[-1]) * sum(c * c for c in x[:-1]) / 6)

    made.add("slab", *[beneath(axis) for axis in axes], moved=frame.start)
    made.add("block", *[mesh.spaced(corner[axis], corner[axis] + size[axis], n[axis]) for axis in axes], moved=rounded)
    return made.write(path)


def deck(bench, dimension, name, frame, mu, drag, element):
    """Deck and settings of a run."""
    up = AXES[dimension - 1]
    load = [f"{drag}*max(t-1,0)", f"{drag / 2}*max(t-1,0)", "-0.12*min(t,1)"]
    load = load if dimension == 3 else load[::2]
    path = bodies(bench.path(f"{dimension}-{name}.msh"), dimension, frame)
    return f"{'space' if dimension == 3 else 'plane'}.yaml", {
        "mesh.file": path, "boundary.0.displacement": frame.displacement(["0"] * dimension),
        "boundary.1.displacement": frame.displacement(load), "boundary.1.region": f"block_{up}1",
        "contact.0.friction.coefficient": mu, "contact.0.discretization": element}


def nodal_difference(run, frame, reference, dimension):
    """Greatest difference of a node's force at the end, seen from the bodies, over the greatest force."""
    axes = ["f" + axis for axis in AXES[:dimension]]
    pairs = [(frame.back([a[axis] for axis in axes]), [b[axis] for axis in axes]) for a, b in zip(run.nodes(), reference.nodes())]
    return max(math.dist(a, b) for a, b in pairs) / max(math.hypot(*b) for _, b in pairs)


def history(run):
    """Amount of the total contact force by t."""
    contacts = [(increment["time"], increment["contacts"][0]) for increment in run.increments]
    return [(t, math.hypot(*(n + q for n, q in zip(c["normal_force"], c["tangential_force"])))) for t, c in contacts]


def history_difference(run, reference):
    """Greatest difference of the total force in any increment over its greatest."""
    pairs = list(zip(history(run), history(reference)))
    return max(abs(a - b) for (_, a), (_, b) in pairs) / max(b for _, (_, b) in pairs)


# Friction, how far the block is dragged, when the frame begins to move, how surfaces are coupled.
VARIANTS = [("no friction, within a face", 0.0, 0.03, 0, "node-to-face"), ("no friction, over faces", 0.0, 0.35, 0, "node-to-face"),
            ("friction, moving once pressed", 0.3, 0.03, 1, "node-to-face"), ("friction, over faces", 0.3, 0.35, 0, "node-to-face"),
            ("mortar, no friction, over faces", 0.0, 0.35, 0, "mortar"), ("mortar, friction, over faces", 0.3, 0.35, 0, "mortar")]


def verify(bench):
    rows = []
    for dimension, space in bench.choose([(2, "plane")], [(2, "plane"), (3, "space")]):
        for variant, mu, drag, begin, element in bench.choose(VARIANTS[:4:2], VARIANTS):
            frames = {"still": Frame(dimension, False, False, 0), "turned before": Frame(dimension, True, False, 1),
                      "turned before and moving": Frame(dimension, True, True, 3, begin),
                      "turned before and moving in jerks": Frame(dimension, True, True, 4, begin, jerks=0.3)}
            reference, *others = bench.run_all([deck(bench, dimension, f"{variant}-{name}", frame, mu, drag, element)
                                                for name, frame in frames.items()])
            for (name, frame), run in zip(list(frames.items())[1:], others):
                difference = max(nodal_difference(run, frame, reference, dimension), history_difference(run, reference))
                rows.append(Row(f"{space}, {variant}, {name}: worst difference of forces / greatest", 0, difference, TOLERANCE,
                                runs=[run]))
            if variant == "friction, moving once pressed":
                bench.plot(f"forces-{space}", Plot(f"Objectivity, {space}: contact force, pressed and then turned", "t", "force")
                           .add("still", history(reference)).add(name, history(run), "points"))
    return rows
