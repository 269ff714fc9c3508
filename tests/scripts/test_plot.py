"""What the pictures of bench/plot show: lines, labels, units and places, against the run's own tables and closed forms."""

import itertools

import numpy as np
import pytest
import synthetic_run as synthetic
from conftest import example
from matplotlib.colors import to_rgba
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from pictures import (assert_panels_apart, assert_readable, labels, legend, line, on_paper, script, segments, style, texts,
                      title)

plot = script("bench/plot")
rhegma, plt = plot.rhegma, plot.plt
CASE = rhegma.parse_yaml(synthetic.SPALL)
PROBES = [("p-1", [0.0, 0.5, 1.0]), ("low", [0.0, 0.0, -2.0])]
TIME = np.linspace(0, 8.8e-3, 45)  # a step before 7/c = 5.5 ms, the last event of the probe p-1, and beyond
VIEW = plot.View("stress", "zz", 2)
HISTORY = synthetic.structured({"time": TIME, "p-1_szz": 30e6 * np.sin(900 * TIME), "low_szz": -55e6 * np.sin(700 * TIME) ** 2,
                                "p-1_sxx": 0 * TIME, "low_sxx": 0 * TIME})


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


# ---- history.png ----


@pytest.fixture(scope="module")
def history():
    return plot.plot_history(HISTORY, CASE, PROBES, VIEW, synthetic.SUMMARY)


def test_history_draws_the_stress_of_each_probe(history):
    assert len(history.axes) == len(PROBES)
    for axes, (name, _) in zip(history.axes, PROBES):
        time, stress = line(axes, "computed")  # ms and MPa
        assert time == pytest.approx(1e3 * HISTORY["time"], rel=1e-12)
        assert stress == pytest.approx(1e-6 * HISTORY[f"{name}_szz"], rel=1e-12)
        assert axes.get_ylabel() == "σ$_{zz}$ (MPa)"
        assert axes.get_xlim() == pytest.approx((0, 8.8))
    assert [title(axes) for axes in history.axes] == ["p-1   at (0, 0.5, 1) m", "low   at (0, 0, -2) m"]
    assert [axes.get_xlabel() for axes in history.axes] == ["", "time (ms)"]


def test_history_draws_theory(history):
    theory = plot.theory.Spall(CASE)
    for axes, (_, at) in zip(history.axes, PROBES):
        time, stress = line(axes, "1-D theory")
        assert time[0] == 0 and time[-1] == pytest.approx(8.8) and len(time) > 1000
        assert 1e6 * stress == pytest.approx(theory.stress(at[2], 1e-3 * time), rel=1e-9, abs=1)


def test_history_marks_events_and_fracture(history):
    speed = np.sqrt(1.6e6)
    for axes, z in zip(history.axes, (1.0, 2.0)):
        expected = [(1e3 * (4 - z) / speed, "wave arrives"), (1e3 * 4 / speed, "waves meet"),
                    (1e3 * (4 + z) / speed, "unloading arrives" if plot.theory.Spall(CASE).breaks else "second wave arrives")]
        words = [(text.xy[0], text.get_text()) for text in axes.texts]
        assert words == [(pytest.approx(time), f"{name}\n{time:.4f}") for time, name in expected]
        assert all(text.xy[1] == 1 for text in axes.texts)  # at the top
        lines = sorted(one.get_xdata()[0] for one in axes.get_lines() if one.get_linestyle() == ":")
        assert lines == pytest.approx([time for time, _ in expected])
        time, _ = line(axes, "first fracture")
        assert time == pytest.approx([4.2, 4.2])


def test_history_has_the_unit_of_the_largest_stress():
    for name in ("p-1", "low"):
        large = HISTORY.copy()
        large[f"{name}_szz"] *= 100
        figure = plot.plot_history(large, CASE, PROBES, VIEW, synthetic.SUMMARY)
        assert [axes.get_ylabel() for axes in figure.axes] == ["σ$_{zz}$ (GPa)"] * 2


def test_history_leaves_out_events_after_the_end():
    early = HISTORY[TIME < 3.1e-3]
    axes = plot.plot_history(early, CASE, PROBES[:1], VIEW, synthetic.SUMMARY).axes[0]
    assert [text.get_text().split("\n")[0] for text in axes.texts] == ["wave arrives"]


def test_history_says_what_it_is(history):
    bar = plot.theory.Spall(CASE)
    assert texts(history)[0] == (f"spall: stress at the probes\n1-D theory: c$_d$ = {bar.speed:.0f} m/s, incident "
                                 f"{bar.high / 1e6:.4g} MPa, meeting at {4e3 / bar.speed:.4g} ms, where the bar breaks")
    assert sorted(legend(history.axes[0])) == ["1-D theory", "computed", "first fracture"]
    assert history.axes[1].get_legend() is None
    for label, colour, dashes in (("computed", plot.BLUE, "-"), ("1-D theory", plot.INK, "--"),
                                  ("first fracture", plot.RED, "-.")):
        assert style(history.axes[0], label)[:2] == (to_rgba(colour), dashes)


def test_history_can_be_read(history):
    assert_readable(history)
    assert_panels_apart(history)
    for axes in history.axes:  # the words of the events lie above the curves
        top = max(line(axes, "computed")[1].max(), line(axes, "1-D theory")[1].max())
        edge = axes.transData.transform((0, top))[1]
        frame = axes.get_window_extent()
        assert all(text.get_window_extent().y0 > edge and text.get_window_extent().y1 <= frame.y1 for text in axes.texts)
        assert 0.6 < (edge - frame.y0) / frame.height < 0.75  # and leave room for these
    assert len({text.get_window_extent().y0 // 3 for text in history.axes[0].get_legend().get_texts()}) == 1  # in a row
    width, height = history.get_size_inches()
    assert 8 < width < 12 and height == pytest.approx(1.2 + 2 * 3.2)
    assert all(0.65 < axes.get_position().width for axes in history.axes)


def test_history_of_uneven_pulls_names_both():
    boundary = [{**motion, "velocity": {"z+": 7, "z-": -3.5}.get(motion["set"], 0)} for motion in CASE["boundary"]]
    case = {**CASE, "boundary": boundary, "interface": {"strength": 1e9, "energy": 1}}
    heading = texts(plot.plot_history(HISTORY, case, PROBES, VIEW, synthetic.SUMMARY))[0]
    impedance = 3000 * np.sqrt(1.6e6) / 1e6
    assert f"incident {3.5 * impedance:.4g} and {7 * impedance:.4g} MPa, meeting at" in heading and "breaks" not in heading


@pytest.mark.parametrize("sections", [{"boundary": []}, {"materials": [{**CASE["material"], "name": "steel"}]}])
def test_history_draws_no_theory_where_there_is_none(sections):
    """In particular of bars of two materials."""
    figure = plot.plot_history(HISTORY, {**CASE, **sections}, PROBES, VIEW, {**synthetic.SUMMARY, "first_fracture_time_s": None})
    assert texts(figure)[0] == "spall: stress at the probes"
    assert [labels(axes) for axes in figure.axes] == [["computed"], ["computed"]]
    assert not any(axes.texts for axes in figure.axes)


def test_history_of_the_first_moment_alone():
    axes = plot.plot_history(HISTORY[:1], CASE, PROBES[:1], VIEW, synthetic.SUMMARY).axes[0]
    assert line(axes, "computed")[0] == [0] and axes.get_xlim()[0] == 0 < axes.get_xlim()[1]


# ---- energy.png ----

ENERGY = synthetic.structured(synthetic.energy())


def test_energy_draws_every_part():
    figure = plot.plot_energy(ENERGY, synthetic.SUMMARY)
    upper, lower = figure.axes
    total = "total: sum of the parts\nless work and half_kick"
    assert labels(upper) == [*synthetic.ENERGIES, "external work", total, "first fracture"] == legend(upper)
    for name in (*synthetic.ENERGIES, "external work", total):
        time, value = line(upper, name)  # ms and mJ
        assert time == pytest.approx([1, 2, 3, 4])
        column = {"external work": "external_work", total: "total"}.get(name, name)
        assert value == pytest.approx(1e3 * ENERGY[column], rel=1e-12)
    assert len({style(upper, label) for label in labels(upper)}) == len(labels(upper))
    assert all(style(upper, name)[0] == to_rgba(colour) for name, colour in plot.PARTS.items())
    assert line(upper, "first fracture")[0] == pytest.approx([4.2, 4.2])
    assert upper.get_ylabel() == "energy (mJ)" and upper.get_xlabel() == ""
    time, error = lower.get_lines()[0].get_xydata().T
    assert time == pytest.approx([1, 2, 3, 4]) and error == pytest.approx(100 * ENERGY["error_rel"])
    assert (lower.get_ylabel(), lower.get_xlabel()) == ("error (%)", "time (ms)")
    assert lower.get_xlim() == pytest.approx((1, 4)) == upper.get_xlim()
    assert title(lower) == "relative energy error, at most 0.25 %"
    assert texts(figure)[0] == "spall: energy ledger" and figure.get_size_inches() == pytest.approx((9, 6.4))
    assert_readable(figure)
    assert_panels_apart(figure)
    assert upper.get_position().height == pytest.approx(3 * lower.get_position().height, rel=0.05)
    right = upper.get_legend().get_window_extent()
    assert right.x0 >= upper.get_window_extent().x1 and right.x1 <= figure.bbox.width


def test_energy_leaves_out_rare_parts_that_are_nothing():
    quiet = {name: np.zeros(4) for name in synthetic.ENERGIES}
    for present in ("plastic", "damage", "viscous", "friction"):
        table = synthetic.structured(synthetic.energy(**{**quiet, present: np.array([0, 0, 0, -1e-6])}))
        shown = labels(plot.plot_energy(table, {**synthetic.SUMMARY, "first_fracture_time_s": None}).axes[0])
        assert shown[:-2] == ["kinetic", "bodies", "bulk", "penalty", "cohesive", "contact", "dissipated", present]


@pytest.mark.parametrize("end, unit, factor", [(0.15e-6, "µs", 1e6), (0.09e-6, "ns", 1e9)])
def test_times_have_their_unit(end, unit, factor):
    table, history = ENERGY.copy(), HISTORY.copy()
    table["time"] *= end / table["time"][-1]
    history["time"] *= end / history["time"][-1]
    lower = plot.plot_energy(table, synthetic.SUMMARY).axes[1]
    assert lower.get_xlabel() == f"time ({unit})" and lower.get_xlim() == pytest.approx((end * factor / 4, end * factor))
    axes = plot.plot_history(history, CASE, PROBES[:1], VIEW, synthetic.SUMMARY).axes[0]
    assert axes.get_xlabel() == f"time ({unit})" and axes.get_xlim() == pytest.approx((0, end * factor))
    fragments = synthetic.structured({"time": [end / 2, end], "id": [0, 0], "mass": [1.0, 1]})
    assert plot.plot_fragments(fragments, synthetic.SUMMARY).axes[0].get_xlabel() == f"time ({unit})"


def test_energy_that_is_not_finite_and_of_one_moment():
    columns = synthetic.energy(rows=1)
    columns["error_rel"] = np.array([-3e-4])
    figure = plot.plot_energy(synthetic.structured(columns), synthetic.SUMMARY)
    assert title(figure.axes[1]).endswith("at most 0.03 %")
    broken = ENERGY.copy()
    broken["kinetic"][-1] = broken["error_rel"][-1] = np.nan
    most = 100 * abs(ENERGY["error_rel"][:3]).max()
    assert title(plot.plot_energy(broken, synthetic.SUMMARY).axes[1]).endswith(f"at most {most:.3g} %")


@pytest.mark.parametrize("name", [*synthetic.ENERGIES, "external_work", "total"])
def test_energy_has_the_unit_of_the_largest(name):
    table = ENERGY.copy()
    table[name][1] = -2.5e3
    assert plot.plot_energy(table, synthetic.SUMMARY).axes[0].get_ylabel() == "energy (kJ)"


# ---- fragments.png ----


def test_fragments():
    table = synthetic.structured({"time": [0.0, 0, 2e-3, 2e-3, 2e-3, *[5e-3] * 5], "id": [0, 1, 0, 1, 2, *range(5)],
                                  "mass": [5.0, 5.0, 2, 3, 5, 5, 1, 2, 0.5, 1.5]})
    figure = plot.plot_fragments(table, synthetic.SUMMARY)
    left, right = figure.axes
    (counts,), (heavier,) = left.get_lines(), right.get_lines()
    assert counts.get_xydata().tolist() == [[0, 2], [2, 3], [5, 5]] and counts.get_drawstyle() == "steps-post"
    assert (left.get_xlabel(), left.get_ylabel(), left.get_ylim()[0]) == ("time (ms)", "fragments", 0)
    assert heavier.get_xydata() == pytest.approx(np.array([[0.05, 5], [0.1, 4], [0.15, 3], [0.2, 2], [0.5, 1]]))
    assert heavier.get_drawstyle() == "steps-pre"
    assert (right.get_xscale(), right.get_yscale(), left.get_xscale(), left.get_yscale()) == ("log", "log", "linear", "linear")
    assert (right.get_xlabel(), right.get_ylabel()) == ("mass m / mass of the body", "fragments of mass m or more")
    assert texts(figure)[0] == "spall: 5 fragments at 5 ms, the heaviest 50 % of the body"
    assert figure.get_size_inches() == pytest.approx((10, 4.2))
    assert_readable(figure)
    assert_panels_apart(figure)


def test_few_fragments_have_no_distribution():
    table = synthetic.structured({"time": [2e-3] * 5 + [5e-3] * 4, "id": [*range(5), *range(4)], "mass": np.ones(9)})
    (axes,) = plot.plot_fragments(table, synthetic.SUMMARY).axes
    assert axes.get_lines()[0].get_ydata().tolist() == [5, 4]


# ---- crack.png ----

BOX = np.array([[-1.0, -1.5, -4.0], [1.0, 1.5, 4.0]])  # 2 x 3 x 8 m
ACROSS = np.array([[[-1, -1.5, 0.1], [1, -1.5, 0.1], [1, 1.5, 0.1]], [[-1, -1.5, 0.1], [1, 1.5, 0.1], [-1, 1.5, 0.1]],
                   [[0, 0, 0.4], [0, 1, 0.4], [0, 0, 1.0]]])  # the section, and a triangle of 0.3 m2 along the bar
DAMAGE = np.array([0.2, 0.9, 1 - 1e-15])  # the mean of points that all are 1


@pytest.fixture(scope="module")
def broken():
    return plot.plot_crack(BOX, 4.4e-3, ACROSS, DAMAGE, 2, synthetic.SUMMARY)


def collections(axes, kind):
    return [one for one in axes.collections if type(one) is kind]


def test_crack_is_drawn_where_it_is(broken):
    """The longest side lies on paper, axes in cyclic order: (z, x, y)."""
    whole, detail = broken.axes[:2]
    assert [(axes.elev, axes.azim) for axes in (whole, detail)] == [(17, -68), (20, -48)]
    for axes in (whole, detail):
        walls, crack = collections(axes, Poly3DCollection)
        assert np.array(segments(crack)) == pytest.approx(ACROSS[:, :, [2, 0, 1]])
        assert len(segments(walls)) == 3
        assert (axes.get_xlim()[0] == -4) == (axes is whole)
    colours = plot.matplotlib.colormaps["YlOrRd"](DAMAGE)
    light = np.array([0.55, -0.65, 0.53]) / np.linalg.norm([0.55, -0.65, 0.53])
    turned = np.array([[1.0, 0, 0], [1, 0, 0], [0, 1, 0]])  # normals z, z, x in the order of the paper
    expected = colours[:, :3] * (0.62 + 0.38 * np.abs(turned @ light))[:, None]
    for axes in (whole, detail):
        paint = collections(axes, Poly3DCollection)[1]._facecolor3d
        assert paint[:, :3] == pytest.approx(expected) and (paint[:, 3] == 1).all()


def test_close_up_is_around_the_crack(broken):
    detail = broken.axes[1]
    assert detail.get_xlim() == pytest.approx((0.1 - 0.3 * 3, 1.0 + 0.3 * 3))
    assert detail.get_ylim() == (-1, 1) and detail.get_zlim() == (-1.5, 1.5)


@pytest.mark.parametrize("low, high, expected", [(0.1, 0.5, (-0.2, 0.8)), (-4, -3.7, (-4, -3.4)), (3.9, 4, (3.6, 4)),
                                                 (-2.0, 1.3, (-2.3, 1.6)), (-2.0, 1.5, None), (-4, 4, None)])
def test_close_up_keeps_to_the_body_and_to_where_it_helps(low, high, expected):
    limits = np.array([[-4, 0, 0], [4, 1.0, 0.5]])
    part = plot.close_up(limits, np.array([[[low, 0, 0], [low, 1, 0], [high, 0, 0]]]))
    if expected is None:
        assert part is None
    else:
        assert part[:, 0] == pytest.approx(expected) and part[:, 1:].tolist() == limits[:, 1:].tolist()
    assert limits[:, 0].tolist() == [-4, 4]


def test_bar_without_close_up_has_a_wide_profile():
    scattered = np.concatenate([ACROSS, ACROSS + [0, 0, -3.5]])
    figure = plot.plot_crack(BOX, 4.4e-3, scattered, np.ones(6), 2, synthetic.SUMMARY)
    whole, colours, profile = figure.axes
    assert profile.get_position().width > 0.85 and sum(profile.get_position().intervalx) == pytest.approx(1, abs=0.05)
    assert_panels_apart_but_views(figure)
    assert_readable(figure)


def assert_panels_apart_but_views(figure):
    """Colours and profile lie apart from each other and from what the views show."""
    flat = [axes.get_position() for axes in figure.axes if axes.name != "3d"]
    views = [on_paper(axes, corners_of(axes)) for axes in figure.axes if axes.name == "3d"]
    boxes = [(box.x0, box.y0, box.x1, box.y1) for box in flat] + [(*v.min(axis=0), *v.max(axis=0)) for v in views]
    for box in boxes:
        assert min(box) >= 0 and max(box) <= 1
    for a, b in itertools.combinations(boxes, 2):
        assert min(a[2], b[2]) <= max(a[0], b[0]) or min(a[3], b[3]) <= max(a[1], b[1]), (a, b)


def corners_of(axes):
    return list(itertools.product(axes.get_xlim(), axes.get_ylim(), axes.get_zlim()))


def test_crack_has_its_parts_in_their_places(broken):
    """The whole across the top, the close-up below at the left, the profile beside it."""
    whole, detail, _, profile = broken.axes
    for axes, place in ((whole, (0.07, 0.5, 0.93, 0.84)), (detail, (0.07, 0.06, 0.39, 0.48))):
        seen = on_paper(axes, corners_of(axes))
        middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
        assert middle == pytest.approx([(place[0] + place[2]) / 2, (place[1] + place[3]) / 2], abs=2e-3)
        assert (np.ptp(seen, axis=0) / [place[2] - place[0], place[3] - place[1]]).max() == pytest.approx(1, abs=5e-3)
    box = profile.get_position()
    assert (box.x0, box.y0, box.x1, box.y1) == pytest.approx((0.5, 0.1, 0.96, 0.36))


def test_crack_can_be_read(broken):
    assert_readable(broken)
    caption, colours = broken.texts[1].get_window_extent(), broken.axes[2].get_tightbbox()
    assert caption.x1 + 5 < colours.x0
    assert_panels_apart_but_views(broken)
    assert broken.get_size_inches() == pytest.approx((11, 6.8))


@pytest.mark.parametrize("place", [(0.07, 0.5, 0.86, 0.34), (0.3, 0.1, 0.2, 0.8)])
@pytest.mark.parametrize("limits", [BOX[:, [2, 0, 1]], np.array([[0, 0, 0], [1e-3, 2e-3, 3e-3]])])
def test_view_fills_its_place(place, limits):
    figure = plt.figure(figsize=(11, 6.8))
    axes = plot.open_view(figure, limits, (17, -68), place)
    seen = on_paper(axes, corners_of(axes))
    low, high = seen.min(axis=0), seen.max(axis=0)
    assert (low + high) / 2 == pytest.approx([place[0] + place[2] / 2, place[1] + place[3] / 2], abs=2e-3)
    room = (high - low) / place[2:]
    assert room.max() == pytest.approx(1, abs=5e-3)
    assert (axes.elev, axes.azim) == (17, -68) and not axes.axison and not axes.patch.get_visible()
    assert [axes.get_xlim(), axes.get_ylim(), axes.get_zlim()] == [tuple(pair) for pair in limits.T]


def test_view_is_not_squeezed():
    """A cube: its edges on paper are as long as the same cube's in a square figure, whatever the shape of the figure."""
    ratios = []
    for size in ((5, 5), (11, 6.8)):
        figure = plt.figure(figsize=size)
        axes = plot.open_view(figure, np.array([[0, 0, 0], [1.0, 1, 1]]), (20, -48), (0.1, 0.1, 0.8, 0.8))
        corner, *others = on_paper(axes, [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) * figure.get_size_inches()
        lengths = [np.linalg.norm(other - corner) for other in others]
        ratios.append([lengths[0] / lengths[2], lengths[1] / lengths[2]])
    assert ratios[0] == pytest.approx(ratios[1], rel=0.01)


def test_perspective_makes_what_is_near_larger():
    figure = plt.figure(figsize=(6, 6))
    axes = plot.open_view(figure, np.array([[0, 0, 0], [1.0, 1, 1]]), (0, -90), (0.1, 0.1, 0.8, 0.8))  # eye at -y
    low, high, low_far, high_far = on_paper(axes, [[0, 0, 0], [0, 0, 1], [0, 1, 0], [0, 1, 1]])
    assert 1.02 < (high - low)[1] / (high_far - low_far)[1] < 1.5


def test_order_on_paper():
    assert plot.lying(np.array([1, 2, 3])) == (2, 0, 1)
    assert plot.lying(np.array([3, 1, 2])) == (0, 1, 2)
    assert plot.lying(np.array([2, 3, 1])) == (1, 2, 0)
    assert plot.lying(np.array([3, 3, 1])) == (0, 1, 2)  # of two that lie, the lower one
    assert plot.lying(np.array([3, 1, 3])) == (2, 0, 1)


def test_sides_of_a_box():
    edges, faces = plot.sides_of(BOX)
    assert len(edges) == 12 and len({tuple(sorted(map(tuple, edge))) for edge in edges}) == 12
    assert sorted(np.abs(a - b).sum() for a, b in edges) == [2] * 4 + [3] * 4 + [8] * 4
    assert all(np.count_nonzero(a != b) == 1 for a, b in edges)
    assert len(faces) == 6
    planes = set()
    for face in faces:
        steps = np.roll(face, -1, axis=0) - face
        assert (np.count_nonzero(steps, axis=1) == 1).all()  # around it, along its edges
        (axis,) = np.nonzero(np.ptp(face, axis=0) == 0)[0]
        planes.add((axis, face[0, axis]))
    assert len(planes) == 6


@pytest.mark.parametrize("view, farthest", [((17, -68), (-1, 1.5, -4)), ((17, 22), (-1, -1.5, -4)), ((-17, 112), (1, -1.5, 4)),
                                            ((17, 202), (1, 1.5, -4))])
def test_walls_behind_the_body(view, farthest):
    """The eye is up at elevation and azimuth; the corner farthest from it belongs to three faces and three edges."""
    edges, faces = plot.sides_of(BOX)
    is_behind = plot.behind(BOX, view)
    for sides, number in ((edges, 3), (faces, 3)):
        hidden = [side for side in sides if is_behind(side)]
        assert len(hidden) == number and all((np.array(side) == farthest).all(axis=1).any() for side in hidden)


def test_front_edges_lie_on_the_crack_and_hidden_ones_behind(broken):
    whole = broken.axes[0]
    walls, crack = collections(whole, Poly3DCollection)
    hidden, front = collections(whole, Line3DCollection)
    assert (len(segments(hidden)), len(segments(front))) == (3, 9)
    assert walls.get_zorder() < hidden.get_zorder() < crack.get_zorder() < front.get_zorder()
    assert not whole.computed_zorder
    assert to_rgba(hidden.get_colors()[0]) != to_rgba(front.get_colors()[0])


def test_sides_are_named_with_their_lengths():
    box = BOX + [[10, 20, 30]]  # whose middle is no zero
    whole = plot.plot_crack(box, 4.4e-3, ACROSS + [10, 20, 30], DAMAGE, 2, synthetic.SUMMARY).axes[0]
    assert [text.get_text() for text in whole.texts] == ["z  8 m", "x  2 m", "y  3 m"]
    z, x, y = (np.array(text._position3d if hasattr(text, "_position3d") else (*text.get_position(), text._z))
               for text in whole.texts)
    gap, middle = 0.12 * 2, np.array([30, 10, 20])
    assert z - middle == pytest.approx([0, -1, -1.5 - gap]) and x - middle == pytest.approx([4, 0, -1.5 - gap])
    assert y - middle == pytest.approx([-4 - gap, -1, 0])
    assert [(text.get_ha(), text.get_va()) for text in whole.texts] == [("center", "top"), ("left", "top"), ("right", "center")]


def test_profile_of_the_broken_area(broken):
    """Areas: twice 3 m2 at z = 0.1, 0.3 m2 around the height 0.6."""
    profile = broken.axes[-1]
    failed, breaking = ({round(patch.get_x() + patch.get_width() / 2, 6): patch.get_height() for patch in profile.patches
                         if to_rgba(colour) == patch.get_facecolor()} for colour in (plot.RED, plot.YELLOW))
    bars = {z: failed[z] + breaking[z] for z in failed}
    assert len(bars) == 61 and sum(failed.values()) == pytest.approx(0.3) and sum(bars.values()) == pytest.approx(6.3)
    width = 8 / 61
    filled = {z: area for z, area in bars.items() if area > 0}
    assert list(filled.values()) == pytest.approx([6, 0.3]) and legend(profile) == [
        "failed", "breaking", "cross-section of the outline"]
    assert all(abs(z - at) <= width / 2 for z, at in zip(filled, (0.1, 0.6)))
    assert min(abs(z) for z in bars) < 1e-6  # a bar has the mid-plane in its middle
    assert (profile.get_xlabel(), profile.get_ylabel()) == ("z (m)", "broken area (m²)")
    assert profile.get_xlim() == pytest.approx((-4, 4))
    (section,) = profile.get_lines()
    assert section.get_ydata() == [6, 6] and profile.get_ylim() == pytest.approx((0, 1.2 * 6))


def test_profile_takes_what_lies_beyond_the_mesh_and_hides_a_section_far_away():
    figure, axes = plt.subplots()
    small = np.array([[[0, 0, -9], [1, 0, -9], [0, 2, -9]]], float)  # 1 m2, moved below the box
    plot.draw_profile(axes, BOX, small, np.ones(1), 2, "m")
    assert axes.patches[0].get_height() == pytest.approx(1) and not axes.get_lines() and legend(axes) == ["failed", "breaking"]
    figure, axes = plt.subplots()
    plot.draw_profile(axes, BOX, np.concatenate([small, small / 1.4]), np.ones(2), 2, "m")  # 1.51 m2, a bit more than a quarter of 6
    assert len(axes.get_lines()) == 1 and axes.get_ylim()[1] == pytest.approx(7.2)
    figure, axes = plt.subplots()
    plot.draw_profile(axes, BOX, np.concatenate([small] * 9), np.ones(9), 2, "m")
    assert axes.get_ylim()[1] == pytest.approx(1.2 * 9)


def test_crack_says_what_it_is(broken):
    assert texts(broken)[:2] == ["spall: fracture surface",
                                 "t = 4.4 ms  ·  first fracture 4.2 ms  ·  failed 1.5 m²  ·  broken 2.5 m²  ·  "
                                 "dissipated 0.75 mJ  ·  12,345 elements"]
    title_, caption = broken.texts[:2]
    assert (title_.get_fontsize(), caption.get_fontsize()) == (14, 10) and title_.get_position()[1] > caption.get_position()[1]
    colours = broken.axes[2]
    assert colours.get_xlabel() == "damage (1: failed)" and colours.get_xticks().tolist() == [0, 0.5, 1]
    assert colours.get_xlim() == (0, 1) and not colours.spines["outline"].get_visible()


def test_crack_has_the_unit_of_the_body():
    figure = plot.plot_crack(1e-3 * BOX, 4.4e-7, 1e-3 * ACROSS, DAMAGE, 2, {**synthetic.SUMMARY, "first_fracture_time_s": None,
                                                                         "broken_area_m2": 2.5e-6, "failed_area_m2": 1.5e-6, "dissipated_J": 0.0})
    assert figure.axes[-1].get_xlabel() == "z (mm)" and figure.axes[-1].get_lines()[0].get_ydata() == pytest.approx([6, 6])
    assert [text.get_text() for text in figure.axes[0].texts] == ["z  8 mm", "x  2 mm", "y  3 mm"]
    assert texts(figure)[1] == "t = 0.44 µs  ·  failed 1.5 mm²  ·  broken 2.5 mm²  ·  dissipated 0 J  ·  12,345 elements"
    assert np.array(segments(collections(figure.axes[0], Poly3DCollection)[1])) == pytest.approx(ACROSS[:, :, [2, 0, 1]])


def test_body_far_from_the_origin_lies_as_any_other():
    far = BOX + [[0, 500, 0]]
    whole = plot.plot_crack(far, 4.4e-7, ACROSS + [0, 500, 0], DAMAGE, 2, synthetic.SUMMARY).axes[0]
    assert (whole.get_xlim(), whole.get_zlim()) == ((-4, 4), (498.5, 501.5))


def test_intact_body_has_its_unit():
    (axes,) = plot.plot_crack(1e-3 * BOX, 4.4e-7, np.zeros((0, 3, 3)), None, 2, synthetic.SUMMARY).axes
    assert [text.get_text() for text in axes.texts] == ["z  8 mm", "x  2 mm", "y  3 mm"]
    assert axes.get_xlim() == pytest.approx((-4, 4))


def test_triangle_without_area_has_a_colour():
    flat = np.zeros((1, 3, 3))
    assert np.isfinite(plot.shaded(flat, np.array([1.0]), plot.matplotlib.colormaps["YlOrRd"])).all()


@pytest.mark.parametrize("triangles, message",
                         [(np.zeros((0, 3, 3)), "Nothing broke."), (None, "The run did not write its crack surface.")])
def test_body_that_did_not_break(triangles, message):
    figure = plot.plot_crack(BOX, 4.4e-3, triangles, None, 2, synthetic.SUMMARY)
    assert texts(figure)[:3] == ["spall: fracture surface", "t = 4.4 ms  ·  12,345 elements", message]
    (axes,) = figure.axes
    assert figure.texts[2].get_ha() == "center" and figure.texts[2].get_position() == (0.5, 0.08)
    assert figure.get_size_inches() == pytest.approx((11, 4.6))
    assert [text.get_text() for text in axes.texts] == ["z  8 m", "x  2 m", "y  3 m"]
    assert [len(segments(one)) for one in axes.collections] == [3, 3, 9]
    seen = on_paper(axes, corners_of(axes))
    assert seen.min() > 0.05 and seen.max() < 0.95 and np.ptp(seen, axis=0)[1] > 0.5
    assert_readable(figure)
    low = seen.min(axis=0)[1]
    assert figure.texts[2].get_position()[1] < low < seen.max(axis=0)[1] < figure.texts[1].get_position()[1]


# ---- all of a run ----


def crack_fields(points=True):
    cells = np.arange(10).reshape(1, 10)
    crack = {"crack/points": ACROSS.reshape(-1, 3), "crack/damage": DAMAGE.reshape(-1, 1),
             "crack/cells": np.arange(9).reshape(3, 3)}
    return synthetic.box_points(*BOX), cells, [{"time": 1e-3}, {"time": 4.4e-3, **(crack if points else {})}]


def drawn(monkeypatch, run, out, **options):
    """The pictures that plot() saves, by name."""
    figures = {}
    monkeypatch.setitem(plot.__dict__, "save", lambda figure, path: figures.update({path.relative_to(out).name: figure}))
    plot.plot(run, out, **options)
    return figures


FRAGMENTS = {"time": [1e-3, 1e-3], "id": [0, 7], "mass": [1.0, 2.0]}
STRESS = {"time": TIME, "p-1_szz": HISTORY["p-1_szz"]}


def test_plot_reads_a_run(tmp_path, monkeypatch, capsys):
    run = synthetic.write_run(tmp_path / "run", history=STRESS, fragments=FRAGMENTS, fields=crack_fields())
    figures = drawn(monkeypatch, run, tmp_path / "out")
    assert list(figures) == ["history.png", "energy.png", "fragments.png", "crack.png"]
    assert line(figures["history.png"].axes[0], "computed")[1] == pytest.approx(1e-6 * HISTORY["p-1_szz"])
    assert line(figures["energy.png"].axes[0], "bulk")[1] == pytest.approx(1e3 * ENERGY["bulk"])
    assert "2 fragments" in texts(figures["fragments.png"])[0]
    assert texts(figures["crack.png"])[1].startswith("t = 4.4 ms  ·  first")
    assert np.array(segments(collections(figures["crack.png"].axes[0],
                                         Poly3DCollection)[1])) == pytest.approx(ACROSS[:, :, [2, 0, 1]])
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("change, pictures, said", [
    ({"summary": {"fragments": 1}}, ["history.png", "energy.png", "crack.png"], ""),
    ({"summary": {"fragments": 2}}, ["history.png", "energy.png", "fragments.png", "crack.png"], ""),
    ({"fragments": None}, ["history.png", "energy.png", "crack.png"], ""),
    ({"case": synthetic.SPALL.replace("fields: [crack]", "fields: []"), "fields": None},
     ["history.png", "energy.png", "fragments.png"],
     "plot: no crack.png, since the case asks for no fields\n"),
    ({"case": synthetic.SPALL.replace("{name: p-1, at: [0, 0.5, 1]}", ""), "history": None},
     ["energy.png", "fragments.png", "crack.png"], "")])
def test_plot_draws_what_there_is(tmp_path, monkeypatch, capsys, change, pictures, said):
    whole = {"history": STRESS, "fragments": FRAGMENTS, "fields": crack_fields()}
    run = synthetic.write_run(tmp_path / "run", **{**whole, **change})
    assert list(drawn(monkeypatch, run, tmp_path)) == pictures and capsys.readouterr().err == said


def test_plot_of_a_run_without_crack_surface(tmp_path, monkeypatch):
    run = synthetic.write_run(tmp_path / "run", history=STRESS, fields=crack_fields(points=False))
    assert "The run did not write its crack surface." in texts(drawn(monkeypatch, run, tmp_path)["crack.png"])


@pytest.mark.parametrize("left_out", ["time", *synthetic.ENERGIES, "external_work", "total", "error_rel"])
def test_plot_wants_the_whole_ledger(tmp_path, left_out):
    table = {name: column for name, column in synthetic.energy().items() if name != left_out}
    run = synthetic.write_run(tmp_path / "run", history=STRESS, fields=crack_fields(), energy_table=table)
    with pytest.raises(rhegma.BadInput, match=f"energy.csv: no column '{left_out}'"):
        plot.plot(run, tmp_path)


@pytest.mark.parametrize("case, complaint", [
    (synthetic.SPALL.replace("at: [0, 0.5, 1]", "at: [0, a, 1]"), "output.probes"),
                                             (synthetic.SPALL.replace("probes", "samples"), "output.probes"),
    (synthetic.SPALL.replace("name: p-1", "name: p-2"), "history.csv: no column 'p-2_szz'")])
def test_plot_names_what_is_wrong(tmp_path, case, complaint):
    run = synthetic.write_run(tmp_path / "run", case=case, history=STRESS, fields=crack_fields())
    with pytest.raises(rhegma.BadInput, match=complaint):
        plot.plot(run, tmp_path)


def test_plot_of_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr("sys.argv", ["plot", str(tmp_path / "nothing")])
    with pytest.raises(rhegma.BadInput, match="nothing: no such directory"):
        plot.main()


def test_plot_writes_beside_the_run_or_elsewhere(tmp_path, monkeypatch):
    seen = []
    monkeypatch.setitem(plot.__dict__, "plot", lambda run, out, **options: seen.append((run, out, options)))
    monkeypatch.setattr("sys.argv", ["plot", str(tmp_path)])
    plot.main()
    monkeypatch.setattr("sys.argv", ["plot", str(tmp_path), "--out", str(tmp_path / "a"), "--field", "velocity", "--component",
                                     "x", "--axis", "y", "--time", "1e-6"])
    plot.main()
    assert seen == [(tmp_path, tmp_path, dict.fromkeys(("field", "component", "axis", "time"))),
                    (tmp_path, tmp_path / "a", {"field": "velocity", "component": "x", "axis": "y", "time": 1e-6})]


# ---- what is drawn ----


@pytest.mark.parametrize("sections, axis", [
    ({"boundary": [{"component": "x", "velocity": 0}, {"component": "y", "velocity": "t"}], "initial": {"velocity": {"z": 1}}}, 1),
    ({"boundary": [{"component": "x", "velocity": 0.0}], "bodies": [{"velocity": {"x": 0, "y": 0, "z": "-300"}}],
      "initial": {"velocity": {"x": 1}}}, 2),
    ({"boundary": [{"component": "x", "displacement": "0*t"}]}, 0),
    ({"bodies": [{"velocity": {"x": 3}}, {"velocity": {"y": 1}}, {"velocity": {"x": 0, "y": 2}}]}, 1),
    ({"bodies": [{"shape": "plane"}], "initial": {"velocity": {"x": "-x", "y": "y"}}}, 0),  # x is the longer of them
    ({"initial": {"velocity": {"y": 1, "z": "1"}}}, 2), ({"initial": {"displacement": {"y": 1e-3}}}, 1), ({"initial": {"velocity": {"z": 0}}}, 0), ({}, 0)])
def test_axis_is_that_along_which_the_case_pulls(sections, axis):
    assert plot.pulled_axis(sections, np.array([3, 1, 2])) == axis


@pytest.mark.parametrize("mesh, component", [("{size: [2, 3, 8]}", "zz"), ("{file: a.h5}", "xx")])
def test_longest_axis_of_a_run_without_fields(tmp_path, monkeypatch, mesh, component):
    text = f"mesh: {mesh}\noutput: {{probes: [{{name: p-1, at: [0, 0.5, 1]}}], fields: []}}"
    run = synthetic.write_run(tmp_path / "run", case=text, history={"time": TIME, **{f"p-1_s{c}": TIME for c in ("xx", "yy", "zz")}})
    assert drawn(monkeypatch, run, tmp_path)["history.png"].axes[0].get_ylabel().startswith(f"σ$_{{{component}}}$")


def test_view_follows_case_and_options():
    case, size = {"boundary": [{"component": "y", "velocity": 1}]}, np.array([3, 1, 2])
    assert plot.view_of(case, size) == plot.View("stress", "yy", 1)
    assert plot.view_of(case, size, axis="z", time=1e-6) == plot.View("stress", "zz", 2, 1e-6)
    assert plot.view_of(case, size, field="velocity") == plot.View("velocity", "y", 1)
    assert plot.view_of(case, size, field="displacement", component="x") == plot.View("displacement", "x", 1)
    assert plot.view_of(case, size, component="xy") == plot.View("stress", "xy", 1)
    with pytest.raises(rhegma.BadInput, match="--component zz: velocity has x, y, z"):
        plot.view_of(case, size, field="velocity", component="zz")


@pytest.mark.parametrize("view, column, label, factor", [(plot.View("velocity", "x", 0), "p-1_vx", "v$_{x}$ (m/s)", 1),
                                                         (plot.View("displacement", "y", 1), "p-1_uy", "u$_{y}$ (µm)", 1e6),
                                                         (plot.View("stress", "xy", 0), "p-1_sxy", "σ$_{xy}$ (MPa)", 1e-6)])
def test_history_of_other_fields(view, column, label, factor):
    value = np.linspace(0, 5, len(TIME)) / factor
    table = synthetic.structured({"time": TIME, column: value, "p-1_szz": 0 * TIME})
    figure = plot.plot_history(table, CASE, PROBES[:1], view, synthetic.SUMMARY)
    assert line(figure.axes[0], "computed")[1] == pytest.approx(value * factor) and figure.axes[0].get_ylabel() == label
    assert texts(figure)[0] == f"spall: {view.field} at the probes" and "1-D theory" not in labels(figure.axes[0])


def test_profile_is_along_any_axis():
    figure, axes = plt.subplots()
    plot.draw_profile(axes, BOX, ACROSS + [0.5, 0, 0], np.ones(3), 0, "mm")
    assert axes.get_xlim() == pytest.approx((-1, 1)) and axes.get_xlabel() == "x (mm)"
    filled = {patch.get_x() + patch.get_width() / 2: patch.get_height() for patch in axes.patches if patch.get_height() > 0}
    assert sorted(filled.values()) == pytest.approx([0.3, 3, 3]) and all(
        abs(x - at) <= 1 / 61 for x, at in zip(sorted(filled), (0.5 - 1 / 3, 0.5, 0.5 + 1 / 3)))
    assert not axes.get_lines()  # 3 of a section of 24


@pytest.mark.parametrize("time, words", [(None, "t = 4.4 ms"), (1e-3, "t = 1 ms"), (2.6e-3, "t = 1 ms"), (9, "t = 4.4 ms")])
def test_fracture_surface_of_the_nearest_output(tmp_path, monkeypatch, time, words):
    points, cells, frames = crack_fields()
    frames[0].update({name: frames[1][name] for name in frames[1] if name != "time"})
    run = synthetic.write_run(tmp_path / "run", history=STRESS, fields=(points, cells, frames))
    assert texts(drawn(monkeypatch, run, tmp_path, time=time)["crack.png"])[1].startswith(words + " ")


def test_plot_of_a_real_run(run, monkeypatch):
    """Columns, names and shapes are those that the program writes; the parts of the ledger add up to the total drawn."""
    result = run(example("spall.yaml"), sets={"mesh.cells": [2, 2, 20], "time.end": 2.6e-7, "output.interval": 2e-8})
    figures = drawn(monkeypatch, result.dir, result.dir)
    assert {"history.png", "energy.png", "crack.png"} <= set(figures)
    upper = figures["energy.png"].axes[0]
    table = rhegma.energy(result.dir)
    drawn_parts = sum(line(upper, name)[1] for name in labels(upper) if name in plot.PARTS)
    total = line(upper, "total: sum of the parts\nless work and half_kick")[1]
    scale = np.abs(drawn_parts).max()
    assert drawn_parts - line(upper, "external work")[1] - 1e6 * table["half_kick"] == pytest.approx(total, abs=1e-9 * scale)
    assert scale == pytest.approx(1e6 * result.summary["energy_largest_J"], rel=0.05) and upper.get_ylabel() == "energy (µJ)"
    known = {"step", "time", "external_work", "total", "half_kick", "error_rel", "error_dissipated", "broken_area", "failed_area", *plot.PARTS}
    assert {name for name in table.dtype.names if not name.startswith(("momentum_", "angular_"))} == known
    time, stress = line(figures["history.png"].axes[0], "computed")
    after = (time > 0.13) & (time < 0.22)
    assert stress[after].mean() == pytest.approx(200, rel=0.03)
    crack = rhegma.crack(result.dir)
    areas = np.linalg.norm(np.cross(crack["points"][:, 1] - crack["points"][:, 0],
                                    crack["points"][:, 2] - crack["points"][:, 0]), axis=1) / 2
    bars = sum(patch.get_height() for patch in figures["crack.png"].axes[-1].patches)
    assert bars == pytest.approx(1e6 * areas.sum(), rel=1e-9)
    assert figures["crack.png"].axes[-1].get_ylabel() == "broken area (mm²)"
