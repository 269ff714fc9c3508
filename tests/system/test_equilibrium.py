"""Pressure on a spherical hole, at rest and suddenly, and in a ring: the meshes and cases of the example, against closed forms."""

import math

import numpy as np
import pytest
from conftest import PROGRAM, SINGLE, example, launch

FOLDER = example("sphere.yaml").parent
YOUNG, NU, DENSITY, PRESSURE = 70e9, 0.25, 2700, 1e6  # of the cases
MU = YOUNG / 2 / (1 + NU)
HOLE, FAR = 1e-3, 5e-3
PASSES = 3000

pytestmark = [pytest.mark.skipif(SINGLE, reason="strains of 1e-5"),
              pytest.mark.skipif(not PROGRAM.with_name("rhegma-mesh").exists(), reason="built without Gmsh's library")]


@pytest.fixture(scope="module")
def mesh(scratch):
    """The mesh of a geometry of the example."""

    def make(name):
        path = scratch / f"{name}.h5"
        if not path.exists():
            made = launch("mesh", FOLDER / f"{name}.geo", "-o", path, "--scale", "1e-3", *(["--improve"] if name == "sphere" else []))
            assert made.returncode == 0, made.stderr
        return str(path)

    return make


def test_a_hole_under_pressure_at_rest(run, mesh, figure):
    """Lame's sphere of radii 1 and 5, elements of a tenth of the hole's radius there."""
    done = run(FOLDER / "sphere.yaml", sets={"mesh.file": mesh("sphere"), "time.steps": 20})
    row, part = done.history[0], PRESSURE * HOLE**3 / (FAR**3 - HOLE**3)

    def stress(r):
        return part * (1 - (FAR / r) ** 3), part * (1 + (FAR / r) ** 3 / 2)

    def way(r):
        return r / YOUNG * (stress(r)[1] * (1 - NU) - NU * stress(r)[0])

    figure("hole under pressure: mean displacement", 2 * row["hole_ux_mean"], theory=way(HOLE), bound=0.0025, unit="m", relative=True)
    for axis in "xyz":
        figure(f"hole under pressure: displacement of its point on {axis}", row[f"{axis}_u{axis}"], theory=way(HOLE), bound=0.009, unit="m", relative=True)
    figure("hole under pressure: hoop stress of its point on x", (row["x_syy"] + row["x_szz"]) / 2, theory=stress(HOLE)[1], bound=0.01, unit="Pa", relative=True)
    figure("hole under pressure: radial stress of its point on x", row["x_sxx"], theory=-PRESSURE, bound=0.01, unit="Pa", relative=True)
    tensor = np.array([[row[f"mid_s{''.join(sorted(a + b))}"] for a in "xyz"] for b in "xyz"])
    radial = tensor.sum() / 3  # along (1, 1, 1)
    figure("hole under pressure: radial stress at twice its radius", radial, theory=stress(1.15e-3 * math.sqrt(3))[0], bound=0.01, unit="Pa", relative=True)
    figure("hole under pressure: force, of an eighth of a sphere in plane facets", row["gas_force_x"], theory=PRESSURE * math.pi * HOLE**2 / 4, bound=0.004, unit="N", relative=True)
    assert done.summary["static_residual"] < 1e-8 and done.summary["static_passes"] < PASSES
    assert done.energy["kinetic"].max() < 1e-10 * done.energy["bulk"][0]


def test_a_hole_suddenly_under_pressure(run, mesh, figure):
    """Hopkins' solution (1960): of the potential f(t - (r - a)/c)/r with f" + 2 n f' + w^2 f = -p a/rho; the far side absorbs."""
    history = run(FOLDER / "sphere-step.yaml", sets={"mesh.file": mesh("sphere")}).history
    speed = math.sqrt(YOUNG * (1 - NU) / (1 + NU) / (1 - 2 * NU) / DENSITY)
    damping, square = 2 * MU / (DENSITY * speed * HOLE), 4 * MU / (DENSITY * HOLE**2)
    turning, rest = math.sqrt(square - damping**2), PRESSURE * HOLE**3 / 4 / MU

    def way(r, time):
        since = np.maximum(time - (r - HOLE) / speed, 0)
        decay, cos, sin = np.exp(-damping * since), np.cos(turning * since), np.sin(turning * since)
        f, rate = -rest * (1 - decay * (cos + damping / turning * sin)), -rest * decay * square / turning * sin
        return -rate / speed / r - f / r**2

    time, far = history["time"], 1.15e-3 * math.sqrt(3)
    at_hole, beyond = way(HOLE, time), way(far, time)
    middle = sum(history[f"mid_u{axis}"] for axis in "xyz") / math.sqrt(3)
    figure("hole suddenly under pressure: mean displacement, over its largest", np.abs(2 * history["hole_ux_mean"] - at_hole).max() / at_hole.max(), bound=0.01)
    figure("hole suddenly under pressure: displacement at twice its radius, over its largest", np.abs(middle - beyond).max() / beyond.max(), bound=0.04)
    assert at_hole.max() > 1.25 * PRESSURE * HOLE / 4 / MU  # it swings beyond its equilibrium


def test_a_ring_under_pressure_at_rest(run, mesh, figure):
    """Four elements through its thickness, of radii 4 and 5, in plane strain."""
    done = run(FOLDER / "ring.yaml", sets={"mesh.file": mesh("ring")})
    row, part = done.history[0], PRESSURE * 16 / 9

    def way(r):
        return (1 + NU) / YOUNG * part * r * (1 - 2 * NU + (5e-3 / r) ** 2)

    figure("ring under pressure: displacement inside", row["inside_ux"], theory=way(4e-3), bound=7e-4, unit="m", relative=True)
    figure("ring under pressure: displacement outside", row["outside_ux"], theory=way(5e-3), bound=6e-4, unit="m", relative=True)
    assert done.summary["static_residual"] < 1e-8 and done.summary["static_passes"] < PASSES
    figure("ring under pressure: kinetic over stored energy in 1000 steps", done.energy["kinetic"].max() / done.energy["bulk"][0], bound=1e-14, why="the residual at which the search ends")
