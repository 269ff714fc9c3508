"""Solids that a prescribed temperature expands: free, held, suddenly heated, and the same bits on any layout."""

import numpy as np
import pytest
import rhegma
from conftest import SINGLE, example, launch, overrides
from figures import ROUNDING
from test_parallel import assert_same_bits

YOUNG, NU, DENSITY, EXPANSION = 70e9, 0.3, 2700, 23e-6
LAMBDA, MU = YOUNG * NU / (1 + NU) / (1 - 2 * NU), YOUNG / 2 / (1 + NU)
BULK, SPEED = LAMBDA + 2 * MU / 3, np.sqrt((LAMBDA + 2 * MU) / DENSITY)
SIZE = 1e-3
CUBE = {"mesh": {"cells": [2, 2, 2], "size": [SIZE, SIZE, SIZE], "jitter": 0.15},
        "material": {"model": "neo-hookean", "young": YOUNG, "poisson": NU, "density": DENSITY, "expansion": EXPANSION},
        "interface": {"law": "none"}, "temperature": {"value": 393, "free": 293}, "initial": {}, "output.energy_limit": 1e9,
        "time": {"end": 1e-9, "steps": 2}, "output.interval": 1, "output.fields": ["displacement", "stress"], "output.probes": []}
BAR = example("torn-bar.yaml")
RISE = 100 * EXPANSION  # of that cube


def rollers(sides="xyz", ends="-"):
    return [{"set": side + end, "component": side, "velocity": 0} for side in sides for end in ends]


def centroids(one):
    points, cells = rhegma.mesh(one.dir)
    return points[cells[:, :4]].mean(axis=1)[:, 2]


@pytest.mark.skipif(SINGLE, reason="a static start to rounding")
def test_a_free_cube_grows_without_stress(run, figure):
    frame = run(BAR, sets={**CUBE, "boundary": rollers(), "start": "static"})
    first, points = frame.frames()[0], frame.points()
    figure("heated cube, free: displacement against expansion, of the largest",
           np.abs(first["displacement"] / (RISE * SIZE) - points / SIZE).max(), bound=2.5e-9)
    figure("heated cube, free: stress, of 3K e", np.abs(first["stress"]).max() / (3 * BULK * RISE), bound=1.2e-9)


@pytest.mark.parametrize("model", ["neo-hookean", pytest.param("j2", marks=pytest.mark.skipif(SINGLE, reason="needs double precision"))])
def test_a_held_cube_is_pressed(run, figure, model):
    """By E e/(1 - 2 nu) to first order; exactly by the solid's own law at F/(1 + e)."""
    flows = {"yield_stress": 1e9} if model == "j2" else {}
    stress = run(BAR, sets={**CUBE, "material": {**CUBE["material"], "model": model, **flows}, "boundary": rollers("xyz", "-+")}).frames()[0]["stress"]
    grown = 1 + RISE
    exact = -3 * LAMBDA * np.log(grown) + MU * (grown**-2 - 1) if model == "neo-hookean" else -3 * BULK * np.log(grown)
    figure(f"heated cube, held, {model}: pressure over E e/(1 - 2 nu)", -stress[:, [0, 3, 5]].mean() / (YOUNG * RISE / (1 - 2 * NU)),
           theory=1, bound=3.4e-3)
    figure(f"heated cube, held, {model}: stress against its law, relative",
           max(np.abs(stress[:, [0, 3, 5]] / exact - 1).max(), np.abs(stress[:, [1, 2, 4]] / exact).max()), bound=1e-3 if SINGLE else 2e-12,
           why=ROUNDING)


def test_fields_show_the_temperature(run, figure):
    """Of a case without one beside it: means over the points of an element, at its centroid where it is linear."""
    sets = {**CUBE, "temperature": {"value": f"293 + 50*z/{SIZE} - 20*x/{SIZE} + 1e9*t", "free": 293}, "output.fields": ["temperature"]}
    one = run(BAR, sets=sets)
    points, cells = rhegma.mesh(one.dir)
    middle = points[cells[:, :4]].mean(axis=1) / SIZE
    apart = [np.abs(f["temperature"].ravel() - (293 + 50 * middle[:, 2] - 20 * middle[:, 0] + 1e9 * f["time"])).max() for f in one.frames()]
    figure("field of temperature against the case's expression", max(apart), bound=1e-3 if SINGLE else 1.7e-13, why=ROUNDING, unit="K")


@pytest.mark.skipif(SINGLE, reason="a static start to rounding")
def test_a_plate_between_walls(run, figure):
    """Heated in proportion to the depth, held along x and y, free across: sigma_x = -E e(z)/(1 - nu), nothing across."""
    sets = {**CUBE, "mesh": {"cells": [1, 1, 4], "size": [SIZE, SIZE, 4 * SIZE]}, "temperature": {"value": f"293 + 10*z/{SIZE}", "free": 293},
            "boundary": rollers("xy", "-+") + rollers("z"), "start": "static"}
    one = run(BAR, sets=sets)
    stress, depth = one.frames()[0]["stress"], centroids(one)
    theory = -YOUNG / (1 - NU) * EXPANSION * 10 * depth / SIZE
    figure("plate heated by its depth: stress along it, of the largest", np.abs(stress[:, 0] - theory).max() / np.abs(theory).max(), bound=3e-3)
    figure("plate heated by its depth: stress across, of the largest", np.abs(stress[:, 5]).max() / np.abs(theory).max(), bound=5e-7)


SHOCK = {**CUBE, "mesh": {"cells": [1, 1, 40], "size": [0.25e-3, 0.25e-3, 10e-3]}, "boundary": rollers("xy", "-+") + rollers("z"),
         "temperature": {"value": 303, "free": 293}, "time": {"end": 1.2e-6}, "output.fields": [], "output.interval": 1.2e-6,
         "output.probes": [{"name": "end", "at": [0.1e-3, 0.1e-3, 9.99e-3]}, {"name": "middle", "at": [0.1e-3, 0.1e-3, 5.1e-3]}]}


def test_thermal_shock(run, figure):
    """A plate that is hot at once, held at its sides: pressed by 3K e, till waves run in from its free face, behind which
    there is no stress and which move it at 3K e/(rho c)."""
    history = run(BAR, sets=SHOCK).history
    stress, time = 3 * BULK * 10 * EXPANSION, history["time"]
    outside = (time > 0.4e-6) & (time < 1.2e-6)
    figure("thermal shock: speed of the free face", history["end_vz"][outside].mean(), theory=stress / DENSITY / SPEED, bound=4e-3, unit="m/s",
           relative=True)
    before, arrival = (time > 0.1e-6) & (time < 0.6e-6), 4.9e-3 / SPEED
    figure("thermal shock: pressure before the wave", -1e-6 * history["middle_szz"][before].mean(), theory=1e-6 * stress, bound=5e-4, unit="MPa",
           relative=True)
    half = np.interp(0.5, -history["middle_szz"][::-1] / stress, time[::-1])
    figure("thermal shock: arrival of the wave", 1e6 * half, theory=1e6 * arrival, bound=0.012, unit="us", relative=True)


def test_ledger_of_heating(run, figure):
    """Heat that comes and goes does work on a plate, which is booked as work from outside."""
    sets = {**SHOCK, "temperature": {"value": "293 + 100*sin(pi*z/10e-3)*(1 - cos(2*pi*t/2e-6))", "free": 293}, "time": {"end": 2.4e-6}}
    energy = run(BAR, sets=sets).energy
    assert np.ptp(energy["external_work"]) > 0.5 * np.ptp(energy["bulk"])
    figure("heated plate: energy error", np.abs(energy["total"] - energy["total"][0]).max() / np.abs(energy["bulk"]).max(), bound=5e-7)


HOT = {"mesh.cells": [2, 2, 20], "mesh.jitter": 0.1, "time.end": 0.35e-6, "initial.velocity.z": "-40*cos(pi*z/4e-3)", "output.interval": 0.05e-6,
       "output.fields": [], "material.expansion": 2e-5, "temperature.value": "293 + 40*cos(pi*x/0.2e-3)*sin(2*pi*t/0.3e-6) + 1e4*z",
       "output.probes": [{"name": "a", "at": [0.11e-3, 0.13e-3, 1.9e-3]}]}


@pytest.mark.parametrize("ranks, threads", [(1, 2), (2, 1), (3, 1)])
def test_a_hot_bar_is_the_same_on_any_layout(run, ranks, threads):
    one, other = run(BAR, sets=HOT), run(BAR, ranks=ranks, threads=threads, sets=HOT)
    assert one.summary["broken_area_m2"] > 0 and one.energy["external_work"][-1] != 0
    assert_same_bits(one, other)


FRONT = {"name": "f", "at": [0, 0, 0], "direction": [1, 0, 0], "normal": [0, 0, 1], "radius": {"inner": 1e-4, "outer": 3e-4}, "values": ["J"]}


@pytest.mark.parametrize("change, message", [
    ({"temperature": {"value": 393}}, "temperature.value: has no use: no material has an expansion"),
    ({"temperature": {"value": 393}, "material.expansion": EXPANSION, "output.crack_fronts": [FRONT]},
     "temperature.value: not with output.crack_fronts: the energy that a crack sets free is not known in a field of temperature"),
    ({"material.expansion": EXPANSION, "materials": [{"name": "other", "where": "z > 0", "model": "neo-hookean", "young": YOUNG, "poisson": NU, "density": DENSITY}],
      "temperature": {"value": 393}}, None)])
def test_temperatures_that_are_refused(change, message):
    told = launch("check", BAR, *overrides(change))
    assert (told.returncode, message is None) in ((2, False), (0, True)) and (message or "") in told.stderr, told.stderr
