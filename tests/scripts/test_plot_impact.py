"""What bench/studies/plot-impact shows of a plate and prints, against fields made by hand on a small plate."""

import itertools
import math

import numpy as np
import pytest
import synthetic_run as synthetic
from matplotlib.collections import LineCollection, PolyCollection
from pictures import assert_panels_apart, assert_readable, script, texts, title

import rhegma

impact = script("bench/studies/plot-impact")
plt = impact.plt
CELLS, LOW, SIZE = (4, 3, 2), np.array([-2.0, 1.0, -0.5]), np.array([8.0, 6.0, 4.0])  # mm: from (-2, 1, -0.5) to (6, 7, 3.5)
BLOW = (1.0, 3.5)  # mm
KUHN = [(0, 1, 3, 7), (0, 1, 5, 7), (0, 2, 3, 7), (0, 2, 6, 7), (0, 4, 5, 7), (0, 4, 6, 7)]  # corners of a cube, x fastest
CASE = f"""
material: {{model: deshpande-evans, shear: 1.6e9, poisson: 0.25, density: 3000}}
materials: []
interface: {{strength: 250e6, energy: 30}}
bodies: [{{at: [{BLOW[0]}e-3, {BLOW[1]}e-3, 9e-3]}}]
output:
  probes: [{{name: side, at: [0, 0, -0.5e-3]}}, {{name: under, at: [{BLOW[0]}e-3, {BLOW[1]}e-3, -0.5e-3]}}]
  fields: [crack]
"""


def plate_mesh():
    """Nodes of elements that share none, as the program writes them (m), and the elements; cubes of 6 tetrahedra."""
    points = []
    for i, j, k in itertools.product(*(range(n) for n in CELLS)):
        corner = [LOW + SIZE / CELLS * [i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)] for c in range(8)]
        for tet in KUHN:
            four = [corner[c] for c in tet]
            points += four + [(four[a] + four[b]) / 2 for a, b in ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))]
    return 1e-3 * np.array(points), np.arange(len(points)).reshape(-1, 10)


POINTS, TETS = plate_mesh()
CENTRES = 1e3 * POINTS[TETS[:, :4]].mean(axis=1)  # mm
ELEMENTS = len(TETS)


def triangle(centre, normal, size=0.1):
    """A small face with this centre and normal (mm)."""
    normal = np.array(normal, float) / np.linalg.norm(normal)
    right = np.cross(normal, [0.31, 0.52, 0.8])
    right /= np.linalg.norm(right)
    up = np.cross(normal, right)
    return np.array(centre) + size * np.array([right, -0.5 * right + up, -0.5 * right - up])


# centre, normal, damage, rank, time of failure (us)
FACES = [((1.0, 3.5 + 2.0, 3.4), (0, 0, 1), 1.0, 0, 0.9), ((1.0 - 1.5, 3.5, 3.3), (0, 0, 1), 1.0, 1, 0.5),  # top
         ((1.0 + 1.0, 3.5, 1.6), (0, 1, 0), 1.0, 2, 1.1), ((1.0, 3.5 + 0.4, 1.4), (1, 0, 0), 1.0, 3, 0.7),
         # middle, across and in the slab
         ((1.0 + 3.0, 3.5, -0.4), (0, 1, 0), 1.0, 0, 1.4), ((1.0, 3.5 - 2.0, -0.3), (1, 0, 0.2), 1.0, 1, 1.3),  # back, radial
         ((1.0, 3.5 - 1.0, -0.2), (0, 1, 0), 1.0, 2, 1.2),  # back, across the radius
         ((2.0, 5.0, 0.0), (0, 0, 1), 0.998, 3, 0.1)]  # not fully broken


def frame_values(time, faces=FACES, rank=True):
    corners = np.array([triangle(centre, normal) for centre, normal, *_ in faces])
    values = {"time": time, "mean_stress": 1e6 * CENTRES[:, :1],
              "principal_stress": 1e6 * np.column_stack([CENTRES[:, 1], 0 * CENTRES[:, :2]]),
              "stress": 1e6 * np.column_stack([10 + CENTRES[:, 0], *(np.full((2, ELEMENTS), 1e3)), 20 + CENTRES[:, 1],
                                               *np.full((2, ELEMENTS), 1e3)]),
              "crack/points": 1e-3 * corners.reshape(-1, 3), "crack/cells": np.arange(3 * len(faces)).reshape(-1, 3),
              "crack/damage": np.array([[face[2]] for face in faces]),
              "crack/time_of_failure": 1e-6 * np.array([[face[4]] for face in faces])}
    if rank:
        values["crack/rank"] = np.array([[float(face[3])] for face in faces])
    return values


PLATE = impact.Plate(POINTS, TETS, rhegma.parse_yaml(CASE))
FRAME = impact.Frame(frame_values(1.28e-6))
BROKEN = np.array([triangle(centre, normal) for centre, normal, damage, *_ in FACES if damage > 0.999])


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def polygons(collection):
    """Corners of the polygons on paper."""
    return [path.vertices[:-1] for path in collection.get_paths()]


def area(polygon):
    """Signed, of corners in their order."""
    x, y = np.array(polygon).T
    return 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()


# ---- the plate ----


def test_plate():
    assert PLATE.box == pytest.approx(np.array([LOW, LOW + SIZE])) and PLATE.thickness == pytest.approx(4)
    assert PLATE.blow.tolist() == pytest.approx(list(BLOW)) and PLATE.strength == pytest.approx(250)
    assert PLATE.corners == pytest.approx(1e3 * POINTS[TETS[:, :4]])
    areas = [np.linalg.norm(np.cross(b - a, c - a)) / 2 for a, b, c in PLATE.outer]
    assert sum(areas) == pytest.approx(2 * (8 * 6 + 6 * 4 + 4 * 8))  # all of the surface, once
    for triangle_, element in zip(PLATE.outer, PLATE.element):
        assert all((np.abs(PLATE.corners[element] - corner).max(axis=1) < 1e-9).any() for corner in triangle_)


@pytest.mark.parametrize("axis, high, size",
                         [(0, False, 24), (0, True, 24), (1, False, 32), (1, True, 32), (2, False, 48), (2, True, 48)])
def test_sides_of_the_plate(axis, high, size):
    seen = PLATE.outer[PLATE.side(axis, high)]
    assert (np.abs(seen[:, :, axis] - (LOW + high * SIZE)[axis]) < 1e-9).all()
    assert sum(np.linalg.norm(np.cross(b - a, c - a)) / 2 for a, b, c in seen) == pytest.approx(size)


def test_plate_without_a_body_is_hit_in_its_middle():
    case = {**rhegma.parse_yaml(CASE), "bodies": []}
    assert impact.Plate(POINTS, TETS, case).blow == pytest.approx([2, 4])


def test_plate_that_cannot_break():
    with pytest.raises(rhegma.BadInput, match=r"no strength \(interface.strength\)"):
        impact.Plate(POINTS, TETS, {**rhegma.parse_yaml(CASE), "interface": {"law": "none"}})


def test_places_are_told_from_the_blow():
    r, height, quadrant = PLATE.from_blow(np.array([triangle((BLOW[0] + x, BLOW[1] + y, z), (0, 0, 1)) for x, y, z in
                                                    ((3, 4, -0.5), (-3, 4, 3.5), (3, -4, 0.5), (-0.3, -0.4, 1.5))]))
    assert r == pytest.approx([5, 5, 5, 0.5]) and height == pytest.approx([0, 1, 0.25, 0.5])
    assert quadrant.tolist() == [3, 2, 1, 0]


@pytest.mark.parametrize("axis, at", [(1, 3.5), (0, 0.3), (2, 1.6), (1, 3.0)])
def test_section(axis, at):
    """The polygons of a plane through the plate cover its section once, each in the element it belongs to."""
    found, elements = impact.section(PLATE.corners, axis, at)
    others = [k for k in range(3) if k != axis]
    assert sum(abs(area(polygon)) for polygon in found) == pytest.approx(np.prod(SIZE[others]))
    for polygon, element in zip(found, elements):
        assert len(polygon) in (3, 4)
        corners = PLATE.corners[element][:, others]
        assert (np.array(polygon) >= corners.min(axis=0) - 1e-9).all()
        assert (np.array(polygon) <= corners.max(axis=0) + 1e-9).all()


def test_section_of_one_element():
    """A regular corner cut at a quarter: of the height 1 a triangle with sides of 3/4; from the other side the same."""
    tet = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]])
    for order in itertools.permutations(range(4)):
        (polygon,), element = impact.section(tet[:, order], 2, 0.25)
        assert element.tolist() == [0] and np.array(sorted(map(tuple, np.round(polygon, 4)))) == pytest.approx(
            np.array([(0, 0), (0, 0.75), (0.75, 0)]), abs=1e-4)
    quad = np.array([[[0, 0, -1], [1, 0, -1], [0, 0, 1], [0, 1, 1.0]]])  # of edges that cross, a square in their middle
    for order in itertools.permutations(range(4)):
        (polygon,), _ = impact.section(quad[:, order], 2, 0.0)
        assert abs(area(polygon)) == pytest.approx(0.25, rel=1e-4) and len(polygon) == 4
    assert impact.section(tet, 2, 1.5)[0] == [] == impact.section(tet, 2, -0.5)[0]


# ---- pictures ----


def test_frame():
    assert FRAME.time == 1.28e-6 and len(FRAME.faces) == 7 and FRAME.faces == pytest.approx(BROKEN)
    assert FRAME.rank.tolist() == [0, 1, 2, 3, 0, 1, 2]
    assert 1e6 * FRAME.failure == pytest.approx([0.9, 0.5, 1.1, 0.7, 1.4, 1.3, 1.2])
    assert FRAME.mean == pytest.approx(CENTRES[:, 0]) and FRAME.principal == pytest.approx(CENTRES[:, 1])
    assert FRAME.in_plane == pytest.approx(15 + (CENTRES[:, 0] + CENTRES[:, 1]) / 2)
    assert impact.Frame(frame_values(0.0, rank=False)).rank.tolist() == [0] * 7


def collections(axes, kind):
    return [one for one in axes.collections if type(one) is kind]


def assert_values(collection, found, expected):
    """Polygons and their values (MPa), coloured from minus to plus the strength."""
    assert len(polygons(collection)) == len(found)
    for polygon, triangle_ in zip(polygons(collection), found):
        assert polygon == pytest.approx(np.array(triangle_))
    assert np.asarray(collection.get_array()) == pytest.approx(expected)
    assert (collection.norm.vmin, collection.norm.vmax) == pytest.approx((-250, 250))
    assert collection.get_cmap().name == "coolwarm"


def expected_faces(view):
    """The broken faces on paper and their order, the farthest from the eye first."""
    right, up = view
    toward = np.cross(right, up)
    order = np.argsort(BROKEN.mean(axis=1) @ toward)
    return (BROKEN @ np.array(view).T)[order], order


def assert_faces(axes, view, colours, kept=None):
    (outline,), (faces,) = collections(axes, LineCollection), collections(axes, PolyCollection)
    found, order = expected_faces(view)
    if kept is not None:
        inside = [k for k, n in enumerate(order) if kept[n]]
        found, order = found[inside], order[inside]
    assert np.array(polygons(faces)) == pytest.approx(found)
    assert faces.get_facecolors() == pytest.approx(colours[order])
    corners = np.array([corner @ np.array(view).T for corner in itertools.product(*PLATE.box.T)])
    ends = np.array(outline.get_segments())
    assert len(ends) == 12 and ends.reshape(-1, 2).min(axis=0) == pytest.approx(corners.min(axis=0))
    assert ends.reshape(-1, 2).max(axis=0) == pytest.approx(corners.max(axis=0))


def test_edges_of_the_plate():
    view = np.array([[1.0, 0, 0], [0, 0, 1]])
    lengths = [np.abs(np.array(b) - a) for a, b in impact.outline(PLATE.box, view)]
    assert sorted(map(tuple, np.round(lengths, 9))) == [(0, 0)] * 4 + [(0, 4)] * 4 + [(8, 0)] * 4


def test_frame_is_drawn_in_four_panels():
    figure = impact.plot_frame(PLATE, FRAME)
    outside, broken, back, cut, bar = figure.axes
    assert [title(axes) for axes in (outside, broken, back, cut)] == [
        "mean stress", "fully broken faces: 7, coloured by height", "in-plane mean stress on the back face",
        "largest principal stress in the cross-section y = 3.5 mm"]
    view = np.array([[0.80, 0.60, 0.0], [-0.27, 0.36, 0.89]])
    for collection, (axis, high) in zip(outside.collections, ((0, True), (1, False), (2, True))):
        seen = PLATE.side(axis, high)
        assert_values(collection, PLATE.outer[seen] @ view.T, CENTRES[PLATE.element[seen], 0])
    assert len(outside.collections) == 3
    eye = np.cross(*view)
    assert eye[0] > 0 > eye[1] and eye[2] > 0  # so that these three sides are seen
    height = plt.get_cmap("viridis")((BROKEN[:, :, 2].mean(axis=1) + 0.5) / 4)
    assert_faces(broken, view, height)
    under = PLATE.side(2, False)
    assert_values(back.collections[0], PLATE.outer[under][:, :, :2], 15 + CENTRES[PLATE.element[under], :2].mean(axis=1))
    found, elements = impact.section(PLATE.corners, 1, 3.5)
    assert_values(cut.collections[0], found, CENTRES[elements, 1])
    assert bar.get_ylabel() == "MPa" and bar.get_ylim() == pytest.approx((-250, 250))
    assert texts(figure)[0] == "t = 1.28 µs"
    for axes in figure.axes[:4]:
        assert axes.get_aspect() == 1 and not axes.axison and np.ptp(axes.get_xlim()) > 4
        for collection in axes.collections:  # all of it is inside
            limits = collection.get_datalim(axes.transData)
            assert axes.get_xlim()[0] <= limits.x0 and limits.x1 <= axes.get_xlim()[1]
            assert axes.get_ylim()[0] <= limits.y0 and limits.y1 <= axes.get_ylim()[1]
    assert_readable(figure)
    assert_panels_apart(figure)


def test_plate_that_is_whole_is_drawn_too():
    whole = impact.Frame(frame_values(0.5e-6, faces=FACES[-1:]))
    assert title(impact.plot_frame(PLATE, whole).axes[1]).startswith("fully broken faces: 0,")
    assert len(impact.plot_views(PLATE, whole).axes) == 4


def test_slab():
    """Within a quarter of the thickness of y = 3.5 mm, and turned from y by more than 45 degrees."""
    faces = np.array([triangle((0, 3.5 + y, 0), normal, 0.01) for y, normal in (
        (0, (1, 0, 0)), (0.98, (1, 0, 0)), (-0.98, (0, 0, 1)), (1.02, (1, 0, 0)), (-1.02, (1, 0, 0)), (0, (0, 1, 0)),
                                                                                (0, (1, 1.05, 0)),
        (0, (1, 0.95, 0)), (0, (0, -1.05, 1)))] + [triangle((0, 3.5 + 0.9, 0), (1, 0, 0), 0.3)])  # the last one reaches beyond
    inside, width = impact.in_slab(PLATE, faces)
    assert inside.tolist() == [True, True, True, False, False, False, False, True, False, False] and width == pytest.approx(1)


def test_views():
    figure = impact.plot_views(PLATE, FRAME)
    above, below, side, ranks = figure.axes
    assert [title(axes) for axes in figure.axes] == [
        "from above", "from below", "from the side: within 1 mm of y = 3.5 mm, without those that lie in it",
                                                     "from below, coloured by rank"]
    height = plt.get_cmap("viridis")((BROKEN[:, :, 2].mean(axis=1) + 0.5) / 4)
    assert_faces(above, [[1, 0, 0], [0, 1, 0]], height)
    assert_faces(below, [[1, 0, 0], [0, -1, 0]], height)
    assert_faces(side, [[1, 0, 0], [0, 0, 1]], height, kept=[False, True, False, True, False, False, False])
    assert_faces(ranks, [[0.80, 0.60, 0.0], [0.27, -0.36, 0.89]], plt.get_cmap("tab10")(FRAME.rank))
    assert texts(figure)[0] == "fully broken faces at 1.28 µs: yellow at the top, blue at the back"
    assert_readable(figure)
    assert_panels_apart(figure)


def test_ranks_go_round_the_colours():
    many = [(*face[:3], 7 + 10 * k, face[4]) for k, face in enumerate(FACES)]
    figure = impact.plot_views(PLATE, impact.Frame(frame_values(0.0, many)))
    colours = collections(figure.axes[3], PolyCollection)[0].get_facecolors()
    assert colours == pytest.approx(np.tile(plt.get_cmap("tab10")(7), (7, 1)))


# ---- in figures ----


def test_table_of_first_breaks():
    lines = list(impact.table(PLATE, FRAME, synthetic.SUMMARY))
    assert lines[0] == "spall: 12345 elements, 678 steps, 12 s; energy error 0.12 %, 7 faces fully broken"
    assert lines[1].split() == ["where", "faces", "first", "breaks", "at", "radius", "90", "%", "within"]
    assert [line.split() for line in lines[2:]] == [
        ["top", "eighth", "2", "0.50", "us", "1.5", "mm", "1.9", "mm"],
                                                    ["upper", "middle", "1", "1.10", "us", "1.0", "mm", "1.0", "mm"],
        ["lower", "middle", "1", "0.70", "us", "0.4", "mm", "0.4", "mm"],
                                                    ["back", "eighth", "3", "1.20", "us", "1.0", "mm", "2.8", "mm"]]


@pytest.mark.parametrize("height, where",
                         [(0.999, "top"), (0.88, "top"), (0.87, "upper"), (0.51, "upper"), (0.49, "lower"), (0.13, "lower"),
                                           (0.12, "back"), (0.001, "back")])
def test_eighths(height, where):
    faces = [((1, 3.5, -0.5 + 4 * height), (0, 0, 1), 1.0, 0, 1.0)]
    lines = list(impact.table(PLATE, impact.Frame(frame_values(0.0, faces)), synthetic.SUMMARY))
    assert [line.split()[0] for line in lines[2:]] == [where]


def test_shape():
    radii, radial, quadrants = impact.shape(PLATE, FRAME.faces)
    assert radii == [pytest.approx(np.quantile([2.0, 1.5], 0.9)), pytest.approx(np.quantile([1.0, 0.4], 0.9)),
                     pytest.approx(np.quantile([3.0, 2.0, 1.0], 0.9))]
    assert sorted(radial) == pytest.approx([2, 3]) and quadrants.sum() == 7


@pytest.mark.parametrize("height, layer", [(0.76, 0), (0.74, None), (0.99, 0), (0.62, 1), (0.63, None), (0.38, 1), (0.37, None),
                                           (0.24, 2), (0.26, None), (0.01, 2)])
def test_layers(height, layer):
    radii, _, _ = impact.shape(PLATE, np.array([triangle((4, 3.5, -0.5 + 4 * height), (0, 0, 1))]))
    assert radii == [pytest.approx(3) if k == layer else None for k in range(3)]


@pytest.mark.parametrize("normal, height, radial", [
    ((0, 1, 0), 0.1, True), ((0, 1, 0), 0.24, True), ((0, 1, 0), 0.26, False),
    ((0.48, 0.877, 0), 0.1, True), ((0.52, 0.854, 0), 0.1, False),
                                                    ((-0.48, 0.877, 0), 0.1, True),
    ((-0.52, 0.854, 0), 0.1, False), ((0, 0.877, 0.48), 0.1, True), ((0, 0.854, 0.52), 0.1, False),
                                                    ((0, 0.854, -0.52), 0.1, False), ((1, 0, 0), 0.1, False)])
def test_radial_faces(normal, height, radial):
    """A face at (3, 0) from the blow."""
    _, found, _ = impact.shape(PLATE, np.array([triangle((4, 3.5, -0.5 + 4 * height), normal)]))
    assert (found.tolist() == pytest.approx([3])) if radial else not len(found)


def test_table_of_the_shape():
    whole = impact.Frame(frame_values(0.5e-6, faces=FACES[-1:]))
    lines = list(impact.shape_table(PLATE, [whole, FRAME]))
    assert len(lines) == 5
    assert lines[0].split() == ["faces", "90", "%", "within,", "mm:", "radial,", "at", "the", "back", "in", "quadrants"]
    assert lines[1].split() == ["top", "middle", "back"]
    assert lines[2].split() == ["0.50", "us", "0", "-", "-", "-", "none", "0", "0", "0", "0"]
    quadrants = np.bincount(PLATE.from_blow(FRAME.faces)[2], minlength=4)
    assert lines[3].split() == ["1.28", "us", "7", "1.9", "0.9", "2.8", "2,", "to", "3.0", "mm", *map(str, quadrants)]
    assert len(lines[2]) == len(lines[3])


def test_reach_of_radial_faces():
    """99 % of a hundred and one radii from 1 to 2."""
    faces = [((1 + 1 + k / 100, 3.5, 0.0), (0, 1, 0), 1.0, 0, 1.0) for k in range(101)]
    line = list(impact.shape_table(PLATE, [impact.Frame(frame_values(0.0, faces))]))[2]
    assert "101, to 2.0 mm" in line
    assert np.quantile(impact.shape(PLATE, impact.Frame(frame_values(0.0, faces)).faces)[1], 0.99) == pytest.approx(1.99)


def test_arrival_of_the_wave():
    """By a tenth of the most that the first blow brings, whatever comes later than twice the thickness."""
    time = np.linspace(0, 10e-6, 1001)
    speed = np.where(time < 1.5e-6, 0,
                     np.where(time < 1.8e-6, -0.99, np.where(time < 3e-6, -10, np.where(time < 4e-6, 5, -500.0))))
    said = impact.wave(synthetic.structured({"time": time, "b_vz": speed}), "b", 4e-3, 2000.0)
    assert said == "wave at the back at 1.800 us, a tenth of the first blow's speed; plane waves take 2.000 us"


def test_probe_on_the_back():
    case = rhegma.parse_yaml(CASE)
    assert impact.back_probe(case, PLATE) == "under"
    for at, found in (([1e-3, 3.5e-3, -0.497e-3], "p"), ([1e-3, 3.5e-3, -0.49e-3], None), ([1e-3, 3.5e-3, 3.5e-3], None),
                      ([1e-3, 3.51e-3, -0.5e-3], None)):
        assert impact.back_probe({**case, "output": {"probes": [{"name": "p", "at": at}]}}, PLATE) == found


# ---- all of a run ----


def write(directory, case=CASE, frames=None):
    time = np.linspace(0, 6e-6, 601)
    history = {"time": time, "under_vz": -5.0 * (time > 2.5e-6), "side_vz": 0 * time}
    fields = (POINTS, TETS, frames or [frame_values(0.5e-6, FACES[:3]), frame_values(0.8e-6), frame_values(1.28e-6)])
    return synthetic.write_run(directory, case=case, history=history, fields=fields)


PICTURES = ("impact-0.50us.png", "impact-0.80us.png", "impact-1.28us.png", "views.png")


def start(monkeypatch, *words):
    figures = {}
    monkeypatch.setitem(impact.__dict__, "save", lambda figure, path: figures.update({path: figure}))
    monkeypatch.setattr("sys.argv", ["plot-impact", *map(str, words)])
    impact.main()
    return figures


def test_plot_impact(tmp_path, monkeypatch, capsys):
    run = write(tmp_path / "run")
    figures = start(monkeypatch, run, "--out", tmp_path / "out")
    assert list(figures) == [tmp_path / "out" / name for name in PICTURES]
    assert title(figures[tmp_path / "out/impact-0.50us.png"].axes[1]).startswith("fully broken faces: 3,")
    assert "at 1.28 µs" in texts(figures[tmp_path / "out/views.png"])[0]
    said = capsys.readouterr().out.splitlines()
    assert said[0].endswith("7 faces fully broken") and said[6].split()[0] == "faces"
    assert [line.split()[:3] for line in said[8:11]] == [["0.50", "us", "3"], ["0.80", "us", "7"], ["1.28", "us", "7"]]
    speed = math.sqrt(4.8e9 / 3000)
    assert said[-1].startswith("wave at the back at 2.510 us") and said[-1].endswith(f"plane waves take {4e3 / speed:.3f} us")
    assert list(start(monkeypatch, run)) == [run / name for name in PICTURES]


def test_plate_of_two_materials_has_no_time_of_plane_waves(tmp_path, monkeypatch, capsys):
    """Pictures and tables come first."""
    steel = "[{name: steel, model: neo-hookean, young: 1e9, poisson: 0.3, density: 1e3}]"
    with pytest.raises(rhegma.BadInput,
                       match="plane waves through the plate is for bodies of one material; this case has material, steel"):
        start(monkeypatch, write(tmp_path / "run", case=CASE.replace("materials: []", f"materials: {steel}")))
    assert "top and back are quarters" in capsys.readouterr().out


def test_plate_without_probe_and_without_fields(tmp_path, monkeypatch, capsys):
    start(monkeypatch, write(tmp_path / "run", case=CASE.replace("name: under, at: [1.0e-3", "name: under, at: [2e-3")))
    assert "wave at the back" not in capsys.readouterr().out
    values = frame_values(1e-6)
    for name in ("mean_stress", "principal_stress", "stress"):
        frames = [{key: value for key, value in values.items() if key != name}]
        with pytest.raises(rhegma.BadInput, match=f"the run did not write {name}"):
            start(monkeypatch, write(tmp_path / name, frames=frames))
    frames = [{key: value for key, value in values.items() if not key.startswith("crack")}]
    with pytest.raises(rhegma.BadInput, match="the run did not write crack"):
        start(monkeypatch, write(tmp_path / "crack", frames=frames))
