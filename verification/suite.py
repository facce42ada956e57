"""What a case of the verification is given and gives back: runs of the program in, rows of figures and plots out.

A case is a folder with `case.py`: a TITLE, and a function verify(bench) that returns a list of Rows. Its references are
coded there or stated in its README, with their source; none comes from this program. COARSE = False: not for the tests.
"""
import concurrent.futures
import dataclasses
import importlib.util
import math
import os
import re
import shutil
import sys
import tempfile
import threading
import time
import traceback

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
sys.path.insert(0, os.path.join(ROOT, "scripts"))
import results  # noqa: E402  (scripts/results.py)

LEVELS = ("coarse", "usual", "fine")
# Contact elements by name: what a deck sets for them, and why they are short where meshes do not match.
ELEMENTS = {
    "node-to-face": ({}, "constraints at nodes do not pass on a uniform pressure where meshes do not match: an error of the pressure that "
                         "alternates from node to node and does not shrink with the mesh, while means and forces converge"),
    "mortar": ({"contact.0.discretization": "mortar"}, ""),
}


class NotSolved(RuntimeError):
    """The program did not reach the end of a deck."""


MOST_SHORT = 1.05  # a row that is short by more fails


@dataclasses.dataclass
class Row:
    """One figure held against its reference.

    error = |ours - reference| / scale; scale is |reference|, or 1 where that is zero. Judged against `tolerance`; a row that
    misses it is `short` where the case states the `reason` and it is off by no more than its scale, else it fails; a reference that is not known is nan. `runs`: the runs it stands on, for their
    Newton iterations. `order`: of convergence with the cells' size, from `errors_by_size`.
    """
    quantity: str
    reference: float
    ours: float
    tolerance: float
    scale: float = None
    runs: tuple = ()
    order: float = None
    reason: str = ""

    @property
    def error(self):
        return abs(self.ours - self.reference) / (self.scale or abs(self.reference) or 1)

    @property
    def verdict(self):
        if self.error <= self.tolerance:  # false where the error is not a number
            return "met"
        if math.isnan(self.reference):
            return "short"
        return "short" if self.reason and self.error <= MOST_SHORT else "FAILED"

    def stored(self):
        """As it goes into the stored results: plain values."""
        iterations = [n for run in self.runs for n in run.newton_iterations()]
        return {"quantity": self.quantity, "reference": self.reference, "ours": self.ours, "error": self.error,
                "tolerance": self.tolerance, "order": self.order, "verdict": self.verdict,
                "newton_mean": sum(iterations) / len(iterations) if iterations else None,
                "newton_max": max(iterations, default=None),
                "reason": self.reason if self.verdict == "short" else ""}


class Bench:
    """Runs decks for one case at one level ("coarse": the tests'; "usual"; "fine") and keeps their cost."""

    def __init__(self, program, case, level, jobs=1, keep=None):
        self.program, self.case, self.level, self.jobs = program, case, level, jobs
        self.plots = {}
        self.runs = []
        self._keep = bool(keep)
        self._folder = os.path.join(os.path.abspath(keep), case) if keep else tempfile.mkdtemp(prefix=f"amontons-{case}-")
        os.makedirs(self._folder, exist_ok=True)
        self._lock = threading.Lock()
        self._begin = time.time()

    def choose(self, coarse, usual, fine=None):
        return {"coarse": coarse, "usual": usual, "fine": usual if fine is None else fine}[self.level]

    def path(self, name):
        """A file for meshes and the like that goes when the case is done."""
        return os.path.join(self._folder, name)

    def run(self, deck, settings=None, pictures=0):
        """A converged run of a deck of this case's folder, or of one named from the root (examples/...).

        settings: what --set takes, by key path. pictures: every how many increments.
        """
        place = os.path.join(HERE, self.case, deck)
        place = place if os.path.exists(place) else os.path.join(ROOT, deck)
        settings = {"output.every": pictures, **(settings or {})}
        folder = tempfile.mkdtemp(dir=self._folder)
        finished = results.run(self.program, place, [f"{key}={value}" for key, value in settings.items()], folder)
        with self._lock:
            self.runs.append(finished)
        if not finished.converged:
            raise NotSolved(f"{deck} with {settings}: {finished.record.get('failure', 'not converged')}")
        return finished

    def run_all(self, decks):
        """Runs of several (deck, settings[, pictures]), as many at a time as there are jobs, in the order given."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            return list(pool.map(lambda job: self.run(*job), decks))

    def plot(self, name, plot):
        self.plots[f"{self.case}-{name}.svg"] = plot.svg()

    def cost(self):
        """What the case took; wall seconds are those of this machine as busy as it was."""
        return {"runs": len(self.runs), "wall_s": time.time() - self._begin,
                "n_dofs": max((run.record["n_dofs"] for run in self.runs), default=0)}

    def close(self):
        if not self._keep:
            shutil.rmtree(self._folder)


def cases():
    """Names of the cases, folders with a case.py: in the order of their links in README.md, then those without one."""
    with open(os.path.join(HERE, "README.md"), encoding="utf-8") as file:
        listed = re.findall(r"\]\(([a-z0-9-]+)\)", file.read())
    found = sorted(name for name in os.listdir(HERE) if os.path.exists(os.path.join(HERE, name, "case.py")))
    return [name for name in listed if name in found] + [name for name in found if name not in listed]


def load(name):
    """The module of a case."""
    spec = importlib.util.spec_from_file_location(f"verification_{name.replace('-', '_')}", os.path.join(HERE, name, "case.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def verify(program, name, level, jobs=1, keep=None):
    """Results of a case as plain values for storing, and its plots by file name; keep: a folder for its meshes and runs."""
    module = load(name)
    bench = Bench(program, name, level, jobs, keep)
    rows, failure = [], ""
    try:
        rows = [row.stored() for row in module.verify(bench)]
    except RuntimeError as error:  # a run of the program
        failure = str(error)
    except Exception:  # in the case itself: it must not take the other cases with it
        failure = traceback.format_exc()
    finally:
        cost = bench.cost()
        bench.close()
    result = {"case": name, "title": module.TITLE, "level": level, "rows": rows, "failure": failure, "plots": list(bench.plots)}
    return {**result, **cost}, bench.plots


def good(result):
    return not result["failure"] and all(row["verdict"] != "FAILED" for row in result["rows"])


def order(coarse, fine, ratio=2):
    """Order of convergence from the errors on two meshes whose sizes have this ratio."""
    return math.log(coarse / fine) / math.log(ratio) if coarse > 0 and fine > 0 else math.nan
