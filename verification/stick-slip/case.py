"""A block that sticks at 99 % of the friction it can have and slips at 101 %, held by springs or by its displacement."""
from suite import Row
from svg import Plot

TITLE = "Stick to slip"
DECK = "stick-slip.yaml"
NORMAL, LIMIT = 600, 180  # force, and mu times it
MODULUS = 2.1e5  # E; the shear modulus is half of it
EXACT = 1e-8
SLIP = 1e-6  # the stiffness is up to 4e7 times the spring's


def pushed(force, spring):
    """Settings of a block under this tangential force, its sole on springs of this stiffness."""
    growing = f"{force}*max(t-1,0)"
    return {"solver.tolerance": 1e-12, "boundary.0.traction.x": growing, "boundary.1.traction.y": f"-{growing}",
            "boundary.2.traction.y": growing, "boundary.3.spring.x": spring}


def friction(run):
    return abs(run.contact()["tangential_force"][0])


def worst(run, key, reference):
    return max((node[key] for node in run.nodes()), key=lambda value: abs(value - reference))


# Displacement of the top between +- 0.005, and the shear stress that it brings: 525 per t, until the sole slips.
TO_AND_FRO = "0.005*(max(t-1,0)-2*max(t-2,0)+2*max(t-4,0))"
SHEAR = "(t<1 ? 0 : (t<2 ? min(525*(t-1),180) : (t<4 ? max(180-525*(t-2),-180) : min(525*(t-4)-180,180))))"


def dragged(bench):
    """The same block without springs, its top dragged to and fro by more than it can shear: (displacement, friction)."""
    run = bench.run(DECK, {"solver.tolerance": 1e-12, "loading.end": 5, "loading.increments": 40,
                           "boundary.0": f'{{region: top, displacement: {{x: "{TO_AND_FRO}"}}, traction: {{y: "-600*min(t,1)"}}}}',
                           "boundary.1.traction.y": f'"-{SHEAR}"', "boundary.2.traction.y": f'"{SHEAR}"', "boundary.3.spring.x": 0})
    loop = []
    for increment in run.increments:
        t = increment["time"]
        move = 0.005 * (max(t - 1, 0) - 2 * max(t - 2, 0) + 2 * max(t - 4, 0))
        loop.append((move, -increment["contacts"][0]["tangential_force"][0]))
    return run, loop


def elastic_slider(loop):
    """Friction of a spring of the block's shear stiffness in series with a slider of LIMIT, for the same displacements."""
    found, slipped = [], 0.0
    for move, _ in loop:
        force = MODULUS / 2 * (move - slipped)
        if abs(force) > LIMIT:
            force = LIMIT if force > 0 else -LIMIT
            slipped = move - force / (MODULUS / 2)
        found.append((move, force))
    return found


def verify(bench):
    rows = []
    for spring in (2.0, 0.005):
        held, gone = bench.run_all([(DECK, pushed(178.2, spring)), (DECK, pushed(181.8, spring))])
        slip = (181.8 - LIMIT) / spring
        rows += [
            Row(f"178.2, spring {spring}: nodes that stick", 5, held.contact()["n_stick"], 0, runs=[held]),
            Row(f"178.2, spring {spring}: friction", 178.2, friction(held), EXACT),
            Row(f"178.2, spring {spring}: worst displacement of the sole", 0, worst(held, "ux", 0), EXACT),
            Row(f"181.8, spring {spring}: nodes that slip", 5, gone.contact()["n_slip"], 0, runs=[gone]),
            Row(f"181.8, spring {spring}: friction", LIMIT, friction(gone), EXACT),
            Row(f"181.8, spring {spring}: worst slip of a node", slip, worst(gone, "ux", slip), SLIP),
            Row(f"181.8, spring {spring}: worst pressure", NORMAL, worst(gone, "pressure", NORMAL), EXACT)]
    run, loop = dragged(bench)
    exact = elastic_slider(loop)
    rows.append(Row("displaced to and fro: worst friction of all increments / limit", 0,
                    max(abs(ours - theirs) for (_, ours), (_, theirs) in zip(loop, exact)) / LIMIT, EXACT, runs=[run]))
    bench.plot("loop", Plot("Stick to slip: friction of the block displaced to and fro", "displacement of the top", "friction")
               .add("computed", loop, "points").add("spring and slider", exact))
    return rows
