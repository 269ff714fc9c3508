"""Faces that are open from the start: a free surface to tension, none to pressure. Bits on any layout and restarts, with
fracture beside them: test_parallel.py, test_restart.py."""

import numpy as np
import pytest
from conftest import CASES, example, launch, rounding
from figures import ROUNDING

PRESSURE = 1e8
BAR = {
    "mesh": {"cells": [1, 1, 40], "size": [5e-5, 5e-5, 2e-3]},
    "material": {"model": "linear-elastic", "young": 200e9, "poisson": 0, "density": 8000},
    "tables": {"rise": {"points": [[0, 0], [8e-8, 1]], "smooth": True}},
    "time": {"end": 4.8e-7, "safety": 0.9}, "boundary": [], "initial": {},
    "output": {"fields": ["crack"], "probes": [{"name": "near", "at": [2e-5, 2e-5, 0.9e-3]}, {"name": "far", "at": [2e-5, 2e-5, 1.5e-3]}]},
}


def bar(run, sign, contact, friction=0):
    """A step of traction from below on a bar that is cut in the middle."""
    crack = {"where": "abs(z - 1e-3) < 1e-6 && abs(nz) > 0.9", "open": True}
    law = {"law": "linear", "strength": 1e10, "energy": 1e3, "beta_s": 2, "contact": contact, "friction": friction, "sets": [crack]}
    return run(example("spall.yaml"), sets={**BAR, "interface": law,
                                            "loads": [{"name": "push", "set": "z-", "traction": {"z": f"{sign * PRESSURE}*rise(t)"}}]})


@pytest.mark.parametrize("contact, friction", [("penalty", 0), ("penalty", 0.3), ("potential", 0)])
def test_pressure_passes_and_tension_does_not(run, figure, contact, friction):
    pressed, pulled = bar(run, 1, contact, friction), bar(run, -1, contact, friction)
    what = f"bar with an open face, contact {contact}, friction {friction}"
    figure(f"{what}: pressure behind it", -pressed.history["far_szz"][-1], theory=PRESSURE, bound=1.5e-4, unit="Pa", relative=True,
           why="the worst of the three")
    figure(f"{what}: velocity of the free end that it makes in tension", -pulled.history["near_vz"][-1],
           theory=2 * PRESSURE / (8000 * 5000), bound=5e-4, unit="m/s", relative=True)
    assert np.abs(pulled.history["far_szz"]).max() < 1e-3 * PRESSURE > np.abs(pulled.history["near_szz"][-1])
    for done in (pressed, pulled):
        energy = done.energy
        error = np.abs(energy["total"] - energy["total"][0]).max() / energy["external_work"].max()
        figure(f"{what}: energy error", error, bound=rounding(7e-9, 1.5e-6), why="the worse of the two")
        assert not energy["dissipated"].any() and not energy["broken_area"].any() and not energy["failed_area"].any()
        assert done.summary["first_fracture_time_s"] is None
        frame = done.frames()[-1]
        assert frame["crack/damage"] == pytest.approx(1, abs=1e-12) and len(frame["crack/damage"]) == 2


def test_pressure_inside_a_crack(run, figure):
    """Two waves run away from it."""
    crack = {"where": "abs(z - 1e-3) < 1e-6 && abs(nz) > 0.9", "open": True}
    law = {"law": "linear", "strength": 1e10, "energy": 1e3, "beta_s": 2, "contact": "penalty", "sets": [crack]}
    sets = {**BAR, "interface": law, "time": {"end": 2e-7, "safety": 0.9}, "loads": [{"name": "gas", "cracks": True, "pressure": f"{PRESSURE}*rise(t)"}]}
    done = run(example("spall.yaml"), sets=sets)
    history, energy = done.history, done.energy
    for probe, way in (("near", -1), ("far", 1)):
        figure(f"pressure inside a crack: stress {probe}", -history[f"{probe}_szz"][-1], theory=PRESSURE, bound=5e-4, unit="Pa", relative=True,
               why="the worse of the two probes")
        figure(f"pressure inside a crack: velocity {probe}", way * history[f"{probe}_vz"][-1], theory=PRESSURE / (8000 * 5000), bound=4e-4, unit="m/s",
               relative=True, why="the worse of the two probes")
    figure("pressure inside a crack: force on both sides together, over that on one", np.abs(history["gas_force_z"]).max() / (PRESSURE * 5e-5**2),
           bound=rounding(1.7e-15, 3e-8), why=ROUNDING)
    figure("pressure inside a crack: energy error over its work", np.abs(energy["total"] - energy["total"][0]).max() / history["gas_work"][-1],
           bound=rounding(7.5e-10, 1.5e-6))
    assert history["gas_work"][-1] == pytest.approx(energy["external_work"][-1], rel=1e-6)


def test_pressure_enters_cracks_as_they_open(run, figure):
    """Of a body that tears: none before; then it drives the faces apart."""
    gas = {"name": "gas", "cracks": True, "pressure": 5e7}
    sets = {"time.end": 0.3e-6, "output.fields": [], "interface.activation": "conserving", "output.interval": 1e-8}
    plain, driven = (run(CASES / "fragments.yaml", sets={**sets, "loads": loads}) for loads in ([], [gas]))
    history, energy = driven.history, driven.energy
    failed = np.interp(history["time"], energy["time"], energy["failed_area"])
    assert not history["gas_work"][failed <= 0][:-1].any() and history["gas_work"][-1] > 0.01 * energy["dissipated"][-1]
    assert energy["failed_area"][-1] >= plain.energy["failed_area"][-1] > 0
    worst = [np.abs(of.energy["total"] - of.energy["total"][0]).max() for of in (plain, driven)]
    figure("pressure in cracks as they open: energy error over that without", worst[1] / worst[0], bound=1.5)


def test_check_tells_where_pressure_may_enter(tmp_path):
    """Inside the mesh each face is counted once, with the area of one side: those of a bar of cubes across its axis."""
    told = launch("check", example("spall.yaml"), "--set", "mesh.cells=[2,2,3]", "--set", "mesh.size=[2e-3,2e-3,3e-3]", "--set", "mesh.jitter=0",
                  "--set", "loads=[{name: gas, cracks: true, where: 'abs(nz) > 0.9', pressure: 1e6}]").stdout
    assert "load           gas: pressure in cracks, on each side on at most 8e-06 m2, 16 faces; (0, 0, 0) N at t = 0\n" in told


def test_what_breaks_later_counts(run):
    """Half of the plane is open; the other half tears."""
    crack = {"where": "abs(z) < 5e-5 && abs(nz) > 0.8 && x > 0", "open": True}
    plain, cut = (run(CASES / "fragments.yaml", sets={"time.end": 0.3e-6, "interface.sets": sets, "output.fields": []}) for sets in ([], [crack]))
    assert plain.summary["first_fracture_time_s"] > cut.summary["first_fracture_time_s"] > 0
    energy = cut.energy
    assert energy["broken_area"][0] == 0 and energy["dissipated"][0] == 0 and energy["broken_area"][-1] > 0
    assert (energy["dissipated"] <= 34 * energy["broken_area"] * (1 + 1e-12)).all()


def test_a_law_without_an_end_is_refused(tmp_path):
    case = tmp_path / "open.yaml"
    case.write_text("mesh: {cells: [1, 1, 2], size: [1, 1, 2]}\nmaterial: {model: neo-hookean, young: 1, poisson: 0, density: 1}\n"
                    "interface: {law: free, form: intrinsic, strength: 1, free: {normal: 1, shear: 1}, sets: [{where: z, open: true}]}\n"
                    "time: {end: 1}\n")
    told = launch("check", case)
    assert told.returncode == 2 and "sets[0].open: true: law free has no end: its faces are never without traction\n" in told.stderr


@pytest.mark.parametrize("of, message", [
    ("law: linear, strength: 1, energy: 1, sets: [{where: 1, at: 2}]", "interface.sets[0].at: 2: not used without open: true"),
    ("law: linear, strength: 1, energy: 1, sets: [{where: z > 7, open: true, at: 2}]", "interface.sets[0]: no face is in it, where: z > 7"),
    ("law: bilinear, form: intrinsic, strength: 1, energy: 1, sets: [{where: 1, open: true, at: 2}]",
     "interface.sets[0].at: 2: form intrinsic has no DG terms that would hold the faces until then")])
def test_openings_that_are_refused(tmp_path, of, message):
    case = tmp_path / "open.yaml"
    case.write_text(f"mesh: {{cells: [1, 1, 2], size: [1, 1, 2]}}\nmaterial: {{model: neo-hookean, young: 1, poisson: 0, density: 1}}\ninterface: {{{of}}}\ntime: {{end: 1}}\n")
    told = launch("check", case)
    assert told.returncode == 2 and told.stderr.endswith(f"{message}\n"), told.stderr


def test_check_tells_what_opens(tmp_path):
    case = tmp_path / "open.yaml"
    case.write_text("mesh: {cells: [1, 1, 2], size: [1, 1, 2]}\nmaterial: {model: neo-hookean, young: 1, poisson: 0, density: 1}\ntime: {end: 1}\n"
                    "interface: {law: linear, strength: 1, energy: 1, sets: [{where: abs(nz) > 0.9, open: true, at: 2.5}]}\n")
    assert "opening        of 1 m2, 2 faces, at 2.5 s\n" in launch("check", case).stdout
    for ranks in (1, 2):
        told = launch("check", case, "--set", "interface.sets=[{where: z > 5, open: true}, {where: abs(nz) > 0.9, open: true}]", ranks=ranks)
        assert told.returncode == 2 and "interface.sets[0]: no face is in it, where: z > 5\n" in told.stderr
        told = launch("check", case, "--set", "interface.sets=[{where: 1, open: true, at: 3}, {where: abs(nz) > 0.9, open: true}]", ranks=ranks).stdout
        assert "opening        of 1 m2, 2 faces, from the start\n" in told and " faces, at 3 s\n" in told


@pytest.mark.parametrize("load, law, message", [
    ("{cracks: true, force: {x: 1}}", "law: linear, strength: 1, energy: 1", "loads[0].cracks: not used: it belongs to a pressure"),
    ("{cracks: true, pressure: 1}", "law: none", "loads[0].cracks: true: nothing opens, because interface.law is none"),
    ("{cracks: true, where: z > 3, pressure: 1}", "law: linear, strength: 1, energy: 1", "loads[0]: no face between elements is in it, where: z > 3")])
def test_cracks_under_pressure_that_are_refused(tmp_path, load, law, message):
    case = tmp_path / "gas.yaml"
    case.write_text("mesh: {cells: [1, 1, 2], size: [1, 1, 2]}\nmaterial: {model: neo-hookean, young: 1, poisson: 0, density: 1}\n"
                    f"interface: {{{law}}}\ntime: {{end: 1}}\nloads: [{load}]\n")
    told = launch("check", case)
    assert told.returncode == 2 and told.stderr.endswith(f"{message}\n"), told.stderr


# ---- Faces that open at a time ----

STATIC = {**BAR, "start": "static", "boundary": [{"set": side, "component": side[0], "displacement": 0} for side in ("x-", "y-", "z-")],
          "loads": [{"set": "z+", "traction": {"z": PRESSURE}}], "time": {"end": 1, "safety": 0.9, "steps": 200}, "output.interval": 1}
RESTING = {"where": "abs(z - 1e-3) < 1e-6 && abs(nz) > 0.9", "open": True, "at": 5e-8}


def test_a_resting_crack_is_released(run, figure):
    """A bar at rest under tension is cut at a time: two waves of v = stress/(rho c) unload it, and two thirds of its energy move by then."""
    law = {"law": "linear", "strength": 1e10, "energy": 1e3, "beta_s": 2, "contact": "penalty", "sets": [RESTING]}
    done = run(example("spall.yaml"), sets={**STATIC, "interface": law})
    energy, history, stored = done.energy, done.history, PRESSURE**2 / 200e9 / 2 * 5e-5**2 * 2e-3
    held, since = energy["time"] < RESTING["at"], energy["time"][-1] - RESTING["at"]
    figure("resting crack: kinetic over stored energy before it opens", energy["kinetic"][held].max() / stored, bound=rounding(1e-16, 1e-8),
           why="the residual at which the search for the equilibrium ends")
    figure("resting crack: kinetic energy of its two waves", energy["kinetic"][-1], theory=PRESSURE**2 * 5e-5**2 * since / (8000 * 5000), bound=0.002, unit="J", relative=True)
    figure("resting crack: stress behind them", max(abs(history[f"{probe}_szz"][-1]) for probe in ("near", "far")) / PRESSURE, bound=0.15)
    figure("resting crack: energy error", np.abs(energy["total"] - energy["total"][0]).max() / stored, bound=rounding(1.2e-14, 3e-6))
    assert not energy["broken_area"].any() and done.summary["first_fracture_time_s"] is None
    assert done.frames()[-1]["crack/time_of_failure"] == pytest.approx(energy["time"][~held][0], rel=1e-6)


@pytest.mark.parametrize("form", ["variational", "continuous"])
def test_what_an_opening_sets_free_is_booked(run, figure, form):
    """Of a block in waves, cut in two halves in tension; by how much the sum changes beside that."""
    opened = [{"where": f"abs(z - 2e-4) < 3e-5 && abs(nz) > 0.7 && {half}", "open": True, "at": at} for half, at in (("x > 5e-5", 3e-8), ("x < 5e-5", 3.5e-8))]
    law = {"law": "linear", "strength": 1e12, "energy": 1e3, "beta_s": 2, "contact": "penalty", "form": form, "sets": opened}
    if form == "continuous":
        law["faces"] = "abs(nz) > 0.7"
    sets = {**BAR, "mesh": {"cells": [2, 2, 8], "size": [1e-4, 1e-4, 4e-4], "jitter": 0.1}, "material": {**BAR["material"], "poisson": 0.3}, "interface": law, "loads": [],
            "time": {"end": 1, "safety": 0.8, "steps": 60},
            "initial": {"velocity": {"x": "20*z/4e-4", "z": "5e4*z*(1 + 3e3*x)"}}, "output": {"fields": [], "interval": 1}}
    energy = run(example("spall.yaml"), sets=sets).energy
    freed = np.diff(energy["unresolved"])
    at = np.flatnonzero(freed)
    assert len(at) == 2 and (energy["time"][at] < (3e-8, 3.5e-8)).all() and (energy["time"][at + 1] >= (3e-8, 3.5e-8)).all()
    figure(f"block that is cut in waves, form {form}: change of the total where it opens, of what came free", np.abs(np.diff(energy["total"])[at] / freed[at]).max(),
           bound=rounding(1e-11, 0.02), why=ROUNDING)
