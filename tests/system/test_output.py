"""The field output of a finished run: fields.xdmf describes what fields.h5 holds, and ParaView can draw it."""

import re
import xml.etree.ElementTree as ET

import h5py
import numpy as np
import pytest
from conftest import example, launch

COMPONENTS = {"Scalar": 1, "Vector": 3, "Tensor6": 6}
EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]  # of a VTK_QUADRATIC_TETRA, nodes 4 to 9


@pytest.fixture
def xdmf(spall_run):
    return ET.parse(spall_run / "fields.xdmf").getroot()


@pytest.fixture
def h5(spall_run):
    with h5py.File(spall_run / "fields.h5", "r") as file:
        yield file


def collections(xdmf):
    found = {grid.get("Name"): grid for grid in xdmf.findall("Domain/Grid")}
    assert set(found) <= {"volume", "crack"} and "volume" in found
    return found


def times(collection):
    return [float(grid.find("Time").get("Value")) for grid in collection.findall("Grid")]


def place_of(item):
    """The file, relative to that of the description, and the dataset in it."""
    return tuple(item.text.strip().split(":"))


def test_every_item_is_in_its_file_with_its_dimensions(xdmf, spall_run):
    kinds = {"Int": np.dtype("int64"), "Float": np.dtype("float64")}
    items = xdmf.findall(".//DataItem")
    assert items
    for item in items:
        file, path = place_of(item)
        with h5py.File(spall_run / file) as h5:
            assert h5[path].shape == tuple(int(n) for n in item.get("Dimensions").split())
            assert h5[path].dtype == kinds[item.get("NumberType")]


def test_every_field_of_the_files_is_described(xdmf, spall_run):
    described = {place_of(item) for item in xdmf.iter("DataItem")}
    held = set()
    for path in (spall_run / "fields").iterdir():
        file = f"fields/{path.name}"
        with h5py.File(path) as h5:
            h5.visititems(lambda name, node: held.add((file, "/" + name))
                          if isinstance(node, h5py.Dataset) and node.shape[0] else None)
    assert held == described


def test_one_file_leads_to_all(h5, spall_run):
    assert {"mesh", *h5["frames"]} == {path.stem for path in (spall_run / "fields").iterdir()}
    assert all(h5["frames"][name].file.filename.endswith(f"fields/{name}.h5") for name in h5["frames"])


def test_attributes_have_as_many_values_as_their_grid(xdmf):
    for grid in xdmf.findall(".//Grid[@GridType='Uniform']"):
        cells = int(grid.find("Topology").get("NumberOfElements"))
        points = int(grid.find("Geometry/DataItem").get("Dimensions").split()[0])
        for attribute in grid.findall("Attribute"):
            rows, columns = map(int, attribute.find("DataItem").get("Dimensions").split())
            assert rows == {"Cell": cells, "Node": points}[attribute.get("Center")]
            assert columns == COMPONENTS[attribute.get("AttributeType")]


def test_times_ascend_and_are_those_of_the_frames(xdmf, h5):
    volume = times(collections(xdmf)["volume"])
    assert all(a < b for a, b in zip(volume, volume[1:]))
    assert volume == [h5["frames"][name].attrs["time"] for name in sorted(h5["frames"])]
    steps = [h5["frames"][name].attrs["step"] for name in sorted(h5["frames"])]
    assert all(a < b for a, b in zip(steps, steps[1:]))


def test_crack_grids_are_at_the_frames_that_have_triangles(xdmf, h5):
    frames = [h5["frames"][name] for name in sorted(h5["frames"])]
    broken = [f.attrs["time"] for f in frames if "crack" in f and f["crack/cells"].shape[0] > 0]
    found = collections(xdmf)
    assert (times(found["crack"]) if "crack" in found else []) == broken


def test_elements_are_right_handed_with_nodes_in_vtk_order(h5):
    x = h5["mesh/points"][:].reshape(-1, 10, 3)
    assert np.array_equal(h5["mesh/cells"][:].ravel(), np.arange(10 * len(x)))
    size = np.ptp(x.reshape(-1, 3), axis=0).max()
    for node, (i, j) in enumerate(EDGES, start=4):
        assert np.abs(x[:, node] - (x[:, i] + x[:, j]) / 2).max() < 1e-12 * size
    assert (np.linalg.det(x[:, 1:4] - x[:, :1]) > 0).all()


def test_fields_are_finite_and_say_their_unit(h5):
    def check(name, data):
        if isinstance(data, h5py.Dataset) and not name.endswith("cells"):
            assert "unit" in data.attrs, name
            assert np.isfinite(data[()]).all(), name

    for frame in h5["frames"].values():
        frame.visititems(check)


def test_check_says_how_much_disk_the_fields_take(tmp_path):
    words = [example("spall.yaml"), "-o", tmp_path / "out", "--set", "time.end=2.4e-8"]
    size, frames, frame = map(float, re.search(r"^disk +(\S+) GB: (\d+) frames of (\S+) GB", launch("check", *words).stdout, re.M).groups())
    assert launch("run", *words, "-q").returncode == 0
    files = sorted((tmp_path / "out/fields").glob("0*.h5"))
    assert frames == len(files) == 4 and size == pytest.approx(4 * frame, rel=5e-3)
    assert sum(path.stat().st_size for path in files) == pytest.approx(size * 1e9, rel=0.01)
