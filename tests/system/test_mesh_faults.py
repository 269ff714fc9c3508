"""Mesh files that somebody else wrote, whose checksums are right but whose mesh is not: every fault is refused when a run
reads the file, all faults at once and in the same words on any number of ranks, and names the elements."""

import itertools
import math
import os
import re

import h5py
import numpy as np
import pytest
from conftest import CASES, launch, overrides

MASK = 2**64 - 1
NAMES = ["corner", "neighbour", "face", "set", "region", "original", "vertex", "x"]  # with rows for each tile


def mix(z):
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    return z ^ (z >> 31)


def checksum(values):
    """src/mesh/rows.h"""
    values = np.asarray(values).ravel()
    words = values.view(np.uint64) if values.dtype.kind == "f" else values.astype(np.int64).view(np.uint64)
    total = 0
    for word in words.tolist():
        total = mix((total + 0x9E3779B97F4A7C15 + mix(word)) & MASK)
    return total


def links_of(tets):
    """Neighbours and their faces: the first two elements at a face take each other."""
    at = {}
    neighbour, face = np.full(tets.shape, -1), np.full(tets.shape, -1, np.int8)
    for e, f in itertools.product(range(len(tets)), range(4)):
        at.setdefault(tuple(sorted(np.delete(tets[e], f))), []).append((e, f))
    for (e, f), (o, g) in (pair[:2] for pair in at.values() if len(pair) > 1):
        neighbour[e, f], face[e, f], neighbour[o, g], face[o, g] = o, g, e, f
    return neighbour, face


def write(path, points, tets, cut=()):
    """A mesh file with one element to a tile; `cut`: pairs of elements that do not know of each other."""
    tets = np.sort(np.array(tets), axis=1)
    neighbour, face = links_of(tets)
    for a, b in [*cut, *((b, a) for a, b in cut)]:
        face[a][neighbour[a] == b] = -1
        neighbour[a][neighbour[a] == b] = -1
    points = np.array(points, float)
    beside = [np.unique(row[row >= 0]) for row in neighbour]
    data = {"corner": tets, "neighbour": neighbour, "face": face, "set": np.full(tets.shape, -1, np.int8),
            "region": np.full(len(tets), -1, np.int8), "original": np.arange(len(tets)) + 100, "vertex": tets.ravel(),
            "x": points[tets.ravel()], "vertex_start": 4 * np.arange(len(tets) + 1),
            "tile_start": np.cumsum([0] + [len(b) for b in beside]), "tile_neighbour": np.concatenate(beside).astype(int),
            "tile_faces": np.ones(sum(map(len, beside)), np.int32)}
    with h5py.File(path, "w", libver=("v108", "v108")) as file:
        counts = {"version": 1, "vertices": len(points), "elements": len(tets), "interfaces": (neighbour >= 0).sum() // 2,
                  "tile_elements": 1, "tiles": len(tets), "surface_sets": 0, "volume_sets": 0}
        for name, value in counts.items():
            file.attrs.create(name, value, dtype=np.int64)
        file.attrs.create("format", np.bytes_("rhegma mesh"))
        file.attrs["box"] = np.stack([points.min(axis=0), points.max(axis=0)])
        for name, values in data.items():
            file[name] = values
            blocks = np.split(values, len(tets)) if name in NAMES else [values]
            file["checksum/" + name] = np.array([checksum(block) for block in blocks], np.uint64)
    return path


A, B, C, UP, DOWN, FAR = (0, 0, 0), (1, 0, 0), (0, 1, 0), (0.2, 0.2, 1), (0.2, 0.3, -1), (0.1, 0.3, 2)
PAIR = [A, B, C, UP, DOWN]
TWO = [(0, 1, 2, 3), (0, 1, 2, 4)]
OWN = [(0, 1, 2, 3), (4, 5, 6, 7)]  # no vertex in common
NEAR = [(x + 1e-13, y, z) for x, y, z in (A, B, C)]
ASIDE = [(9, 9, 9), (10, 9, 9), (9, 10, 9), (9, 9, 10)]  # a sound element, so that there is one for each of three ranks
FAULTS = {
    "flat": ([A, B, C, UP, (0.2, 0.3, -1e-14)], TWO, (), ["element 101 at (0, 0, 0) m has no volume: "]),
    "open": (PAIR, TWO, [(0, 1)], ["elements 100 and 101 have a face at the same place, but are not neighbours: "]),
    "three": ([*PAIR, FAR], [*TWO, (0, 1, 2, 5)], (), ["elements 100, 101 and 102 share a face"]),
    "copies": ([*PAIR, A, B, C], OWN, (), ["elements 100 and 101 have a face at the same place, "]),
    "near": ([*PAIR, *NEAR], OWN, (), ["elements 100 and 101 have different vertices at the same place "] * 3),
    "hanging": ([A, B, C, UP, DOWN, (0.3, 0.3, 0), (0.5, 0.4, -1), (0.2, 0.6, -1)], OWN, (),
                ["a vertex of element 101 at (0.3, 0.3, 0) m lies on a face of element 100 "]),
}


def check(path, cwd, ranks=1):
    sets = {"mesh": {"file": str(path)}, "initial": {}, "boundary": []}
    return launch("check", CASES / "rotation.yaml", *overrides(sets), cwd=cwd, ranks=ranks)


def refused(path, cwd, ranks=(1, 3)):
    """What is said of the file: the very same, line by line, on so many ranks."""
    said = []
    for n in ranks:
        process = check(path, cwd, n)
        assert process.returncode == 2, process.stdout
        said.append([line for line in process.stderr.splitlines() if line.startswith("rhegma: ")])
    assert all(lines == said[0] for lines in said)
    assert all(line.startswith(f"rhegma: {path}: ") for line in said[0])
    return [line.removeprefix(f"rhegma: {path}: ") for line in said[0]]


def write_with_one_aside(path, points, tets, cut=()):
    return write(path, [*points, *ASIDE], [*tets, tuple(range(len(points), len(points) + 4))], cut)


def change(path, name, index, value):
    """A value, and the checksum of its tile with it."""
    with h5py.File(path, "r+") as file:
        rows = file[name][:]
        rows[index] = value
        file[name][...] = rows
        tile = index[0] // (4 if name in ("vertex", "x") else 1)
        step = len(rows) // len(file["checksum/" + name])
        file["checksum/" + name][tile] = checksum(rows[step * tile:step * (tile + 1)])


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_good_mesh_is_read(tmp_path, ranks):
    process = check(write_with_one_aside(tmp_path / "good.h5", PAIR, TWO), tmp_path, ranks)
    assert process.returncode == 0, process.stderr
    assert process.stdout.startswith("elements       3 ")


@pytest.mark.parametrize("fault", FAULTS)
def test_faulty_mesh_is_refused(tmp_path, fault):
    points, tets, cut, messages = FAULTS[fault]
    said = refused(write_with_one_aside(tmp_path / "faulty.h5", points, tets, cut), tmp_path, (1, 2, 3))
    assert len(said) == len(messages)
    assert all(line.startswith(message) for line, message in zip(said, messages)), said


def test_neighbours_that_see_their_face_at_two_places(tmp_path):
    path = write_with_one_aside(tmp_path / "moved.h5", PAIR, TWO)
    change(path, "x", (4,), (0.01, 0, 0))  # in the tile of element 1 alone, whose first corner is the face's
    assert refused(path, tmp_path) == ["neighbour: elements 100 and 101 do not agree that they share a face"]
    process = launch("mesh", "--info", path)
    assert process.returncode == 2 and process.stderr == f"rhegma: {path}: x: vertex 0 is at two places\n"


@pytest.mark.parametrize("name, value", [("neighbour", 2), ("neighbour", 1), ("face", 2)])
def test_neighbour_that_knows_nothing_of_it(tmp_path, name, value):
    """Element 1 takes element 2, itself, or another face of element 0 for what is across its face 3."""
    path = write_with_one_aside(tmp_path / "stranger.h5", PAIR, TWO)
    change(path, name, (1, 3), value)
    pairs = {("neighbour", 2): [(100, 101), (101, 102)], ("neighbour", 1): [(100, 101), (101, 101)]}
    assert refused(path, tmp_path) == [f"neighbour: elements {a} and {b} do not agree that they share a face"
                                       for a, b in pairs.get((name, value), [(100, 101)])]


def strip(count):
    """So many elements in a row, each of which shares a face with the next."""
    return [(0.3 * i, math.cos(2.0 * i), math.sin(2.0 * i)) for i in range(count + 3)], [range(i, i + 4) for i in range(count)]


def test_all_faults_of_all_ranks_are_told_at_once(tmp_path):
    path = write(tmp_path / "strip.h5", *strip(9))
    change(path, "set", (7, 0), 5)
    change(path, "neighbour", (2, 1), 99)
    change(path, "face", (2, 2), -2)
    change(path, "vertex", (19,), 8)
    with h5py.File(path, "r+") as file:
        file["x"][23, 0] += 1
        file["corner"][0, 3] += 1
        file["original"][0] = 7
    assert refused(path, tmp_path, (1, 2, 3)) == [
        "corner: the checksum of tile 0 is wrong; the file is damaged",
        "original: the checksum of tile 0 is wrong; the file is damaged",
        "neighbour: value 99 of element 102 is not between -1 and 8",
        "face: value -2 of element 102 is not between -1 and 3",
        "vertex: tile 4 does not list vertex 7 of element 104",
        "x: the checksum of tile 5 is wrong; the file is damaged",
        "set: value 5 of element 107 is not between -1 and -1"]


def test_faults_beyond_the_tenth_are_counted(tmp_path):
    path = write(tmp_path / "strip.h5", *strip(14))
    for e in range(1, 14):
        change(path, "face", (e, 1), 7)
    said = refused(path, tmp_path, (1, 2, 3))
    assert said == [*(f"face: value 7 of element {100 + e} is not between -1 and 3" for e in range(1, 11)), "and 3 more"]


def test_header_and_graph_that_are_not_those_of_the_elements(tmp_path):
    path = write(tmp_path / "strip.h5", *strip(5))
    with h5py.File(path, "r+") as file:
        file.attrs.modify("interfaces", np.int64(5))
        file.attrs["box"] = file.attrs["box"] * 1.01
        file["tile_faces"][0] = 2
        file["tile_neighbour"][2] = 3
        for name in ("tile_faces", "tile_neighbour"):
            file["checksum/" + name][0] = checksum(file[name][:])
    assert refused(path, tmp_path) == [
        "interfaces: 5, but the elements have 4", "box: is not that of the vertices",
        "tile_neighbour: not the neighbours of tile 0, or not as many faces",
        "tile_neighbour: not the neighbours of tile 1, or not as many faces"]


@pytest.mark.parametrize("end, axis", [(end, axis) for end in range(2) for axis in range(3)])
def test_a_box_with_one_wrong_side(tmp_path, end, axis):
    path = write(tmp_path / "strip.h5", *strip(5))
    with h5py.File(path, "r+") as file:
        box = file.attrs["box"]
        box[end][axis] += 1e-9
        file.attrs["box"] = box
    assert refused(path, tmp_path) == ["box: is not that of the vertices"]


def test_header_that_claims_more_than_memory(tmp_path):
    path = write(tmp_path / "strip.h5", *strip(5))
    with h5py.File(path, "r+") as file:
        listed = len(file["vertex"])
        file.attrs.modify("vertices", np.int64(1 << 40))
    assert refused(path, tmp_path) == [f"vertices: {1 << 40}, but the tiles list {listed}"]


def test_dataset_that_is_not_there(tmp_path):
    path = write(tmp_path / "strip.h5", *strip(5))
    with h5py.File(path, "r+") as file:
        del file["checksum/set"]
    said = refused(path, tmp_path)
    assert len(said) == 1 and said[0].startswith("checksum/set: cannot be read: ")


@pytest.mark.parametrize("words", [["--info", "folder.h5"], ["--partition", "2", "folder.h5"], ["folder.inp", "-o", "out.h5"]])
def test_directory_in_place_of_a_file(tmp_path, words):
    for name in ("folder.h5", "folder.inp"):
        (tmp_path / name).mkdir()
    process = launch("mesh", *words, cwd=tmp_path)
    assert process.returncode == 2 and not (tmp_path / "out.h5").exists()
    assert re.fullmatch(r"rhegma: folder.(h5|inp): cannot be read: Is a directory\n", process.stderr)


def test_what_is_not_a_file_is_not_replaced_by_one(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    process = launch("mesh", CASES / "rotation.yaml", "-o", "pipe", cwd=tmp_path)
    assert process.returncode == 1 and process.stderr == "rhegma: pipe: cannot be written: not a file\n"
    assert (tmp_path / "pipe").is_fifo() and len(list(tmp_path.iterdir())) == 1


def test_elements_that_share_no_face(tmp_path):
    """No tile has a neighbour then. The input begins with the mark of UTF-8 and has lines of Windows."""
    nodes = "\r\n".join(f"{n}, {x + 3 * (n > 4)}, {y}, {z}" for n, (x, y, z) in enumerate(2 * [A, B, C, UP], 1))
    text = f"*NODE\r\n{nodes}\r\n*ELEMENT, TYPE=C3D4\r\n1, 1, 2, 3, 4\r\n2, 5, 6, 7, 8\r\n"
    (tmp_path / "two.inp").write_bytes(b"\xef\xbb\xbf" + text.encode())
    path = tmp_path / "two.h5"
    assert "the mesh has 2 parts that share no face" in launch("mesh", tmp_path / "two.inp", "-o", path).stderr
    assert re.search(r"^parts +2 that share no face: 1 1 elements$", launch("mesh", "--info", path).stdout, re.M)
    process = check(path, tmp_path, ranks=2)
    assert process.returncode == 0 and "0 faces between ranks (0 % of all)" in process.stdout, process.stderr


def test_orientation_of_an_input_is_told_and_does_no_harm(tmp_path):
    source = tmp_path / "turned.inp"
    nodes = "\n".join(f"{n}, {x}, {y}, {z}" for n, (x, y, z) in enumerate(PAIR, 1))
    source.write_text(f"*NODE\n{nodes}\n*ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 4\n8, 1, 2, 3, 5\n")
    process = launch("mesh", source, "-o", tmp_path / "turned.h5")
    assert process.returncode == 0
    assert "1 of 2 elements have their corners in the order of a negative volume, the first of them 8" in process.stderr
    info = launch("mesh", "--info", tmp_path / "turned.h5").stdout
    assert re.search(r"aspect ratio .*\n(.* \d+\n){8}  worst [\d.]+: element \d \([78] in the input\)", info)
