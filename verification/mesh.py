"""Structured meshes of blocks, mapped to any shape, written as Gmsh's .msh 2.2 with names for bodies and sides."""


def spaced(begin, end, n):
    """n equal cells from begin to end."""
    return [begin + (end - begin) * i / n for i in range(n + 1)]


def graded(h, length, growth):
    """Coordinates from 0 to length whose cells grow from about h by `growth`."""
    steps, total = [], 0.0
    while total < length:
        steps.append(h * growth ** len(steps))
        total += steps[-1]
    places = [0.0]
    for step in steps:
        places.append(places[-1] + step * length / total)
    return places[:-1] + [length]


class Mesh:
    """Blocks of cells. In the plane cells are quadrilaterals, in space hexahedra.

    A block's sides are named <name>_x0, _x1, _y0, _y1[, _z0, _z1] and the block <name>. Blocks of one name are one body: their nodes
    at the very same place are one node.
    """

    def __init__(self, dimension):
        self.dimension = dimension
        self.nodes = []
        self.numbers = {}  # of a node by its block's name and place
        self.elements = []  # (type of Gmsh, group, nodes)
        self.groups = {}  # name: (dimension, number)

    def add(self, name, *axes, moved=None, triangles=False, sides=None):
        """A block with these coordinates along x, y[, z]; moved: its nodes' places from those; sides: only these of its sides are
        named, by what follows <name>_, as in {"x1": "outside"}.
        """
        counts = [len(axis) for axis in axes]
        stride = [1, counts[0], counts[0] * counts[1]]
        places = [(x, y) for y in axes[1] for x in axes[0]]
        if self.dimension == 3:
            places = [(x, y, z) for z in axes[2] for x, y in places]
        numbers = [self._node(name, moved(*place) if moved else place) for place in places]

        def corners(low, spans):
            """Node numbers of the cell or side at index `low` that spans one cell along the axes of `spans`."""
            base = sum(i * s for i, s in zip(low, stride))
            ring = [0] if not spans else [0, stride[spans[0]]]
            if len(spans) > 1:
                ring += [i + stride[spans[1]] for i in reversed(ring)]
            if len(spans) > 2:
                ring += [i + stride[spans[2]] for i in ring]
            return [numbers[base + i] for i in ring]

        all_axes = list(range(self.dimension))
        for low in self._cells(counts, all_axes):
            nodes = corners(low, all_axes)
            for part in ([nodes[:3], [nodes[0], nodes[2], nodes[3]]] if triangles else [nodes]):
                self._element(name, self.dimension, part)
        for axis in all_axes:
            spans = [other for other in all_axes if other != axis]
            for end in (0, 1):
                side = f"{'xyz'[axis]}{end}"
                if sides is None or side in sides:
                    for low in self._cells(counts, spans):
                        low[axis] = end * (counts[axis] - 1)
                        self._element(f"{name}_{sides[side] if sides else side}", self.dimension - 1, corners(low, spans))
        return self

    def point(self, name, block, place):
        """Names the node at this very place in a block, as a group of one point."""
        self._element(name, 0, [self.numbers[block, place]])
        return self

    def _node(self, name, place):
        """Number of the node of the blocks of this name at this place, which is new where there is none."""
        number = self.numbers.setdefault((name, place), len(self.nodes))
        if number == len(self.nodes):
            self.nodes.append(place)
        return number

    @staticmethod
    def _cells(counts, spans):
        """Indices of the lowest corners of cells along the axes of `spans`, zero along others."""
        lows = [[0] * len(counts)]
        for axis in spans:
            lows = [low[:axis] + [i] + low[axis + 1:] for low in lows for i in range(counts[axis] - 1)]
        return lows

    def _element(self, group, dimension, nodes):
        number = self.groups.setdefault(group, (dimension, len(self.groups) + 1))[1]
        kind = {1: 15, 2: 1, 3: 2, 4: 3, 8: 5}[len(nodes)]
        self.elements.append((kind, number, nodes))

    def write(self, path):
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(self.groups))]
        lines += [f'{dimension} {number} "{name}"' for name, (dimension, number) in self.groups.items()]
        lines += ["$EndPhysicalNames", "$Nodes", str(len(self.nodes))]
        lines += [f"{i} " + " ".join(f"{c:.17g}" for c in (*place, 0.0)[:3]) for i, place in enumerate(self.nodes, 1)]
        lines += ["$EndNodes", "$Elements", str(len(self.elements))]
        lines += [f"{i} {kind} 2 {group} {group} " + " ".join(str(node + 1) for node in nodes)
                  for i, (kind, group, nodes) in enumerate(self.elements, 1)]
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(lines + ["$EndElements", ""]))
        return path
