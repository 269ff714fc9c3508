"""Shared nodes: what the copies of a node have in common, conservation, and the spall test with interfaces on the
middle plane alone."""

import numpy as np
import pytest
from conftest import BENCH, CASES, rounding
from test_invariance import drift, momentum_scale, spin
from test_waves import bar_half_period, fit_frequency

WHOLE = {"interface.form": "continuous", "interface.faces": 0}  # with any case: nothing breaks


@pytest.mark.parametrize("ranks", [1, 3])
def test_copies_of_a_node_have_the_same_bits(run, ranks):
    """On a jittered, turning bar, by their places in the mesh."""
    sets = {**WHOLE, "time.end": 0.05e-6, "output.fields": ["displacement", "velocity"]}
    bar = run(CASES / "fragments.yaml", ranks=ranks, sets=sets)
    _, node = np.unique(bar.points(), axis=0, return_inverse=True)
    assert node.max() + 1 == 5 * 5 * 33  # of 10-node tetrahedra in 2 x 2 x 16 cubes
    assert bar.summary["dofs"] == 3 * 5 * 5 * 33
    last = bar.frames()[-1]
    for name in ("displacement", "velocity"):
        first = np.zeros((node.max() + 1, 3))
        first[node] = last[name]
        assert np.array_equal(first[node], last[name]) and np.abs(first).min() > 0


def test_momenta_and_energy_of_a_free_bar_are_constant(run):
    """Nothing but rounding changes momentum and spin: there are no interfaces."""
    bar = run(CASES / "fragments.yaml", threads=2, sets={**WHOLE, "time.end": 1e-6, "output.fields": []})
    energy = bar.energy
    assert bar.summary["interfaces"] == 0 and bar.summary["fragments"] == 1
    assert drift(energy, "momentum", momentum_scale(energy)) < rounding(1e-14, 1e-6)
    assert drift(energy, "angular", spin(energy)) < rounding(1e-14, 1e-4)
    for name in ("penalty", "cohesive", "contact", "dissipated", "broken_area"):
        assert (energy[name] == 0).all(), name


def test_free_bar_rings_at_its_frequency(run):
    """As late as the lumped mass is in the DG form: 5e-4."""
    sets = {**WHOLE, "time.end": 1.0, "time.steps": 4000, "output.interval": 10, "output.fields": []}
    bar = run(BENCH / "free-bar.yaml", sets=sets)
    frequency = fit_frequency(bar.energy["time"], bar.energy["kinetic"], np.pi / bar_half_period())
    assert np.pi / frequency == pytest.approx(bar_half_period(), rel=1e-3)
    assert bar.summary["energy_error_rel"] < 5e-4


@pytest.fixture(scope="module")
def plane(run):
    """The spall test with interfaces on the middle plane alone."""
    sets = {"interface.form": "continuous", "interface.faces": "abs(z) < 1e-6", "output.fields": ["crack"]}
    return run(BENCH / "spall.yaml", threads=2, sets=sets)


def test_plane_breaks_when_the_waves_meet(plane):
    assert plane.summary["interfaces"] == 72
    assert plane.summary["first_fracture_time_s"] == pytest.approx(0.2246e-6, rel=0.08)  # lumped mass: 6 % late


def test_plane_costs_its_area_times_the_energy(plane):
    assert plane.summary["failed_area_m2"] == pytest.approx(0.16e-6, rel=rounding(1e-12, 1e-5))
    assert plane.summary["dissipated_J"] == pytest.approx(34 * 0.16e-6, rel=rounding(1e-12, 1e-5))
    assert plane.summary["energy_error_rel"] < 0.005
    assert plane.summary["fragments"] == 2


def test_stress_before_fracture_is_that_of_the_dg_form(plane, run):
    """Both with the lumped mass. They differ in the ripples behind the front."""
    dg = run(BENCH / "spall.yaml", threads=2, sets={"mass": "lumped", "output.fields": [], "time.end": 0.22e-6})
    time = np.linspace(0, 0.22e-6, 500)
    one, other = (np.interp(time, h.history["time"], h.history["p1mm_szz"]) for h in (plane, dg))
    assert abs(np.argmax(one > 100e6) - np.argmax(other > 100e6)) * 0.22e-6 / 500 < 0.02 * 0.1123e-6
    late = time > 0.14e-6
    assert one[late].mean() == pytest.approx(other[late].mean(), rel=0.01)
    assert one[late].mean() == pytest.approx(200e6, rel=0.02)
    assert np.sqrt(np.mean((one - other) ** 2)) < 0.05 * 200e6


def test_selection_of_faces_must_be_finite(run):
    failed = run(CASES / "affine.yaml", sets={"interface.form": "continuous", "interface.faces": "1/(z - z)"}, expect=2)
    assert "interface.faces: 1/(z - z) is not finite" in failed.stderr
