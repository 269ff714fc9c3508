"""Concrete that is crushed with and without pressure across (README.md)."""

import pathlib

import gallery
import numpy as np
import point

HERE = pathlib.Path(__file__).parent
TITLE = "crushed concrete: strength by pressure across"
SEED = "mesh.seed"
LENGTH, AREA = 10e-3, 25e-6  # m, m2, of crushed-concrete.yaml
TESTS = {"free": (100.0, 0.0), "8 MPa": (100.0, 8e6), "24 MPa": (100.0, 24e6)}  # rate (1/s), pressure across (Pa)


def runs(full):
    mesh = {"mesh.cells": [4, 4, 8] if full else [2, 2, 4], "mesh.jitter": 0.05}
    return {name: gallery.Setup(HERE / "crushed-concrete.yaml", {**mesh, **test(rate, across)}) for name, (rate, across) in TESTS.items()}


def test(rate, across):
    """What differs from the case, which is the first one and goes on for longer."""
    along, sideways = rate, 0.145 * rate
    sides = [{"set": f"{axis}-", "component": axis, "velocity": 0} for axis in "xyz"]
    return {
        "initial.velocity": {"x": f"{sideways}*x", "y": f"{sideways}*y", "z": f"-{along}*z"},
        "boundary": [*sides, {"name": "piston", "set": "z+", "component": "z", "velocity": -rate * LENGTH}],
        "loads": [{"name": "cell", "where": "nx > 0.5 || ny > 0.5", "pressure": f"{across}*min(t/20e-6, 1)"}],
        "time.end": 0.01 / rate, "output.interval": 1e-4 / rate,
    }


def pressed(run, rate):
    """Logarithmic strain (compression positive) and stress on the piston (Pa)."""
    history = run.history
    return -np.log1p(-rate * history["time"]), -history["piston_force_z"] / AREA


def surface(solid, rate, across):
    """The axial stress on the strength surface of the solid as it is before it is damaged (Pa): the root of the law itself, by
    repetition."""
    strength, stress = solid["compressive_strength"], 0.0
    faster = 1 + solid["rate_sensitivity"] * np.log(rate / solid["reference_rate"])
    for _ in range(100):
        pressure = (stress + 2 * across) / 3 / strength
        mises = strength * faster * (solid["cohesive_strength"] + solid["crushed_strength"] * pressure**solid["crushed_power"])
        stress = across + mises
    return stress


def path(solid, rate, across):
    """Of one point (kernels/reference)."""
    return solid.uniaxial_stress(-np.linspace(0, 0.01, 1001)[1:], rate, across)


def quantities(setups, done):
    solid, rows = point.Solid(point.preset("concrete-hjc")), []
    for name, (rate, across) in TESTS.items():
        strength = pressed(done[name], rate)[1].max()
        rows += [gallery.within(f"{name}: strength, of that of one point (Pa)", strength, -path(solid, rate, across).stress[:, 2].min(), 0.02),
                 gallery.within(f"{name}: strength, of that before damage (Pa)", strength, surface(solid, rate, across), 0.06, 0.01)]
    return [*rows, *(gallery.ledger(done[name], f"{name}: energy error over dissipated") for name in TESTS)]


def draw(setups, done):
    from drawing import BLUE, INK, RED, plt

    solid = point.Solid(point.preset("concrete-hjc"))
    figure, axes = plt.subplots()
    for (name, (rate, across)), color in zip(TESTS.items(), (BLUE, RED, INK)):
        strain, stress = pressed(done[name], rate)
        one = path(solid, rate, across)
        axes.plot(100 * strain, stress / 1e6, color=color, label=f"{rate:.0f}/s, {across / 1e6:.0f} MPa across")
        axes.plot(-100 * one.strain[:, 2], -one.stress[:, 2] / 1e6, color=color, linestyle="--", linewidth=1)
    axes.plot([], [], color=INK, linestyle="--", linewidth=1, label="one point")
    axes.set(xlabel="log. strain, compression (%)", ylabel="stress on the piston (MPa)", title="a block of concrete-hjc", xlim=(0, 1))
    axes.legend()
    return figure
