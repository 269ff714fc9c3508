"""The linear elastic, St. Venant-Kirchhoff and J2 solids in a run: waves, ledger, and the same bits on any layout."""

import numpy as np
import pytest
import rhegma
from conftest import CASES, SINGLE, example, launch, overrides, rounding
from figures import ROUNDING
from test_parallel import LAYOUTS, assert_same_bits

PLASTIC = CASES / "plastic.yaml"
YOUNG, POISSON, DENSITY, YIELD, HARDENING = 70e9, 0.3, 2700, 200e6, 5e9  # of that case
G, K = YOUNG / 2 / (1 + POISSON), YOUNG / 3 / (1 - 2 * POISSON)
ELASTIC_SPEED = np.sqrt((K + 4 / 3 * G) / DENSITY)
PLASTIC_SPEED = np.sqrt((K + 4 / 3 * G * HARDENING / (3 * G + HARDENING)) / DENSITY)
LIMIT = YIELD * (K + 4 / 3 * G) / (2 * G)

double_only = pytest.mark.skipif(SINGLE, reason="J2 plasticity needs double precision")
TORN = example("torn-bar.yaml")
SOLIDS = {
    "linear": {"material.model": "linear-elastic"},
    "kirchhoff": {"material.model": "st-venant-kirchhoff"},
    "metal": {"material.model": "j2", "material.yield_stress": 300e6, "material.hardening": 20e9,
              "material.saturation_stress": 350e6, "material.saturation_rate": 500},
    "flowing": {"interface.strength": 60e6, "material": {"preset": "copper-ofhc", "yield_stress": 120e6, "density": 3000},
                "materials": [{"name": "glass", "where": "z > 2.2e-3", "preset": "float-glass-jh2", "density": 3000,
                               "intact_strength": 0.05},
                              {"name": "polymer", "where": "z < 1e-3", "preset": "pmma-viscoelastic", "young": 124e9,
                               "density": 3000},
                              {"name": "rock", "where": "z > 1.7e-3 && z < 2.2e-3", "preset": "berea-sandstone", "young": 124e9,
                               "density": 3000, "cohesion": 100e6, "cap_pressure": 150e6, "cap_ratio": 0.3},
                              {"name": "concrete", "where": "z > 1.3e-3 && z < 1.7e-3", "preset": "concrete-hjc", "young": 124e9,
                               "density": 3000, "compressive_strength": 150e6}]},
}
EACH = [pytest.param(name, marks=[double_only] if name in ("metal", "flowing") else []) for name in SOLIDS]
SHORT = {"mesh.cells": [2, 2, 20], "mesh.jitter": 0.1, "time.end": 0.35e-6, "initial.velocity.z": "-40*cos(pi*z/4e-3)",
         "output.interval": 0.05e-6, "output.fields": [],
         "output.probes": [{"name": "a", "at": [0.11e-3, 0.13e-3, 1.9e-3]}]}


@pytest.mark.parametrize("ranks, threads", LAYOUTS)
@pytest.mark.parametrize("solid", EACH)
def test_a_torn_bar_is_the_same_on_any_layout(run, solid, ranks, threads):
    sets = {**SHORT, **SOLIDS[solid]}
    one, other = run(TORN, sets=sets), run(TORN, ranks=ranks, threads=threads, sets=sets)
    assert one.summary["broken_area_m2"] > 0
    assert solid not in ("metal", "flowing") or one.summary["plastic_J"] > 0
    assert solid != "flowing" or one.summary["damage_J"] != 0
    assert_same_bits(one, other)


FORMS = {
    "incomplete": {"interface.form": "incomplete", "interface.beta_s": 40},
    "intrinsic": {"interface.form": "intrinsic", "interface.law": "exponential"},
    "continuous": {"interface.form": "continuous", "interface.faces": "abs(z - 2e-3) < 1e-6", "mass": "lumped"},
}


@pytest.mark.parametrize("form, bound", [("incomplete", 0.01), ("intrinsic", 4e-4), ("continuous", 3e-3)])
@pytest.mark.parametrize("solid", EACH)
def test_every_form_takes_every_solid(run, figure, solid, form, bound):
    sets = {**SHORT, "mesh.cells": [1, 1, 10], "time.end": 0.2e-6, **SOLIDS[solid],
            **FORMS[form]}
    summary = run(TORN, sets=sets).summary
    assert summary["status"] == "completed"
    figure(f"torn bar, worst solid, {form} form: energy error", summary["energy_error_rel"], bound=bound)
    assert solid != "metal" or summary["plastic_J"] > 0


# ---- Elastic solids ----

QUIET = {"interface": {"law": "none"}, "mesh.cells": [2, 2, 20], "time.end": 0.3e-6, "output.interval": 0.3e-6,
         "output.fields": ["stress"], "output.energy_limit": 1e9}


@pytest.mark.parametrize("model, bound", [("linear-elastic", 5.5e-3), ("st-venant-kirchhoff", 0.03)])
def test_small_strains_are_those_of_the_neo_hookean_solid(run, figure, model, bound):
    def difference(speed):
        sets = {**QUIET, "initial.velocity.z": f"-{speed}*cos(pi*z/4e-3)"}
        one = run(TORN, sets=sets).frames()[-1]["stress"]
        other = run(TORN, sets={**sets, "material.model": model}).frames()[-1]["stress"]
        return np.abs(one - other).max() / np.abs(one).max()

    large, small = difference(40), difference(4)
    assert 1e-5 < small < 2e-3
    figure(f"{model} against neo-hookean: stress apart at 10 times the strain, over that at one", large / small, theory=10,
           bound=rounding(bound, 0.15), relative=True)  # of first order in the strain


def test_a_spinning_body_grows_if_it_is_linear(run, figure):
    """A cube that spins freely keeps its size, but for what the centrifugal force stretches it. The linear solid feels
    nothing of u = t w x r, however large: its points fly along tangents, and it grows by sqrt(1 + (w t)^2)."""
    rate, end = 0.8e6, 1e-6  # rad/s, s
    sets = {"mesh": {"cells": [1, 1, 1], "size": [0.2e-3, 0.2e-3, 0.2e-3], "origin": [-0.1e-3, -0.1e-3, -0.1e-3]},
            "interface": {"law": "none"}, "initial.velocity": {"x": f"-{rate}*y", "y": f"{rate}*x"}, "time.end": end,
            "output.interval": end, "output.fields": ["displacement"], "output.energy_limit": 1e9}

    def growth(model):
        one = run(TORN, sets={**sets, "material.model": model})
        before = one.points()
        after = before + one.frames()[-1]["displacement"]
        corner = np.abs(before).min(axis=1) > 0.09e-3
        return np.hypot(*after[corner, :2].T) / np.hypot(*before[corner, :2].T)

    def worst(model, theory):
        return max(growth(model), key=lambda size: abs(size - theory))

    for model in ("neo-hookean", "st-venant-kirchhoff"):
        figure(f"spinning cube, {model}: size over that at the start", worst(model, 1), theory=1, bound=8e-5,
               relative=True)
    theory = np.sqrt(1 + (rate * end) ** 2)
    figure("spinning cube, linear-elastic: size over that at the start", worst("linear-elastic", theory), theory=theory,
           bound=rounding(2e-14, 1.8e-6), relative=True, why=ROUNDING)


def test_check_tells_the_material(tmp_path):
    said = launch("check", TORN, *overrides(SOLIDS["linear"]), cwd=tmp_path).stdout
    assert "material       linear-elastic: for small strains and rotations alone\n" in said
    said = launch("check", TORN, *overrides(SOLIDS["kirchhoff"]), cwd=tmp_path).stdout
    assert "material       st-venant-kirchhoff\n" in said and "plastic" not in said


@double_only
def test_check_tells_the_plastic_waves(tmp_path):
    said = launch("check", PLASTIC, cwd=tmp_path).stdout
    assert f"plastic waves  {PLASTIC_SPEED:.1f} m/s, beyond {LIMIT:.4g} Pa in uniaxial strain\n" in said


# ---- Plastic waves ----


def simple_wave():
    """Particle speed, stress and wave speed over the material, from rest on, along a simple wave of uniaxial strain:
    with the logarithmic strain e = log(lambda), tau the Kirchhoff stress, P = tau/lambda, c = sqrt(dP/dlambda/rho) and
    dv = -c dlambda."""
    strain = -np.linspace(0, 0.02, 20001)
    elastic = K + 4 / 3 * G
    tau = np.maximum(elastic * strain, -LIMIT + DENSITY * PLASTIC_SPEED**2 * (strain + LIMIT / elastic))
    stretch = np.exp(strain)
    speed = np.sqrt(np.diff(tau / stretch) / np.diff(stretch) / DENSITY)
    return np.cumsum(-speed * np.diff(stretch)), (-tau / stretch)[1:], speed


@double_only
def test_plastic_wave_follows_an_elastic_precursor(run, figure):
    """Uniaxial strain, an end pushed at 60 m/s: a precursor of the elastic limit, then a wave at the plastic speed."""
    history = run(PLASTIC).history
    time, stress, speed = history["time"], -history["p4_szz"], history["p4_vz"]
    v, sigma, c = simple_wave()
    first, last = LIMIT / (DENSITY * ELASTIC_SPEED), 60
    rising = speed[:np.argmax(speed > 0.98 * last)]
    late = {}
    for level in (first / 2, 30, 40, 50):  # m/s: passes the probe 4 mm away so long after the end moved at that speed
        travelled = np.interp(level, rising, time[:len(rising)]) - 0.1e-6 * np.arctanh(level / last)
        late[level] = travelled / (4e-3 / np.interp(level, v, c)) - 1
    figure("plastic wave: passage of the precursor, relative", late.pop(first / 2), bound=6e-5)
    figure("plastic wave: passage of 30, 40 and 50 m/s, relative", max(late.values(), key=abs), bound=1.8e-3)
    between, after = (time > 0.76e-6) & (time < 0.83e-6), time > 1.4e-6
    figure("plastic wave: speed behind the precursor", np.mean(speed[between]), theory=first, bound=1.7e-3, unit="m/s",
           relative=True)
    figure("plastic wave: stress behind the precursor", 1e-6 * np.mean(stress[between]),
           theory=1e-6 * np.interp(first, v, sigma), bound=1.8e-3, unit="MPa", relative=True)
    figure("plastic wave: speed behind the wave", np.mean(speed[after]), theory=last, bound=3e-4, unit="m/s", relative=True)
    figure("plastic wave: stress behind the wave", 1e-6 * np.mean(stress[after]), theory=1e-6 * np.interp(last, v, sigma),
           bound=4.5e-4, unit="MPa", relative=True)


@double_only
def test_ledger_of_a_plastic_wave(run, figure):
    energy = run(PLASTIC).energy
    assert energy["plastic"][-1] > 0.05 * energy["kinetic"].max() and (energy["damage"] == 0).all()
    assert (np.diff(energy["plastic"]) >= 0).all()
    figure("plastic wave: energy error", np.abs(energy["error_rel"]).max(), bound=1.2e-4)
    parts = ("kinetic", "bulk", "penalty", "cohesive", "contact", "dissipated", "plastic", "damage")
    assert np.allclose(sum(energy[name] for name in parts) - energy["external_work"], energy["total"], rtol=1e-12)


@double_only
def test_fields_show_the_plastic_strain(run, figure):
    last = run(PLASTIC).frames()[-1]
    assert "damage" not in last and "regime" not in last
    strain, stress = last["plastic_strain"].ravel(), last["stress"]  # xx xy xz yy yz zz
    mean = (stress[:, 0] + stress[:, 3] + stress[:, 5]) / 3
    mises = np.sqrt(1.5 * ((stress[:, [0, 3, 5]] - mean[:, None]) ** 2).sum(axis=1)
                    + 3 * (stress[:, [1, 2, 4]] ** 2).sum(axis=1))
    figure("plastic wave: mean stress by the field of triaxiality, of the largest stress",
           np.abs(last["triaxiality"].ravel() * mises - mean).max() / np.abs(stress).max(), bound=5e-16, why=ROUNDING)
    flowed = strain > 1e-3
    assert flowed.sum() > 100 and (strain >= 0).all() and (strain[-20:] == 0).any()
    # Cauchy stress, not Kirchhoff's, and fields are means over the points of an element
    figure("plastic wave: von Mises stress in the fields against the yield curve, relative",
           np.abs(mises[flowed] / (YIELD + HARDENING * strain[flowed]) - 1).max(), bound=0.02)


@double_only
def test_fields_show_the_heat_of_flow(run, figure):
    """Nine tenths of the plastic work of a metal stay where it flowed; another one beside it has no temperature."""
    sets = {**SHORT, "material": {"preset": "copper-ofhc"}, "interface": {"law": "none"}, "output.fields": ["temperature", "plastic_strain"],
            "materials": [{"name": "stiff", "where": "z > 3e-3", "model": "neo-hookean", "young": 124e9, "poisson": 0.34, "density": 8960}]}
    one = run(TORN, sets=sets)
    points, cells = rhegma.mesh(one.dir)
    last, corner = one.frames()[-1], points[cells[:, :4]]
    volume = np.abs(np.linalg.det(corner[:, 1:] - corner[:, :1])) / 6
    copper, rise = corner[:, :, 2].mean(axis=1) < 3e-3, last["temperature"].ravel() - 294
    assert (rise[copper] >= 0).all() and rise.max() > 0.5 and (rise[~copper] == -294).all()
    figure("Johnson-Cook: heat in the field of temperature over 0.9 of the plastic work", 8960 * 383 * (volume * rise)[copper].sum() / 0.9
           / one.summary["plastic_J"], theory=1, bound=3e-13, why=ROUNDING)


@double_only
def test_output_does_not_flow(run):
    sets = {"time.end": 2e-7, "output.fields": []}
    often = run(PLASTIC, sets={**sets, "output.interval": 1})
    seldom = run(PLASTIC, sets={**sets, "output.interval": 2e-7})
    assert often.summary["plastic_J"] > 0
    assert often.summary["state_hash"] == seldom.summary["state_hash"]


# ---- Rock ----


@double_only
@pytest.mark.parametrize("across", [0, 40])
def test_triaxial_compression(run, figure, across, tmp_path):
    """The example, without pressure across up to 64.5 us, where it has flowed for 20 us, two periods in which it breathes by 5 %;
    theory is Mohr and Coulomb's."""
    case = tmp_path / "triaxial.yaml"
    case.write_text(example("triaxial.yaml").read_text().replace("40e6*min", f"{across}e6*min"))
    done = run(case, sets={"time.end": 120e-6 if across else 64.5e-6, "output.fields": []})
    history, phi, cohesion = done.history, np.radians(37), 18.5
    flows = history["time"] > (100e-6 if across else 43.5e-6)
    theory = (2 * cohesion * np.cos(phi) + (1 + np.sin(phi)) * across) / (1 - np.sin(phi))
    figure(f"sandstone, {across} MPa across: axial stress", -1e-6 * history["middle_szz"][flows].mean(), theory=theory,
           bound=8e-4 if across else 2e-3, unit="MPa", relative=True)
    assert abs(history["middle_sxx"][flows].mean() + across * 1e6) < 0.1e6
    figure(f"sandstone, {across} MPa across: energy error", done.summary["energy_error_rel"], bound=1e-6)
    assert done.summary["plastic_J"] > 0.05
