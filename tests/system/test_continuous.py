"""Shared nodes: what the copies of a node have in common, conservation, and the spall test with interfaces on the
middle plane alone."""

import numpy as np
import pytest
from conftest import CASES, example, rounding
from figures import ROUNDING
from test_invariance import drift, momentum_scale, spin
from test_spall import ARRIVAL, AREA, MEETING, STRESS, TOUGHNESS, passage, plateau
from test_waves import bar_half_period, half_period

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


def test_momenta_of_a_free_bar_are_constant(run, figure):
    """Nothing but rounding changes momentum and spin: there are no interfaces."""
    bar = run(CASES / "fragments.yaml", threads=2, sets={**WHOLE, "time.end": 1e-6, "output.fields": []})
    energy = bar.energy
    assert bar.summary["interfaces"] == 0 and bar.summary["fragments"] == 1
    figure("shared nodes: change of linear momentum", drift(energy, "momentum", momentum_scale(energy)),
           bound=rounding(4e-16, 1e-6), why=ROUNDING)
    figure("shared nodes: change of angular momentum", drift(energy, "angular", spin(energy)),
           bound=rounding(4e-16, 1e-4), why=ROUNDING)
    for name in ("penalty", "cohesive", "contact", "dissipated", "broken_area"):
        assert (energy[name] == 0).all(), name


def test_free_bar_rings_at_its_frequency(run, figure):
    """As late as the lumped mass is in the DG form: 5e-4."""
    sets = {**WHOLE, "time.end": 1.0, "time.steps": 4000, "output.interval": 10, "output.fields": []}
    bar = run(example("free-bar.yaml"), sets=sets)
    figure("free bar, shared nodes: half period against Rayleigh and Love", 1e6 * half_period(bar.energy),
           theory=1e6 * bar_half_period(), bound=1e-3, unit="us", relative=True)
    figure("free bar, shared nodes, 4,000 steps: energy error", bar.summary["energy_error_rel"], bound=1.5e-8)


@pytest.fixture(scope="module")
def plane(run):
    """The spall test with interfaces on the middle plane alone."""
    sets = {"interface.form": "continuous", "interface.faces": "abs(z) < 1e-6", "output.fields": ["crack"]}
    return run(example("spall.yaml"), threads=2, sets=sets)


def test_plane_breaks_when_the_waves_meet(plane, figure):
    assert plane.summary["interfaces"] == 72
    figure("spall, shared nodes: first fracture", 1e6 * plane.summary["first_fracture_time_s"], theory=1e6 * MEETING,
           bound=0.1, unit="us", relative=True)  # late like the lumped mass


def test_plane_costs_its_area_times_the_energy(plane, figure):
    assert plane.summary["failed_area_m2"] == pytest.approx(AREA, rel=rounding(1e-12, 1e-5))
    figure("spall, shared nodes: energy dissipated, against that of the flat plane", 1e6 * plane.summary["dissipated_J"],
           theory=1e6 * TOUGHNESS * AREA, bound=rounding(3e-15, 1e-5), unit="uJ", relative=True, why=ROUNDING)
    figure("spall, shared nodes: energy error", plane.summary["energy_error_rel"], bound=0.002)
    assert plane.summary["fragments"] == 2


@pytest.fixture(scope="module")
def lumped(run, spall):
    """The spall test in the DG form with the lumped mass, at the step size of the consistent one."""
    sets = {"mass": "lumped", "output.fields": []}
    critical = run(example("spall.yaml"), sets={**sets, "time.steps": 1}).summary["dt_critical"]
    safety = spall.summary["dt_first"] / critical
    return run(example("spall.yaml"), threads=2, sets={**sets, "time.end": 0.25e-6, "time.safety": safety})


def test_lumped_mass_is_late(lumped, spall, figure):
    assert lumped.summary["dt_first"] == pytest.approx(spall.summary["dt_first"], rel=1e-12)
    arrival = passage(lumped.history["time"], lumped.history["p1mm_szz"], STRESS / 2)
    figure("spall, lumped mass: arrival at the probe", 1e6 * arrival, theory=1e6 * ARRIVAL, bound=0.1, unit="us",
           relative=True)
    figure("spall, lumped mass: first fracture", 1e6 * lumped.summary["first_fracture_time_s"], theory=1e6 * MEETING,
           bound=0.1, unit="us", relative=True)


def test_stress_before_fracture_is_that_of_the_dg_form(plane, lumped, figure):
    """Both with the lumped mass. They differ in the ripples behind the front."""
    arrivals = [passage(h.history["time"], h.history["p1mm_szz"], STRESS / 2) for h in (plane, lumped)]
    figure("spall, shared nodes: arrival at the probe", 1e6 * arrivals[0], theory=1e6 * ARRIVAL, bound=0.1, unit="us",
           relative=True)
    figure("spall, shared nodes against the DG form with the lumped mass: arrival", 1e6 * arrivals[0],
           theory=1e6 * arrivals[1], bound=0.005, unit="us", relative=True)
    figure("spall, shared nodes: stress at the probe, first plateau", 1e-6 * plateau(plane.history, 0.17e-6),
           theory=1e-6 * STRESS, bound=0.0017, unit="MPa", relative=True)
    time = np.linspace(0, 0.22e-6, 500)
    one, other = (np.interp(time, h.history["time"], h.history["p1mm_szz"]) for h in (plane, lumped))
    late = time > 0.14e-6
    figure("spall, shared nodes against the DG form with the lumped mass: plateau to 0.22 us", 1e-6 * one[late].mean(),
           theory=1e-6 * other[late].mean(), bound=0.008, unit="MPa", relative=True)
    figure("spall, shared nodes against the DG form with the lumped mass: ripples apart (root mean square), of the stress",
           np.sqrt(np.mean((one - other) ** 2)) / STRESS, bound=0.1)


def test_selection_of_faces_must_be_finite(run):
    failed = run(CASES / "affine.yaml", sets={"interface.form": "continuous", "interface.faces": "1/(z - z)"}, expect=2)
    assert "interface.faces: 1/(z - z) is not finite" in failed.stderr


@pytest.mark.parametrize("ranks", [1, 2])
def test_selection_of_faces_must_hold_one(run, ranks):
    """On all ranks together: there is a face at the top on some of them only."""
    failed = run(CASES / "affine.yaml", ranks=ranks, sets={"interface.form": "continuous", "interface.faces": "z > 1e3"}, expect=2)
    assert "interface.faces: z > 1e3: no face is in it\n" in failed.stderr
