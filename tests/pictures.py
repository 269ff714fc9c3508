"""What a matplotlib figure shows, for tests: its lines by their labels, its words, whether they can be read."""

import itertools
import types

import numpy as np
from conftest import ROOT
from matplotlib.colors import to_rgba
from mpl_toolkits.mplot3d import proj3d
from mpl_toolkits.mplot3d.art3d import Text3D


def script(name):
    """A script of bench/ or perf/ as a module, whatever the name of its file; compiled anew, so that no cache is stale."""
    path = ROOT / name
    module = types.ModuleType("script_" + path.name.replace("-", "_"))
    module.__file__ = str(path)
    exec(compile(path.read_text(), path, "exec"), module.__dict__)
    return module


def line(axes, label):
    """x and y of the one line with that label."""
    found = [one for one in axes.get_lines() if one.get_label() == label]
    assert len(found) == 1, [one.get_label() for one in axes.get_lines()]
    return np.array(found[0].get_xdata(), float), np.array(found[0].get_ydata(), float)


def style(axes, label):
    """Colour, line style and marker of the line with that label."""
    found = next(one for one in axes.get_lines() if one.get_label() == label)
    return to_rgba(found.get_color()), found.get_linestyle(), found.get_marker()


def look(one):
    """Colour and line style of a line."""
    return to_rgba(one.get_color()), one.get_linestyle()


def labels(axes):
    """Of the lines that have one of their own."""
    return [one.get_label() for one in axes.get_lines() if not one.get_label().startswith("_")]


def legend(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def title(axes):
    """Titles stand at the left."""
    assert axes.get_title("center") == axes.get_title("right") == ""
    return axes.get_title("left")


def words(figure):
    """Every text that a reader sees but the numbers of the axes."""
    found = list(figure.texts)  # its title among them
    for axes in figure.axes:
        found += [axes.title, axes._left_title, axes._right_title, axes.xaxis.label, axes.yaxis.label, *axes.texts]
        found += axes.get_legend().get_texts() if axes.get_legend() else []
        if not axes.axison:
            found = [text for text in found if text not in (axes.xaxis.label, axes.yaxis.label)]
    return [text for text in found if text.get_visible() and text.get_text().strip()]


def texts(figure):
    return [text.get_text() for text in words(figure)]


def place_of(text):
    """The room that a text takes, in pixels; one in space lies where its place is seen."""
    if not isinstance(text, Text3D):
        return text.get_window_extent()
    space = text._x, text._y, text._z
    text._x, text._y, _ = proj3d.proj_transform(*space, text.axes.get_proj())
    box = text.get_window_extent()
    text._x, text._y, text._z = space
    return box


def assert_readable(figure):
    """All words are inside the picture, and none lies on another."""
    figure.canvas.draw()
    boxes = [(text.get_text(), place_of(text)) for text in words(figure)]
    width, height = figure.bbox.size
    for text, box in boxes:
        assert box.x0 > -1 and box.y0 > -1 and box.x1 < width + 1 and box.y1 < height + 1, f"{text!r} leaves the picture: {box}"
    for (one, a), (other, b) in itertools.combinations(boxes, 2):
        across, along = min(a.x1, b.x1) - max(a.x0, b.x0), min(a.y1, b.y1) - max(a.y0, b.y0)
        assert across < 2 or along < 2, f"{one!r} lies on {other!r}"


def assert_panels_apart(figure):
    """No panel lies on another, and all are inside the picture."""
    boxes = [axes.get_position() for axes in figure.axes]
    for box in boxes:
        assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= 1 and box.y1 <= 1
    for a, b in itertools.combinations(boxes, 2):
        assert min(a.x1, b.x1) <= max(a.x0, b.x0) or min(a.y1, b.y1) <= max(a.y0, b.y0)


def on_paper(axes, points):
    """Points in space as parts of the figure's width and height."""
    x, y, _ = proj3d.proj_transform(*np.asarray(points, float).T, axes.get_proj())
    return axes.transData.transform(np.column_stack([x, y])) / axes.figure.bbox.size


def segments(collection):
    """Ends of the lines of a Line3DCollection, corners of the faces of a Poly3DCollection."""
    if hasattr(collection, "_segments3d"):
        return [np.asarray(segment) for segment in collection._segments3d]
    return [collection._vec[:3, piece].T for piece in collection._segslices]
