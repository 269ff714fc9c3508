"""Sides: the forces that hold them, and waves that leave by them. Bits on any layout and restarts: test_parallel.py,
test_restart.py."""

import numpy as np
import pytest
from conftest import CASES, example, launch, rounding
from figures import ROUNDING

LOADS = CASES / "loads.yaml"
NAMES = ("hold", "pull", "press", "push", "fall")

# ---- Reactions ----


@pytest.fixture(scope="module")
def held(run):
    return run(LOADS, sets={"time.steps": 1000, "output.interval": 50})


def test_momentum_is_what_forces_and_reactions_gave(held, figure):
    energy, history = held.energy, held.history
    step = np.diff(history["time"])
    kick = np.concatenate([[step[0] / 2], (step[1:] + step[:-1]) / 2, [step[-1] / 2]])
    at = energy["step"].astype(int)
    for axis in "xyz":
        force = sum(history[f"{name}_force_{axis}"] for name in NAMES)
        gained = np.cumsum(force * kick) - force * np.concatenate([step / 2, [0]])
        error = np.abs(gained[at] - energy[f"momentum_{axis}"]).max() / np.abs(energy[f"momentum_{axis}"]).max()
        figure(f"momentum along {axis} against the sum of forces", error, bound=rounding(5e-9 if axis == "x" else 5e-14, 3e-5),
               why="rounding; along x at times of output the nodes of a support have just what is prescribed")
    assert np.abs(history["hold_force_x"]).max() > 1 and not history["hold_force_y"].any()


def test_work_of_all_is_the_external_work(held, figure):
    history, energy = held.history, held.energy
    work = sum(history[f"{name}_work"] for name in NAMES)[energy["step"].astype(int)]
    scale = np.abs(history["hold_work"]).max()
    assert scale > 1e-8
    figure("works of loads and supports against the external work, over that of the support",
           np.abs(work - energy["external_work"]).max() / scale, bound=5e-5)


# ---- Absorbing sides ----

YOUNG, POISSON, DENSITY, CELL = 200e9, 0.25, 8000.0, 1e-4


def absorb(run, wave, cells, form="variational", mass="consistent", absorbing=True, dashpot=None):
    """A pulse sin^2 of so many cells, in a column of three times as many whose end absorbs; a dashpot over rho c in place of that."""
    lame, shear = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON), YOUNG / 2 / (1 + POISSON)
    speed = np.sqrt((lame + 2 * shear) / DENSITY if wave == "P" else shear / DENSITY)
    length, pulse = 3 * cells * CELL, cells * CELL
    begin = length - 2.5 * pulse
    axis = "z" if wave == "P" else "x"
    phase, inside = f"pi*(z - {begin})/{pulse}", f"z > {begin} && z < {begin + pulse}"
    velocity = f"{inside} ? sin({phase})^2 : 0"
    whole = pulse / 2 / speed
    way = f"z < {begin} ? {whole} : z > {begin + pulse} ? 0 : {whole} - ((z - {begin})/2 - {pulse}/(4*pi)*sin(2*{phase}))/{speed}"
    side = {"set": "z+", "absorbing": True} if dashpot is None else {"set": "z+", "dashpot": dashpot * DENSITY * speed}
    held = {"P": [("x", "x"), ("y", "y")], "S": [("x", "z"), ("y", "z"), ("y", "y")]}[wave]
    boundary = [{"set": side + end, "component": component, "velocity": 0} for side, component in held for end in "-+"]
    law = {"law": "none", "form": form, **({"beta_s": 2} if form != "continuous" else {})}
    sets = {"mesh": {"cells": [1, 1, 3 * cells], "size": [CELL, CELL, length]}, "mass": mass, "interface": law,
            "material": {"model": "linear-elastic", "young": YOUNG, "poisson": POISSON, "density": DENSITY},
            "boundary": [*boundary, *([side] if absorbing else [])],
            "initial": {"velocity": {axis: velocity}, "displacement": {axis: way}}, "time": {"end": 3 * pulse / speed, "safety": 0.9},
            "output": {"fields": [], "probes": [{"name": "p", "at": [CELL / 3, CELL / 3, length - pulse]}]}}
    done = run(example("spall.yaml"), sets=sets)
    time, signal = done.history["time"], np.abs(done.history[f"p_v{axis}"])
    left = signal[time > 1.8 * pulse / speed].max()  # the pulse has passed the probe; what comes back has not yet
    return done, left / signal.max()


@pytest.mark.parametrize("wave, cells, form, mass, bound", [
    ("P", 10, "variational", "consistent", 0.008), ("S", 10, "variational", "consistent", 0.009), ("P", 20, "variational", "scaled", 0.0025),
    # the lumped mass leaves a wake of its own behind the pulse
    ("P", 20, "variational", "lumped", 0.009), ("S", 20, "continuous", "lumped", 0.006)])
def test_a_plane_wave_leaves(run, figure, wave, cells, form, mass, bound):
    done, left = absorb(run, wave, cells, form, mass)
    what = f"{wave} wave of {cells} elements, form {form}, mass {mass}"
    figure(f"{what}: left of its amplitude by an absorbing side", left, bound=bound)
    energy = done.energy
    error = np.abs(energy["total"] - energy["total"][0]).max() / energy["total"][0]
    figure(f"{what}: energy error with what is radiated", error, bound=1e-5, why="the lumped mass is the worst; as the time integration has it")
    assert energy["radiated"][-1] > 0.99 * energy["total"][0] and (np.diff(energy["radiated"]) > -1e-9 * energy["total"][0]).all()


def reflected(angle, slow):
    """Amplitudes of P and S that a P wave leaves at this angle on sides that absorb, over its own; slow: c_s/c_p, rho = c_p = 1."""
    turned = np.arcsin(slow * np.sin(angle))
    waves = [((np.sin(angle), np.cos(angle)), (np.sin(angle), np.cos(angle)), 1), ((np.sin(angle), -np.cos(angle)), (np.sin(angle), -np.cos(angle)), 1),
             ((np.sin(turned), -np.cos(turned)), (np.cos(turned), np.sin(turned)), slow)]  # direction, motion, speed

    def left(n, d, c):  # of the traction without that of the dashpots
        normal = -((1 - 2 * slow**2) * (n[0] * d[0] + n[1] * d[1]) + 2 * slow**2 * n[1] * d[1]) / c
        return np.array([normal + d[1], -(slow**2) * (n[0] * d[1] + n[1] * d[0]) / c + slow * d[0]])

    come, *go = (left(*wave) for wave in waves)
    return np.linalg.solve(np.array(go).T, -come), waves


def test_a_wave_at_45_degrees_leaves_what_theory_says(run, figure):
    """All other sides move as of the P wave with the P and S waves that dashpots leave of it, 10 elements a wave of S."""
    fast, slow = np.sqrt(1.2 * YOUNG / DENSITY), np.sqrt(0.4 * YOUNG / DENSITY)
    cells, size = (36, 1, 18), (36 * CELL, CELL, 18 * CELL)
    rises, late = 18 * CELL / fast, 18 * CELL * np.cos(np.pi / 4) / fast  # the pulse; how long it takes to the side
    (p, s), waves = reflected(np.pi / 4, slow / fast)

    def field(shape):
        parts = [(amplitude, motion, f"t - {late!r} - ({n[0]!r}*x + {n[1]!r}*(z - {size[2]!r}))/{c * fast!r}") for amplitude, (n, motion, c) in zip((1, p, s), waves)]
        return {axis: " + ".join(f"{amplitude * motion[i]!r}*({shape(phase)})" for amplitude, motion, phase in parts) for i, axis in enumerate("xz")}

    way = field(lambda phase: f"{phase} <= 0 ? 0 : {phase} >= {rises!r} ? {rises / 2!r} : ({phase})/2 - {rises / 4 / np.pi!r}*sin(2*pi*({phase})/{rises!r})")
    place = np.array([18 * CELL, CELL / 3, 12 * CELL])
    sets = {"mesh": {"cells": cells, "size": size}, "interface": {"law": "none", "beta_s": 2}, "initial": {},
            "material": {"model": "linear-elastic", "young": YOUNG, "poisson": POISSON, "density": DENSITY},
            "boundary": [{"set": side, "component": axis, "displacement": way[axis]} for side in ("x-", "x+", "z-") for axis in "xz"]
            + [{"set": "y-", "normal": 0}, {"set": "y+", "normal": 0}, {"set": "z+", "absorbing": True}],
            "time": {"end": 4 * rises, "safety": 0.9}, "output": {"fields": [], "probes": [{"name": "p", "at": list(place)}]}}
    history = run(example("spall.yaml"), sets=sets).history
    t, apart, back = history["time"], 0, 0
    for axis, i in (("x", 0), ("z", 1)):
        shapes = []
        for n, motion, c in waves:
            phase = (t - late - (n[0] * place[0] + n[1] * (place[2] - size[2])) / (c * fast)) / rises
            shapes.append(motion[i] * np.where((phase > 0) & (phase < 1), np.sin(np.pi * phase) ** 2, 0))
        theory = shapes[0] + p * shapes[1] + s * shapes[2]
        apart = max(apart, np.abs(history[f"p_v{axis}"] - theory).max())
        back = max(back, np.abs(theory - shapes[0]).max())
    figure("P wave at 45 degrees on an absorbing side: velocity apart from the theory of the dashpots, over the wave's", apart, bound=0.003)
    assert back > 0.06  # what theory says is left


@pytest.mark.parametrize("form, mass", [("variational", "consistent"), ("variational", "scaled"), ("variational", "lumped"), ("intrinsic", "consistent"), ("continuous", "lumped")])
def test_the_step_stays(run, form, mass):
    """As without dampers, and at the critical step itself these take the energy out, on all sides, edges and corners of some elements: they act on the mean velocity of each kick, implicitly."""
    law = {"law": "xu-needleman", "strength": 1e9, "energy": 100} if form == "intrinsic" else {"law": "none"}
    sets = {"interface": {"form": form, **law}, "mass": mass, "loads": [], "initial.velocity": {"x": "20*sin(2e4*z)", "z": "30*cos(1e4*x)"}, "time.safety": 1, "time.steps": 400,
            "output": {"fields": [], "interval": 20, "energy_limit": 1e9}, "material.model": "linear-elastic"}
    free, *damped = (run(LOADS, sets={**sets, "boundary": boundary}) for boundary in ([], [{"where": 1, "absorbing": True}], [{"where": 1, "dashpot": 3690 * 8906}]))
    for one in damped:
        energy = one.energy
        assert one.summary["dt_first"] == free.summary["dt_first"]
        assert energy["kinetic"].max() <= energy["kinetic"][0] and energy["radiated"][-1] > 0.5 * energy["kinetic"][0] and energy["kinetic"][-1] < 1e-3 * energy["kinetic"][0]


@pytest.mark.parametrize("wave, form, mass, taken", [("P", "variational", "consistent", 8e-5), ("S", "continuous", "lumped", 0.0015)])
def test_a_dashpot_takes_its_share(run, figure, wave, form, mass, taken):
    """Of a third of rho c: a plane wave comes back with (1 - 1/3)/(1 + 1/3) = 1/2, and three quarters of its energy are gone."""
    done, left = absorb(run, wave, 20, form, mass, dashpot=1 / 3)
    figure(f"{wave} wave on a dashpot, form {form}: what comes back", left, theory=0.5, bound=0.002, relative=True)
    figure(f"{wave} wave on a dashpot, form {form}: energy that it takes", done.energy["radiated"][-1] / done.energy["total"][0], theory=0.75, bound=taken, relative=True)


def test_check_tells_of_dashpots(tmp_path):
    case = tmp_path / "dashpot.yaml"
    text = ("mesh: {cells: [1, 1, 1], size: [1, 1, 1]}\nmaterial: {model: neo-hookean, young: 1, poisson: 0, density: 1}\n"
            "interface: {law: none}\ntime: {end: 1}\nboundary: [{set: z+, dashpot: 3%s}]\n")
    case.write_text(text % "")
    assert "boundary       dashpot on 1 m2, 2 faces\n" in launch("check", case).stdout
    for more, message in ((", velocity: 1", "boundary[0]: velocity and dashpot both given"), (", name: a", "boundary[0].name: not used: what leaves is `radiated` in energy.csv"),
                          (", until: 1", "boundary[0].until: not used: a side absorbs all the time")):
        case.write_text(text % more)
        assert message in launch("check", case).stderr


def test_a_block_with_all_sides_absorbing_comes_to_rest(run, figure):
    """Edges and corners, where elements have two and three damped faces; a prescribed side and a load beside them."""
    sides = [{"set": side, "absorbing": True} for side in ("x-", "x+", "y-", "z-", "z+")]
    sets = {"boundary": [*sides, {"set": "y+", "component": "x", "velocity": 0}], "time.steps": 1500,
            "loads": [{"set": "y+", "traction": {"x": 2e7, "y": "t < 3e-7 ? -1e8 : 0"}, "until": 4e-7}], "output.interval": 20,
            "material.model": "linear-elastic"}
    for form, mass in (("variational", "consistent"), ("variational", "scaled"), ("continuous", "lumped")):
        law = {"form": form, "law": "none", **({"beta_s": 2} if form == "variational" else {})}
        energy = run(LOADS, sets={**sets, "interface": law, "mass": mass}).energy
        stored = energy["kinetic"] + energy["bulk"]
        assert stored[-1] < 1e-3 * stored.max() and (np.diff(energy["radiated"]) > -1e-6 * stored.max()).all()
        figure(f"block with absorbing sides, form {form}, mass {mass}: energy error over what is radiated",
               np.abs(energy["total"] - energy["total"][0]).max() / energy["radiated"][-1], bound=rounding(1e-14, 4e-7),
               why=ROUNDING)


def test_a_side_without_faces_is_refused(tmp_path):
    case = tmp_path / "none.yaml"
    case.write_text("mesh: {cells: [1, 1, 1], size: [1, 1, 1]}\nmaterial: {model: neo-hookean, young: 1, poisson: 0, density: 1}\n"
                    "interface: {law: none}\ntime: {end: 1}\nloads: [{where: z > 2, pressure: 1}]\n")
    told = launch("check", case)
    assert told.returncode == 2 and told.stderr.endswith("loads[0]: no face of the surface is in it, where: z > 2\n")


@pytest.mark.parametrize("kind, begin", [("velocity", 4e-7), ("displacement", 0)])
def test_a_side_is_caught_and_released(run, figure, kind, begin):
    """Free before and after, moved in between; beside it another side that only ends, at nodes that both have."""
    end, other = 1.2e-6, 1.5e-6
    value = {"velocity": 3, "displacement": "3*t"}[kind]
    sets = {"boundary": [{"name": "hold", "set": "z-", "component": "x", kind: value, "from": begin, "until": end},
                         {"name": "other", "set": "y+", "component": "x", "velocity": 0, "until": other}],
            "material.model": "linear-elastic", "time.steps": 800, "output.interval": 10, "time.safety": 0.5,
            "initial.velocity": {"x": 2}, "loads": [{"name": "push", "set": "x-", "force": {"x": 5}}]}
    history, energy = (done := run(LOADS, sets=sets)).history, done.energy
    time = history["time"]
    for name, acts in (("hold", (time >= begin) & (time < end)), ("other", time < other)):
        force = history[f"{name}_force_x"]
        assert (force[~acts] == 0).all() and (force[acts] != 0).all() and acts.any() and not acts.all()
    kinetic = energy["kinetic"][-1]
    work = sum(history[f"{name}_work"][-1] for name in ("hold", "other", "push"))
    figure(f"side with a prescribed {kind}, caught and released: energy error over the work",
           abs(energy["total"][-1] - energy["total"][1]) / np.abs(history["hold_work"]).max(), bound=rounding(2e-13, 1e-3),
           why=ROUNDING)
    assert energy["external_work"][-1] == pytest.approx(work, rel=1e-6) and kinetic > 0
