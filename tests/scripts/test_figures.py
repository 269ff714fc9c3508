"""Figures that tests state, and what tests/report makes of them."""

import importlib.machinery
import importlib.util
import json
import os
import subprocess

import figures
import pytest
from conftest import ENVIRONMENT, PROGRAM, ROOT


def load_report():
    loader = importlib.machinery.SourceFileLoader("report", str(ROOT / "tests" / "report"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("report", loader))
    loader.exec_module(module)
    return module


@pytest.fixture
def lines(tmp_path, monkeypatch):
    """lines(): what has been written so far."""
    path = tmp_path / "figures.jsonl"
    monkeypatch.setenv("RHEGMA_FIGURES", str(path))
    return lambda: load_report().collect(path)


def state(found, test="test_a.py::test_b[c]", **more):
    figures.state(test, False, "speed", found, **{"bound": 0.1, **more})


@pytest.mark.parametrize("found, more", [
    (0.11, {}), (float("nan"), {}), (float("inf"), {}), (-0.11, {}), (1.12, {"theory": 1}), (8, {"theory": 10, "relative": True})])
def test_a_figure_beyond_its_bound_fails_and_is_written(lines, found, more):
    with pytest.raises(AssertionError, match="speed: found"):
        state(found, **more)
    (line,) = lines()
    assert line["quantity"] == "speed" and load_report().apart(line) > 0.1 or found != found


@pytest.mark.parametrize("found, more", [(0.1, {}), (-0.1, {}), (0.95, {"theory": 1}), (9, {"theory": 10, "relative": True})])
def test_a_figure_within_its_bound_passes(lines, found, more):
    state(found, **more)
    assert len(lines()) == 1


def test_nothing_is_written_unless_it_is_asked_for(monkeypatch, tmp_path):
    monkeypatch.delenv("RHEGMA_FIGURES", raising=False)
    monkeypatch.chdir(tmp_path)
    state(0.05)
    assert list(tmp_path.iterdir()) == []


def test_table_has_the_worst_and_tells_what_is_loose(lines):
    report = load_report()
    for found in (0.02, -0.03, 0.01):
        state(found, test=f"test_a.py::test_b[{found}]")
    state(0.04)
    state(0.02, why="as it is", test="test_a.py::test_c")
    state(9.9, theory=10, relative=True, unit="m/s", test="test_z.py::test_d[1]")
    worst, excused, relative = lines()
    assert worst["found"] == 0.04 and not report.loose(worst)
    assert report.loose({**worst, "found": 0.03}) and not report.loose({**worst, "found": 0.034})
    assert not report.loose(excused)
    assert report.row(relative, ["as it is"]) == (
        "| speed | 10 m/s | 9.9 m/s (-1 %) | 10 % | `python3 -m pytest -rP tests/system/test_z.py::test_d` |")
    assert "0.1 [1] |" in report.row(excused, ["as it is"])


def test_programs_in_c_write_the_same(tmp_path):
    path = tmp_path / "figures.jsonl"
    program = PROGRAM.parent / "tests" / "test_friction"
    environment = {**os.environ, **ENVIRONMENT, "RHEGMA_FIGURES": str(path)}
    said = subprocess.run([program], env=environment, capture_output=True, text=True, timeout=300)
    assert said.returncode == 0
    written = [json.loads(text) for text in path.read_text().splitlines()]
    assert len(written) == 5 and all(f"# {line['quantity']}: found" in said.stderr for line in written)
    for line in written:
        assert line["test"] == "test_friction" and line["ranks"] == 1 and 0 < line["found"] <= line["bound"]
        assert set(line) == {"quantity", "theory", "found", "bound", "relative", "unit", "why", "test", "ranks", "single"}
