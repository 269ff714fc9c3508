"""What a run does when the world around it fails, and when it fails itself: a clear message, an exit status that is not
0, the last good checkpoint usable, no hang."""

import json
import math
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

import h5py
import pytest
import rhegma
from conftest import CASES, ENVIRONMENT, PROGRAM, ROOT, launch, overrides

FRAGMENTS = CASES / "fragments.yaml"
GROWING = {"time.end": 0.3e-6, "output.interval": 20, "output.energy_limit": 1e9, "output.fields": [],
           "checkpoint.steps": 40}


def start(*arguments, ranks=2):
    command = ["mpirun", "--bind-to", "none", "-n", str(ranks), str(PROGRAM)] if ranks > 1 else [str(PROGRAM)]
    return subprocess.Popen([*command, *map(str, arguments)], text=True, stderr=subprocess.PIPE,
                            env={**os.environ, **ENVIRONMENT, "OMP_NUM_THREADS": "1"})


def restart_ends_as(directory, reference):
    process = launch("run", "--restart", directory, "-q", ranks=2)
    assert process.returncode == 0, process.stderr
    summary = rhegma.summary(directory)
    assert summary["restarted_from_step"] > 0
    assert summary["state_hash"] == reference.summary["state_hash"]
    assert (directory / "energy.csv").read_bytes() == (reference.dir / "energy.csv").read_bytes()


def test_kills_at_random_instants():
    """The long version: tests/kill-restart."""
    process = subprocess.run([sys.executable, ROOT / "tests" / "kill-restart", "--kills", "6", "--seed", "3",
                              "--program", PROGRAM], capture_output=True, text=True, timeout=900)
    assert process.returncode == 0, process.stderr
    assert re.match("6 kills, .* all the same", process.stdout)


# ---- Disks ----


def limit_files(process, size):
    """No file of the program's ranks may be larger from now on (mpirun has files of its own)."""
    children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    for pid in [*map(int, children), process.pid]:
        if pathlib.Path(f"/proc/{pid}/comm").read_text().startswith("rhegma"):
            resource.prlimit(pid, resource.RLIMIT_FSIZE, (size, size))


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_checkpoint_that_finds_no_room(run, tmp_path, ranks):
    sets = {**GROWING, "time.end": 0.8e-6, "checkpoint.steps": 10}
    reference = run(FRAGMENTS, sets={**sets, "checkpoint.steps": 0})
    process = start("run", FRAGMENTS, "-q", "-o", tmp_path / "out", *overrides(sets), ranks=ranks)
    begin = time.monotonic()
    while not list(tmp_path.glob("out/checkpoints/step-*.h5")):
        assert process.poll() is None and time.monotonic() - begin < 120
        time.sleep(0.002)
    limit_files(process, 100000)  # no checkpoint is so small
    said = process.communicate(timeout=120)[1]
    assert process.returncode == 1
    assert re.search(r"^rhegma: .*/checkpoints/step-\d+.h5: cannot (write|close|create)", said, re.M), said
    left = sorted(path.name for path in (tmp_path / "out" / "checkpoints").iterdir())
    assert left and all(re.fullmatch(r"step-\d+.h5", name) for name in left)  # nothing half-written
    restart_ends_as(tmp_path / "out", reference)


@pytest.fixture
def small_disk(tmp_path):
    """A tmpfs of 1 MB; skips where it cannot be mounted."""
    place = tmp_path / "disk"
    place.mkdir()
    mount = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "none", str(place)], capture_output=True)
    if mount.returncode != 0:
        pytest.skip("no tmpfs can be mounted here")
    yield place
    subprocess.run(["umount", str(place)], check=True)


@pytest.mark.parametrize("ranks", [1, 2])
def test_full_disk(run, tmp_path, small_disk, ranks):
    reference = run(FRAGMENTS, sets=GROWING)
    sets = {**GROWING, "checkpoint.keep": 100}
    process = launch("run", FRAGMENTS, "-q", "-o", small_disk / "out", *overrides(sets), ranks=ranks)
    assert process.returncode == 1
    assert re.search(r"^rhegma: .*cannot .*\(the disk is full\)$", process.stderr, re.M), process.stderr
    assert list((small_disk / "out" / "checkpoints").glob("step-*.h5"))
    shutil.copytree(small_disk / "out", tmp_path / "out")
    restart_ends_as(tmp_path / "out", reference)


def test_mesh_file_that_finds_no_room(small_disk):
    process = launch("mesh", FRAGMENTS, "-o", small_disk / "box.h5", "--set", "mesh.cells=[20, 20, 20]")
    assert process.returncode == 1
    assert re.fullmatch(r"rhegma: .*box.h5: cannot write [a-z_ ]*: No space left on device\n", process.stderr), process.stderr
    assert list(small_disk.iterdir()) == []


@pytest.mark.parametrize("ranks", [1, 2])
def test_directory_in_which_another_run_is_at_work(tmp_path, ranks):
    out, sets = tmp_path / "out", {**GROWING, "time.end": 1e-3}
    process = start("run", FRAGMENTS, "-q", "-o", out, *overrides(sets), ranks=ranks)
    begin = time.monotonic()
    while not list(out.glob("checkpoints/step-*.h5")):
        assert process.poll() is None and time.monotonic() - begin < 120
        time.sleep(0.01)
    for words in ([FRAGMENTS, "-o", out], [FRAGMENTS, "-o", out, "--overwrite"], ["--restart", out]):
        other = launch("run", "-q", *words, ranks=ranks)
        assert other.returncode == 2 and other.stderr.count("rhegma: ") == 1
        assert f"{out}/energy.csv: another run is writing to it" in other.stderr
    process.send_signal(signal.SIGUSR2)
    process.communicate(timeout=120)
    assert process.returncode == 3
    step = max(out.glob("checkpoints/step-*.h5")).stem.removeprefix("step-")
    again = launch("run", "--restart", out, "-q", *overrides({"time.steps": int(step) + 10}), ranks=ranks)
    assert again.returncode == 0, again.stderr
    rows = [int(line.split(",")[0]) for line in (out / "energy.csv").read_text().splitlines()[1:]]
    assert rows == sorted(set(rows)) and rows[-1] == int(step) + 10


@pytest.mark.parametrize("sets", [{"output.fields": ["crack"], "checkpoint.steps": 0},
                                  {"output.interval": 100000, "output.fields": [], "checkpoint.steps": 50}])
def test_directory_that_vanishes(tmp_path, sets):
    out = tmp_path / "out"
    sets = {**GROWING, "time.end": 1e-3, **sets}
    process = start("run", FRAGMENTS, "-q", "-o", out, *overrides(sets))
    begin = time.monotonic()
    while not ((out / "fields.xdmf").exists() or list(out.glob("checkpoints/*.h5"))):
        assert process.poll() is None and time.monotonic() - begin < 120
        time.sleep(0.01)
    os.rename(out, tmp_path / "elsewhere")
    (tmp_path / "out").write_text("not a directory")
    said = process.communicate(timeout=120)[1]
    assert process.returncode == 1
    # whichever file is next names itself
    assert re.search(r"^rhegma: [^:]*/out\S*: cannot [a-z ]+: (Not a|No such file or) directory$", said, re.M), said


# ---- Autopsies ----


def autopsy(directory):
    return json.loads((directory / "autopsy.json").read_text())


def last_frame(directory):
    with h5py.File(directory / "fields.h5") as file:
        frame = file["frames"][max(file["frames"])]
        return frame.attrs["step"], {name: node[()] for name, node in frame.items() if isinstance(node, h5py.Dataset)}


def fail(tmp_path, sets, ranks, words):
    fields = {"output.fields": ["displacement"], "output.interval": 100000, "output.energy_limit": 1e300}
    process = launch("run", FRAGMENTS, "-q", "-o", tmp_path / "out", *overrides({**fields, **sets}), ranks=ranks)
    assert process.returncode == 1
    message = re.search(rf"^rhegma: stopped: (.*{words}.*)$", process.stderr, re.M)
    assert message, process.stderr
    found = autopsy(tmp_path / "out")
    assert found["reason"] in message[1] and f"at step {found['step']}, " in message[1]
    assert f"element {found['element']} at " in message[1]
    assert 0 < found["quality"] <= 1 and found["volume_m3"] > 0
    return found


PUSH = {"boundary": [{"set": "z+", "component": "z", "velocity": "t < 1e-8 ? 0 : -2e4"}]}


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_autopsy_of_an_element_inside_out(tmp_path, ranks):
    """The fields are those of the state that went wrong, not of the one behind it."""
    found = fail(tmp_path, {**PUSH, "time.collapse": 0}, ranks, "not finite")
    assert found["stiffening"] is None and found["z_m"] > 1.2e-3
    assert found["smallest_jacobian"] is not None and found["smallest_jacobian"] < 0.5
    step, fields = last_frame(tmp_path / "out")
    assert step == found["step"] > 1
    assert all(math.isfinite(v) for v in fields["displacement"].ravel())


@pytest.mark.parametrize("ranks", [1, 2])
def test_autopsy_of_a_time_step_that_collapses(tmp_path, ranks):
    found = fail(tmp_path, {**PUSH, "time.collapse": 0.5, "time.safety": 0.5}, ranks, r"time step collapsed: .*below 0.5 \(time.collapse\)")
    step, rest = map(float, re.search(r"collapsed: (\S+) s, below 0.5 .* of the (\S+) s at rest", found["reason"]).groups())
    assert 0 < step < 0.5 * rest
    assert found["step_limited_by"] == "the stiffening of the element"
    assert found["stiffening"] > 4 and 0 < found["smallest_jacobian"] < 0.7 and found["z_m"] > 1.2e-3
    assert last_frame(tmp_path / "out")[0] == found["step"]


@pytest.mark.parametrize("ranks, times", [(1, []), (2, []), (2, [2e-7])])
def test_autopsy_of_energy_out_of_balance(tmp_path, ranks, times):
    """The fields of that moment are there even where they are due at other times alone."""
    sets = {"output.energy_limit": 1e-9, "output.interval": 10, "output.times": times}
    found = fail(tmp_path, sets if times else {k: v for k, v in sets.items() if k != "output.times"}, ranks,
                 "passed the limit 1e-09")
    assert found["step_limited_by"] == "the spectrum at rest" and found["spectrum_faces"]
    assert last_frame(tmp_path / "out")[0] == found["step"]


# ---- Less output ----


def test_region_precision_and_compression(run):
    """The same numbers, fewer and shorter."""
    sets = {"time.end": 1e-7, "output.energy_limit": 1e9, "output.interval": 2e-8,
            "output.fields": ["displacement", "stress", "crack"]}
    full = run(FRAGMENTS, sets=sets)
    less = {"output.region": "abs(z) < 0.4e-3", "output.precision": "single", "output.compression": 4}
    for ranks in (1, 3):
        part = run(FRAGMENTS, ranks=ranks, sets={**sets, **less})
        assert part.summary["state_hash"] == full.summary["state_hash"]
        corners = full.points().reshape(-1, 10, 3)[:, :4]
        inside = abs(corners.mean(axis=1)[:, 2]) < 0.4e-3
        assert 0 < inside.sum() < len(inside) / 2
        for a, b in zip(full.frames(), part.frames()):
            assert (b["stress"] == a["stress"][inside].astype("float32")).all()
            wanted = a["displacement"].reshape(-1, 30)[inside].astype("float32")
            assert (b["displacement"].reshape(-1, 30) == wanted).all()
            assert len(b["crack/cells"]) <= len(a["crack/cells"])
        assert b["crack/points"].dtype == "float32"
    sizes = [sum(path.stat().st_size for path in (r.dir / "fields").iterdir()) for r in (full, part)]
    assert sizes[1] < sizes[0] / 4


@pytest.mark.parametrize("ranks", [1, 2])
def test_region_without_elements(tmp_path, ranks):
    process = launch("run", FRAGMENTS, "-q", "-o", tmp_path / "out", *overrides({"output.region": "z > 1"}), ranks=ranks)
    assert process.returncode == 2 and "output.region: z > 1: no element is in it" in process.stderr
