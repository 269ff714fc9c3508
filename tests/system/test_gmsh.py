"""Meshes that Gmsh reads, from files of a few elements: groups, their names and numbers, types of elements, mistakes."""

import re
import shutil
import subprocess

import h5py
import numpy as np
import pytest
from conftest import PROGRAM, launch

pytestmark = pytest.mark.skipif(not PROGRAM.with_name("rhegma-mesh").exists(), reason="rhegma-mesh is not built")

POINTS = {1: (1, 2, 3), 2: (5, 2, 3.5), 3: (1.5, 7, 3), 4: (1, 2.5, 9), 5: (6, 8, 10)}
TRI, QUAD, TET, HEXA, TRI6, TET10 = 2, 3, 4, 5, 9, 11
SOLIDS = [(71, TET, 1, 21, (1, 2, 3, 4)), (72, TET, 2, 22, (2, 3, 4, 5))]  # number, type, group, entity, nodes


def mesh(path, elements, names=(), points=POINTS):
    """A file in Gmsh's format 2.2; names: (dimension, group, name)."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat"]
    if names:
        lines += ["$PhysicalNames", str(len(names)), *(f'{d} {g} "{n}"' for d, g, n in names), "$EndPhysicalNames"]
    lines += ["$Nodes", str(len(points)), *(f"{n} {x} {y} {z}" for n, (x, y, z) in points.items()), "$EndNodes"]
    lines += ["$Elements", str(len(elements)),
              *(f"{number} {kind} 2 {group} {entity} " + " ".join(map(str, nodes))
                for number, kind, group, entity, nodes in elements), "$EndElements", ""]
    path.write_text("\n".join(lines))
    return path


def convert(tmp_path, *arguments, **keys):
    """By the input's numbers of elements: their volume sets, and the sets of their faces; the warnings."""
    source, out = mesh(tmp_path / "a.msh", *arguments, **keys), tmp_path / "a.h5"
    process = launch("mesh", source, "-o", out)
    assert process.returncode == 0, process.stderr
    with h5py.File(out) as file:
        names = {kind: [n.decode() for n in file[kind][:]] if kind in file else [] for kind in ("surface_sets", "volume_sets")}
        region = {int(e): names["volume_sets"][r] if r >= 0 else None for e, r in zip(file["original"], file["region"])}
        faces = {(int(file["original"][e]), int(f)): names["surface_sets"][file["set"][e, f]]
                 for e, f in np.argwhere(file["set"][:] >= 0)}
    return names, region, faces, [line.removeprefix(f"rhegma: warning: {source}") for line in process.stderr.splitlines()]


def refused(tmp_path, *arguments, **keys):
    source, out = mesh(tmp_path / "a.msh", *arguments, **keys), tmp_path / "refused.h5"
    process = launch("mesh", source, "-o", out)
    assert process.returncode == 2 and not out.exists()
    return process.stderr.removeprefix(f"rhegma: {source}: ")


def test_groups_by_name_and_number(tmp_path):
    """A group without a name has its number; with one of that name it is one set; what is in no group is in no set."""
    faces = [(1, TRI, 3, 31, (1, 2, 3)), (2, TRI, 4, 32, (1, 2, 4)), (3, TRI, 5, 33, (1, 3, 4)), (4, TRI, 0, 34, (2, 3, 5)),
             (5, TRI6, 4, 35, (2, 5, 4, 6, 7, 8))]
    middles = {6: (5.5, 5, 6.75), 7: (3.5, 5.25, 9.5), 8: (3, 2.25, 6.25)}
    names, region, marked, said = convert(tmp_path, faces + SOLIDS, [(3, 1, "steel"), (2, 3, "5"), (2, 4, "foot")],
                                          points=POINTS | middles)
    assert names == {"surface_sets": ["5", "foot"], "volume_sets": ["steel", "2"]}
    assert region == {71: "steel", 72: "2"}
    assert marked == {(71, 3): "5", (71, 2): "foot", (71, 1): "5", (72, 1): "foot"}
    assert said == [": 3 nodes belong to no tetrahedron and are left out; the first is node 6 at (5.5, 5, 6.75) m"]


def test_split(tmp_path):
    """A hexahedron, a wedge and a pyramid of Gmsh's types and orders side by side, a quadrangle on top, another between two."""
    points = {1: (0, 0, 0), 2: (1, 0, 0), 3: (1, 1, 0), 4: (0, 1, 0), 5: (0, 0, 1), 6: (1, 0, 1), 7: (1, 1, 1), 8: (0, 1, 1),
              9: (2, 0, 0), 10: (2, 0, 1), 11: (0.5, 0.5, 2), 12: (3, 3, 3)}
    middles = {8: [8, 27, 20], 6: [6, 18, 15], 5: [5, 14, 13]}
    for kinds in ((HEXA, 6, 7, QUAD), (12, 13, 14, 10), (17, 18, 19, 16)):
        order = (HEXA, 12, 17).index(kinds[0])
        solid = [corners + (12,) * (middles[len(corners)][order] - len(corners))
                 for corners in ((1, 2, 3, 4, 5, 6, 7, 8), (2, 9, 3, 6, 10, 7), (5, 6, 7, 8, 11))]
        sides = [corners + (12,) * ((0, 5, 4)[order]) for corners in ((1, 2, 3, 4), (2, 3, 7, 6))]
        elements = [(1, kinds[3], 1, 31, sides[0]), (2, kinds[3], 2, 32, sides[1]), (7, kinds[0], 3, 21, solid[0]),
                    (8, kinds[1], 4, 22, solid[1]), (9, kinds[2], 4, 23, solid[2])]
        assert "--split cuts" in refused(tmp_path, elements, points=points)
        source, out = mesh(tmp_path / "a.msh", elements, points=points), tmp_path / "split.h5"
        process = launch("mesh", source, "-o", out, "--split")
        assert process.returncode == 0, process.stderr
        with h5py.File(out) as file:
            region, sets, inside = file["region"][:], file["set"][:], file["neighbour"][:] >= 0
            assert sorted(file["original"][:]) == [7] * 6 + [8] * 3 + [9] * 2
            assert (region[file["original"][:] == 7] == 0).all() and (region == 1).sum() == 5
            assert (sets == 0).sum() == 2 and not inside[sets == 0].any() and (sets == 1).sum() == 4 and inside[sets == 1].all()
            x = np.zeros((file.attrs["vertices"], 3))
            x[file["vertex"][:]] = file["x"][:]
            c = x[file["corner"][:]]
            assert np.abs(np.linalg.det(c[:, 1:] - c[:, :1])).sum() / 6 == pytest.approx(1 + 0.5 + 1 / 3, rel=1e-14)


def test_size(tmp_path):
    """Of the elements of a geometry: a number, an expression, and along curves; a mesh has its own."""
    (tmp_path / "box.geo").write_text('SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 4, 1, 1};')
    (tmp_path / "ball.geo").write_text('SetFactory("OpenCASCADE"); Sphere(1) = {0, 0, 0, 1};')

    def edges(source, *options):
        """Middles and lengths of edges (m)."""
        process = launch("mesh", tmp_path / source, "-o", tmp_path / "size.h5", "--unit", "cm", *options)
        assert process.returncode == 0, process.stderr
        with h5py.File(tmp_path / "size.h5") as file:
            x = np.zeros((file.attrs["vertices"], 3))
            x[file["vertex"][:]] = file["x"][:]
            ends = x[file["corner"][:][:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]]].reshape(-1, 2, 3)
        return ends.mean(axis=1), np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)

    for size in (0.5, 0.25):
        _, length = edges("box.geo", "--size", size)
        assert 0.9 * size < length.mean() / 1e-2 < 1.25 * size
    middle, length = edges("box.geo", "--size", "x < 2 ? 0.2 : 0.5")
    low, high = (length[(middle[:, 0] > a) & (middle[:, 0] < b)].mean() / 1e-2 for a, b in ((0, 0.015), (0.03, 0.04)))
    assert 0.18 < low < 0.28 and 0.4 < high < 0.65
    coarse, fine = (len(edges("ball.geo", "--curvature", n)[1]) for n in (6, 36))
    assert fine > 3 * coarse
    process = launch("mesh", tmp_path / "box.geo", "-o", tmp_path / "bad.h5", "--size", "x - 1")
    assert process.returncode == 2 and "box.geo: --size: x - 1 is -1 at (0, " in process.stderr
    process = launch("mesh", mesh(tmp_path / "a.msh", SOLIDS), "-o", tmp_path / "bad.h5", "--size", 1)
    assert process.returncode == 2 and "it is a mesh already, so --size and --curvature say nothing" in process.stderr


def test_entities_without_groups(tmp_path):
    faces = [(1, TRI, 0, 31, (1, 2, 3)), (2, TRI, 0, 32, (2, 3, 4))]
    solids = [(number, kind, 0, entity, nodes) for number, kind, _, entity, nodes in SOLIDS]
    names, region, marked, said = convert(tmp_path, faces + solids)
    assert names == {"surface_sets": ["31", "32"], "volume_sets": ["21", "22"]}
    assert region == {71: "21", 72: "22"} and marked == {(71, 3): "31", (71, 0): "32", (72, 3): "32"}
    assert said == [": 1 faces of surface sets lie between elements: interface.sets may name them, boundary leaves them out"]


def test_many_entities(tmp_path):
    faces = [(1000 + n, TRI, 0, 100 + n, (1, 2, 100 + n)) for n in range(1, 301)]
    solids = [(number, kind, 0, entity, nodes) for number, kind, _, entity, nodes in SOLIDS]
    names, _, _, _ = convert(tmp_path, faces + solids, points=POINTS | {100 + n: (n, n * n, 0) for n in range(1, 301)})
    assert names["surface_sets"] == [str(100 + n) for n in range(1, 301)]


def test_entities_in_several_groups(tmp_path):
    """In format 4, where an entity has a list of them."""
    (tmp_path / "a.msh").write_text("""$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
5
2 1 "foot"
2 2 "all"
3 1 "steel"
3 2 "half"
3 3 "whole"
$EndPhysicalNames
$Entities
0 0 2 2
31 0 0 0 9 9 9 2 1 2 0
32 0 0 0 9 9 9 1 2 0
21 0 0 0 9 9 9 2 3 1 0
22 0 0 0 9 9 9 2 2 3 0
$EndEntities
$Nodes
1 5 1 5
3 21 0 5
1\n2\n3\n4\n5
1 2 3\n5 2 3.5\n1.5 7 3\n1 2.5 9\n6 8 10
$EndNodes
$Elements
4 4 1 72
2 31 2 1
1 1 2 3
2 32 2 1
2 1 2 4
3 21 4 1
71 1 2 3 4
3 22 4 1
72 2 3 4 5
$EndElements
""")
    process = launch("mesh", tmp_path / "a.msh", "-o", tmp_path / "a.h5")
    assert process.returncode == 0 and process.stderr == "", process.stderr
    with h5py.File(tmp_path / "a.h5") as file:
        def members(kind, group):
            names = [n.decode() for n in file[f"{kind}_sets"][:]]
            combined = [[names[s] for c, s in file[f"{kind}_combinations"][:] if c == group - len(names)]
                        if f"{kind}_combinations" in file else []]
            return [] if group < 0 else [names[group]] if group < len(names) else combined[0]

        of = {int(e): members("volume", g) for e, g in zip(file["original"], file["region"])}
        faces = {(int(file["original"][e]), int(f)): members("surface", file["set"][e, f])
                 for e, f in np.argwhere(file["set"][:] >= 0)}
    assert of == {71: ["steel", "whole"], 72: ["half", "whole"]}
    assert faces == {(71, 3): ["foot", "all"], (71, 2): ["all"]}


def test_what_is_in_no_physical_volume(tmp_path):
    solids = [SOLIDS[0], (72, TET, 0, 22, (2, 3, 4, 5)), (73, TET, 0, 23, (1, 2, 3, 5))]
    names, region, _, said = convert(tmp_path, solids)
    assert region == {71: "1"} and names["volume_sets"] == ["1"]
    assert ": 2 elements are in no physical volume and left out" in said


def test_groups_of_points_are_told(tmp_path):
    points = [(n, 15, n, n, (1,)) for n in range(1, 7)]
    said = ": physical groups of points name no faces: {} are left out: 'tip', '2'{}; a probe takes a place"
    for count, more in ((2, ""), (6, ", '3', '4', '5', ...")):
        assert said.format(count, more) in convert(tmp_path, points[:count] + SOLIDS, [(0, 1, "tip")])[3]


def test_second_order(tmp_path):
    ends = [(1, 2), (2, 3), (3, 1), (4, 1), (4, 3), (4, 2)]  # in Gmsh's order
    points = POINTS | {10 + k: tuple((p + q) / 2 for p, q in zip(POINTS[a], POINTS[b])) for k, (a, b) in enumerate(ends)}
    del points[5]
    solid = [(71, TET10, 1, 21, (1, 2, 3, 4, *range(10, 16)))]
    _, region, _, said = convert(tmp_path, solid, points=points)
    assert region == {71: "1"} and said == []
    for k in (4, 5):  # Abaqus has these two the other way round
        moved = points | {10 + k: (points[10 + k][0] + 0.5, *points[10 + k][1:])}
        _, _, _, said = convert(tmp_path, solid, points=moved)
        far = 0.5 / np.linalg.norm(np.subtract(POINTS[ends[k][0]], POINTS[ends[k][1]]))
        assert said == [": second-order elements are taken by their corners: 1 of 6 mid-nodes are off straight by more than "
                        f"1e-06 of their edge, by {far:.2g} at most"]


CUBE = {n + 1: (n & 1, n >> 1 & 1, n >> 2) for n in range(8)}
HEX = (9, HEXA, 1, 21, (1, 2, 4, 3, 5, 6, 8, 7))


def test_other_elements(tmp_path):
    said = refused(tmp_path, [HEX], points=CUBE)
    assert said == ("1 elements of type 'Hexahedron 8', the first of them element 9; only tetrahedra of first and second order "
                    "are possible; --split cuts hexahedra, wedges and pyramids\n")
    said = refused(tmp_path, [(7, QUAD, 3, 31, (1, 2, 5, 3)), *SOLIDS])
    assert said == ("1 elements of type 'Quadrilateral 4', the first of them element 7; only tetrahedra of first and second "
                    "order are possible; --split cuts hexahedra, wedges and pyramids\n")
    _, region, _, said = convert(tmp_path, [(8, TRI, 3, 32, (1, 2, 3)), (7, QUAD, 0, 31, (1, 2, 5, 3)), *SOLIDS])
    assert len(region) == 2 and said == []


def test_names_that_are_too_long(tmp_path):
    """Gmsh cuts names behind 253 bytes: what may have been cut is refused."""
    face = (1, TRI, 3, 31, (1, 2, 3))
    names, _, marked, _ = convert(tmp_path, [face, *SOLIDS], [(2, 3, 252 * "n")])
    assert names["surface_sets"] == [252 * "n"]
    for length in (253, 300):
        said = refused(tmp_path, [face, *SOLIDS], [(2, 3, length * "n")])
        assert said == f"physical group '{253 * 'n'}...': its name is longer than 252 bytes, and Gmsh cut it\n"


@pytest.mark.parametrize("name", ["broken.geo", "broken.diff"])
def test_what_ends_gmsh_ends_in_a_message(tmp_path, name):
    """An exception that nobody catches, and an access to memory that is not there."""
    texts = {"broken.geo": """Mesh.RandomFactor = 1e-1; Mesh.CharacteristicLengthMax = 0.1; Mesh.Algorithm = 5;
                 Point(1) = {0,0,0}; Point(2) = {1,0,0}; Point(3) = {1,1,0}; Point(4) = {0,1,0};
                 Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};
                 Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1};
                 out[] = Extrude {0,0,0.1} { Surface{1}; Layers{1}; };
                 Physical Volume("v") = {out[1]};""",
             "broken.diff": "\n\n Finite element mesh (GridFE):\n\n  Number of space dim. = 3\n  Number of elements = 999999999\n"}
    (tmp_path / name).write_text(texts[name] + "\n")
    process = launch("mesh", tmp_path / name, "-o", tmp_path / "a.h5")
    assert process.returncode == 2 and not (tmp_path / "a.h5").exists()
    assert re.search(rf"^rhegma: {tmp_path}/{name}: Gmsh(:| broke down on it \((Aborted|Segmentation fault)\):)", process.stderr, re.M), process.stderr


@pytest.mark.parametrize("unit, size", [("MILLI", 1e-3), ("$", 1)])
def test_the_unit_of_a_geometry_is_its_own(tmp_path, unit, size):
    """A STEP file of a box of 3, as Gmsh writes it in mm, and with the unit replaced."""
    gmsh = shutil.which("gmsh")
    if gmsh is None:
        pytest.skip("no Gmsh here")
    (tmp_path / "box.geo").write_text('SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 3, 2, 1}; Save "box.step";\n')
    subprocess.run([gmsh, "-0", tmp_path / "box.geo", "-o", tmp_path / "box.step"], capture_output=True, timeout=100, check=True)
    step = (tmp_path / "box.step").read_text()
    assert "SI_UNIT(.MILLI.,.METRE.)" in step
    (tmp_path / "box.step").write_text(step.replace(".MILLI.,.METRE.", f".{unit}.,.METRE." if unit != "$" else "$,.METRE."))
    for scale, said in ((1, ""), (2, "the file says its unit, so its lengths are in m already; --scale multiplies them by 2")):
        process = launch("mesh", tmp_path / "box.step", "-o", tmp_path / "a.h5", "--scale", scale)
        assert process.returncode == 0 and said in process.stderr and bool(said) == bool(process.stderr)
        with h5py.File(tmp_path / "a.h5") as file:
            assert np.ptp(file.attrs["box"], axis=0) == pytest.approx(np.array([3, 2, 1]) * size * scale, rel=1e-9)


def test_reasons(tmp_path):
    process = launch("mesh", tmp_path / "none.msh", "-o", tmp_path / "a.h5")
    assert process.returncode == 2 and process.stderr == f"rhegma: {tmp_path / 'none.msh'}: cannot be read: No such file or directory\n"
    (tmp_path / "b.geo").write_text("Box(1) = {0, 0, 0, 1, 1\n")
    process = launch("mesh", tmp_path / "b.geo", "-o", tmp_path / "a.h5")
    assert process.returncode == 2 and re.match(rf"rhegma: {tmp_path}/b.geo: Gmsh: '.*b.geo', line \d+: syntax error", process.stderr)
    process = launch("mesh", tmp_path / "b.geo", "-o", tmp_path / "a.h5", "--scale", "0")
    assert "--scale must be a number > 0" in process.stderr
