#!/usr/bin/env python3
"""Runs the benchmark of detection over many processes, writes one list of all results.   run.py PROGRAM [--quick] --json FILE

Beyond the cores processes share them: work, messages and bytes are counted there, not seconds."""
import argparse
import json
import math
import os
import subprocess
import time

PROCESSES = [1, 2, 4, 8, 16]
ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1",
               "OMPI_MCA_mpi_yield_when_idle": "1"}


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
                                     env={**os.environ, **ENVIRONMENT}).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--quick", action="store_true", help="fewer processes and smaller surfaces")
    parser.add_argument("--only", choices=["what_falls", "same_everywhere"], help="one part of it")
    parser.add_argument("--json", required=True, help="where to write the results")
    options = parser.parse_args()
    results, start = [], time.time()
    for part in (what_falls, same_everywhere):
        if options.only not in (None, part.__name__):
            continue
        for configuration in part(options.quick):
            found = measure(options.program, *configuration)
            results += [{**result, "part": part.__name__} for result in found]
            with open(options.json, "w", encoding="utf-8") as file:  # what there is so far
                json.dump(results, file, indent=1)
            wrong = sum(detection["wrong"] for result in found for detection in result["detections"])
            print(f"{time.time() - start:6.0f} s  {configuration}: {wrong} wrong", flush=True)


if __name__ == "__main__":
    main()
