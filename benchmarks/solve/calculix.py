"""The curved blocks in CalculiX's language, and its run (Debian's calculix-ccx)."""
import os
import re
import shutil
import subprocess
import time

FACE_OF_SIDE = {"bottom": "S1", "top": "S2"}
"""C3D8's first face is that of nodes 1 to 4, its second that of nodes 5 to 8."""


def available():
    return shutil.which("ccx") is not None


def lines_of(numbers, per_line=10):
    numbers = list(numbers)
    return "".join(", ".join(map(str, numbers[i:i + per_line])) + ",\n" for i in range(0, len(numbers), per_line))


def deck(mesh, friction, tied):
    cells = {name: [] for dimension, name in mesh.groups if dimension == 3}
    sides = {name: set() for dimension, name in mesh.groups if dimension == 2}
    facets = {name: set() for name in sides}
    elements = []
    for kind, group, nodes in mesh.elements:
        name = mesh.groups[group - 1][1]
        if kind == 5:
            elements.append(nodes)
            cells[name].append(len(elements))
        else:
            sides[name].update(nodes)
            facets[name].add(frozenset(nodes))
    out = ["*NODE, NSET=ALL\n"]
    out += [f"{i}, {p[0]:.16g}, {p[1]:.16g}, {p[2]:.16g}\n" for i, p in enumerate(mesh.points, 1)]
    for name, numbers in cells.items():
        out.append(f"*ELEMENT, TYPE=C3D8, ELSET={name}\n")
        out += [f"{e}, " + ", ".join(map(str, elements[e - 1])) + "\n" for e in numbers]
    for name, nodes in sides.items():
        out.append(f"*NSET, NSET={name}\n{lines_of(sorted(nodes))}")
    for name in ("upper_bottom", "lower_top"):
        body, side = name.split("_")
        corners = slice(0, 4) if side == "bottom" else slice(4, 8)
        touching = [e for e in cells[body] if frozenset(elements[e - 1][corners]) in facets[name]]
        out.append(f"*SURFACE, NAME=S_{name}, TYPE=ELEMENT\n")
        out += [f"{e}, {FACE_OF_SIDE[side]}\n" for e in touching]
    out.append("*MATERIAL, NAME=SOLID\n*ELASTIC\n1000, 0.3\n")
    out += [f"*SOLID SECTION, ELSET={name}, MATERIAL=SOLID\n" for name in cells]
    if tied:
        out.append("*TIE, NAME=INTERFACE, POSITION TOLERANCE=1\nS_upper_bottom, S_lower_top\n")
    else:
        # The manual's advice for the slope of linear pressure-overclosure: 5 to 50 times Young's modulus.
        out.append("*SURFACE INTERACTION, NAME=TOUCH\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n50000\n")
        if friction > 0:
            out.append(f"*FRICTION\n{friction}, 5000\n")
        out.append("*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE\nS_upper_bottom, S_lower_top\n")
    out.append("*STEP\n*STATIC, SOLVER=SPOOLES\n1, 1\n*BOUNDARY\nlower_bottom, 1, 3\nupper_top, 1, 2\n"
               "upper_top, 3, 3, -0.02\n*NODE PRINT, NSET=lower_bottom, TOTALS=ONLY\nRF\n*END STEP\n")
    return "".join(out)


def solve(mesh, folder, friction, tied):
    folder.mkdir(exist_ok=True)
    (folder / "blocks.inp").write_text(deck(mesh, friction, tied))
    began = time.time()
    with open(folder / "ccx.log", "w") as log:
        child = subprocess.Popen(["ccx", "blocks"], cwd=folder, stdout=log, stderr=log,
                                 env=os.environ | {"OMP_NUM_THREADS": "1"})
        _, _, usage = os.wait4(child.pid, 0)
    seconds = time.time() - began
    log = (folder / "ccx.log").read_text()
    totals = re.findall(r"total force.*?\n\s*\n\s*(\S+)\s+(\S+)\s+(\S+)", (folder / "blocks.dat").read_text())
    return {"converged": bool(totals) and "Job finished" in log, "contact_s": seconds,
            "iterations": len(re.findall(r"^ iteration", log, re.M)),
            "normal_force": abs(float(totals[-1][2])) if totals else 0,
            "peak_rss_mb": usage.ru_maxrss / 1024}
