#!/usr/bin/env python3
"""Runs the detection benchmark, a process per configuration, and writes one list of all results.   run.py PROGRAM [--quick] --json FILE"""
import argparse
import json
import subprocess
import time

EXACT = ["exact", "brute", "embree", "cgal"]
ALL = EXACT + ["nearest-node", "nanoflann"]
WITHOUT_CGAL = ["exact", "brute", "embree", "nearest-node", "nanoflann"]  # CGAL would take as long as all others
# The nearest-node rule's cells are as wide as the longest edge asks for: on strongly graded surfaces a cell holds a
# share of all nodes. It is shown there at 1e5 nodes only.
WITHOUT_CELLS = EXACT + ["nanoflann"]
SURFACES_2D = ["circle", "shuffled", "graded-50", "graded-500", "flat", "flat-45", "thin"]
SURFACES_3D = ["torus", "shuffled", "graded-50", "graded-500", "aspect-20", "flat", "flat-45", "thin"]


def quick_plan():
    yield "wavy", "quadrilaterals", 1e4, ALL, 3
    yield "wavy", "quadrilaterals", 1e6, ["exact", "embree", "nearest-node", "nanoflann"], 1
    for shape in ("quadrilaterals", "triangles"):
        for surface in ("wavy", "torus", "shuffled", "graded-50", "graded-500", "aspect-20"):
            yield surface, shape, 5e4, ALL, 2
    for n_nodes in (1e3, 1e4):
        yield "wavy", "segments", n_nodes, ALL, 3
    for surface in ("wavy", "graded-500", "flat-45"):
        yield surface, "segments", 1e5, WITHOUT_CELLS if surface == "graded-500" else ALL, 3


def full_plan():
    for n_nodes in (300, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6, 4e6):
        yield "wavy", "segments", n_nodes, ALL if n_nodes < 4e6 else WITHOUT_CGAL, 5 if n_nodes < 1e5 else 3
    for surface in SURFACES_2D:
        yield surface, "segments", 1e6, WITHOUT_CELLS if "graded" in surface else ALL, 3
    for n_nodes in (1e3, 1e4, 1e5, 3e5, 1e6, 2e6, 4e6):
        yield "wavy", "quadrilaterals", n_nodes, ALL if n_nodes < 2e6 else WITHOUT_CGAL, 5 if n_nodes < 1e5 else 3
    for n_nodes in (1e4, 1e5, 1e6):
        yield "wavy", "triangles", n_nodes, ALL, 3
    for shape in ("quadrilaterals", "triangles"):
        for surface in ("graded-50", "graded-500"):
            yield surface, shape, 1e5, ALL, 1
        for surface in SURFACES_3D:
            yield surface, shape, 1e6, WITHOUT_CELLS if "graded" in surface else ALL, 3


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--quick", action="store_true", help="smaller surfaces, fewer repeats: under two minutes")
    parser.add_argument("--json", required=True, help="where to write the results")
    options = parser.parse_args()
    results, start = [], time.time()
    for surface, shape, n_nodes, methods, repeats in quick_plan() if options.quick else full_plan():
        output = subprocess.run(
            [options.program, "--surface", surface, "--shape", shape, "--nodes", str(n_nodes), "--methods",
             ",".join(methods), "--repeats", str(repeats)], check=True, stdout=subprocess.PIPE, text=True).stdout
        rows = json.loads(output)
        results += rows
        with open(options.json, "w", encoding="utf-8") as file:  # what there is so far
            json.dump(results, file, indent=1)
        figures = "  ".join(f"{row['method']} {row['total_ns']:.0f}" + (f" ({row['wrong']} wrong)" if row["wrong"] else "")
                            for row in rows)
        print(f"{time.time() - start:6.0f} s  {surface} {shape} {rows[0]['n_impactor']}: {figures}", flush=True)


if __name__ == "__main__":
    main()
