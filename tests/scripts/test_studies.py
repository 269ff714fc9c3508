"""What the studies of bench/ ask of the program, what they make of its results and what their pictures show, against tables
made by hand and closed forms; tests/scripts/test_scripts.py starts them."""

import json
import math
import time
import types

import numpy as np
import pytest
import synthetic_run as synthetic
from conftest import example
from matplotlib.colors import to_rgba
from pictures import assert_panels_apart, assert_readable, labels, legend, line, look, script, segments, style, texts, title

import launch
import rhegma
import theory
from drawing import BLUE, FAINT, GREEN, INK, RED, YELLOW, plt

TWO_MATERIALS = "materials=[{name: steel, where: 'z < 0', model: neo-hookean, young: 1e9, poisson: 0.3, density: 1e3}]"


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


class Runs:
    """In place of the program: notes what it is asked for, and lets `result(out, sets)` write the directory."""

    def __init__(self, result):
        self.calls, self.result = [], result

    def __call__(self, case, out, sets=None, overrides=(), **keywords):
        self.calls.append(types.SimpleNamespace(case=case, out=out, sets=sets, overrides=overrides, keywords=keywords))
        self.result(out, sets or {})
        return 2.5


@pytest.fixture
def runs(monkeypatch):
    def instead(result):
        fake = Runs(result)
        monkeypatch.setattr(launch, "run", fake)
        monkeypatch.setattr(launch, "run_once", fake)
        return fake

    return instead


@pytest.fixture
def saved(monkeypatch):
    """{name of the picture: figure} of a script; saved(module) to begin with."""
    figures = {}

    def catch(module):
        monkeypatch.setitem(module.__dict__, "save", lambda figure, path: figures.update({path.name: figure}))
        return figures

    return catch


def start(module, monkeypatch, *words):
    """The script's main function with these words."""
    monkeypatch.setattr("sys.argv", ["script", *map(str, words)])
    return module.main()


def case_text(name, **sections):
    """A case of bench/examples with sections replaced, as text."""
    return json.dumps({**rhegma.read_case(example(name)), **sections})


@pytest.mark.parametrize("name", ["free-bar", "ceramic-curves", "intrinsic", "mesh-study", "fragmentation"])
def test_bars_of_two_materials_are_refused_before_anything_runs(name, tmp_path, monkeypatch, runs):
    fake = runs(lambda out, sets: None)
    with pytest.raises(rhegma.BadInput, match="of one material; this case has material, steel"):
        start(script(f"bench/studies/{name}"), monkeypatch, "--out", tmp_path, "--set", TWO_MATERIALS)
    assert not fake.calls


# ---- bench/studies/free-bar ----

free_bar = script("bench/studies/free-bar")
STEP = 20 * np.arange(1.0, 801)
RING = {"step": STEP, "time": 1e-9 * STEP, "kinetic": 2 + np.cos(2 * np.pi * 1e-9 * STEP / 2.3834e-7)}


def bar_result(out, sets):
    variational = sets["interface.form"] == "variational"
    total = 3 * (1 + 1e-5 * np.sin(STEP)) if variational else np.where(STEP < 300, 3 * np.exp(np.minimum(STEP, 300)), np.nan)
    synthetic.write_run(out, case=case_text("free-bar.yaml"), energy_table={**RING, "total": total},
                        summary={"status": "completed" if variational else "stopped"})


def test_free_bar(tmp_path, monkeypatch, runs, saved, capsys):
    fake, figures = runs(bar_result), saved(free_bar)
    assert not start(free_bar, monkeypatch, "--out", tmp_path, "--steps", 16000, "--set", "a=1")
    assert [(call.case.name, call.out, call.overrides, call.keywords) for call in fake.calls] == [
        ("free-bar.yaml", tmp_path / form, ["a=1"], {"accept": (0, 1)}) for form in ("variational", "incomplete")]
    for call in fake.calls:
        assert call.sets["time.steps"] == 16000 and call.sets["time.end"] == 1e-3 and call.sets["output.interval"] == 20
        assert call.sets["interface.form"] == call.out.name and call.sets["output.energy_limit"] == 1e12
    said = capsys.readouterr().out
    table = rhegma.energy(tmp_path / "variational")
    drift = np.abs(table["total"] / table["total"][0] - 1).max()
    expected = theory.free_bar_half_period(rhegma.read_case(example("free-bar.yaml")))
    assert "variational: completed" in said and "incomplete: stopped" in said
    assert f"energy constant to {drift:.2g}; half period 2.3834" in said and f"theory {expected:.7g} s" in said
    found = float(said.split("half period ")[1].split()[0])
    assert found == pytest.approx(2.3834e-7, rel=1e-6)
    assert f"difference {2.3834e-7 / expected - 1:+.1e}" in said

    (axes,) = figures["free-bar.png"].axes
    assert labels(axes) == ["variational", "incomplete"] == legend(axes)
    step, change = line(axes, "variational")
    assert (step == STEP).all() and change == pytest.approx(np.maximum(np.abs(table["total"] / table["total"][0] - 1), 1e-9))
    step, change = line(axes, "incomplete")
    assert (step == STEP[STEP < 300]).all() and change[-1] == pytest.approx(math.exp(280 - 20) - 1)
    assert [style(axes, form)[:2] for form in labels(axes)] == [(to_rgba(BLUE), "-"), (to_rgba(RED), "-")]
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_yscale()) == ("step", "relative change of energy", "log")
    assert axes.get_xlim() == (0, 16000) and axes.get_ylim() == (1e-9, 1e9)
    (bound,) = [one for one in axes.get_lines() if one.get_label().startswith("_")]
    assert look(bound) == (to_rgba(FAINT), "--") and axes.texts[0].get_ha() == "right"
    assert bound.get_ydata() == [0.005, 0.005] and [text.get_text() for text in axes.texts] == ["0.5 %"]
    assert axes.texts[0].xy == (16000, 0.005)
    assert title(axes) == "Free elastic bar: energy in the two DG forms"
    assert_readable(figures["free-bar.png"])


def test_free_bar_takes_as_many_steps_as_it_says(tmp_path, monkeypatch, runs, saved):
    fake, figures = runs(bar_result), saved(free_bar)
    start(free_bar, monkeypatch, "--out", tmp_path)
    assert [call.sets["time.steps"] for call in fake.calls] == [20000, 20000] and fake.calls[0].overrides == []
    assert figures["free-bar.png"].axes[0].get_xlim() == (0, 20000)


# ---- bench/studies/ceramic-curves ----

ceramic = script("bench/studies/ceramic-curves")


def cube_result(out, sets):
    side, rate = out.name.split("-", 1)
    time = np.linspace(0, sets["time.end"], 101)
    sign = {"compression": -1, "tension": 1}[side]
    stress = sign * 4e9 * float(rate) ** 0.1 * np.sin(4 * np.arange(101) / 100)  # most at 39, past 0 from 79 on
    synthetic.write_run(out, history={"time": time, "middle_szz": stress})


def test_ceramic_curves(tmp_path, monkeypatch, runs, saved, capsys):
    fake, figures = runs(cube_result), saved(ceramic)
    start(ceramic, monkeypatch, "--out", tmp_path, "--rates", "1e3", "1e5", "--set", "material.poisson=0.3")
    asked = {(call.out.name): call for call in fake.calls}
    assert list(asked) == ["compression-1e+03", "compression-1e+05", "tension-1e+03", "tension-1e+05"]
    for name, rate, end in (("compression-1e+03", -1e3, 0.04e-3), ("tension-1e+05", 1e5, 0.015e-5)):
        call, along = asked[name], f"{rate!r}*z"
        assert call.case.name == "ceramic-cube.yaml" and call.overrides == ["material.poisson=0.3"]
        assert call.sets["initial.velocity"]["z"] == along and call.sets["time.end"] == pytest.approx(end)
        across = [float(call.sets["initial.velocity"][c].removesuffix(f"*{c}")) for c in "xy"]
        assert across == pytest.approx([-0.3 * rate] * 2)  # uniaxial stress: of the case's Poisson ratio
        assert call.sets["boundary"] == [{"set": side, "component": "z", "velocity": along} for side in ("z+", "z-")]
        assert call.sets["output.energy_limit"] == 1e9
    said = capsys.readouterr().out.splitlines()
    peaks = {rate: 4 * rate**0.1 * math.sin(1.56) for rate in (1e3, 1e5)}
    assert said[0].split() == ["compression", "1e+03", "/s:", f"{-peaks[1e3]:.3f}", "GPa", "at", f"{-0.039 * 40:.3f}", "%"]
    assert said[3].split() == ["tension", "1e+05", "/s:", f"{peaks[1e5]:.3f}", "GPa", "at", f"{0.039 * 15:.3f}", "%"]

    figure = figures["ceramic-curves.png"]
    for axes, (side, far) in zip(figure.axes, (("compression", 4), ("tension", 1.5))):
        assert labels(axes) == ["1e+03 /s", "1e+05 /s"] == legend(axes)
        for rate in (1e3, 1e5):
            strain, stress = line(axes, f"{rate:.0e} /s")
            end = 78  # sin(4 k/100) is below a tenth for the first time after its top at k = 77
            assert strain == pytest.approx(np.linspace(0, far, 101)[:end], abs=1e-12)
            assert stress == pytest.approx(4 * rate**0.1 * np.sin(4 * np.arange(end) / 100), abs=1e-12)
        assert (axes.get_xlabel(), axes.get_ylabel()) == (f"{side}, strain (%)", "stress (GPa)")
        assert axes.get_xlim() == (0, far) and axes.get_ylim()[0] == 0
        assert [style(axes, label)[0] for label in labels(axes)] == [to_rgba(BLUE), to_rgba(GREEN)]
    assert texts(figure)[0] == "deshpande-evans, uniaxial stress" and figure.get_size_inches() == pytest.approx((10, 4.2))
    assert_readable(figure)
    assert_panels_apart(figure)


def test_curve_of_a_cube_that_holds():
    history = synthetic.structured({"time": [0.0, 1, 2], "middle_szz": [0.0, -10, -20]})
    strain, stress = ceramic.curve(history, -2.0)
    assert strain.tolist() == [0, -2, -4] and stress.tolist() == [0, -10, -20]
    assert ceramic.largest(strain, stress) == (-4, -20)


def test_curve_ends_below_a_tenth_of_the_largest():
    history = synthetic.structured({"time": np.arange(5.0), "middle_szz": [1, 20, -2.01, 1.99, 20.0]})
    assert ceramic.curve(history, 1.0)[1].tolist() == [1, 20, -2.01, 1.99]


def test_more_rates_than_colours():
    curves = {side: {10.0**k: (np.zeros(2), np.zeros(2)) for k in range(6)} for side in ceramic.SIDES}
    axes = ceramic.draw(curves, "m").axes[0]
    assert [style(axes, label)[0] for label in labels(axes)] == [to_rgba(c) for c in (BLUE, GREEN, YELLOW, RED, BLUE, GREEN)]


def test_ceramic_has_four_rates_unless_told(tmp_path, monkeypatch, runs, saved):
    fake, _ = runs(cube_result), saved(ceramic)
    start(ceramic, monkeypatch, "--out", tmp_path)
    assert [call.out.name for call in fake.calls[:4]] == [f"compression-1e+0{k}" for k in (3, 4, 5, 6)] and len(fake.calls) == 8


# ---- bench/studies/intrinsic ----

intrinsic = script("bench/studies/intrinsic")


MOMENTS = [0.07e-6, 0.1e-6, 0.15e-6, 0.2e-6, 0.31e-6, 0.36e-6, 0.42e-6, 0.5e-6]


def spall_result(out, sets):
    """The wave comes a tenth late and is a tenth low; a mesh of two elements, of which the upper one has a side in y+."""
    case = rhegma.read_case(example("spall.yaml"))
    bar = theory.Spall(case)
    time = np.linspace(0, 0.5e-6 if out.name == "intrinsic" else 0.45e-6, 5001 if out.name == "intrinsic" else 4501)
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [0, 1, 1.5]])
    tets = [[0, 1, 2, 3], [2, 4, 5, 1]]  # (2, 4, 5) lies in y = 1
    cells = np.array([tet + [0] * 6 for tet in tets])
    moments = MOMENTS
    stress = np.arange(12.0).reshape(2, 6) * 1e7
    frames = [{"time": moment, "displacement": np.full((6, 3), moment), "stress": (k + 1) * stress} for k,
              moment in enumerate(moments)]
    synthetic.write_run(out, case=case_text("spall.yaml"),
                        summary={"first_fracture_time_s": None if out.name == "intrinsic" else 2.3e-7},
                        history={"time": time, "p1mm_szz": 0.9 * bar.stress(1e-3, time / 1.1)},
                        fields=(1e-3 * points, cells, frames))


def test_intrinsic_spall(tmp_path, monkeypatch, runs, saved, capsys):
    fake, figures = runs(spall_result), saved(intrinsic)
    start(intrinsic, monkeypatch, "--out", tmp_path, "--only", "spall", "--set", "a=1")
    asked = [(call.case.name, call.out.name, call.overrides) for call in fake.calls]
    assert asked == [("spall.yaml", "dg", ["a=1"]), ("intrinsic.yaml", "intrinsic", ["a=1"]),
                     ("spall.yaml", "continuous", ["a=1"])]
    assert fake.calls[0].sets == fake.calls[1].sets == {}
    assert fake.calls[2].sets == {"interface.form": "continuous", "interface.faces": "abs(z) < 1e-6", "output.fields": []}
    bar = theory.Spall(rhegma.read_case(example("spall.yaml")))
    late = 1e-4 * math.ceil(1.1e7 / bar.speed)  # us, of the table
    said = capsys.readouterr().out.splitlines()
    assert said == [f"{name}: 100 MPa at {late:.4f} us (theory 0.1123), plateau {0.9 * bar.high / 1e6:.1f} MPa (theory 200), "
                    f"first fracture {first}, energy error 0.001" for name, first in
                    (("DG", "0.2300 us"), ("intrinsic", "none"), ("continuous", "0.2300 us"))]

    (axes,) = figures["spall-history.png"].axes
    label = "theory, spall at 0.2246 µs"
    assert labels(axes) == [label, "DG", "intrinsic", "continuous"] == legend(axes)
    assert [style(axes, one)[:2] for one in labels(axes)] == [(to_rgba(FAINT), "--"),
                                                              *((to_rgba(c), "-") for c in (BLUE, RED, GREEN))]
    time, stress = line(axes, label)
    assert time[[0, -1]] == pytest.approx([0, 0.5]) and stress == pytest.approx(bar.stress(1e-3, 1e-6 * time) / 1e6)
    time, stress = line(axes, "intrinsic")
    assert time == pytest.approx(np.linspace(0, 0.5, 5001))
    assert stress == pytest.approx(0.9e-6 * bar.stress(1e-3, 1e-6 * time / 1.1))
    assert axes.get_xlim() == pytest.approx((0, 0.5))
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time (µs)", "stress along the bar at z = 1 mm (MPa)")
    assert title(axes).startswith("Spall test: DG, intrinsic cohesive faces, shared nodes")
    assert_readable(figures["spall-history.png"])

    figure = figures["spall-snapshots.png"]
    panels = np.array(figure.axes[:-1]).reshape(4, 2)
    for axes, name in zip(panels.T, ("DG", "intrinsic")):
        assert [title(one) for one in axes] == [f"{name}, {moment} µs" for moment in ("0.07", "0.15", "0.31", "0.42")]
        for one, k in zip(axes, (0, 2, 4, 6)):
            moment = MOMENTS[k]
            (picture,) = one.collections
            assert np.asarray(picture.get_array()) == pytest.approx([(k + 1) * 110])  # MPa: zz of the second element
            corners = picture.get_paths()[0].vertices[:3]
            moved = 1e3 * (1e-3 * np.array([[0, 0], [1, 1], [1.5, 0]]) + 300 * moment)  # z and x
            assert np.array(sorted(map(tuple, corners))) == pytest.approx(moved)
            assert picture.get_clim() == pytest.approx((0, 400)) and one.get_aspect() == 1
    assert [axes.get_xlabel() for axes in panels[:, 0]] == ["", "", "", "z (mm), displacements x 300"]
    assert figure.get_size_inches() == pytest.approx((12, 3.9))
    assert figure.axes[-1].get_ylabel() == "stress along the bar (MPa)"
    assert not any(len(axes.get_yticks()) for axes in panels.flat)


def test_passage_of_the_wave_on_the_other_side():
    """A probe below the middle sees the wave of the lower end first."""
    case = rhegma.read_case(example("spall.yaml"))
    case["boundary"][1]["velocity"] = -3.0
    bar = theory.Spall(case, np.array([[0, 0, 3e-3], [1e-4, 1e-4, 7e-3]]))
    time = np.linspace(0, 0.4e-6, 4001)
    for z, expected in ((4e-3, bar.low), (6e-3, bar.high)):
        history = synthetic.structured({"time": time, "p_szz": bar.stress(z, time)})
        arrival, plateau, begin, near = intrinsic.passage(history, bar, ("p", z))
        assert (arrival, begin) == pytest.approx((1e-3 / bar.speed,) * 2, abs=1e-10)
        assert (plateau, near) == pytest.approx((expected,) * 2)


def test_plateau_is_taken_from_its_middle():
    bar = theory.Spall(rhegma.read_case(example("spall.yaml")))
    begin, span = 1e-3 / bar.speed, 2e-3 / bar.speed
    time = begin + span * np.linspace(-0.5, 1.2, 1701)
    part = (time - begin) / span
    history = synthetic.structured({"time": time, "p_szz": np.where((part > 0.25) & (part < 0.875), 5.0, 7e8 * (part > 0))})
    assert intrinsic.passage(history, bar, ("p", 1e-3))[1] == pytest.approx(5)
    ramp = synthetic.structured({"time": time, "p_szz": part})
    assert intrinsic.passage(ramp, bar, ("p", 1e-3))[1] == pytest.approx((0.25 + 0.875) / 2, rel=1e-2)


def test_wave_that_never_comes():
    time = np.array([0.0, 1e-9])
    assert math.isnan(intrinsic.first_passage(time, np.zeros(2), 1.0)) and math.isnan(intrinsic.mean(np.zeros(0)))
    assert intrinsic.first_passage(time, np.array([1.0, 1.5]), 1.0) == 1e-9 and intrinsic.mean(np.array([1.0, 2])) == 1.5


def test_side_of_a_mesh():
    """Of the four triangles of a tetrahedron the one in y+ alone, whichever corners make it."""
    points = np.array([[0, 1, 0], [1, 1, 0], [0, 1, 1], [0, 0, 0.0]])
    for order in ([0, 1, 2, 3], [3, 0, 1, 2], [0, 3, 1, 2], [0, 1, 3, 2]):
        triangles, owners = intrinsic.surface(points, np.array([order]))
        assert [sorted(t) for t in triangles] == [[0, 1, 2]] and owners.tolist() == [0]


ROW = rhegma.read_case(example("spring-bar.yaml"))
ROW_SPEED = theory.rhegma.one_material(ROW, "").dilatational_speed


def test_row_of_cubes():
    """Slope s = strength^2/(2 ascent energy): s h/E is what was asked for."""
    row = intrinsic.Row(ROW)
    modulus = row.material.uniaxial
    assert row.length == pytest.approx(4e-3) and row.cube == pytest.approx(1e-4)
    assert row.crossing() == pytest.approx(4e-3 / ROW_SPEED)
    for ratio in (0.3, 7.0):
        slope = 1e9**2 / (2 * 0.5 * row.energy(ratio))
        assert slope * 1e-4 / modulus == pytest.approx(ratio)
    assert row.stress() == pytest.approx(3690 * ROW_SPEED * 5)
    steps = intrinsic.step_of_stress(row)
    assert steps["boundary"] == [*ROW["boundary"], {"set": "z+", "component": "z", "velocity": 5.0}]
    assert steps["initial"] == {"velocity": {"z": 0}} and 1.4 < steps["time.end"] * ROW_SPEED / 4e-3 < 1.5
    (probe,) = steps["output.probes"]
    assert probe["name"] == "middle" and probe["at"] == pytest.approx([0.5e-4, 0.5e-4, 2e-3])


def row_result(out, sets):
    """Everything as formula (3.10) says, so that what is told is the formula; but the stress a tenth more."""
    name, ratio = out.name.split("-")
    slowed = math.sqrt(float(ratio) / (1 + float(ratio)))
    time = np.linspace(0, sets["time.end"] * (1.1 if ratio == "3" else 1), 3001)
    stress = 3690 * ROW_SPEED * 5 * 1.1 * slowed * (time * slowed * ROW_SPEED > 2e-3)
    half = 4e-3 / ROW_SPEED / slowed
    energy = {"time": time, "total": 0 * time, "kinetic": 1 + np.cos(2 * np.pi * time / half)}
    synthetic.write_run(out, case=case_text("spring-bar.yaml"), energy_table=energy,
                        history={"time": time, "middle_szz": stress})


def test_intrinsic_slopes(tmp_path, monkeypatch, runs, saved, capsys):
    fake, figures = runs(row_result), saved(intrinsic)
    start(intrinsic, monkeypatch, "--out", tmp_path, "--only", "slopes", "--set", "b=2")
    assert [(call.case.name, call.out.name, call.overrides) for call in fake.calls] == [
        ("spring-bar.yaml", f"slope-{ratio}", ["b=2"]) for ratio in (0.3, 3, 30)]
    row = intrinsic.Row(ROW)
    for call, ratio in zip(fake.calls, (0.3, 3, 30)):
        assert call.sets == {"interface.energy": pytest.approx(row.energy(ratio)), **intrinsic.step_of_stress(row)}
    half = 2e3 / ROW_SPEED
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 3
    for said, ratio in zip(lines, (0.3, 3, 30)):
        slowed = math.sqrt(ratio / (1 + ratio))
        numbers = [float(word.strip(",;")) for word in said.replace(":", "").split() if word.strip(",;")[0].isdigit()]
        assert numbers == pytest.approx([ratio, half / slowed, half / slowed, half, 1.1 * slowed, slowed, 678], abs=6e-4), said

    (axes,) = figures["interface-stress.png"].axes
    assert labels(axes) == ["theory", "s h/E = 0.3", "s h/E = 3", "s h/E = 30"] == legend(axes)
    assert [style(axes, one)[:2] for one in labels(axes)] == [(to_rgba(FAINT), "--"),
                                                              *((to_rgba(c), "-") for c in (YELLOW, RED, BLUE))]
    end = 1e6 * intrinsic.step_of_stress(row)["time.end"]
    time, stress = line(axes, "theory")
    assert time[[0, -1]] == pytest.approx([0, 1.1 * end])
    assert stress == pytest.approx(np.where(time > half, row.stress() / 1e6, 0))
    time, stress = line(axes, "s h/E = 3")
    assert time == pytest.approx(np.linspace(0, 1.1 * end, 3001))
    assert stress == pytest.approx(1.1 * row.stress() / 1e6 * math.sqrt(0.75) * (time > half / math.sqrt(0.75)))
    assert axes.get_xlim() == pytest.approx((0, 1.1 * end))
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time (µs)", "stress in the middle (MPa)")
    assert title(axes) == "A step of stress through interfaces of three slopes"
    assert_readable(figures["interface-stress.png"])


def test_level_behind_the_step_is_taken_a_while_after_it():
    row = intrinsic.Row(ROW)
    time = np.linspace(0, 1e-6, 1001)
    stress = np.where(time < 0.3e-6, 0, np.where(time < 0.4e-6, row.stress(), 0.25 * row.stress()))
    history = synthetic.structured({"time": time, "middle_szz": stress})
    assert intrinsic.response(history, row) == pytest.approx((0.3e-6, 0.25), rel=5e-3)


def test_intrinsic_speed(tmp_path, monkeypatch, runs, saved, capsys):
    fake, figures = runs(row_result), saved(intrinsic)
    start(intrinsic, monkeypatch, "--out", tmp_path, "--only", "speed")
    ratios, row = (0.3, 0.6, 1, 2, 3), intrinsic.Row(ROW)
    slowed = [math.sqrt(ratio / (1 + ratio)) for ratio in ratios]
    assert [(call.case.name, call.out.name) for call in fake.calls] == [("spring-bar.yaml", f"speed-{ratio}")
                                                                        for ratio in ratios]
    for call, ratio, slow in zip(fake.calls, ratios, slowed):
        assert call.sets == {"interface.energy": pytest.approx(row.energy(ratio)),
                             "time.end": pytest.approx(1.2 * 4e-3 / ROW_SPEED / slow)}
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 5
    for said, ratio, slow in zip(lines, ratios, slowed):
        assert said in [f"s h/E = {ratio}: speed {slow:.4f} of {ROW_SPEED:.0f} m/s, formula (3.10) {slow:.4f}, {sign}0.00 %"
                        for sign in "+-"]
    (axes,) = figures["wave-speed.png"].axes
    assert labels(axes) == ["formula (3.10)", "measured"] == legend(axes)
    found, speeds = line(axes, "measured")
    assert found == pytest.approx(ratios) and speeds == pytest.approx(slowed, rel=1e-5)
    assert style(axes, "measured") == (to_rgba(BLUE), "None", "o")
    assert style(axes, "formula (3.10)")[:2] == (to_rgba(FAINT), "--")
    fine, formula = line(axes, "formula (3.10)")
    assert formula == pytest.approx(np.sqrt(fine / (1 + fine))) and fine.min() < 0.3 and fine.max() > 3
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_xscale(), axes.get_ylim()) == (
        "s h/E", "wave speed over that of the continuum", "log", (0, 1))
    assert title(axes) == "Waves through intrinsic cohesive faces"
    assert_readable(figures["wave-speed.png"])


def test_intrinsic_does_all_parts_unless_told(monkeypatch):
    done = []
    monkeypatch.setattr(intrinsic, "PARTS", {name: lambda args, name=name: done.append(name) for name in intrinsic.PARTS})
    start(intrinsic, monkeypatch)
    start(intrinsic, monkeypatch, "--only", "speed", "spall")
    assert done == ["spall", "slopes", "speed", "speed", "spall"]


# ---- bench/studies/mesh-study ----

study = script("bench/studies/mesh-study")
BAR = theory.Spall(rhegma.read_case(example("spall.yaml")))
CORNERS = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0.0]], [[0, 0, 2.9], [1, 0, 2.9], [0, 1, 2.9]],
                    [[0, 0, 0], [1, 0, 0], [0, 1, 3.1]],
                    [[0, 0, -1], [1, 0, -1], [0, 1, -1]]]) * 1e-4


def result(first=0.2246e-6, at=6e-6, end=9e-6, error=1e-3, mesh_s=60.0, run_s=120.0, last=0.6e-6):
    summary = {**synthetic.SUMMARY, "first_fracture_time_s": first, "dissipated_J": end, "energy_error_rel": error}
    whole = 0.98 * BAR.crossing()
    energy = synthetic.structured({"time": np.array([0, whole, last]), "dissipated": np.array([0, at, end])})
    crack = {"points": CORNERS, "damage": np.array([1.0, 1.0, 1.0, 0.5])}
    return study.Result(summary, energy, crack, mesh_s, run_s)


def test_findings_that_hold():
    results = {"uniform": result(), "middle": result(at=7e-6, first=0.2250e-6), "graded": result(error=2e-3)}
    found = study.findings(results, BAR)
    spread = 100 * (0.2250e-6 - 0.2246e-6) / BAR.meeting()
    assert [(words, value) for words, value, _ in found][:5] == [
        ("thesis: all dissipate more than a flat plane", "6.00 uJ at least"),
        ("thesis: fracture starts at about the same time on all", f"within {spread:.1f} %"),
        ("thesis: the middle mesh dissipates most", "middle"),
        ("first fracture within 3 % of 0.2246 us", f"{100 * (0.2250e-6 / BAR.meeting() - 1):.1f} %"),
        ("energy error below 1 %", "0.20 %")]
    assert found[5][0].startswith("done in 20 minutes, meshing included (") and found[5][1] == "9.0 min"
    assert len(found) == 6 and all(holds for _, _, holds in found)


@pytest.mark.parametrize("fault, which", [
    ({"at": 5.43e-6}, {0}), ({"first": 0.2314e-6}, {1, 3}), ({"first": 0.2178e-6}, {1, 3}), ({"first": 0.2180e-6}, set()),
    ({"at": 7.1e-6}, {2}), ({"error": 1.01e-2}, {4}), ({"error": 0.99e-2}, set()), ({"run_s": 1e3}, {5}),
                                          ({"mesh_s": 1e3}, {5}),
    ({"run_s": 770}, set()), ({"at": 5.45e-6}, set()), ({"first": 0.2311e-6}, set())])
def test_findings_that_do_not_hold(fault, which):
    results = {"uniform": result(**fault), "middle": result(at=7e-6), "graded": result()}
    assert {k for k, (_, _, holds) in enumerate(study.findings(results, BAR)) if not holds} == which


def test_findings_state_what_is_farthest_off():
    results = {"uniform": result(first=0.2300e-6, error=5e-3), "middle": result(first=0.2200e-6), "graded": result()}
    values = [value for _, value, _ in study.findings(results, BAR)]
    assert values[1] == f"within {100 * 0.01e-6 / BAR.meeting():.1f} %"
    assert values[3] == f"{100 * (0.23e-6 / BAR.meeting() - 1):.1f} %"
    assert values[4] == "0.50 %"


def test_findings_of_one_mesh_and_of_one_that_did_not_break():
    assert [words.split()[0] for words, _, _ in study.findings({"middle": result()}, BAR)] == ["thesis:", "first", "energy",
                                                                                               "done"]
    assert len(study.findings({"uniform": result(), "graded": result()}, BAR)) == 5
    whole = study.findings({"uniform": result(first=None)}, BAR)
    assert [holds for _, _, holds in whole] == [True, False, True, True]


def test_energies_are_compared_before_the_ends_break():
    assert study.moment({"a": result()}, BAR) == pytest.approx(0.98 * BAR.crossing())
    assert study.moment({"a": result(), "b": result(last=0.45e-6)}, BAR) == pytest.approx(0.98 * BAR.crossing())
    short = result()
    short.energy["time"] /= 2
    assert study.moment({"a": result(), "b": short}, BAR) == pytest.approx(0.3e-6)
    assert result().dissipated(0.49 * BAR.crossing()) == pytest.approx(3e-6)
    assert math.isnan(result(first=None).first) and result().first == 0.2246e-6


def test_table_of_the_study():
    heading, row, last = study.table({"uniform": result()}, BAR)
    assert heading.split() == ["mesh", "tets", "steps", "first", "fracture", "at", "0.44", "us", "at", "the", "end", "energy",
                               "error",
                               "meshing", "run"]
    percent = 100 * (0.2246e-6 / BAR.meeting() - 1)
    assert row.split() == ["uniform", "12,345", "678", "0.2246", "us", f"{percent:+.1f}", "%", "6.00", "uJ", "9.00", "uJ",
                           "0.10", "%",
                           "60", "s", "120", "s"]
    assert last == "flat plane 5.44 uJ, waves meet at 0.2246 us; after 0.44 us the ends break too"


def test_pictures_of_the_study():
    results = {"uniform": result(), "graded": result(at=7e-6)}
    figure = study.draw_energy(results, BAR)
    (axes,) = figure.axes
    assert labels(axes) == ["uniform, 12,345 tets", "graded, 12,345 tets"] == legend(axes)
    time, energy = line(axes, "graded, 12,345 tets")
    assert time == pytest.approx([0, 0.98e6 * BAR.crossing(), 0.6]) and energy == pytest.approx([0, 7, 9])
    flat, meeting = [one for one in axes.get_lines() if one.get_label().startswith("_")]
    assert look(flat) == (to_rgba(FAINT), "--") and look(meeting) == (to_rgba(FAINT), "-")
    assert flat.get_ydata() == pytest.approx([5.44, 5.44]) and meeting.get_xdata() == pytest.approx([1e6 * BAR.meeting()] * 2)
    assert [text.get_text() for text in axes.texts] == ["flat plane"] and axes.texts[0].xy == (0, pytest.approx(5.44))
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time (µs)", "dissipated energy (µJ)")
    assert axes.get_xlim()[0] == axes.get_ylim()[0] == 0 and title(axes) == "Spall: dissipated energy on three meshes"
    assert [style(axes, one)[0] for one in labels(axes)] == [to_rgba(BLUE), to_rgba(GREEN)]
    assert_readable(figure)

    figure = study.draw_cracks(results, BAR)
    assert [axes.get_title() for axes in figure.axes] == ["uniform", "graded"]
    assert figure.get_size_inches() == pytest.approx((10, 4.6))
    assert all(axes.get_position().height > 0.7 for axes in figure.axes)
    assert texts(figure)[0] == "Fully broken faces near the middle"
    for axes in figure.axes:
        (faces,) = axes.collections
        assert np.array(segments(faces)) == pytest.approx(1e3 * CORNERS[:2])  # mm; within 0.3 mm, and fully broken
        for direction in "xyz":
            assert getattr(axes, f"get_{direction}lim")() == pytest.approx((-0.2, 0.2))
            assert getattr(axes, f"get_{direction}ticks")() == pytest.approx([-0.2, 0, 0.2])
        assert axes.get_xlabel() == "x (mm)" and (axes.elev, axes.azim) == (17, -68)
        assert np.ptp(axes._box_aspect) < 1e-12
    assert len({tuple(axes.collections[0].get_facecolor()[0]) for axes in figure.axes}) == 2
    figure.canvas.draw()
    assert_panels_apart(figure)


def test_cracks_of_a_bar_anywhere():
    """Of another bar, wider in y than in x and not around the origin, the faces around its middle."""
    box = np.array([[1.0, 2.0, 5.0], [1.2, 2.6, 9.0]])  # half its width: 0.3; so 0.45 on both sides of z = 7
    bar = theory.Spall(rhegma.read_case(example("spall.yaml")), box)
    at = [7.44, 6.56, 7.46, 6.54]
    corners = np.array([[[0, 0, 7], [1, 0, 7], [0, 1, z]] for z in at])
    faces, half = study.near_middle({"points": corners, "damage": np.ones(4)}, bar)
    assert faces == pytest.approx(1e3 * corners[:2]) and half == pytest.approx(300)
    one = result()
    one.crack["points"] = corners
    (axes,) = study.draw_cracks({"middle": one}, bar).axes
    assert axes.get_zlim() == pytest.approx((6700, 7300)) and axes.get_xlim() == pytest.approx((800, 1400))
    assert axes.get_ylim() == pytest.approx((2000, 2600))


def study_result(out, sets):
    points = BAR.box[[0, 1]]
    frames = [{"time": 0.6e-6, "crack/points": CORNERS.reshape(-1, 3), "crack/damage": np.ones((4, 1))}]
    made = result()
    synthetic.write_run(out, case=case_text("spall.yaml", mesh={"file": "m.h5"}), summary=made.summary,
                        energy_table={"time": made.energy["time"], "total": 0 * made.energy["time"],
                                      "dissipated": made.energy["dissipated"]},
                        fields=(points, np.zeros((1, 10), int), frames))


def test_mesh_study(tmp_path, monkeypatch, runs, saved, capsys):
    fake, figures, meshed = runs(study_result), saved(study), []
    monkeypatch.setattr(launch, "call", lambda words, **options: meshed.append((words, options)))
    (tmp_path / "graded.h5").write_text("made by somebody else")
    monkeypatch.chdir(tmp_path.parent)  # a mesh is sought from the case file on, so its path is made absolute
    status = start(study, monkeypatch, "--out", tmp_path.name, "--ranks", 2, "--threads", 3, "--end", "0.5e-6", "--safety", 0.7,
                   "--only", "graded", "uniform", "--set", "c=3")
    ((words, options),) = meshed
    assert words == [launch.program(), "mesh", example("spall-uniform.geo"), "-o", tmp_path / "uniform.h5", "--scale", "1e-3",
                     "--improve"]
    assert float((tmp_path / "uniform.mesh-s").read_text()) < 1 and not (tmp_path / "graded.mesh-s").exists()
    for call, name in zip(fake.calls, ("graded", "uniform")):
        assert (call.case.name, call.out, call.overrides) == ("spall.yaml", tmp_path / name, ["c=3"])
        assert call.sets == {"mesh": {"file": str(tmp_path / f"{name}.h5")}, "time.end": 0.5e-6, "time.safety": 0.7,
                             "output.fields": ["crack"]}
        assert call.keywords == {"launcher": launch.ranks_launcher(2), "show": True, "OMP_NUM_THREADS": "3"}
    assert set(figures) == {"energy.png", "cracks.png"}
    said = capsys.readouterr().out
    assert said.count("  yes\n") == 5 and "NO" not in said and status == 0 and "graded       12,345" in said
    assert "0 s     2 s" in said


def test_mesh_study_says_what_does_not_hold(tmp_path, monkeypatch, runs, saved, capsys):
    def late(out, sets):
        study_result(out, sets)
        (out / "summary.json").write_text((out / "summary.json").read_text().replace("2.246e-07", "2.5e-07"))

    runs(late), saved(study)
    (tmp_path / "uniform.h5").write_text("")
    assert start(study, monkeypatch, "--out", tmp_path, "--only", "uniform") == 1
    assert "first fracture within 3 % of 0.2246 us" in capsys.readouterr().out.split("  NO\n")[0]


def test_meshing_is_timed_once(tmp_path, monkeypatch):
    mesh = tmp_path / "uniform.h5"
    monkeypatch.setattr(launch, "call", lambda words, **options: (mesh.write_text(""), time.sleep(0.2)))
    assert 0.2 <= study.mesh_once("uniform", mesh) < 5
    (tmp_path / "uniform.mesh-s").write_text("17.5\n")
    assert study.mesh_once("uniform", mesh) == 17.5
    (tmp_path / "uniform.mesh-s").unlink()
    assert study.mesh_once("uniform", mesh) == 0


def test_study_runs_to_the_end_it_says(tmp_path, monkeypatch, runs, saved, capfd):
    fake, _ = runs(study_result), saved(study)
    monkeypatch.setattr(launch, "call", lambda words, **options: options["show"])
    start(study, monkeypatch, "--out", tmp_path / "a" / "b", "--threads", 1)
    assert [call.out.name for call in fake.calls] == ["uniform", "middle", "graded"]
    assert fake.calls[0].sets["time.end"] == 0.6e-6 and fake.calls[0].sets["time.safety"] == 0.9
    assert fake.calls[0].keywords["launcher"] == [] and len(capfd.readouterr().out.splitlines()) == 5 + 6


def test_threads_of_the_study(tmp_path, monkeypatch):
    asked = []
    monkeypatch.setattr(study, "compute", lambda name, args: asked.append(args.threads)
                        or (_ for _ in ()).throw(rhegma.BadInput("stop")))
    monkeypatch.setattr(study.os, "cpu_count", lambda: 7)
    for words in (["--ranks", 2], ["--ranks", 9], ["--threads", 5]):
        with pytest.raises(rhegma.BadInput, match="stop"):
            start(study, monkeypatch, "--out", tmp_path, *words)
    assert asked == [3, 1, 5]


# ---- bench/studies/fragmentation ----

fragmentation = script("bench/studies/fragmentation")
STRETCHED = rhegma.read_case(example("fragmentation.yaml"))


def test_settings_of_a_stretched_bar():
    bar = theory.Stretched(STRETCHED)
    sets = fragmentation.settings(bar, 3e4, 7)
    assert sets["mesh.seed"] == 7
    strain = 0.975 * 400e6 / 260e9  # just before it breaks: 1.5e-3, as in the case
    for key, along in (("initial.displacement", strain), ("initial.velocity", 3e4)):
        found = [float(sets[key][c].removesuffix(f"*{c}")) for c in "xyz"]
        assert found == pytest.approx([-0.21 * along, -0.21 * along, along])
    assert sets["boundary"] == [{"set": side, "component": "z", "velocity": pytest.approx(speed)} for side,
                                speed in (("z+", 300), ("z-", -300))]
    size, opening = bar.glenn_chudnovsky(3e4), 2 * 340 / 400e6
    end = 0.13 * 400e6 / 260e9 / 3e4 + 6 * size / math.sqrt(260e9 / 3690) + 4 * opening / (3e4 * size)
    assert sets["time.end"] == pytest.approx(end) and sets["output.interval"] == pytest.approx(end / 20)


def test_case_starts_as_the_script_has_it():
    """At its own rate the case and the script's settings are the same motion."""
    sets = fragmentation.settings(theory.Stretched(STRETCHED), 1e5, 1)
    def value(text):
        return float(np.prod([float(factor) for factor in text.split("*")[:-1]]))
    for key in ("displacement", "velocity"):
        for c in "xyz":
            assert value(sets[f"initial.{key}"][c]) == pytest.approx(value(STRETCHED["initial"][key][c]))


def pieces_result(out, sets):
    """As many fragments at the end as the rate over 1e3, plus the seed, the same from the middle on."""
    seed, rate = sets["mesh.seed"], float(sets["initial.velocity"]["z"].removesuffix("*z"))
    number = int(rate / 1e3) + seed
    times = [0.25] * 1 + [0.5] * number + [1.0] * number
    synthetic.write_run(out, fragments={"time": times, "id": range(len(times)), "mass": np.ones(len(times))})


def test_fragmentation(tmp_path, monkeypatch, runs, saved, capsys):
    fake, figures = runs(pieces_result), saved(fragmentation)
    start(fragmentation, monkeypatch, "--out", tmp_path, "--rates", "3e4", "1e4", "--seeds", 1, 5, "--set",
          "mesh.cells=[1, 1, 99]",
          "--set", "interface.energy=170")
    assert [(call.case.name, call.out.name) for call in fake.calls] == [
        ("fragmentation.yaml", f"rate-{rate}-seed-{seed}") for rate in (30000, 10000) for seed in (1, 5)]
    bar = theory.Stretched({**STRETCHED, "interface": {**STRETCHED["interface"], "energy": 170}})
    assert fake.calls[3].sets == fragmentation.settings(bar, 1e4, 5)
    assert fake.calls[0].overrides == ["mesh.cells=[1, 1, 99]", "interface.energy=170"]
    said = capsys.readouterr().out.splitlines()
    assert said[1] == ("rate 3e+04/s, seed 5: 35 fragments (the same since 0.50 of the time), mean size 0.571 mm, "
                       "energy error 1.2e-03")
    sizes = [(rate, 1e3 * bar.grady(rate), 1e3 * bar.glenn_chudnovsky(rate)) for rate in (1e4, 3e4)]
    assert said[4:6] == [f"rate {rate:.3g}/s: Grady {one:.3g} mm, Glenn-Chudnovsky {other:.3g} mm" for rate, one,
                         other in sizes]
    figure = figures["fragmentation.png"]
    (axes,) = figure.axes
    computed = "computed, one mark a mesh"
    assert labels(axes) == ["Grady 1982", "Glenn & Chudnovsky 1986", "planes of the mesh", computed] == legend(axes)
    rates, numbers = line(axes, computed)
    assert sorted(zip(rates, numbers)) == [(1e4, 11), (1e4, 15), (3e4, 31), (3e4, 35)]
    assert style(axes, computed)[1:] == ("None", "o")
    for label, size in (("Grady 1982", bar.grady), ("Glenn & Chudnovsky 1986", bar.glenn_chudnovsky)):
        rates, numbers = line(axes, label)
        assert numbers == pytest.approx([20e-3 / size(rate) for rate in rates])
        assert rates[[0, -1]] == pytest.approx([1e4 / 1.5, 4.5e4])
    assert line(axes, "planes of the mesh")[1].tolist() == [99, 99]
    assert (axes.get_xscale(), axes.get_yscale(), axes.get_xlabel(), axes.get_ylabel()) == (
        "log", "log", "strain rate (1/s)", "fragments of 20 mm")
    assert title(axes) == "Fragments of a stretched bar"
    assert [style(axes, one)[:2] for one in labels(axes)] == [(to_rgba(INK), "--"), (to_rgba(INK), "-"), (to_rgba(FAINT), ":"),
                                                              (to_rgba(BLUE), "None")]
    assert_readable(figure)


def test_fragmentation_has_its_rates_and_seeds(tmp_path, monkeypatch, runs, saved):
    fake, _ = runs(pieces_result), saved(fragmentation)
    start(fragmentation, monkeypatch, "--out", tmp_path)
    assert [call.out.name for call in fake.calls] == [f"rate-{rate}-seed-{seed}"
                                                      for rate in ("10000", "30000", "100000", "300000") for seed in (1, 2)]


def test_fragmentation_without_the_table(tmp_path, monkeypatch, runs):
    runs(lambda out, sets: synthetic.write_run(out))
    with pytest.raises(rhegma.BadInput, match=r"wrote no fragments.csv \(output.fragments\)"):
        start(fragmentation, monkeypatch, "--out", tmp_path, "--rates", 1e4, "--seeds", 1)


def test_count_of_fragments():
    table = synthetic.structured({"time": [1.0, 1, 2, 4, 4, 8, 8]})
    assert fragmentation.count(table) == (2, 1 / 8)
    assert fragmentation.count(synthetic.structured({"time": [1.0, 2, 2, 4, 4, 4]})) == (3, 1)
