"""Fronts of cracks: energy release rate by the domain integral, stress intensity from it and from the opening. Bits on any
layout and restarts of J: test_parallel.py, test_restart.py."""

import json
import math
import re

import numpy as np
import pytest
from conftest import SINGLE, example, launch, rounding
from figures import ROUNDING

E, NU, DENSITY = 200e9, 0.3, 8000
MU, KAPPA = E / 2 / (1 + NU), 3 - 4 * NU
SOLID = {"model": "linear-elastic", "young": E, "poisson": NU, "density": DENSITY}
FRONT = {"at": [0, 0, 0], "direction": [2, 0, 0], "normal": [0, 3, 0]}
R = "sqrt(x*x + y*y)"
COS, SIN = f"sqrt(max(0.5*(1 + x/(1e-12 + {R})), 0))", f"sqrt(max(0.5*(1 - x/(1e-12 + {R})), 0))"  # of half the angle


def written(path, case):
    path.write_text(json.dumps(case))
    return path


def opening_field(K):
    """Of a crack in plane strain along x < 0, where y >= 0 (Williams 1957)."""
    a = K / 2 / MU / math.sqrt(2 * math.pi)
    return {"x": f"{a!r}*sqrt({R})*{COS}*({KAPPA - 1!r} + 2*{SIN}*{SIN})", "y": f"{a!r}*sqrt({R})*{SIN}*({KAPPA + 1!r} - 2*{COS}*{COS})"}


@pytest.mark.skipif(SINGLE, reason="strains of 1e-5")
@pytest.mark.parametrize("form, bound", [("variational", 0.015), ("continuous", 0.04)])
def test_a_known_field_around_a_crack(run, scratch, figure, form, bound):
    """Of K = 1 MPa sqrt(m) on the sides of one half of a body; static start. Three rings of 8 by 4 cells a radius and less."""
    K, n, size = 1e6, 16, 16e-3
    u, front = opening_field(K), {**FRONT, "symmetric": True, "values": ["J", "K", "KI"]}
    rings = {"near": (1e-3, 3e-3), "mid": (2e-3, 5e-3), "far": (4e-3, 7e-3)}
    case = {
        "mesh": {"cells": [n, n // 2, 1], "size": [size, size / 2, size / n], "origin": [-size / 2, 0, 0]}, "material": SOLID,
        "interface": {"law": "none", **({"form": form} if form == "continuous" else {})}, "start": "static",
        "boundary": [{"set": side, "component": c, "displacement": u[c]} for side in ("x-", "x+", "y+") for c in "xy"]
        + [{"where": "ny < -0.5 && x > 0", "component": "y", "displacement": 0}] + [{"set": side, "component": "z", "displacement": 0} for side in ("z-", "z+")],
        "time": {"end": 1, "steps": 2}, "output": {"fields": [], "crack_fronts": [{"name": name, **front, "radius": {"inner": a, "outer": b}} for name, (a, b) in rings.items()]},
    }
    history = run(written(scratch / f"known-{form}.yaml", case)).history
    J = K**2 * (1 - NU**2) / E
    what = f"K field around a crack, {form}"
    found = {name: history[f"{name}_J"][0] for name in rings}
    figure(f"{what}: energy release rate, rings of 3 and 7 edges", found["mid"], theory=J, bound=bound, unit="J/m2", relative=True)
    figure(f"{what}: largest difference between three rings", np.ptp(list(found.values())) / J, bound=0.006)
    figure(f"{what}: K from the opening, 2 to 5 edges behind", history["mid_KI"][0], theory=K, bound=bound, unit="Pa sqrt(m)", relative=True)
    assert history["mid_K"][0] == pytest.approx(math.sqrt(found["mid"] * E / (1 - NU**2)), rel=1e-12)
    assert np.ptp(history["mid_J"]) < 1e-9 * J  # at rest


@pytest.mark.skipif(SINGLE, reason="strains of 1e-5")
def test_a_crack_in_a_plate_under_tension(run, scratch, figure):
    """A quarter of a plate with a crack of half its width in the middle; then it stays at rest. K = s sqrt(pi a sec(pi a/2W)) (Feddersen 1966), 0.3 % of it."""
    a, half, tall, pull = 4e-3, 8e-3, 16e-3, 1e6
    case = {
        "mesh": {"cells": [10, 20, 1], "size": [half, tall, half / 10]}, "material": SOLID, "interface": {"law": "none"}, "start": "static",
        "boundary": [{"set": "x-", "normal": 0}, {"where": f"ny < -0.5 && x > {a}", "normal": 0}, {"set": "z-", "normal": 0}, {"set": "z+", "normal": 0}],
        "loads": [{"set": "y+", "traction": {"y": pull}}], "time": {"end": 1, "steps": 100},
        "output": {"fields": [], "crack_fronts": [{"name": "tip", **FRONT, "at": [a, 0, 0], "symmetric": True, "radius": {"inner": 1e-3, "outer": 3e-3}, "values": ["K", "KI"]}]},
    }
    history = run(written(scratch / "plate.yaml", case)).history
    theory = pull * math.sqrt(math.pi * a / math.cos(math.pi * a / 2 / half))
    figure("crack in a plate under tension: K from the domain integral", history["tip_K"][0], theory=theory, bound=0.012, unit="Pa sqrt(m)", relative=True)
    figure("crack in a plate under tension: K from the opening, 1 to 4 edges behind", history["tip_KI"][0], theory=theory, bound=0.05, unit="Pa sqrt(m)", relative=True)
    assert np.ptp(history["tip_K"]) < 1e-6 * theory


@pytest.mark.parametrize("poisson, bound", [(0.2, 0.02), (0.35, 0.009)])
def test_a_crack_that_is_suddenly_there(run, figure, poisson, bound):
    """In a body at rest under tension, on a coarse mesh of the example: K_I(t) of Freund 1990, section 2.5."""
    done = run(example("opened.yaml"), sets={"material.poisson": poisson, "mesh.cells": [30, 30, 1], "output.fields": [], "output.interval": 1000})
    history, opened = done.history, 0.5e-6
    modulus = 32e9 * (1 - poisson) / (1 + poisson) / (1 - 2 * poisson)
    apart = {"K": [], "KI": []}
    for time in (3e-6, 4e-6, 5e-6, 6e-6):
        at = np.argmin(np.abs(history["time"] - opened - time))
        since = history["time"][at] - opened
        theory = 2 * 1.0775e-4 * modulus * math.sqrt(math.sqrt(modulus / 2450) * since * (1 - 2 * poisson) / math.pi) / (1 - poisson)
        for name, found in apart.items():
            found.append(abs(history[f"tip_{name}"][at] / theory - 1))
    figure(f"crack that is suddenly there, Poisson's ratio {poisson}: K of the domain integral, 3 to 6 us", max(apart["K"]), bound=bound)
    figure(f"crack that is suddenly there, Poisson's ratio {poisson}: K_I of the opening", max(apart["KI"]), bound=0.04)
    assert np.abs(history["tip_K"][history["time"] < opened]).max() < 0.02 * theory


@pytest.mark.skipif(SINGLE, reason="strains of 1e-5")
def test_three_modes_from_the_opening(run, scratch, figure):
    """Fields of each on the nodes, of another sign on either side; beside them a stretch along the crack and a motion as one."""
    K = {"KI": 1e6, "KII": -0.5e6, "KIII": 0.7e6}
    above = opening_field(K["KI"])
    two, three = K["KII"] / 2 / MU / math.sqrt(2 * math.pi), 2 * K["KIII"] / MU / math.sqrt(2 * math.pi)
    parts = []
    for where, sign in (("y > 0", 1), ("y < 0", -1)):
        x, y = above["x"], above["y"] if sign > 0 else f"-({above['y']})"
        parts.append({"where": where, "displacement": {
            "x": f"{x} + {sign * two!r}*sqrt({R})*{SIN}*({KAPPA + 1!r} + 2*{COS}*{COS}) + 1e-5*x + 3e-7",
            "y": f"{y} - {two!r}*sqrt({R})*{COS}*({KAPPA - 1!r} - 2*{SIN}*{SIN}) - 2e-7", "z": f"{sign * three!r}*sqrt({R})*{SIN} + 1e-7"}})
    case = {
        "mesh": {"cells": [8, 8, 2], "size": [16e-3, 16e-3, 2e-3], "origin": [-8e-3, -8e-3, 0]}, "material": SOLID,
        "interface": {"law": "linear", "strength": 1e12, "energy": 1e3, "sets": [{"where": "abs(y) < 1e-7 && x < 0", "open": True}]},
        "initial": {"sets": parts}, "time": {"end": 1, "steps": 1},
        "output": {"fields": [], "crack_fronts": [{"name": "f", **FRONT, "radius": {"inner": 2e-3, "outer": 7e-3}, "values": list(K)},
                                                  {"name": "back", "at": [0, 0, 1e-3], "direction": [1, 0, 0], "normal": [0, -1, 0], "length": 2e-3,
                                                   "radius": {"inner": 2e-3, "outer": 7e-3}, "values": list(K)}]},
    }
    history = run(written(scratch / "modes.yaml", case)).history
    for mode, known in K.items():
        figure(f"{mode} from the opening of its field on the nodes", history[f"f_{mode}"][0], theory=known, bound=1e-9, unit="Pa sqrt(m)", relative=True,
               why="R of the fields is 1e-12 m too long, where it divides")
    # Seen with the normal turned the upper face is the lower one, and the front runs the other way.
    turned = [history[f"back_{mode}"][0] / known for mode, known in K.items()]
    assert turned == pytest.approx([1, -1, 1], rel=1e-9)


def test_waves_without_a_crack(run, scratch, figure):
    """Stored and kinetic energy and both terms of inertia against each other: nothing is released. Two waves that meet, jittered mesh."""
    case = {
        "mesh": {"cells": [12, 12, 1], "size": [12e-3, 12e-3, 1e-3], "jitter": 0.1}, "material": {**SOLID, "model": "neo-hookean"}, "interface": {"law": "none"},
        "initial": {"displacement": {"x": "1e-5*cos(400*x + 0.3)", "y": "4e-6*sin(300*x + 0.2*y)"}, "velocity": {"x": "20*sin(400*x + 1)", "y": "8*cos(250*x)"}},
        "boundary": [{"set": side, "component": "z", "velocity": 0} for side in ("z-", "z+")], "time": {"end": 1, "steps": 1},
        "output": {"fields": [], "crack_fronts": [{"name": "none", **FRONT, "at": [6e-3, 6e-3, 0], "radius": {"inner": 2e-3, "outer": 5e-3}, "values": ["J"]}]},
    }
    scale = 0.5 * DENSITY * 20**2 * 8e-3  # kinetic energy by the width of the ring
    done = run(written(scratch / "waves.yaml", case))
    figure("waves without a crack: J over rho v^2/2 times the ring", abs(done.history["none_J"][0]) / scale, bound=rounding(3e-6, 1e-4))


# ---- Fronts that move: the crack of test_sensors.py, pulled ----

CELLS, EDGE, EVERY = 8, 1e-3, 0.5e-6
PULLED = {
    "mesh": {"cells": [CELLS, 1, 4], "size": [CELLS * EDGE, EDGE, 4 * EDGE]}, "material": SOLID,
    "interface": {"law": "linear", "strength": 1e12, "energy": 1e3, "sets": [{"where": f"abs(z - 2e-3) < 1e-6 && x < {(k + 1) * EDGE} && x > {k * EDGE}", "open": True,
                                                                           **({"at": k * EVERY} if k > 1 else {})} for k in range(CELLS - 2)]},
    "initial": {"velocity": {"z": "1e3*(z - 2e-3)"}}, "time": {"end": 4 * EVERY},
}
MOVING = {"direction": [1, 0, 0], "normal": [0, 0, 1], "radius": {"inner": 0.8e-3, "outer": 1.8e-3}, "values": ["J", "KI", "KII", "KIII"]}


def pulled(run, path, fronts, **options):
    output = {"fields": [], "crack_tips": [{"name": "run", "direction": [5, 0, 0]}], "crack_fronts": fronts}
    return run(written(path, {**PULLED, "output": output}), **options)


def test_a_front_that_follows_a_tip(run, scratch, figure):
    """It is where the tip was a step before: as one that rests there. The same bits on two ranks of two threads."""
    follows = {"name": "front", **MOVING, "at": [2e-3, 0, 2e-3], "tip": "run"}
    one, other = (pulled(run, scratch / f"follow-{ranks}.yaml", [follows], ranks=ranks, threads=ranks) for ranks in (1, 2))
    assert one.summary["state_hash"] == other.summary["state_hash"] and (one.dir / "history.csv").read_bytes() == (other.dir / "history.csv").read_bytes()
    history = one.history
    tip = history["run_tip"]
    places = np.unique(tip)
    assert len(places) >= 4
    rest = pulled(run, scratch / "rest.yaml", [{"name": f"at{k}", **MOVING, "at": [place, 0, 2e-3]} for k, place in enumerate(places)]).history
    for value in MOVING["values"]:
        fixed = np.array([rest[f"at{np.flatnonzero(places == before)[0]}_{value}"][i + 1] for i, before in enumerate(tip[:-1])])
        moving = history[f"front_{value}"][1:]
        figure(f"{value} of a front that follows a tip against one that rests there", np.abs(moving - fixed).max() / np.abs(fixed).max(),
               bound=rounding(1e-12, 1e-3), why=ROUNDING)
        assert np.abs(moving - rest[f"at0_{value}"][1:]).max() > 0.1 * np.abs(fixed).max()


@pytest.mark.parametrize("front, message", [
    ("at: [0, 0, 1], direction: [0, 0, 0], normal: [0, 0, 1], radius: {inner: 0.1, outer: 0.4}", ".direction: [0, 0, 0]: has no direction"),
    ("at: [0, 0, 1], direction: [1, 0, 0], normal: [1, 0, 2], radius: {inner: 0.1, outer: 0.4}", ".normal: not at right angles to the direction"),
    ("at: [0, 0, 1], direction: [1, 0, 0], normal: [0, 0, 1], radius: {inner: 0.4, outer: 0.4}", ".radius: inner is not below outer"),
    ("at: [0, 0, 1], direction: [1, 0, 0], normal: [0, 0, 1], radius: {inner: 0.1, outer: 0.4}, tip: no", ".tip: no: no such tip in output.crack_tips"),
    ("at: [0, 0, 1], direction: [1, 0, 0], normal: [0, 0, 1], radius: {inner: 0.1, outer: 0.4}, tip: back", ".tip: back: that tip is looked for against the direction of this front"),
    ("at: [0, 0, 1], direction: [1, 0, 0], normal: [0, 0, 1], radius: {inner: 0.1, outer: 0.4}, values: []", ".values: []: nothing is to be recorded"),
    ("at: [0, 0, 1], direction: [1, 0, 0], normal: [0, 0, 1], radius: {inner: 0.1, outer: 0.4}, symmetric: true, values: [KIII]",
     ".values: a symmetric half tells of opening alone; allowed: J, K, KI"),
    ("at: [0, 0, 9], direction: [1, 0, 0], normal: [0, 0, 1], radius: {inner: 0.1, outer: 0.4}", ": no element is within its outer radius"),
    ("at: [0.5, 0, 1], direction: [1, 0, 0], normal: [0, 0, 1], radius: {inner: 0.1, outer: 0.6}", ": its outer radius passes a side of the body that is not parallel to the direction"),
    ("at: [2, 0, 1], direction: [1, 0, 0], normal: [0, 0, 1], radius: {inner: 0.1, outer: 0.3}, values: [KI]", ": no face in the plane of the crack lies between the radii behind the front"),
    ("at: [3, 0, 1], direction: [1, 0, 0], normal: [0, 0, 1], radius: {inner: 0.5, outer: 0.9}", ": stress intensity is known in one isotropic solid only; values: [J]")])
def test_fronts_that_are_refused(tmp_path, front, message):
    case = tmp_path / "front.yaml"
    case.write_text("mesh: {cells: [4, 1, 2], size: [4, 1, 2]}\nmaterial: {model: neo-hookean, young: 1, poisson: 0, density: 1}\n"
                    "materials: [{name: end, where: x > 3, model: neo-hookean, young: 2, poisson: 0, density: 1}]\ninterface: {law: linear, strength: 1, energy: 1}\n"
                    f"time: {{end: 1}}\noutput: {{crack_tips: [{{name: back, direction: [-1, 0, 0]}}], crack_fronts: [{{name: a, {front}}}]}}\n")
    told = launch("check", case)
    assert told.returncode == 2 and told.stderr.endswith(f"output.crack_fronts[0]{message}\n"), told.stderr


def test_gas_in_cracks_is_refused(tmp_path):
    case = {**PULLED, "loads": [{"cracks": True, "pressure": 1}], "output": {"crack_fronts": [{"name": "a", **MOVING, "at": [3e-3, 0, 2e-3]}]}}
    told = launch("check", written(tmp_path / "gas.yaml", case))
    assert told.returncode == 2 and told.stderr.endswith("output.crack_fronts[0]: J does not know of a pressure inside cracks; values: KI, KII, KIII\n")
    case["output"]["crack_fronts"][0]["values"] = ["KI"]
    assert launch("check", written(tmp_path / "gas.yaml", case)).returncode == 0


def test_check_tells_what_fronts_look_at(tmp_path):
    case = written(tmp_path / "front.yaml", {**PULLED, "output": {"crack_fronts": [{"name": "a", **MOVING, "at": [3e-3, 0, 2e-3]}]}})
    assert "crack front    a: 0.001 m long, " in launch("check", case).stdout


def test_check_tells_of_which_materials_tips_and_fronts_are(tmp_path):
    """A laminate along whose interface the crack lies, of one more solid far from it."""
    material = {"model": "linear-elastic", "young": 70e9, "poisson": 0.2, "density": 2500}
    case = {"mesh": {"cells": [6, 2, 4], "size": [6e-3, 1e-3, 4e-3]}, "material": {"name": "glass", **material},
            "materials": [{"name": "resin", "where": "z > 2e-3", **material, "young": 3e9}, {"name": "far", "where": "x > 4.9e-3", **material}],
            "interface": {"law": "linear", "strength": 1e8, "energy": 10}, "time": {"end": 1e-6},
            "output": {"crack_tips": [{"name": "run", "direction": [1, 0, 0], "where": "abs(z - 2e-3) < 1e-5"}, {"name": "low", "direction": [1, 0, 0], "where": "z < 1.9e-3 && x < 4.9e-3"}],
                       "crack_fronts": [{"name": "a", **MOVING, "at": [3e-3, 0, 2e-3], "values": ["J"]}]}}
    told = launch("check", written(tmp_path / "laminate.yaml", case)).stdout
    assert "crack tip      run: along (1, 0, 0), on 6e-06 m2, 24 faces of glass, resin and far\n" in told, told
    assert re.search(r"crack tip      low: along \(1, 0, 0\), on \S+ m2, \d+ faces of glass\n", told), told
    assert re.search(r"crack front    a: 0.001 m long, \d+ elements of glass and resin, 12 sides of faces behind it of glass and resin\n", told), told
