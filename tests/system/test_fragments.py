"""Fragments of runs: they add up to the body, are the same bits on any layout, and overlaps are told. Their values
against closed forms are in test_fragment.c."""

import os
import re
import shutil
import subprocess

import numpy as np
import pytest
import rhegma
from conftest import CASES, ENVIRONMENT, PROGRAM, ROOT, launch, rounding
from figures import ROUNDING

SETS = {"time.end": 0.6e-6, "output.interval": 5e-8, "output.energy_limit": 1e9,
        "output.fields": ["fragment", "crack"]}
LAYOUTS = [(1, 2), (2, 1), (3, 1)]  # ranks, threads


@pytest.fixture(scope="module")
def torn(run):
    return run(CASES / "fragments.yaml", sets=SETS)


def by_step(run):
    rows = run.fragments
    return [(step, rows[rows["step"] == step]) for step in np.unique(rows["step"])]


STRENGTHS = {"uniform": {}, "weibull": {"interface.weibull": {"modulus": 10, "area": 7.8e-9}}}


@pytest.mark.parametrize("ranks, threads", LAYOUTS)
@pytest.mark.parametrize("strengths", STRENGTHS)
def test_same_fragments_on_any_layout(run, strengths, ranks, threads):
    sets = {**SETS, **STRENGTHS[strengths]}
    one = run(CASES / "fragments.yaml", sets=sets)
    other = run(CASES / "fragments.yaml", ranks=ranks, threads=threads, sets=sets)
    assert len(by_step(one)[-1][1]) > 4
    assert (other.dir / "fragments.csv").read_bytes() == (one.dir / "fragments.csv").read_bytes()
    for key in ("fragments", "fragment_mass_heaviest_kg", "fragment_mass_bins", "state_hash"):
        assert other.summary[key] == one.summary[key], key
    for a, b in zip(one.frames(), other.frames()):
        assert np.array_equal(a["fragment"], b["fragment"])


def test_fragments_add_up_to_the_body(torn, figure):
    mass = 3690 * 0.4e-3 * 0.4e-3 * 3.2e-3
    worst = {"mass": 0, "kinetic energy": 0, "momentum": 0}
    for (step, rows), ledger in zip(by_step(torn), torn.energy):
        assert step == ledger["step"]
        assert rows["elements"].sum() == torn.summary["elements"]
        found = {"mass": [rows["mass"].sum() / mass - 1], "kinetic energy": [rows["kinetic"].sum() / ledger["kinetic"] - 1],
                 "momentum": [(rows[name].sum() - ledger[name]) / np.abs(rows[name]).sum()
                              for name in ("momentum_x", "momentum_y", "momentum_z")]}
        worst = {name: max(worst[name], np.abs(found[name]).max()) for name in worst}
    for name, error in worst.items():
        figure(f"fragments of a torn bar: sum against the body, {name}, relative", error, bound=rounding(1e-15, 1e-6),
               why=ROUNDING)


def test_moving_and_turning_take_no_more_than_the_kinetic_energy(torn):
    rows = torn.fragments
    moving = sum(rows[f"momentum_{axis}"] ** 2 for axis in "xyz") / (2 * rows["mass"])
    assert (rows["rotational"] >= 0).all()
    assert (moving + rows["rotational"] <= rows["kinetic"] * (1 + rounding(1e-12, 1e-5))).all()


def test_field_and_summary_agree_with_the_table(torn):
    _, rows = by_step(torn)[-1]
    ids, elements = np.unique(torn.frames()[-1]["fragment"], return_counts=True)
    assert np.array_equal(ids, rows["id"]) and np.array_equal(elements, rows["elements"])
    assert torn.summary["fragments"] == len(rows)
    assert torn.summary["fragment_mass_heaviest_kg"] == rows["mass"].max()
    bins = torn.summary["fragment_mass_bins"]
    assert sum(count for _, count, _ in bins) == len(rows)
    assert sum(mass for _, _, mass in bins) == pytest.approx(rows["mass"].sum(), rel=1e-12)
    for upper, count, _ in bins:
        inside = (rows["mass"] <= upper * (1 + 1e-9)) & (rows["mass"] > upper / 2 * (1 + 1e-9))
        assert inside.sum() == count


@pytest.mark.parametrize("when, steps", [("last", 1), ("none", 0)])
def test_fragments_only_when_asked_for(run, torn, when, steps):
    few = run(CASES / "fragments.yaml", sets={**SETS, "output.fragments": when})
    assert (few.dir / "fragments.csv").exists() == (steps > 0)
    assert ("fragments" in few.summary) == (steps > 0)
    if steps:
        assert (few.dir / "fragments.csv").read_bytes().split(b"\n")[1:] == (
            (torn.dir / "fragments.csv").read_bytes().split(b"\n")[-1 - len(by_step(torn)[-1][1]):])


# ---- Pieces that do not see each other ----

CUBE = [(0, 1, 3, 7), (0, 1, 5, 7), (0, 2, 3, 7), (0, 2, 6, 7), (0, 4, 5, 7), (0, 4, 6, 7)]  # around 0-7
GAP, SPEED = 0.2e-3, 100.0  # m, m/s: of cubes of 1 mm that fly at each other


def two_cubes():
    nodes, elements = [], []
    for body in range(2):
        for k in range(8):
            x = [1e-3 * (k & 1), 1e-3 * (k >> 1 & 1), 1e-3 * (k >> 2 & 1) + body * (1e-3 + GAP)]
            nodes.append(", ".join([str(8 * body + k + 1), *map(repr, x)]))
        for k, corners in enumerate(CUBE):
            elements.append(", ".join(map(str, [6 * body + k + 1, *(8 * body + c + 1 for c in corners)])))
    return "*NODE\n{}\n*ELEMENT, TYPE=C3D4\n{}\n".format("\n".join(nodes), "\n".join(elements))


def meet(scratch, ranks, towards, *arguments):
    folder = scratch / "-".join(["cubes", str(ranks), str(towards), *arguments[1::2]])
    folder.mkdir()
    (folder / "cubes.inp").write_text(two_cubes())
    made = launch("mesh", folder / "cubes.inp", "-o", folder / "cubes.h5")
    assert made.returncode == 0, made.stderr
    (folder / "cubes.yaml").write_text(f"""
mesh: {{file: cubes.h5}}
material: {{model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}}
interface: {{law: none}}
initial: {{velocity: {{z: "z > 1.1e-3 ? {-towards * SPEED} : 0"}}}}
time: {{end: 4e-6}}
output: {{interval: 1e-7, fields: []}}
""")
    return folder, launch("run", folder / "cubes.yaml", "-q", "-o", folder / "out", *arguments, ranks=ranks)


@pytest.mark.parametrize("ranks, table", [(1, "each"), (2, "each"), (1, "last"), (2, "none")])
def test_overlap_is_told_once(scratch, ranks, table):
    """At the first output that finds it, with or without a table of fragments."""
    folder, process = meet(scratch, ranks, 1, "--set", f"output.fragments={table}")
    assert process.returncode == 0
    assert process.stderr.count("warning: fragments 0 and 6 overlap at ") == 1
    summary = (folder / "out" / "summary.json").read_text()
    assert '"overlap_fragments": [0, 6]' in summary
    first = float(summary.split('"overlap_time_s": ')[1].split(",")[0])
    assert GAP / SPEED < first < (GAP + 0.1e-3) / SPEED + 1e-7


def test_overlap_is_not_told_again_after_a_restart(scratch):
    """A run goes on once before and once after the overlap."""
    folder, process = meet(scratch, 1, 1, "--set", "checkpoint={steps: 60, keep: 1000}")
    summary = rhegma.summary(folder / "out")
    for share in (0.5, 1.2):
        directory = folder / f"from-{share}"
        shutil.copytree(folder / "out", directory)
        for path in (directory / "checkpoints").glob("step-*.h5"):
            if int(path.stem[5:]) > share * summary["steps"] * summary["overlap_time_s"] / summary["time_end"]:
                path.unlink()
        again = launch("run", "--restart", directory, "-q", ranks=2)
        assert again.returncode == 0, again.stderr
        assert again.stderr.count("overlap") == (share < 1)
        found = rhegma.summary(directory)
        assert 0 < found["restarted_from_step"] < summary["steps"] - 20
        for key in ("overlap_time_s", "overlap_fragments", "state_hash"):
            assert found[key] == summary[key]


def test_no_word_of_pieces_that_part(scratch):
    folder, process = meet(scratch, 1, -1)
    assert process.returncode == 0 and "overlap" not in process.stderr
    assert "overlap_" not in (folder / "out" / "summary.json").read_text()
    assert rhegma.summary(folder / "out")["overlaps"] == 0


# ---- A bar stretched at a uniform rate ----


def test_fragments_of_a_stretched_bar_are_of_the_size_that_energy_allows(scratch, figure):
    """Within a factor of 3 of Glenn & Chudnovsky (1986), whose theory is one of order of magnitude, and not a matter of the
    mesh, which has 160 planes."""
    environment = {**os.environ, **ENVIRONMENT, "RHEGMA": str(PROGRAM), "OMP_NUM_THREADS": "2"}
    command = [ROOT / "bench/studies/fragmentation", "--out", scratch / "stretched", "--rates", "3e4", "--seeds", "1"]
    process = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)
    assert process.returncode == 0, process.stderr
    count = int(re.search(r": (\d+) fragments", process.stdout)[1])
    size = float(re.search(r"Glenn-Chudnovsky ([\d.]+) mm", process.stdout)[1])
    figure("bar stretched at 3e4/s: fragments against Glenn and Chudnovsky", count, theory=20 / size, bound=2, relative=True)
    assert 20 / size / 3 < count < 80
    assert (scratch / "stretched" / "fragmentation.png").exists()
