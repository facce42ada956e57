"""See validate-ranks.sh.   validate_ranks.py PROGRAM [EXAMPLE ...]"""
import sys
import tempfile

from examples import FINITE_STRAIN, SAME, SMALL_STRAIN, breaches, deck_of, worst
from results import run, table

PROCESSES = (2, 3, 4)
# FETI's residual does not come down further on the punch.
TOLERANCE = {"direct": "1e-11", "amg": "1e-11", "feti": "1e-10"}
HEAD = ["example", "linear", "processes", "Newton", "linear iterations", *SAME]


def solve(program, example, overrides, linear, processes):
    with tempfile.TemporaryDirectory(prefix="amontons-") as folder:
        finished = run(program, deck_of(example),
                       [*overrides, "loading.fixed=true", f"solver.linear={linear}", f"solver.tolerance={TOLERANCE[linear]}",
                        "output.every=0"], folder, processes)
        if not finished.converged:
            raise RuntimeError(f"{example}, {linear}, {processes} processes: {finished.record['failure']}")
        finished.tables = {c["name"]: finished.nodes(c["name"]) for c in finished.increments[-1]["contacts"]}
    finished.nodes = finished.tables.get
    return finished


def row(example, linear, processes, finished, found):
    totals = finished.record["totals"]
    return [example, linear, str(processes), str(totals["n_newton_iterations"]), str(totals["n_linear_iterations"]),
            *(f"{found[q]:.1e}" if q in found and limit else str(found.get(q, "")) for q, limit in SAME.items())]


def main():
    program, wanted = sys.argv[1], sys.argv[2:]
    rows, wrong = [], []
    for example, overrides in {**SMALL_STRAIN, **FINITE_STRAIN}.items():
        if wanted and example not in wanted:
            continue
        for linear in ("direct", "amg", *(["feti"] if example in SMALL_STRAIN else [])):
            alone = solve(program, example, overrides, linear, 1)
            rows.append(row(example, linear, 1, alone, {}))
            for processes in PROCESSES:
                try:
                    finished = solve(program, example, overrides, linear, processes)
                except RuntimeError as failure:
                    wrong.append(str(failure))
                    continue
                found = worst(alone, finished)
                rows.append(row(example, linear, processes, finished, found))
                print("  ".join(rows[-1]), file=sys.stderr, flush=True)
                if linear != "direct":  # a loose first iterate has statuses of its own
                    del found["newton_iterations"]
                wrong += [f"{example}, {linear}, {processes} processes: {text}" for text in breaches(found)]
    print(table(HEAD, rows))
    print("\n".join(wrong) or "the same on every number of processes")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
