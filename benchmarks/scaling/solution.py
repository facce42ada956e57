"""Whole solutions over many processes: the curved block on a flat one of benchmarks/solve, friction 0.3, by FETI.

Beyond the cores iterations, work, messages and bytes are counted, not seconds."""
import json
import os
import pathlib
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "solve"))
import curved_blocks

ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1",
               "OMPI_MCA_mpi_yield_when_idle": "1"}
NOT_SOLUTION = ("mesh", "output")


def problem(work, cells, **options):
    """A deck with its mesh; the same cells give the same mesh."""
    folder = work / f"blocks-{cells}"
    if not folder.exists():
        folder.mkdir()
        curved_blocks.curved_blocks(cells).write(folder / "blocks.msh")
    name = "-".join(str(value) for value in options.values()) or "deck"
    return curved_blocks.write_deck(folder / f"{name}.yaml", **options)


def start(program, deck, n_processes, results, settings=()):
    command = ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(n_processes)] if n_processes > 1 else []
    command += [str(program), "run", str(deck), "--output", str(results)]
    for setting in settings:
        command += ["--set", setting]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                            env={**os.environ, **ENVIRONMENT})


def finish(process, results):
    """The run record."""
    _, errors = process.communicate()
    record = json.loads((results / "record.json").read_text())
    if record["status"] != "converged":
        raise SystemExit(f"not converged: {results}\n{errors}")
    return record


def row(part, record, n_processes, **known):
    totals = record["totals"]
    contact = record["increments"][-1]["contacts"][0]
    return {"part": part, "processes": n_processes, "n_dofs": record["n_dofs"], **known,
            "newton_iterations": totals["n_newton_iterations"], "linear_iterations": totals["n_linear_iterations"],
            "normal_force": contact["normal_force"], "tangential_force": contact["tangential_force"],
            "timings": totals["timings"], "wall_s": totals["wall_s"], "peak_rss_mb": totals["peak_rss_mb"],
            "of_processes": totals.get("processes", {})}


def one_decomposition(program, work, quick):
    """The same subdomains, dealt out to more and more processes; the direct solver's force beside it."""
    cells = 6 if quick else 13
    for solver, processes in (("direct", [1]), ("feti", [1, 2, 4] if quick else [1, 2, 4, 8, 16]), ("amg", [1, 2, 4])):
        deck = problem(work, cells, friction=0.3, linear=solver)
        for n in processes:
            results = work / f"one-{solver}-{n}"
            settings = ["solver.tolerance=1e-10"]
            yield row("one_decomposition", finish(start(program, deck, n, results, settings), results), n, solver=solver)


def growing(program, work, quick):
    """As many cells on each process. Tied, a run is one linear system solved to the run's tolerance; with friction each
    of several systems is solved as tightly as Newton's iteration deserves, and counts cannot be compared."""
    for n in ([1, 2, 4] if quick else [1, 2, 4, 8, 16]):
        cells = round((5 if quick else 8) * n ** (1 / 3))
        for tied in (True, False):
            results = work / f"growing-{n}-{tied}"
            deck = problem(work, cells, friction=0 if tied else 0.3, tied=tied, linear="feti")
            yield row("growing", finish(start(program, deck, n, results), results), n, solver="feti", cells=cells,
                      tied=tied)


def speed_up(program, work, quick):
    """Seconds of one process, of two, and of two runs of one process side by side: what the machine can give."""
    cells = 10 if quick else 21
    deck = problem(work, cells, friction=0.3, linear="feti")
    for repeat in range(1 if quick else 3):
        for n_runs, n_processes in ((1, 1), (1, 2), (2, 1)):
            folders = [work / f"speed-{repeat}-{n_runs}-{n_processes}-{k}" for k in range(n_runs)]
            began = time.time()
            running = [start(program, deck, n_processes, folder) for folder in folders]
            records = [finish(process, folder) for process, folder in zip(running, folders)]
            yield row("speed_up", records[0], n_processes, solver="feti", n_runs=n_runs, repeat=repeat,
                      seconds=time.time() - began,
                      solution_s=max(sum(t for phase, t in record["totals"]["timings"].items()
                                         if phase not in NOT_SOLUTION) for record in records))
