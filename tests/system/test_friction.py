"""sliding.yaml: a block slides on another one, to which it is pressed, until Coulomb friction has stopped it."""

import types

import numpy as np
import pytest
from conftest import CASES, launch

MODULUS, DENSITY, COEFFICIENT = 260e9, 3690, 0.3
EDGE, HEIGHT, AREA, APPROACH = 0.05e-3, 0.1e-3, 0.04e-6, 8e-9  # m, m, m2, m
PRESSURE = MODULUS * APPROACH / (2 * HEIGHT + EDGE / 2)  # the contact gives way too: its stiffness is 2 E/h
SLOWING = COEFFICIENT * PRESSURE / (DENSITY * HEIGHT)  # m/s2
PRESSED = 0.15e-6  # s: from here on


def table(run):
    """Of the times at which the two blocks are fragments: velocity and place of the upper one, those of the other,
    energy dissipated by friction."""
    rows = run.fragments
    rows = rows[rows["elements"] < rows["elements"].max()] if len(set(rows["elements"])) > 1 else rows
    upper, lower = rows[rows["centroid_z"] > 0], rows[rows["centroid_z"] < 0]
    late = upper["time"] > PRESSED
    upper, lower = upper[late], lower[late]
    heat = np.interp(upper["time"], run.energy["time"], run.energy["friction"])
    return types.SimpleNamespace(time=upper["time"], velocity=upper["momentum_x"] / upper["mass"],
                                 relative=upper["momentum_x"] / upper["mass"] - lower["momentum_x"] / lower["mass"],
                                 slip=upper["centroid_x"] - lower["centroid_x"], heat=heat)


@pytest.fixture(scope="module")
def slide(run):
    return run(CASES / "sliding.yaml")


def test_block_slows_down_as_coulomb_says(slide, figure):
    blocks = table(slide)
    sliding = blocks.relative > 0.3
    assert sliding.sum() > 30
    slowing = -np.polyfit(blocks.time[sliding], blocks.velocity[sliding], 1)[0]
    figure("sliding block: deceleration against mu p/(rho h)", 1e-6 * slowing, theory=1e-6 * SLOWING, bound=0.003,
           unit="Mm/s2", relative=True)


def test_block_stops_after_the_stopping_distance(slide, figure):
    blocks = table(slide)
    distance = blocks.slip[-1] - blocks.slip[0]
    figure("sliding block: stopping distance", 1e6 * distance, theory=1e6 * blocks.velocity[0] ** 2 / (2 * SLOWING),
           bound=0.0018, unit="um", relative=True)
    figure("sliding block: motion at rest, of the distance", np.ptp(blocks.slip[-20:]) / distance, bound=0.024)


def test_heat_is_friction_times_slip(slide, figure):
    blocks = table(slide)
    last = np.flatnonzero(blocks.relative > 0.3)[-1]
    slip, heat = blocks.slip[last] - blocks.slip[0], blocks.heat[last] - blocks.heat[0]
    figure("sliding block: heat against mu N times slip", 1e9 * heat, theory=1e9 * COEFFICIENT * PRESSURE * AREA * slip,
           bound=0.015, unit="nJ", relative=True)
    assert slide.summary["friction_J"] == slide.energy["friction"][-1]


def test_ledger_closes(slide, figure):
    figure("sliding block: energy error", slide.summary["energy_error_rel"], bound=2.5e-5)
    assert (np.diff(slide.energy["friction"]) >= 0).all()
    work = abs(slide.energy["external_work"][0] - slide.energy["total"][0])
    assert slide.energy["friction"][-1] > 0.3 * work


def test_no_friction_no_slowing(run, figure):
    free = run(CASES / "sliding.yaml", sets={"interface.friction": 0})
    blocks = table(free)
    figure("block without friction: change of its speed, relative", np.ptp(blocks.velocity) / blocks.velocity[0], bound=2e-5)
    assert not free.energy["friction"].any()


def test_block_slides_on_a_penalty_as_on_a_potential(run, figure):
    """By 0.7 % of an edge, so that little fades; tests/unit/kernels/test_friction.c has what does."""
    slide = run(CASES / "sliding.yaml", sets={"interface.contact": "penalty"})
    blocks = table(slide)
    sliding = blocks.relative > 0.3
    slowing = -np.polyfit(blocks.time[sliding], blocks.velocity[sliding], 1)[0]
    figure("block on a penalty: deceleration against mu p/(rho h)", 1e-6 * slowing, theory=1e-6 * SLOWING, bound=0.003,
           unit="Mm/s2", relative=True)
    figure("block on a penalty: energy error", slide.summary["energy_error_rel"], bound=1.5e-4)
    assert abs(blocks.relative[-1]) < 0.1 * blocks.relative[0]  # it sticks, and swings


def shaken(run, share, **more):
    """The lower wall, at rest while it presses, then pushes with a share of what friction can pass on; a jolt of
    1 mm/s breaks the faces first."""
    push = share * SLOWING
    boundary = [{"set": "z-", "component": "x",
                 "velocity": f"t < 1e-8 ? 1e-3 : (t < {PRESSED} ? 0 : {push}*(t - {PRESSED}))"},
                {"set": "z-", "component": "z",
                 "velocity": f"t < {PRESSED} ? {APPROACH / PRESSED}*(1 - cos(2*pi*t/{PRESSED})) : 0"},
                {"set": "z+", "component": "z", "velocity": 0}]
    return run(CASES / "sliding.yaml", sets={"initial.velocity.x": 0, "boundary": boundary, **more})


def test_block_sticks_below_the_limit(run, figure):
    """Waves double the push at most. A sticking point gives way by traction over stiffness, 4 mu/h."""
    stuck = shaken(run, 0.2)
    blocks = table(stuck)
    late = stuck.energy["time"] > 1.02 * PRESSED
    assert stuck.summary["broken_area_m2"] == pytest.approx(AREA, rel=1e-12)
    assert late.sum() > 50 and np.ptp(stuck.energy["friction"][late]) == 0
    assert blocks.velocity[-1] > 0.8 * 0.2 * SLOWING * (blocks.time[-1] - PRESSED)
    give = 0.2 * COEFFICIENT * PRESSURE * (EDGE / (2 * MODULUS) + HEIGHT / MODULUS * 2)
    figure("block that sticks: slip, of what its elements give way at rest", np.ptp(blocks.slip) / give, bound=6)


def test_time_step_covers_sticking(slide, run, figure):
    """At 98 % of the critical step a block that sticks stays in order for 1700 steps; faces that stick lower it."""
    near = shaken(run, 0.2, **{"time.safety": 0.98, "time.end": 1.2e-6, "interface.friction": 1})
    free = run(CASES / "sliding.yaml", sets={"interface.friction": 0})
    assert near.summary["dt_critical"] < free.summary["dt_critical"]
    figure("block that sticks, at 98 % of the critical step: energy error", near.summary["energy_error_rel"], bound=4e-6)
    assert near.energy["friction"][-1] < 1e-9 * near.summary["energy_largest_J"]


def test_block_slips_above_it(run, figure):
    """The lower wall runs away; the upper block follows with what friction gives."""
    slipped = shaken(run, 3)
    blocks = table(slipped)
    far = blocks.time > PRESSED + 5e-8
    figure("block that is dragged along: acceleration against mu p/(rho h)",
           1e-6 * np.polyfit(blocks.time[far], blocks.velocity[far], 1)[0], theory=1e-6 * SLOWING, bound=0.006,
           unit="Mm/s2", relative=True)
    assert slipped.energy["friction"][-1] > 0


PRESSED_BY, SHEAR_STRENGTH, SHEAR_RATE = 80e6, 60e6, 1600  # Pa, Pa, 1/s


def test_block_under_pressure_breaks_where_mohr_and_coulomb_say(run, figure):
    """A block in uniform pressure, uniformly sheared by its sides, whose middle plane alone can break."""
    sides = [{"set": f"{c}{sign}", "component": k, "displacement": u} for c in "xyz" for sign in "-+"
             for k, u in (("x", f"{SHEAR_RATE}*t*z"), ("y", 0), ("z", f"-{PRESSED_BY / MODULUS}*z"))]
    block = run(CASES / "sliding.yaml", sets={
        "mesh.cells": [2, 2, 2], "boundary": sides, "initial": {"displacement": {"z": f"-{PRESSED_BY / MODULUS}*z"}, "velocity": {"x": f"{SHEAR_RATE}*z"}},
        "interface": {"law": "linear", "strength": SHEAR_STRENGTH / 1.5, "energy": 1e-3, "beta": 1.5, "activation": "conserving", "onset": 0.3, "beta_s": 4,
                      "contact": "potential", "friction": 0.6, "criterion": "mohr-coulomb", "sets": [{"where": "abs(z) > 1e-6", "law": "none"}]},
        "time": {"end": 0.8e-6, "safety": 0.5}})
    shear = SHEAR_STRENGTH + 0.6 * PRESSED_BY
    figure("block under pressure: shear at which it breaks", block.summary["first_fracture_time_s"] * SHEAR_RATE * MODULUS / 2e6,
           theory=shear / 1e6, bound=0.0016, unit="MPa", relative=True)
    figure("block under pressure: energy error over what was dissipated", block.summary["energy_error_dissipated"], bound=0.0026)
    assert block.summary["friction_J"] > 0


def test_friction_needs_faces_that_slide(tmp_path):
    process = launch("run", CASES / "sliding.yaml", "-q", "-o", tmp_path / "out", "--set", "interface.contact=flux")
    assert process.returncode == 2
    assert "sliding.yaml" in process.stderr and "interface.friction: 0.3" in process.stderr
