#!/usr/bin/env python3
"""Writes the tables of docs/performance/solve.md from a benchmark's results.   report.py FILE"""
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


def main():
    rows = json.loads(pathlib.Path(sys.argv[1]).read_text())
    titles = {"tied": "Both blocks tied: one linear system", "curved-blocks": "Curved block on block, 3D, small strain",
              "later-increments": "From the second increment on (seconds per increment)",
              "punch": "Rigid punch, axisymmetric, mu = 0.2", "sliding": "Sliding block, 3D, finite strain, mu = 0.3"}
    parts = []
    for case, title in titles.items():
        if chosen := [r for r in rows if r["case"] == case]:
            parts.append(f"## {title}\n\n" + table(SOLUTION, map(solution_row, chosen)))
    if chosen := [r for r in rows if r["case"].startswith("calculix")]:
        parts.append("## CalculiX on the same meshes\n\n" + table(
            ["unknowns", "", "mu", "s", "times ours", "force over ours", "MB"],
            [[f"{r['n_dofs']:,}".replace(",", " "), "tied" if r["case"].endswith("tied") else "contact", str(r["friction"]),
              f"{r['contact_s']:.1f}", f"{r['ratio_to_ours']:.1f}", f"{r['force_over_ours']:.4f}" if r["force_over_ours"] else "-",
              f"{r['peak_rss_mb']:.0f}"] for r in chosen]))
    page = PAGE.read_text()
    before, after = page.split(BEGIN)[0], page.split(END)[1]
    PAGE.write_text(before + BEGIN + "\n\n" + "\n".join(parts) + "\n" + END + after)


if __name__ == "__main__":
    main()
