"""Partitions in mesh files, and runs that read only their own part of one."""

import pathlib
import re
import shutil

import h5py
import numpy as np
import pytest
from conftest import CASES, launch, overrides
from test_meshes import convert, file_case

SETS = {"time.steps": 200, "output.fields": []}
WORD = 2**64 - 1


# ---- Editing mesh files ----


def mix(z):
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & WORD
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & WORD
    return z ^ (z >> 31)


def checksum(values):
    """As src/mesh/rows.h says."""
    total = 0
    for value in np.asarray(values).ravel().astype(np.int64).view(np.uint64):
        total = mix((total + 0x9E3779B97F4A7C15 + mix(int(value))) & WORD)
    return total


def store(file, name, values):
    """Replaces a dataset of integers, with its checksums: one for each tile, or one for all."""
    sums, rows = file["checksum"][name], file.attrs["tile_elements"]
    file[name][...] = values
    stretch = rows if len(sums) > 1 else len(values)
    sums[...] = [checksum(values[i:i + stretch]) for i in range(0, len(values), stretch)]


def edit(file, name, change):
    values = file[name][:]
    change(values)
    store(file, name, values)


def silly(path, ranks):
    """The partition for so many ranks becomes one that hands tiles out one to each in turn."""
    with h5py.File(path, "r+") as file:
        store(file, f"partition_{ranks}", np.arange(file.attrs["tiles"]) % ranks)


def quality(file, owner):
    """Imbalance, cut faces, most and mean neighbours, from the elements."""
    parts = owner.max() + 1
    owner = np.repeat(owner, file.attrs["tile_elements"])[:file.attrs["elements"]]
    neighbour = file["neighbour"][:]
    here, there = np.broadcast_to(owner[:, None], neighbour.shape)[neighbour >= 0], owner[neighbour[neighbour >= 0]]
    beside = np.zeros((parts, parts), bool)
    beside[here, there] = True
    beside[np.diag_indices(parts)] = False
    size = np.bincount(owner)
    return size.max() / size.mean(), (here != there).sum() // 2, beside.sum(axis=1).max(), beside.sum(axis=1).mean()


@pytest.fixture(scope="module")
def box(scratch):
    """A case on a mesh file of 1,296 elements, with partitions for 2 and 3 ranks."""
    folder = scratch / "partition"
    folder.mkdir()
    convert(CASES / "fragments.yaml", folder / "box.h5", "--set", "mesh.cells=[3, 3, 24]")
    process = launch("mesh", "--partition", "3,2", folder / "box.h5")
    assert process.returncode == 0, process.stderr
    return file_case(folder, folder / "box.h5")


@pytest.fixture
def copy(box, tmp_path):
    """A case on a copy of that file, which may be changed."""
    shutil.copy(box.parent / "box.h5", tmp_path)
    return pathlib.Path(shutil.copy(box, tmp_path))


# ---- rhegma mesh --partition ----


@pytest.mark.parametrize("ranks", [2, 3])
def test_quality_is_that_of_the_elements(box, ranks):
    said = launch("mesh", "--info", box.parent / "box.h5").stdout
    line = re.search(rf"^  {ranks} +imbalance ([\d.]+), (\d+) faces .*at most (\d+), mean ([\d.]+)$", said, re.M)
    with h5py.File(box.parent / "box.h5") as file:
        expected = quality(file, file[f"partition_{ranks}"][:])
    assert [float(word) for word in line.groups()] == pytest.approx(expected, abs=5e-3)
    assert expected[0] < 1.1


def test_partitions_are_added_and_replaced(copy):
    path = copy.with_name("box.h5")
    before = path.read_bytes()
    with h5py.File(path) as file:
        everything = {name: file[name][:] for name in file if name != "checksum"}
    silly(path, 2)
    process = launch("mesh", "--partition", "2,5", path)
    assert process.returncode == 0, process.stderr
    assert re.findall(r"^  (\d+) +imbalance", process.stdout, re.M) == ["2", "3", "5"]
    with h5py.File(path) as file:
        assert set(file) - {"checksum"} == {*everything, "partition_5"}
        for name in everything:
            assert (file[name][:] == everything[name]).all(), name
    assert launch("mesh", "--partition", "5", path).returncode == 0
    assert len(path.read_bytes()) < len(before) + 8192
    assert [entry.name for entry in path.parent.glob("*.part")] == []


def test_file_without_partitions_says_so(tmp_path):
    convert(CASES / "fragments.yaml", tmp_path / "bare.h5")
    assert "none stored" in launch("mesh", "--info", tmp_path / "bare.h5").stdout


@pytest.mark.parametrize("ranks", ["1", "0", "-2", "x", "2,", "2;3", "82", "99999999999", ""])
def test_numbers_of_ranks_that_are_refused(copy, ranks):
    path = copy.with_name("box.h5")
    before = path.read_bytes()
    process = launch("mesh", "--partition", ranks, path)
    assert process.returncode == 2 and process.stdout == ""
    assert f"--partition {ranks}: numbers of ranks, separated by commas, each from 2 to 81" in process.stderr
    assert path.read_bytes() == before


@pytest.mark.parametrize("options", [["--info"], ["-o", "out.h5"]])
def test_partition_stands_alone(box, options):
    process = launch("mesh", "--partition", "2", box.parent / "box.h5", *options)
    assert process.returncode == 2 and "--partition changes the file" in process.stderr


# ---- Runs ----


@pytest.mark.parametrize("ranks", [2, 3])
def test_silly_partition_gives_the_same_bits(run, box, copy, ranks):
    silly(copy.with_name("box.h5"), ranks)
    one, good, bad = run(box, sets=SETS), run(box, ranks=ranks, sets=SETS), run(copy, ranks=ranks, sets=SETS)
    with h5py.File(copy.with_name("box.h5")) as file:
        owner = np.arange(file.attrs["tiles"]) % ranks
        imbalance, cut, most, _ = quality(file, owner)
    assert bad.summary["cut_faces"] == cut > 3 * good.summary["cut_faces"]
    assert bad.summary["imbalance"] == pytest.approx(imbalance)
    assert bad.summary["neighbours_max"] == most == ranks - 1
    assert one.summary["broken_area_m2"] > 0
    for other in (good, bad):
        assert other.summary["state_hash"] == one.summary["state_hash"]
        assert (other.dir / "energy.csv").read_bytes() == (one.dir / "energy.csv").read_bytes()


def test_other_numbers_of_ranks_make_their_own_partition(run, box, copy):
    silly(copy.with_name("box.h5"), 2)
    one, other = run(box, ranks=3, sets=SETS), run(copy, ranks=3, sets=SETS)
    assert other.summary["cut_faces"] == one.summary["cut_faces"]
    alone = run(copy, sets=SETS).summary
    assert (alone["imbalance"], alone["cut_faces"], alone["neighbours_max"]) == (1, 0, 0)


@pytest.mark.parametrize("command", ["check", "run"])
def test_quality_is_told(box, tmp_path, command):
    said = launch(command, box, "-o", tmp_path, *overrides({**SETS, "time.steps": 1}), ranks=2).stdout
    assert re.search(r"^partition +imbalance 1.\d+, \d+ faces between ranks", said, re.M)
    said = launch("check", box).stdout
    assert "elements" in said and "partition" not in said


# ---- mesh.weight ----

HEAVY = "z > 0 ? 3 : 1"  # the middle of the cost is at a third of the upper half


def cost_imbalance(said):
    return float(re.search(r"imbalance 1\.\d+ \(([\d.]+) of the cost\)", said)[1])


def test_weights_of_a_box_and_of_a_file(box):
    """Costs are balanced, elements are not: the light part has 3 of 4 elements in the lower half and none above."""
    sets = overrides({"mesh.weight": HEAVY})
    file = launch("check", box, *sets, ranks=2).stdout
    memory = launch("check", CASES / "fragments.yaml", "--set", "mesh.cells=[3, 3, 24]", *sets, ranks=2).stdout
    lines = [re.search(r"^partition .*", said, re.M)[0] for said in (file, memory)]
    assert lines[0] == lines[1]
    assert cost_imbalance(file) < 1.05
    assert float(re.search(r"imbalance (\d.\d+)", file)[1]) == pytest.approx(4 / 3, abs=0.05)


def test_weights_do_not_change_results(run, box):
    one = run(box, sets=SETS)
    other = run(box, ranks=2, sets={**SETS, "mesh.weight": HEAVY})
    assert other.summary["imbalance"] > 1.2 and other.summary["cost_imbalance"] < 1.05
    assert other.summary["state_hash"] == one.summary["state_hash"]
    assert re.search(r"weight: .z > 0 \? 3 : 1.", (other.dir / "case.yaml").read_text())


@pytest.mark.parametrize("mesh", ["box", "file"])
@pytest.mark.parametrize("weight", [0, -1, "z", "1/(z - z)"])
def test_weight_that_is_refused(box, tmp_path, mesh, weight):
    case = box if mesh == "file" else CASES / "fragments.yaml"
    process = launch("run", case, "-q", "-o", tmp_path / "out", *overrides({"mesh.weight": weight}), ranks=2)
    assert process.returncode == 2 and not (tmp_path / "out").exists()
    assert process.stderr.count("rhegma: ") == 1
    assert f"mesh.weight: {weight} is " in process.stderr and "allowed: numbers > 0" in process.stderr


# ---- mesh.rebalance ----


def frames(run):
    with h5py.File(run.dir / "fields.h5") as file:
        return {name: (group.attrs["time"], group["displacement"][:].tobytes()) for name, group in file["frames"].items()}


@pytest.mark.parametrize("ranks, threads", [(2, 1), (3, 1), (2, 2)])
def test_a_run_goes_on_where_its_tiles_are_dealt_anew(run, box, ranks, threads):
    """Below 1 they are at every look, each 100 steps; the bar is about to break at the first and has broken at the last."""
    sets = {**SETS, "time.steps": 320, "time.end": 1e-6, "output.interval": 40, "output.fields": ["displacement"],
            "output.probes": [{"name": "a", "at": [0.01e-3, 0.03e-3, 0.5e-3]}]}
    one = run(box, sets=sets)
    other = run(box, ranks=ranks, threads=threads, sets={**sets, "mesh.rebalance": 0.5})
    assert one.summary["broken_area_m2"] > 0 and one.summary["partitions"] == 1
    assert other.summary["partitions"] == 4 and other.summary["restarted_from_step"] == 0
    assert other.summary["state_hash"] == one.summary["state_hash"]
    for name in ("energy.csv", "history.csv", "fragments.csv"):
        assert (other.dir / name).read_bytes() == (one.dir / name).read_bytes(), name
    assert frames(other) == frames(one)


@pytest.mark.parametrize("limit", [1.001, 100])
def test_tiles_stay_where_another_partition_would_not_pay(run, box, limit):
    """Too little is left to save, or the work is even enough."""
    other = run(box, ranks=2, sets={**SETS, "mesh.rebalance": limit})
    assert other.summary["steps"] > 100 and other.summary["partitions"] == 1 and other.summary["checkpoints"] == 0


# ---- Files that are wrong although their checksums are right ----


def refused(case, ranks, message):
    process = launch("run", case, "-q", "-o", case.with_name("out"), ranks=ranks)
    assert process.returncode == 2 and not case.with_name("out").exists()
    assert re.search("rhegma: .*box.h5: " + message, process.stderr), process.stderr


@pytest.mark.parametrize("ranks", [1, 2])
def test_element_with_a_corner_twice(copy, ranks):
    with h5py.File(copy.with_name("box.h5"), "r+") as file:
        def flatten(corner):
            corner[700, 3] = corner[700, 2]
        edit(file, "corner", flatten)
        original = file["original"][700]
    refused(copy, ranks, rf"element {original}: its corners must be four different vertices")


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("across", [False, True])
def test_neighbours_that_do_not_agree(copy, ranks, across):
    """On one rank, and on both sides of the boundary between two."""
    with h5py.File(copy.with_name("box.h5"), "r+") as file:
        owner = np.repeat(file["partition_2"][:], file.attrs["tile_elements"])[:1296]
        neighbour = file["neighbour"][:]
        cut = (neighbour >= 0) & ((owner[neighbour] != owner[:, None]) == across)
        e, f = np.argwhere(cut)[0]

        def turn(face):
            face[e, f] = (face[e, f] + 1) % 4
        edit(file, "face", turn)
    refused(copy, ranks, r"neighbour: elements \d+ and \d+ do not agree")


@pytest.mark.parametrize("ranks", [1, 2])
def test_rank_that_is_told_of_a_face_too_few(copy, ranks):
    with h5py.File(copy.with_name("box.h5"), "r+") as file:
        owner = np.repeat(file["partition_2"][:], file.attrs["tile_elements"])[:1296]
        neighbour = file["neighbour"][:]
        e, f = np.argwhere((neighbour >= 0) & (owner[neighbour] != owner[:, None]))[0]

        def cut(values):
            values[e, f] = -1
        edit(file, "neighbour", cut)
        edit(file, "face", cut)
        pair = sorted(file["original"][i] for i in (e, neighbour[e, f]))
    refused(copy, ranks, "neighbour: elements (%d and %d|%d and %d) do not agree" % (*pair, *pair[::-1]))


@pytest.mark.parametrize("ranks", [1, 2])
def test_graph_that_is_not_that_of_the_elements(copy, ranks):
    with h5py.File(copy.with_name("box.h5"), "r+") as file:
        def gather(owner):
            owner[:] = 0
            owner[-1] = 1
        edit(file, "partition_2", gather)

        def miss(neighbour):
            neighbour[neighbour == 80] = 0
        edit(file, "tile_neighbour", miss)
    refused(copy, ranks, r"tile_neighbour: not the neighbours of tile \d+")


def test_partition_that_leaves_a_rank_without_tiles(copy):
    with h5py.File(copy.with_name("box.h5"), "r+") as file:
        edit(file, "partition_2", lambda owner: owner.fill(1))
    refused(copy, 2, "partition_2: rank 0 has no tile")
