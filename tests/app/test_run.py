"""Whole runs: what is written, and that every number is the same wherever it is written."""
import csv
import math
import sys
import unittest
from pathlib import Path

from command import CommandTest

sys.path.append(str(Path(__file__).parents[2] / "scripts"))
from vtu import vtu_arrays  # noqa: E402


class Run(CommandTest):
    def rows(self, results="deck-results"):
        with open(self.folder / results / "contact_interface.csv", newline="", encoding="utf-8") as file:
            return [{key: value if key == "status" else float(value) for key, value in row.items()}
                    for row in csv.DictReader(file)]

    def test_writes_everything(self):
        text = self.succeed("run", "deck.yaml")
        self.assertIn("Block on block", text)
        self.assertIn("solved to t = 1\n", text)
        self.assertIn("results in deck-results\n", text)
        names = sorted(path.name for path in (self.folder / "deck-results").iterdir())
        self.assertEqual(names, [
            "contact_interface.csv", "contact_interface.pvd", "contact_interface_00000.vtu",
            "contact_interface_00001.vtu", "contact_interface_00002.vtu", "record.json", "solution.pvd",
            "solution_00000.vtu", "solution_00001.vtu", "solution_00002.vtu"])

    def test_record_is_whole(self):
        self.succeed("run", "deck.yaml")
        record = self.record()
        self.assertEqual((record["status"], record["processes"], record["title"]), ("converged", 1, "Block on block"))
        self.assertEqual([increment["time"] for increment in record["increments"]], [0.5, 1])
        totals = record["totals"]
        self.assertEqual(totals["n_newton_iterations"], sum(i["newton_iterations"] for i in record["increments"]))
        for counter in ("n_bulk_assemblies", "n_pattern_builds", "n_contact_updates", "n_factorizations", "n_detections"):
            self.assertGreaterEqual(totals[counter], 1, counter)
        self.assertEqual(totals["n_bulk_assemblies"], 1, "small strain keeps its stiffness")
        self.assertEqual(set(totals["timings"]), {"mesh", "setup", "detection", "bulk_assembly", "contact_assembly",
                                                  "linear_setup", "linear_solve", "output"})
        self.assertLessEqual(sum(totals["timings"].values()), totals["wall_s"])
        self.assertGreater(sum(totals["timings"].values()), 0.5 * totals["wall_s"])

    def test_forces_agree_wherever_they_are_written(self):
        self.succeed("run", "deck.yaml")
        rows = self.rows()
        increment = self.record()["increments"][-1]
        contact, = increment["contacts"]
        reactions = {reaction["region"]: reaction["force"] for reaction in increment["reactions"]}
        scale = math.hypot(*contact["normal_force"])
        self.assertGreater(scale, 1)
        for axis, column in enumerate(("fx", "fy")):
            of_nodes = math.fsum(row[column] for row in rows)
            of_record = contact["normal_force"][axis] + contact["tangential_force"][axis]
            self.assertAlmostEqual(of_record / scale, of_nodes / scale, delta=1e-10)
            # What the lower block pushes up, the upper support pushes down, and the other way round.
            self.assertAlmostEqual(of_nodes / scale, -reactions["upper_top"][axis] / scale, delta=1e-10)
            self.assertAlmostEqual(of_nodes / scale, reactions["lower_bottom"][axis] / scale, delta=1e-10)

    def test_pressures_and_counts_follow_from_the_nodes(self):
        self.succeed("run", "deck.yaml")
        rows = self.rows()
        contact, = self.record()["increments"][-1]["contacts"]
        closed = [row for row in rows if row["status"] != "open"]
        self.assertEqual(contact["n_active"], len(closed))
        self.assertEqual(contact["n_stick"], sum(row["status"] == "stick" for row in rows))
        self.assertEqual(contact["n_slip"], sum(row["status"] == "slip" for row in rows))
        self.assertEqual(contact["max_pressure"], max(row["pressure"] for row in rows))
        self.assertEqual(contact["min_gap"], min(row["gap"] for row in rows))
        self.assertAlmostEqual(contact["contact_area"], math.fsum(row["area"] for row in closed), places=12)
        self.assertAlmostEqual(math.fsum(row["area"] for row in rows), 1, places=12)
        for row in rows:
            self.assertAlmostEqual(row["pressure"] * row["area"], row["fy"], delta=1e-12 * contact["max_pressure"])
            self.assertLessEqual(abs(row["traction_1"]), 0.3 * row["pressure"] * (1 + 1e-9))

    def test_pressure_integrated_over_the_picture_is_the_force(self):
        """By the trapezoidal rule on the written segments, as ParaView's Integrate Variables does: exact for nodal pressures
        that are force over tributary area where the segments are of one length, here to round-off."""
        self.succeed("run", "deck.yaml")
        arrays = vtu_arrays(self.folder / "deck-results" / "contact_interface_00002.vtu")
        x, pressure = arrays["Points"][0::3], arrays["pressure"]
        ends = zip(arrays["connectivity"][0::2], arrays["connectivity"][1::2])
        integral = math.fsum(abs(x[b] - x[a]) * (pressure[a] + pressure[b]) / 2 for a, b in ends)
        contact, = self.record()["increments"][-1]["contacts"]
        self.assertAlmostEqual(integral / contact["normal_force"][1], 1, delta=1e-12)

    def test_pictures_hold_the_numbers_of_the_table(self):
        self.succeed("run", "deck.yaml")
        arrays = vtu_arrays(self.folder / "deck-results" / "contact_interface_00002.vtu")
        rows = self.rows()
        self.assertEqual(arrays["node"], tuple(int(row["id"]) for row in rows))
        for name, column in (("pressure", "pressure"), ("gap", "gap"), ("slip", "slip_1"), ("traction", "traction_1")):
            self.assertEqual(arrays[name], tuple(row[column] for row in rows), name)
        bodies = vtu_arrays(self.folder / "deck-results" / "solution_00002.vtu")
        self.assertEqual(len(bodies["types"]), 89)
        self.assertEqual(set(bodies["body"]), {0, 1})
        of_node = {node: bodies["displacement"][3 * i:3 * i + 2] for i, node in enumerate(bodies["node"])}
        for row in rows:
            self.assertEqual(of_node[int(row["id"])], (row["ux"], row["uy"]))

    def test_output_folder_and_overrides(self):
        self.succeed("run", "deck.yaml", "--output", "a/b", "--set", "loading.increments=1", "--set",
                     "contact.0.friction.coefficient=0", "--set", "output.every=0")
        record = self.record("a/b")
        self.assertEqual(len(record["increments"]), 1)
        self.assertEqual(record["increments"][0]["contacts"][0]["n_stick"], 0)
        self.assertEqual(sorted(path.name for path in (self.folder / "a/b").iterdir()),
                         ["contact_interface.csv", "record.json"])

    def test_a_second_run_leaves_nothing_of_the_first(self):
        self.succeed("run", "deck.yaml")
        (self.folder / "deck-results" / "notes.txt").write_text("mine", encoding="utf-8")
        self.succeed("run", "deck.yaml", "--set", "loading.increments=1")
        names = {path.name for path in (self.folder / "deck-results").iterdir()}
        self.assertNotIn("solution_00002.vtu", names)
        self.assertIn("notes.txt", names)

    def test_not_converged_is_3_and_keeps_what_was_solved(self):
        """Free of increments that may be cut, with one Newton iteration: the first increment cannot converge."""
        done = self.call("run", "deck.yaml", "--set", "solver.max-iterations=1", "--set", "loading.fixed=true")
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertIn("stopped at t = 0 of 1", done.stdout)
        record = self.record()
        self.assertEqual((record["status"], record["increments"]), ("failed", []))
        self.assertNotEqual(record["failure"], "")
        self.assertEqual(len(record["rejected"]), 1)
        self.assertFalse((self.folder / "deck-results" / "contact_interface.csv").exists())

    def test_failure_on_the_way_keeps_the_increments_before(self):
        """Half way the upper block is to be pressed through the lower one's bottom: no state is there to be found."""
        self.write_deck(("-0.01*t", "-0.01*t - 1e6*max(t-0.5,0)"))
        finite = [argument for key in ("strain=finite", "bodies.0.material.law=neo-hookean",
                                       "bodies.1.material.law=neo-hookean") for argument in ("--set", key)]
        done = self.call("run", "deck.yaml", "--set", "loading.min-increment=0.1", *finite)
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        record = self.record()
        self.assertEqual(record["status"], "failed")
        self.assertEqual([increment["time"] for increment in record["increments"]], [0.5])
        self.assertEqual(len(self.rows()), 6)


if __name__ == "__main__":
    unittest.main()
