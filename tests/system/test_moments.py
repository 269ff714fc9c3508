"""Values at the moments that they are said to be of: prescribed motions against the closed form of the central difference,
fields, history and energies against what was prescribed, each at its own time."""

import numpy as np
import pytest
from conftest import example, rounding
from figures import ROUNDING

YOUNG, POISSON, DENSITY, EDGE = 260e9, 0.21, 3690.0, 0.1e-3
LAMBDA, MU = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), YOUNG / (2 * (1 + POISSON))
RATE = 2e7  # 1/s, of the motions: 80 steps to a period
BOX = {"mesh": {"cells": [2, 1, 1], "size": [2 * EDGE, EDGE, EDGE]}, "interface": {"law": "none"}, "initial.velocity": {},
       "material": {"model": "linear-elastic", "young": YOUNG, "poisson": POISSON, "density": DENSITY},
       "output": {"interval": 7, "energy_limit": 1e9, "fields": ["displacement", "velocity", "stress"],
                  "probes": [{"name": "top", "at": [1.7 * EDGE, 0.2 * EDGE, EDGE]},
                             {"name": "left", "at": [0, 0.8 * EDGE, 0.3 * EDGE]}]}}

# ---- Prescribed motions ----

BODY = {"name": "wall", "shape": "plane", "motion": "prescribed", "at": [0, 0, 3 * EDGE], "normal": [0, 0, -1],
        "velocity": {"x": f"2*sin({RATE}*t)", "z": "3 + 1e7*t"}}  # touches nothing


def height(x):
    return 1 + 1e3 * x


def on_side(points, axis, at):
    """Nodes of the elements that have a face on this side."""
    on = np.abs(points[:, axis] - at).reshape(-1, 10) < 1e-9 * EDGE
    return (on & (on.sum(axis=1) == 6)[:, None]).ravel()


@pytest.fixture(scope="module")
def moved(run):
    """The top moves up and down, the left side as a displacement; a wall that touches nothing moves too."""
    boundary = [{"set": "z+", "component": "z", "velocity": f"3*sin({RATE}*t)*(1 + 1e3*x)"},
                {"set": "x-", "component": "x", "displacement": f"1e-8*(1 - cos({RATE}*t))"}]
    return run(example("torn-bar.yaml"), sets={**BOX, "boundary": boundary, "bodies": [BODY], "mass": "lumped", "time.end": 1,
                                              "time.steps": 200})


def steps(moved):
    """Times, and the size of the steps, all but equal."""
    time = moved.history["time"]
    dt = np.diff(time)
    assert len(time) == 201 and np.ptp(dt) < 1e-9 * dt[0]
    return time, time[-1] / 200


def summed_sine(time, dt):
    """Sum of dt sin(RATE t) over the middles of the steps so far."""
    return dt * np.sin(RATE * time / 2) ** 2 / np.sin(RATE * dt / 2)


def test_prescribed_velocity_acts_in_the_middle_of_each_step(moved, figure):
    time, dt = steps(moved)
    scale = 3 * height(1.7 * EDGE)
    place = scale * summed_sine(time, dt)
    figure("prescribed velocity: displacement against the sum over the middles of the steps, of the largest",
           np.abs(moved.history["top_uz"] - place).max() / place.max(), bound=rounding(6e-15, 1e-6), why=ROUNDING)
    figure("prescribed velocity: velocity at the step, of the largest",
           np.abs(moved.history["top_vz"] - scale * np.sin(RATE * time)).max() / scale, bound=rounding(1.5e-15, 2e-7),
           why=ROUNDING)


def test_prescribed_displacement_is_that_of_the_step(moved, figure):
    time, dt = steps(moved)
    place = 1e-8 * (1 - np.cos(RATE * time))
    speed = 1e-8 * np.sin(RATE * time) * 2 * np.sin(RATE * dt / 2) / dt  # from half a step before to half a step after
    figure("prescribed displacement: displacement, of the largest",
           np.abs(moved.history["left_ux"] - place).max() / place.max(), bound=rounding(1.5e-15, 2e-7), why=ROUNDING)
    figure("prescribed displacement: velocity at the step, of the largest",
           np.abs(moved.history["left_vx"] - speed).max() / np.abs(speed).max(), bound=rounding(3e-13, 2e-7), why=ROUNDING)


def test_body_moves_by_its_velocity_in_the_middle_of_each_step(moved, figure):
    time, dt = steps(moved)
    history = moved.history
    figure("prescribed body: place against the sum over the middles of the steps, of the way",
           max(np.abs(history["wall_x"] - 2 * summed_sine(time, dt)).max() / np.ptp(history["wall_x"]),
               np.abs(history["wall_z"] - 3 * EDGE - (3 * time + 0.5e7 * time**2)).max() / np.ptp(history["wall_z"])),
           bound=5e-13, why=ROUNDING)
    figure("prescribed body: velocity at the step, of the largest",
           max(np.abs(history["wall_vx"] - 2 * np.sin(RATE * time)).max() / 2,
               np.abs(history["wall_vz"] - 3 - 1e7 * time).max() / history["wall_vz"].max()), bound=1e-15, why=ROUNDING)


# ---- Outputs of the same moments ----


def test_fields_are_those_of_the_prescribed_motion(moved, figure):
    _, dt = steps(moved)
    points = moved.points()
    top, left = on_side(points, 2, EDGE), on_side(points, 0, 0)
    worst = 0
    frames = moved.frames()
    assert len(frames) == 30 and top.sum() == 4 * 6 and left.sum() == 2 * 6
    for frame in frames:
        time, scale = frame["time"], 3 * height(points[top, 0])
        place, speed = scale * summed_sine(time, dt), scale * np.sin(RATE * time)
        aside = 1e-8 * (1 - np.cos(RATE * time))
        worst = max(worst, np.abs(frame["displacement"][top, 2] - place).max() / 5e-7,
                    np.abs(frame["velocity"][top, 2] - speed).max() / 3,
                    np.abs(frame["displacement"][left, 0] - aside).max() / 2e-8)
    figure("fields of prescribed motions at their times, of the largest", worst, bound=rounding(5e-15, 7e-7), why=ROUNDING)


def test_history_has_the_fields_of_the_same_step(run, figure):
    """At a corner, which is a node, of a body that is shaken."""
    at = [2 * EDGE, EDGE, EDGE]
    shaken = run(example("torn-bar.yaml"), sets={
        **BOX, "boundary": [{"set": "z-", "component": "z", "velocity": f"3*sin({RATE}*t)"}],
        "time.end": 1, "time.steps": 50, "output": {**BOX["output"], "probes": [{"name": "corner", "at": at}]}})
    node = np.flatnonzero(np.abs(shaken.points() - at).max(axis=1) < 1e-9 * EDGE)
    worst = 0
    for frame in shaken.frames():
        (row,) = shaken.history[shaken.history["time"] == frame["time"]]
        for field, column in (("displacement", "u"), ("velocity", "v")):
            seen = np.array([row[f"corner_{column}{axis}"] for axis in "xyz"])
            scale = np.abs(shaken.history[f"corner_{column}z"]).max()
            worst = max(worst, np.abs(frame[field][node] - seen).max(axis=1).min() / scale)
    figure("history against the fields of the same step, of the largest", worst, bound=rounding(1e-15, 1e-7), why=ROUNDING)


def test_energy_has_the_velocities_of_the_same_step(moved, figure):
    """Kinetic energy and momentum of the lumped mass: rho V/36 at corners, 4 rho V/27 on mid-edges."""
    mass = DENSITY * EDGE**3 / 6 * np.tile([1 / 36] * 4 + [4 / 27] * 6, 12)
    energy, worst = moved.energy, 0
    for frame in moved.frames():
        row = energy[energy["time"] == frame["time"]]
        assert len(row) == 1
        kinetic = 0.5 * np.sum(mass[:, None] * frame["velocity"] ** 2)
        momentum = mass @ frame["velocity"][:, 2]
        worst = max(worst, abs(row["kinetic"][0] - kinetic) / energy["kinetic"].max(),
                    abs(row["momentum_z"][0] - momentum) / np.abs(energy["momentum_z"]).max())
    figure("kinetic energy and momentum against the velocities of the same frame, of the largest", worst,
           bound=rounding(3e-15, 1.2e-7), why=ROUNDING)


# ---- A state that is known at all times ----


def test_stress_energy_and_work_are_those_of_their_time(run, figure):
    """All sides move so that F = I + t L: no waves, and energies that grow with the square of time."""
    rate = np.array([[2e4, 1e4, 0], [-3e4, 1e4, 5e3], [4e3, 0, -1e4]])
    motion = {axis: "+".join(f"({value!r})*{name}" for value, name in zip(row, "xyz"))
              for axis, row in zip("xyz", rate.tolist())}
    boundary = [{"set": axis + side, "component": c, "velocity": motion[c]}
                for axis in "xyz" for side in "-+" for c in "xyz"]
    still = run(example("torn-bar.yaml"), sets={**BOX, "boundary": boundary, "initial.velocity": motion, "time.end": 1,
                                               "time.steps": 100})
    strain = (rate + rate.T) / 2  # per second
    growth = LAMBDA * np.trace(strain) * np.eye(3) + 2 * MU * strain
    volume = 2 * EDGE**3
    energy, last = still.energy, still.history[-1]
    time = energy["time"]
    assert len(time) == 16
    stored = volume * np.tensordot(growth, strain) / 2 * time**2
    figure("homogeneous strain: energy stored at its time, of the largest",
           np.abs(energy["bulk"] - stored).max() / stored[-1], bound=rounding(1.5e-14, 5e-6), why=ROUNDING)
    figure("homogeneous strain: work of the sides at its time, of the largest",
           np.abs(energy["external_work"] - stored).max() / stored[-1], bound=rounding(1.5e-14, 3e-7), why=ROUNDING)
    worst = 0
    for frame in still.frames():
        F = np.eye(3) + frame["time"] * rate
        cauchy = frame["time"] * growth @ F.T / np.linalg.det(F)
        worst = max(worst, np.abs(frame["stress"] - cauchy[np.triu_indices(3)]).max())
    F = np.eye(3) + last["time"] * rate
    cauchy = last["time"] * growth @ F.T / np.linalg.det(F)
    worst = max(worst, abs(last["top_szz"] - cauchy[2, 2]), abs(last["top_sxz"] - cauchy[0, 2]))
    figure("homogeneous strain: stress in fields and history at its time, of the largest", worst / np.abs(cauchy).max(),
           bound=rounding(3.5e-14, 2e-5), why=ROUNDING)
