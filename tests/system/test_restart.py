"""A run that was stopped and goes on ends with the bits of one that never stopped; and what happens to checkpoints
that are damaged, or of another case."""

import itertools
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest
from conftest import CASES, ENVIRONMENT, EVERYWHERE, PROGRAM, SINGLE, Run, launch, overrides

FRAGMENTS = CASES / "fragments.yaml"
LAYOUTS = [(1, 2), (2, 1), (3, 1)]  # ranks, threads
CASE = {
    "mesh.cells": [2, 2, 24], "time.end": 0.2e-6, "output.interval": 1e-8,  # 9 elements to a tile: two blocks
    "output.energy_limit": 1e9,
    "output.fields": ["displacement", "velocity", "stress", "crack"],
    "output.probes": [{"name": "a", "at": [0.01e-3, 0.03e-3, 0.5e-3]}],
    "boundary": [{"set": "z+", "component": "z", "velocity": "1e8*t*(1 + 1e3*x)"},
                 {"set": "x-", "component": "x", "displacement": "1e6*t*y"}],
    "checkpoint.steps": 45,
}
STOP = 110  # steps: between two outputs and two checkpoints


def copy(run, directory):
    shutil.copytree(run.dir, directory)
    return directory


def checkpoints(directory):
    return sorted((directory / "checkpoints").glob("step-*.h5"))


def go_on(directory, *arguments, ranks=1, threads=1, expect=0, **environment):
    process = launch("run", "--restart", directory, "-q", *arguments, ranks=ranks, threads=threads, **environment)
    assert process.returncode == expect, process.stderr
    return Run(directory, process)


def gone_on_anywhere(run, case, sets, steps, directory):
    """Of a case of so many steps: stopped on two ranks before its end, without its last checkpoint, and gone on on three."""
    stopped = copy(run(case, ranks=2, sets={**sets, "time.steps": steps - 8}), directory)
    checkpoints(stopped)[-1].unlink()
    again = go_on(stopped, "--set", "time.steps=100000", ranks=3)
    assert 0 < again.summary["restarted_from_step"] < steps - 8
    return again


@pytest.fixture(scope="module")
def whole(run):
    """The run that nothing stopped."""
    return run(FRAGMENTS, sets=CASE)


@pytest.fixture(scope="module")
def stopped(run):
    """stopped(ranks, threads): a run that ended at a limit of steps; its newest checkpoint lies before its last outputs."""
    def make(ranks=1, threads=1):
        result = run(FRAGMENTS, ranks=ranks, threads=threads, sets={**CASE, "time.steps": STOP})
        last = result.dir / "checkpoints" / f"step-{STOP:012d}.h5"
        last.unlink(missing_ok=True)
        return result
    return make


def test_checkpoints_count_as_output(run):
    found = run(FRAGMENTS, sets={**CASE, "time.steps": 20, "checkpoint.steps": 1, "output.fields": []}).summary
    assert found["checkpoints"] >= 20 and 0 < found["checkpoint_s"] < found["output_s"] < found["wall_s"]


def crack_rows(frame):
    """The crack surface as rows in an order of their own: which rank wrote them decides their order in the file."""
    names = sorted(name for name in frame if name.startswith("crack/") and name not in ("crack/cells", "crack/points"))
    points = frame["crack/points"].reshape(-1, 9)
    rows = np.hstack([points, *(frame[name] for name in names)])
    return rows[np.lexsort(rows.T)]


# Of the layout, the speed of the machine, the name of the case file; all else in the summary, whatever is added, is physics.
OF_THE_RUN = {"case", "ranks", "threads", "partitions", "imbalance", "cost_imbalance", "cut_faces", "neighbours", "neighbours_max",
              "inner_share", "messages_per_step", "bytes_per_step", "bytes_per_message", "bytes_per_tet", "restarted_from_step",
              "setup_s", "wall_s", "output_s", "checkpoints", "checkpoint_s", "checkpoint_median_s", "halo_wait_s",
              "us_per_tet_step", "exchange_alone_s", "phases_s"}


def results(run):
    return {key: value for key, value in run.summary.items() if key not in OF_THE_RUN}


def tables(run):
    return {path.name: path.read_bytes() for path in [*run.dir.glob("*.csv"), *run.dir.glob("*.xdmf")]}


def assert_same_results(one, other, frames=18):
    """Every output, to the bit; more than so many frames."""
    assert results(one) == results(other)
    assert tables(one) == tables(other) and "energy.csv" in tables(one)
    assert (one.dir / "fields.h5").exists() == (other.dir / "fields.h5").exists() == (frames >= 0)
    for a, b in zip(one.frames(), other.frames(), strict=True) if frames >= 0 else []:
        assert a["time"] == b["time"] and a.keys() == b.keys()
        for name in a:
            if not name.startswith("crack") and name != "time":
                assert np.array_equal(a[name], b[name]), name
        assert "crack/points" not in a or np.array_equal(crack_rows(a), crack_rows(b))
    assert frames < 0 or len(one.frames()) > frames


@pytest.mark.parametrize("to", LAYOUTS)
@pytest.mark.parametrize("written", LAYOUTS)
def test_restart_on_any_layout(whole, stopped, tmp_path, written, to):
    before = stopped(*written)
    assert before.summary["broken_area_m2"] > 0 and before.summary["steps"] == STOP
    assert [path.name for path in checkpoints(before.dir)] == ["step-000000000090.h5"]
    again = go_on(copy(before, tmp_path / "out"), "--set", "time.steps=100000", ranks=to[0], threads=to[1])
    assert again.summary["restarted_from_step"] == 90
    assert_same_results(again, whole)


def test_restart_of_less_output_on_other_ranks(run, tmp_path):
    sets = {**CASE, "output": {**{key.split(".")[1]: value for key, value in CASE.items() if key.startswith("output.")},
                               "region": "abs(z) < 0.8e-3", "precision": "single", "compression": 4}}
    sets = {key: value for key, value in sets.items() if not key.startswith("output.")}
    stopped = run(FRAGMENTS, ranks=2, sets={**sets, "time.steps": STOP})
    (stopped.dir / "checkpoints" / f"step-{STOP:012d}.h5").unlink()
    again = go_on(copy(stopped, tmp_path / "out"), "--set", "time.steps=100000", ranks=3)
    assert again.summary["restarted_from_step"] == 90
    assert len(again.frames()[0]["displacement"]) < 10 * again.summary["elements"]
    assert_same_results(again, run(FRAGMENTS, sets=sets))


VARIANTS = {  # test_checkpoint.c has more, on one rank
    "incomplete": {"interface.form": "incomplete", "mass": "lumped"},
    "thesis": {"defaults": 0, "interface.activation": "total", "interface.contact": "flux"},
    "conserving": {"interface.activation": "conserving", "interface.criterion": "mohr-coulomb", "interface.friction": 0.4, "interface.law": "linear" if SINGLE else "rate",
                   "interface.rise": {"rate": 1e15, "exponent": 0.1, "most": 2}, "interface.sets": [{"where": "z > 0", "rise": 0.05}]},
    "intrinsic": {"interface.form": "intrinsic", "interface.law": "xu-needleman"},
    "viscosity": {"viscosity": {"linear": 0.06, "quadratic": 1.2}},
    **EVERYWHERE,
    "plain": {"output.fields": [], "output.probes": [], "boundary": []},
}
VARIANTS["hot"] = {"material.expansion": 2e-5, "temperature.value": "293 + 40*cos(pi*x/1e-3)*sin(2*pi*t/1e-7)"}
if not SINGLE:  # solids whose history grows, heats and relaxes; copper flows at the rate of the last step
    VARIANTS["flowing"] = {"interface.strength": 60e6, "material": {"preset": "copper-ofhc", "yield_stress": 120e6, "density": 3000},
                           "materials": [{"name": "glass", "where": "z > 5e-4", "preset": "float-glass-jh2", "density": 3000, "intact_strength": 0.05},
                                         {"name": "polymer", "where": "z < -5e-4", "preset": "pmma-viscoelastic", "young": 124e9, "density": 3000},
                                         {"name": "rock", "where": "z > 0 && z < 5e-4", "preset": "berea-sandstone", "young": 124e9, "density": 3000,
                                          "cohesion": 100e6, "cap_pressure": 150e6, "cap_ratio": 0.3},
                                         {"name": "concrete", "where": "z > -4e-4 && z < -1e-4", "preset": "concrete-hjc", "young": 124e9, "density": 3000,
                                          "compressive_strength": 150e6}]}


@pytest.mark.parametrize("variant", VARIANTS)
def test_restart_of_every_variant(run, tmp_path, variant):
    sets = {**CASE, **VARIANTS[variant]}
    one = run(FRAGMENTS, sets=sets)
    copied = copy(run(FRAGMENTS, ranks=2, sets={**sets, "time.steps": STOP}), tmp_path / "out")
    again = go_on(copied, "--set", "time.steps=100000", ranks=3)
    assert one.summary["broken_area_m2"] > 0
    assert_same_results(again, one, frames=18 if sets["output.fields"] else -1)


STATEFUL = {  # what has state of its own: bodies, free and prescribed; a material with a history; given times of output
    "bounce": {"time.end": 1.5e-6, "bodies": [
        {"name": "ball", "shape": "sphere", "motion": "free", "at": [0.1e-3, 0, 1e-3], "radius": 1e-3, "density": 8000, "velocity": {"z": -20}},
        {"name": "rod", "shape": "cylinder", "motion": "free", "at": [0.3e-3, 0, -3e-3], "axis": [1, 0, 0.1], "radius": 1e-3, "density": 8000,
         "length": 3e-3, "spin": {"x": 1e4, "y": 2e3}, "tied": ["z-"], "tied_until": 1.2e-6, "faces": ["y-"]}]},
    "push": {"output.times": [0.4e-7, 1.1e-7], "output.fields": ["displacement"]},
    "ceramic": {"time.end": 4.5e-8, "output.interval": 2e-9, "output.fields": ["damage"]},
}


@pytest.mark.parametrize("case", STATEFUL)
def test_restart_of_bodies_and_materials(run, tmp_path, case):
    sets = {**STATEFUL[case], "checkpoint.steps": 20, "checkpoint.keep": 100}
    one = run(CASES / f"{case}.yaml", sets=sets)
    steps = one.summary["steps"]
    assert steps > 45
    before = run(CASES / f"{case}.yaml", sets={**sets, "time.steps": steps - 5})
    directory = copy(before, tmp_path / "out")
    for path in checkpoints(directory):
        if int(path.stem[5:]) > steps // 2:
            path.unlink()
    again = go_on(directory, "--set", "time.steps=100000", ranks=2)
    assert 0 < again.summary["restarted_from_step"] <= steps // 2
    assert_same_results(again, one, frames=1 if STATEFUL[case].get("output.fields") else -1)


@pytest.fixture(scope="module")
def grains(scratch):
    """1,296 tetrahedra, eight grains, a surface inside and one by its nodes; tiles have two blocks."""
    n, step = 6, (1, 7, 49)
    corner = [i + 7 * j + 49 * k for k, j, i in itertools.product(range(n), repeat=3)]
    paths = [(0, step[a], step[a] + step[b], 57) for a, b in itertools.permutations(range(3), 2)]
    text = "*NODE\n" + "".join(f"{1 + i + 7 * j + 49 * k}, {i / n}, {j / n}, {k / n}\n" for k, j, i in itertools.product(range(n + 1), repeat=3))
    for g, (z, y, x) in enumerate(itertools.product((0, 1), repeat=3)):
        text += f'*ELEMENT, TYPE=C3D4, ELSET="Korn {g}"\n'
        for c, (k, j, i) in enumerate(itertools.product(range(n), repeat=3)):
            if (k // 3, j // 3, i // 3) == (z, y, x):
                text += "".join(f"{1 + 6 * c + t}, " + ", ".join(str(1 + corner[c] + p) for p in path) + "\n" for t, path in enumerate(paths))
    # of the cubes below the plane z = 1/3 the faces that lie in it: S3 of the two paths that begin along z
    text += "*SURFACE, NAME=weak\n" + "".join(f"{1 + 6 * c + t}, S3\n" for c in range(n * n, 2 * n * n) for t in (4, 5))
    text += "*NSET, NSET=top, GENERATE\n295, 343\n*NSET, NSET=bottom, GENERATE\n1, 49\n*NSET, NSET=plane, GENERATE\n197, 245\n"
    (scratch / "grains.inp").write_text(text)
    process = launch("mesh", scratch / "grains.inp", "-o", scratch / "grains.h5", "--unit", "mm")
    assert process.returncode == 0, process.stderr
    said = launch("mesh", "--info", scratch / "grains.h5").stdout
    assert all(f"{name}: 0 faces, and 72 between elements\n" in said for name in ("weak", "plane"))
    return scratch / "grains.h5"


def test_sets_inside_on_any_layout_and_restart(run, grains, tmp_path):
    """A weak surface inside and boundaries of all grains, pulled by sets of nodes."""
    law = {"law": "linear", "strength": 400e6, "energy": 34, "sets": [
        {"set": "weak", "strength": 100e6}, {"set": "plane", "strength": 150e6}, {"between": "any", "strength": 200e6, "energy": 10}]}
    case = tmp_path / "grains.yaml"
    case.write_text(json.dumps({
        "mesh": {"file": str(grains)}, "material": {"model": "neo-hookean", "young": 260e9, "poisson": 0.21, "density": 3690},
        "interface": law, "initial": {"velocity": {"z": "4e4*(z - 5e-4)"}},
        "boundary": [{"set": "top", "component": "z", "velocity": 20}, {"set": "bottom", "component": "z", "velocity": "-20"}],
        "time": {"end": 6e-8}, "output": {"interval": 1.2e-8, "fields": ["crack"]}, "checkpoint": {"steps": 20}}))
    one = run(case)
    steps = one.summary["steps"]
    assert one.summary["broken_area_m2"] > 1e-6 and steps > 25, (one.summary["broken_area_m2"], steps)
    for ranks, threads in LAYOUTS:
        other = run(case, ranks=ranks, threads=threads)
        assert other.summary["state_hash"] == one.summary["state_hash"] and tables(other) == tables(one)
    stopped = copy(run(case, ranks=2, sets={"time.steps": steps - 8}), tmp_path / "out")
    checkpoints(stopped)[-1].unlink()
    again = go_on(stopped, "--set", "time.steps=100000", ranks=3)
    assert 0 < again.summary["restarted_from_step"] < steps - 8
    assert_same_results(again, one, frames=4)


# All that acts from outside and is measured at once; tiles of four blocks. Static starts: test_static.py.
AT_ONCE = {
    **EVERYWHERE["loads"], "mesh": {"cells": [4, 4, 24], "size": [0.4e-3, 0.4e-3, 3.2e-3], "origin": [-0.2e-3, -0.2e-3, -1.6e-3]}, "time.end": 0.1e-6,
    "materials": [{"name": "soft", "where": "z > 0.8e-3", "model": "neo-hookean", "density": 2500, "young": 70e9, "poisson": 0.3}],
    "bodies": [{"name": "ball", "shape": "sphere", "motion": "free", "at": [-1.2e-3, 0, -0.9e-3], "radius": 1e-3, "density": 8000, "velocity": {"x": 30}, "spin": {"y": 1e4}},
               {"name": "rider", "shape": "none", "motion": "free", "at": [0.4e-3, 0.1e-3, 0.3e-3], "mass": 1e-7, "inertia": [1e-15, 1.2e-15, 1.5e-15, 0, 0, 1e-16], "velocity": {"y": 20},
                "spin": {"z": 2e4}, "tied_where": "nx > 0.5 && abs(z - 0.3e-3) < 1.2e-4", "tied_from": 3e-8}],
    "output.fields": [], "output.interval": 1e-8, "output.energy_limit": 1e9, "checkpoint.steps": 20, "checkpoint.keep": 100,
    "output.probes": [{"name": "a", "at": [0.01e-3, 0.03e-3, 0.5e-3], "strain": True}],
    "output.crack_fronts": [{"name": name, "at": [0, 0, 0], "direction": [-1, 0, 0], "normal": [0, 0, 1], "radius": {"inner": 4e-5, "outer": 1.5e-4}, "values": ["KI", "KII", "KIII"],
                             **more} for name, more in (("still", {}), ("front", {"tip": "left"}))],
}


def test_everything_at_once_on_any_layout_and_through_a_restart(run, tmp_path):
    """Loads from a table, supports with a begin and an end, cracks that are there and one that opens, sensors, tips, fronts."""
    one = run(FRAGMENTS, sets=AT_ONCE)
    steps, history = one.summary["steps"], one.history
    assert one.summary["broken_area_m2"] > 0 and steps > 80
    for name in ("pull_work", "gas_work", "bed_work", "fall_work", "hold_work", "roll_work", "catch_work", "ball_fx", "rider_vx", "rider_wx", "end_szz_max", "left_tip", "front_KI", "still_KI", "a_exy"):
        assert np.any(history[name] != 0) and np.ptp(history[name][np.isfinite(history[name])]) > 0, name
    for ranks, threads in ((1, 2), (5, 1)):
        assert_same_results(run(FRAGMENTS, ranks=ranks, threads=threads, sets=AT_ONCE), one, frames=-1)
    before = run(FRAGMENTS, ranks=2, sets={**AT_ONCE, "time.steps": steps - 5})
    assert tables(one)["history.csv"].startswith(tables(before)["history.csv"])
    directory = copy(before, tmp_path / "out")
    for path in checkpoints(directory):
        if int(path.stem[5:]) > steps // 2:
            path.unlink()
    again = go_on(directory, "--set", "time.steps=100000", ranks=3)
    assert 0 < again.summary["restarted_from_step"] <= steps // 2
    assert_same_results(again, one, frames=-1)


def test_a_finished_run_can_be_made_longer(run, whole, tmp_path):
    """From a checkpoint before the last step, which was cut to end on time: a longer run does not come through its state."""
    short = run(FRAGMENTS, sets={**CASE, "time.end": 0.15e-6})
    steps = short.summary["steps"]
    assert short.summary["dt_last"] < 0.9 * short.summary["dt_first"]
    assert [int(path.stem[5:]) for path in checkpoints(short.dir)] == [90, steps - 1]
    again = go_on(copy(short, tmp_path / "out"), "--set", f"time.end={CASE['time.end']}", ranks=2)
    assert again.summary["restarted_from_step"] == steps - 1
    assert_same_results(again, whole)
    same = go_on(copy(short, tmp_path / "same"))
    assert_same_results(same, short, frames=10)


def test_nothing_is_left_to_compute(stopped, tmp_path):
    ended = stopped()
    again = go_on(copy(ended, tmp_path / "out"), "--set", "time.steps=80", ranks=2)
    assert re.search(r"warning: nothing is left to compute: the checkpoint is of step 90, time 1.3\d*e-07 s", again.stderr)
    assert again.summary["steps"] == 90


@pytest.mark.parametrize("before", [1e-8, 7])
def test_outputs_of_another_interval(run, tmp_path, before):
    """Come at the moments at which they would have come all along, also that of the checkpoint itself."""
    short = {**CASE, "time.end": 2.5e-8, "output.fields": ["displacement"], "checkpoint.steps": 1, "checkpoint.keep": 1000}
    wanted = run(FRAGMENTS, sets={**short, "output.interval": 3e-9})
    steps, times = wanted.energy["step"], [frame["time"] for frame in wanted.frames()]
    assert len(steps) == len(times) == 10  # that of t = 0 included
    for step in (steps[5] - 1, steps[5], steps[5] + 1):
        directory = copy(run(FRAGMENTS, sets={**short, "output.interval": before}), tmp_path / f"{step:.0f}")
        for path in checkpoints(directory):
            if int(path.stem[5:]) > step:
                path.unlink()
        again = go_on(directory, "--set", "output.interval=3e-9")
        assert again.summary["restarted_from_step"] == step
        late = again.energy["step"] >= step
        assert list(again.energy["step"][late]) == list(steps[steps >= step])
        assert [frame["time"] for frame in again.frames()][-late.sum():] == times[-late.sum():]
        assert (directory / "history.csv").read_bytes() == (wanted.dir / "history.csv").read_bytes()


def test_checkpoints_do_not_depend_on_the_layout(stopped):
    """But for the speed of the machine, which the estimate of the next run starts from."""
    def content(directory):
        values = {}
        with h5py.File(checkpoints(directory)[-1]) as file:
            file.visititems(lambda name, node: values.update({name: node[()].tobytes()})
                            if isinstance(node, h5py.Dataset) else None)
        return {name: value for name, value in values.items() if name != "run/core_seconds"}

    one, *others = [content(stopped(*layout).dir) for layout in LAYOUTS]
    assert len(one["face/crack"]) > 0 and len(one) > 20
    for other in others:
        assert other == one


def test_only_the_last_checkpoints_stay(run):
    sets = {**CASE, "output.fields": [], "checkpoint.steps": 20, "checkpoint.keep": 3, "time.steps": 110}
    assert [int(path.stem[5:]) for path in checkpoints(run(FRAGMENTS, sets=sets).dir)] == [80, 100, 110]


def test_checkpoints_by_simulated_time(run):
    sets = {**CASE, "output.fields": [], "checkpoint.steps": 0, "checkpoint.time": 2e-8, "checkpoint.keep": 100}
    result = run(FRAGMENTS, sets=sets)
    found = []
    for path in checkpoints(result.dir):
        with h5py.File(path) as file:
            found.append(file["run/time"][0, 0])
    assert len(found) == 10  # every 2e-8 s, and the end
    for k, t in enumerate(found[:-1], start=1):
        assert 0 <= t - 2e-8 * k + 1e-13 < 2e-9
    assert 0 < 0.2e-6 - found[-1] < 2e-9  # before the last step, which is cut


def test_checkpoints_by_wall_time(run):
    sets = {**CASE, "output.fields": [], "checkpoint.steps": 0, "checkpoint.wall_time": 1e-9, "checkpoint.keep": 100}
    assert len(checkpoints(run(FRAGMENTS, sets={**sets, "time.steps": 40}).dir)) >= 38


# ---- Signals and limits ----


class Background:
    """A run that goes on beside the test. `step()` waits for its next line of energy.csv."""

    def __init__(self, directory, sets, *arguments, ranks=2, **environment):
        mpirun = ["mpirun", "--bind-to", "none", "-n", str(ranks)] if ranks > 1 else []
        self.dir = directory
        self.process = subprocess.Popen(
            [*mpirun, str(PROGRAM), "run", str(FRAGMENTS), "-q", "-o", str(directory), *overrides(sets), *arguments],
            env={**os.environ, **ENVIRONMENT, "OMP_NUM_THREADS": "1", **environment}, stderr=subprocess.PIPE, text=True)

    def wait_for(self, lines):
        """Until so many outputs are there."""
        begin = time.monotonic()
        while not (self.dir / "energy.csv").exists() or (self.dir / "energy.csv").read_text().count("\n") <= lines:
            assert self.process.poll() is None, self.process.stderr.read()
            assert time.monotonic() - begin < 120
            time.sleep(0.01)

    def ranks(self):
        """Process numbers of the program itself."""
        children = pathlib.Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text().split()
        return [int(pid) for pid in children
                if pathlib.Path(f"/proc/{pid}/comm").read_text().startswith("rhegma")] or [self.process.pid]

    def end(self):
        error = self.process.communicate(timeout=120)[1]
        return self.process.returncode, error


LONG = {**CASE, "time.end": 2e-6, "output.interval": 10, "output.fields": ["crack"], "checkpoint.steps": 0}
WHOLE = {"initial": {"velocity": {"x": 0, "y": 0, "z": 1}}, "boundary": []}  # does not break: can go on for ever


@pytest.fixture(scope="module")
def long_run(run):
    return run(FRAGMENTS, sets={**LONG, "time.steps": 400})


def finish(directory, long_run):
    again = go_on(directory, "--set", "time.steps=400", ranks=2)
    assert again.summary["state_hash"] == long_run.summary["state_hash"]
    for name in ("energy.csv", "history.csv"):
        assert (directory / name).read_bytes() == (long_run.dir / name).read_bytes()


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("name", ["SIGTERM", "SIGINT", "SIGUSR2"])
def test_signals_that_stop(tmp_path, long_run, name, ranks):
    """To one rank, whichever."""
    background = Background(tmp_path / "out", LONG, ranks=ranks)
    background.wait_for(3)
    os.kill(background.ranks()[-1], getattr(signal, name))
    status, said = background.end()
    assert status == 3, said
    assert re.search(r"stopped with a checkpoint at step \d+, .*by a signal; goes on with: rhegma run --restart", said)
    assert len(checkpoints(tmp_path / "out")) == 1
    left = json.loads((tmp_path / "out" / "summary.json").read_text())
    step, = re.findall(r"checkpoint at step (\d+),", said)
    assert left["status"] == "stopped by a signal" and left["steps"] == int(step) and left["elements"] > 0
    if name == "SIGTERM":
        finish(tmp_path / "out", long_run)


@pytest.mark.parametrize("before, expect", [(signal.SIG_DFL, 3), (signal.SIG_IGN, 0)])
def test_a_terminal_that_goes_away(tmp_path, before, expect):
    """Stops a run with a checkpoint, but not under nohup. Shell and system both send the signal."""
    kept = signal.signal(signal.SIGHUP, before)
    try:
        background = Background(tmp_path / "out", {**LONG, "time.steps": 400}, ranks=1)
    finally:
        signal.signal(signal.SIGHUP, kept)
    background.wait_for(3)
    for _ in range(2):
        os.kill(background.process.pid, signal.SIGHUP)
    status, said = background.end()
    assert status == expect, said
    assert len(checkpoints(tmp_path / "out")) == (expect == 3)


def test_sigusr1_writes_a_checkpoint_and_goes_on(tmp_path, long_run):
    background = Background(tmp_path / "out", {**LONG, "time.steps": 400}, ranks=2)
    background.wait_for(3)
    os.kill(background.process.pid, signal.SIGUSR1)  # mpirun passes it on
    status, said = background.end()
    assert status == 0, said
    assert len(checkpoints(tmp_path / "out")) in (1, 2)
    assert Run(tmp_path / "out", subprocess.CompletedProcess([], 0)).summary["state_hash"] == \
        long_run.summary["state_hash"]


@pytest.mark.parametrize("way", ["option", "slurm"])
def test_wall_time_limit(tmp_path, long_run, way):
    arguments = ["--walltime", "0:00:04"] if way == "option" else []
    environment = {"SLURM_JOB_END_TIME": str(int(time.time()) + 5)} if way == "slurm" else {}
    begin = time.monotonic()
    background = Background(tmp_path / "out", {**LONG, **WHOLE, "time.end": 1e-3, "output.interval": 5000}, *arguments, ranks=2,
                            **environment)
    status, said = background.end()
    assert status == 3, said
    assert "before the wall-time limit" in said
    assert time.monotonic() - begin < 60 and len(checkpoints(tmp_path / "out")) == 1


def test_wall_time_that_leaves_none_for_steps(tmp_path):
    """A job that queues itself again on status 3 would do so for ever."""
    process = launch("run", FRAGMENTS, "-q", "-o", tmp_path / "out", "--walltime", "0:00:01", *overrides(LONG))
    assert process.returncode == 3
    assert re.search(r"warning: the wall-time limit of 1 s leaves no time for steps: set-up took \d+ s", process.stderr)


@pytest.mark.parametrize("text", ["90", "1:60:00", "0:00:00", "-1:00:00", "1:00:00x", ""])
def test_wall_time_that_is_none(text):
    process = launch("run", FRAGMENTS, "--walltime", text)
    assert process.returncode == 2 and "--walltime takes H:M:S" in process.stderr


@pytest.mark.parametrize("which", [0, 1])
def test_a_lost_rank_ends_the_run(tmp_path, which):
    background = Background(tmp_path / "out", LONG, ranks=2)
    background.wait_for(3)
    os.kill(background.ranks()[which], signal.SIGKILL)
    status, said = background.end()
    assert status not in (0, 3)


# ---- Damage ----


def flip(path, position, bit):
    data = bytearray(path.read_bytes())
    data[position] ^= 1 << bit
    path.write_bytes(data)


def test_the_checkpoint_before_a_damaged_one_is_taken(whole, run, tmp_path):
    directory = copy(run(FRAGMENTS, sets={**CASE, "time.steps": STOP, "checkpoint.steps": 40}), tmp_path / "out")
    names = [path.name for path in checkpoints(directory)]
    assert names == ["step-000000000080.h5", f"step-{STOP:012d}.h5"]
    flip(directory / "checkpoints" / names[1], 100000, 3)
    again = go_on(directory, "--set", "time.steps=100000", ranks=2)
    assert re.search(f"warning: .*{names[1]}: its checksum is wrong: it is damaged", again.stderr)
    assert_same_results(again, whole)
    assert (directory / "checkpoints" / f"{names[1]}.damaged").exists()


@pytest.fixture(scope="module")
def victim(stopped, scratch):
    """A stopped run to be damaged, and the bytes of its one checkpoint."""
    directory = copy(stopped(), scratch / "victim")
    return directory, checkpoints(directory)[0], checkpoints(directory)[0].read_bytes()


def refused(directory, ranks=1):
    """What the run says that does not start from this checkpoint; nothing else may change."""
    before = {path: path.read_bytes() for path in directory.rglob("*") if path.is_file()}
    process = launch("run", "--restart", directory, "-q", "--set", "time.steps=100000", ranks=ranks)
    assert process.returncode == 2, process.stderr
    assert {path: path.read_bytes() for path in directory.rglob("*") if path.is_file()} == before
    return process.stderr


def test_flipped_bits_are_found(victim):
    directory, path, good = victim
    for position in [20, 300, 600, len(good) // 2, len(good) - 1]:  # tests/unit/restart/test_checksum.c tries thousands
        path.write_bytes(good)
        flip(path, position, position % 8)
        said = refused(directory)
        assert "all are damaged" in said, position
    path.write_bytes(good)


@pytest.mark.parametrize("ranks", [1, 3])
@pytest.mark.parametrize("size", [0, 100, 512, 5000, -1])
def test_truncated_checkpoint(victim, size, ranks):
    directory, path, good = victim
    path.write_bytes(good[:size])
    said = refused(directory, ranks)
    assert re.search(r"step-000000000090.h5: (its head|it has \d+ bytes and should have)", said), said
    path.write_bytes(good)


@pytest.mark.parametrize("ranks", [1, 2])
def test_no_checkpoint(victim, ranks):
    directory, path, good = victim
    path.unlink()
    assert "checkpoints: no checkpoint to restart from\n" in refused(directory, ranks)
    path.parent.rename(directory / "elsewhere")
    said = refused(directory, ranks)
    (directory / "elsewhere").rename(path.parent)
    path.write_bytes(good)
    assert "checkpoints: no checkpoint to restart from: No such file or directory\n" in said


@pytest.mark.parametrize("name, words", [("energy.csv", "energy.csv: cannot go on with it: it has 10 bytes"),
                                         ("history.csv", "history.csv: cannot go on with it: it has 10 bytes")])
def test_outputs_that_were_cut(stopped, tmp_path, name, words):
    directory = copy(stopped(), tmp_path / "out")
    (directory / name).write_bytes(b"time,a_ux,")
    process = launch("run", "--restart", directory, "-q")
    assert process.returncode == 2 and words in process.stderr


def test_outputs_that_vanished(stopped, tmp_path):
    directory = copy(stopped(), tmp_path / "out")
    (directory / "fields" / "000003.h5").unlink()
    process = launch("run", "--restart", directory, "-q", ranks=2)
    assert process.returncode == 1 and "fields/000003.h5: No such file or directory" in process.stderr


# ---- Another case ----


CHANGES = [
    ({"interface.strength": 300e6}, "interface.strength: 300000000; in the checkpoint: 400000000"),
    ({"mass": "lumped"}, "mass: lumped; in the checkpoint: consistent"),
    ({"boundary": [CASE["boundary"][0]]}, r"boundary\[1\].component: not given; in the checkpoint: x"),
    ({"output.probes": []}, r"output.probes\[0\].name: not given"),
    ({"output.fragments": "none"}, "most of output, but not\n  output.fragments: none; in the checkpoint: each"),
    ({"mesh.cells": [2, 2, 15]}, "a checkpoint of 576 elements; the mesh of the case has 360"),
    ({"mesh.seed": 9}, "a checkpoint on another mesh"),
]


@pytest.mark.parametrize("sets, words", CHANGES)
def test_changed_physics_is_refused(victim, sets, words):
    directory = victim[0]
    before = sorted(path.name for path in directory.rglob("*"))
    process = launch("run", "--restart", directory, *overrides(sets), ranks=2)
    assert process.returncode == 2
    assert re.search(words, process.stderr), process.stderr
    assert sorted(path.name for path in directory.rglob("*")) == before


@pytest.mark.skipif(SINGLE, reason="one program is enough")
def test_what_may_change(stopped, whole, tmp_path):
    directory = copy(stopped(), tmp_path / "out")
    sets = {"time.steps": 100000, "output.interval": 3e-8, "checkpoint": {"steps": 0, "keep": 1},
            "output.fields": ["crack"], "output.energy_limit": 1e8}
    again = go_on(directory, *overrides(sets))
    assert again.summary["state_hash"] == whole.summary["state_hash"]
    assert (directory / "history.csv").read_bytes() == (whole.dir / "history.csv").read_bytes()
    assert len(again.energy) < len(whole.energy)


def test_an_unfinished_run_is_not_overwritten(victim, tmp_path):
    directory = tmp_path / "out"
    shutil.copytree(victim[0], directory)
    (directory / "summary.json").unlink()
    process = launch("run", directory / "case.yaml", "-q", "-o", directory)
    assert process.returncode == 2
    assert re.search("holds checkpoints of a run that did not end: --restart .*--overwrite", process.stderr)
    process = launch("run", directory / "case.yaml", "-q", "-o", directory, "--overwrite", "--set", "time.steps=5")
    assert process.returncode == 0, process.stderr
    assert [int(path.stem[5:]) for path in checkpoints(directory)] == [5]
