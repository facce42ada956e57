#!/usr/bin/env python3
"""Writes the tables of docs/performance/scaling.md from the benchmark's results.   report.py FILE"""
import json
import pathlib
import re
import statistics
import sys

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "performance" / "scaling.md"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def spaced(value):
    return f"{value:,.0f}".replace(",", " ")


def most_over_mean(figure):
    return f"{figure['most'] / figure['mean']:.2f}"


def chosen(results, **wanted):
    return [r for r in results if all(r.get(key) == value for key, value in wanted.items())]


def falls(results):
    rows = []
    n_largest = max(r["n_target"] for r in chosen(results, surface="wavy"))
    for spread in ("in-runs", "random"):
        seen = set()
        for r in chosen(results, part="what_falls", surface="wavy", mode="distributed", spread=spread, n_target=n_largest):
            if r["processes"] in seen:
                continue
            seen.add(r["processes"])
            first, again = r["detections"][0], r["detections"][1]
            rows.append([spread, str(r["processes"]), spaced(first["nodes sought"]["most"]),
                         spaced(first["nodes held"]["mean"]), spaced(first["nodes held"]["most"]),
                         f"{first['nodes held']['mean'] * r['processes'] / (r['n_impactor'] + r['n_target']):.3f}",
                         spaced(first["bytes"]["mean"] / 1000), spaced(first["bytes"]["most"] / 1000),
                         spaced(again["bytes"]["mean"] / 1000), f"{again['messages']['mean']:.0f}",
                         f"{first['reductions']['mean']:.0f}", f"{again['reductions']['mean']:.0f}"])
    return table(["spread", "processes", "nodes sought, most", "nodes held, mean", "most", "held in all / nodes",
                  "first: kB sent, mean", "most", "again: kB sent, mean", "messages, mean", "reductions, first", "again"],
                 rows)


def gathered(results):
    rows = []
    for r in chosen(results, part="what_falls", surface="wavy", mode="gathered", spread="in-runs"):
        same = chosen(results, part="what_falls", surface="wavy", mode="distributed", spread="in-runs",
                      processes=r["processes"], n_target=r["n_target"])[0]
        cells = [str(r["processes"])]
        for mode in (r, same):
            again = mode["detections"][-1]
            cells += [spaced(max(again["hub nodes held"]["most"], again["nodes held"]["most"])),
                      spaced(again["bytes"]["most"] / 1000), spaced(again["messages"]["most"])]
        rows.append(cells)
    return table(["processes", "gathered: nodes held, most", "kB sent, most", "messages, most",
                  "distributed: nodes held, most", "kB sent, most", "messages, most"], rows)


def surfaces(results):
    rows = []
    for surface, distance in (("torus", "auto"), ("graded-500", "auto"), ("crowded", "auto"), ("crowded", "given")):
        for r in chosen(results, part="what_falls", surface=surface, distance=distance):
            if r["processes"] == 1:
                continue
            first = r["detections"][0]
            rows.append([f"{surface}, w {distance}", str(r["processes"]), most_over_mean(first["nodes sought"]),
                         spaced(first["nodes held"]["mean"]), most_over_mean(first["nodes held"]),
                         spaced(first["bytes"]["mean"] / 1000), most_over_mean(first["bytes"])])
    return table(["surface", "processes", "nodes sought, most / mean", "nodes held, mean", "most / mean", "kB sent, mean",
                  "most / mean"], rows)


def grows(results):
    rows, n_largest = [], max(r["n_target"] for r in chosen(results, surface="wavy"))
    for r in chosen(results, part="what_falls", surface="wavy", mode="distributed", spread="in-runs"):
        if r["n_target"] == n_largest and r["processes"] < 16 or any(row[0] == str(r["processes"]) for row in rows):
            continue
        first, again = r["detections"][0], r["detections"][1]
        rows.append([str(r["processes"]), spaced(r["n_impactor"] + r["n_target"]), spaced(first["nodes held"]["most"]),
                     spaced(first["bytes"]["most"] / 1000), spaced(again["bytes"]["most"] / 1000),
                     f"{again['messages']['mean']:.0f}", f"{first['reduced bytes']['mean'] / 1000:.1f}"])
    return table(["processes", "nodes of both sides", "nodes held, most", "first: kB sent, most", "again: kB sent, most",
                  "messages, mean", "first: kB reduced"], rows)


def same(results):
    rows = []
    for n_processes in sorted({r["processes"] for r in results if "detections" in r}):
        for mode in ("distributed", "gathered"):
            found = chosen(results, processes=n_processes, mode=mode)
            detections = [(r, d) for r in found for d in r["detections"]]
            if n_processes > 1:
                rows.append([str(n_processes), mode, str(len({(r["surface"], r["shape"]) for r in found})),
                             str(len(detections)), spaced(sum(r["n_impactor"] for r, _ in detections)),
                             str(sum(d["wrong"] for _, d in detections))])
    return table(["processes", "mode", "surfaces", "detections", "nodes compared", "that differ in any bit"], rows)


def one_decomposition(results):
    found = chosen(results, part="one_decomposition")
    reference = chosen(found, solver="direct")[0]

    def difference(row):
        size = max(abs(f) for f in reference["normal_force"])
        return max(abs(a - b) for kind in ("normal_force", "tangential_force")
                   for a, b in zip(row[kind], reference[kind])) / size
    return table(["solver", "processes", "unknowns", "Newton", "linear iterations", "force off direct's",
                  "MB, most", "messages of a process", "MB sent, most"],
                 [[r["solver"], str(r["processes"]), spaced(r["n_dofs"]), str(r["newton_iterations"]),
                   str(r["linear_iterations"]), f"{difference(r):.0e}", *shares_of(r)] for r in found])


def shares_of(row):
    """Greatest memory, messages and megabytes sent of a process, from the record."""
    traffic = row["of_processes"].get("traffic", {}).values()
    return [spaced(row["peak_rss_mb"]), spaced(sum(t["messages"]["max"] for t in traffic)),
            f"{sum(t['bytes']['max'] for t in traffic) / 1e6:.1f}"]


def growing(results):
    found = chosen(results, part="growing")
    iterations_of_one = {r["processes"]: r["linear_iterations"] for r in chosen(found, tied=True)}
    return table(["processes", "unknowns", "tied, one system: iterations", "friction: Newton", "linear iterations",
                  "MB, most", "messages of a process", "MB sent, most"],
                 [[str(r["processes"]), spaced(r["n_dofs"]), str(iterations_of_one[r["processes"]]),
                   str(r["newton_iterations"]), str(r["linear_iterations"]), *shares_of(r)]
                  for r in chosen(found, tied=False)])


def speed_up(results):
    found = chosen(results, part="speed_up")
    median = {(runs, processes): {key: statistics.median(r[key] for r in chosen(found, n_runs=runs, processes=processes))
                                  for key in ("seconds", "solution_s")}
              for runs, processes in ((1, 1), (1, 2), (2, 1))}
    rows = []
    for key, what in (("seconds", "whole run"), ("solution_s", "solution alone")):
        one, two, beside = (median[case][key] for case in ((1, 1), (1, 2), (2, 1)))
        rows.append([what, f"{one:.1f}", f"{two:.1f}", f"{one / two:.2f}", f"{beside:.1f}", f"{2 * one / beside:.2f}",
                     f"{beside / 2 / two:.2f}"])
    return table(["", "one process, s", "two processes, s", "speed-up", "two runs of one side by side, s",
                  "the machine's ceiling", "of that ceiling"], rows)


def main():
    results = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
    text = PAGE.read_text(encoding="utf-8")
    measured = {r["part"] for r in results}
    of_detection = (falls, gathered, surfaces, grows, same) if "what_falls" in measured else ()
    of_solution = [make for make in (one_decomposition, growing, speed_up) if make.__name__ in measured]
    for make in (*of_detection, *of_solution):
        begin, end = f"<!-- {make.__name__} -->", f"<!-- end of {make.__name__} -->"
        if begin not in text or end not in text:
            sys.exit(f"{PAGE}: no {begin} ... {end}")
        block = f"{begin}\n\n{make(results)}\n\n{end}"
        text = re.sub(re.escape(begin) + ".*?" + re.escape(end), lambda _, block=block: block, text, flags=re.DOTALL)
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
