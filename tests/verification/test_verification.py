"""The verification on its coarsest meshes: every row within its tolerance, or short for the reason it states."""
import os
import sys
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).parents[2] / "verification"))
import suite  # noqa: E402

PROGRAM = os.environ["AMONTONS"]


class Verification(unittest.TestCase):
    def test_coarse_meshes(self):
        for name in suite.cases():
            if not getattr(suite.load(name), "COARSE", True):
                continue
            with self.subTest(case=name):
                result, _ = suite.verify(PROGRAM, name, "coarse", jobs=2)
                self.assertEqual(result["failure"], "")
                self.assertGreater(sum(row["verdict"] == "met" for row in result["rows"]), 0)
                self.assertEqual([row for row in result["rows"] if row["verdict"] == "FAILED"], [])

    def test_rows_are_judged(self):
        self.assertEqual(suite.Row("", 2, 2.02, 0.011).verdict, "met")
        self.assertEqual(suite.Row("", 2, 2.02, 0.009).verdict, "FAILED")
        self.assertEqual(suite.Row("", 2, 2.02, 0.009, reason="known").verdict, "short")
        self.assertEqual(suite.Row("", 0, 1e-3, 1e-2, scale=0.05).verdict, "FAILED")
        self.assertEqual(suite.Row("", 1, float("nan"), 1).verdict, "FAILED")


if __name__ == "__main__":
    unittest.main()
