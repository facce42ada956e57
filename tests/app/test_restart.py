"""A run that goes on from a checkpoint comes to the end of one that was never interrupted, with the same files."""
import itertools
import os
import random
import re
import signal
import subprocess
import time
import unittest

from command import PROGRAM, CommandTest, children
from examples import breaches, worst
from results import Run, launcher
from vtu import grid_arrays

ELASTIC = "material: {law: linear-elastic, young: 1000, poisson: 0.3}}\n  - {name: above"
LOADING = "loading: {increments: 2}\n"
CHECKPOINTS = ("loading: {increments: %d}\noutput: {checkpoint: %d}\n"
               "solver: {tolerance: 1e-10}\n")


class Restart(CommandTest):
    def files(self, results):
        return {path.name: path.read_bytes() for path in (self.folder / results).iterdir()
                if path.name not in ("record.json", "checkpoint.cbor")}

    def increments(self, results):
        return self.record(results)["increments"]

    def go_on(self, results, **how):
        return self.succeed("run", "deck.yaml", "--output", results, "--restart", f"{results}/checkpoint.cbor", **how)

    def expect_the_same(self, results, whole="whole"):
        self.assertEqual(self.increments(results), self.increments(whole))
        self.assertEqual(self.files(results), self.files(whole))
        totals, expected = self.record(results)["totals"], self.record(whole)["totals"]
        self.assertEqual(totals["n_newton_iterations"], expected["n_newton_iterations"])

    def stop_short(self, increments, end):
        """The whole run of the deck, and one that ended earlier and is then taken on to the end."""
        self.succeed("run", "deck.yaml", "--output", "whole")
        self.succeed("run", "deck.yaml", "--output", "part", "--set", f"loading.end={end}",
                     "--set", f"loading.increments={round(end * increments)}")
        self.assertLess(len(self.increments("part")), len(self.increments("whole")))
        text = self.go_on("part")
        self.assertIn("goes on from increment", text)
        self.expect_the_same("part")
        self.assertEqual(self.record("part")["restarts"], [{"after_increment": round(end * increments)}])

    def test_friction_in_small_strain(self):
        self.write_deck((LOADING, CHECKPOINTS % (4, 1)), ('"0.005*t"', '"0.02*max(t-0.5,0)"'))
        self.stop_short(4, 0.5)

    def slide_in_finite_strain(self, *more):
        self.write_deck((LOADING, CHECKPOINTS % (8, 2) + "strain: finite\n"), ('"0.005*t"', '"0.3*max(t-0.25,0)"'),
                        (ELASTIC, ELASTIC.replace("linear-elastic", "neo-hookean")),
                        ("region: upper, material: {law: linear-elastic", "region: upper, material: {law: neo-hookean"), *more)
        self.stop_short(8, 0.5)

    def test_friction_in_finite_strain(self):
        self.slide_in_finite_strain()

    def test_surface_to_surface_in_finite_strain(self):
        self.slide_in_finite_strain(("target: lower_top,", "target: lower_top, discretization: mortar,"))

    def test_plastic_bodies_unloaded(self):
        self.write_deck((LOADING, CHECKPOINTS % (4, 1)), ('"-0.01*t"', '"-0.04*min(t,1-t)"'),
                        (ELASTIC, ELASTIC.replace("linear-elastic", "von-mises").replace(
                            "poisson: 0.3", "poisson: 0.3, yield-stress: 5, kinematic-hardening: 100")))
        self.stop_short(4, 0.5)

    def n_converged(self, results):
        return len(self.increments(results)) if (self.folder / results / "record.json").exists() else 0

    def kill_and_go_on(self, n_kills, n_increments, numbers):
        """Runs, and goes on, on these numbers of processes in turn; each time one of them is killed at a random moment of
        one of the next increments."""
        seed = random.randrange(10**6)
        moment = random.Random(seed)
        checkpoint = self.folder / "killed" / "checkpoint.cbor"
        for kill, processes in zip(range(n_kills), itertools.cycle(numbers)):
            go_on = ["--restart", checkpoint] if checkpoint.exists() else []
            run = subprocess.Popen([*launcher(processes), PROGRAM, "run", "deck.yaml", "--output", "killed", *go_on],
                                   cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            while (self.n_converged("killed") < (kill + 1) * n_increments // (n_kills + 2)
                   or processes > 1 and not children(run.pid)):  # mpirun takes its time
                self.assertIsNone(run.poll(), f"seed {seed}")
                time.sleep(0.002)
            time.sleep(moment.uniform(0, 0.05))
            os.kill(moment.choice(children(run.pid)) if processes > 1 else run.pid, signal.SIGKILL)
            self.assertNotEqual(run.wait(), 0, f"seed {seed}")
        return seed

    def test_killed_at_any_moment(self):
        """AMONTONS_KILLS in the environment: how often."""
        n_kills = int(os.environ.get("AMONTONS_KILLS", 3))
        n_increments = 20 * (n_kills + 2)
        self.write_deck((LOADING, CHECKPOINTS % (n_increments, 1)))
        self.succeed("run", "deck.yaml", "--output", "whole")
        seed = self.kill_and_go_on(n_kills, n_increments, [1])
        self.go_on("killed")
        self.expect_the_same("killed")
        # A restart that was killed before its first checkpoint left no trace.
        self.assertIn(len(self.record("killed")["restarts"]), range(1, n_kills + 1), f"seed {seed}")

    def expect_close(self, results):
        """The same as the whole run, to what other numbers of processes leave the same."""
        self.assertEqual(breaches(worst(Run(self.folder / "whole"), Run(self.folder / results))), [])
        for pvd in (self.folder / results).glob("*.pvd"):
            for listed in re.findall('file="([^"]*)"', pvd.read_text(encoding="utf-8")):
                grid_arrays(self.folder / results / listed)

    def test_killed_on_any_number_of_processes(self):
        """AMONTONS_KILLS as above."""
        n_kills = int(os.environ.get("AMONTONS_KILLS", 3))
        n_increments = 20 * (n_kills + 2)
        self.write_deck((LOADING, CHECKPOINTS % (n_increments, 1)))
        self.succeed("run", "deck.yaml", "--output", "whole")
        seed = self.kill_and_go_on(n_kills, n_increments, [2, 3, 1, 2])
        self.go_on("killed", processes=3)
        with self.subTest(seed=seed):
            self.expect_close("killed")

    def change_processes(self, end=0.5):
        """From 1 to 2, from 2 to 1 and from 2 to 3 processes half way: as the whole run on one."""
        self.succeed("run", "deck.yaml", "--output", "whole")
        for before, after in ((1, 2), (2, 1), (2, 3)):
            with self.subTest(before=before, after=after):
                results = f"{before}-then-{after}"
                self.succeed("run", "deck.yaml", "--output", results, "--set", f"loading.end={end}", "--set",
                             "loading.increments=2", processes=before)
                self.go_on(results, processes=after)
                self.expect_close(results)

    def test_other_number_of_processes_with_friction(self):
        self.write_deck((LOADING, CHECKPOINTS % (4, 1)), ('"0.005*t"', '"0.02*max(t-0.5,0)"'))
        self.change_processes()

    def test_other_number_of_processes_with_plasticity(self):
        self.write_deck((LOADING, CHECKPOINTS % (4, 1)), ('"-0.01*t"', '"-0.04*min(t,1-t/2)"'),
                        (ELASTIC, ELASTIC.replace("linear-elastic", "von-mises").replace(
                            "poisson: 0.3", "poisson: 0.3, yield-stress: 5, kinematic-hardening: 100")))
        self.change_processes()

    def test_goes_on_into_another_folder(self):
        self.write_deck((LOADING, CHECKPOINTS % (4, 1)))
        self.succeed("run", "deck.yaml", "--output", "whole")
        self.succeed("run", "deck.yaml", "--output", "part", "--set", "loading.end=0.5", "--set", "loading.increments=2")
        self.succeed("run", "deck.yaml", "--output", "rest", "--restart", "part/checkpoint.cbor")
        self.assertEqual(self.increments("rest"), self.increments("whole"))
        self.assertNotIn("solution_00001.vtu", (self.folder / "rest" / "solution.pvd").read_text(encoding="utf-8"))

    def test_says_what_is_wrong(self):
        self.write_deck((LOADING, CHECKPOINTS % (2, 1)))
        self.succeed("run", "deck.yaml", "--output", "whole")
        record = (self.folder / "whole" / "record.json").read_bytes()
        message = self.expect_error(2, "run", "deck.yaml", "--output", "whole", "--restart", "whole/checkpoint.cbor")
        self.assertIn("set loading.end", message)
        self.assertEqual((self.folder / "whole" / "record.json").read_bytes(), record, "nothing is lost")
        message = self.expect_error(2, "run", "deck.yaml", "--restart", "whole/checkpoint.cbor",
                                    "--set", "contact.0.discretization=mortar")
        self.assertIn("of another problem", message)
        message = self.expect_error(2, "run", "deck.yaml", "--restart", "whole/checkpoint.cbor",
                                    "--set", "mesh.parameters.n=5")
        self.assertIn("of another problem", message)
        message = self.expect_error(2, "run", "deck.yaml", "--restart", "deck.yaml")
        self.assertIn("is no checkpoint", message)
        message = self.expect_error(2, "run", "deck.yaml", "--restart", "nowhere.cbor")
        self.assertIn("cannot read the checkpoint 'nowhere.cbor'", message)


if __name__ == "__main__":
    unittest.main()
