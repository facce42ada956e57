#!/usr/bin/env python3
"""Writes the tables of docs/performance/solve.md from a benchmark's results; those of cases that did not run stay.   report.py FILE"""
import json
import pathlib
import sys

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "performance" / "solve.md"
BEGIN, END = "<!-- tables of report.py -->", "<!-- end of tables -->"


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
                     + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def solution_row(r):
    return [f"{r['n_dofs']:,}".replace(",", " "), str(r["friction"]), r["solver"], str(r["increments"]),
            f"{r['newton_iterations'] / max(r['increments'], 1):.1f}", str(r["linear_iterations"]), f"{r['contact_s']:.1f}",
            f"{r['s_per_1e5_dofs']:.1f}", f"{r['overhead']:.2f}" if r.get("overhead") else "-",
            f"{100 * r['contact_share']:.1f} %", f"{r['peak_rss_mb'] * 1000 / r['n_dofs']:.1f}",
            "" if r["converged"] else "not converged"]


SOLUTION = ["unknowns", "mu", "solver", "increments", "Newton per increment", "linear iterations", "s", "s per 1e5 unknowns",
            "overhead", "contact's share", "kB per unknown", ""]
MORTAR, CALCULIX = "Surface to surface against nodes to faces", "CalculiX on the same meshes"


def main():
    rows = json.loads(pathlib.Path(sys.argv[1]).read_text())
    titles = {"tied": "Both blocks tied: one linear system", "curved-blocks": "Curved block on block, 3D, small strain",
              "later-increments": "From the second increment on (seconds per increment)",
              "punch": "Rigid punch, axisymmetric, mu = 0.2", "sliding": "Sliding block, 3D, finite strain, mu = 0.3"}
    page = PAGE.read_text()
    before, rest = page.split(BEGIN)
    old, after = rest.split(END)
    parts = {part.splitlines()[0]: part.strip() + "\n" for part in old.split("## ")[1:]}
    for case, title in titles.items():
        if chosen := [r for r in rows if r["case"] == case]:
            parts[title] = f"{title}\n\n" + table(SOLUTION, map(solution_row, chosen))
    if chosen := [r for r in rows if r["case"] == "mortar"]:
        parts[MORTAR] = f"{MORTAR}\n\n" + table(
            ["unknowns", "strain", "mu", "element", *SOLUTION[2:7], "over nodes to faces", *SOLUTION[9:]],
            [[cells[0], r["strain"], cells[1], r["element"], *cells[2:7], f"{r['over_nodes']:.2f}" if r["over_nodes"] else "-", *cells[9:]]
             for r in chosen for cells in [solution_row(r)]])
    if chosen := [r for r in rows if r["case"].startswith("calculix")]:
        parts[CALCULIX] = f"{CALCULIX}\n\n" + table(
            ["unknowns", "", "mu", "s", "times ours", "force over ours", "MB"],
            [[f"{r['n_dofs']:,}".replace(",", " "), "tied" if r["case"].endswith("tied") else "contact", str(r["friction"]),
              f"{r['contact_s']:.1f}", f"{r['ratio_to_ours']:.1f}", f"{r['force_over_ours']:.4f}" if r["force_over_ours"] else "-",
              f"{r['peak_rss_mb']:.0f}"] for r in chosen])
    order = [*titles.values(), MORTAR, CALCULIX]
    tables = "\n".join("## " + parts[title] for title in sorted(parts, key=order.index))
    PAGE.write_text(before + BEGIN + "\n\n" + tables + "\n" + END + after)


if __name__ == "__main__":
    main()
