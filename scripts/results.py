"""Runs the program and reads what it writes: the run record and the contact surfaces. Standard library only."""
import csv
import json
import os
import subprocess
import tempfile


class Run:
    """A finished run.

    `record` is record.json; `increments` its list of increments; `directory` where the run wrote.
    """

    def __init__(self, directory):
        self.directory = directory
        with open(os.path.join(directory, "record.json"), encoding="utf-8") as file:
            self.record = json.load(file)
        self.increments = self.record["increments"]

    @property
    def converged(self):
        return self.record["status"] == "converged"

    def contact(self, name="interface", increment=-1):
        """Sums of a contact at the end of an increment, as the record states them."""
        return next(c for c in self.increments[increment]["contacts"] if c["name"] == name)

    def nodes(self, name="interface"):
        """Rows of contact_<name>.csv, numbers as floats, in the order of the file."""
        with open(os.path.join(self.directory, f"contact_{name}.csv"), newline="", encoding="utf-8") as file:
            return [{key: value if key == "status" else float(value) for key, value in row.items()}
                    for row in csv.DictReader(file)]

    def newton_iterations(self):
        return [increment["newton_iterations"] for increment in self.increments]

    def cutbacks(self):
        return sum(increment["cutbacks"] for increment in self.increments)


def launcher(processes):
    """What comes before the program on a command line, for so many processes, as many as there may be cores or more."""
    return ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(processes)] if processes > 1 else []


def run(program, deck, overrides=(), directory=None, processes=1):
    """Runs a deck; its output goes to `directory` or to a new temporary one.

    Raises RuntimeError with the program's last lines where it leaves no record.
    """
    directory = directory or tempfile.mkdtemp(prefix="amontons-")
    command = [*launcher(processes), program, "run", deck, "--output", directory]
    for override in overrides:
        command += ["--set", override]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode not in (0, 3) or not os.path.exists(os.path.join(directory, "record.json")):
        last = "\n".join(done.stdout.splitlines()[-8:])
        raise RuntimeError(f"{' '.join(command)}\nexit code {done.returncode}\n{last}")
    return Run(directory)


def table(head, rows):
    """Text table with aligned columns; cells are strings."""
    widths = [max(len(row[i]) for row in [head, *rows]) for i in range(len(head))]
    lines = ["  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in [head, *rows]]
    lines.insert(1, "  ".join("-" * width for width in widths))
    return "\n".join(lines)
