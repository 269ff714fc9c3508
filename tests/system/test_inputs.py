"""Inputs as people have them, each one body written in another way: all of it comes in, or it is refused by keyword and line."""

import itertools
import shutil

import h5py
import numpy as np
import pytest
from conftest import ROOT, launch
import test_meshes as meshes
from test_abaqus import ELEMENTS, NODES, SIDES, corners, found, on_plane

INPUTS = ROOT / "tests" / "inputs"
TET = {e: frozenset(NODES[n] for n in nodes) for e, nodes in ELEMENTS.items()}
ALL, LOW, UP = (set(TET.values()) if part is None else {TET[e] for e in part} for part in (None, range(1, 25), range(25, 49)))
FACE = [(e, corners(e, f)) for e, f in SIDES]
SKIN = {(TET[e], frozenset(NODES[n] for n in nodes)) for e, nodes in FACE}
BOTTOM, TOP = ({(TET[e], frozenset(NODES[n] for n in nodes)) for e, nodes in FACE if on_plane(nodes, 2, z)} for z in (0, 2))

# Volume sets, surface sets; without an entry those of plain.inp. `moved`: where the body is.
PLAIN = {"all": ALL}, {"top": TOP, "bottom": BOTTOM}
SETS = {
    "c3d10-and-c3d4": ({"low": LOW, "up": UP}, PLAIN[1]),
    "c3d10-gaps": ({"Eall": ALL}, {"top": TOP, "Nall": SKIN}),
    "elcopy": ({"low": LOW, "up": UP}, {}),
    "instance-moved": ({}, {}),
    "kw-continued-surface": (PLAIN[0], {"top": TOP}),
    "kw-solid-blanks": ({"low": LOW, "up": UP, "all": ALL}, PLAIN[1]),
    "mixed-DC3D4": ({"low": LOW, "up": UP}, {}),
    "node-surface": (PLAIN[0], {"FIX": BOTTOM, "fix": BOTTOM}),
    "nset-only": (PLAIN[0], {"FIX": BOTTOM, "LOAD": TOP}),
    "overlap-elsets": ({"everything": ALL, "low": LOW}, PLAIN[1]),
    "overlap-elsets-section": ({"everything": ALL, "low": LOW}, PLAIN[1]),
    "overlap-surfaces": (PLAIN[0], {**PLAIN[1], "outside": TOP | BOTTOM}),
    "quoted": ({"my part, left": ALL}, {"top, face": TOP}),
    "set-of-later-set": ({"both": ALL, "low": LOW, "up": UP}, {}),
    "surface-free": (PLAIN[0], {"skin": SKIN}),
    "surface-instance": ({}, {"top": set(), "bottom": BOTTOM}),
    "surface-set-later": ({"all": ALL, "st3": {tet for tet, _ in TOP}}, {"top": TOP}),
    "triangles-S3": ({}, {"top": TOP}),
    "two-instances-moved": ({}, {}),
}
MOVED = {"instance-moved": (10, 0, 0), "system-moved": (10, 0, 0)}
REFUSED = {
    "two-instances": "elements 1 and 101 have different vertices at the same place (0, 0, 0) m: the mesh is open there; rhegma "
                     "mesh joins nodes that coincide by --merge D, keeps parts apart by --apart, or takes faces that lie on each other for a crack by --crack NAME\n",
    "type-short": "two-words.inp:29: *ELEM is not a keyword that is known here, and might change the mesh: without it, the mesh could be "
                  "another one\n",
}


def shifted(thing, by):
    """A tetrahedron, a face, sets of them: by a vector."""
    if isinstance(thing, (set, frozenset)):
        return type(thing)(shifted(t, by) for t in thing)
    if isinstance(thing[0], frozenset):
        return tuple(shifted(t, by) for t in thing)
    return tuple(x + d for x, d in zip(thing, by))


def moved(sets, by):
    return {name: shifted(members, by) for name, members in sets.items()}


@pytest.mark.parametrize("name", sorted(path.stem for path in (INPUTS / "inp").glob("*.inp") if path.stem not in REFUSED))
def test_one_body_in_many_words(tmp_path, name):
    process = launch("mesh", INPUTS / "inp" / f"{name}.inp", "-o", tmp_path / "a.h5")
    assert process.returncode == 0, process.stderr
    assert "keywords skipped, which say nothing of the mesh" in process.stdout
    volumes, surfaces = SETS.get(name, PLAIN)
    whole = {"": ALL | shifted(ALL, (0, 0, 5)) if name == "two-instances-moved" else ALL}
    by = MOVED.get(name, (0, 0, 0))
    rounding = 1e-5 if name == "node-system-C" else 1e-14  # its numbers have six digits
    assert found(tmp_path / "a.h5", rounding) == (moved({**whole, **volumes}, by), moved(surfaces, by))
    assert (process.stderr != "") == (name in ("surface-instance", "two-instances-moved"))  # a surface without faces; two parts


@pytest.mark.parametrize("name", sorted(REFUSED))
def test_what_is_refused(tmp_path, name):
    process = launch("mesh", INPUTS / "inp" / f"{name}.inp", "-o", tmp_path / "a.h5")
    assert process.returncode == 2 and not (tmp_path / "a.h5").exists()
    assert REFUSED[name].replace("two-words", name) in process.stderr


def test_many_grains(tmp_path):
    """A set of elements for each of 125 cubes."""
    side = range(6)
    deck = "*NODE\n" + "".join(f"{1 + i + 6 * j + 36 * k}, {i}., {j}., {k}.\n" for k, j, i in itertools.product(side, repeat=3))
    cell = [(1, 1 + a, 1 + a + b, 44) for a, b in itertools.permutations((1, 6, 36), 2)]
    for g, (k, j, i) in enumerate(itertools.product(range(5), repeat=3)):
        deck += f"*ELEMENT, TYPE=C3D4, ELSET=grain{g + 1}\n"
        deck += "".join(f"{6 * g + t + 1}, " + ", ".join(str(n + i + 6 * j + 36 * k) for n in cell[t]) + "\n" for t in range(6))
    (tmp_path / "grains.inp").write_text(deck)
    process = launch("mesh", tmp_path / "grains.inp", "-o", tmp_path / "a.h5")
    assert process.returncode == 0, process.stderr
    volumes, surfaces = found(tmp_path / "a.h5")
    assert surfaces == {} and len(volumes.pop("")) == 750
    for g, (k, j, i) in enumerate(itertools.product(range(5), repeat=3)):
        inside = volumes.pop(f"grain{g + 1}")
        assert len(inside) == 6 and {tuple(min(x[c] for x in tet) for c in range(3)) for tet in inside} == {(i, j, k)}
    assert volumes == {}


@pytest.mark.parametrize("name", sorted(path.name for path in (INPUTS / "vtk").iterdir() if not path.stem.startswith("box_")))
def test_regions_of_vtk(tmp_path, name):
    """As other programs write them; three pieces with each other's cells as ghosts."""
    merge = ["--merge", "1e-9"] if name.endswith(".pvtu") else []
    process = launch("mesh", INPUTS / "vtk" / name, "-o", tmp_path / "a.h5", *merge)
    if "LZMA" in name and "built without liblzma" in process.stderr:
        pytest.skip("no liblzma here")
    assert process.returncode == 0 and process.stderr == "", process.stderr
    assert found(tmp_path / "a.h5") == ({"": ALL, "block.0": LOW, "block.1": UP}, {})


# ---- What rhegma-convert reads ----


def converted(tmp_path, source):
    process = launch("mesh", source, "-o", tmp_path / "a.h5")
    assert process.returncode == 0, process.stderr
    return found(tmp_path / "a.h5"), process.stderr


def test_cgns(tmp_path):
    """As the library of CGNS wrote it: two sections of tetrahedra, one of triangles, a boundary condition on these."""
    sets, said = converted(tmp_path, INPUTS / "hdf5" / "box.cgns")
    assert sets == ({"": ALL, "low": LOW, "up": UP}, {"bottom faces": BOTTOM, "bottom": BOTTOM})
    assert len(said.splitlines()) == 1 and "24 of 48 elements have their corners in the order of a negative volume" in said


def change_cgns(tmp_path, change):
    path = shutil.copy(INPUTS / "hdf5" / "box.cgns", tmp_path / "a.cgns")
    with h5py.File(path, "r+") as file:
        change(file["Base/body"])
    return path


def put(group, name, values):
    del group[name]
    group[name] = np.asarray(values)


def mixed(zone):
    nodes = zone["low/ElementConnectivity/ data"][:].reshape(-1, 4)
    put(zone["low"], " data", np.array([20, 0], "i4"))
    put(zone["low/ElementConnectivity"], " data", np.hstack([np.full((24, 1), 10), nodes]).ravel())


def by_vertices(zone):
    """The boundary by vertices, which the top then has."""
    del zone["ZoneBC/bottom/GridLocation"]
    put(zone["ZoneBC/bottom/PointRange"], " data", [[19], [27]])


@pytest.mark.parametrize("change, surfaces", [(mixed, {"bottom faces": BOTTOM, "bottom": BOTTOM}),
                                              (by_vertices, {"bottom faces": BOTTOM, "bottom": TOP})])
def test_cgns_in_other_words(tmp_path, change, surfaces):
    assert converted(tmp_path, change_cgns(tmp_path, change))[0] == ({"": ALL, "low": LOW, "up": UP}, surfaces)


@pytest.mark.parametrize("change, message", [
    (lambda zone: put(zone["ZoneType"], " data", np.frombuffer(b"Structured", "i1")), "zone 'body' is not unstructured, and cannot be read"),
    (lambda zone: put(zone["up"], " data", [23, 0]), "section 'up' has elements of type 23 of CGNS, which cannot be read"),
    (lambda zone: put(zone["ZoneBC/bottom/PointRange"], " data", [[49], [57]]), "boundary 'bottom' names elements that are not there"),
    (lambda zone: zone["ZoneBC/bottom"].pop("PointRange"), "boundary 'bottom' has neither a list nor a range"),
    (lambda zone: zone["GridCoordinates"].pop("CoordinateZ"), "zone 'body' has not the coordinates x, y, z"),
    (lambda zone: zone["low"].pop("ElementConnectivity"), "damaged, or another kind of file: KeyError"),
])
def test_cgns_that_is_refused(tmp_path, change, message):
    process = launch("mesh", change_cgns(tmp_path, change), "-o", tmp_path / "a.h5")
    assert process.returncode == 2 and not (tmp_path / "a.h5").exists()
    assert process.stderr.startswith(f"convert: {tmp_path}/a.cgns: {message}") and process.stderr.endswith(
        f"rhegma: {tmp_path}/a.cgns: it cannot be read\n")


def test_med(tmp_path):
    pytest.importorskip("meshio")
    sets, _ = converted(tmp_path, INPUTS / "hdf5" / "box.med")
    assert sets == ({"": ALL, "low": ALL, "odd": {TET[e] for e in range(2, 49, 2)}}, {"bottom": BOTTOM})


@pytest.mark.parametrize("name", ["a.med", "a.cgns"])
def test_what_is_no_such_file(tmp_path, name):
    (tmp_path / name).write_text("neither\n")
    process = launch("mesh", tmp_path / name, "-o", tmp_path / "a.h5")
    assert process.returncode == 2 and process.stderr.startswith(f"convert: {tmp_path / name}: ")
    assert "Traceback" not in process.stderr and process.stderr.endswith(f"rhegma: {tmp_path / name}: it cannot be read\n")
    process = launch("mesh", tmp_path / f"no-{name}", "-o", tmp_path / "a.h5")
    assert process.returncode == 2 and process.stderr == f"rhegma: {tmp_path}/no-{name}: cannot be read: No such file or directory\n"


# ---- Quadrangles of Abaqus ----

SHEET = """*NODE
1, 0., 0.
2, 2., 0.
3, 3., 0.
4, 0., 1.
5, 2., 1.
6, 3., 1.
7, 4., 0.
*ELEMENT, TYPE=CPS4R, ELSET=steel
1, 1, 2, 5, 4
*ELEMENT, TYPE=S4, ELSET=brass
2, 2, 3, 6, 5
*ELEMENT, TYPE=S3, ELSET=brass
3, 3, 7, 6
*SURFACE, NAME=left
1, S4
*SURFACE, NAME=weld
1, S2
*SURFACE, NAME=right
3, S2
"""


def parts(path):
    """Volumes of sets, areas of sets of faces and of those between elements (both sides)."""
    with h5py.File(path) as file:
        c = meshes.corners(file)
        volume = {name: meshes.volumes(c)[meshes.in_set(file, "volume", name)].sum() for name in meshes.names(file, "volume")}
        area = {name: meshes.face_areas(c)[meshes.in_set(file, "surface", name)].sum() for name in meshes.names(file, "surface")}
    return volume, area


def test_quadrangles_are_extruded(tmp_path):
    (tmp_path / "a.inp").write_text(SHEET)
    process = launch("mesh", tmp_path / "a.inp", "-o", tmp_path / "a.h5", "--extrude", "0.5,2")
    assert process.returncode == 0, process.stderr
    volume, area = parts(tmp_path / "a.h5")
    assert volume == pytest.approx({"steel": 1, "brass": 0.75})
    assert area == pytest.approx({"left": 0.5, "weld": 2 * 0.5, "right": 0.5 * 2**0.5, "bottom": 3.5, "top": 3.5})
    (tmp_path / "a.inp").write_text(SHEET.replace("3, S2", "3, S4"))
    process = launch("mesh", tmp_path / "a.inp", "-o", tmp_path / "b.h5", "--extrude", "0.5,2")
    assert process.returncode == 2 and process.stderr.endswith("of a triangle that is extruded, S1 to S3 is expected\n")


def test_quadrangles_name_faces_of_split_solids(tmp_path):
    """A cube of 1 and one beside it; quadrangles on the lower side of the first, of eight nodes, and between them."""
    nodes = "".join(f"{1 + i + 3 * j + 6 * k}, {i}., {j}., {k}.\n" for k, j, i in itertools.product(range(2), range(2), range(3)))
    middles = "".join(f"{20 + k}, {x}, {y}, 0.\n" for k, (x, y) in enumerate([(0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5)]))
    text = "*NODE\n" + nodes + middles + "*ELEMENT, TYPE=C3D8, ELSET=all\n1, 1, 2, 5, 4, 7, 8, 11, 10\n2, 2, 3, 6, 5, 8, 9, 12, 11\n"
    text += "*ELEMENT, TYPE=S8R, ELSET=foot\n3, 1, 2, 5, 4, 20, 21, 22, 23\n*ELEMENT, TYPE=M3D4, ELSET=joint\n4, 2, 5, 11, 8\n"
    (tmp_path / "a.inp").write_text(text)
    process = launch("mesh", tmp_path / "a.inp", "-o", tmp_path / "a.h5", "--split")
    assert process.returncode == 0, process.stderr
    volume, area = parts(tmp_path / "a.h5")
    assert volume == pytest.approx({"all": 2}) and area == pytest.approx({"foot": 1, "joint": 2})
