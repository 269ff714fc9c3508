"""The Deshpande-Evans ceramic in a run: its elastic limit, the ledger, and the same bits on any layout."""

import numpy as np
import pytest
from conftest import CASES, SINGLE, example
from figures import ROUNDING
from test_parallel import LAYOUTS, assert_same_bits

pytestmark = pytest.mark.skipif(SINGLE, reason="the ceramic needs double precision")

CERAMIC = CASES / "ceramic.yaml"
SHEAR, POISSON = 146e9, 0.2
INITIAL_DAMAGE = 4 / 3 * np.pi * (19e-6 / np.sqrt(2)) ** 3 * 1e12
BREAKS = {"interface": {"law": "linear", "strength": 400e6, "energy": 34, "beta": 0}}


def collision(speed):
    return {"initial.velocity.z": f"-{speed}*tanh(z/0.1e-3)"}


# ---- Elastic limit ----

ELASTIC = {"time.end": 0.1e-6, "output.interval": 0.1e-6, "output.fields": ["displacement", "stress"]}
NO_FLAWS = {"material.flaw_density": 1e-3, "material.toughness": 1e9, "material.yield_stress": 1e15}
NEO_HOOKEAN = {"material": {"model": "neo-hookean", "young": 2 * SHEAR * (1 + POISSON), "poisson": POISSON,
                            "density": 3700}}


def test_without_flaws_and_flow_small_strains_are_those_of_the_elastic_solid(run, figure):
    def difference(speed):
        sets = {**ELASTIC, **collision(speed)}
        ceramic = run(CERAMIC, sets={**sets, **NO_FLAWS}).frames()[-1]
        elastic = run(CERAMIC, sets={**sets, **NEO_HOOKEAN}).frames()[-1]
        return np.array([np.abs(ceramic[name] - elastic[name]).max() / np.abs(elastic[name]).max()
                         for name in ELASTIC["output.fields"]])

    large, small = difference(4.0), difference(0.4)  # strains of 4e-4 and 4e-5
    assert (large < 2e-3).all() and (small > 1e-7).all()
    for name, ratio, bound in zip(ELASTIC["output.fields"], large / small, (2e-4, 3e-4)):  # of first order in the strain
        figure(f"ceramic without flaws against neo-hookean: {name} apart at 10 times the strain, over that at one", ratio,
               theory=10, bound=bound, relative=True)


# ---- Ledger ----


FORMS = {"variational": {}, "incomplete": {"interface.form": "incomplete", "interface.beta_s": 40}}


@pytest.fixture(params=FORMS)
def form(request):
    return request.param


@pytest.fixture
def crushed(run, form):
    return run(CERAMIC, sets={"time.end": 0.1e-6, **FORMS[form]})


def test_ledger_closes_where_cracks_grow_and_the_solid_flows(crushed, form, figure):
    energy = crushed.energy
    assert crushed.summary["status"] == "completed"
    assert crushed.summary["plastic_J"] > 1e-4 * energy["kinetic"][0]
    assert crushed.summary["damage_J"] > 0.02 * energy["kinetic"][0]
    figure(f"ceramic halves that collide at 1400 m/s, {form} form: energy error", np.abs(energy["error_rel"]).max(),
           bound={"variational": 3e-3, "incomplete": 4.5e-3}[form])
    assert (np.diff(energy["plastic"]) >= 0).all()
    parts = ("kinetic", "bulk", "penalty", "cohesive", "contact", "dissipated", "plastic", "damage")
    assert np.allclose(sum(energy[name] for name in parts) - energy["half_kick"] - energy["external_work"], energy["total"], rtol=1e-12)


def test_fields_show_what_the_material_did(crushed, figure):
    last = crushed.frames()[-1]
    assert (last["damage"] >= INITIAL_DAMAGE * (1 - 1e-12)).all() and 0.9 < last["damage"].max() < 1
    assert set(np.unique(last["regime"])) <= {1, 2, 3} and last["plastic_strain"].max() > 5e-4
    s = last["stress"]  # xx xy xz yy yz zz
    mean = (s[:, 0] + s[:, 3] + s[:, 5]) / 3
    mises = np.sqrt(1.5 * ((s[:, [0, 3, 5]] - mean[:, None]) ** 2).sum(axis=1) + 3 * (s[:, [1, 2, 4]] ** 2).sum(axis=1))
    figure("ceramic: mean stress by the field of triaxiality, of the largest stress",
           np.abs(last["triaxiality"].ravel() * mises - mean).max() / np.abs(s).max(), bound=5e-16, why=ROUNDING)


def test_fields_of_the_virgin_material(run):
    first = run(CERAMIC, sets={"time.steps": 1, "output.interval": 1}).frames()[0]
    assert np.allclose(first["damage"], INITIAL_DAMAGE, rtol=1e-12)
    for name in ("plastic_strain", "regime", "triaxiality"):
        assert (first[name] == 0).all()


# ---- Bits ----


@pytest.mark.parametrize("ranks, threads", LAYOUTS)
def test_a_ceramic_that_cracks_and_flows_is_the_same_on_any_layout(run, ranks, threads):
    sets = {**BREAKS, "time.end": 0.1e-6, "output.energy_limit": 1e9}
    one, other = run(CERAMIC, sets=sets), run(CERAMIC, ranks=ranks, threads=threads, sets=sets)
    assert one.summary["plastic_J"] > 0 and one.summary["damage_J"] != 0 and one.summary["broken_area_m2"] > 0
    assert_same_bits(one, other)


def test_hash_knows_the_history(run):
    sets = {"time.end": 2e-8, **collision(100)}
    one = run(CERAMIC, sets={**sets, "material.growth_speed": 1e-12})
    other = run(CERAMIC, sets={**sets, "material.growth_speed": 1.0001e-12})
    assert one.summary["state_hash"] != other.summary["state_hash"]


def test_output_does_not_advance_the_history(run):
    often = run(CERAMIC, sets={"time.end": 5e-8, "output.interval": 1, "output.fields": []})
    seldom = run(CERAMIC, sets={"time.end": 5e-8, "output.interval": 5e-8, "output.fields": []})
    assert often.summary["state_hash"] == seldom.summary["state_hash"]


# ---- Strength ----

DIGITS = "theory has two or three digits"


@pytest.mark.parametrize("load, sign, end, strength, strain", [
    ("compression", -1, 1.2e-6, 3.94, 1.14), ("tension", 1, 0.45e-6, 1.21, 0.41)])
def test_uniaxial_strength_is_that_of_a_point(run, figure, load, sign, end, strength, strain):
    """kernels/material/deshpande_evans_model.h has the strengths of a point, at 1e4/s: in GPa, at a strain in %."""
    rate = sign * 1e4
    sets = {"initial.velocity": {"x": f"{-0.2 * rate}*x", "y": f"{-0.2 * rate}*y", "z": f"{rate}*z"},
            "boundary": [{"set": side, "component": "z", "velocity": f"{rate}*z"} for side in ("z-", "z+")],
            "time.end": end, "output.energy_limit": 1e9}
    history = run(example("ceramic-cube.yaml"), sets=sets).history
    top = np.argmax(np.abs(history["middle_szz"]))
    figure(f"ceramic cube, {load} at 1e4/s: strength", 1e-9 * abs(history["middle_szz"][top]), theory=strength, bound=0.006,
           unit="GPa", relative=True, why=DIGITS)
    figure(f"ceramic cube, {load} at 1e4/s: strain there", 100 * abs(rate * history["time"][top]), theory=strain,
           bound=0.015, unit="%", relative=True, why=DIGITS)
    assert abs(history["middle_szz"][-1]) < 0.6e9 * strength


@pytest.mark.parametrize("safety, bound", [(0.5, 0.03), (0.25, 0.012)])
def test_ledger_of_a_cube_that_fails_all_at_once(run, figure, safety, bound):
    """What is lost within a few steps is seen to first order in the step."""
    cube = run(example("ceramic-cube.yaml"), sets={"time.safety": safety})
    assert cube.summary["damage_J"] > 0.25 * cube.summary["energy_largest_J"]
    figure(f"ceramic cube that is crushed, at {safety} of the critical step: energy error", cube.summary["energy_error_rel"],
           bound=bound)
