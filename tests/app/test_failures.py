"""What ends one process ends all, in seconds, with a message and an exit code that is not zero."""
import os
import pathlib
import random
import re
import signal
import subprocess
import time
import unittest

from command import PROGRAM, CommandTest, children
from results import launcher

ONE_FAILS = os.environ["AMONTONS_ONE_FAILS"]
SECONDS = 20  # on a busy machine


class OneProcessFails(unittest.TestCase):
    def end(self, error, others):
        start = time.monotonic()
        done = subprocess.run([*launcher(3), ONE_FAILS, error, others], capture_output=True, text=True, check=False,
                              timeout=120)
        self.assertLess(time.monotonic() - start, SECONDS)
        return done

    def test_while_others_wait_for_it(self):
        """They are ended, with the exit code of the error."""
        for error, code, message in (("user", 2, "bad deck"), ("numerical", 3, "no convergence"),
                                     ("other", 4, "internal error: vector")):
            with self.subTest(error=error):
                done = self.end(error, "waiting")
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertEqual(done.stderr.count(f"error: process 1: {message}"), 1, done.stderr)

    def test_after_others_are_done(self):
        """It is the error of all, which go on to their end."""
        for error, code in (("user", 12), ("numerical", 13), ("other", 14)):
            with self.subTest(error=error):
                done = self.end(error, "done")
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertNotIn("process 1:", done.stderr)


def is_at_work(process):
    """Not ended, nor merely waiting for its parent to notice."""
    stat = pathlib.Path(f"/proc/{process}/stat")
    try:
        return stat.read_text(encoding="ascii").rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


class OneProcessIsKilled(CommandTest):
    def test_by_any_signal(self):
        self.write_deck(("loading: {increments: 2}", "loading: {increments: 1000}\noutput: {every: 0}"))
        for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGSEGV):
            with self.subTest(signal=number):
                self.end_one(number)

    def end_one(self, number):
        results = self.folder / f"ended-by-{number}"
        run = subprocess.Popen([*launcher(3), PROGRAM, "run", "deck.yaml", "--output", results], cwd=self.folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        while not (results / "record.json").exists():
            self.assertIsNone(run.poll())
            time.sleep(0.01)
        processes = children(run.pid)
        self.assertEqual(len(processes), 3)
        start = time.monotonic()
        os.kill(random.choice(processes), number)
        self.assertNotEqual(run.wait(timeout=120), 0)
        self.assertLess(time.monotonic() - start, SECONDS)
        self.assertRegex(run.stderr.read(), "signal")
        while any(map(is_at_work, processes)):
            self.assertLess(time.monotonic() - start, SECONDS, "processes are left over")
            time.sleep(0.01)


class ErrorsOfAll(CommandTest):
    def expect_once(self, code, message, *arguments):
        done = self.call(*arguments, processes=3)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertEqual(done.stderr.count("error: "), 1, done.stderr)
        self.assertRegex(done.stderr, message)
        return done

    def test_are_told_once(self):
        self.expect_once(2, r"no command 'runn'", "runn", "deck.yaml")
        self.expect_once(2, r"DECK is required", "run")
        self.expect_once(2, r"cannot read the deck", "run", "deck.yml")
        self.expect_once(2, r"increments", "run", "deck.yaml", "--set", "loading.increments=none")
        self.expect_once(2, r"output folder 'blocks.geo' is a file", "run", "deck.yaml", "--output", "blocks.geo")
        self.expect_once(2, r"cannot read the checkpoint", "run", "deck.yaml", "--restart", "nowhere.cbor")
        self.expect_once(2, r"is no checkpoint", "run", "deck.yaml", "--restart", "deck.yaml")

    def test_of_the_mesh_are_told_once_and_recorded(self):
        self.write_deck(("lower_top,", "lower_tops,"))
        self.expect_once(2, r"deck.yaml:7:\d+: .*'lower_tops'.*did you mean 'lower_top'", "run", "deck.yaml")
        self.assertEqual(self.record()["status"], "failed")
        self.assertIn("lower_tops", self.record()["failure"])

    def test_not_converged_is_3(self):
        done = self.call("run", "deck.yaml", "--set", "solver.max-iterations=1", "--set", "loading.fixed=true",
                         processes=3)
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count("stopped at t = 0 of 1"), 1)
        self.assertEqual(self.record()["status"], "failed")


class OneProcessAlone(CommandTest):
    """Commands that need no others are done by one of the processes."""

    def test_says_the_same_as_without_others(self):
        for command in (["version"], ["--help"], ["detect", "deck.yaml"], ["check", "deck.yaml"]):
            with self.subTest(command=command):
                alone, among_others = (re.sub(r": \S+ s\n", "\n", self.succeed(*command, processes=n)) for n in (1, 3))
                self.assertEqual(alone, among_others)

    def test_its_errors_are_those_of_all(self):
        done = self.call("check", "deck.yml", processes=3)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("cannot read the deck"), 1)


if __name__ == "__main__":
    unittest.main()
