"""Stick radius of a run of examples/punch against the exact one.   stick_radius.py FOLDER NU MU

NU and MU are those of the run, one of the pairs for which the exact value is known.
"""
import sys

from contact_figures import stick_radius_by_slip
from results import Run

# Spence's coupled problem (1975, J. Elasticity 5), solved by boundary elements with two independent algorithms.
# (nu, mu): c/a, P/P(mu = 0), inward slip at r = 0.95 a over delta.
EXACT = {
    (0.0, 0.2): (0.22086, 1.03595, 0.14434),
    (0.0, 0.3): (0.50316, 1.05240, 0.10416),
    (0.0, 0.4): (0.69819, 1.06546, 0.07043),
    (0.3, 0.2): (0.69828, 1.01927, 0.03663),
    (0.3, 0.3): (0.89596, 1.02430, 0.00877),
    (0.3, 0.4): (0.96111, 1.02661, 0.0),
}


def main():
    folder, nu, mu = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
    exact = EXACT[nu, mu][0]
    computed = stick_radius_by_slip(Run(folder).nodes())  # the radius of the punch is 1
    print(f"stick radius c/a = {computed:.5f}, exact {exact:.5f} (Spence 1975): {100 * (computed / exact - 1):+.2f} %")


if __name__ == "__main__":
    main()
