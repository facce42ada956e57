#!/usr/bin/env python3
"""Writes the plots and the tables of docs/performance/detection.md from the results of the detection benchmark.   report.py FILE

The page's text stays as it is; each table stands between two comments that name it."""
import json
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDER = ROOT / "docs/performance"
SHAPES = {"quadrilaterals": "quadrilaterals", "triangles": "triangles", "segments": "segments (2D)"}
LIBRARIES = ("nanoflann", "embree", "cgal")
METHODS = ("exact", "nearest-node") + LIBRARIES


class Results:
    def __init__(self, rows):
        self.rows = rows
        self.by_key = {(r["surface"], r["shape"], r["n_impactor"], r["method"]): r for r in rows}

    def configurations(self):
        seen = []
        for row in self.rows:
            key = (row["surface"], row["shape"], row["n_impactor"])
            if key not in seen:
                seen.append(key)
        return seen

    def get(self, configuration, method):
        return self.by_key.get((*configuration, method))

    def series(self, surface, shape, method):
        found = [r for r in self.rows if (r["surface"], r["shape"], r["method"]) == (surface, shape, method)]
        return sorted(found, key=lambda row: row["n_impactor"])


def count(n):
    exponent = int(math.floor(math.log10(n)))
    return f"{n / 10**exponent:.1f}e{exponent}"


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def nanoseconds(row, key="total_ns"):
    return f"{row[key]:.0f}" if row and key in row else ""


def again_over_nothing(row):
    """A re-detection over a detection from nothing at the same places."""
    return row["redetect_ns"] / row["moved_ns"]


def totals(results):
    """Total time of all methods on all surfaces, and the ratios to ours."""
    rows = []
    for configuration in results.configurations():
        surface, shape, n = configuration
        ours = results.get(configuration, "exact")
        cells = [surface, SHAPES[shape], count(n)]
        cells += [nanoseconds(ours), nanoseconds(ours, "setup_ns"), nanoseconds(ours, "redetect_ns")]
        cells += [nanoseconds(results.get(configuration, method)) for method in METHODS[1:]]
        for method in LIBRARIES:
            other = results.get(configuration, method)
            cells.append(f"{other['total_ns'] / ours['total_ns']:.1f}" if other else "")
        rows.append(cells)
    return markdown(["surface", "faces", "nodes", "exact", "topology, once", "exact, again", *METHODS[1:],
                     *(f"{method} / exact" for method in LIBRARIES)], rows)


def queries(results):
    """Build and query apart, where it matters most."""
    rows = []
    for configuration in results.configurations():
        if configuration[2] < 9e4:
            continue
        cells = [configuration[0], SHAPES[configuration[1]], count(configuration[2])]
        for method in ("exact", "nanoflann", "embree", "cgal"):
            row = results.get(configuration, method)
            cells.append(f"{row['build_ns']:.0f} + {row['query_ns']:.0f}" if row else "")
        ours, embree = results.get(configuration, "exact"), results.get(configuration, "embree")
        cells.append(f"{embree['query_ns'] / ours['query_ns']:.2f}" if embree else "")
        cells.append(f"{again_over_nothing(ours):.2f}")
        rows.append(cells)
    return markdown(["surface", "faces", "nodes", "exact", "nanoflann", "embree", "cgal", "query: embree / exact",
                     "again / from nothing"], rows)


def wrong(results):
    """Nodes for which what was found is farther than the closest point of the target."""
    rows = []
    for configuration in results.configurations():
        if configuration[2] < 9e3:
            continue
        cells = [configuration[0], SHAPES[configuration[1]], count(configuration[2])]
        for method in METHODS:
            row = results.get(configuration, method)
            if not row:
                cells.append("")
            elif not row["wrong"]:
                cells.append("0")
            else:
                share = 100 * row["wrong"] / configuration[2]
                cells.append(f"{row['wrong']} ({share:.2g} %; by up to {row['worst_excess']:.1g} w; {row['lost']} lost)")
        brute = results.get(configuration, "brute")
        cells.append(str(brute["sampled_nodes"]) if brute else "")
        rows.append(cells)
    return markdown(["surface", "faces", "nodes", *METHODS, "nodes held against brute force"], rows)


def memory(results):
    rows = []
    for configuration in results.configurations():
        if configuration[2] >= 9e5:
            rows.append([configuration[0], SHAPES[configuration[1]], count(configuration[2])] + [
                nanoseconds(results.get(configuration, method), "bytes_per_node") for method in METHODS])
    return markdown(["surface", "faces", "nodes", *METHODS], rows)


def steps(results):
    """The paper's four steps against the number of nodes, with the occupied cells."""
    names = ["bounds", "fill", "nearest", "projection"]
    tables = []
    for shape in ("segments", "quadrilaterals"):
        rows = []
        for row in results.series("wavy", shape, "nearest-node"):
            rows.append([count(row["n_impactor"]), str(row["occupied_cells"]),
                         f"{row['n_target'] / row['occupied_cells']:.2f}"] +
                        [f"{row['steps_ns'].get(name, 0):.0f}" for name in names])
        tables.append(f"In {'the plane' if shape == 'segments' else 'space'} ({shape}, wavy):\n\n" + markdown(
            ["nodes", "occupied cells", "target nodes in each", "1 bounds", "2 fill", "3 nearest node",
             "4 projection and the pairing"], rows))
    return "\n\n".join(tables)


def slope(points):
    """Of the straight line through the points in logarithms (least squares), as text; "-" for a single point."""
    if len(points) < 2:
        return "-"
    x, y = [math.log(p[0]) for p in points], [math.log(p[1]) for p in points]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return f"{sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x)**2 for a in x):.2f}"


def seconds(row):
    return row["total_ns"] * row["n_impactor"] * 1e-9


def gain(results):
    """The paper's figure 3a in figures."""
    rows = []
    points = {name: [] for name in ("brute", "exact", "nearest-node")}
    for brute in results.series("wavy", "segments", "brute"):
        n, cells = brute["n_impactor"], [count(brute["n_impactor"])]
        for name in points:
            row = results.get(("wavy", "segments", n), name)
            points[name].append((n, seconds(row)))
            cells.append(f"{seconds(row):.3g}")
        rows.append(cells + [f"{brute['total_ns'] / results.get(('wavy', 'segments', n), name)['total_ns']:.3g}"
                             for name in ("exact", "nearest-node")])
    slopes = ["slope"] + [slope(values) for values in points.values()] + ["", ""]
    return markdown(["nodes on each side", "brute force, s", "exact, s", "nearest-node, s", "gain of exact",
                     "gain of nearest-node"], rows + [slopes])


def run(results):
    """What the figures come from."""
    processor = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"))
    configurations = results.configurations()
    most = max(n for _, _, n in configurations)
    rounds = min(row["repeats"] for row in results.rows if "repeats" in row)
    return (f"{len(configurations)} configurations with up to {count(most)} nodes on each side, the median of at least {rounds} "
            f"round{'s' if rounds > 1 else ''} each; processor: {processor[1] if processor else 'unknown'}.")


def claims(results):
    """What was to be shown, with what was measured."""
    rows = []

    def claim(text, wanted, value, holds):
        rows.append([text, wanted, value, "yes" if holds else "no"])

    def at_least(text, wanted, ratio):
        claim(text, f"at least {wanted}", f"{ratio:.2f}", ratio >= wanted)

    for configuration in results.configurations():
        surface, shape, n = configuration
        ours = results.get(configuration, "exact")
        others = {name: results.get(configuration, name) for name in LIBRARIES if results.get(configuration, name)}
        where = f"{surface}, {shape}, {count(n)}"
        if len(others) < 2 or n < 9e5 or n > 1.5e6:
            continue
        best = min(row["total_ns"] for row in others.values())
        if shape == "segments":
            at_least(f"{where}: best library / exact", 4, best / ours["total_ns"])
        elif surface in ("graded-50", "graded-500", "aspect-20"):
            at_least(f"{where}: best library / exact", 2, best / ours["total_ns"])
        elif surface in ("wavy", "torus", "shuffled"):
            factors = (4, 4, 2) if shape == "quadrilaterals" else (2.5, 4, 1.3)
            at_least(f"{where}: nanoflann / exact", factors[0], others["nanoflann"]["total_ns"] / ours["total_ns"])
            at_least(f"{where}: Embree / exact", factors[1], others["embree"]["total_ns"] / ours["total_ns"])
            at_least(f"{where}: query, Embree / exact", factors[2], others["embree"]["query_ns"] / ours["query_ns"])
        claim(f"{where}: again / from nothing", "at most 0.5", f"{again_over_nothing(ours):.2f}",
              again_over_nothing(ours) <= 0.5)
    claims_of_size(results, claim)
    return markdown(["", "wanted", "measured", "holds"], rows)


def claims_of_size(results, claim):
    sizes = {count(row["n_impactor"]): row for row in results.series("wavy", "quadrilaterals", "exact")}
    if "4.0e6" in sizes and "1.0e5" in sizes:
        ratio = sizes["4.0e6"]["total_ns"] / sizes["1.0e5"]["total_ns"]
        claim("wavy, quadrilaterals: time per node, 4e6 / 1e5", "at most 1.3", f"{ratio:.2f}", ratio <= 1.3)
    if "2.0e6" in sizes:
        time = seconds(sizes["2.0e6"])
        claim("wavy, quadrilaterals: 2e6 on 2e6, one core", "less than 1 s", f"{time:.2f} s", time < 1)
    large = [row for row in results.rows if row["method"] == "exact" and row["n_impactor"] > 9e5]
    if large:
        most = max(row["bytes_per_node"] for row in large)
        claim("memory per surface node, the most of all", "less than 200 bytes", f"{most:.0f}", most < 200)
    n_wrong = sum(row["wrong"] for row in results.rows if row["method"] == "exact")
    claim("exact: wrong answers in all", "0", str(n_wrong), n_wrong == 0)
    n_wrong = sum(row["wrong_again"] for row in results.rows if row["method"] == "exact")
    claim("exact, after three motions: distances that differ from those from nothing", "0", str(n_wrong), n_wrong == 0)


COLOURS = {"exact": "#b3261e", "nearest-node": "#e08a1e", "nanoflann": "#2a7f62", "embree": "#2b5fa8", "cgal": "#7a4fa0",
           "brute": "#555555", "bounds": "#7a4fa0", "fill": "#2b5fa8", "nearest": "#2a7f62", "projection": "#e08a1e"}
WIDTH, HEIGHT, LEFT, BOTTOM, RIGHT, TOP = 640, 400, 64, 44, 116, 28


def ticks(low, high):
    return [10.0**e for e in range(math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9) + 1)]


def plot(name, title, x_label, y_label, lines):
    """A plot with logarithmic axes as SVG. `lines`: name -> [(x, y), ...]."""
    points = [point for line in lines.values() for point in line]
    x_low, x_high = min(p[0] for p in points), max(p[0] for p in points)
    y_low, y_high = 0.8 * min(p[1] for p in points), 1.25 * max(p[1] for p in points)

    def place(x, y):
        return (LEFT + (WIDTH - LEFT - RIGHT) * math.log(x / x_low) / max(math.log(x_high / x_low), 1e-9),
                HEIGHT - BOTTOM - (HEIGHT - BOTTOM - TOP) * math.log(y / y_low) / math.log(y_high / y_low))

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
           f'<text x="{LEFT}" y="18" font-size="14">{title}</text>']
    for x in ticks(x_low, x_high):
        px, _ = place(x, y_low)
        out.append(f'<path d="M{px:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#dddddd"/>'
                   f'<text x="{px:.1f}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle">1e{round(math.log10(x))}</text>')
    levels = ticks(y_low, y_high)
    if len(levels) < 3:
        levels = [m * 10.0**e for e in range(-6, 12) for m in (1, 2, 5) if y_low <= m * 10.0**e <= y_high]
    for y in levels:
        _, py = place(x_low, y)
        out.append(f'<path d="M{LEFT} {py:.1f}H{WIDTH - RIGHT}" stroke="#dddddd"/>'
                   f'<text x="{LEFT - 6}" y="{py + 4:.1f}" text-anchor="end">{y:g}</text>')
    labels = []
    for line, values in lines.items():
        colour = COLOURS.get(line.split(",")[0], "#333333")
        path = " ".join("{:.1f},{:.1f}".format(*place(*p)) for p in values)
        out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out += ['<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"/>'.format(*place(*p), colour) for p in values]
        labels.append([place(*values[-1])[1] + 4, line, colour])
    labels.sort()
    for i in range(1, len(labels)):  # none upon another
        labels[i][0] = max(labels[i][0], labels[i - 1][0] + 14)
    for y, line, colour in labels:
        out.append(f'<text x="{WIDTH - RIGHT + 8}" y="{y:.1f}" fill="{colour}">{line}</text>')
    out += [f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 8}" text-anchor="middle">{x_label}</text>',
            f'<text transform="translate(14 {(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)" text-anchor="middle">{y_label}</text>',
            "</svg>"]
    (FOLDER / f"{name}.svg").write_text("\n".join(out) + "\n", encoding="utf-8")


def draw(results):
    brute = results.series("wavy", "segments", "brute")
    lines = {}
    for method in ("exact", "nearest-node"):
        pairs = [(row, results.get(("wavy", "segments", row["n_impactor"]), method)) for row in brute]
        lines[method] = [(b["n_impactor"], b["total_ns"] / row["total_ns"]) for b, row in pairs if row]
    plot("detection-gain-2d", "Gain over brute force in the plane (the paper's figure 3a)", "nodes on each side",
         "time of brute force / time", lines)
    for shape, label in (("segments", "2d"), ("quadrilaterals", "3d")):
        lines = {m: [(r["n_impactor"], r["total_ns"]) for r in results.series("wavy", shape, m)] for m in METHODS}
        plot(f"detection-size-{label}", f"One detection from nothing, wavy, {shape}", "nodes on each side",
             "ns per impactor node", {m: line for m, line in lines.items() if line})
        rows = results.series("wavy", shape, "nearest-node")
        lines = {step: [(r["n_impactor"], r["steps_ns"].get(step, 0) * r["n_impactor"] * 1e-9) for r in rows]
                 for step in ("bounds", "fill", "nearest", "projection")}
        plot(f"detection-steps-{label}", f"The paper's four steps, wavy, {shape}", "nodes on each side", "seconds", lines)


def main():
    results = Results(json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")))
    page = FOLDER / "detection.md"
    text = page.read_text(encoding="utf-8")
    for name, table in {"run": run, "claims": claims, "totals": totals, "queries": queries, "wrong answers": wrong,
                        "memory": memory, "steps": steps, "gain": gain}.items():
        begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
        if begin not in text or end not in text:
            sys.exit(f"{page}: no {begin} ... {end}")
        text = re.sub(re.escape(begin) + ".*?" + re.escape(end), lambda _: f"{begin}\n\n{table(results)}\n\n{end}", text,
                      flags=re.DOTALL)
    page.write_text(text, encoding="utf-8")
    draw(results)


if __name__ == "__main__":
    main()
