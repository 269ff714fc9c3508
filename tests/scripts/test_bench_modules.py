"""The modules that the scripts of bench/ share: starting the program, reading what a run left, theory, units."""

import json
import math

import numpy as np
import pytest
import synthetic_run as synthetic
from conftest import ROOT, example
from conftest import launch as start

import drawing
import launch
import rhegma
import theory

# ---- launch.py ----


def fake_program(directory, body):
    """A program that does what a line of shell says; its words are in `words`."""
    directory.mkdir(parents=True, exist_ok=True)
    path = directory / "rhegma"
    path.write_text(f"#!/bin/sh\nprintf '%s\\n' \"$@\" >>{directory}/words\n{body}\n")
    path.chmod(0o755)
    return path


def words_of(directory):
    return (directory / "words").read_text().splitlines()


def test_program_is_the_one_named_or_that_of_the_tree(monkeypatch):
    monkeypatch.setenv("RHEGMA", "/elsewhere/rhegma")
    assert str(launch.program()) == "/elsewhere/rhegma"
    monkeypatch.delenv("RHEGMA")
    assert launch.program() == ROOT / "build/rhegma"


def test_options_are_json():
    assert launch.options({"a.b": [1, 2], "c": "d*x"}) == ["--set", "a.b=[1, 2]", "--set", 'c="d*x"']
    assert launch.options(None) == []


def test_run_hands_everything_on(tmp_path, monkeypatch):
    monkeypatch.setenv("RHEGMA", str(fake_program(tmp_path, "echo said; echo $CASUALLY >&2")))
    done = launch.run("case.yaml", tmp_path / "out", {"a": 1}, ["b=2"], launcher=["env"], CASUALLY="by the way")
    assert words_of(tmp_path) == ["run", "case.yaml", "-o", str(tmp_path / "out"), "-q", "--set", "a=1", "--set", "b=2"]
    assert (done.stdout, done.stderr) == ("said\n", "by the way\n")


def test_run_of_another_build_and_not_quiet(tmp_path, capfd):
    fake_program(tmp_path / "other", "echo shown")
    done = launch.run("c", "o", build=tmp_path / "other", quiet=False, show=True)
    assert words_of(tmp_path / "other") == ["run", "c", "-o", "o"]
    assert done.stdout is None and capfd.readouterr().out == "shown\n"


def test_failure_tells_what_the_program_said_and_its_status(tmp_path):
    with pytest.raises(launch.Failed, match="(?s)no such case.*") as failure:
        launch.call(["sh", "-c", "echo no such case >&2; exit 3"])
    assert failure.value.status == 3 and "failed with status 3" in str(failure.value)
    assert launch.call(["sh", "-c", "exit 3"], accept=(0, 3)).returncode == 3
    with pytest.raises(launch.Failed) as killed:
        launch.call(["sh", "-c", "kill -9 $$"])
    assert killed.value.status == 1
    with pytest.raises(launch.BadInput, match="/nowhere: No such file.*RHEGMA") as missing:
        launch.call(["/nowhere"])
    assert missing.value.status == 2


@pytest.mark.parametrize("end, status, said", [
    (lambda: None, 0, ""), (lambda: 7, 7, ""), (lambda: launch.call(["sh", "-c", "exit 4"]), 4, "failed with status 4")])
def test_status_of_a_script(capsys, end, status, said):
    with pytest.raises(SystemExit) as ended:
        launch.exit_with(end)
    assert (ended.value.code or 0) == status and said in capsys.readouterr().err


def test_bad_input_is_one_line_and_status_2(capsys):
    def main():
        raise launch.BadInput("not here")

    with pytest.raises(SystemExit) as ended:
        launch.exit_with(main)
    assert ended.value.code == 2 and capsys.readouterr().err == f"{launch.NAME}: not here\n"


def test_run_once_repeats_what_is_not_the_same(tmp_path, monkeypatch):
    out = tmp_path / "out"
    monkeypatch.setenv("RHEGMA", str(fake_program(tmp_path, f"mkdir -p {out}; echo '{{}}' >{out}/summary.json; sleep 0.05")))
    seconds = launch.run_once("c", out, {"a": 1}, ["b=2"])
    assert 0.05 <= seconds < 5
    assert launch.run_once("c", out, {"a": 1}, ["b=2"]) == seconds
    assert words_of(tmp_path) == ["run", "c", "-o", str(out), "-q", "--set", "a=1", "--set", "b=2"]
    for changed in (("d", {"a": 1}, ["b=2"]), ("d", {"a": 2}, ["b=2"]), ("d", {"a": 2}, ["b=3"])):
        launch.run_once(changed[0], out, *changed[1:])
    assert words_of(tmp_path).count("run") == 4
    (out / "summary.json").unlink()
    launch.run_once("d", out, {"a": 2}, ["b=3"])
    assert words_of(tmp_path).count("run") == 5
    (tmp_path / "out.run").write_text("of an earlier time")
    launch.run_once("d", out, {"a": 2}, ["b=3"])
    assert words_of(tmp_path).count("run") == 6


def test_run_once_does_not_remember_a_run_that_failed(tmp_path, monkeypatch):
    out = tmp_path / "out"
    monkeypatch.setenv("RHEGMA", str(fake_program(tmp_path, f"mkdir -p {out}; echo '{{}}' >{out}/summary.json; exit $STATUS")))
    launch.run_once("c", out, STATUS="0")
    for _ in range(2):
        with pytest.raises(launch.Failed):
            launch.run_once("other", out, STATUS="1")
    launch.run_once("c", out, STATUS="0")
    assert words_of(tmp_path).count("run") == 4


def test_ranks_launcher():
    assert launch.ranks_launcher(1) == []
    assert launch.ranks_launcher(2) == ["mpirun", "--bind-to", "none", "-n", 2]


# ---- rhegma.py: cases ----


def test_numbers_of_a_case_are_numbers(tmp_path):
    path = tmp_path / "case.yaml"
    path.write_text("{a: 1e-8, b: 260e9, c: 3, d: .5, e: -2.5E+3, f: 1e5*x, g: [1e1, 2.], h: 1.0, i: '2'}")
    case = rhegma.read_case(path)
    assert case == {"a": 1e-8, "b": 260e9, "c": 3, "d": 0.5, "e": -2500.0, "f": "1e5*x", "g": [10.0, 2.0], "h": 1.0, "i": "2"}
    assert isinstance(case["c"], int)


def test_overrides_are_those_of_the_program(run):
    """The program's own case.yaml against the case file with the same overrides."""
    sets = {"material.young": 1e9, "mesh.cells": [1, 1, 2], "viscosity.linear": 0.06, "time.steps": 1, "output.fields": []}
    texts = [f"{key}={json.dumps(value)}" for key, value in sets.items()]
    used = rhegma.case(run(example("spall.yaml"), sets=sets).dir)
    case = rhegma.read_case(example("spall.yaml"), texts)
    for section in ("mesh", "material", "interface", "viscosity", "boundary"):
        for key, value in case[section].items() if isinstance(case[section], dict) else []:
            assert used[section][key] == value
    assert used["boundary"] == case["boundary"]
    assert case["viscosity"] == {"linear": 0.06} and case["mesh"]["cells"] == [1, 1, 2]


@pytest.mark.parametrize("text", ["mesh.cells.x=1", "a=[1", "mesh.cells.0.y=2"])
def test_overrides_that_cannot_be(text):
    with pytest.raises(rhegma.BadInput, match="--set "):
        rhegma.read_case(example("spall.yaml"), [text])


def test_what_cannot_be_read_is_named(tmp_path):
    with pytest.raises(rhegma.BadInput, match="summary.json: cannot be read: No such file"):
        rhegma.summary(tmp_path)
    (tmp_path / "summary.json").write_text("{")
    with pytest.raises(rhegma.BadInput, match="summary.json: "):
        rhegma.summary(tmp_path)
    (tmp_path / "summary.json").write_text("[1]")
    with pytest.raises(rhegma.BadInput, match="not a table of keys and values"):
        rhegma.summary(tmp_path)
    (tmp_path / "summary.json").write_bytes(b"\xff")
    with pytest.raises(rhegma.BadInput, match="cannot be read: .*utf-8"):
        rhegma.summary(tmp_path)
    (tmp_path / "case.yaml").write_text("a: [")
    with pytest.raises(rhegma.BadInput, match="case.yaml: "):
        rhegma.case(tmp_path)


# ---- rhegma.py: tables and fields ----


def test_tables(tmp_path):
    columns = {"time": [0.0, 1e-9], "total": [1.5, -2.5], "p-1_szz": [3.0, math.inf]}
    synthetic.write_table(tmp_path / "energy.csv", columns)
    table = rhegma.energy(tmp_path, ["p-1_szz"])
    assert table.dtype.names == tuple(columns)
    for name, values in columns.items():
        assert table[name].tolist() == values
    with pytest.raises(rhegma.BadInput, match="energy.csv: no column 'kinetic'"):
        rhegma.energy(tmp_path, ["p-1_szz", "kinetic", "bulk"])
    synthetic.write_table(tmp_path / "history.csv", {"time": [1.0], "x": [2.0]})
    assert rhegma.history(tmp_path, ["x"])["x"].tolist() == [2.0]
    with pytest.raises(rhegma.BadInput, match="no column 'y'"):
        rhegma.history(tmp_path, ["y"])
    assert rhegma.fragments(tmp_path) is None
    synthetic.write_table(tmp_path / "fragments.csv", {"time": [1.0], "id": [0.0], "mass": [2.0]})
    assert rhegma.fragments(tmp_path)["mass"].tolist() == [2.0]


@pytest.mark.parametrize("name, read, needed",
                         [("energy", rhegma.energy, ["time", "total"]), ("history", rhegma.history, ["time"]),
                                                ("fragments", rhegma.fragments, ["time", "id", "mass"])])
def test_tables_need_their_columns(tmp_path, name, read, needed):
    for left_out in needed:
        synthetic.write_table(tmp_path / f"{name}.csv", {column: [1.0] for column in [*needed, "more"] if column != left_out})
        with pytest.raises(rhegma.BadInput, match=f"{name}.csv: no column '{left_out}'"):
            read(tmp_path)


@pytest.mark.parametrize("text, complaint", [("", "no column 'time'"), ("time", "has no rows"), ("time\n", "has no rows"),
                                             ("time,x\n1\n", "x.csv: "), ("time,x\n1,b\n", "x.csv: "),
                                             ("time,time\n1,2\n", "x.csv: ")])
def test_tables_that_are_none(tmp_path, text, complaint):
    (tmp_path / "x.csv").write_text(text)
    with pytest.raises(rhegma.BadInput, match=complaint):
        rhegma.read_table(tmp_path / "x.csv", ["time"])


FRAMES = [{"time": 1e-7, "stress": np.arange(12.0).reshape(2, 6)},
          {"time": 2e-7, "stress": 2 * np.arange(12.0).reshape(2, 6), "crack/points": np.arange(18.0).reshape(6, 3),
           "crack/cells": np.arange(6).reshape(2, 3), "crack/damage": np.array([[0.5], [1.0]])}]


@pytest.fixture
def fields(tmp_path):
    synthetic.write_fields(tmp_path, np.array([[1.0, 2, 3], [-4, 5, 6]]), np.arange(10).reshape(1, 10), FRAMES)
    return tmp_path


def test_fields(fields):
    points, cells = rhegma.mesh(fields)
    assert points.tolist() == [[1, 2, 3], [-4, 5, 6]] and cells.tolist() == [list(range(10))]
    assert rhegma.box_of(points).tolist() == [[-4, 2, 3], [1, 5, 6]]
    assert rhegma.frame_times(fields).tolist() == [1e-7, 2e-7]
    first, last = rhegma.fields(fields, 0), rhegma.fields(fields)
    assert first["time"] == 1e-7 and sorted(first) == ["stress", "time"] and rhegma.crack_of(first) is None
    assert last["time"] == 2e-7 and (last["stress"] == FRAMES[1]["stress"]).all()
    crack = rhegma.crack_of(last)
    assert sorted(crack) == ["damage", "points"] and crack["damage"].tolist() == [0.5, 1.0]
    assert (crack["points"] == np.arange(18.0).reshape(2, 3, 3)).all()
    assert sorted(rhegma.fields(fields, names=["crack"])) == ["crack/cells", "crack/damage", "crack/points", "time"]
    assert sorted(rhegma.whole_fields(fields, 1, ["stress", "crack"])) == sorted(last)


def test_fields_that_are_not_there(fields, tmp_path):
    with pytest.raises(rhegma.BadInput, match=r"fields.h5: the run did not write crack \(output.fields\)"):
        rhegma.whole_fields(fields, 0, ["stress", "crack"])
    synthetic.write_fields(tmp_path, np.zeros((1, 3)), np.zeros((1, 10), int), [])
    for read in (rhegma.fields, rhegma.frame_times):
        with pytest.raises(rhegma.BadInput, match="fields.h5: has no frames"):
            read(tmp_path)
    (tmp_path / "fields.h5").write_text("no HDF5")
    with pytest.raises(rhegma.BadInput, match="fields.h5: "):
        rhegma.mesh(tmp_path)
    (tmp_path / "fields.h5").unlink()
    with pytest.raises(rhegma.BadInput, match="fields.h5: no such file"):
        rhegma.mesh(tmp_path)


# ---- rhegma.py: materials ----

ALUMINA = {"name": "alumina", "model": "neo-hookean", "young": 260e9, "poisson": 0.21, "density": 3690}


def test_moduli_and_speeds():
    """nu = 1/4: lambda = mu = E/2.5, so c_d^2 = 3 mu/rho, c_s^2 = mu/rho, c_0^2 = 2.5 mu/rho."""
    solid = rhegma.material_of({"model": "j2", "young": 10e9, "poisson": 0.25, "density": 1000.0})
    assert (solid.name, solid.model, solid.density, solid.poisson) == ("material", "j2", 1000, 0.25)
    for found, expected in ((solid.shear, 4e9), (solid.lame, 4e9), (solid.young, 10e9), (solid.uniaxial, 12e9),
                            (solid.dilatational_speed, math.sqrt(12e6)), (solid.shear_speed, 2000),
                            (solid.bar_speed, math.sqrt(10e6))):
        assert found == pytest.approx(expected, rel=1e-14)
    ceramic = rhegma.material_of({"name": "c", "model": "deshpande-evans", "shear": 4e9, "poisson": 0.25, "density": 1000})
    assert ceramic.name == "c" and ceramic.young == pytest.approx(10e9, rel=1e-14)


def test_speeds_are_those_of_the_program():
    solid = rhegma.material_of(ALUMINA)
    said = start("check", example("spall.yaml")).stdout
    assert f"dilatational {solid.dilatational_speed:.1f} m/s, shear {solid.shear_speed:.1f} m/s" in said


@pytest.mark.parametrize("left_out", ["young", "poisson", "density", "model"])
def test_material_needs_its_keys(left_out):
    with pytest.raises(rhegma.BadInput, match=f"material: '{left_out}' is missing or wrong"):
        rhegma.material_of({key: value for key, value in ALUMINA.items() if key != left_out})


def test_material_that_is_no_number():
    with pytest.raises(rhegma.BadInput, match="is missing or wrong"):
        rhegma.material_of({**ALUMINA, "poisson": "much"})


COPPER = [168.4e9, 121.4e9, 121.4e9, 0, 0, 0, 168.4e9, 121.4e9, 0, 0, 0, 168.4e9, 0, 0, 0, 75.4e9, 0, 0, 75.4e9, 0, 75.4e9]


@pytest.mark.parametrize("keys, shear, bulk", [
    ({"model": "anisotropic", "stiffness": COPPER}, (168.4e9 - 121.4e9 + 3 * 75.4e9) / 5, (168.4e9 + 2 * 121.4e9) / 3),
    ({"model": "anisotropic", "young": [26e9] * 3, "poisson": [0.3] * 3, "shear": [10e9] * 3}, 10e9, 26e9 / 1.2),
    ({"model": "mooney-rivlin", "bulk": 2e9, "c10": 1e6, "c01": 0.5e6}, 3e6, 2e9),
    ({"model": "mooney-rivlin", "bulk": 2e9, "c10": 1e6}, 2e6, 2e9),
    ({"model": "ogden", "bulk": 2e9, "mu_1": 1e6, "alpha_1": 2, "mu_3": -0.5e6, "alpha_3": -4}, 2e6, 2e9),
    ({"model": "user", "library": "x.so", "young": 10e9, "poisson": 0.25}, 4e9, 20e9 / 3),
    ({"model": "user", "library": "x.so", "parameters": {"shear": 4e9, "poisson": 0.25}}, 4e9, 20e9 / 3),
    ({"model": "user", "library": "x.so", "stiff": 10e9}, math.nan, math.nan),
    ({"model": "holmquist-johnson-cook", "young": 10e9, "poisson": 0.25}, 4e9, 20e9 / 3)])
def test_moduli_of_every_model(keys, shear, bulk):
    """Of those that are not given by Young's modulus too; of crystals the means over all orientations."""
    solid = rhegma.material_of({**keys, "density": 1000})
    assert solid.shear == pytest.approx(shear, nan_ok=True, rel=1e-12)
    assert solid.lame + 2 / 3 * solid.shear == pytest.approx(bulk, nan_ok=True, rel=1e-9)


def test_moduli_of_a_composite():
    """An orthotropic solid by its compliance: what its inverse has in the mean, against the same means of the stiffness."""
    keys = {"model": "anisotropic", "density": 1, "young": [140e9, 10e9, 9e9], "poisson": [0.4, 0.3, 0.28], "shear": [3.5e9, 5e9, 5.5e9]}
    S = np.array([[1 / 140e9, -0.28 / 140e9, -0.3 / 140e9], [-0.28 / 140e9, 1 / 10e9, -0.4 / 10e9], [-0.3 / 140e9, -0.4 / 10e9, 1 / 9e9]])
    C, G = np.linalg.inv(S), [3.5e9, 5e9, 5.5e9]
    upper = [*C[0], 0, 0, 0, *C[1, 1:], 0, 0, 0, C[2, 2], 0, 0, 0, G[0], 0, 0, G[1], 0, G[2]]
    one, other = rhegma.material_of(keys), rhegma.material_of({"model": "anisotropic", "density": 1, "stiffness": upper})
    assert one.shear == pytest.approx(other.shear) and one.poisson == pytest.approx(other.poisson) and C.sum() / 9 == pytest.approx(
        one.lame + 2 / 3 * one.shear)


def test_one_material():
    case = {"material": ALUMINA}
    assert rhegma.one_material(case, "it").name == "alumina"
    assert rhegma.one_material(case, "it", rhegma.ELASTIC).young == pytest.approx(260e9)
    with pytest.raises(rhegma.BadInput, match="it is for neo-hookean, linear-elastic, st-venant-kirchhoff; this case has j2"):
        rhegma.one_material({"material": {**ALUMINA, "model": "j2"}}, "it", rhegma.ELASTIC)
    with pytest.raises(rhegma.BadInput, match="it is for bodies of one material; this case has alumina, steel"):
        rhegma.one_material({"material": ALUMINA, "materials": [{**ALUMINA, "name": "steel"}]}, "it")
    assert [m.name for m in rhegma.materials({"material": ALUMINA, "materials": None})] == ["alumina"]
    with pytest.raises(rhegma.BadInput, match="material"):
        rhegma.one_material({}, "it")


# ---- theory.py: the spall test ----

RHO, C, LENGTH = 3000.0, math.sqrt(4.8e9 / 3000), 8.0  # of the synthetic case: lambda = mu = 1.6 GPa
INCIDENT = RHO * C * 7


def spall_case(**sections):
    case = rhegma.parse_yaml(synthetic.SPALL)
    case.update(sections)
    return case


def pulled(low, high):
    return [{**motion, "velocity": {"z+": high, "z-": low}.get(motion["set"], 0)} for motion in spall_case()["boundary"]]


def test_spall_of_a_case():
    bar = theory.Spall(spall_case())
    assert bar.speed == pytest.approx(C) and (bar.bottom, bar.top, bar.length) == (-4, 4, 8)
    assert bar.low == pytest.approx(INCIDENT) and bar.high == pytest.approx(INCIDENT)
    assert bar.meeting() == pytest.approx(4 / C) and bar.crossing() == pytest.approx(8 / C)
    assert (bar.strength, bar.energy) == (50e6, 30) and bar.plane_energy() == pytest.approx(30 * 2 * 3)
    uneven = theory.Spall(spall_case(boundary=pulled(-2, 3)))
    assert (uneven.low, uneven.high) == pytest.approx((INCIDENT * 2 / 7, INCIDENT * 3 / 7))
    assert theory.Spall(spall_case(mesh={"file": "x"}), np.array([[0, 0, 1], [1, 1, 5]])).bottom == 1
    assert theory.Spall(spall_case(mesh={"size": [1, 1, 2]})).box.tolist() == [[0, 0, 0], [1, 1, 2]]


@pytest.mark.parametrize("low, high, strength, breaks", [
    (-7, 7, 2 * INCIDENT, True), (-7, 7, 2 * INCIDENT / 0.9985, False), (-7, 7, 2 * INCIDENT / 0.9995, True),
    (-14, 0, INCIDENT, False), (0, 14, INCIDENT, False), (7, 21, INCIDENT, False), (-21, -7, INCIDENT, False)])
def test_bar_breaks_where_two_pulls_add_up_to_the_strength(low, high, strength, breaks):
    case = spall_case(boundary=pulled(low, high), interface={"strength": strength, "energy": 1})
    assert theory.Spall(case).breaks is breaks


def test_bar_without_strength_never_breaks():
    bar = theory.Spall(spall_case(interface={"law": "none", "sets": []}))
    assert bar.strength == math.inf and not bar.breaks


def step(time, arrival):
    return np.where(time >= arrival, 1.0, 0.0)


@pytest.mark.parametrize("z", [-3.1, -0.7, 0.9, 2.3])
def test_stress_of_a_bar_that_holds(z):
    """By images: ends that move at given speeds send every wave back as it comes."""
    case = spall_case(boundary=pulled(-2, 3), interface={"strength": 1e12, "energy": 1})
    time = np.linspace(0, 5.3 * LENGTH / C, 5001)
    expected = np.zeros_like(time)
    for k in range(4):
        for speed, way in ((3, 4 - z), (2, z + 4)):
            for arrival in (way + 2 * k * LENGTH, 2 * (k + 1) * LENGTH - way):
                expected += RHO * C * speed * step(time, arrival / C)
    assert theory.Spall(case).stress(z, time) == pytest.approx(expected, rel=1e-12, abs=1e-6)


@pytest.mark.parametrize("z", [-3.1, -0.7, 0.9, 2.3])
def test_stress_of_a_bar_that_breaks(z):
    """Two bars of half the length: the new free ends turn waves over, and the pulled ends send them back as they come."""
    case = spall_case(boundary=pulled(-2, 3), interface={"strength": RHO * C * 5, "energy": 1})
    time, half = np.linspace(0, 3.7 * LENGTH / C, 5001), LENGTH / 2
    way, speed = min(4 - z, z + 4), 3 if z > 0 else 2
    expected = np.zeros_like(time)
    for k in range(8):
        expected += (-1) ** k * (step(time, (2 * k * half + way) / C) - step(time, (2 * (k + 1) * half - way) / C))
    assert theory.Spall(case).stress(z, time) == pytest.approx(RHO * C * speed * expected, rel=1e-12, abs=1e-6)


def test_stress_at_the_end_itself():
    bar = theory.Spall(spall_case(interface={"strength": 1e12, "energy": 1}))
    time = np.array([0.0, 0.9, 1.1]) * LENGTH / C
    assert bar.stress(4.0, time) == pytest.approx(INCIDENT * np.array([1, 1, 3]))


def test_events():
    bar = theory.Spall(spall_case(interface={"strength": 2 * INCIDENT, "energy": 1}))
    assert bar.events(1.5) == [(pytest.approx(2.5 / C), "wave arrives"), (pytest.approx(4 / C), "waves meet"),
                               (pytest.approx(5.5 / C), "unloading arrives")]
    assert [time for time, _ in bar.events(-1.5)] == pytest.approx([2.5 / C, 4 / C, 5.5 / C])
    whole = theory.Spall(spall_case(interface={"strength": 1e12, "energy": 1}))
    assert whole.events(1.5)[2] == (pytest.approx(5.5 / C), "second wave arrives")


STEEL = {"name": "steel", "model": "neo-hookean", "young": 210e9, "poisson": 0.3, "density": 7800}
NO_SPALL = [
    ({"materials": [STEEL]}, "one material; this case has material, steel"),
    ({"material": {**STEEL, "model": "deshpande-evans"}}, "this case has deshpande-evans"),
    ({"mesh": {"file": "bar.h5"}}, "built-in box"), ({"mesh": None}, "built-in box"),
    ({"boundary": []}, "pulled at both ends"), ({"boundary": None}, "pulled at both ends"),
    ({"boundary": pulled(-7, 7)[:-1]}, "pulled at both ends"), ({"boundary": pulled(-7, 7)[1:]}, "pulled at both ends"),
    ({"boundary": pulled(-7, 7)[:2]}, "cannot move at their sides"),
    ({"boundary": [*pulled(-7, 7)[:-1], {"set": "y+", "component": "x", "velocity": 0}]}, "cannot move at their sides"),
    ({"boundary": [*pulled(-7, 7)[:-1], {"set": "y+", "component": "y", "velocity": 1}]}, r"no motion of y\+ along y"),
    ({"boundary": [*pulled(-7, 7), {"set": "x+", "component": "z", "velocity": 0}]}, r"no motion of x\+ along z"),
    ({"boundary": [*pulled(-7, 7)[1:], {"set": "z+", "component": "z", "displacement": 1e-3}]}, r"no motion of z\+ along z"),
    ({"boundary": pulled(-7, "7*t")}, r"\(z\+\) is for plain numbers, not '7\*t'"),
    ({"initial": {"velocity": {"z": "x"}}}, "bars at rest"), ({"bodies": [{}]}, "without rigid bodies"),
    ({"interface": {"strength": 1e6, "sets": [{}]}}, "faces of one strength"),
    ({"interface": {"strength": 1e6, "weibull": {}, "sets": None}}, None),
    ({"interface": {"strength": 1e6, "weibull": {"modulus": 10}}}, "faces of one strength"),
]


@pytest.mark.parametrize("sections, complaint", NO_SPALL)
def test_cases_that_are_no_spall_test(sections, complaint):
    case = spall_case(**sections)
    if complaint is None:
        assert theory.of(case) is not None
        return
    with pytest.raises(rhegma.BadInput, match=complaint):
        theory.Spall(case)
    assert theory.of(case) is None


def test_displacements_of_nothing_hold_the_sides():
    held = [{"set": m["set"], "component": m["component"], "displacement": 0} if m["set"][0] != "z" else m
            for m in pulled(-7, 7)]
    assert theory.of(spall_case(boundary=[*held, {"set": "z+", "component": "x", "velocity": 0}])) is not None


# ---- theory.py: bars that ring, rows of springs, fragments ----


def test_half_period_of_the_free_bar():
    """Rayleigh-Love: (L/c) sqrt(1 + nu^2 (a^2 + b^2)/12 (pi/L)^2), c^2 = E/rho."""
    case = spall_case(boundary=[], mesh={"size": [1.5, 3, 8]})
    assert theory.free_bar_half_period(case) == pytest.approx(
        8 / math.sqrt(4e9 / 3000) * math.sqrt(1 + (0.25 * math.pi / 8) ** 2 * (1.5**2 + 3**2) / 12), rel=1e-14)
    for sections, complaint in (({"materials": [STEEL]}, "one material"), ({"mesh": {"file": "x"}}, "built-in box"),
                                ({"boundary": pulled(0, 0)}, "nothing holds"), ({"bodies": [{}]}, "nothing holds"),
                                ({"material": {**STEEL, "model": "j2"}}, "has j2")):
        with pytest.raises(rhegma.BadInput, match=complaint):
            theory.free_bar_half_period({**case, **sections})


def test_half_period_by_least_squares():
    """The kinetic energy of a mode of half period T has period T."""
    time = np.linspace(0, 10, 400)
    ringing = synthetic.structured({"time": time, "kinetic": 3 + 1.2 * np.cos(2 * np.pi * time / 0.8123 + 0.4)})
    assert theory.half_period(ringing, 0.81, 1e-2) == pytest.approx(0.8123, rel=6e-9)
    assert theory.half_period(ringing, 0.7, 0.2) == pytest.approx(0.8123, rel=1.2e-7)
    assert abs(theory.half_period(ringing, 0.7, 1e-2) / 0.7 - 1) < 1.02e-2  # no farther than that
    assert theory.half_period(ringing[:3], 0.81, 1e-2) == pytest.approx(0.81, rel=1.02e-2)  # too few rows to tell


def test_speed_through_springs():
    """Thesis 3.10: E_eff/E = 1 - 1/(1 + s h/E) = s h/(E + s h), two springs in a row."""
    for ratio in (0.3, 1.0, 30.0):
        assert theory.slowed(ratio) ** 2 == pytest.approx(ratio / (1 + ratio), rel=1e-14)
    assert theory.slowed([1, 3]) == pytest.approx(np.sqrt([0.5, 0.75]))


def test_fragment_sizes():
    case = spall_case(interface={"strength": 4e6, "energy": 30.0})
    bar = theory.Stretched(case)
    assert bar.length == 8 and bar.material.young == pytest.approx(4e9) and (bar.strength, bar.energy) == (4e6, 30)
    for rate in (1.0, 30.0, 1e4):
        s = bar.grady(rate)
        assert 3000 * rate**2 * s**3 / 24 == pytest.approx(30, rel=1e-12)
        s = bar.glenn_chudnovsky(rate)
        assert s > 0 and 3000 * rate**2 * s**3 / 24 + 4e6**2 * s / (2 * 4e9) == pytest.approx(30, rel=1e-9)


@pytest.mark.parametrize("sections, complaint", [
    ({"materials": [STEEL]}, "one material"), ({"material": {**STEEL, "model": "j2"}}, "has j2"),
                                                 ({"mesh": {"file": "x"}}, "built-in box"),
    ({"interface": {"law": "none"}}, "nothing can break"), ({"interface": {"strength": 1e6}}, "nothing can break"),
    ({"interface": None}, "nothing can break"), ({"interface": {"strength": "a", "energy": 1}}, "plain numbers, not 'a'")])
def test_cases_without_fragment_sizes(sections, complaint):
    with pytest.raises(rhegma.BadInput, match=complaint):
        theory.Stretched(spall_case(**sections))


# ---- drawing.py ----


@pytest.mark.parametrize("value, unit, keywords, factor, name", [
    (2e-7, "s", {}, 1e9, "ns"), (4.4e-7, "s", {"least": 0.1}, 1e6, "µs"), (0.99e-7, "s", {"least": 0.1}, 1e9, "ns"),
    (5.0, "Pa", {}, 1, "Pa"), (1e3, "Pa", {}, 1e-3, "kPa"), (999.0, "Pa", {}, 1, "Pa"), (2e8, "Pa", {}, 1e-6, "MPa"),
    (3e11, "Pa", {}, 1e-9, "GPa"), (5e13, "Pa", {}, 1e-9, "GPa"), (4e-3, "m", {}, 1e3, "mm"), (5e-12, "J", {}, 1e9, "nJ"),
    (1.6e-7, "m", {"power": 2}, 1e12, "µm²"), (2e-6, "m", {"power": 2}, 1e6, "mm²"), (0, "s", {}, 1, "s"),
                                                                 (math.inf, "s", {}, 1, "s"),
    (1e-6, "m", {}, 1e6, "µm"), (1e-7, "s", {"least": 0.1}, 1e6, "µs")])
def test_units(value, unit, keywords, factor, name):
    found = drawing.prefixed(value, unit, **keywords)
    assert found == (pytest.approx(factor, rel=1e-12), name)


def test_values_with_units():
    assert drawing.with_unit(2.246e-7, "s") == "0.2246 µs"
    assert drawing.with_unit(-3e-6, "J") == "-3 µJ"
    assert drawing.with_unit(1.6e-7, "m", 2) == "0.16 mm²"
    assert drawing.place([0, -2e-4, 1.5e-3]) == "(0, -0.2, 1.5) mm"
    assert drawing.place([0, 0, 1.5e-4]) == "(0, 0, 0.15) mm"


def test_pictures_are_saved_and_told(tmp_path, capsys):
    path = tmp_path / "new" / "one" / "a.png"
    drawing.save(drawing.plt.figure(), path)
    assert path.read_bytes()[:4] == b"\x89PNG" and capsys.readouterr().out == f"{path}\n"
    assert not drawing.plt.get_fignums()
    (tmp_path / "file").write_text("")
    with pytest.raises(rhegma.BadInput, match="file/a.png: cannot be written: "):
        drawing.save(drawing.plt.figure(), tmp_path / "file" / "a.png")
    drawing.plt.close("all")


def test_titles_stand_at_the_left():
    figure = drawing.plt.figure()
    assert figure.get_size_inches() == pytest.approx((8.5, 4.2)) and figure.get_constrained_layout()
    drawing.add_title(figure, "words")
    assert figure._suptitle.get_text() == "words" and figure._suptitle.get_position()[0] == 0.02
    assert figure._suptitle.get_ha() == "left"
    drawing.plt.close(figure)


def test_notes_are_small_words_beside_their_place():
    axes = drawing.plt.figure().add_subplot()
    words = drawing.note(axes, "here", (0.5, 0.25))
    assert (words.get_text(), words.xy, words.xyann, words.anncoords) == ("here", (0.5, 0.25), (3, 2), "offset points")
    assert words.get_fontsize() == 8 and words.get_color() == drawing.GREY
    assert drawing.note(axes, "red", (0, 0), (7, 8), color="r").xyann == (7, 8) and axes.texts[1].get_color() == "r"
    drawing.plt.close("all")


def test_a_run_is_made_and_read(tmp_path, monkeypatch):
    """Everything that Run reads is of its directory, and what the functions of the module read."""
    seen = []
    monkeypatch.setattr(launch, "run", lambda *words, **keywords: seen.append((words, keywords)))
    synthetic.write_run(tmp_path, history={"time": [1.0], "p-1_szz": [2.0]}, fragments={"time": [1.0], "id": [0.0], "mass": [3.0]})
    cells, corners = np.arange(10).reshape(1, 10), np.arange(9.0).reshape(3, 3)
    synthetic.write_fields(tmp_path, synthetic.box_points([0, 0, 0], [1, 2, 3]), cells, [
        {"time": 1.0, "stress": np.full((2, 6), 4.0)}, {"time": 2.0, "crack/points": corners, "crack/damage": np.array([[0.5]])}])
    made = rhegma.run("a.yaml", tmp_path, {"b": 1}, ["c=2"], quiet=False)
    assert seen == [(("a.yaml", tmp_path, {"b": 1}, ["c=2"]), {"quiet": False})]
    assert made.summary["elements"] == 12345 and made.case["material"]["young"] == 4e9
    assert made.energy["step"].tolist() == [10, 20, 30, 40] and made.history["p-1_szz"].tolist() == [2]
    assert made.fragments["mass"].tolist() == [3] and np.ptp(made.points(), axis=0).tolist() == [1, 2, 3]
    assert [frame["time"] for frame in made.frames()] == [1, 2] and made.fields(0)["stress"].shape == (2, 6)
    assert sorted(made.fields()) == ["crack/damage", "crack/points", "time"] and sorted(made.fields(0, ["crack"])) == ["time"]
    assert made.crack()["points"].tolist() == [corners.tolist()] and made.crack()["damage"].tolist() == [0.5]
    assert made.crack(0) is None


def test_an_example_is_found_by_the_name_of_a_file():
    assert rhegma.example("spall-jittered.yaml") == launch.ROOT / "bench/examples/spall/spall-jittered.yaml"
    with pytest.raises(rhegma.BadInput, match="no files are called spal.yaml"):
        rhegma.example("spal.yaml")
    with pytest.raises(rhegma.BadInput, match=r"\d+ files are called README.md"):
        rhegma.example("README.md")
