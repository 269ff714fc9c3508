"""Bulk viscosity: what it takes from a wave, its place in the ledger and in the time step, the same bits on any layout."""

import numpy as np
import pytest
from conftest import CASES
from test_parallel import assert_same_bits

BOTH = {"viscosity": {"linear": 0.06, "quadratic": 1.2}}
YOUNG, POISSON, DENSITY = 260e9, 0.21, 3690
SPEED = np.sqrt(YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON) * DENSITY))
EDGE, CELLS = 0.1e-3, 10
STANDING = {  # a standing wave of uniaxial strain along a bar of cubes
    "mesh": {"cells": [1, 1, CELLS], "size": [EDGE, EDGE, CELLS * EDGE]},
    "material": {"model": "neo-hookean", "young": YOUNG, "poisson": POISSON, "density": DENSITY},
    "initial": {"velocity": {"z": f"0.1*cos(pi*z/{CELLS * EDGE})"}},
    "boundary": [{"set": s + side, "component": s, "displacement": 0} for s in "xy" for side in "-+"],
    "time": {"end": 1e-6},
    "output": {"interval": 20, "fields": []},
}


def test_a_standing_wave_decays_as_in_a_viscous_solid(run, figure):
    """Viscosity b1 rho c h: the energy falls as exp(-b1 c h k^2 t); h of the six tetrahedra of a cube is edge/sqrt 2."""
    energy = run(CASES / "wave.yaml", sets={**STANDING, "viscosity": {"linear": 0.1}}).energy
    stored = sum(energy[name] for name in ("kinetic", "bulk", "penalty"))
    rate = 0.1 * SPEED * EDGE / np.sqrt(2) * (np.pi / (CELLS * EDGE)) ** 2
    half = energy["time"] >= 0.5 * energy["time"][-1]
    slope = np.polyfit(energy["time"][half], np.log(stored[half]), 1)[0]
    assert stored[-1] < 0.6 * stored[0]
    figure("standing wave, viscosity 0.1: decay of its energy", -1e-6 * slope, theory=1e-6 * rate, bound=0.0015,
           unit="1/us", relative=True)
    figure("standing wave, viscosity 0.1: energy error", np.abs(energy["error_rel"]).max(), bound=2.4e-4)


@pytest.mark.parametrize("linear, bound", [(0.3, 4e-4), (2.0, 4e-4)])
def test_the_step_leaves_room_for_the_damping(run, figure, linear, bound):
    sets = {**STANDING, "viscosity": {"linear": linear}, "time": {"end": 0.2e-6, "safety": 0.95}}
    damped, free = run(CASES / "wave.yaml", sets=sets), run(CASES / "wave.yaml", sets=STANDING)
    assert damped.summary["dt_critical"] < 0.7 * free.summary["dt_critical"]
    figure(f"standing wave, viscosity {linear}, at 95 % of the critical step: energy error",
           np.abs(damped.energy["error_rel"]).max(), bound=bound)


def test_ledger_of_a_collision(run, figure):
    sets = {**BOTH, "material": STANDING["material"], "time.end": 0.1e-6, "initial.velocity.z": "-200*tanh(z/0.1e-3)"}
    energy = run(CASES / "ceramic.yaml", sets=sets).energy
    assert energy["viscous"][-1] > 0.01 * energy["kinetic"][0] and (np.diff(energy["viscous"]) >= 0).all()
    figure("halves that collide, with viscosity: energy error", np.abs(energy["error_rel"]).max(), bound=1.6e-4)


def test_the_same_bits_on_any_layout(run):
    sets = {**BOTH, "material": STANDING["material"], "time.end": 3e-8, "initial.velocity.z": "-200*tanh(z/0.1e-3)",
            "output.fields": []}
    one = run(CASES / "ceramic.yaml", sets=sets)
    for ranks, threads in ((1, 2), (2, 1), (3, 1)):
        assert_same_bits(one, run(CASES / "ceramic.yaml", ranks=ranks, threads=threads, sets=sets))
