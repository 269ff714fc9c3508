"""Anisotropic solids in a run: waves along the axes of a crystal, polycrystals between their bounds, turned bodies."""

import json

import h5py
import numpy as np
import pytest
from conftest import SINGLE, launch, rounding
from figures import ROUNDING
from test_meshes import convert, polycrystal
from test_restart import assert_same_results, gone_on_anywhere

C11, C12, C44, DENSITY = 168.4e9, 121.4e9, 75.4e9, 8960  # copper
CUBIC = np.diag([C11 - C12] * 3 + [C44] * 3) + np.pad(np.full((3, 3), C12), (0, 3))
COPPER = {"model": "anisotropic", "density": DENSITY, "stiffness": list(CUBIC[np.triu_indices(6)])}
LENGTH = 1e-3


def written(folder, **case):
    path = folder / "crystal.yaml"
    path.write_text(json.dumps({"interface": {"law": "none"}, "output": {"fields": []}, **case}))
    return path


# ---- Waves ----

# Directions of the crystal along z and x; of the motion along z or x; rho c^2.
WAVES = [
    ((0, 0, 1), (1, 0, 0), "z", C11),
    ((1, 1, 0), (0, 0, 1), "z", (C11 + C12 + 2 * C44) / 2),
    ((1, 1, 0), (0, 0, 1), "x", C44),
    ((1, 1, 0), (1, -1, 0), "x", (C11 - C12) / 2),
    ((1, 1, 1), (1, -1, 0), "z", (C11 + 2 * C12 + 4 * C44) / 3),
]


@pytest.fixture
def bar(tmp_path):
    """A bar along z whose cross-section moves as one, along z or x, with a direction of copper along z, another along x."""
    def make(along, across, motion, **more):
        turn = np.stack([across, np.cross(along, across), along])  # rows: x, y, z in the crystal
        turn = turn / np.linalg.norm(turn, axis=1)[:, None]
        held = [c for c in "xyz" if c != motion]
        boundary = [{"where": "abs(nz) < 0.5", "component": c, "velocity": 0} for c in held]
        return written(tmp_path, mesh={"cells": [1, 1, 10], "size": [LENGTH / 10, LENGTH / 10, LENGTH]}, boundary=boundary,
                       material={**COPPER, "orientation": {"axis_1": list(turn[:, 0]), "axis_2": list(turn[:, 1])}}, **more)
    return make


@pytest.mark.parametrize("along, across, motion, modulus", WAVES)
def test_waves_have_christoffels_speed(run, figure, bar, along, across, motion, modulus):
    """cos(pi z/L) swings with half the period L/c; its middle comes when the end stands still."""
    quarter = 0.5 * LENGTH / np.sqrt(modulus / DENSITY)
    case = bar(along, across, motion, initial={"velocity": {motion: f"cos(pi*z/{LENGTH})"}}, time={"end": 1.2 * quarter},
               output={"interval": 1, "fields": [], "probes": [{"name": "end", "at": [0, 0, 0]}]})
    history = run(case).history
    time, speed = history["time"], history[f"end_v{motion}"]
    k = np.argmax(speed < 0)
    still = np.interp(0, [-speed[k - 1], -speed[k]], [time[k - 1], time[k]])
    figure("copper: speed of plane waves along [001], [110], [111], relative", quarter / still - 1, bound=3e-4)


def test_an_absorbing_side_lets_the_waves_of_a_crystal_out(run, figure, bar):
    """Longitudinal waves of [110], half of each goes either way: all leave."""
    speed = np.sqrt(WAVES[1][3] / DENSITY)
    case = bar(*WAVES[1][:3], initial={"velocity": {"z": f"exp(-((z - {LENGTH / 2})/1e-4)^2)"}}, time={"end": 1.2 * LENGTH / speed})
    case.write_text(json.dumps({**json.loads(case.read_text()), "boundary": [
        *json.loads(case.read_text())["boundary"], {"set": "z-", "absorbing": True}, {"set": "z+", "absorbing": True}]}))
    energy = run(case).energy
    figure("copper, pulse along [110] that leaves by absorbing sides: energy left, of all",
           (energy["kinetic"] + energy["bulk"])[-1] / energy["kinetic"][0], bound=1e-3)


# ---- Polycrystals ----


def turned(angles):
    """Copper turned by Bunge's angles, as the 6 x 6 matrix of Voigt."""
    p, t, q = np.radians(angles)
    cp, sp, ct, st, cq, sq = np.cos(p), np.sin(p), np.cos(t), np.sin(t), np.cos(q), np.sin(q)
    g = np.array([[cp * cq - sp * sq * ct, sp * cq + cp * sq * ct, sq * st], [-cp * sq - sp * cq * ct, -sp * sq + cp * cq * ct, cq * st],
                  [sp * st, -cp * st, ct]])
    pairs = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)]
    one = np.eye(3)
    C = C12 * np.einsum("ij,kl", one, one) + C44 * (np.einsum("ik,jl", one, one) + np.einsum("il,jk", one, one))
    C += (C11 - C12 - 2 * C44) * np.einsum("ai,aj,ak,al", g, g, g, g)
    return np.array([[C[i, j, k, l] for k, l in pairs] for i, j in pairs])


@pytest.mark.skipif(SINGLE, reason="the search for an equilibrium ends at 1e-8 in doubles")
def test_a_polycrystal_is_between_voigt_and_reuss(run, figure, tmp_path):
    """Stretched between rollers: its energy is at most that of uniform strain and at least that of uniform stress, both of
    the grains as they lie."""
    grains, strain = 30, 1e-5
    _, grain = polycrystal(tmp_path / "grains.vtk", grains, 4)
    convert(tmp_path / "grains.vtk", tmp_path / "grains.h5", "--unit", "mm")
    angles = np.random.default_rng(1).uniform(0, 360, (grains, 3))
    present = sorted(set(grain))
    (tmp_path / "grains.csv").write_text("\n".join(["set, angle_1, angle_2, angle_3", *(
        f"grain.{g}, " + ", ".join(repr(a) for a in angles[g]) for g in present)]))
    rollers = [{"where": f"n{c} < -0.5", "component": c, "displacement": 0} for c in "xyz"]
    rollers += [{"where": f"n{c} > 0.5", "component": c, "displacement": "0*t"} for c in "xy"]
    case = written(tmp_path, mesh={"file": "grains.h5"}, material=COPPER, materials=[{**COPPER, "file": "grains.csv", "name": "g"}],
                   boundary=[*rollers, {"where": "nz > 0.5", "component": "z", "displacement": f"{strain * 1e-3} + 0*t"}],
                   start="static", time={"end": 1, "steps": 1})
    energy = run(case).energy["bulk"][0] / (strain**2 / 2 * 1e-9)  # over the square of the strain and the volume
    stiffness = [turned(angles[g]) for g in grain]
    voigt = np.mean(stiffness, axis=0)[2, 2]
    reuss = np.linalg.inv(np.mean([np.linalg.inv(C) for C in stiffness], axis=0)[:3, :3])[2, 2]
    assert reuss < energy < voigt and voigt > 1.05 * reuss
    figure("30 grains of copper: modulus of uniaxial strain, between Reuss (0) and Voigt (1)", (energy - reuss) / (voigt - reuss), theory=0.5, bound=0.5,
           why="theory gives the two ends alone")


# ---- Axes that differ from element to element ----


@pytest.fixture(scope="module")
def three_ways(tmp_path_factory):
    """The same 12 grains of copper, turned by a table, a field of the mesh file, and expressions; 1,296 tetrahedra."""
    folder = tmp_path_factory.mktemp("ways")
    _, grain = polycrystal(folder / "grains.vtk", 12, 6)
    convert(folder / "grains.vtk", folder / "grains.h5", "--unit", "mm")
    present, angles = sorted(set(grain)), np.random.default_rng(2).uniform(-180, 180, (12, 3))
    (folder / "grains.csv").write_text("\n".join(["set, angle_1, angle_2, angle_3", *(
        f"grain.{g}, " + ", ".join(repr(float(a)) for a in angles[g]) for g in present)]))
    with h5py.File(folder / "grains.h5", "a") as file:
        file["axes"] = angles[np.array(grain)[file["original"][:]]]
    other = {"model": "anisotropic", **LAMINATE}
    shared = {"mesh": {"file": "grains.h5"}, "initial": {"velocity": {"x": "20*sin(3000*z)", "z": "10*cos(4000*x)"}},
              "interface": {"law": "linear", "strength": 1e6, "energy": 0.1}, "time": {"end": 0.801e-7}, "boundary": [{"where": "nx > 0.5", "absorbing": True}],
              "output": {"fields": ["displacement", "stress"], "times": [2e-9 * k for k in range(1, 41)], "probes": [{"name": "p", "at": [3e-4, 4e-4, 5e-4]}]}}
    ways = {"table": {"material": COPPER, "materials": [{**COPPER, "file": "grains.csv", "name": "g"}]},
            "field": {"material": {**COPPER, "orientation": {"field": "axes"}}},
            "expression": {"material": other, "materials": [
                {**COPPER, "set": f"grain.{g}", "name": f"g{g}", "orientation": {f"angle_{k + 1}": f"{float(angles[g][k])!r} + 0*x" for k in range(3)}} for g in present]}}
    for name, way in ways.items():
        written(folder, **shared, **way).rename(folder / f"{name}.yaml")
    return folder


@pytest.mark.parametrize("way", ["field", "expression"])
def test_axes_of_elements_are_those_of_a_table(run, figure, three_ways, way):
    """Steps of the same length by the moments of output; what breaks, and what leaves at an absorbing side, too."""
    one, other = run(three_ways / "table.yaml"), run(three_ways / f"{way}.yaml")
    u, v = one.fields()["displacement"].ravel(), other.fields()["displacement"].ravel()
    assert one.energy["dissipated"][-1] > 0 and one.energy["radiated"][-1] > 0 and len(one.energy) == len(other.energy)
    figure("12 grains of copper, axes by a field or expressions: displacement apart from that by a table, of the largest",
           np.abs(u - v).max() / np.abs(u).max(), bound=rounding(1e-11, 1e-2), why=ROUNDING)


def test_axes_of_elements_on_any_layout_and_restart(run, three_ways, tmp_path):
    case, often = three_ways / "field.yaml", {"checkpoint.steps": 10}
    one = run(case, sets=often)
    for ranks, threads in [(1, 2), (2, 1), (3, 1)]:
        assert_same_results(run(case, ranks=ranks, threads=threads, sets=often), one, frames=39)
    assert_same_results(gone_on_anywhere(run, case, often, one.summary["steps"], tmp_path / "out"), one, frames=39)


def test_a_field_that_is_not_right(three_ways):
    for way, field, said in [("none", "axis", "there is no such dataset"), ("region", "region", "is not 1296 rows of 3 numbers, a row for each element")]:
        case = json.loads((three_ways / "field.yaml").read_text())
        case["material"]["orientation"]["field"] = field
        (three_ways / f"{way}.yaml").write_text(json.dumps(case))
        process = launch("check", three_ways / f"{way}.yaml", ranks=2)
        assert process.returncode == 2
        assert f"{way}.yaml: material.orientation.field: {field}: {three_ways}/grains.h5: {said}\n" in process.stderr


# ---- Turned ----

LAMINATE = {"model": "anisotropic", "density": 1600, "young": [140e9, 10e9, 9e9], "poisson": [0.4, 0.25, 0.3], "shear": [3e9, 5e9, 6e9]}


def turn_about(axis, angle):
    x, y, z = axis / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def test_a_turned_body_moves_as_the_unturned_one_turned(run, figure, tmp_path):
    """An orthotropic cube with axes askew to its sides, and the same turned with its axes and velocities; output cuts the
    steps to the same length, which the search for the critical one knows to some digits alone."""
    polycrystal(tmp_path / "one.vtk", 1, 2)
    text = (tmp_path / "one.vtk").read_text().splitlines()
    points = np.array([line.split() for line in text[5:32]], dtype=float)
    R = turn_about(np.array([1, 2, -1]), 1.1)
    text[5:32] = [" ".join(map(repr, map(float, x))) for x in points @ R.T]
    (tmp_path / "other.vtk").write_text("\n".join(text) + "\n")
    axes, rate = turn_about(np.array([3, -1, 1]), 0.7), 1e4 * np.array([[1, 0.5, -0.3], [0.2, -0.7, 0.4], [-0.1, 0.6, 0.9]])
    runs = []
    for name, turn in (("one", np.eye(3)), ("other", R)):
        convert(tmp_path / f"{name}.vtk", tmp_path / f"{name}.h5", "--unit", "mm")
        velocity = turn @ rate @ turn.T
        case = written(tmp_path, mesh={"file": f"{name}.h5"}, output={"fields": ["displacement"], "times": [4e-9 * k for k in range(1, 21)]}, time={"end": 8e-8},
                       material={**LAMINATE, "orientation": {"axis_1": list(turn @ axes[0]), "axis_2": list(turn @ axes[1])}},
                       initial={"velocity": {c: "+".join(f"({float(velocity[k, j])!r})*{x}" for j, x in enumerate("xyz")) for k, c in enumerate("xyz")}})
        runs.append(run(case.rename(tmp_path / f"{name}.yaml")))
    at, u, there, v = (array for one in runs for array in (one.points().reshape(-1, 10, 3), one.fields()["displacement"].reshape(-1, 10, 3)))
    at, u = at @ R.T, u @ R.T
    apart = 0
    for k, middle in enumerate(at.mean(axis=1)):  # the meshes' elements, and their nodes, lie in another order
        other = np.argmin(np.linalg.norm(there.mean(axis=1) - middle, axis=1))
        node = [np.argmin(np.linalg.norm(there[other] - x, axis=1)) for x in at[k]]
        assert np.abs(there[other, node] - at[k]).max() < 1e-12
        apart = max(apart, np.abs(v[other, node] - u[k]).max())
    figure("orthotropic cube, turned: displacement apart from that of the unturned one, of the largest", apart / np.abs(u).max(),
           bound=rounding(5e-14, 1e-3), why=ROUNDING)


def test_check_tells_the_waves_of_a_crystal(tmp_path):
    said = launch("check", written(tmp_path, mesh={"cells": [1, 1, 1], "size": [1e-3] * 3}, material=COPPER, time={"end": 1e-7})).stdout
    slow, fast = np.sqrt((C11 - C12) / 2 / DENSITY), np.sqrt((C11 + 2 * C12 + 4 * C44) / 3 / DENSITY)
    assert f"material       anisotropic\nwave speeds    {slow:.1f} to {fast:.1f} m/s, by direction and kind\n" in said
