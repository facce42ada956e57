"""The table of the verification: on the screen, and as docs/verification.md from the stored results."""
import json
import math
import os

from suite import ROOT, results

STORE = os.path.join(ROOT, "docs", "verification")
HEAD = ["quantity", "reference", "ours", "error", "tolerance", "order", "Newton mean / max", ""]
INTRODUCTION = """\
# Verification

Every claim against something that nobody here wrote: formulas of the literature, published numbers, exact solutions. `bash
scripts/verify.sh` ran the cases and made this page; `bash scripts/verify.sh CASE --fine` runs one of them, on its finest meshes too. The
folder of a case ([verification](../verification)) says what is computed, where its reference comes from and how the figure is measured.

*error*: |ours - reference| over |reference| (over 1, or over the scale that the quantity names, where the reference is zero).
*order*: of the convergence of that error with the cells' size, between the two finest meshes. *Newton*: iterations per increment.
*met*: the error is within the tolerance; *short*: it is not, for the reason below the table. No deck sets a penalty or a search radius.
"""


def cells(row):
    newton = "" if row["newton_max"] is None else f"{row['newton_mean']:.1f} / {row['newton_max']}"
    order = "" if row["order"] is None else f"{row['order']:.2f}"
    known = math.isfinite(row["reference"])
    return [row["quantity"], f"{row['reference']:.8g}" if known else "none", f"{row['ours']:.8g}",
            f"{row['error']:.1e}" if known else "", f"{row['tolerance']:.1e}", order, newton, row["verdict"]]


def reasons(result):
    """Reasons of the rows that are short, each with the rows it holds for."""
    found = {}
    for row in result["rows"]:
        if row["reason"]:
            found.setdefault(row["reason"], []).append(row["quantity"])
    return found


def cost(result):
    return f"{result['runs']} runs, largest {result['n_dofs']} unknowns, {result['wall_s']:.0f} s"


def screen(result):
    """Text of one case for the terminal."""
    lines = [f"== {result['case']}: {result['title']} ({result['level']}; {cost(result)})",
             results.table(HEAD, [cells(row) for row in result["rows"]])]
    lines += [f"short: {'; '.join(quantities)}: {reason}" for reason, quantities in reasons(result).items()]
    lines += [f"FAILED: {result['failure']}"] if result["failure"] else []
    return "\n".join(lines) + "\n"


def stored(name):
    """Results of a case as they were stored last, or None."""
    place = os.path.join(STORE, name + ".json")
    if not os.path.exists(place):
        return None
    with open(place, encoding="utf-8") as file:
        return json.load(file)


def store(result, plots):
    """Keeps a case's results and plots in docs/verification, in place of earlier ones."""
    os.makedirs(STORE, exist_ok=True)
    earlier = stored(result["case"])
    for old in earlier["plots"] if earlier else []:
        if old not in plots and os.path.exists(os.path.join(STORE, old)):
            os.remove(os.path.join(STORE, old))
    with open(os.path.join(STORE, result["case"] + ".json"), "w", encoding="utf-8") as file:
        json.dump(result, file, indent=1)
        file.write("\n")
    for name, svg in plots.items():
        with open(os.path.join(STORE, name), "w", encoding="utf-8") as file:
            file.write(svg)


def section(result):
    lines = [f"## {result['title']}", "",
             f"[verification/{result['case']}](../verification/{result['case']}); level {result['level']}: {cost(result)}.", "",
             f"| {' | '.join(HEAD)} |", "|" + " --- |" * len(HEAD)]
    lines += [f"| {' | '.join(cells(row))} |" for row in result["rows"]]
    lines.append("")
    for reason, quantities in reasons(result).items():
        lines += [f"- Short, {'; '.join(quantities)}: {reason}."]
    lines += ["- Failed: a run did not end as it should."] if result["failure"] else []
    lines += [""] if reasons(result) or result["failure"] else []
    lines += [f"![{name}](verification/{name})" for name in result["plots"]]
    return "\n".join(lines).rstrip() + "\n"


def overview(results_of_all):
    lines = ["| case | rows | short | failed |", "| --- | --- | --- | --- |"]
    for result in results_of_all:
        verdicts = [row["verdict"] for row in result["rows"]]
        lines.append(f"| {result['title']} | {len(verdicts)} | {verdicts.count('short')} | {verdicts.count('FAILED') + bool(result['failure'])} |")
    return "\n".join(lines) + "\n"


def write(names):
    """docs/verification.md from the stored results of these cases, in this order."""
    found = [result for result in map(stored, names) if result]
    text = "\n".join([INTRODUCTION, overview(found), *(section(result) for result in found)])
    with open(os.path.join(ROOT, "docs", "verification.md"), "w", encoding="utf-8") as file:
        file.write(text)
