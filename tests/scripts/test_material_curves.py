"""bench/studies/material-curves and bench/point.py: what the pictures of the solids show, against closed forms written anew."""

import math

import numpy as np
import pictures
import pytest
from conftest import SINGLE

import launch
import point
import rhegma
from drawing import plt

study = pictures.script("bench/studies/material-curves")
pytestmark = pytest.mark.skipif(SINGLE, reason="points are in double precision: once is enough")


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def panels(name):
    """The solid and the panels of its picture, which can be read."""
    solid = study.solid_of(name, [])
    figure = study.SOLIDS[name](solid)
    pictures.assert_readable(figure)
    pictures.assert_panels_apart(figure)
    return solid, figure.axes


def titles(axes):
    return [(pictures.title(one), one.get_xlabel(), one.get_ylabel()) for one in axes]


def apart(axes, label, other="theory"):
    """The largest difference of two lines over the largest value, where both are there."""
    (x, y), (at, expected) = pictures.line(axes, label), pictures.line(axes, other)
    there = ~np.isnan(expected)
    if len(at) == len(x) and np.array_equal(at, x):
        return abs(y - expected)[there].max() / abs(y).max()
    return abs(np.interp(at, x, y) - expected).max() / abs(y).max()


STRETCHED = [("uniaxial strain", "stretch", "nominal stress (GPa)"), ("uniaxial stress", "stretch", "nominal stress (GPa)")]


def test_every_model_is_drawn():
    """But linear-elastic, whose curves are straight, and the user's own."""
    models = [word for word in rhegma.parse_yaml(launch.call([launch.program(), "keys", "--schema"]).stdout)
              ["properties"]["material"]["properties"]["model"]["enum"]]
    assert set(study.SOLIDS) == set(models) - {"linear-elastic", "user"}


@pytest.mark.parametrize("name", ["neo-hookean", "st-venant-kirchhoff"])
def test_elastic(name):
    solid, (held, free) = panels(name)
    assert titles([held, free]) == STRETCHED
    assert apart(held, "held across") < 1e-3  # of the interpolation
    x, y = pictures.line(free, "free across")
    assert np.interp(1.01, x, y) == pytest.approx(3.24 * 0.01, rel=0.03)  # the preset's Young's modulus, GPa
    if name == "neo-hookean":  # at half the length, with lambda = E nu/((1 + nu)(1 - 2 nu)): 2.8 and 1.2 GPa
        x, y = pictures.line(held, "held across")
        assert np.interp(0.5, x, y) == pytest.approx(2.8 * math.log(0.5) / 0.5 + 1.2 * (0.5 - 2), rel=1e-3)
    else:  # softest at 1/sqrt 3
        x, y = pictures.line(held, "held across")
        assert x[y.argmin()] == pytest.approx(3**-0.5, abs=0.005)


def test_anisotropic():
    solid, (pulled, waves) = panels("anisotropic")
    assert titles([pulled, waves]) == [("uniaxial stress", "strain (%)", "stress (MPa)"),
                                       ("waves along [001] to [111] to [110]", "angle from [001] (°)", "speed (km/s)")]
    for name, modulus in (("[100]", 66.7), ("[110]", 130.3), ("[111]", 191.1)):  # GPa, of copper
        x, y = pictures.line(pulled, name)
        assert y[0] / x[0] / 10 == pytest.approx(modulus, rel=1e-3), name
        assert pictures.line(pulled, f"{name}, 1/s'₁₁")[1] == pytest.approx([modulus], rel=2e-3)
    angles, exact = pictures.line(waves, "Christoffel")
    for n, label in enumerate(("slowest", "middle", "fastest")):
        x, y = pictures.line(waves, label)
        assert np.interp(angles[n::3], x, y) == pytest.approx(exact[n::3], rel=1e-6), label
    assert exact[:3] == pytest.approx([2.901, 2.901, 4.335], abs=1e-3)  # sqrt(75.4/8.96), sqrt(168.4/8.96)


@pytest.mark.parametrize("name, at, nominal", [("mooney-rivlin", 2, 2 * 1.75 * (0.16 + 0.01)), ("ogden", 7, 3.97)])
def test_rubber(name, at, nominal):
    """Treloar's has 4 MPa at seven times its length."""
    solid, (pulled, pressed) = panels(name)
    assert titles([pulled, pressed]) == [("uniaxial stress", "stretch", "nominal stress (MPa)"),
                                         ("pressure", "compression µ = 1/J − 1 (%)", "pressure (MPa)")]
    assert apart(pulled, "free across", "at constant volume") < 0.015
    x, y = pictures.line(pulled, "free across")
    assert np.interp(at, x, y) == pytest.approx(nominal, rel=0.01)
    assert apart(pressed, "from all sides", "K/2 (1/J − J)") < 1e-9
    assert pictures.line(pressed, "from all sides")[1][-1] == pytest.approx(500 * (1.2 - 1 / 1.2), rel=1e-9)


def test_j2():
    solid, (pulled, pressed) = panels("j2")
    assert titles([pulled, pressed]) == [("uniaxial stress", "log. strain (%)", "stress (MPa)"),
                                         ("uniaxial strain, there and back", "log. strain, compression (%)", "stress (GPa)")]
    assert apart(pulled, "there, back and on", "±s$_Y$(ε$_p$)/J") < 1e-9
    assert apart(pressed, "axial stress", "pressure ± ⅔ s$_Y$/J") < 1e-9
    x, y = pictures.line(pressed, "axial stress")
    assert y[20] / x[20] * 100 == pytest.approx(70 * 0.67 / (1.33 * 0.34), rel=0.01)  # lambda + 2 mu, GPa


def test_johnson_cook():
    solid, (pulled, heat) = panels("johnson-cook")
    assert titles([pulled, heat]) == [("uniaxial stress", "log. strain (%)", "stress (MPa)"),
                                      ("heat", "plastic strain (%)", "rise of the temperature (K)")]
    for rate in (1, 1e3, 1e5):
        x, y = pictures.line(pulled, f"{rate:g} /s")
        ep, rise = pictures.line(heat, f"{rate:g} /s")
        flow = (792 + 510 * (ep / 100)**0.26) * (1 + 0.014 * math.log(rate)) * (1 - (rise / 1499)**1.03)
        strained = x > 5
        assert y[strained] == pytest.approx(flow[strained], rel=3e-3), rate  # J is not quite 1
        work = np.sum(np.diff(ep / 100) * (flow[1:] + flow[:-1]) / 2) * 1e6
        assert rise[-1] == pytest.approx(0.9 * work / (7830 * 477), rel=1e-3)


def test_johnson_holmquist():
    solid, axes = panels("johnson-holmquist-2")
    assert titles(axes) == [("strength, at 1 /s", "pressure (GPa)", "von Mises stress (GPa)"),
                            ("uniaxial strain, there and back", "log. strain, compression (%)", "axial stress (GPa)"),
                            ("pressure, with bulking", "compression µ (%)", "pressure (GPa)")]
    unit = 1.5 * (19 - 8.71)
    p, q = pictures.line(axes[0], "where it flows first")
    assert q == pytest.approx(unit * 0.927 * ((p + 0.26) / 8.71)**0.67, rel=0.005)
    p, q = pictures.line(axes[0], "crushed")
    assert q == pytest.approx(unit * np.minimum(0.7 * (p / 8.71)**0.85, 0.2), rel=1e-6)
    mu, pressure = pictures.line(axes[2], "uniaxial strain, there and back")
    mu, first = mu[:400] / 100, pressure[:400]
    law = 233 * mu - 593 * mu**2 + 2800 * mu**3
    assert first[mu < 0.03] == pytest.approx(law[mu < 0.03], rel=1e-3)
    # of all the shear energy that is lost at once, less what the crushed solid keeps
    assert 2 < (first - law)[-1] < 4 and np.ptp((first - law)[mu > 0.04]) < 0.1
    slow, fast = (pictures.line(axes[1], label)[1].max() for label in ("1 /s", "1e+06 /s"))
    assert fast > slow


def test_holmquist_johnson_cook():
    solid, axes = panels("holmquist-johnson-cook")
    assert titles(axes) == [("strength, at 1 /s (closed pores: some damage)", "pressure (MPa)", "von Mises stress (MPa)"),
                            ("pressure: pores close", "compression µ (%)", "pressure (GPa)"),
                            ("confined and unconfined compression", "log. strain (%)", "axial stress (MPa)")]
    p, q = pictures.line(axes[0], "crushed")
    assert q == pytest.approx(48 * np.minimum(1.6 * (p / 48)**0.61, 7), rel=1e-6)
    p, q = pictures.line(axes[0], "where it flows first")
    law = 48 * (0.79 + 1.6 * (p / 48)**0.61)
    assert q[:2] == pytest.approx(law[:2], rel=0.01) and np.all(q < 1.001 * law) and np.all(q > 0.9 * law)
    mu, pressure = pictures.line(axes[1], "from all sides, twice back")
    mu, dense = mu / 100, np.poly1d([208, -171, 85, 0])
    first = np.maximum.accumulate(mu) == mu
    assert pressure[(mu < 0.001) & first] == pytest.approx(16 * mu[(mu < 0.001) & first], rel=1e-3)  # K 16 GPa
    assert pressure[mu > 0.12] == pytest.approx(dense((mu[mu > 0.12] - 0.1) / 1.1), rel=1e-6)
    for across, least in ((0, 0.97), (24, 0.95)):
        x, y = pictures.line(axes[2], f"1 /s, {across} MPa across")
        most = y.max() - across  # on the surface of the solid that is whole, less what closing pores have damaged
        assert least < most / (48 * (0.79 + 1.6 * ((across + most / 3) / 48)**0.61)) < 1, across
    assert pictures.line(axes[2], "1000 /s, 0 MPa across")[1].max() > 1.03 * pictures.line(axes[2], "1 /s, 0 MPa across")[1].max()


def test_drucker_prager():
    solid, axes = panels("drucker-prager")
    assert titles(axes) == [("strength", "pressure (MPa)", "von Mises stress (MPa)"),
                            ("triaxial cell (dashed: Mohr-Coulomb)", "log. strain, compression (%)", "axial stress (MPa)"),
                            ("pores collapse", "volume lost, −log J (%)", "pressure (MPa)")]
    sine = math.sin(math.radians(37))
    k, a = 6 * 18.5 * math.sqrt(1 - sine**2) / (3 - sine), 6 * sine / (3 - sine)
    p, q = pictures.line(axes[0], "where it flows first")
    begin = (390 - 0.5 * k) / (1 + 0.5 * a)
    cone, cap = p < begin, p >= begin
    assert cone.sum() == 3 and cap.sum() == 5
    assert q[cone] == pytest.approx(k + a * p[cone], rel=2e-3)
    assert ((p[cap] - begin) / 0.5)**2 + q[cap]**2 == pytest.approx(np.full(5, (k + a * begin)**2), rel=5e-3)
    for pressure in (0, 10, 40):
        x, y = pictures.line(axes[1], f"{pressure} MPa across")
        assert y[-1] == pytest.approx((2 * 18.5 * math.sqrt(1 - sine**2) + (1 + sine) * pressure) / (1 - sine), rel=1e-3)
    x, y = pictures.line(axes[2], "from all sides, once back")
    assert y[-1] == pytest.approx(np.interp(x[-1], *pictures.line(axes[2], "crush curve")), rel=1e-3)
    assert y[x < 3] == pytest.approx(19.3e3 / (3 * 0.6) * x[x < 3] / 100 * np.exp(x[x < 3] / 100), rel=1e-6)  # K, of Cauchy's stress


def test_viscoelastic():
    solid, (relaxing, pulled) = panels("viscoelastic")
    assert titles([relaxing, pulled]) == [("relaxation", "time (s)", "shear modulus (GPa)"),
                                          ("uniaxial stress, there and back", "log. strain (%)", "stress (MPa)")]
    assert relaxing.get_xscale() == "log" and apart(relaxing, "sheared, then held", "Prony series") < 1e-3
    x, y = pictures.line(relaxing, "sheared, then held")
    assert (y[0], y[-1]) == pytest.approx((6 / 2.66, 6 / 2.66 * (1 - 0.46)), rel=2e-3)
    ends = [pictures.line(pulled, f"{rate:g} /s")[1].max() for rate in (1, 100, 1e4, 1e6)]
    assert ends == sorted(ends) and ends[-1] == pytest.approx(120, rel=0.03)  # Young's modulus at once


def test_deshpande_evans():
    """The strengths that kernels/material/deshpande_evans_model.h states of a point."""
    solid, axes = panels("deshpande-evans")
    assert titles(axes) == [("uniaxial stress, compression", "log. strain (%)", "stress (GPa)"),
                            ("uniaxial stress, tension", "log. strain (%)", "stress (GPa)"),
                            ("uniaxial strain, compression", "log. strain (%)", "stress (GPa)")]
    assert [pictures.line(one, "10000 /s")[1].max() for one in axes[:2]] == pytest.approx([3.94, 1.21], rel=0.01)
    x, y = pictures.line(axes[2], "axial, 10000 /s")
    assert y[-1] / x[-1] * 100 == pytest.approx(2 * 146 * 0.8 / 0.6 / math.exp(-0.04), rel=0.01)


# ---- point.py ----

def test_a_step_that_no_stretch_holds_is_told():
    soft = study.solid_of("ogden", [])
    with pytest.raises(launch.BadInput, match=r"ogden: step 1: no stretch across gives a pressure of -1e\+15 Pa"):
        soft.walk(np.ones((3, 3)), 1.0, pressure=[0, -1e15, 0], free=point.ALIKE)


def test_pressure_across_is_there():
    rock = study.solid_of("drucker-prager", [])
    path = rock.uniaxial_stress(study.to(-0.01, 50), pressure=40e6)
    assert path.stress[:, :2] == pytest.approx(np.full((50, 2), -40e6), rel=1e-6)
    assert path.stress[0, 2] == pytest.approx(-40e6, rel=0.2) and path.time[-1] == pytest.approx(0.01, rel=0.2)


def test_energy_of_a_path_adds_up():
    metal = study.solid_of("j2", [])
    path = metal.uniaxial_stress(study.to(0.02, 2000))
    force, stretch = np.append(0, path.nominal[:, 2]), np.append(1, path.stretch[:, 2])
    work = np.sum(np.diff(stretch) * (force[1:] + force[:-1]) / 2)
    assert path.energy[-1] + path.flow[-1] == pytest.approx(work, rel=1e-4) and path.flow[-1] > path.energy[-1]


def test_what_is_wrong_is_told():
    with pytest.raises(launch.BadInput, match="concrete: no such model"):
        point.Solid({"model": "concrete", "density": 1, "young": 1, "poisson": 0.2})
    with pytest.raises(launch.BadInput, match="--set yield=1: the block of j2 has model, density"):
        study.solid_of("j2", ["yield=1"])
    assert study.solid_of("j2", ["yield_stress=5e8"])["yield_stress"] == 5e8


def test_what_c_has_and_python_has_not_is_noticed(monkeypatch):
    point.library.cache_clear()
    monkeypatch.setattr(point, "INSIDE", point.INSIDE[1:])
    with pytest.raises(launch.BadInput, match="other values inside"):
        point.library()
    point.library.cache_clear()
