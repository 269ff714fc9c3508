"""The plate impact on a small plate: what rubble under a ball must keep, and the wave that reaches the back."""

import math

import numpy as np
import pytest
from conftest import CASES, SINGLE
from figures import ROUNDING
from test_parallel import assert_same_bits
from test_spall import passage

pytestmark = pytest.mark.skipif(SINGLE, reason="the ceramic needs double precision")

IMPACT = CASES / "impact.yaml"
SHEAR, POISSON, DENSITY = 146e9, 0.2, 3700.0
SPEED = math.sqrt(SHEAR * 2 * (1 - POISSON) / (1 - 2 * POISSON) / DENSITY)
BALL = 8000 * 4 / 3 * math.pi * 7.66e-3**3 * 300.0  # momentum (kg m/s)


@pytest.fixture(scope="module")
def impact(run):
    return run(IMPACT)


@pytest.mark.parametrize("ranks, threads", [(1, 2), (2, 1), (3, 1)])
def test_rubble_is_the_same_on_any_layout(run, impact, ranks, threads):
    assert impact.summary["failed_area_m2"] > 2e-3
    assert_same_bits(run(IMPACT, ranks=ranks, threads=threads), impact)


def test_ball_and_plate_keep_their_momentum(impact, figure):
    energy = impact.energy
    assert energy["momentum_z"][0] == pytest.approx(-BALL, rel=1e-12)
    figure("ball on a plate that breaks: change of linear momentum",
           max(np.ptp(energy[f"momentum_{axis}"]) for axis in "xyz") / BALL, bound=1e-14, why=ROUNDING)


def test_ledger_closes(impact, figure):
    figure("ball on a plate that breaks: energy error", impact.summary["energy_error_rel"], bound=1.5e-3)
    assert impact.summary["plastic_J"] > 0.05 and impact.summary["damage_J"] > 1


def test_cracks_are_their_own_mirror_image(run, figure):
    """Equal cubes, cut around parallel diagonals, are their own mirror image about x = y."""
    plate = run(IMPACT, sets={"mesh.jitter": 0, "time.end": 2e-6, "output.fields": ["crack"]})
    middle = plate.crack()["points"].mean(axis=1)
    assert len(middle) > 200 and np.ptp(middle[:, 0] - middle[:, 1]) > 8e-3
    apart = np.linalg.norm(middle[:, None, [1, 0, 2]] - middle[None], axis=2).min(axis=1)
    figure("ball on a plate of equal cubes: cracks apart from their mirror image", apart.max(), bound=5e-11, unit="m",
           why="rounding, and what rubble makes of it")


def test_wave_crosses_the_plate_at_the_dilatational_speed(run, figure):
    """Plane wave of a push, read at half of what the free back then moves at."""
    push, thickness = 1.0, 12e-3
    sides = [{"set": side, "component": side[0], "velocity": 0} for side in ("x-", "x+", "y-", "y+")]
    wave = run(IMPACT, sets={
        "mesh": {"cells": [1, 1, 24], "size": [0.5e-3, 0.5e-3, thickness], "origin": [0, 0, -thickness]},
        "bodies": [],
        "boundary": [*sides, {"set": "z+", "component": "z", "velocity": -push}],
        "time.end": 1.5e-6,
        "output": {"interval": 1e-7, "fields": [], "probes": [{"name": "back", "at": [0.25e-3, 0.25e-3, -thickness]}]},
    })
    history = wave.history
    figure("ceramic plate: passage of a plane wave", 1e6 * passage(history["time"], -history["back_vz"], push),
           theory=1e6 * thickness / SPEED, bound=0.03, unit="us", relative=True)
    figure("ceramic plate: speed at the back before the wave, of that after it",
           np.abs(history["back_vz"][history["time"] < 0.8 * thickness / SPEED]).max() / (2 * push), bound=3.5e-6)
