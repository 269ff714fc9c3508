"""The drivers of scaling studies: what they run is what they say, delays from outside change no bit, the model follows the
simulation."""

import json
import os
import shutil
import statistics
import subprocess
import sys

import pytest
import rhegma
from conftest import CASES, ENVIRONMENT, PROGRAM, ROOT, SINGLE, TIMEOUT, launch, overrides

BUILD = PROGRAM.parent
SETS = {"time.end": 5e-8, "output.interval": 1, "output.fields": []}
pytestmark = pytest.mark.skipif(not (BUILD / "rhegma-pattern").exists(), reason="built without -Dbench=true")


def command(*words, **environment):
    process = subprocess.run([str(w) for w in words], env={**os.environ, **ENVIRONMENT, **environment}, capture_output=True,
                             text=True, timeout=TIMEOUT)
    assert process.returncode == 0, process.stderr or process.stdout
    return process.stdout


def test_delayed_messages_change_time_but_no_bit(tmp_path):
    delay = 3e-3
    sets = overrides({**SETS, "time.steps": 30, "output.interval": 30})
    quick = launch("run", CASES / "fragments.yaml", "-q", "-o", tmp_path / "quick", *sets, ranks=2)
    assert quick.returncode == 0, quick.stderr
    command("mpirun", "--bind-to", "none", "-n", 2, "env", f"LD_PRELOAD={BUILD / 'libmpi_delay.so'}", PROGRAM, "run",
            CASES / "fragments.yaml", "-q", "-o", tmp_path / "slow", *sets, RHEGMA_DELAY_US=str(1e6 * delay),
            OMP_NUM_THREADS="1")
    one, other = (rhegma.summary(tmp_path / name) for name in ("quick", "slow"))
    assert one["state_hash"] == other["state_hash"]
    assert other["wall_s"] > 29 * 2 * delay  # two exchanges a step, one after the other; the first one before the clock


@pytest.mark.parametrize("ranks", [2, 5])
def test_pattern_is_the_one_of_a_run(run, tmp_path, ranks):
    cells = [4, 4, 32]  # powers of two: no centroid is rounded across a border of the curve
    summary = run(CASES / "fragments.yaml", ranks=ranks,
                  sets={"mesh.cells": cells, "mesh.size": cells, "mesh.origin": [0, 0, 0], "mesh.jitter": 0, "time.steps": 1,
                        "output.fields": []}).summary
    command(BUILD / "rhegma-pattern", tmp_path / "p", *cells, ranks)
    rows = [[int(x) for x in line.split()] for line in (tmp_path / f"p-{ranks}.txt").read_text().splitlines()[1:]]
    assert sum(row[0] for row in rows) == summary["elements"]
    assert sum(sum(row[4::2]) for row in rows) == 2 * summary["cut_faces"]
    assert [min(row[2] for row in rows), max(row[2] for row in rows)] == summary["neighbours"][::2]
    bytes_sent = [sum(row[4::2]) * 27 * (4 if SINGLE else 8) for row in rows]
    assert summary["bytes_per_step"][::2] == pytest.approx([min(bytes_sent), max(bytes_sent)], rel=1e-5)


def test_scaling_leaves_a_record_for_each_layout_and_a_picture(tmp_path):
    command(sys.executable, ROOT / "bench/scaling", "run", "--out", tmp_path, "--layouts", "1x1,2x1", "--cells", "3,3,30", "--steps", 5,
            "--repeats", 2, "--build", BUILD, "--launcher", "mpirun -n {ranks} --bind-to none")
    one, two = (json.loads((tmp_path / f"strong-1620-{name}.json").read_text()) for name in ("1x1", "2x1"))
    assert one["state_hash"] == two["state_hash"]
    assert len(one["repeats"]) == 2 and len(two["affinity"]) == 2
    assert one["messages_per_step"] == [0, 0, 0] and two["messages_per_step"] == [2, 2, 2]
    assert 0 <= two["hidden_share"] <= 1
    command(sys.executable, ROOT / "bench/scaling", "plot", tmp_path, "--out", tmp_path / "picture")
    assert (tmp_path / "picture.png").stat().st_size > 10_000


def test_efficiency_is_written(tmp_path):
    command(sys.executable, ROOT / "bench/studies/efficiency", "--quick", "--rounds", 3, "--build", BUILD, "--json", tmp_path / "e.json")
    record = json.loads((tmp_path / "e.json").read_text())
    assert {(s["form"], s["layout"]) for s in record["steps"]} == {(f, k) for f in ("variational", "incomplete")
                                                                   for k in ("threads", "ranks")}
    assert all(len(q["samples_s"]) == 3 and min(q["samples_s"]) > 0 for q in record["quantities"])
    times = [q["samples_s"] for q in record["quantities"]]
    limit = [min(t1 / t2, p1 / p2) for t1, t2, p1, p2 in zip(*times[:4])]
    shares = [one / all_cores / most for one, all_cores, most in zip(times[4], times[6], limit)]  # variational, ranks
    stated = next(s for s in record["steps"] if (s["form"], s["layout"]) == ("variational", "ranks"))
    assert stated["of_limit"] == pytest.approx(statistics.median(shares), rel=1e-3)


@pytest.mark.skipif(shutil.which("smpirun") is None, reason="SimGrid is not installed (libsimgrid-dev)")
def test_model_follows_simulation(tmp_path):
    row = {"first": 2e-7, "second": 1e-7, "pack_s": 1e-5, "faces": 200, "rest_s": 1e-5}
    rows = [{**row, "tets": tets, "step_s": tets * 3e-7} for tets in (10_000, 200_000)]
    costs = {"alone": rows, "busy": rows, "alone_checks": [], "busy_checks": []}
    (tmp_path / "costs.json").write_text(json.dumps(costs))
    command(sys.executable, ROOT / "perf/simulate", "run", "--costs", tmp_path / "costs.json", "--json", tmp_path / "r.json", "--build", BUILD,
            "--study", "thesis mesh", "--most", 16, "--scratch", tmp_path)
    points = json.loads((tmp_path / "r.json").read_text())["points"]
    simulated = [p for p in points if "simulated_s" in p]
    assert {p["ranks"] for p in simulated} == {1, 2, 8, 16}
    for p in simulated:
        assert p["model"]["step_s"] == pytest.approx(p["simulated_s"], rel=0.1)
        assert p["simulated_s"] > 0.999 * p["ideal_s"]
