"""Sensors: means, extremes and integrals over parts of the body. Bits on any layout and restarts: test_parallel.py,
test_restart.py."""

import json

import numpy as np
import pytest
from conftest import SINGLE, launch, rounding
from figures import ROUNDING

SIZE = np.array([2e-3, 1e-3, 3e-3])
E, NU = 200e9, 0.3
BLOCK = """
mesh: {cells: [2, 1, 3], size: [2e-3, 1e-3, 3e-3], jitter: 0.15}
material: {model: linear-elastic, young: 200e9, poisson: 0.3, density: 8000}
materials: [{name: half, where: x < 1e-3, model: linear-elastic, young: 200e9, poisson: 0.3, density: 8000}]
interface: {law: none, beta_s: 2}
initial:
  displacement: {x: "1e-4*x*x + 1e-7*y", y: "2e-4*y*z", z: "3e-7*x"}
  velocity: {x: "1e6*x*y", y: 3, z: "z > 2.9e-3 ? 7 : x/1e-3"}
time: {end: 1, safety: 0.9, steps: 1}
output:
  fields: []
  sensors:
    - {name: all, values: [ux, uy, uz, vx, vy], measures: [mean, min, max, integral]}
    - {name: stress, values: [sxx, syy, sxy, pressure, von_mises]}
    - {name: far, set: x+, values: [sxx, sxy, von_mises, pressure, ux], measures: [mean, min, max]}
    - {name: top, where: nz > 0.5, values: [vz, uy], measures: [mean, min, integral]}
    - {name: half, material: half, values: [sxx], measures: [mean, max]}
"""


@pytest.fixture(scope="module")
def row(run, scratch):
    path = scratch / "sensors.yaml"
    path.write_text(BLOCK)
    history = run(path).history
    return {name: history[name][0] for name in history.dtype.names}


def stress(x, y, z):
    """xx, yy, zz, xy of the displacement, and yz, xz."""
    x, y, z = np.broadcast_arrays(x, y, z)
    mu, lam = E / 2 / (1 + NU), E * NU / (1 + NU) / (1 - 2 * NU)
    xx, yy = 2e-4 * x, 2e-4 * z
    trace = lam * (xx + yy)
    return np.array([trace + 2 * mu * xx, trace + 2 * mu * yy, trace, mu * 1e-7 + 0 * x, mu * 2e-4 * y, mu * 3e-7 + 0 * x])


def test_motion_is_integrated_exactly(row, figure):
    """Quadratic fields on an irregular mesh."""
    x, y, z = SIZE
    volume = SIZE.prod()
    known = {"all_ux_mean": 1e-4 * x**2 / 3 + 1e-7 * y / 2, "all_ux_max": 1e-4 * x**2 + 1e-7 * y, "all_ux_min": 0, "all_uy_mean": 2e-4 * y * z / 4,
             "all_uz_integral": 3e-7 * x / 2 * volume, "all_vx_mean": 1e6 * x * y / 4, "all_vx_max": 1e6 * x * y, "all_vy_integral": 3 * volume, "all_vy_min": 3,
             "top_vz_mean": 7, "top_vz_min": 7, "top_uy_mean": 2e-4 * y * z / 2, "top_uy_integral": 2e-4 * y * z / 2 * x * y, "far_ux_mean": 1e-4 * x**2 + 1e-7 * y / 2}
    apart = max(abs(row[name] - value) / max(abs(value), 1e-12) for name, value in known.items())
    figure("sensors: displacement and velocity, the worst of 14", apart, bound=rounding(2e-15, 4e-7), why=ROUNDING)


@pytest.mark.skipif(SINGLE, reason="strains of 1e-7")
def test_stress_is_that_of_the_points(row, figure):
    """Linear in an element: means are exact, and so is all on a face where it is the same everywhere."""
    x, y, z = SIZE
    mean, far = stress(x / 2, y / 2, z / 2), stress(x, y / 2, z / 2)
    known = {"stress_sxx_mean": mean[0], "stress_syy_mean": mean[1], "stress_sxy_mean": mean[3], "stress_pressure_mean": -mean[:3].mean(), "half_sxx_mean": stress(x / 4, y / 2, z / 2)[0],
             "far_sxx_mean": far[0], "far_sxy_mean": far[3], "far_sxy_min": far[3], "far_sxy_max": far[3], "far_pressure_mean": -far[:3].mean()}
    apart = max(abs(row[name] - value) / abs(value) for name, value in known.items())
    figure("sensors: stress, the worst of 10", apart, bound=1e-6, why="strains of 1e-7, of which Cauchy stress takes the square")
    assert row["far_sxx_min"] < far[0] < row["far_sxx_max"] <= stress(x, y, z)[0] * (1 + 1e-6)
    assert row["half_sxx_max"] < stress(x / 2, y, z)[0] < row["far_sxx_mean"]


@pytest.mark.skipif(SINGLE, reason="strains of 1e-7")
def test_von_mises(row, figure):
    """At the middles of the edges of the side: between its extremes there, and the mean over them."""
    x, y, z = SIZE
    def mises(t):
        return np.sqrt(0.5 * ((t[0] - t[1]) ** 2 + (t[1] - t[2]) ** 2 + (t[2] - t[0]) ** 2) + 3 * (t[3] ** 2 + t[4] ** 2 + t[5] ** 2))
    grid = mises(stress(x, *np.meshgrid(np.linspace(0, y, 101), np.linspace(0, z, 101))))
    figure("sensors: mean von Mises stress of a side", row["far_von_mises_mean"], theory=grid.mean(), bound=3e-3, unit="Pa", relative=True)
    assert grid.min() * (1 - 1e-6) <= row["far_von_mises_min"] < row["far_von_mises_mean"] < row["far_von_mises_max"] <= grid.max() * (1 + 1e-6)


@pytest.mark.parametrize("sensor, message", [
    ("{name: a, where: z > 7, values: [ux]}", "output.sensors[0]: no element is in it"),
    ("{name: a, where: nz > 7, values: [ux]}", "output.sensors[0]: no face of the surface is in it, where: nz > 7"),
    ("{name: a, where: 1/x, values: [ux]}, {name: a, values: [ux]}", "output.sensors[1].name: a: the name of an earlier one in history.csv; allowed: letters, digits, _ and -; unique in history.csv"),
    ("{name: a, values: []}", "output.sensors[0].values: []: nothing is to be recorded"),
    ("{name: a, set: z+, where: 1, values: [ux]}", "output.sensors[0]: more than one given; allowed: at most one of set, where, material"),
    ("{name: a, material: tin, values: [ux]}", "output.sensors[0].material: tin: no such material")])
def test_sensors_that_are_refused(tmp_path, sensor, message):
    case = tmp_path / "sensor.yaml"
    case.write_text("mesh: {cells: [1, 1, 1], size: [1, 1, 1]}\nmaterial: {model: neo-hookean, young: 1, poisson: 0, density: 1}\n"
                    f"interface: {{law: none}}\ntime: {{end: 1}}\noutput: {{sensors: [{sensor}]}}\n")
    told = launch("check", case)
    assert told.returncode == 2 and told.stderr.endswith(f"{message}\n"), told.stderr


def test_check_tells_what_sensors_look_at(tmp_path):
    case = tmp_path / "sensors.yaml"
    case.write_text(BLOCK)
    told = [line for line in launch("check", case).stdout.splitlines() if line.startswith("sensor ")]
    assert told[0] == "sensor         all: 6e-09 m3, 36 elements of material and half" and told[2] == "sensor         far: 3e-06 m2, 6 faces of material" and len(told) == 5


def test_strain_at_a_probe(run, scratch, figure):
    """Green and Lagrange's, of a large displacement that is quadratic; beside probes that have none."""
    at = np.array([0.31, 0.42, 0.27])
    case = scratch / "strain.yaml"
    case.write_text("mesh: {cells: [2, 2, 2], size: [1, 1, 1], jitter: 0.2}\nmaterial: {model: st-venant-kirchhoff, young: 1, poisson: 0.2, density: 1}\ninterface: {law: none}\n"
                    "initial: {displacement: {x: 0.1*x*x + 0.2*y*z, y: 0.05*y - 0.1*x*z, z: 0.1*z*z + 0.3*x}}\ntime: {end: 1, steps: 1}\n"
                    "output: {fields: [], probes: [{name: bare, at: [0.5, 0.5, 0.5]}, {name: p, at: [0.31, 0.42, 0.27], strain: true}, {name: last, at: [0.5, 0.5, 0.5]}]}\n")
    row = run(case).history[0]
    x, y, z = at
    F = np.eye(3) + np.array([[0.2 * x, 0.2 * z, 0.2 * y], [-0.1 * z, 0.05, -0.1 * x], [0.3, 0, 0.2 * z]])
    strain, names = (F.T @ F - np.eye(3)) / 2, ("exx", "eyy", "ezz", "eyz", "exz", "exy")
    apart = max(abs(row[f"p_{name}"] - strain["xyz".index(name[1]), "xyz".index(name[2])]) for name in names)
    figure("strain at a probe, of 0.1", apart, bound=rounding(3e-16, 1e-7), why=ROUNDING)
    assert [name for name in row.dtype.names if "_e" in name] == [f"p_{name}" for name in names]
    assert row["bare_sxy"] == row["last_sxy"] and row["bare_ux"] == row["last_ux"] == pytest.approx(0.075, rel=1e-6)


# ---- Tips of cracks ----

CELLS, EDGE, EVERY = 8, 1e-3, 0.5e-6
RUNNING = {
    "mesh": {"cells": [CELLS, 1, 2], "size": [CELLS * EDGE, EDGE, 2 * EDGE]}, "material": {"model": "linear-elastic", "young": 200e9, "poisson": 0.3, "density": 8000},
    "interface": {"law": "linear", "strength": 1e12, "energy": 1e3, "sets": [{"where": f"abs(z - 1e-3) < 1e-6 && x < {(k + 1) * EDGE} && x > {k * EDGE}", "open": True,
                                                                           **({"at": k * EVERY} if k > 0 else {})} for k in range(1, CELLS)]},
    "time": {"end": (CELLS - 1) * EVERY},
    "output": {"fields": [], "crack_tips": [{"name": "run", "direction": [3, 0, 0], "distance": 1.5 * EDGE}, {"name": "back", "direction": [-1, 0, 0], "where": "x < 3e-3"},
                                            {"name": "none", "direction": [1, 0, 0], "where": "abs(nx) > 0.9"}]},
}


def test_a_tip_that_moves_cell_by_cell(run, scratch, figure):
    """Faces open one cell after the other; the last point of a face is 0.0916 of an edge from its corner."""
    path = scratch / "running.yaml"
    path.write_text(json.dumps(RUNNING))
    history = run(path).history
    time, tip, step = history["time"], history["run_tip"], np.diff(history["time"]).max()
    point = 0.091576213509771
    settled = np.abs(time / EVERY - np.rint(time / EVERY)) * EVERY > 1.01 * step
    opened = np.floor(time / EVERY)
    assert np.isnan(tip[opened == 0][:-2]).all() and np.isnan(history["none_tip"]).all() and not history["none_speed"].any()
    figure("tip of a crack that opens cell by cell: its place, over an edge", np.nanmax(np.abs(tip / EDGE - (opened + 1 - point))[settled & (opened > 0)]),
           bound=rounding(1e-14, 1e-7), why=ROUNDING)
    assert history["back_tip"][-1] == pytest.approx(-EDGE * (1 + point), rel=1e-6)
    figure("tip of a crack that opens cell by cell: its speed", history["run_speed"][-1], theory=EDGE / EVERY, bound=0.03, unit="m/s", relative=True)
    assert not history["run_speed"][opened < 2].any()
    assert len(np.unique(history["run_speed"])) == 1 + (CELLS - 2) // 2  # each is that over two cells


@pytest.mark.parametrize("tip, law, message", [
    ("{name: a, direction: [0, 0, 0]}", "law: linear, strength: 1, energy: 1", "output.crack_tips[0].direction: [0, 0, 0]: has no direction"),
    ("{name: a, direction: [0, 0, 1], where: z > 3}", "law: linear, strength: 1, energy: 1", "output.crack_tips[0]: no face between elements is in it, where: z > 3"),
    ("{name: a, direction: [0, 0, 1]}", "law: none", "output.crack_tips: [{name: a, direction: [0, 0, 1]}]: not used, because interface.law is none")])
def test_tips_that_are_refused(tmp_path, tip, law, message):
    case = tmp_path / "tip.yaml"
    case.write_text("mesh: {cells: [1, 1, 1], size: [1, 1, 1]}\nmaterial: {model: neo-hookean, young: 1, poisson: 0, density: 1}\n"
                    f"interface: {{{law}}}\ntime: {{end: 1}}\noutput: {{crack_tips: [{tip}]}}\n")
    told = launch("check", case)
    assert told.returncode == 2 and told.stderr.endswith(f"{message}\n"), told.stderr
