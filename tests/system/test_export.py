"""`rhegma export`: what other programs read is what the run wrote, number by number."""

import re
import struct

import h5py
import numpy as np
import pytest
from conftest import CASES, launch

SETS = {"mesh.cells": [2, 2, 12], "time.end": 0.3e-6, "output.interval": 1e-7, "output.compression": 4,
        "output.fields": ["displacement", "stress", "fragment", "crack"]}
TENSOR = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]
NUMPY = {"Float32": "f4", "Float64": "f8", "Int64": "i8", "UInt8": "u1"}


@pytest.fixture(scope="module", params=["double", "single"])
def broken(run, request):
    return run(CASES / "fragments.yaml", sets={**SETS, "output.precision": request.param})


def export(run, out, *arguments):
    process = launch("export", run.dir, "-o", out, *arguments)
    assert process.returncode == 0 and process.stderr == "", process.stderr
    return process.stdout


def read_xml(path):
    """Arrays by section and name, as the documentation of the format has it; number of points, of cells, time."""
    head, _, data = path.read_bytes().partition(b"<AppendedData encoding=\"raw\">\n_")
    head, found = head.decode(), {}
    for section, body in re.findall(r"<(Points|Cells|Polys|PointData|CellData)>(.*?)</\1>", head, re.S):
        for text in re.findall("<DataArray (.*?)/>", body):
            key = dict(re.findall(r'(\w+)="(.*?)"', text))
            columns = int(key["NumberOfComponents"])
            bytes_of, = struct.unpack_from("<Q", data, int(key["offset"]))
            kind = np.dtype(NUMPY[key["type"]])
            values = np.frombuffer(data, kind, bytes_of // kind.itemsize, int(key["offset"]) + 8)
            found[section, key["Name"]] = values.reshape(-1, columns)
            assert columns != 6 or [key[f"ComponentName{k}"] for k in range(6)] == TENSOR
    points, cells = re.search(r'NumberOfPoints="(\d+)" NumberOf(?:Cells|Polys)="(\d+)"', head).groups()
    return found, int(points), int(cells), float(re.search('Name="TimeValue".*?>(.*?)<', head)[1])


def by_vtk(reader, path):
    """The same by VTK, where that is there: fields by name; None: it is not."""
    try:
        import vtkmodules.vtkIOGeometry as geometry
        import vtkmodules.vtkIOXML as xml
        from vtkmodules.util.numpy_support import vtk_to_numpy
    except ImportError:
        return None
    reading = getattr(xml, reader, None) or getattr(geometry, reader)
    reading = reading()
    reading.SetFileName(str(path))
    reading.Update()
    grid = reading.GetOutput()
    values = {"points": vtk_to_numpy(grid.GetPoints().GetData())}
    for data in (grid.GetPointData(), grid.GetCellData()):
        values |= {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    return values, grid.GetNumberOfCells()


@pytest.mark.parametrize("when", [(), ("--time", "1.1e-7"), ("--time", "1.6e-7"), ("--time", "0")])
def test_the_body(broken, tmp_path, when):
    said = export(broken, tmp_path / "a.vtu", *when)
    frame = broken.frames()[{(): -1, "1.1e-7": 1, "1.6e-7": 2, "0": 0}[when[-1] if when else ()]]
    found, points, cells, time = read_xml(tmp_path / "a.vtu")
    assert time == frame["time"] and said == f"{tmp_path}/a.vtu: at {time:.9g} s\n"
    n = broken.summary["elements"]
    assert (points, cells) == (10 * n, n)
    assert np.array_equal(found["Points", "points"], broken.points())
    assert found["Cells", "connectivity"].ravel().tolist() == list(range(10 * n))
    assert found["Cells", "offsets"].ravel().tolist() == list(range(10, 10 * n + 1, 10)) and (found["Cells", "types"] == 24).all()
    assert np.array_equal(found["PointData", "displacement"], frame["displacement"])
    assert np.array_equal(found["CellData", "stress"], frame["stress"][:, [0, 3, 5, 1, 4, 2]])  # xx xy xz yy yz zz
    assert np.array_equal(found["CellData", "fragment"].ravel(), frame["fragment"].ravel())
    assert found["CellData", "stress"].dtype == frame["stress"].dtype and len(found) == 7
    vtk = by_vtk("vtkXMLUnstructuredGridReader", tmp_path / "a.vtu")
    if vtk is not None:
        assert np.array_equal(vtk[0]["stress"], found["CellData", "stress"]) and vtk[1] == n


@pytest.mark.parametrize("suffix", [".vtp", ".vtu", ".stl"])
def test_the_crack(broken, tmp_path, suffix):
    out, crack = tmp_path / f"crack{suffix}", broken.crack()
    n = len(crack["damage"])
    assert n > 30
    export(broken, out, "--crack")
    if suffix == ".stl":
        data = out.read_bytes()
        rows = np.frombuffer(data, np.dtype([("normal", "f4", 3), ("corner", "f4", (3, 3)), ("more", "u2")]), n, 84)
        assert struct.unpack_from("<I", data, 80) == (n,) and len(data) == 84 + 50 * n
        assert np.array_equal(rows["corner"], crack["points"].astype("f4"))
        edge = crack["points"][:, 1:] - crack["points"][:, :1]
        normal = np.cross(edge[:, 0], edge[:, 1])
        assert abs(rows["normal"] - normal / np.linalg.norm(normal, axis=1)[:, None]).max() < 3e-6  # of single precision
        vtk = by_vtk("vtkSTLReader", out)
        assert vtk is None or vtk[1] == n
        return
    found, points, cells, _ = read_xml(out)
    assert (points, cells) == (3 * n, n) and np.array_equal(found["Points", "points"], crack["points"].reshape(-1, 3))
    section = "Polys" if suffix == ".vtp" else "Cells"
    assert found[section, "connectivity"].ravel().tolist() == list(range(3 * n))
    assert found[section, "offsets"].ravel().tolist() == list(range(3, 3 * n + 1, 3))
    assert ("Cells", "types") in found if suffix == ".vtu" else section == "Polys"
    for name in ("damage", "opening", "slip", "time_of_failure"):
        assert np.array_equal(found["CellData", name].ravel(), crack[name])
    vtk = by_vtk("vtkXMLPolyDataReader" if suffix == ".vtp" else "vtkXMLUnstructuredGridReader", out)
    if vtk is not None:
        assert vtk[1] == n and np.array_equal(vtk[0]["damage"], crack["damage"])


def test_meshio_reads_it(broken, tmp_path):
    meshio = pytest.importorskip("meshio")
    export(broken, tmp_path / "a.vtu")
    body, frame = meshio.read(tmp_path / "a.vtu"), broken.frames()[-1]
    assert [(c.type, len(c.data)) for c in body.cells] == [("tetra10", broken.summary["elements"])]
    assert np.array_equal(body.point_data["displacement"], frame["displacement"]) and np.array_equal(body.points, broken.points())
    assert np.array_equal(np.ravel(body.cell_data["fragment"][0]), frame["fragment"].ravel())
    for name, options in (("c.vtu", ["--crack"]), ("c.stl", [])):
        export(broken, tmp_path / name, *options)
        assert [c.type for c in meshio.read(tmp_path / name).cells] == ["triangle"]


def test_a_moment_without_cracks(broken, tmp_path):
    for name in ("none.vtp", "none.stl"):
        export(broken, tmp_path / name, "--time", "0")
    assert read_xml(tmp_path / "none.vtp")[1:3] == (0, 0) and len((tmp_path / "none.stl").read_bytes()) == 84


def test_what_is_there(broken):
    process = launch("export", broken.dir)
    times = [frame["time"] for frame in broken.frames()]
    assert process.returncode == 0 and [line.split() for line in process.stdout.splitlines()] == [
        [str(i), f"{time:.9g}", "s"] for i, time in enumerate(times)] and len(times) == 4


def test_a_part_of_the_body(run, tmp_path):
    part = run(CASES / "fragments.yaml", sets={**SETS, "output.region": "z > 0", "output.fields": ["displacement"]})
    export(part, tmp_path / "a.vtu")
    found, points, cells, _ = read_xml(tmp_path / "a.vtu")
    assert 0 < cells < part.summary["elements"] and np.array_equal(found["Points", "points"], part.points())
    process = launch("export", part.dir, "-o", tmp_path / "a.stl")
    assert process.returncode == 2 and not (tmp_path / "a.stl").exists()
    assert process.stderr == f"rhegma: {part.dir}/fields.h5: the run did not write its crack surface (crack in output.fields)\n"


@pytest.mark.parametrize("arguments, message", [
    ([], "export: of which run?\n"),
    (["no", "such"], "export: one run at a time; not understood: such\n"),
    (["no"], "no/fields.h5: there is no field output here (output.fields)\n"),
    (["no", "-o", "a.vtk"], "export: the name must end with .vtu, .vtp or .stl: a.vtk\n"),
    (["no", "-o"], "export: missing value after: -o\n"),
    (["no", "--crack"], "export: where to? -o is missing\n"),
    (["no", "--time", "1"], "export: where to? -o is missing\n"),
    (["no", "--time", "now"], "export: --time is a number of seconds, not: now\n"),
    (["no", "--frob"], "export: unknown option: --frob\n"),
])
def test_mistakes(tmp_path, arguments, message):
    process = launch("export", *arguments, cwd=tmp_path)
    assert process.returncode == 2 and process.stderr.startswith(f"rhegma: {message}") and process.stdout == ""


def test_damaged_fields(broken, tmp_path):
    for name in ("", "frames/000000"):
        with h5py.File(tmp_path / "fields.h5", "w") as file:
            file.create_group(name) if name else file.create_dataset("frames", data=1)
        process = launch("export", tmp_path, "-o", tmp_path / "a.vtu")
        assert process.returncode == 2 and process.stderr.startswith(f"rhegma: {tmp_path}/fields.h5: "), process.stderr
