#!/usr/bin/env python3
"""Runs the benchmarks over many processes, writes one list of all results.   run.py PROGRAM [--quick] --json FILE

Beyond the cores processes share them: work, messages and bytes are counted there, not seconds."""
import argparse
import json
import math
import os
import pathlib
import subprocess
import tempfile
import time

import solution

PROCESSES = [1, 2, 4, 8, 16]


def same_everywhere(quick):
    """Small surfaces, all of them, held against one process in every way."""
    for n_processes in ([2, 16] if quick else [2, 3, 4, 8, 16]):
        for shape in ("segments", "triangles", "quadrilaterals"):
            yield n_processes, "all", shape, 2e3, "both", "random"
        for spread in ("apart", "some-bare"):
            for surface, shape in (("wavy", "segments"), ("thin", "triangles"), ("torus", "quadrilaterals")):
                yield n_processes, surface, shape, 2e3, "both", spread


def what_falls(quick):
    """What a process sends and holds as there are more of them."""
    n_nodes = 2e4 if quick else 1e5
    for n_processes in PROCESSES:
        for spread in ("in-runs", "random"):
            yield n_processes, "wavy", "quadrilaterals", n_nodes, "both", spread
        for surface in ("torus", "graded-500", "crowded"):
            yield n_processes, surface, "quadrilaterals", n_nodes, "distributed", "in-runs"
        # Five of the fine faces.
        yield n_processes, "crowded", "quadrilaterals", n_nodes, "distributed", "in-runs", 0.5 / math.sqrt(n_nodes)
        yield n_processes, "wavy", "quadrilaterals", n_nodes * n_processes / 16, "distributed", "in-runs"


def measure(program, n_processes, surface, shape, n_nodes, mode, spread, distance=None):
    command = ["mpirun", "--oversubscribe", "-n", str(n_processes), program, "--surface", surface, "--shape", shape,
               "--nodes", str(n_nodes), "--mode", mode, "--spread", spread]
    if distance:
        command += ["--distance", str(distance)]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True,
                                     env={**os.environ, **solution.ENVIRONMENT}).stdout)


def detections(program, part, quick):
    for configuration in part(quick):
        found = measure(program, *configuration)
        wrong = sum(detection["wrong"] for result in found for detection in result["detections"])
        yield f"{configuration}: {wrong} wrong", [{**result, "part": part.__name__} for result in found]


def solutions(program, part, quick):
    amontons = pathlib.Path(program).resolve().parents[1] / "app" / "amontons"
    with tempfile.TemporaryDirectory() as work:
        for row in part(amontons, pathlib.Path(work), quick):
            yield (f"{row['n_dofs']} unknowns, {row['solver']}, {row['processes']} processes: "
                   f"{row['newton_iterations']} Newton, {row['linear_iterations']} linear iterations"), [row]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--quick", action="store_true", help="fewer processes and smaller surfaces")
    parts = {part.__name__: (how, part)
             for how, members in ((detections, (what_falls, same_everywhere)),
                                  (solutions, (solution.one_decomposition, solution.growing, solution.speed_up)))
             for part in members}
    parser.add_argument("--only", choices=list(parts), help="one part of it")
    parser.add_argument("--json", required=True, help="where to write the results")
    options = parser.parse_args()
    results, start = [], time.time()
    for name, (how, part) in parts.items():
        if options.only not in (None, name):
            continue
        for text, found in how(options.program, part, options.quick):
            results += found
            with open(options.json, "w", encoding="utf-8") as file:  # what there is so far
                json.dump(results, file, indent=1)
            print(f"{time.time() - start:6.0f} s  {text}", flush=True)


if __name__ == "__main__":
    main()
