"""The same results on 1, 2 and 3 processes: forces, statuses, Newton's iterations, pictures and tables."""
import unittest

from command import PROGRAM, CommandTest
from examples import breaches, deck_of, worst
from results import run
from vtu import grid_arrays

ELASTIC_BELOW = "region: lower, material: {law: linear-elastic, young: 1000, poisson: 0.3}"
ELASTIC_ABOVE = "region: upper, material: {law: linear-elastic, young: 1000, poisson: 0.3}"
CONTACT = "{name: interface, impactor: upper_bottom, target: lower_top, friction: {law: coulomb, coefficient: 0.3}}"
TIGHT = ["loading.fixed=true", "solver.tolerance=1e-11"]


class Ranks(CommandTest):
    def solve(self, deck, overrides, processes):
        finished = run(PROGRAM, deck, [*TIGHT, *overrides], str(self.folder / f"on-{processes}"), processes)
        self.assertTrue(finished.converged, finished.record.get("failure"))
        self.assertEqual(finished.record["processes"], processes)
        return finished

    def expect_same(self, overrides=(), deck=None, numbers=(2, 3)):
        """On each of these numbers of processes as on one. Returns the run on one."""
        deck = deck or str(self.folder / "deck.yaml")
        alone = self.solve(deck, overrides, 1)
        self.assertGreater(sum(c["n_active"] for c in alone.increments[-1]["contacts"]), 0)
        for processes in numbers:
            with self.subTest(processes=processes):
                finished = self.solve(deck, overrides, processes)
                self.assertEqual(breaches(worst(alone, finished)), [])
                self.expect_same_bodies(processes, alone.increments[-1]["increment"])
        return alone

    def bodies(self, processes, increment):
        """By node: place and displacement; by the cell's nodes: stress, body and what else there is."""
        kind = "vtu" if processes == 1 else "pvtu"
        pieces = grid_arrays(self.folder / f"on-{processes}" / f"solution_{increment:05d}.{kind}")
        self.assertEqual(len(pieces), processes)
        nodes, cells = {}, {}
        for arrays in pieces:
            for i, node in enumerate(arrays["node"]):
                value = arrays["Points"][3 * i:3 * i + 3] + arrays["displacement"][3 * i:3 * i + 3]
                self.assertEqual(nodes.setdefault(node, value), value, "copies of a node")
            begin = 0
            for k, end in enumerate(arrays["offsets"]):
                key = tuple(arrays["node"][i] for i in arrays["connectivity"][begin:end])
                self.assertNotIn(key, cells, "a cell twice")
                cells[key] = (arrays["body"][k], arrays["types"][k], *arrays["stress"][6 * k:6 * k + 6],
                              *(arrays[name][k] for name in ("plastic_strain",) if name in arrays))
                begin = end
        return nodes, cells

    def expect_same_bodies(self, processes, increment):
        for of_one, of_all in zip(self.bodies(1, increment), self.bodies(processes, increment)):
            self.assertEqual(set(of_one), set(of_all))
            largest = max(abs(value) for values in of_one.values() for value in values)
            for key, values in of_one.items():
                self.assertEqual(len(values), len(of_all[key]))
                for x, y in zip(values, of_all[key]):
                    self.assertLessEqual(abs(x - y), 1e-8 * largest, key)

    def test_friction_in_the_plane(self):
        self.expect_same(numbers=(2, 3, 4))

    def test_feti(self):
        self.expect_same(["solver.linear=feti"])

    def test_multigrid(self):
        self.expect_same(["solver.linear=amg"])

    def test_coupled_form(self):
        self.expect_same(["solver.multipliers=coupled"])

    def test_finite_strain(self):
        self.write_deck((ELASTIC_BELOW, ELASTIC_BELOW.replace("linear-elastic", "neo-hookean")),
                        (ELASTIC_ABOVE, ELASTIC_ABOVE.replace("linear-elastic", "neo-hookean")),
                        ("loading: {increments: 2}", "loading: {increments: 6}\nstrain: finite"),
                        ('x: "0.005*t", y: "-0.01*t"', 'x: "0.3*max(t-0.5,0)", y: "-0.05*min(2*t,1)"'))
        self.expect_same()

    def test_plasticity(self):
        self.write_deck((ELASTIC_BELOW, ELASTIC_BELOW.replace("linear-elastic", "von-mises").replace(
            "poisson: 0.3", "poisson: 0.3, yield-stress: 5, kinematic-hardening: 100")),
            ('"-0.01*t"', '"-0.04*min(t,1-t/2)"'), ("loading: {increments: 2}", "loading: {increments: 4}"))
        self.expect_same()

    def test_mortar(self):
        self.expect_same(["contact.0.discretization=mortar", "contact.0.friction.coefficient=0.1"])

    def test_rigid_body_with_force_and_moment(self):
        self.write_deck((ELASTIC_ABOVE, "region: upper, material: {law: rigid}"),
                        (CONTACT, CONTACT.replace("upper_bottom", "lower_top", 1).replace("target: lower_top",
                                                                                         "target: upper_bottom")),
                        ('region: upper_top, displacement: {x: "0.005*t", y: "-0.01*t"}',
                         'region: upper, displacement: {x: "0.005*t"}, force: {y: "-5*t"}, moment: {z: "0.2*t"}'))
        alone = self.expect_same()
        self.assertEqual({contact["n_active"] > 0 for contact in alone.increments[-1]["contacts"]}, {True})

    def test_friction_in_space(self):
        self.expect_same(["mesh.parameters.n_small=3", "mesh.parameters.n_large=2", "strain=small", "loading.end=1.02",
                          "loading.increments=3", "bodies.0.material.law=linear-elastic",
                          "bodies.1.material.law=linear-elastic"], deck_of("blocks-3d/blocks-3d"))

    def test_self_contact(self):
        self.expect_same(["mesh.parameters.n=12", "loading.end=1.6", "loading.increments=32", "output.every=40"],
                         deck_of("self-contact/ring"))

    def test_record_tells_of_all_processes(self):
        self.succeed("run", "deck.yaml", "--output", "two", processes=2)
        totals = self.record("two")["totals"]
        processes = totals["processes"]
        self.assertEqual(processes["n_cells"]["sum"], 89)
        for of_all in (processes["n_cells"], processes["cpu_s"], processes["peak_rss_mb"], processes["timings"]["linear_setup"]):
            self.assertLessEqual(of_all["min"], of_all["max"])
            self.assertGreater(of_all["min"], 0)
        self.assertGreater(sum(phase["bytes"]["sum"] for phase in processes["traffic"].values()), 0)


if __name__ == "__main__":
    unittest.main()
