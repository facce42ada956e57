"""The examples, the long ones shortened by coarser meshes and fewer increments, and how two runs of one differ."""
import math
from pathlib import Path

from contact_figures import hertz_fit, stick_radius_by_slip

EXAMPLES = Path(__file__).parents[1] / "examples"

# deck: what shortens it
SMALL_STRAIN = {
    "patch-tests/plane-matching": [],
    "patch-tests/plane-non-matching": [],
    "patch-tests/plane-mortar": [],
    "patch-tests/space-matching": [],
    "patch-tests/space-non-matching": [],
    "patch-tests/space-mortar": [],
    "press-fit/press-fit": ["mesh.parameters.n_inner=48", "mesh.parameters.n_outer=36"],
    "press-fit/interference": ["mesh.parameters.n_inner=32", "mesh.parameters.n_outer=32"],
    "hertz-cylinder/hertz-cylinder": ["mesh.parameters.n_cylinder=16", "mesh.parameters.n_block=8"],
    "hertz-sphere/hertz-sphere": ["mesh.parameters.n=20"],
    "hertz-sphere/friction": ["mesh.parameters.n=20", "loading.increments=12"],
    "punch/punch": ["mesh.parameters.n=40"],
}
FINITE_STRAIN = {
    # An odd number of cells: nodes on an edge of the target, in exact symmetry, go to one side or the other by round-off.
    "blocks-3d/blocks-3d": ["mesh.parameters.n_small=5", "mesh.parameters.n_large=3", "loading.end=1.5",
                            "loading.increments=10"],
    "ironing/ironing": ["mesh.parameters.n_block=60", "mesh.parameters.n_indenter=6", "loading.end=1.04",
                        "loading.increments=52"],
    "self-contact/ring": ["mesh.parameters.n=20", "loading.end=1.6", "loading.increments=40"],
}


def deck_of(example):
    return str(EXAMPLES / f"{example}.yaml")


def of_increments(a, b):
    """See differences()."""
    yield "increments", "the run", abs(len(a.increments) - len(b.increments))
    scale = {}
    for of_a, of_b in zip(a.increments, b.increments):
        yield "times", f"increment {of_a['increment']}", abs(of_a["time"] - of_b["time"])
        yield "newton_iterations", f"t = {of_a['time']}", abs(of_a["newton_iterations"] - of_b["newton_iterations"])
        for x, y in zip(of_a["contacts"], of_b["contacts"]):
            where = f"{x['name']} at t = {of_a['time']}"
            for count in ("n_active", "n_stick", "n_slip"):
                yield "statuses", f"{count} of {where}", abs(x[count] - y[count])
            name = x["name"]
            scale[name] = max([scale.get(name, 0), *map(abs, x["normal_force"])])
            for force in ("normal_force", "tangential_force"):
                difference = max(abs(p - q) for p, q in zip(x[force], y[force]))
                yield "forces", f"{force} of {where}", difference / (scale[name] or 1)
            yield "pressures", f"max_pressure of {where}", abs(x["max_pressure"] - y["max_pressure"]) / (x["max_pressure"] or 1)


def of_nodes(a, b):
    """See differences()."""
    for contact in a.increments[-1]["contacts"]:
        rows = list(zip(a.nodes(contact["name"]), b.nodes(contact["name"])))
        axes = [axis for axis in ("fx", "fy", "fz") if axis in rows[0][0]]
        force = max(abs(x[axis]) for x, _ in rows for axis in axes) or 1
        pressure = max(abs(x["pressure"]) for x, _ in rows) or 1
        for x, y in rows:
            where = f"node {x['id']:.0f} of {contact['name']}"
            yield "statuses", where, int((x["id"], x["status"]) != (y["id"], y["status"]))
            yield "node_forces", where, max(abs(x[axis] - y[axis]) for axis in axes) / force
            yield "pressures", where, abs(x["pressure"] - y["pressure"]) / pressure


def of_radii(a, b):
    """See differences(). Where an example has a contact or a stick radius."""
    figures = {"hertz": lambda nodes: hertz_fit(nodes, 0.1, 0.9)[0], "punch": stick_radius_by_slip}
    for beginning, radius in figures.items():
        for contact in a.increments[-1]["contacts"]:
            if Path(a.record["deck"]).parent.name.startswith(beginning):
                x, y = radius(a.nodes(contact["name"])), radius(b.nodes(contact["name"]))
                yield "radii", contact["name"], abs(x - y) / abs(x)


def differences(a, b):
    """(quantity, where, by how much) for everything that two runs of a deck should have in common.

    Counts (`increments`, `newton_iterations`, `statuses`) by number. `times` as they are. `forces` of contacts after each
    increment over the contact's greatest one so far; `pressures`, `node_forces` and `radii` (of contact or stick) relative.
    """
    yield from of_increments(a, b)
    yield from of_nodes(a, b)
    yield from of_radii(a, b)


def worst(a, b):
    """The greatest difference of each quantity."""
    out = {}
    for quantity, _, difference in differences(a, b):
        out[quantity] = max(out.get(quantity, 0), math.inf if math.isnan(difference) else difference)
    return out


# What runs of a deck have in common whatever the number of processes, its solver's tolerance being tight.
SAME = {"increments": 0, "times": 0, "newton_iterations": 0, "statuses": 0, "forces": 1e-8, "node_forces": 1e-8,
        "pressures": 1e-8, "radii": 1e-8}


def breaches(found):
    """Of what worst() has found: as text, what goes beyond SAME."""
    return [f"{quantity} differ by {difference:.3g}" for quantity, difference in found.items()
            if not difference <= SAME[quantity]]
