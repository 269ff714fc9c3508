"""Elastic waves in free bars: their speed, their energy, the order of convergence."""

import numpy as np
import pytest
from conftest import BENCH, CASES

YOUNG, POISSON, DENSITY = 260e9, 0.21, 3690.0  # of both cases

# ---- free-bar.yaml ----

BAR = {"time.end": 1.0, "time.steps": 20000, "output.interval": 20, "output.fields": []}


def bar_half_period():
    """First longitudinal mode of a free square bar, with the inertia of its lateral motion (Rayleigh, Love)."""
    length, side = 2e-3, 0.2e-3
    slender = length / np.sqrt(YOUNG / DENSITY)
    return slender * np.sqrt(1 + POISSON**2 * side**2 / 6 * (np.pi / length) ** 2)


def misfit(time, signal, frequency):
    """Squared distance of the signal from A + B cos 2wt + C sin 2wt."""
    base = np.stack([np.ones_like(time), np.cos(2 * frequency * time), np.sin(2 * frequency * time)], axis=1)
    return np.sum((base @ np.linalg.lstsq(base, signal, rcond=None)[0] - signal) ** 2)


def fit_frequency(time, signal, guess, span=1e-2):
    while span > 1e-9:
        trial = guess * (1 + span * np.linspace(-1, 1, 41))
        guess = trial[np.argmin([misfit(time, signal, w) for w in trial])]
        span /= 10
    return guess


def test_energy_stays_for_20000_steps(run):
    bar = run(BENCH / "free-bar.yaml", sets=BAR)
    assert bar.summary["steps"] == 20000
    assert bar.summary["energy_error_rel"] < 0.005


def test_bar_rings_at_its_frequency(run):
    energy = run(BENCH / "free-bar.yaml", sets=BAR).energy
    assert len(energy) == 1001
    frequency = fit_frequency(energy["time"], energy["kinetic"], np.pi / bar_half_period())
    assert np.pi / frequency == pytest.approx(bar_half_period(), rel=1e-4)


def test_incomplete_form_grows_without_bound(run):
    sets = {**BAR, "interface.form": "incomplete", "output.energy_limit": 1e9}
    bar = run(BENCH / "free-bar.yaml", sets=sets, expect=1)
    assert "the time step collapsed" in bar.stderr
    assert bar.summary["status"] != "completed" and bar.summary["steps"] < 20000
    total = bar.energy["total"]
    assert total[-1] > 1e3 * total[0] > 0


# ---- wave.yaml ----

LENGTH, SPEED = 1e-3, 1e-3  # m, m/s
FREQUENCY = np.pi / LENGTH * np.sqrt(YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON)) / DENSITY)
END = 0.8 * np.pi / FREQUENCY
CUBES = [4, 8, 16, 32]


class Wave:
    """The standing wave with one mass matrix, on any number of cubes, in equal steps."""

    def __init__(self, run, mass, form="variational"):
        self.run, self.method = run, {"mass": mass, "interface.form": form}
        self.steps = int(np.ceil(END / (0.15 * self.critical(CUBES[-1]))))

    def wave(self, cubes, **sets):
        # So little energy is of the size of its rounding errors: no limit.
        mesh = {"mesh.cells": [1, 1, cubes], "mesh.size": [LENGTH / cubes, LENGTH / cubes, LENGTH]}
        return self.run(CASES / "wave.yaml", sets={**mesh, **self.method, "output.energy_limit": 1e9, **sets})

    def critical(self, cubes):
        return self.wave(cubes, **{"time.steps": 1}).summary["dt_critical"]

    def error(self, cubes, steps):
        """Root mean square over the nodes, relative to the amplitude."""
        safety = END / steps / self.critical(cubes)
        run = self.wave(cubes, **{"time.end": END, "time.safety": safety})
        assert abs(run.summary["steps"] - steps) <= 1
        frame = run.frames()[-1]
        assert frame["time"] == pytest.approx(END, rel=1e-12)
        amplitude = SPEED / FREQUENCY
        exact = np.zeros_like(run.points())
        exact[:, 2] = -amplitude * np.sin(FREQUENCY * END) * np.cos(np.pi * run.points()[:, 2] / LENGTH)
        return np.sqrt(np.mean(np.sum((frame["displacement"] - exact) ** 2, axis=1))) / amplitude

    def orders(self):
        errors = np.array([self.error(cubes, self.steps) for cubes in CUBES])
        return np.log2(errors[:-1] / errors[1:])


def test_displacements_converge_with_order_3(run):
    assert (Wave(run, "consistent").orders() >= 2.7).all()


def test_lumped_mass_converges_with_order_2(run):
    assert (Wave(run, "lumped").orders() >= 1.8).all()


def test_shared_nodes_converge_with_order_2(run):
    assert (Wave(run, "lumped", "continuous").orders() >= 1.8).all()


def test_time_steps_are_small_enough_to_see_the_order(run):
    wave = Wave(run, "consistent")
    error = wave.error(16, wave.steps)
    assert wave.error(16, 2 * wave.steps) == pytest.approx(error, rel=0.01)
