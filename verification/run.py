"""Runs cases of the verification and prints their table.   run.py PROGRAM [CASE ...] [--coarse | --fine] [--jobs N] [--keep FOLDER]

Results go to docs/verification/, from which docs/verification.md is made anew (not with --coarse, the level of the tests).
Exit code 1 where a row misses its tolerance without a stated reason, or a run does not converge.
"""
import argparse
import difflib
import os
import sys

import page
import suite


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("case", nargs="*")
    parser.add_argument("--coarse", action="store_const", const="coarse", dest="level", default="usual")
    parser.add_argument("--fine", action="store_const", const="fine", dest="level")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs at a time")
    parser.add_argument("--keep", metavar="FOLDER", help="keep meshes, decks' results and pictures there, by case")
    options = parser.parse_args()
    known = suite.cases()
    for name in options.case:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            sys.exit(f"no case '{name}'{f', did you mean {near[0]}?' if near else ''}; there are: {', '.join(known)}")

    good = True
    for name in options.case or known:
        result, plots = suite.verify(options.program, name, options.level, options.jobs, options.keep)
        print(page.screen(result), flush=True)
        good &= suite.good(result)
        if options.level != "coarse":
            page.store(result, plots)
    if options.level != "coarse":
        page.write(known)
        print("written: docs/verification.md")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
