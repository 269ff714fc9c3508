"""Mesh files: imports in every format that Gmsh here writes, the meshes of bench/examples, runs from a file."""

import json
import re
import shutil
import subprocess

import h5py
import numpy as np
import pytest
from conftest import CASES, PROGRAM, example, launch, overrides

GMSH = shutil.which("gmsh")
needs_gmsh = pytest.mark.skipif(GMSH is None or not PROGRAM.with_name("rhegma-mesh").exists(),
                                reason="no Gmsh here (Debian: gmsh, libgmsh-dev), or rhegma-mesh is not built")

# Two materials, one above the other; two named sides.
TWO = """
SetFactory("OpenCASCADE");
Mesh.MeshSizeMax = 0.5;
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {0, 0, 1, 1, 1, 1};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
bottom[] = Surface In BoundingBox{-1, -1, -0.1, 2, 2, 0.1};
top[] = Surface In BoundingBox{-1, -1, 1.9, 2, 2, 2.1};
"""
NAMED = TWO + """
Physical Volume("steel") = {1};
Physical Volume("brass") = {2};
Physical Surface("bottom") = bottom[];
Physical Surface("top") = top[];
"""
NAMES = {"surface": ["bottom", "top"], "volume": ["steel", "brass"]}
NUMBERS = {"surface": ["5", "11"], "volume": ["1", "2"]}  # of Gmsh's entities, where a format has no names
# VTK as Gmsh writes it has the numbers of physical groups as cell data.
CELL_DATA = {"surface": ["CellEntityIds.3", "CellEntityIds.4"], "volume": ["CellEntityIds.1", "CellEntityIds.2"]}
FORMATS = [("msh2", ".msh", [], NAMES), ("msh2", ".msh", ["-bin"], NAMES), ("msh40", ".msh", [], NAMES),
           ("msh41", ".msh", [], NAMES), ("msh41", ".msh", ["-bin"], NAMES), ("unv", ".unv", [], NAMES),
           ("inp", ".inp", [], NAMES), ("bdf", ".bdf", [], NUMBERS), ("mesh", ".mesh", [], NUMBERS),
           ("vtk", ".vtk", [], CELL_DATA), ("vtk", ".vtk", ["-bin"], CELL_DATA)]


def gmsh(text, out, *options):
    """The mesh that Gmsh makes of a geometry."""
    geo = out.with_suffix(".geo")
    geo.write_text(text + "\n")
    process = subprocess.run([GMSH, "-3", geo, *options, "-o", out], capture_output=True, text=True, timeout=300)
    assert process.returncode == 0, process.stdout + process.stderr
    return out


def convert(source, out, *options):
    """rhegma mesh: the mesh file opened for reading, and the warnings."""
    process = launch("mesh", source, "-o", out, *options)
    assert process.returncode == 0, process.stderr
    return h5py.File(out), process.stderr


def refused(source, out, *options):
    process = launch("mesh", source, "-o", out, *options)
    assert process.returncode == 2, process.stdout + process.stderr
    assert not out.exists() and not out.with_name(out.name + ".part").exists()
    return process.stderr


def positions(file):
    """[vertices][3], from the tiles' lists."""
    x = np.full((file.attrs["vertices"], 3), np.nan)
    x[file["vertex"][:]] = file["x"][:]
    return x


def corners(file):
    return positions(file)[file["corner"][:]]


def volumes(c):
    return abs(np.linalg.det(c[:, 1:] - c[:, :1])) / 6


def names(file, kind):
    return [name.decode() for name in file[kind + "_sets"]] if kind + "_sets" in file else []


def in_set(file, kind, name):
    """[elements][4] or [elements]: whether each face or element is in the set (src/mesh/sets.h)."""
    number, count = names(file, kind).index(name), len(names(file, kind))
    rows = file[f"{kind}_combinations"][:] if f"{kind}_combinations" in file else np.zeros((0, 2), int)
    groups = [number, *(count + rows[rows[:, 1] == number, 0])]
    return np.isin(file["set" if kind == "surface" else "region"][:], groups)


def face_areas(c):
    """[elements][4]: area of the face opposite each corner."""
    p, q, r = ([c[:, face[i]] for face in ([1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2])] for i in range(3))
    return np.stack([np.linalg.norm(np.cross(b - a, d - a), axis=1) / 2 for a, b, d in zip(p, q, r)], axis=1)


# ---- Plates ----

SHEET = """
SetFactory("OpenCASCADE");
Mesh.MeshSizeMax = 0.3;
Rectangle(1) = {0, 0, 0, 2, 1};
Rectangle(2) = {2, 0, 0, 1, 1};
BooleanFragments{ Surface{1}; Delete; }{ Surface{2}; Delete; }
Physical Surface("steel") = {1};
Physical Surface("brass") = {2};
left[] = Curve In BoundingBox{-0.1, -0.1, -0.1, 0.1, 1.1, 0.1};
weld[] = Curve In BoundingBox{1.9, -0.1, -0.1, 2.1, 1.1, 0.1};
Physical Curve("left") = left[];
Physical Curve("weld") = weld[];
"""
SHEETS = [(".geo", [], ["steel", "brass", "left", "weld"]), (".msh", [], ["steel", "brass", "left", "weld"]),
          (".inp", [], ["steel", "brass", "left", "weld"]), (".unv", [], ["steel", "brass", "left", "weld"]),
          (".vtk", ["-bin"], [f"CellEntityIds.{n}" for n in (1, 2, 3, 4)])]


@needs_gmsh
@pytest.mark.parametrize("suffix, options, sets", SHEETS, ids=lambda v: v if type(v) is str else "")
def test_extrude(tmp_path, suffix, options, sets):
    """A flat mesh of two materials becomes a plate of three layers, whatever the format."""
    source = tmp_path / f"sheet{suffix}"
    geo = tmp_path / "sheet.geo"
    geo.write_text(SHEET)
    if suffix != ".geo":
        subprocess.run([GMSH, "-2", geo, *options, "-o", source], capture_output=True, check=True, timeout=300)
    file, said = convert(source, tmp_path / "plate.h5", "--extrude", "0.6,3", "--unit", "cm")
    assert "faces of surface sets lie between elements" in said
    c = corners(file)
    for name, volume in zip(sets[:2], (1.2e-6, 0.6e-6)):
        assert volumes(c)[in_set(file, "volume", name)].sum() == pytest.approx(volume, rel=1e-9)
    areas, outside = face_areas(c), file["neighbour"][:] < 0
    for name, area, inside in ((sets[2], 0.6e-4, False), (sets[3], 2 * 0.6e-4, True), ("bottom", 3e-4, False), ("top", 3e-4, False)):
        here = in_set(file, "surface", name)
        assert areas[here].sum() == pytest.approx(area, rel=1e-9) and outside[here].any() != inside
    assert len(set(np.round(positions(file)[:, 2], 9))) == 4


# ---- Polycrystals ----


def polycrystal(path, grains, cells):
    """A cube of 1 mm of cells^3 cubes, whose tetrahedra belong to the nearest of so many random points; as VTK."""
    random = np.random.default_rng(grains)
    index = np.arange((cells + 1) ** 3).reshape((cells + 1,) * 3)
    corner = index[:-1, :-1, :-1].ravel()
    step = [(cells + 1) ** 2, cells + 1, 1]
    paths = [np.cumsum([0, *(step[k] for k in order)]) for order in ((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0))]
    tets = np.concatenate([corner[:, None] + p for p in paths])
    x = np.stack(np.unravel_index(index.ravel(), index.shape), axis=1) / cells
    seeds = random.random((grains, 3))
    middle = x[tets].mean(axis=1)
    grain = np.argmin(((middle[:, None] - seeds) ** 2).sum(axis=2), axis=1)
    with open(path, "w") as file:
        file.write(f"# vtk DataFile Version 4.2\ngrains\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {len(x)} double\n")
        np.savetxt(file, x, "%.17g")
        file.write(f"CELLS {len(tets)} {5 * len(tets)}\n")
        np.savetxt(file, np.column_stack([np.full(len(tets), 4), tets]), "%d")
        file.write(f"CELL_TYPES {len(tets)}\n" + "10\n" * len(tets) + f"CELL_DATA {len(tets)}\nSCALARS grain int\n")
        np.savetxt(file, grain, "%d")
    return tets, grain


@pytest.mark.parametrize("grains, cells", [(20, 4), (1000, 9)])
def test_polycrystal(run, tmp_path_factory, grains, cells):
    """A material for each grain, stiffer from one to the next or turned anyhow, and boundaries of grains that are weaker: the
    same bits on any ranks."""
    folder = tmp_path_factory.mktemp("grains")
    tets, grain = polycrystal(folder / "grains.vtk", grains, cells)
    names_of = sorted(set(grain))
    file, _ = convert(folder / "grains.vtk", folder / "grains.h5", "--unit", "mm")
    assert names(file, "volume") == [f"grain.{g}" for g in names_of] and len(names_of) > 0.8 * grains
    glass = {"model": "neo-hookean", "poisson": 0.2, "density": 2500}
    crystal = {"model": "anisotropic", "density": 2500, "stiffness": [80e9, 20e9, 20e9, 0, 0, 0, 80e9, 20e9, 0, 0, 0, 80e9, 0, 0, 0, 45e9, 0, 0, 45e9, 0, 45e9]}
    kind, heading = (glass, "young") if grains == 20 else (crystal, "angle_1, angle_2, angle_3")
    rows = [f"g{g}, grain.{g}, " + (f"{70e9 * (1 + g / grains)}" if kind is glass else f"{g}, {7 * g}, {-31 * g}") for g in names_of]
    (folder / "grains.csv").write_text("\n".join([f"name, set, {heading}", *rows]))
    case = folder / "grains.yaml"
    case.write_text(json.dumps({
        "mesh": {"file": "grains.h5"}, "material": {**glass, "young": 70e9},
        "materials": [{**kind, "name": "g", "file": "grains.csv"}],
        "interface": {"law": "linear", "strength": 1e9, "energy": 10, "sets": [{"between": "any", "strength": 1e6}]},
        "initial": {"velocity": {"x": "1e4*x"}}, "boundary": [], "time": {"end": 1, "steps": 30}, "output": {"fields": ["material", "crack"]}}))
    one, two = run(case), run(case, ranks=2, threads=2)
    assert one.summary["state_hash"] == two.summary["state_hash"]
    assert [m["elements"] for m in one.summary["materials"]] == [0, *np.bincount(grain)[names_of]]
    assert ("bulk_g3" in one.energy.dtype.names) == (grains == 20)
    faces = np.sort(tets[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3), axis=1)
    of = np.repeat(grain, 4)
    order = np.lexsort(faces.T)
    twice = (faces[order][1:] == faces[order][:-1]).all(axis=1)
    between = (twice & (of[order][1:] != of[order][:-1])).sum()
    assert 0 < len(one.frames()[-1]["crack/damage"]) <= 2 * between and one.energy["broken_area"][-1] > 0
    told = launch("check", one.dir / "case.yaml").stdout  # all that was read from the table
    assert ("others, with dilatational waves of" in told) == (grains == 1000)


# ---- Formats ----


@needs_gmsh
@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("name, suffix, options, sets", FORMATS, ids=lambda v: " ".join(v) if type(v) is list else None)
def test_format(tmp_path, name, suffix, options, sets, order):
    source = gmsh(NAMED, tmp_path / f"two{suffix}", "-format", name, "-order", str(order), *options)
    file, said = convert(source, tmp_path / "two.h5")
    c = corners(file)
    size = volumes(c)
    assert file.attrs["elements"] == len(c) == 1413
    assert size.sum() == pytest.approx(2, rel=1e-4)  # Nastran's short fields hold five digits
    for kind in sets:  # Abaqus's have those of the entities besides
        assert set(names(file, kind)) >= set(sets[kind]) and (name == "inp" or len(names(file, kind)) == len(sets[kind]))
    height = c[:, :, 2].mean(axis=1)
    for side, there in (("bottom", 0), ("top", 2)):
        key = sets["surface"][0 if there == 0 else 1]
        faces = in_set(file, "surface", key)
        assert face_areas(c)[faces].sum() == pytest.approx(1, rel=1e-4), side
        assert (abs(height[faces.any(axis=1)] - there) < 0.5).all()
    lower = in_set(file, "volume", sets["volume"][0])
    assert (lower == (height < 1)).all()
    bent = [line for line in said.splitlines() if "mid-nodes" in line]
    assert bool(bent) == (name == "bdf" and order == 2)  # its digits bend edges


@needs_gmsh
def test_neighbours_of_an_import(tmp_path):
    file, _ = convert(gmsh(NAMED, tmp_path / "two.msh"), tmp_path / "two.h5")
    corner, neighbour, face = file["corner"][:], file["neighbour"][:], file["face"][:]
    assert (np.diff(corner, axis=1) > 0).all()
    for e, f in np.argwhere(neighbour >= 0):
        other, back = neighbour[e, f], face[e, f]
        assert (neighbour[other, back], face[other, back]) == (e, f)
        assert set(np.delete(corner[e], f)) == set(np.delete(corner[other], back))
    area = face_areas(corners(file))
    assert area[neighbour < 0].sum() == pytest.approx(10)  # the whole surface and nothing else
    assert file.attrs["interfaces"] == (neighbour >= 0).sum() // 2
    assert len(np.unique(file["original"])) == len(corner)


@needs_gmsh
def test_curved_second_order_is_counted(tmp_path):
    text = 'SetFactory("OpenCASCADE"); Sphere(1) = {0, 0, 0, 1}; Mesh.MeshSizeMax = 0.4;'
    source = gmsh(text, tmp_path / "ball.msh", "-format", "msh2", "-order", "2")
    lines = source.read_text().splitlines()
    count = int(lines[lines.index("$Nodes") + 1])
    x = np.array([line.split() for line in lines[lines.index("$Nodes") + 2:][:count]], float)
    place = dict(zip(x[:, 0].astype(int), x[:, 1:]))
    tets = [list(map(int, line.split()[-10:])) for line in lines if re.match(r"\d+ 11 ", line)]
    nodes = np.array([[place[n] for n in tet] for tet in tets])
    ends = [(0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3)]
    off = np.stack([np.linalg.norm(nodes[:, 4 + k] - (nodes[:, a] + nodes[:, b]) / 2, axis=1) /
                    np.linalg.norm(nodes[:, a] - nodes[:, b], axis=1) for k, (a, b) in enumerate(ends)])
    assert (off > 1e-6).sum() > 100
    file, said = convert(source, tmp_path / "ball.h5")
    assert f"{(off > 1e-6).sum()} of {off.size} mid-nodes are off straight by more than 1e-06" in said
    assert volumes(corners(file)).sum() == pytest.approx(volumes(nodes[:, :4]).sum(), rel=1e-12)


@needs_gmsh
def test_scale(tmp_path):
    source = gmsh(NAMED, tmp_path / "two.msh")
    file, _ = convert(source, tmp_path / "mm.h5", "--scale", "1e-3")
    assert file.attrs["box"].tolist() == [[0, 0, 0], [1e-3, 1e-3, 2e-3]]


@needs_gmsh
def test_no_names_become_numbers(tmp_path):
    file, _ = convert(gmsh(TWO, tmp_path / "two.msh"), tmp_path / "two.h5")
    assert len(names(file, "surface")) == 11 and names(file, "volume") == ["1", "2"]
    inner = [i for i in range(11) if (file["neighbour"][:][file["set"][:] == i] >= 0).all()]
    assert len(inner) == 1  # the surface between the two volumes is inside


@needs_gmsh
@pytest.mark.parametrize("text, message", [
    ('Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Line(1) = {1, 2};', "no tetrahedra"),
    ("Point(1) = {0, 0, 0, 1}; Point(2) = {1, 0, 0, 1}; Line(1) = {1, 2};"
     "s[] = Extrude {0, 1, 0} { Line{1}; Layers{2}; Recombine; };"
     "Extrude {0, 0, 1} { Surface{s[1]}; Layers{2}; Recombine; }", "Hexahedron"),
    ("Box(1) = {0, 0, 0, 1, 1", "syntax error"),
])
def test_geometry_that_is_refused(tmp_path, text, message):
    geo = tmp_path / "bad.geo"
    geo.write_text(text + "\n")
    said = refused(geo, tmp_path / "out.h5")
    assert message.lower() in said.lower() and "bad.geo" in said


@needs_gmsh
def test_elements_outside_of_physical_volumes_are_left_out(tmp_path):
    geo = tmp_path / "half.geo"
    geo.write_text(TWO + 'Physical Volume("steel") = {1};\n')
    file, said = convert(geo, tmp_path / "half.h5")
    assert "in no physical volume" in said
    assert volumes(corners(file)).sum() == pytest.approx(1)


@needs_gmsh
def test_open_mesh_is_refused(tmp_path):
    geo = tmp_path / "open.geo"  # the two boxes do not share the surface between them
    geo.write_text(re.sub(r"BooleanFragments.*", "", NAMED).replace("11", "5"))
    said = refused(geo, tmp_path / "out.h5")
    assert re.search(r"open.geo: (elements \d+ and \d+ have different vertices at the same place|"
                     r"a vertex of element \d+ .* hanging)", said)


@needs_gmsh
def test_parts_are_told(tmp_path):
    geo = tmp_path / "apart.geo"
    geo.write_text('SetFactory("OpenCASCADE"); Mesh.MeshSizeMax = 0.5;'
                   "Box(1) = {0, 0, 0, 1, 1, 1}; Box(2) = {0, 0, 3, 1, 1, 1};\n")
    _, said = convert(geo, tmp_path / "apart.h5")
    assert "the mesh has 2 parts that share no face" in said and "part 2: " in said


def test_missing_and_foreign_inputs(tmp_path):
    assert "nowhere.inp: cannot be read" in refused("nowhere.inp", tmp_path / "out.h5")
    other = tmp_path / "other.h5"
    other.write_text("not HDF5")
    process = launch("mesh", "--info", other)
    assert process.returncode == 2 and "other.h5: not a mesh file of Rhegma" in process.stderr


@pytest.mark.parametrize("arguments, message", [
    ([], "nothing to read"), (["a.msh"], "-o OUT.h5 is missing"), (["a.msh", "-o"], "missing value after: -o"),
    (["a.msh", "b.msh"], "one mesh at a time"), (["a.msh", "-o", "x.h5", "--scale", "0"], "--scale must be a number > 0"),
    (["--info", "a.h5", "-o", "b.h5"], "--info writes nothing"),
    (["--info", "a.h5", "--improve"], "not understood with it: --info"),
    (["--partition", "2", "a.h5", "--improve"], "not understood with it: --partition"),
    (["a.yaml", "-o", "b.h5", "--improve"], "--improve is for a mesh on its way in"), (["a.h5", "-o", "b.h5"], "a mesh file already"), (["a.msh", "--frob", "1"], "unknown option: --frob"),
])
def test_wrong_arguments(tmp_path, arguments, message):
    process = launch("mesh", *arguments, cwd=tmp_path)
    assert process.returncode == 2 and message in process.stderr.splitlines()[0]
    assert "usage: rhegma mesh" in process.stderr and list(tmp_path.iterdir()) == []


def test_output_does_not_replace_its_input(tmp_path):
    case = shutil.copy(example("spall.yaml"), tmp_path / "a.yaml")
    other = tmp_path / "b.yaml"
    other.symlink_to(case)
    process = launch("mesh", case, "-o", other)
    assert process.returncode == 2 and "it would take the place of what it is made from: -o" in process.stderr
    assert case.read_text() == (example("spall.yaml")).read_text()


# ---- Abaqus ----

PART = """*HEADING
two tetrahedra
*PART, NAME=P
** the nodes
*NODE
10, 0., 0., 0.
20, 1., 0., 0.
30, 0., 1., 0.
40, 0., 0., 1.
50, 0., 0., -1.
*ELEMENT, TYPE=C3D4, ELSET=All
1, 10, 20, 30, 40
2, 10,
20, 30, 50
*ELSET, ELSET=up
1
*Elset, elset=both, generate
 1, 2, 1
*SOLID SECTION, ELSET=both, MATERIAL=glass
1.
*END PART
*INSTANCE, NAME=I, PART=P
*END INSTANCE
*ELSET, ELSET=_s_S2, INTERNAL, INSTANCE=I
1, 2
*SURFACE, TYPE=ELEMENT, NAME=side
_s_S2, S2
I.2, S3
"""


def inp(tmp_path, text):
    path = tmp_path / "a.inp"
    path.write_text(text)
    return path


def test_abaqus_sets_and_surfaces(tmp_path):
    file, said = convert(inp(tmp_path, PART), tmp_path / "a.h5", "--scale", "2")
    assert len(said.splitlines()) == 1 and "1 of 2 elements have their corners in the order of a negative" in said
    assert names(file, "volume") == ["All", "up", "both"] and names(file, "surface") == ["side"]
    assert file["volume_combinations"][:].tolist() == [[0, 0], [0, 1], [1, 0], [1, 1], [1, 2], [2, 0], [2, 2]]
    first = {original: i for i, original in enumerate(file["original"])}
    assert file["region"][first[1]] == 4 and file["region"][first[2]] == 5
    marked = {(int(e) + 0, f) for e, f in np.argwhere(file["set"][:] == 0)}
    # corners in order: 10 20 30 40 and 10 20 30 50; S2 has nodes 1 4 2, so it is opposite 30; S3 opposite 10
    assert marked == {(first[1], 2), (first[2], 2), (first[2], 0)}
    assert positions(file).max() == 2 and file.attrs["interfaces"] == 1


@pytest.mark.parametrize("old, new, message", [
    ("TYPE=C3D4", "TYPE=C3D8R", "a.inp:11: *ELEMENT, TYPE=C3D8R: only tetrahedra"),
    ("20, 30, 50", "20, 60, 50", "element 2 has node 60, which is not there"),
    ("20, 30, 50", "20, 30", "a.inp:15: element 2 has 3 of 4 nodes"),
    ("I.2, S3", "I.7, S3", "a.inp:28: *SURFACE, NAME=side: there is no element 7"),
    ("*HEADING", "*NMAP\n*HEADING", "*NMAP is not a keyword that is known here"),
])
def test_abaqus_that_is_refused(tmp_path, old, new, message):
    assert message in refused(inp(tmp_path, PART.replace(old, new)), tmp_path / "out.h5")


# ---- The meshes of bench/examples ----

THESIS = {"spall-uniform": 13683, "spall-middle": 150742, "spall-graded": 223394,
          "plate-structured": 183673, "plate-unstructured": 198431}
SIDES = ["x+", "x-", "y+", "y-", "z+", "z-"]
REFINED = ["spall-middle", "spall-graded"]  # meshed for --improve


@pytest.fixture(scope="module")
def thesis(scratch):
    made = {}

    def make(name):
        if name not in made:
            improve = ["--improve"] if name in REFINED else []
            made[name] = convert(example(f"{name}.geo"), scratch / f"{name}.h5", "--scale", "1e-3", *improve)[0]
        return made[name]

    return make


@needs_gmsh
@pytest.mark.parametrize("name", THESIS)
def test_mesh_of_the_thesis(thesis, name):
    file = thesis(name)
    size = [0.4e-3, 0.4e-3, 4e-3] if name.startswith("spall") else [50.8e-3, 50.8e-3, 12e-3]
    assert file.attrs["elements"] == pytest.approx(THESIS[name], rel=0.05)
    assert np.ptp(file.attrs["box"], axis=0) == pytest.approx(size, rel=1e-12)
    assert sorted(names(file, "surface")) == SIDES
    c = corners(file)
    assert volumes(c).sum() == pytest.approx(np.prod(size), rel=1e-9)
    areas = face_areas(c)
    for i, side in enumerate(names(file, "surface")):
        axis = "xyz".index(side[0])
        assert areas[file["set"][:] == i].sum() == pytest.approx(np.prod(np.delete(size, axis)), rel=1e-9)


def mean_edge(c, within):
    c = c[abs(c[:, :, 2].mean(axis=1)) < within]
    return np.mean([np.linalg.norm(c[:, a] - c[:, b], axis=1) for a in range(4) for b in range(a)])


def flat_area(c):
    """Largest area of faces in one plane of constant z inside the bar (m^2); c[elements][4][3]."""
    areas, most = face_areas(c), {}
    for f in range(4):
        z = np.delete(c[:, :, 2], f, axis=1)
        flat = (np.ptp(z, axis=1) < 1e-12) & (abs(z[:, 0]) < 1.9e-3)
        for height, area in zip(np.round(z[flat, 0], 12), areas[flat, f]):
            most[height] = most.get(height, 0) + area / 2
    return max(most.items(), key=lambda item: item[1], default=(None, 0))


@needs_gmsh
def test_middle_of_the_refined_meshes(thesis):
    c = corners(thesis("spall-middle"))
    assert mean_edge(c, 0.08e-3) == pytest.approx(14.8e-6, rel=0.05)
    assert flat_area(c)[1] < 0.05 * 0.16e-6
    c = corners(thesis("spall-graded"))
    assert mean_edge(c, 5e-6) == pytest.approx(11.4e-6, rel=0.05)
    height, area = flat_area(c)
    assert height == 0 and area == pytest.approx(0.16e-6, rel=1e-9)


def smallest_height(c):
    return (3 * volumes(c) / face_areas(c).max(axis=1)).min()


@needs_gmsh
@pytest.mark.parametrize("name, gain", [("spall-uniform", 1.6), ("part", 1.5)])
def test_improvement(thesis, tmp_path, name, gain):
    plain = thesis(name)
    better, _ = convert(example(f"{name}.geo"), tmp_path / "better.h5", "--scale", "1e-3", "--improve")
    before, after = corners(plain), corners(better)
    assert smallest_height(after) > gain * smallest_height(before)
    assert volumes(after).sum() == pytest.approx(volumes(before).sum(), rel=1e-9)
    sizes = [{key: face_areas(c)[file["set"][:] == i].sum() for i, key in enumerate(names(file, "surface"))}
             for file, c in ((plain, before), (better, after))]
    assert sizes[1] == pytest.approx(sizes[0], rel=1e-9)  # curved surfaces included
    again, _ = convert(example(f"{name}.geo"), tmp_path / "again.h5", "--scale", "1e-3", "--improve")
    assert (tmp_path / "again.h5").read_bytes() == (tmp_path / "better.h5").read_bytes()


@needs_gmsh
def test_improvement_keeps_surfaces_between_volumes(tmp_path):
    geo = tmp_path / "two.geo"
    geo.write_text(NAMED)
    file, said = convert(geo, tmp_path / "two.h5", "--improve")
    c = corners(file)
    for i, part in enumerate(names(file, "volume")):
        z = c[file["region"][:] == i][:, :, 2]
        assert (z.min(), z.max()) == ((0, 1) if part == "steel" else (1, 2))
        assert volumes(c)[file["region"][:] == i].sum() == pytest.approx(1, rel=1e-12)


LINE = """
SetFactory("OpenCASCADE");
Mesh.MeshSizeMax = 0.3;
Box(1) = {0, 0, 0, 2, 1, 1};
Point(20) = {0.3, 0.37, 1};
Point(21) = {1.7, 0.61, 1};
Line(20) = {20, 21};
BooleanFragments{ Volume{1}; Delete; }{ Curve{20}; Delete; }
Physical Volume("body") = {1};
"""


@needs_gmsh
@pytest.mark.parametrize("named", [True, False])
def test_improvement_keeps_named_edges(tmp_path, named):
    """A line inside a surface of one set keeps its place, all along, if it is a physical curve; else vertices leave it."""
    geo = tmp_path / "line.geo"
    geo.write_text(LINE + ("""Physical Curve("front") = {20};\n""" if named else ""))
    file, said = convert(geo, tmp_path / "line.h5", "--improve")
    assert ("sets of edges name no faces: 1 are left out, but --improve keeps their places" in said) == named
    x = positions(file)
    a, b = np.array([0.3, 0.37, 1]), np.array([1.7, 0.61, 1])
    along = (x - a) @ (b - a) / ((b - a) @ (b - a))
    on = np.linalg.norm(x - a - np.outer(along, b - a), axis=1) < 1e-9
    on &= (along > -1e-9) & (along < 1 + 1e-9)
    chain = np.flatnonzero(on)[np.argsort(along[on])]
    edges = {tuple(sorted((e[i], e[j]))) for e in file["corner"][:].tolist() for i in range(4) for j in range(i)}
    whole = all(tuple(sorted(pair)) in edges for pair in zip(chain.tolist(), chain[1:].tolist()))
    assert (len(chain) > 5 and whole and along[on].max() > 1 - 1e-9) == named


@needs_gmsh
def test_meshing_twice_gives_the_same_file(thesis, tmp_path):
    thesis("spall-uniform")
    _, _ = convert(example("spall-uniform.geo"), tmp_path / "again.h5", "--scale", "1e-3")
    assert (tmp_path / "again.h5").read_bytes() == open(thesis("spall-uniform").filename, "rb").read()


@needs_gmsh
def test_part_with_holes(tmp_path):
    file, _ = convert(example("part.geo"), tmp_path / "part.h5", "--scale", "1e-3")
    checked = launch("check", example("part.yaml"), *overrides({"mesh.file": str(tmp_path / "part.h5")}))
    assert checked.returncode == 0 and "0.06 x 0.06 x 0.03 m" in checked.stdout, checked.stderr
    c = corners(file)
    areas = face_areas(c)
    area = {name: areas[file["set"][:] == i].sum() for i, name in enumerate(names(file, "surface"))}
    holes = 4 * np.pi * 3.5e-3**2
    assert area["bore"] == pytest.approx(2 * np.pi * 11e-3 * 30e-3, rel=0.03)
    assert area["bolts"] == pytest.approx(4 * 2 * np.pi * 3.5e-3 * 8e-3, rel=0.04)
    assert area["base"] == pytest.approx(3.6e-3 - np.pi * 11e-3**2 - holes, rel=0.01)
    assert area["rim"] == pytest.approx(np.pi * (18e-3**2 - 11e-3**2), rel=0.03)


@needs_gmsh
def test_plate_with_a_hole_is_what_its_case_pulls(tmp_path):
    """The geometry of bench/examples/plate-with-hole fits its case: scale, names of the ends, probes inside the body."""
    file, _ = convert(example("plate-with-hole.geo"), tmp_path / "plate.h5", "--scale", "1e-3", "--improve")
    assert volumes(corners(file)).sum() == pytest.approx((3 * 6 - np.pi * 0.4**2) * 0.2e-9, rel=0.003)
    checked = launch("check", example("plate-with-hole.yaml"), *overrides({"mesh.file": str(tmp_path / "plate.h5")}))
    assert checked.returncode == 0 and "0.003 x 0.006 x 0.0002 m" in checked.stdout, checked.stderr


# ---- Runs ----

BOX = {"mesh.cells": [3, 3, 24], "time.steps": 60, "output.fields": []}


def file_case(tmp_path, mesh, source=CASES / "fragments.yaml"):
    """The case with a mesh file in place of its box."""
    text = re.sub(r"^mesh:\n(  .*\n)+", f"mesh:\n  file: {mesh.name}\n", source.read_text(), flags=re.M)
    case = tmp_path / "from-file.yaml"
    case.write_text(text)
    return case


@pytest.fixture(scope="module")
def box(scratch):
    """A case that reads the box of fragments.yaml from a file."""
    folder = scratch / "box"
    folder.mkdir()
    file, _ = convert(CASES / "fragments.yaml", folder / "box.h5", "--set", f"mesh.cells={BOX['mesh.cells']}")
    assert file.attrs["elements"] == 1296
    return file_case(folder, folder / "box.h5")


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_box_from_a_file_runs_the_same(run, box, ranks):
    memory = run(CASES / "fragments.yaml", sets=BOX)
    file = run(box, ranks=ranks, sets={key: BOX[key] for key in BOX if key != "mesh.cells"})
    assert file.summary["state_hash"] == memory.summary["state_hash"]
    assert (file.dir / "energy.csv").read_bytes() == (memory.dir / "energy.csv").read_bytes()


def test_echoed_case_finds_the_file(run, box, tmp_path):
    sets = {key: BOX[key] for key in BOX if key != "mesh.cells"}
    first = run(box, sets=sets)
    moved = tmp_path / "case.yaml"
    shutil.copy(first.dir / "case.yaml", moved)
    assert run(moved).summary["state_hash"] == first.summary["state_hash"]


def test_unknown_set_of_a_file(box, tmp_path):
    boundary = [{"set": "z*", "component": "z", "velocity": 1}]
    process = launch("run", box, "-q", "-o", tmp_path / "out", *overrides({"boundary": boundary}))
    assert process.returncode == 2 and not (tmp_path / "out").exists()
    assert "boundary[0].set: z*: " in process.stderr and "did you mean 'z-'?" in process.stderr
    assert "allowed: x-, x+, y-, y+, z-, z+" in process.stderr


def test_probe_outside_of_a_file(box, tmp_path):
    probes = [{"name": "in", "at": [0, 0, 0]}, {"name": "out", "at": [0, 0, 1.7e-3]}]
    process = launch("run", box, "-q", "-o", tmp_path / "out", *overrides({"output.probes": probes}), ranks=2)
    assert process.returncode == 2 and not (tmp_path / "out").exists()
    assert "output.probes[1].at: [0, 0, 0.0017]: no element of" in process.stderr


def test_damaged_file_is_refused_by_a_run(box, tmp_path):
    mesh = tmp_path / "box.h5"
    data = bytearray((box.parent / "box.h5").read_bytes())
    with h5py.File(box.parent / "box.h5") as file:
        data[file["neighbour"].id.get_offset() + 100] ^= 4
    mesh.write_bytes(data)
    process = launch("run", file_case(tmp_path, mesh), "-q", "-o", tmp_path / "out", ranks=2)
    assert process.returncode == 2 and not (tmp_path / "out").exists()
    assert "box.h5: neighbour: the checksum of tile 0 is wrong; the file is damaged" in process.stderr


@needs_gmsh
def test_run_on_an_import(run, thesis, tmp_path_factory):
    """The spall test on the unstructured mesh: the wave arrives with the stress of the theory."""
    folder = tmp_path_factory.mktemp("import")
    shutil.copy(thesis("spall-uniform").filename, folder / "bar.h5")
    case = file_case(folder, folder / "bar.h5", example("spall.yaml"))
    sets = {"time.end": 0.2e-6, "output.fields": []}
    one, two = run(case, threads=2, sets=sets), run(case, ranks=2, sets=sets)
    plateau = one.history["time"] > 0.15e-6
    assert one.history["p1mm_szz"][plateau].mean() == pytest.approx(200e6, rel=0.02)
    assert two.summary["state_hash"] == one.summary["state_hash"]


# ---- --info ----


def test_info_of_a_cube(tmp_path):
    sets = {"mesh.cells": [2, 2, 2], "mesh.size": [2, 2, 2], "mesh.jitter": 0}
    convert(CASES / "fragments.yaml", tmp_path / "cube.h5", *overrides(sets))
    process = launch("mesh", "--info", tmp_path / "cube.h5")
    assert process.returncode == 0 and process.stderr == ""
    said = process.stdout
    assert "48 in 48 tiles, 27 vertices, 72 interfaces, 48 surface faces" in said
    assert "volume 8 m3" in said and "1 that share no face: 48 elements" in said
    for side in SIDES:
        assert f"{side}: 8 faces" in said
    # Kuhn's tetrahedron: inradius V/(A/3), circumradius sqrt(3)/2; dihedral angles 45, 60 and 90 degrees
    quality = 3 * 3 / 6 / ((2 * 0.5 + 2 * np.sqrt(2) / 2)) / (np.sqrt(3) / 2)
    assert f"worst {quality:.4g}" in said
    assert "from 45 to 90 degrees" in said
    assert f"{3 / 6 / (np.sqrt(2) / 2):.4g} .. 0.7071 m" in said
    assert re.search(r"0.7071 .. 1.414 s +48", said)
    process = launch("mesh", "--info", tmp_path / "cube.h5", "--case", CASES / "fragments.yaml")
    assert f"{np.sqrt(0.5) / 8905.95:.4g} .. " in process.stdout
