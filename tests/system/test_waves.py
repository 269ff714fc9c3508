"""Elastic waves in free bars: their speed, their energy, the order of convergence."""

import numpy as np
import pytest
from conftest import CASES, example

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


def half_period(energy):
    return np.pi / fit_frequency(energy["time"], energy["kinetic"], np.pi / bar_half_period())


def test_energy_stays_for_20000_steps(run, figure):
    bar = run(example("free-bar.yaml"), sets=BAR)
    assert bar.summary["steps"] == 20000
    figure("free bar, 20,000 steps: energy error", bar.summary["energy_error_rel"], bound=1e-8)


@pytest.mark.parametrize("mass, bound", [("consistent", 2e-5), ("lumped", 1.4e-3)])
def test_bar_rings_at_its_frequency(run, figure, mass, bound):
    sets = BAR if mass == "consistent" else {**BAR, "time.steps": 4000, "output.interval": 10, "mass": mass}
    energy = run(example("free-bar.yaml"), sets=sets).energy
    assert len(energy) > 400
    figure(f"free bar, {mass} mass: half period against Rayleigh and Love", 1e6 * half_period(energy),
           theory=1e6 * bar_half_period(), bound=bound, unit="us", relative=True)


def test_incomplete_form_grows_without_bound(run, figure):
    sets = {**BAR, "interface.form": "incomplete", "output.energy_limit": 1e9}
    bar = run(example("free-bar.yaml"), sets=sets, expect=1)
    assert "the time step collapsed" in bar.stderr
    assert bar.summary["status"] != "completed"
    figure("free bar, incomplete form: steps until it is lost", bar.summary["steps"], bound=500, unit="steps")
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


@pytest.mark.parametrize("form, mass, theory, bound", [
    ("variational", "consistent", 3, 0.1), ("variational", "lumped", 2, 0.2), ("continuous", "lumped", 2, 0.09)])
def test_displacements_converge(run, figure, form, mass, theory, bound):
    orders = Wave(run, mass, form).orders()
    assert (orders > theory - 0.15).all()
    figure(f"standing wave, {form} form, {mass} mass: order of convergence, 16 to 32 cubes", orders[-1], theory=theory,
           bound=bound)


def test_time_steps_are_small_enough_to_see_the_order(run, figure):
    wave = Wave(run, "consistent")
    error = wave.error(16, wave.steps)
    figure("standing wave: error with half the steps, over that with all", wave.error(16, 2 * wave.steps) / error, theory=1,
           bound=1.5e-4)
