"""Keys of loads, supports, cracks and starts that scripts rely on, letter by letter, and columns of history.csv by name."""

import numpy as np
import pytest
from conftest import launch, rounding
from test_supports import CUBE

CELL, COUNT = 1e-3, 2  # cubes of 6 tetrahedra
AREA, DENSITY = (COUNT * CELL) ** 2, 2700

# What each name below does stands by `name:`, which the other lines do without.
CASE = """
mesh: {file: kept.h5}
material: {model: linear-elastic, young: 70e9, poisson: 0.25, density: 2700}
tables: {ramp: [[0, 0], [1e-6, 1]]}
interface: {law: linear, strength: 1e12, energy: 1e9, sets: [{where: "abs(z - 1e-3) < 1e-6 && x > 1e-3", open: true}]}
start: static
loads: [{set: z+, traction: {z: 1e6}}, {set: hole, pressure: "2e6*exp(-t/1e-5)"}, {set: z-, force: {x: 10}}, {acceleration: {z: -9.81}},
        {name: pull, set: z+, traction: {z: 1e6}}, {name: gas, set: hole, pressure: "2e6*exp(-t/1e-5)"}, {name: push, set: z-, force: {x: 10}},
        {name: fall, acceleration: {z: -9.81}}, {name: rise, where: "ny > 0.5", pressure: "1e5*ramp(t)"}]
boundary: [{set: z+, absorbing: true}, {set: s, normal: 0}, {name: roll, where: "ny < -0.5", normal: 0},
           {name: hold, set: z-, component: z, displacement: 0, from: 0, until: 1e-6}]
time: {end: 2e-6}
output: {fields: [], interval: 1e-7, sensors: [{name: low, set: low, values: [uz]}, {name: same, where: z < 1e-3, values: [uz]}, {name: end, set: z+, values: [uz]}]}
"""


@pytest.fixture(scope="module")
def kept(run, scratch):
    n = COUNT + 1
    nodes = [(i, j, k) for k in range(n) for j in range(n) for i in range(n)]
    number = {node: m + 1 for m, node in enumerate(nodes)}
    cells = [(i, j, k) for i in range(COUNT) for j in range(COUNT) for k in range(COUNT)]
    text = ["*NODE", *(f"{number[x]}, " + ", ".join(repr(CELL * c) for c in x) for x in nodes), "*ELEMENT, TYPE=C3D4"]
    elements = [[number[i + (v & 1), j + (v >> 1 & 1), k + (v >> 2 & 1)] for v in corners] for i, j, k in cells for corners in CUBE]
    text += [", ".join(map(str, (e + 1, *corners))) for e, corners in enumerate(elements)]
    for name, axis, at in (("z+", 2, COUNT), ("z-", 2, 0), ("hole", 0, COUNT), ("s", 0, 0)):
        text += [f"*NSET, NSET={name}", *(str(number[x]) for x in nodes if x[axis] == at)]
    text += ["*ELSET, ELSET=low", *(str(e + 1) for e in range(len(elements)) if cells[e // len(CUBE)][2] == 0)]
    (scratch / "kept.inp").write_text("\n".join(text) + "\n")
    made = launch("mesh", scratch / "kept.inp", "-o", scratch / "kept.h5")
    assert made.returncode == 0, made.stderr
    (scratch / "kept.yaml").write_text(CASE)
    return run(scratch / "kept.yaml")


def test_they_do_what_they_say(kept):
    history = kept.history
    time = history["time"]
    exact = rounding(1e-9, 1e-4)
    for column, theory in (("pull_force_z", 1e6 * AREA), ("gas_force_x", -2e6 * np.exp(-time / 1e-5) * AREA), ("push_force_x", 10), ("fall_force_z", -9.81 * DENSITY * (COUNT * CELL) ** 3),
                           ("rise_force_y", -1e5 * np.minimum(time / 1e-6, 1) * AREA)):
        bound = 1e-3 if column in ("gas_force_x", "rise_force_y") else exact  # these follow the surface
        assert np.abs(history[column] - theory).max() < bound * np.abs(theory).max(), column
    assert history["hold_force_z"][0] == pytest.approx(-(2e6 * AREA), rel=1e-2)  # both tractions, and the weight
    released = time >= 1e-6
    assert (history["hold_force_z"][released] == 0).all() and (history["hold_force_z"][~released] != 0).all() and released.any()
    assert kept.energy["radiated"][-1] > 0 and kept.summary["static_residual"] < rounding(1e-8, 1e-3) and kept.summary["first_fracture_time_s"] is None


def test_sensors_look_at_sets_of_elements_and_of_faces(kept):
    history = kept.history
    assert np.array_equal(history["low_uz_mean"], history["same_uz_mean"]) and history["low_uz_mean"][0] > 0
    assert history["end_uz_mean"][0] > 2 * history["low_uz_mean"][0]


def test_columns_are_named_after_what_acts(kept):
    for name in ("pull", "gas", "push", "fall", "rise", "roll", "hold"):
        for column in (*(f"{kind}_{axis}" for kind in ("force", "moment") for axis in "xyz"), "work"):
            assert f"{name}_{column}" in kept.history.dtype.names


PARTED = """
mesh: {file: kept.h5}
material: {model: linear-elastic, young: 70e9, poisson: 0.25, density: 2700}
materials: [{name: lower, set: low, model: linear-elastic, young: 70e9, poisson: 0.25, density: 5000}]
interface: {law: linear, strength: 1e12, energy: 1e9, sets: [{between: [lower, material], open: true}]}
initial: {velocity: {z: 1}, sets: [{set: low, velocity: {x: 3, z: -1}}]}
time: {end: 1, steps: 20}
output: {fields: [], interval: 10}
"""


def test_a_set_of_elements_that_moves_and_is_cut_off(kept, run, scratch):
    """Initial values by a named set of elements; faces between two materials are open: the halves part as two bodies."""
    path = scratch / "parted.yaml"
    path.write_text(PARTED)
    cut, glued = run(path), run(path, sets={"interface.sets": []})
    half, energy = (COUNT * CELL) ** 3 / 2, cut.energy
    assert energy["momentum_x"][0] == pytest.approx(3 * 5000 * half, rel=rounding(1e-12, 1e-5)) and energy["momentum_z"][0] == pytest.approx((2700 - 5000) * half, rel=rounding(1e-12, 1e-5))
    stored = energy["bulk"] + energy["penalty"]
    assert stored.max() < rounding(1e-20, 1e-8) * energy["kinetic"][0] and glued.energy["bulk"].max() > 0.01 * energy["kinetic"][0]
    assert run(path, sets={"interface.sets": [{"where": "abs(z - 1e-3) < 1e-9", "open": True}]}).summary["state_hash"] == cut.summary["state_hash"]
    assert "opening        of 4e-06 m2, 8 faces, from the start\n" in launch("check", path).stdout
    told = launch("check", path, "--set", "initial.sets=[{set: lo, velocity: {x: 1}}]")
    assert told.returncode == 2 and "initial.sets[0].set: lo: " in told.stderr and "low" in told.stderr


def test_check_tells_what_each_selects(kept, scratch):
    told = launch("check", scratch / "kept.yaml").stdout
    for line in ("load           traction on 4e-06 m2, 8 faces; (0, 0, 4) N at t = 0", "load           pressure on 4e-06 m2, 8 faces; (-8, 0, 0) N at t = 0",
                 "load           force on 4e-06 m2, 8 faces; (10, 0, 0) N at t = 0", "boundary       absorbing on 4e-06 m2, 8 faces", "boundary       normal on 4e-06 m2, 8 faces",
                 "sensor         low: 4e-09 m3, 24 elements", "sensor         end: 4e-06 m2, 8 faces", "boundary       hold: displacement along z on 4e-06 m2, 8 faces", "opening        of 2e-06 m2, 4 faces, from the start"):
        assert f"{line}\n" in told, line


NOTHING = "no face of the surface is in it, where: z > 7"


@pytest.mark.parametrize("change, message", [
    *((f"loads=[{{where: z > 7, {load}}}]", f"loads[0]: {NOTHING}") for load in ("traction: {z: 1}", "pressure: 1", "force: {x: 10}", "foundation: 1")),
    *((f"loads=[{{where: z > 7, {load}}}]", "loads[0]: no element is in it, where: z > 7") for load in ("acceleration: {z: 1}", "centrifugal: {speed: 1, axis: [0, 0, 1]}")),
    ("loads=[{cracks: true, where: z > 7, pressure: 1}]", "loads[0]: no face between elements is in it, where: z > 7"),
    *((f"boundary=[{{where: z > 7, {support}}}]", f"boundary[0]: {NOTHING}")
      for support in ("normal: 0", "absorbing: true", "dashpot: 3", "component: x, velocity: 0", "direction: [1, 1, 0], displacement: 0", "angle: t, axis: [0, 0, 1]")),
    ("interface.sets=[{where: z > 7, open: true}]", "interface.sets[0]: no face is in it, where: z > 7"),
    ("interface.sets=[{where: z > 7, open: true, at: 1}]", "interface.sets[0]: no face is in it, where: z > 7"),
    ("bodies=[{name: b, shape: none, motion: prescribed, at: [0, 0, 0], tied_where: z > 7}]", f"bodies[0]: {NOTHING}"),
    ("initial={sets: [{where: z > 7, velocity: {x: 1}}]}", "initial.sets[0]: no element is in it, or later sets have them all"),
    ("output={sensors: [{name: a, where: z > 7, values: [ux]}]}", "output.sensors[0]: no element is in it"),
    ("output={sensors: [{name: a, where: nz > 7, values: [ux]}]}", "output.sensors[0]: no face of the surface is in it, where: nz > 7"),
    ("output={crack_tips: [{name: a, direction: [1, 0, 0], where: z > 7}]}", "output.crack_tips[0]: no face between elements is in it, where: z > 7"),
    ("output={probes: [{name: a, at: [0, 0, 7]}]}", "output.probes[0].at[2]: 7: outside the box")])
def test_what_selects_nothing_is_refused(tmp_path, change, message):
    case = tmp_path / "nothing.yaml"
    case.write_text("mesh: {cells: [1, 1, 2], size: [1, 1, 2]}\nmaterial: {model: neo-hookean, young: 1, poisson: 0, density: 1}\n"
                    "interface: {law: linear, strength: 1, energy: 1}\ntime: {end: 1}\n")
    told = launch("check", case, "--set", change)
    assert told.returncode == 2 and message in told.stderr, told.stderr
