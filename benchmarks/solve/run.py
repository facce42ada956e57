#!/usr/bin/env python3
"""What contact costs over a linear solve of the same mesh with the bodies tied.

    run.py AMONTONS [--quick] [--calculix] [--only CASE] --json FILE

Cases: curved-blocks (3D, small strain, mu = 0 and 0.3; one increment and several), punch (2D), sliding (3D, finite strain), mortar
(surface to surface against nodes to faces: the blocks and the sliding).
The tied solve is by the fastest of our own solvers at that size, in the same run; plain multigrid CG is one of them.
Times are of the solution alone: set-up, detection, assembly, linear set-up and solve; reading the mesh and output apart.
CalculiX solves the same meshes where it is installed: *TIE for the tied solve, its node-to-surface hard contact else.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import calculix
import curved_blocks

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"
NOT_SOLUTION = ("mesh", "output")
SLIDING = ["loading.end=1.2", "loading.increments=12"]
CONTACT = ("detection", "contact_assembly")


def run(amontons, deck, folder, settings=()):
    """The run record, and what failed."""
    command = [amontons, "run", str(deck), "--output", str(folder)]
    for setting in settings:
        command += ["--set", setting]
    result = subprocess.run(command, capture_output=True, text=True)
    try:
        record = json.loads((folder / "record.json").read_text())
    except FileNotFoundError:
        raise SystemExit(f"{' '.join(command)}\n{result.stderr}")
    if record["status"] != "converged":
        record["failure"] = result.stderr.strip().splitlines()[-1:] or ["not converged"]
    return record


def solution_time(record):
    return sum(t for phase, t in record["totals"]["timings"].items() if phase not in NOT_SOLUTION)


def normal_force(record):
    contacts = record["increments"][-1]["contacts"] if record["increments"] else []
    contacts = contacts if isinstance(contacts, list) else list(contacts.values())
    return max((abs(f) for c in contacts for f in c["normal_force"]), default=0)


def row(case, record, **known):
    totals = record["totals"]
    seconds = solution_time(record)
    return {
        "case": case, "n_dofs": record["n_dofs"], "processes": 1, **known,
        "converged": record["status"] == "converged", "increments": len(record["increments"]),
        "newton_iterations": totals["n_newton_iterations"], "linear_iterations": totals["n_linear_iterations"],
        "contact_s": seconds, "s_per_1e5_dofs": seconds / record["n_dofs"] * 1e5,
        "contact_share": sum(totals["timings"].get(phase, 0) for phase in CONTACT) / seconds,
        "timings": totals["timings"], "peak_rss_mb": totals["peak_rss_mb"], "wall_s": totals["wall_s"],
        "counters": {key: value for key, value in totals.items() if key.startswith("n_")},
        "normal_force": normal_force(record),
    }


class Bench:
    def __init__(self, amontons, work):
        self.amontons, self.work, self.rows = amontons, work, []

    def say(self, entry):
        self.rows.append(entry)
        overhead = f"{entry['overhead']:.2f}" if entry.get("overhead") else "-"
        print(f"{entry.get('element', entry['case']):<22}{entry['n_dofs']:>9} mu {entry['friction']:<4} {entry['solver']:<16}"
              f" newton {entry['newton_iterations']:>4} linear {entry['linear_iterations']:>5}"
              f" {entry['contact_s']:8.2f} s  overhead {overhead:>6}  contact {100 * entry['contact_share']:4.1f} %"
              f"  {entry['peak_rss_mb']:7.0f} MB{'' if entry['converged'] else '  NOT CONVERGED'}", flush=True)

    def blocks(self, cells, solvers, tied_solvers, repeats=1, with_calculix=False):
        folder = self.work / f"blocks-{cells}"
        make = lambda name, **options: curved_blocks.write_deck(folder / f"{name}.yaml", **options)
        folder.mkdir(exist_ok=True)
        mesh = curved_blocks.curved_blocks(cells)
        mesh.write(folder / "blocks.msh")
        known = {"dimension": 3, "strain": "small"}
        tied = {}
        for solver in tied_solvers:
            deck = make(f"tied-{solver}", tied=True, linear=solver)
            records = [run(self.amontons, deck, folder / f"tied-{solver}") for _ in range(repeats)]
            tied[solver] = statistics.median(map(solution_time, records))
            self.say(row("tied", records[0], friction=0, solver=solver, tied_s=tied[solver], **known)
                     | {"contact_s": tied[solver]})
        best = min(tied.values())
        for friction, increments in ((0, 1), (0.3, 1), (0.3, 4)):
            for solver in solvers:
                name = f"mu{friction}-{increments}-{solver}"
                deck = make(name, friction=friction, increments=increments, linear=solver,
                            slide=0.01 if increments > 1 else 0)
                records = [run(self.amontons, deck, folder / name) for _ in range(repeats)]
                seconds = statistics.median(map(solution_time, records))
                entry = row("curved-blocks", records[0], friction=friction, solver=solver, **known)
                entry |= {"contact_s": seconds, "tied_s": best, "overhead": seconds / best / increments}
                if "amg" in tied:
                    entry["tied_over_gamg"] = best / tied["amg"]
                self.say(entry)
        if with_calculix:
            self.calculix(folder, mesh, known)

    def later_increments(self, cells, solver):
        """From the second increment on: the difference of runs of four and of one increment of the same step."""
        folder = self.work / f"blocks-{cells}"
        for friction in (0, 0.3):
            times = []
            for increments in (1, 4):
                deck = curved_blocks.write_deck(folder / f"later-{friction}-{increments}.yaml", friction=friction,
                                                increments=increments, linear=solver, end=increments / 4,
                                                slide=0.01)
                record = run(self.amontons, deck, folder / f"later-{friction}-{increments}")
                times.append(solution_time(record))
            entry = row("later-increments", record, friction=friction, solver=solver, dimension=3, strain="small")
            later = (times[1] - times[0]) / 3
            tied = min(r["contact_s"] for r in self.rows if r["case"] == "tied" and r["n_dofs"] <= entry["n_dofs"] * 1.1
                       and r["n_dofs"] >= entry["n_dofs"] / 1.1)
            self.say(entry | {"contact_s": later, "tied_s": tied, "overhead": later / tied})

    def mortar(self, cells, solvers, repeats=3):
        """Both contact elements in turn on the same mesh."""
        folder = self.work / f"mortar-{cells}"
        folder.mkdir(exist_ok=True)
        curved_blocks.curved_blocks(cells).write(folder / "blocks.msh")
        for friction in (0, 0.3):
            for solver in solvers:
                records = {"node-to-face": [], "mortar": []}
                for _ in range(repeats):
                    for element, found in records.items():
                        deck = curved_blocks.write_deck(folder / "deck.yaml", friction=friction, linear=solver, discretization=element)
                        found.append(run(self.amontons, deck, folder / element))
                self.compare_elements(records, friction=friction, solver=solver, dimension=3, strain="small")

    def sliding_mortar(self, small, large, elements=("node-to-face", "mortar")):
        records = {element: [run(self.amontons, EXAMPLES / "blocks-3d/blocks-3d.yaml", self.work / f"sliding-{small}-{element}",
                                 [f"mesh.parameters.n_small={small}", f"mesh.parameters.n_large={large}", *SLIDING,
                                  "solver.linear=direct", f"contact.0.discretization={element}"])] for element in elements}
        self.compare_elements(records, friction=0.3, solver="direct", dimension=3, strain="finite")

    def compare_elements(self, records, **known):
        seconds = {element: statistics.median(map(solution_time, found)) for element, found in records.items()}
        for element, found in records.items():
            self.say(row("mortar", found[0], element=element, **known)
                     | {"contact_s": seconds[element],
                        "over_nodes": seconds[element] / seconds["node-to-face"] if "node-to-face" in seconds else None})

    def example(self, case, deck, sizes, solvers, dimension, strain, friction, settings=()):
        for size in sizes:
            for solver in solvers:
                folder = self.work / f"{case}-{abs(hash(tuple(size)))}-{solver}"
                record = run(self.amontons, EXAMPLES / deck, folder, [*size, *settings, f"solver.linear={solver}"])
                self.say(row(case, record, friction=friction, solver=solver, dimension=dimension, strain=strain))

    def calculix(self, folder, mesh, known):
        if not calculix.available():
            print("CalculiX is not installed: no comparison with it")
            return
        for friction, tied in ((0, True), (0, False), (0.3, False)):
            result = calculix.solve(mesh, folder / f"ccx-{friction}-{tied}", friction, tied)
            ours = [r for r in self.rows if r["case"] == ("tied" if tied else "curved-blocks")
                    and r["friction"] == friction and r["increments"] == 1]
            ours = [r for r in ours if r["n_dofs"] == ours[-1]["n_dofs"]]
            best = min(ours, key=lambda r: r["contact_s"])
            entry = {"case": "calculix-tied" if tied else "calculix", "n_dofs": 3 * len(mesh.points),
                     "friction": friction, "solver": "calculix", "processes": 1, **known, **result,
                     "ratio_to_ours": result["contact_s"] / best["contact_s"],
                     "force_over_ours": result["normal_force"] / best["normal_force"] if best["normal_force"] else None}
            self.rows.append(entry)
            print(f"{entry['case']:<22}{entry['n_dofs']:>9} mu {friction:<4} {result['contact_s']:.1f} s, "
                  f"{entry['ratio_to_ours']:.1f} times ours, force {entry['force_over_ours']:.4f} of ours, "
                  f"{result['peak_rss_mb']:.0f} MB{'' if result['converged'] else '  NOT CONVERGED'}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("amontons")
    parser.add_argument("--quick", action="store_true", help="small sizes, a few minutes")
    parser.add_argument("--only", default="", help="curved-blocks, large, punch, sliding or mortar")
    parser.add_argument("--json", type=pathlib.Path, required=True)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        bench = Bench(options.amontons, pathlib.Path(work))
        wanted = lambda name: options.only in ("", name)
        began = time.time()
        try:
            if wanted("curved-blocks"):
                bench.blocks(8, ["direct", "amg", "feti"], ["direct", "amg", "feti"], with_calculix=True)
                bench.blocks(13, ["direct", "amg", "feti"], ["direct", "amg", "feti"], with_calculix=not options.quick)
                if not options.quick:
                    bench.blocks(18, ["amg", "feti"], ["amg", "feti"], with_calculix=True)
                    bench.blocks(26, ["amg", "feti"], ["amg", "feti"])
                    bench.later_increments(26, "auto")
            if wanted("large") and not options.quick:
                bench.blocks(41, ["auto"], ["amg", "feti"])
            if wanted("punch"):
                sizes = ([100], [200]) if options.quick else ([100], [200], [400], [800])
                bench.example("punch", "punch/punch.yaml", [(f"mesh.parameters.n={n}",) for n, in sizes],
                              ["direct", "feti"], 2, "small", 0.2)
            if wanted("sliding"):
                sizes = [(6, 5)] if options.quick else [(8, 6), (14, 11)]
                bench.example("sliding", "blocks-3d/blocks-3d.yaml",
                              [(f"mesh.parameters.n_small={a}", f"mesh.parameters.n_large={b}") for a, b in sizes],
                              ["direct", "amg"], 3, "finite", 0.3, SLIDING)
            if wanted("mortar"):
                for cells in (8,) if options.quick else (8, 13):
                    bench.mortar(cells, ["direct", "amg", "feti"])
                bench.sliding_mortar(*((6, 5) if options.quick else (8, 6)))
                if not options.quick:  # nodes to faces: a quarter of an hour, in 'sliding'
                    bench.sliding_mortar(14, 11, ["mortar"])
        finally:
            options.json.write_text(json.dumps(bench.rows, indent=1))
            print(f"{time.time() - began:.0f} s, {len(bench.rows)} rows in {options.json}")


if __name__ == "__main__":
    main()
