"""A run that goes on from a checkpoint comes to the end of one that was never interrupted, with the same files."""
import os
import random
import signal
import subprocess
import time
import unittest

from command import PROGRAM, CommandTest

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

    def go_on(self, results):
        return self.succeed("run", "deck.yaml", "--output", results, "--restart", f"{results}/checkpoint.cbor")

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

    def test_friction_in_finite_strain(self):
        self.write_deck((LOADING, CHECKPOINTS % (8, 2) + "strain: finite\n"), ('"0.005*t"', '"0.3*max(t-0.25,0)"'),
                        (ELASTIC, ELASTIC.replace("linear-elastic", "neo-hookean")),
                        ("region: upper, material: {law: linear-elastic", "region: upper, material: {law: neo-hookean"))
        self.stop_short(8, 0.5)

    def test_plastic_bodies_unloaded(self):
        self.write_deck((LOADING, CHECKPOINTS % (4, 1)), ('"-0.01*t"', '"-0.04*min(t,1-t)"'),
                        (ELASTIC, ELASTIC.replace("linear-elastic", "von-mises").replace(
                            "poisson: 0.3", "poisson: 0.3, yield-stress: 5, kinematic-hardening: 100")))
        self.stop_short(4, 0.5)

    def n_converged(self, results):
        return len(self.increments(results)) if (self.folder / results / "record.json").exists() else 0

    def test_killed_at_any_moment(self):
        """AMONTONS_KILLS in the environment: how often, each time at a random moment of one of the next increments."""
        n_kills = int(os.environ.get("AMONTONS_KILLS", 3))
        n_increments = 20 * (n_kills + 2)
        self.write_deck((LOADING, CHECKPOINTS % (n_increments, 1)))
        self.succeed("run", "deck.yaml", "--output", "whole")
        seed = random.randrange(10**6)
        moment = random.Random(seed)
        checkpoint = self.folder / "killed" / "checkpoint.cbor"
        for kill in range(n_kills):
            go_on = ["--restart", checkpoint] if checkpoint.exists() else []
            process = subprocess.Popen([PROGRAM, "run", "deck.yaml", "--output", "killed", *go_on], cwd=self.folder,
                                       stdout=subprocess.DEVNULL)
            while self.n_converged("killed") < (kill + 1) * n_increments // (n_kills + 2):
                self.assertIsNone(process.poll(), f"seed {seed}")
                time.sleep(0.002)
            time.sleep(moment.uniform(0, 0.05))
            process.kill()
            self.assertEqual(process.wait(), -signal.SIGKILL, f"seed {seed}")
        self.go_on("killed")
        self.expect_the_same("killed")
        # A restart that was killed before its first checkpoint left no trace.
        self.assertIn(len(self.record("killed")["restarts"]), range(1, n_kills + 1), f"seed {seed}")

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
