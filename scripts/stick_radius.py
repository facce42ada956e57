"""Stick radius of a run of examples/punch against the exact one.   stick_radius.py FOLDER NU MU

NU and MU are those of the run, one of the pairs for which the exact value is known (validate_punch.py).
"""
import sys

from contact_figures import stick_radius_by_slip
from results import Run
from validate_punch import EXACT, RADIUS


def main():
    folder, nu, mu = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
    exact = EXACT[nu, mu][0]
    computed = stick_radius_by_slip(Run(folder).nodes()) / RADIUS
    print(f"stick radius c/a = {computed:.5f}, exact {exact:.5f} (Spence 1975): {100 * (computed / exact - 1):+.2f} %")


if __name__ == "__main__":
    main()
