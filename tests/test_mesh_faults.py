"""Mesh files that somebody else wrote, whose checksums are right but whose mesh is not: every fault is refused when a run
reads the file, on one rank and on two, and names the elements."""

import itertools
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
    """src/mesh_rows.h"""
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
NEAR = [(x + 1e-13, y, z) for x, y, z in (A, B, C)]
FAULTS = {
    "flat": ([A, B, C, UP, (0.2, 0.3, -1e-14)], TWO, (), "element 101 at .* has no volume"),
    "open": (PAIR, TWO, [(0, 1)], "elements 0 and 1 have a face at the same place, but are not neighbours"),
    "three": ([*PAIR, FAR], [*TWO, (0, 1, 2, 5)], (), "elements 0, 1 and 2 share a face"),
    "copies": ([*PAIR, A, B, C], [(0, 1, 2, 3), (4, 5, 6, 7)], (), "elements 0 and 1 have a face at the same place"),
    "near": ([*PAIR, *NEAR], [(0, 1, 2, 3), (4, 5, 6, 7)], (), "elements [01] and [01] have different vertices at the same place"),
    "hanging": ([A, B, C, UP, DOWN, (0.3, 0.3, 0), (0.5, 0.4, -1), (0.2, 0.6, -1)], [(0, 1, 2, 3), (4, 5, 6, 7)], (),
                "a vertex of element 1 at .* lies on a face of element 0"),
}


def check(path, cwd, ranks):
    sets = {"mesh": {"file": str(path)}, "initial": {}, "boundary": []}
    return launch("check", CASES / "rotation.yaml", *overrides(sets), cwd=cwd, ranks=ranks)


@pytest.mark.parametrize("ranks", [1, 2])
def test_good_mesh_is_read(tmp_path, ranks):
    process = check(write(tmp_path / "good.h5", PAIR, TWO), tmp_path, ranks)
    assert process.returncode == 0, process.stderr
    assert process.stdout.startswith("elements       2 ")


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("fault", FAULTS)
def test_faulty_mesh_is_refused(tmp_path, fault, ranks):
    points, tets, cut, message = FAULTS[fault]
    path = write(tmp_path / "faulty.h5", points, tets, cut)
    process = check(path, tmp_path, ranks)
    assert process.returncode == 2, process.stdout
    lines = [line for line in process.stderr.splitlines() if line.startswith("rhegma: ")]
    assert len(lines) == 1 and lines[0].startswith(f"rhegma: {path}: ")
    assert re.search(message, lines[0]), lines[0]


@pytest.mark.parametrize("ranks", [1, 2])
def test_neighbours_that_see_their_face_at_two_places(tmp_path, ranks):
    path = write(tmp_path / "moved.h5", PAIR, TWO)
    with h5py.File(path, "r+") as file:  # in the tile of element 1 alone, whose first corner is the face's
        file["x"][4] = (0.01, 0, 0)
        file["checksum/x"][1] = checksum(file["x"][4:])
    process = check(path, tmp_path, ranks)
    assert process.returncode == 2
    assert ("do not agree that they share a face" in process.stderr) or ("vertex 0 is at two places" in process.stderr)


def test_orientation_of_an_input_is_told_and_does_no_harm(tmp_path):
    source = tmp_path / "turned.inp"
    nodes = "\n".join(f"{n}, {x}, {y}, {z}" for n, (x, y, z) in enumerate(PAIR, 1))
    source.write_text(f"*NODE\n{nodes}\n*ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 4\n8, 1, 2, 3, 5\n")
    process = launch("mesh", source, "-o", tmp_path / "turned.h5")
    assert process.returncode == 0
    assert "1 of 2 elements have their corners in the order of a negative volume, the first of them 8" in process.stderr
    info = launch("mesh", "--info", tmp_path / "turned.h5").stdout
    assert re.search(r"aspect ratio .*\n(.* \d+\n){8}  worst [\d.]+: element \d \([78] in the input\)", info)
