"""The command line: commands, options, exit codes."""
import json
import unittest

from command import CommandTest


class CommandLine(CommandTest):
    def test_version(self):
        self.assertRegex(self.succeed("version"), r"^amontons \d+\.\d+\.\d+\n$")

    def test_help_names_the_commands_and_exit_codes(self):
        text = self.succeed("--help")
        for word in ("run", "check", "detect", "version", "3 not converged"):
            self.assertIn(word, text)
        self.assertIn("--output", self.succeed("run", "--help"))

    def test_wrong_command_lines(self):
        for arguments, message in (
                (["runn", "deck.yaml"], r"no command 'runn' \(did you mean 'run'\?\); there are run, check"),
                ([], r"subcommand is required"),
                (["run"], r"DECK is required"),
                (["run", "deck.yaml", "--outptu", "x"], r"--outptu"),
                (["run", "deck.yaml", "--set"], r"--set"),
                (["detect", "deck.yaml", "--method", "magic"], r"magic.*brute.*exact.*nearest-node"),
                (["run", "deck.yml"], r"deck.yml: cannot read the deck"),
                (["run", "deck.yaml", "--set", "loading.increments=none"], r"increments"),
                (["run", "deck.yaml", "--set", "loading.increment=3"], r"did you mean 'increments'"),
                (["run", "deck.yaml", "--output", "blocks.geo"], r"output folder 'blocks.geo' is a file")):
            with self.subTest(arguments=arguments):
                self.assertRegex(self.expect_error(2, *arguments), message)
        self.assertFalse((self.folder / "deck-results").exists(), "results of a run that could not begin")

    def test_check_tells_what_is_there_and_solves_nothing(self):
        text = self.succeed("check", "deck.yaml")
        self.assertIn("117 nodes, 89 cells", text)
        self.assertIn("contact interface: 6 impactor nodes, 8 target faces", text)
        self.assertFalse((self.folder / "deck-results").exists())

    def test_detect_gives_the_same_pairs_by_every_method(self):
        found = {}
        for method in ("exact", "nearest-node", "brute"):
            reports = json.loads(self.succeed("detect", "deck.yaml", "--json", "--method", method))
            self.assertEqual([report["name"] for report in reports], ["interface"])
            found[method] = (reports[0]["n_pairs"], reports[0]["n_impactor_nodes"], reports[0]["n_penetrations"])
        self.assertEqual(set(found.values()), {(6, 6, 0)})

    def test_detect_counts_what_is_inside(self):
        inside = ["detect", "deck.yaml", "--set", "mesh.parameters.depth=0.01"]
        done = self.call(*inside, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        report, = json.loads(done.stdout)
        self.assertEqual(report["n_penetrations"], 6)
        self.assertAlmostEqual(report["deepest"], -0.01, places=12)
        done = self.call(*inside)
        self.assertIn("6 nodes inside the target, the deepest by 0.01 at ", done.stdout)
        self.assertRegex(done.stderr, r"^warning: contact 'interface': 6 nodes lie inside the target")


if __name__ == "__main__":
    unittest.main()
