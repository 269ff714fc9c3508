"""Rigid bodies against the solid's surface: what must be conserved, and closed forms of contact."""

import math

import numpy as np
import pytest
from conftest import CASES, launch, overrides, rounding
from figures import ROUNDING
from test_spall import passage

YOUNG, NU, DENSITY = 260e9, 0.21, 3690.0
LAME, MU = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU))
SPEED = math.sqrt((LAME + 2 * MU) / DENSITY)  # of plane waves
LAYOUTS = [(1, 2), (2, 1), (3, 1)]  # ranks, threads; all compared with (1, 1)


# ---- a ball on a free block ----

BALL, BLOCK, FALL = 8000 * 4 / 3 * math.pi * 1e-9, DENSITY * 32e-9, 20.0  # kg, kg, m/s


@pytest.fixture(scope="module")
def bounce(run):
    return run(CASES / "bounce.yaml", sets={"interface.penalty": "isotropic"})


def test_momentum_is_handed_over_to_rounding(bounce, figure):
    energy, scale = bounce.energy, BALL * FALL
    assert energy["momentum_z"][0] == pytest.approx(-scale, rel=1e-12)
    assert max(bounce.history["ball_fz"]) > 100
    figure("sphere and block: change of linear momentum", max(np.ptp(energy[f"momentum_{axis}"]) for axis in "xyz") / scale,
           bound=rounding(7e-15, 1e-6), why=ROUNDING)


def test_angular_momentum_is_handed_over(bounce, figure):
    """A ball is pushed along lines through its centre only."""
    energy = bounce.energy
    figure("sphere and block, penalty isotropic: change of angular momentum, of momentum times radius",
           max(np.ptp(energy[f"angular_{axis}"]) for axis in "xyz") / (BALL * FALL * 1e-3), bound=rounding(4e-15, 1e-5),
           why=ROUNDING)


def test_energy_is_handed_over(bounce, figure):
    energy = bounce.energy
    assert energy["bodies"][0] == pytest.approx(0.5 * BALL * FALL**2, rel=1e-12)
    assert energy["contact"].max() > 0.1 * energy["bodies"][0] and energy["contact"][-1] == 0
    figure("sphere and block: energy error of the bounce", bounce.summary["energy_error_rel"], bound=1.8e-5)


def test_ball_bounces_as_from_a_rigid_block(bounce, figure):
    """The block's vibrations are over many times before the ball leaves, so they take little energy. It is hit 0.1 mm
    off its middle and turns."""
    inertia = BLOCK * (4e-3**2 + 2e-3**2) / 12
    block = 1 / (1 / BLOCK + 0.1e-3**2 / inertia)
    figure("sphere and block: speed after the bounce against that from a rigid block", bounce.history["ball_vz"][-1],
           theory=FALL * (block - BALL) / (block + BALL), bound=0.025, unit="m/s", relative=True)
    (body,) = bounce.summary["bodies"]
    assert body["name"] == "ball" and body["velocity"][2] == bounce.history["ball_vz"][-1]
    assert body["position"] == [bounce.history[f"ball_{axis}"][-1] for axis in "xyz"]


def test_force_moves_the_ball(bounce, figure):
    history = bounce.history
    impulse = np.sum(0.5 * (history["ball_fz"][1:] + history["ball_fz"][:-1]) * np.diff(history["time"]))
    figure("sphere: impulse of its force against its change of momentum", 1e6 * impulse,
           theory=1e6 * BALL * (history["ball_vz"][-1] + FALL), bound=rounding(5e-14, 1e-6), unit="uN s", relative=True,
           why=ROUNDING)


@pytest.mark.parametrize("name, sets, bound", [
    ("lumped mass", {"mass": "lumped"}, 1.2e-4),
    ("incomplete form", {"interface.form": "incomplete", "interface.beta_s": 40}, 9e-4)])
def test_other_discretizations_hand_over_momentum_and_energy(run, figure, name, sets, bound):
    other = run(CASES / "bounce.yaml", sets=sets)
    figure("sphere and block, other discretizations: change of linear momentum",
           np.ptp(other.energy["momentum_z"]) / (BALL * FALL), bound=rounding(7e-15, 1e-6), why=ROUNDING)
    figure(f"sphere and block, {name}: energy error of the bounce", other.summary["energy_error_rel"], bound=bound)


@pytest.mark.parametrize("name, change, bound", [
    ("penalty of 400", {"penalty": 400}, 1.5e-3), ("mass of 10 ug", {"mass": 1e-8}, 8e-3)])
def test_time_step_follows_stiff_contact_and_light_bodies(run, bounce, figure, name, change, bound):
    """Both would be unstable at the step of the solid alone."""
    ball = {"name": "ball", "shape": "sphere", "motion": "free", "at": [0.1e-3, 0, 1e-3], "radius": 1e-3,
            "mass": BALL, "velocity": {"z": -FALL}, **change}
    stiff = run(CASES / "bounce.yaml", sets={"bodies": [ball], "time.end": 1e-6})
    assert stiff.summary["dt_critical"] < 0.5 * bounce.summary["dt_critical"]
    figure(f"sphere and block, {name}: energy error", stiff.summary["energy_error_rel"], bound=bound)
    assert max(stiff.history["ball_fz"]) > 1


# ---- a plane wave ----

WALL = {"name": "wall", "motion": "prescribed", "velocity": {"z": -5}, "faces": ["z+"]}
WALLS = {
    "plane": {"shape": "plane", "at": [1, 1, 2e-3], "normal": [0, 0, -3]},
    "ball of 1 km": {"shape": "sphere", "at": [0.1e-3, 0.1e-3, 1e3 + 2e-3], "radius": 1e3},
    "cylinder of 1 km": {"shape": "cylinder", "at": [0, 0.1e-3, 1e3 + 2e-3], "radius": 1e3, "axis": [-2, 0, 0]},
}


@pytest.mark.parametrize("wall", WALLS)
def test_wall_sends_a_plane_wave(run, figure, wall):
    """Behind the front the stress is -rho c V, and so is the force per area on the wall. It rises as 1 - exp(-t/rise),
    since contact gives way like a spring of 4 (lambda + 2 mu)/h."""
    rise = 0.1e-3 / (4 * SPEED)
    push = run(CASES / "push.yaml", sets={"bodies": [{**WALL, **WALLS[wall]}]})
    history, stress = push.history, -DENSITY * SPEED * 5
    late = history["time"] > 0.1e-6
    figure("rigid wall pushes a bar: stress against rho c V", 1e-6 * history["p_szz"][late].mean(),
           theory=1e-6 * stress, bound=4e-4, unit="MPa", relative=True)
    figure("rigid wall pushes a bar: force on the wall against rho c V times the area", history["wall_fz"][late].mean(),
           theory=-stress * 0.04e-6, bound=8e-4, unit="N", relative=True)
    figure("rigid wall pushes a bar: force across, relative", abs(history["wall_fx"]).max() / abs(stress * 0.04e-6),
           bound=2.5e-9)
    figure("rigid wall pushes a bar: arrival", 1e6 * passage(history["time"], -history["p_szz"], -0.5 * stress),
           theory=1e6 * (0.5e-3 / SPEED + math.log(2) * rise), bound=0.02, unit="us", relative=True)
    figure("rigid wall pushes a bar: its work", 1e6 * push.energy["external_work"][-1],
           theory=-1e6 * stress * 0.04e-6 * 5 * (0.2e-6 - rise), bound=6e-4, unit="uJ", relative=True)
    figure("rigid wall pushes a bar: energy error", push.summary["energy_error_rel"], bound=2.5e-5)


# ---- Hertz ----


def layer_factor(chi):
    """Force on a sphere pressed into a layer that is bonded to its base, over that on a half-space; chi: contact radius
    over thickness (Dimitriadis et al., Biophysical Journal 82, 2002, equation 12)."""
    alpha = -(1.2876 - 1.4678 * NU + 1.3442 * NU**2) / (1 - NU)
    beta = (0.6387 - 1.0277 * NU + 1.5164 * NU**2) / (1 - NU)
    pi = math.pi
    return (1 - 2 * alpha / pi * chi + 4 * alpha**2 / pi**2 * chi**2
            - 8 / pi**3 * (alpha**3 + 4 * pi**2 / 15 * beta) * chi**3
            + 16 * alpha / pi**4 * (alpha**3 + 3 * pi**2 / 5 * beta) * chi**4)


def test_slow_ball_is_pressed_back_as_hertz_says(run, figure):
    """Contact radius 0.2 mm, elements of 0.12 mm."""
    hertz = run(CASES / "hertz.yaml", threads=2)
    radius, depth, thickness = 20e-3, 2e-6, 1.2e-3
    held = hertz.history[hertz.history["time"] > 0.8e-6]
    assert held["ball_z"] == pytest.approx(radius - depth, abs=1e-10)
    force = 4 / 3 * YOUNG / (1 - NU**2) * math.sqrt(radius) * depth**1.5
    force *= layer_factor(math.sqrt(radius * depth) / thickness)
    figure("sphere pressed into a layer: force against Hertz, for a layer", 4 * held["ball_fz"].mean(), theory=force,
           bound=0.03, unit="N", relative=True)  # a quarter of the layer
    figure("sphere pressed into a layer: swing of the force, relative",
           np.ptp(held["ball_fz"]) / held["ball_fz"].mean(), bound=0.1)


# ---- shapes ----


def test_cylinder_pushes_across_its_axis_alone(run, figure):
    """The mesh is the same when x and y change places, so the cylinder may lie along either."""
    def rolled(axis):
        body = {"name": "roll", "shape": "cylinder", "motion": "free", "at": [0, 0, 0.5e-3], "radius": 0.5e-3,
                "axis": axis, "mass": 4e-5, "velocity": {"z": -10}}
        return run(CASES / "bounce.yaml", sets={"mesh.jitter": 0, "bodies": [body], "time.end": 1e-6})

    along, across = rolled([3, 0, 0]).history, rolled([0, 0.1, 0]).history
    largest = along["roll_fz"].max()
    assert largest > 10
    assert abs(along["roll_fx"]).max() == 0
    apart = max(np.abs(along["roll_fz"] - across["roll_fz"]).max(), np.abs(along["roll_fy"] - across["roll_fx"]).max())
    figure("cylinder along x and along y: forces apart, of the largest", apart / largest, bound=rounding(1e-13, 1e-3),
           why=ROUNDING)


def test_block_between_two_walls_is_held(run, figure):
    """Two prescribed planes: the block moves with them."""
    walls = [{"name": name, "shape": "plane", "motion": "prescribed", "at": [0, 0, at], "normal": [0, 0, n],
              "velocity": {"z": "5*t/3e-6"}} for name, at, n in (("low", -2e-3, 1), ("high", 0, -1))]
    held = run(CASES / "bounce.yaml", sets={"bodies": walls})
    energy = held.energy
    figure("block between two walls: momentum against that at their speed", 1e3 * energy["momentum_z"][-1],
           theory=1e3 * BLOCK * 5, bound=0.1, unit="g m/s", relative=True)  # it swings between them
    impulse = [np.trapz(held.history[f"{name}_fz"], held.history["time"]) for name in ("low", "high")]
    figure("block between two walls: impulse of the walls against its momentum", -1e3 * sum(impulse),
           theory=1e3 * energy["momentum_z"][-1], bound=rounding(2e-14, 1e-6), unit="g m/s", relative=True, why=ROUNDING)
    assert energy["external_work"][-1] > 0.5 * energy["kinetic"][-1]
    figure("block between two walls: energy error at the end", energy["error_rel"][-1], bound=1.8e-6)


# ---- bodies that turn ----

HEAD = {"name": "head", "shape": "none", "motion": "free", "at": [1e-4, -2e-4, 4.4e-3], "mass": 4e-6, "tied": ["z+"],
        "inertia": [3e-12, 4e-12, 5e-12, 1e-13, -2e-13, 3e-13], "velocity": {"x": 3, "z": -2}, "spin": {"x": 37e3, "y": 7e3, "z": 1.1e4}}
FREE = {key: value for key, value in HEAD.items() if key != "tied"}
TUMBLING = {"mesh": {"cells": [2, 2, 8], "size": [1e-3, 1e-3, 4e-3], "origin": [-5e-4, -5e-4, 0], "jitter": 0.1},
            "material": {"model": "neo-hookean", "young": 2e9, "poisson": 0.3, "density": 1200},
            "interface": {"law": "none", "penalty": "isotropic"}, "bodies": [HEAD],
            "initial": {"velocity": {"x": 3, "z": -2}, "rotation": {"speed": 4e4, "axis": [1, 0.2, 0.3], "at": [0, 0, 4e-3]}},
            "time": {"end": 2e-5, "safety": 0.9}, "output": {"fields": [], "interval": 2e-7}}


def momenta(energy):
    """Largest changes of momentum and angular momentum, over the largest of each."""
    return [max(np.ptp(energy[f"{name}_{axis}"]) for axis in "xyz") / max(abs(energy[f"{name}_{axis}"]).max() for axis in "xyz")
            for name in ("momentum", "angular")]


@pytest.mark.parametrize("form, bound", [("variational", 2e-6), ("continuous", 1.2e-5)])
def test_a_head_tied_to_a_tumbling_bar(run, figure, form, bound):
    """Bar and head spin at speeds that do not fit, about axes that are none of the head's: they bend, and tumble by 50
    degrees."""
    interface = TUMBLING["interface"] if form == "variational" else {"law": "none", "form": form}
    tied = run(CASES / "bounce.yaml", sets={**TUMBLING, "interface": interface})
    energy, history = tied.energy, tied.history
    turned = 2 * math.degrees(math.acos(history["head_qw"][-1]))
    assert 40 < turned < 60 and energy["bodies"][-1] > 1.5 * energy["bodies"][0] and energy["bulk"].max() > 3e-3 * energy["kinetic"].max()
    linear, angular = momenta(energy)
    figure(f"tumbling bar with a head, {form}: change of linear momentum, relative", linear, bound=rounding(1e-14, 1e-5), why=ROUNDING)
    figure(f"tumbling bar with a head, {form}: change of angular momentum, relative", angular, bound=rounding(1e-14, 1e-5), why=ROUNDING)
    figure(f"tumbling bar with a head, {form}: energy error", tied.summary["energy_error_rel"], bound=bound)
    assert np.ptp(history["head_wy"]) > 2e3 and abs(history["head_my"]).max() > 1e-4


def test_a_head_that_is_let_go(run, figure):
    """Until then all is as with the tie, which here is chosen by its faces; from then on the head flies freely: its momentum
    and its angular momentum about its centre, which is attitude and spin, stay."""
    until = 0.8e-5
    tied = run(CASES / "bounce.yaml", sets=TUMBLING)
    free = run(CASES / "bounce.yaml", sets={**TUMBLING, "bodies": [{**FREE, "tied_where": "nz > 0.5", "tied_until": until}]})
    linear, angular = momenta(free.energy)
    figure("head that is let go: change of linear momentum, relative", linear, bound=rounding(1e-14, 1e-5), why=ROUNDING)
    figure("head that is let go: change of angular momentum, relative", angular, bound=rounding(1e-14, 1e-5), why=ROUNDING)
    figure("head that is let go: energy error", free.summary["energy_error_rel"], bound=2e-6)
    history, held = free.history, tied.history
    before = int((history["time"] < until).sum())
    assert 100 < before < len(history) - 100
    for name in ("head_vx", "head_wy", "head_qw", "head_mx"):
        assert np.array_equal(history[name][:before], held[name][:before]), name
    after = history[before + 1:]
    assert all(np.ptp(after[f"head_v{c}"]) == 0 and abs(after[f"head_f{c}"]).max() == abs(after[f"head_m{c}"]).max() == 0 for c in "xyz")
    assert np.ptp(held["head_vx"][before + 1:]) > 0.1 and np.ptp(after["head_wy"]) > 0


@pytest.mark.parametrize("form, bound", [("variational", 4e-6), ("continuous", 2e-5)])
def test_a_head_that_is_caught(run, figure, form, bound):
    """It flies freely beside a bar that tumbles, and is tied to its end where both then are: momenta stay, and the ledger holds what the kinetic energy falls by."""
    since = 0.4e-5
    interface = TUMBLING["interface"] if form == "variational" else {"law": "none", "form": form}
    caught = run(CASES / "bounce.yaml", sets={**TUMBLING, "interface": interface, "bodies": [{**HEAD, "tied_from": since}]})
    history, energy = caught.history, caught.energy
    linear, angular = momenta(energy)
    figure(f"head that is caught, {form}: change of linear momentum, relative", linear, bound=rounding(1e-14, 1e-5), why=ROUNDING)
    figure(f"head that is caught, {form}: change of angular momentum, relative", angular, bound=rounding(1e-14, 1e-5), why=ROUNDING)
    figure(f"head that is caught, {form}: energy error", caught.summary["energy_error_rel"], bound=bound)
    before, joined = history["time"] < since, energy["joined"]
    assert np.ptp(history["head_vx"][before]) == 0 and joined[energy["time"] < since].max() == 0 and np.ptp(history["head_vx"][~before]) > 1
    assert len(set(joined[energy["time"] >= since])) == 1 and joined[-1] > 3e-4 * energy["kinetic"][0]


def test_a_ball_that_sticks_while_it_is_pressed(run, figure):
    """To the face that it bounces off, in the middle of that: so its force counts in what goes."""
    ball = {"name": "ball", "shape": "sphere", "motion": "free", "at": [0.1e-3, 0, 1e-3], "radius": 1e-3, "density": 8000, "velocity": {"z": -20}}
    stuck = run(CASES / "bounce.yaml", sets={"interface.penalty": "isotropic", "bodies": [{**ball, "tied_where": "nz > 0.5 && abs(x) < 1.1e-3 && abs(y) < 1.1e-3", "tied_from": 4e-7}], "output.interval": 1e-8})
    linear, _ = momenta(stuck.energy)
    figure("ball that sticks: change of linear momentum, relative", linear, bound=rounding(1e-14, 1e-5), why=ROUNDING)
    figure("ball that sticks: energy error", stuck.summary["energy_error_rel"], bound=3e-5)
    assert stuck.energy["joined"][-1] > 0.01 * stuck.energy["bodies"][0]


@pytest.mark.parametrize("motion", ["free", "prescribed"])
def test_what_a_catch_takes(run, figure, motion):
    """Of a mass that moves along a bar at rest: m M/(m + M) V^2/2, M the mass of the nodes that it takes along; of one whose motion is prescribed M V^2/2."""
    same, apart, beside, across, edge, edges = 100, 10, 2.5, 10, 28.75, -6.875  # of the inverse mass of an element, times its mass: corners, edges
    inverse = [[same, apart, apart, beside, across, beside], [apart, same, apart, beside, beside, across], [apart, apart, same, across, beside, beside],
               [beside, beside, across, edge, edges, edges], [across, beside, beside, edges, edge, edges], [beside, across, beside, edges, edges, edge]]
    mass, end = 2e-6, 1200 * 1e-6 * 0.25e-3 / 3 * np.linalg.inv(inverse).sum()  # a third of the elements of the last cells have a face there
    body = {"name": "head", "shape": "none", "motion": motion, "at": [0, 0, 10.5e-3], "velocity": {"z": -1}, "tied": ["z+"], "tied_from": 1e-6}
    bar = run(CASES / "bounce.yaml", sets={
        **TUMBLING, "mesh": {"cells": [2, 2, 40], "size": [1e-3, 1e-3, 10e-3], "origin": [-5e-4, -5e-4, 0]}, "initial": {}, "time": {"end": 2e-6, "safety": 0.9},
        "material": {"model": "linear-elastic", "young": 2e9, "poisson": 0, "density": 1200}, "interface": {"law": "none"},
        "bodies": [{**body, **({"mass": mass, "inertia": [1e-12, 1e-12, 1e-12, 0, 0, 0]} if motion == "free" else {})}]})
    theory = 0.5 * (mass * end / (mass + end) if motion == "free" else end)
    figure(f"{motion} mass tied to a bar at rest: kinetic energy that goes", bar.energy["joined"][-1], theory=theory, bound=rounding(1e-11, 1e-5), unit="J", relative=True, why=ROUNDING)
    figure(f"{motion} mass tied to a bar at rest: energy error", bar.summary["energy_error_rel"], bound=2e-4)


def test_a_mass_tied_to_a_bar_is_slowed_as_in_theory(run, figure):
    """V exp(-rho c A t/m) while the wave is on its way; Poisson's ratio 0, so the bar does not bulge."""
    mass, speed, area = 2e-6, math.sqrt(2e9 / 1200), 1e-6
    material = {"model": "linear-elastic", "young": 2e9, "poisson": 0, "density": 1200}
    bar = run(CASES / "bounce.yaml", sets={
        **TUMBLING, "mesh": {"cells": [2, 2, 40], "size": [1e-3, 1e-3, 10e-3], "origin": [-5e-4, -5e-4, 0]}, "material": material,
        "interface": {"law": "none"}, "initial": {}, "time": {"end": 1.4e-5, "safety": 0.9},
        "bodies": [{**HEAD, "at": [0, 0, 10.5e-3], "mass": mass, "velocity": {"z": -1}, "spin": {}, "inertia": [1e-12, 1e-12, 1e-12, 0, 0, 0]}]})
    history = bar.history
    mass += 1200 * area * 0.25e-3 / 4  # of the nodes that are tied, with the consistent mass of the cells there
    expected = -np.exp(-1200 * speed * area / mass * history["time"])
    figure("mass tied to a bar: largest deviation from V exp(-rho c A t/m)", abs(history["head_vz"] - expected).max(), bound=0.03)
    figure("mass tied to a bar: energy error", bar.summary["energy_error_rel"], bound=1e-4)


def test_a_tie_to_a_body_that_spins_is_a_rigid_support(run, figure):
    """Of `boundary`, which prescribes the angle; so are the moments and the work of it."""
    hub = {"name": "hub", "shape": "none", "motion": "prescribed", "at": [0, 0, 0], "tied": ["z-"], "spin": {"y": "3e9*t"}, "velocity": {"z": "2e6*t"}}
    sets = {**TUMBLING, "initial": {}, "time": {"end": 4e-6, "safety": 0.9}, "output": {"fields": [], "interval": 1e-7, "probes": [{"name": "tip", "at": [1e-4, 0, 3.9e-3]}]}}
    tied = run(CASES / "bounce.yaml", sets={**sets, "bodies": [hub]})
    held = run(CASES / "bounce.yaml", sets={**sets, "bodies": [], "boundary": [
        {"name": "hub", "set": "z-", "angle": "1.5e9*t*t", "axis": [0, 1, 0], "translation": {"z": "1e6*t*t"}}]})
    a, b = tied.history, held.history
    for column in ("tip_ux", "tip_uz", "tip_vx"):
        figure(f"body that spins against a rigid support: {column}, relative", abs(a[column] - b[column]).max() / abs(b[column]).max(),
               bound=rounding(3e-11, 1e-4), why=ROUNDING)
    about = a["hub_my"] + a["hub_z"] * a["hub_fx"] - a["hub_x"] * a["hub_fz"]  # the origin, not the body
    figure("body that spins against a rigid support: moment, relative", abs(about + b["hub_moment_y"]).max() / abs(b["hub_moment_y"]).max(),
           bound=rounding(3e-11, 1e-4), why=ROUNDING)
    figure("body that spins against a rigid support: work, relative",
           abs(tied.energy["external_work"] - held.energy["external_work"]).max() / held.energy["external_work"].max(), bound=7e-5)


def test_a_plate_that_is_hit_beside_its_middle_turns(run, figure):
    """Momenta go over from block to plate, which leaves at an angle; a cylinder with its axis across tips."""
    plate = {"name": "plate", "shape": "plane", "motion": "free", "at": [1.5e-3, 0.5e-3, 0], "normal": [0, 0, -1], "mass": 1e-4,
             "inertia": [2e-10, 3e-10, 5e-10, 0, 0, 0], "velocity": {"z": -20}}
    rod = {"name": "rod", "shape": "cylinder", "motion": "free", "at": [0.8e-3, 0, -3e-3], "axis": [1, 0, 0], "radius": 1e-3, "length": 6e-3,
           "density": 8000, "velocity": {"z": 20}}
    hit = run(CASES / "bounce.yaml", sets={"bodies": [plate, rod], "interface.penalty": "isotropic"})
    linear, angular = momenta(hit.energy)
    figure("block between plate and rod: change of linear momentum, relative", linear, bound=rounding(1e-14, 1e-5), why=ROUNDING)
    figure("block between plate and rod: change of angular momentum, relative", angular, bound=rounding(1e-13, 1e-4), why=ROUNDING)
    figure("block between plate and rod: energy error", hit.summary["energy_error_rel"], bound=6e-4)
    assert abs(hit.history["plate_wy"][-1]) > 1e3 and abs(hit.history["rod_wy"][-1]) > 100


@pytest.mark.parametrize("sets, words", [
    ({"boundary": [{"set": "x-", "component": "x", "velocity": 0}]}, "elements with nodes that are tied to a body have others whose motion `boundary` prescribes"),
    ({"bodies": [{**HEAD, "tied_where": "nz > 2"}]}, "bodies[0]: no face of the surface is in it, where: nz > 2"),
    ({"bodies": [{**FREE, "shape": "sphere", "radius": 1e-3, "tied_until": 1e-6}]}, "bodies[0].tied_until: not used: nothing is tied to it"),
    ({"bodies": [{**FREE, "shape": "sphere", "radius": 1e-3, "tied_from": 1e-6}]}, "bodies[0].tied_from: not used: nothing is tied to it"),
    ({"bodies": [{**HEAD, "tied_from": 1e-6, "tied_until": 1e-6}]}, "bodies[0].tied_until: not after `tied_from`"),
    ({"bodies": [HEAD, {**HEAD, "name": "other", "tied": ["x-"]}]}, "elements with nodes that are tied to two bodies")])
def test_ties_that_contradict_are_refused(scratch, sets, words):
    process = launch("check", CASES / "bounce.yaml", *overrides({**TUMBLING, **sets}))
    assert process.returncode == 2 and words in process.stderr


def test_check_tells_what_turns():
    told = launch("check", CASES / "bounce.yaml", *overrides(TUMBLING)).stdout
    assert "body           head: 4e-06 kg, principal moments 2.894e-12, 4.081e-12, 5.025e-12 kg m2, tied to 1e-06 m2, 8 faces\n" in told
    told = launch("check", CASES / "bounce.yaml", *overrides({**TUMBLING, "bodies": [{**HEAD, "tied_from": 1e-6, "tied_until": 2e-6}]})).stdout
    assert "kg m2, tied to 1e-06 m2, 8 faces from 1e-06 s on until 2e-06 s\n" in told


# ---- the same bits on any layout ----

SHATTER = {  # a ball breaks the end of a bar
    "mesh": {"cells": [2, 2, 24], "size": [0.4e-3, 0.4e-3, 4.8e-3], "origin": [-0.2e-3, -0.2e-3, -4.8e-3], "jitter": 0.1},
    "interface": {"law": "linear", "strength": 400e6, "energy": 34},
    "bodies": [{"name": "ball", "shape": "sphere", "motion": "free", "at": [0.05e-3, 0, 0.5e-3], "radius": 0.5e-3,
                "density": 8000, "velocity": {"z": -100}},
               {"name": "floor", "shape": "plane", "motion": "prescribed", "at": [0, 0, -4.8e-3], "normal": [0, 0, 1],
                "velocity": {"z": "1e7*t"}, "faces": ["z-"]},
               {**HEAD, "name": "foot", "at": [1e-4, 0, -5e-3], "mass": 2e-6, "tied": ["z-"]}],
    "time": {"end": 0.4e-6}, "output": {"fields": ["crack", "rank"], "times": [0.4e-6], "interval": 1e-8},
}


@pytest.mark.parametrize("ranks, threads", LAYOUTS)
def test_same_bits_on_any_layout(run, ranks, threads):
    one = run(CASES / "bounce.yaml", sets=SHATTER)
    other = run(CASES / "bounce.yaml", ranks=ranks, threads=threads, sets=SHATTER)
    assert (other.summary["ranks"], other.summary["threads"]) == (ranks, threads)
    assert one.summary["broken_area_m2"] > 0 and max(one.history["ball_fz"]) > 50
    assert one.summary["state_hash"] == other.summary["state_hash"]
    assert one.summary["bodies"] == other.summary["bodies"]
    for name in ("energy.csv", "history.csv"):
        assert (one.dir / name).read_bytes() == (other.dir / name).read_bytes(), name


def test_some_rank_touches_nothing(run):
    """Of three ranks one at least has nothing of the end that the ball breaks."""
    three = run(CASES / "bounce.yaml", ranks=3, sets=SHATTER)
    (frame,) = three.frames()
    z = three.points()[:, 2].reshape(-1, 10)
    assert len(np.unique(frame["rank"])) == 3
    assert len(np.unique(frame["rank"].ravel()[z.max(axis=1) > -0.2e-3])) < 3


def test_hash_tells_bodies_apart(run):
    one = run(CASES / "bounce.yaml")
    far = [{"name": "ball", "shape": "sphere", "motion": "free", "at": [0.1e-3, 0, 1.0000001e-3], "radius": 1e-3,
            "density": 8000, "velocity": {"z": -20}}]
    assert run(CASES / "bounce.yaml", sets={"bodies": far}).summary["state_hash"] != one.summary["state_hash"]


# ---- output times, bad input ----


def test_fields_come_at_the_times_asked_for(run):
    times = [0, 0.31e-6, 0.777e-6, 1e-6]
    timed = run(CASES / "bounce.yaml", sets={"output.times": times, "output.fields": ["mean_stress"], "time.end": 1e-6})
    assert [frame["time"] for frame in timed.frames()] == pytest.approx(times, rel=1e-14)
    assert set(times) <= set(np.round(timed.energy["time"], 15))
    assert len(timed.energy) > 50


@pytest.mark.parametrize("ranks", [1, 2])
def test_body_inside_the_solid_is_refused(scratch, ranks):
    out = scratch / f"overlap-{ranks}"
    body = {"name": "ball", "shape": "sphere", "motion": "free", "at": [0, 0, 0.9e-3], "radius": 1e-3, "mass": 1}
    process = launch("run", CASES / "bounce.yaml", "-q", "-o", out, *overrides({"bodies": [body]}), ranks=ranks)
    assert process.returncode == 2
    assert "bodies[0].at: [0, 0, 0.0009]: ball overlaps the solid at the start, by 0.0001 m" in process.stderr
    assert process.stderr.count("overlaps") == 1
    assert not out.exists()
