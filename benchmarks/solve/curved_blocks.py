#!/usr/bin/env python3
"""Mesh and deck of a curved block on a flat one, hexahedra that do not match.

The lower block is 2 x 2 x 1; the upper, 1.6 x 1.6 x 0.8, has the lower face z = (x^2 + y^2)/16. The upper block's top
goes down by 0.02.

    curved_blocks.py DIR --cells N [--friction MU] [--increments K] [--tied] [--linear SOLVER] [--slide S]

N is the number of cells of the lower block along its height; there are about 24 N^3 unknowns.
"""
import argparse
import pathlib


class Mesh:
    """Blocks of hexahedra with their faces, written in Gmsh's format 2.2."""

    def __init__(self):
        self.points = []
        self.elements = []  # (type, physical tag, nodes)
        self.groups = []  # (dimension, name)

    def group(self, dimension, name):
        self.groups.append((dimension, name))
        return len(self.groups)

    def add_block(self, name, n, place):
        """n cells along each axis; place(i, j, k) with 0 <= i, j, k <= 1 is a point."""
        first = len(self.points) + 1
        index = lambda i, j, k: first + i + (n[0] + 1) * (j + (n[1] + 1) * k)
        self.points += [place(i / n[0], j / n[1], k / n[2])
                        for k in range(n[2] + 1) for j in range(n[1] + 1) for i in range(n[0] + 1)]
        volume = self.group(3, name)
        square = ((0, 0), (1, 0), (1, 1), (0, 1))
        self.elements += [(5, volume, [index(i + a, j + b, k + c) for c in (0, 1) for a, b in square])
                          for k in range(n[2]) for j in range(n[1]) for i in range(n[0])]
        for side, k, corners in (("bottom", 0, square[::-1]), ("top", n[2], square)):
            surface = self.group(2, f"{name}_{side}")
            self.elements += [(3, surface, [index(i + a, j + b, k) for a, b in corners])
                              for j in range(n[1]) for i in range(n[0])]

    def write(self, path):
        with open(path, "w") as out:
            out.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n" % len(self.groups))
            for tag, (dimension, name) in enumerate(self.groups, 1):
                out.write(f'{dimension} {tag} "{name}"\n')
            out.write("$EndPhysicalNames\n$Nodes\n%d\n" % len(self.points))
            out.writelines("%d %.17g %.17g %.17g\n" % (tag, *p) for tag, p in enumerate(self.points, 1))
            out.write("$EndNodes\n$Elements\n%d\n" % len(self.elements))
            out.writelines("%d %d 2 %d %d %s\n" % (tag, kind, group, group, " ".join(map(str, nodes)))
                           for tag, (kind, group, nodes) in enumerate(self.elements, 1))
            out.write("$EndElements\n")


def curved_blocks(cells):
    mesh = Mesh()
    mesh.add_block("lower", (2 * cells, 2 * cells, cells), lambda a, b, c: (2 * a - 1, 2 * b - 1, c - 1))

    def upper(a, b, c):
        x, y = 1.6 * a - 0.8, 1.6 * b - 0.8
        bottom = (x * x + y * y) / 16
        return x, y, bottom + (0.8 - bottom) * c

    across = round(1.6 * 1.17 * cells)
    mesh.add_block("upper", (across, across, max(1, round(0.8 * 1.17 * cells))), upper)
    return mesh


def write_deck(path, friction=0, increments=1, end=1, slide=0, tied=False, linear="auto", discretization="node-to-face"):
    """A deck beside blocks.msh: down by 0.02 and along x by `slide` in t from 0 to 1, run to `end`. Returns its path."""
    contact = "tied: true" if tied else (f"friction: {{law: coulomb, coefficient: {friction}}}" if friction > 0
                                         else "friction: {law: none}")
    path.write_text(f"""title: A curved block pressed on a flat one
mesh: {{file: blocks.msh, kinematics: 3d}}
bodies:
  - {{name: lower, region: lower, material: {{law: linear-elastic, young: 1000, poisson: 0.3}}}}
  - {{name: upper, region: upper, material: {{law: linear-elastic, young: 1000, poisson: 0.3}}}}
contact:
  - {{name: interface, impactor: upper_bottom, target: lower_top, discretization: {discretization}, {contact}}}
boundary:
  - {{region: lower_bottom, fix: [x, y, z]}}
  - {{region: upper_top, displacement: {{x: "{slide}*t", y: 0, z: "-0.02*t"}}}}
loading: {{end: {end}, increments: {increments}, fixed: true}}
strain: small
solver: {{linear: {linear}}}
output: {{fields: [displacement]}}
""")
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--cells", type=int, required=True)
    parser.add_argument("--friction", type=float, default=0)
    parser.add_argument("--increments", type=int, default=1)
    parser.add_argument("--slide", type=float, default=0)
    parser.add_argument("--tied", action="store_true")
    parser.add_argument("--linear", default="auto")
    parser.add_argument("--discretization", default="node-to-face")
    options = vars(parser.parse_args())
    folder = options.pop("folder")
    folder.mkdir(parents=True, exist_ok=True)
    curved_blocks(options.pop("cells")).write(folder / "blocks.msh")
    write_deck(folder / "deck.yaml", **options)


if __name__ == "__main__":
    main()
