"""Contact force on the impactor over time, from a run's record, as CSV.   force_curve.py DIR [contact]"""
import sys

from results import Run

finished = Run(sys.argv[1])
name = sys.argv[2] if len(sys.argv) > 2 else "interface"
axes = "xyz"[:len(finished.contact(name)["normal_force"])]
print(",".join(["t"] + [f"f{axis}" for axis in axes] + ["n_active", "n_slip", "newton_iterations"]))
for i, increment in enumerate(finished.increments):
    contact = finished.contact(name, i)
    force = [normal + friction for normal, friction in zip(contact["normal_force"], contact["tangential_force"])]
    print(",".join(f"{value:.10g}" for value in [increment["time"], *force, contact["n_active"], contact["n_slip"],
                                                  increment["newton_iterations"]]))
