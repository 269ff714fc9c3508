"""bench/validate and the gallery behind it, with a case of the test's own in place of those of bench/examples and a table of
numbers in place of the program."""

import json
import os
import re
import subprocess
import sys

import matplotlib
import numpy as np
import pytest
import synthetic_run as synthetic
from conftest import ENVIRONMENT, PROGRAM, ROOT, SINGLE, TIMEOUT
from pictures import script

import gallery
import launch
import rhegma

CASE = """
import pathlib
import gallery
TITLE, SEED = "a bar", SEED_KEY
HERE = pathlib.Path(__file__).parent
def runs(full):
    return {"bar": gallery.Setup(HERE / "bar.yaml", {"time.end": 2e-6 if full else 1e-6}, GEOMETRY, VALUES)}
def quantities(setups, done):
    strength = setups["bar"].case["interface"]["strength"]
    return [gallery.within("strength", done["bar"].summary["found"], strength, 0.05), gallery.ledger(done["bar"])]
def draw(setups, done):
    from drawing import plt
    return plt.figure()
"""
validate = script("bench/validate")


@pytest.fixture
def bar(tmp_path, monkeypatch):
    """bar(found=, error=, seed=, geometry=, values=): a gallery with one case, whose run finds what it is told: the words and
    environments of the calls of the program are in bar.calls."""
    examples = tmp_path / "examples"
    (examples / "bar").mkdir(parents=True)
    (examples / "bar/bar.yaml").write_text("interface: {strength: 100}\ntime: {end: 1}\n")
    monkeypatch.setattr(gallery, "EXAMPLES", examples)

    def make(found=lambda sets: 100.0, error=1e-4, status="completed", seed="mesh.seed", geometry="", values=None):
        text = CASE.replace("SEED_KEY", repr(seed)).replace("VALUES", repr(values or {}))
        (examples / "bar/validation.py").write_text(text.replace("GEOMETRY", f"HERE / {geometry!r}" if geometry else "None"))
        (examples / "bar/bar.geo").write_text("DefineConstant[ h = 1 ];\n")

        def call(command, *, accept=(0,), **environment):
            words = [str(word) for word in command]
            make.calls.append((words, environment))
            if "mesh" in words:
                open(words[words.index("-o") + 1], "w").close()
                return
            sets = dict(word.split("=", 1) for word in words if "=" in word)
            synthetic.write_run(rhegma.pathlib.Path(words[words.index("-o" if "-o" in words else "--restart") + 1]),
                                case="time: {end: 1}\n", summary={"found": found(sets), "energy_error_dissipated": error,
                                                                   "status": status, "time_end": 0.25})

        monkeypatch.setattr(launch, "call", call)
        return make

    make.calls = []
    return make


def start(monkeypatch, tmp_path, *words):
    """Exit status of the command."""
    monkeypatch.setattr(sys, "argv", ["validate", "--out", str(tmp_path / "out"), *map(str, words)])
    return validate.main()


def test_what_holds(bar, tmp_path, monkeypatch, capsys):
    bar(lambda sets: 104.0)
    assert start(monkeypatch, tmp_path, "bar", "--threads", 1, "--json", tmp_path / "r.json") == 0
    assert json.loads((tmp_path / "r.json").read_text()) == [
        {"quantity": "strength", "value": 104.0, "expected": 100.0, "low": 95.0, "high": 105.0, "ok": True},
        {"quantity": "energy error over dissipated", "value": 1e-4, "expected": 0.0, "low": -0.01, "high": 0.01, "ok": True}]
    said = capsys.readouterr().out.splitlines()
    assert "| strength | 104 | 100 | 95 | 105 | holds |" in said
    page = tmp_path / "out/1x1/report.html"
    assert said[-1] == str(page) and '<img src="bar.png"' in page.read_text() and (page.parent / "bar.png").exists()
    assert "in 0 something fails" in page.read_text()


@pytest.mark.parametrize("found, error", [(106.0, 1e-4), (94.0, 1e-4), (float("nan"), 1e-4), (100.0, 0.02), (100.0, -0.02)])
def test_what_does_not_hold(bar, found, error, tmp_path, monkeypatch, capsys):
    bar(lambda sets: found, error)
    assert start(monkeypatch, tmp_path, "bar", "--json", tmp_path / "r.json") == 1
    text = (tmp_path / "r.json").read_text()
    assert [row["ok"] for row in json.loads(text)].count(False) == 1 and "NaN" not in text
    assert capsys.readouterr().out.count("| FAILS |") == 1
    assert next((tmp_path / "out").glob("*/report.html")).read_text().count("class=fails") == 1


def test_an_error_that_is_planted_does_not_change_what_is_expected(bar, tmp_path, monkeypatch):
    bar(lambda sets: float(sets["interface.strength"]))
    assert start(monkeypatch, tmp_path, "--set", "interface.strength=110", "--set", "time.end=3", "--json", tmp_path / "r.json") == 1
    assert json.loads((tmp_path / "r.json").read_text())[0]["expected"] == 100
    (words, _), = bar.calls
    assert words[-4:] == ["--set", "interface.strength=110", "--set", "time.end=3"]
    assert not any(word.startswith("time.end=1e") for word in words)  # once


def test_a_run_that_ends_early_fails(bar, tmp_path, monkeypatch, capsys):
    bar(status="stopped")
    assert start(monkeypatch, tmp_path, "bar") == 1
    assert "| bar: time reached (s), stopped | 0.25 | 1 | 1 | 1 | FAILS |" in capsys.readouterr().out


def test_list_and_names(bar, tmp_path, monkeypatch, capsys):
    bar()
    assert start(monkeypatch, tmp_path, "--list") == 0 and capsys.readouterr().out == "bar\n"
    with pytest.raises(launch.BadInput, match="foo: no such case; there are bar"):
        start(monkeypatch, tmp_path, "bar", "foo")
    assert not bar.calls


def test_seeds(bar, tmp_path, monkeypatch, capsys):
    bar(lambda sets: 100.0 + 2 * float(sets["mesh.seed"]))
    assert start(monkeypatch, tmp_path, "--seeds", 3, "--json", tmp_path / "r.json") == 0
    assert json.loads((tmp_path / "r.json").read_text())[0]["value"] == 104
    assert "| strength | 104 | 2 | 102 | 106 |" in capsys.readouterr().out


def test_layouts_and_versions_lie_apart_and_are_not_run_again(bar, tmp_path, monkeypatch):
    bar()
    for words in (["--threads", 1], ["--threads", 2], ["--ranks", 2, "--threads", 1], ["--threads", 1, "--full"], ["--threads", 1]):
        assert start(monkeypatch, tmp_path, "bar", *words) == 0
    assert [(words[0], environment["OMP_NUM_THREADS"]) for words, environment in bar.calls] == [
        (str(launch.program()), "1"), (str(launch.program()), "2"), ("mpirun", "1"), (str(launch.program()), "1")]
    assert bar.calls[2][0][:5] == ["mpirun", "--bind-to", "none", "-n", "2"]
    assert [re.findall(r"time.end=\S+", " ".join(words)) for words, _ in bar.calls][2:] == [["time.end=1e-06"], ["time.end=2e-06"]]
    assert {str(path.parent.relative_to(tmp_path / "out")) for path in (tmp_path / "out").rglob("summary.json")} == {
        "1x1/reduced/bar/bar", "1x2/reduced/bar/bar", "2x1/reduced/bar/bar", "1x1/full/bar/bar"}


def test_meshes_are_made_of_the_values_and_once(bar, tmp_path, monkeypatch):
    bar(seed="geometry:seed", geometry="bar.geo", values={"h": 0.5})
    for _ in range(2):
        assert start(monkeypatch, tmp_path, "--threads", 1, "--seeds", 2) == 0
    meshes = [words for words, _ in bar.calls if "mesh" in words]
    assert len(meshes) == 2 and len(bar.calls) == 4
    folder = tmp_path / "out/1x1/reduced/bar"
    assert (folder / "seed-2/bar.geo").read_text() == "h = 0.5;\nseed = 2;\nDefineConstant[ h = 1 ];\n"
    assert meshes[1][2:] == [str(folder / "seed-2/bar.geo"), "-o", str(folder / "seed-2/bar.h5"), "--scale", "0.001", "--improve"]
    assert any(word == f'mesh.file="{folder / "seed-1/bar.h5"}"' for word in bar.calls[1][0])
    bar(seed="geometry:seed", geometry="bar.geo", values={"h": 0.25})
    assert start(monkeypatch, tmp_path, "--threads", 1, "--seeds", 1) == 0
    assert len([words for words, _ in bar.calls if "mesh" in words]) == 3


def test_a_run_of_another_case_or_program_is_made_anew(bar, tmp_path, monkeypatch):
    bar()
    monkeypatch.setenv("RHEGMA", str(tmp_path / "program"))
    (tmp_path / "program").write_text("1")
    for path in (tmp_path / "program", tmp_path / "examples/bar/bar.yaml"):
        for _ in range(2):
            assert start(monkeypatch, tmp_path, "--threads", 1) == 0
        path.write_text(path.read_text() + "\n")
    assert start(monkeypatch, tmp_path, "--threads", 1) == 0
    assert len(bar.calls) == 3


def test_an_interrupted_run_goes_on(bar, tmp_path, monkeypatch):
    bar()
    assert start(monkeypatch, tmp_path, "--threads", 1) == 0
    out = tmp_path / "out/1x1/reduced/bar/bar"
    record = json.loads((out.parent / "bar.run").read_text())
    del record["seconds"]  # as a run leaves it that was killed
    (out.parent / "bar.run").write_text(json.dumps(record))
    (out / "checkpoints").mkdir()
    (out / "checkpoints/1").touch()
    for overrides, expected in (([], ["--restart", str(out)]), (["--set", "time.end=3"], ["-o", str(out), "--overwrite"])):
        assert start(monkeypatch, tmp_path, "--threads", 1, *overrides) == 0
        assert bar.calls[-1][0][3:6] == [*expected, "-q"][:3]


def test_energy_spent_and_first_fracture(tmp_path):
    """Of two faces of 0.5 and 2 m2; and of a run in which nothing broke."""
    crack = {"points": np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [2, 0, 0], [0, 0, 2]]], float),
             "damage": np.array([1, 0.25])}
    run = rhegma.Run(synthetic.write_run(tmp_path, summary={"dissipated_J": 3.0, "first_fracture_time_s": None}))
    assert gallery.areas(crack) == pytest.approx([0.5, 2]) and gallery.spent(run, crack) == 3
    assert gallery.spent(run, crack, np.array([False, True])) == 6 and np.isnan(gallery.first_fracture(run))
    assert np.isnan(gallery.spent(run, {"points": crack["points"][:0], "damage": crack["damage"][:0]}))
    steel = rhegma.Material("steel", "neo-hookean", 8000, 190e9 / 2.6, 0.3)
    assert gallery.rayleigh_speed(steel) == pytest.approx(0.9274 * steel.shear_speed, rel=1e-4)  # of nu 0.3


def test_energy_of_a_moving_crack():
    """g(v) against a crack by boundary integral, which knows nothing of it."""
    moving, setup = gallery.load("moving-crack"), gallery.load("moving-crack").runs(False)["run"]
    case, glass = setup.case, rhegma.one_material(setup.case, "a crack")
    other = moving.boundary_integral().run(glass, moving.TENSION, float(case["interface"]["strength"]),
                                           float(case["interface"]["energy"]), 6e-6, 2e-4, 0.08)
    for span in ((3e-6, 4e-6), (4e-6, 5e-6), (4e-6, 6e-6)):
        assert moving.mean_speed(*other, span) == pytest.approx(np.mean(moving.speed(case, np.linspace(*span, 201))), rel=0.02)
    rayleigh = gallery.rayleigh_speed(glass)
    assert gallery.moving_crack_share(glass, 0) == 1 and gallery.moving_crack_share(glass, 0.9999 * rayleigh) < 2e-4
    assert gallery.moving_crack_share(glass, 1e-3 * rayleigh) == pytest.approx(1, abs=2e-3)
    assert gallery.moving_crack_share(glass, gallery.moving_crack_speed(glass, 0.3)) == pytest.approx(0.3, rel=1e-4)


def test_cases_of_the_gallery():
    """Each can be loaded, and says what it runs, from files that are there; the gallery of examples tells the command."""
    assert gallery.names()
    for name in gallery.names():
        module = gallery.load(name)
        assert module.TITLE and f"bench/validate {name}" in (gallery.EXAMPLES / name / "README.md").read_text()
        for full in (False, True):
            for setup in module.runs(full).values():
                assert setup.file.exists() and (setup.geometry is None or setup.geometry.exists())
                assert setup.seeded(module.SEED, 7) != setup and setup.case
    assert "bench/validate" in (ROOT / "bench/README.md").read_text() and matplotlib.get_backend().lower() == "agg"


def judged(tmp_path, *arguments):
    """bench/validate with the program itself: exit status and rows."""
    command = [sys.executable, ROOT / "bench/validate", *arguments, "--threads", "1", "--out", tmp_path, "--json", tmp_path / "r.json"]
    done = subprocess.run(command, env={**os.environ, **ENVIRONMENT, "RHEGMA": str(PROGRAM)}, capture_output=True, text=True,
                          timeout=TIMEOUT)
    assert done.returncode in (0, 1), done.stderr
    return done.returncode, json.loads((tmp_path / "r.json").read_text())


@pytest.mark.skipif(not PROGRAM.with_name("rhegma-mesh").exists(), reason="rhegma-mesh is not built (Debian: libgmsh-dev)")
@pytest.mark.skipif(SINGLE, reason="bounds are those of double precision")
@pytest.mark.parametrize("name", ["resting-crack", "brazilian-disc"])
def test_cases_that_hold(tmp_path, name):
    status, rows = judged(tmp_path, name)
    assert status == 0 and len(rows) == 5 and all(row["ok"] for row in rows)


@pytest.mark.skipif(SINGLE, reason="bounds are those of double precision")
def test_spall_by_a_plate_holds_and_turns_with_the_strength(tmp_path):
    """A case of the gallery with the program itself, on a mesh of fewer elements across."""
    for planted, status, wrong in (([], 0, []), (["--set", "interface.strength=440e6"], 1, ["pull-back of the velocity (m/s)"])):
        turned, rows = judged(tmp_path, "plate-impact-spall", "--set", "mesh.cells=[1, 1, 80]", *planted)
        assert turned == status
        assert len(rows) == 6 and [row["quantity"] for row in rows if not row["ok"]] == wrong
