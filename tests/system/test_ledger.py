"""What the ledger of any run has to fulfil."""

import numpy as np
import pytest
from conftest import CASES, example
from figures import ROUNDING

TOUGHNESS = 34.0  # J/m^2, of every case here
RUNS = {
    "spall": (example("spall.yaml"), {}),
    "jittered": (example("spall-jittered.yaml"), {"output.fields": ["crack"]}),
    "fragments": (CASES / "fragments.yaml", {}),
    "collision": (CASES / "collision.yaml", {}),
}


@pytest.fixture(params=RUNS)
def energy(request, run):
    case, sets = RUNS[request.param]
    energy = run(case, threads=2, sets=sets).energy
    assert len(energy) > 40 and energy["broken_area"][-1] > 0
    return energy


def test_cracks_never_heal(energy):
    for name in ("broken_area", "failed_area"):
        assert (np.diff(energy[name]) >= 0).all(), name
    assert (np.diff(energy["dissipated"]) >= -1e-14 * energy["dissipated"][-1]).all()  # a difference, so rounded


def test_dissipation_lies_between_failed_and_broken_area(energy):
    assert (energy["dissipated"] <= TOUGHNESS * energy["broken_area"] * (1 + 1e-12)).all()
    assert (energy["dissipated"] >= TOUGHNESS * energy["failed_area"] * (1 - 1e-12)).all()


def test_stored_energies_are_not_negative(energy):
    """But that of opened faces, which counts from the state at their switch (kernels/cohesive/conserving.h)."""
    for name in ("kinetic", "bodies", "bulk", "penalty", "contact", "dissipated"):
        assert (energy[name] >= -1e-9 * energy[name].max()).all(), name


def test_total_is_the_sum_of_its_parts(energy, figure):
    parts = sum(energy[name] for name in ("kinetic", "bodies", "bulk", "penalty", "cohesive", "contact", "foundation", "dissipated"))
    parts += energy["unresolved"] + energy["radiated"]
    scale = np.abs(energy["external_work"]).max() + parts.max()
    figure("ledger: total against the sum of its parts",
           np.abs(parts - energy["half_kick"] - energy["external_work"] - energy["total"]).max() / scale, bound=1e-15, why=ROUNDING)
    error = (energy["total"] - energy["total"][0])[1:] / np.maximum.accumulate(parts)[1:]
    figure("ledger: relative error against that of the total", np.abs(energy["error_rel"][1:] - error).max(), bound=1e-15,
           why=ROUNDING)


@pytest.mark.parametrize("jitter, velocity, before, bound", [(0, 15, 1.0, 0.4), (0.12, 15, 0.3, 0.1), (0, 40, 0.3, 0.2)])
def test_energy_of_a_violent_break_holds(run, figure, jitter, velocity, before, bound):
    """The first 500 steps of the bars of bench/examples/endurance, undamped; in %, where `before` is passed by defaults 0."""
    sets = {"mesh.jitter": jitter, "initial.velocity": {"z": f"-{velocity}*cos(pi*z/4e-3)"}, "time.steps": 500,
            "viscosity.linear": 0, "output.interval": 10, "output.fields": []}
    old = run(example("endurance.yaml"), threads=2, sets={**sets, "defaults": 0})
    torn = run(example("endurance.yaml"), threads=2, sets=sets)
    assert old.summary["energy_error_rel"] > before / 100
    figure(f"bar torn at {velocity} m/s, jittered by {jitter}: energy error after 500 steps",
           torn.summary["energy_error_rel"], bound=bound / 100)
    energy = torn.energy
    assert energy["broken_area"][-1] > 1e-6 and energy["failed_area"][-1] > 0.5e-6
    assert (np.diff(energy["dissipated"]) >= -1e-14 * energy["dissipated"][-1]).all()
    assert (energy["dissipated"] <= TOUGHNESS * energy["broken_area"] * (1 + 1e-12)).all()
    assert (energy["dissipated"] >= TOUGHNESS * energy["failed_area"] * (1 - 1e-12)).all()


@pytest.mark.parametrize("name, bound, later", [("spall", 3e-6, 2e-6), ("jittered", 1.5e-6, 1e-6)])
def test_work_of_the_ends_is_accounted_for(run, figure, name, bound, later):
    case, sets = RUNS[name]
    spall = run(case, threads=2, sets=sets)
    whole = spall.energy[spall.energy["time"] < spall.summary["first_fracture_time_s"]]
    assert len(whole) > 20 and whole["external_work"][-1] > 1e-5
    mesh = "regular" if name == "spall" else name
    change, largest = np.abs(whole["total"] - whole["total"][0]), (whole["total"] + whole["external_work"]).max()
    figure(f"spall, {mesh}: energy error until it breaks", change.max() / largest, bound=bound)
    first = change[1:3].mean()  # what the sudden start of the ends costs, of order (omega dt)^2; nothing is added to it
    figure(f"spall, {mesh}: energy error until it breaks, but for the first output", np.abs(change[1:] - first).max() / largest,
           bound=later)
    assert whole["time"][0] == 0 and whole["kinetic"][0] == pytest.approx(whole["external_work"][0], rel=1e-12)  # of the jump


@pytest.mark.parametrize("velocity, bound, share", [(15, 0.005, 0.012), (40, 0.003, 0.03)])
def test_energy_of_a_bar_torn_to_pieces(run, figure, velocity, bound, share):
    torn = run(example("torn-bar.yaml"), threads=2, sets={"initial.velocity.z": f"-{velocity}*cos(pi*z/4e-3)", "time.end": 1e-6, "output.fields": []})
    figure(f"bar torn at {velocity} m/s: energy error after 1 us", torn.summary["energy_error_rel"], bound=bound)
    figure(f"bar torn at {velocity} m/s: energy error after 1 us, of the dissipated", torn.summary["energy_error_dissipated"], bound=share)
