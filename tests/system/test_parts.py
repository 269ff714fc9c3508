"""Parts that touch: joined by --merge, or kept apart by --apart and left to contact."""

import re

import numpy as np
import pytest
from conftest import SINGLE, launch, rounding
from figures import ROUNDING
from test_fragment_contact import H, HELD, SPEED, YOUNG, deck, material
from test_restart import assert_same_results, gone_on_anywhere

LENGTH = 30  # elements along a bar
PULSE = 16 * H / SPEED  # a wave 16 elements long
SKIN = 2e-3 * H  # of contact
PUSH = 100.0  # m/s, at its crest: it moves the bars by 16 um, 80 times the skin of contact
END = 68 * H / SPEED  # it is past the probe, amid the second bar, at 61, and is back there at 75


def bars(across, start=0):
    """Two bars end to end, the second one of so many elements across, which begins at `start` elements from the first."""
    return [((-H, -H, -LENGTH * H), (2 * H, 2 * H, LENGTH * H), (1, 1, LENGTH)), ((-H, -H, start * H), (2 * H, 2 * H, LENGTH * H), (across, 1, LENGTH))]


def make(folder, name, boxes, *options, expect=0):
    (folder / f"{name}.inp").write_text(deck(boxes))
    process = launch("mesh", folder / f"{name}.inp", "-o", folder / f"{name}.h5", *options)
    assert process.returncode == expect, process.stderr
    return process


@pytest.fixture(scope="module")
def pulse(scratch):
    """pulse(mesh, more): a case in which a pulse runs along both bars of mesh.h5."""
    def write(name, model="general"):
        path = scratch / f"{name}-{model}.yaml"
        push = f', {{set: zlow, component: z, velocity: "t < {PULSE} ? {PUSH / 2}*(1 - cos(2*pi*t/{PULSE})) : 0"}}]\n'
        path.write_text(f"defaults: 1\nmesh: {{file: {name}.h5}}\ninterface: {{law: none}}\ncontact: {{model: {model}}}\n{material()}"
                        f"{HELD.rstrip(']' + chr(10))}{push}time: {{end: {END}}}\ncheckpoint: {{steps: 100, keep: 100}}\n"
                        f"output: {{interval: {END / 4}, fields: [velocity], probes: [{{name: far, at: [0.3e-4, 0.2e-4, {LENGTH / 2 * H}]}}]}}\n")
        return path
    return write


@pytest.fixture(scope="module")
def apart(scratch):
    said = make(scratch, "apart", bars(2), "--apart").stdout
    touch = re.search(r"parts 1 and 2 touch: 2 and 4 faces on (\S+) m2 around \((\S+), (\S+), (\S+)\) m, with gaps of 0 to 0 m\n", said)
    assert float(touch[1]) == pytest.approx(4 * H * H, rel=1e-3)
    assert np.abs([float(touch[k]) for k in (2, 3, 4)]).max() < 1e-12 * H
    assert "parts          2 that share no face, kept apart where they share no node: 180 360 elements\n" in launch("mesh", "--info", scratch / "apart.h5").stdout
    return "apart"


def test_a_wave_goes_from_part_to_part(run, figure, scratch, pulse, apart):
    """Meshes that do not match, by contact; its twin is one bar whose nodes were merged. Both pass on the momentum."""
    assert "nodes merged" in make(scratch, "whole", bars(1), "--merge", "1e-9").stdout
    one, two = (run(pulse(name)) for name in (apart, "whole"))
    passed, whole = (r.history["far_uz"][-1] / (PUSH * PULSE / 2) for r in (one, two))
    late = SKIN / 2 / (PUSH * PULSE / 2)  # an end moves twice as far until it is through the skin, and throws that back
    figure("displacement that a pulse leaves beyond parts that touch", passed, theory=1 - late, bound=3.5e-4)
    figure("displacement that a pulse leaves in one bar", whole, theory=1, bound=1e-4)
    figure("crest of a pulse beyond parts that touch", one.history["far_vz"].max() / two.history["far_vz"].max(), theory=1, bound=5e-3)
    assert one.summary["contacts"] > 0 and one.summary["overlaps"] == 0 and "kept apart" not in one.stderr


def test_parts_without_contact_are_told(run, pulse, apart):
    """Once, and nothing goes from one to the other."""
    result = run(pulse(apart, "interfaces"), ranks=2)
    assert result.stderr.count("its 2 parts are kept apart (rhegma mesh --apart) and do not see each other") == 1
    assert np.abs(result.history["far_uz"]).max() == 0


def test_parts_are_the_same_on_any_layout_and_after_a_restart(run, pulse, apart, tmp_path):
    path, sets = pulse(apart), {"time.end": 33 * H / SPEED, "output.interval": 8 * H / SPEED}  # the pulse has begun to pass
    one = run(path, sets=sets)
    assert one.summary["contacts"] > 0
    for ranks, threads in ((2, 1), (3, 1), (1, 2)):
        assert run(path, ranks=ranks, threads=threads, sets=sets).summary["state_hash"] == one.summary["state_hash"]
    assert_same_results(gone_on_anywhere(run, path, sets, one.summary["steps"], tmp_path / "out"), one, frames=4)


def test_both_ways_are_offered(scratch):
    """Where nodes coincide, and where one part's lie on faces of the other."""
    for name, boxes, what in (("match", bars(1), "different vertices at the same place"), ("hang", bars(2), "different vertices"),
                              ("shift", [bars(1)[0], ((-0.7 * H, -0.6 * H, 0), (H, H, H), (1, 1, 1))], "a hanging node")):
        said = make(scratch, name, boxes, expect=2).stderr
        assert what in said and "rhegma mesh joins nodes that coincide by --merge D, keeps parts apart by --apart, or takes faces that lie on each other for a crack by --crack NAME" in said
    make(scratch, "shift", [bars(1)[0], ((-0.7 * H, -0.6 * H, 0), (H, H, H), (1, 1, 1))], "--apart")


def test_parts_in_each_other_are_refused(scratch):
    """Named, with the deepest elements of each pair; also one that is inside another, of which no faces meet."""
    said = make(scratch, "sunk", bars(2, -0.25), "--apart", expect=2).stderr
    assert re.search(r"parts 1 and 2 lie in each other: elements \d+ and \d+ by 2.5e-05 m", said)
    block = ((-4 * H, -4 * H, 5 * H), (8 * H, 8 * H, 8 * H), (1, 1, 1))
    said = make(scratch, "inside", [bars(1)[0], block, ((0.1 * H, 0.2 * H, 8 * H), (H, H, H), (1, 1, 1))], "--apart", expect=2).stderr
    assert "parts 2 and 3 lie in each other" in said and "parts 1" not in said
    make(scratch, "skin", bars(2, -5e-4), "--apart")  # within what contact takes


def test_one_part_has_nothing_to_keep_apart(scratch):
    said = make(scratch, "one", bars(1)[:1], "--apart").stderr
    assert "--apart: all elements hang together by their nodes: there is one part" in said
    assert "kept apart" not in launch("mesh", "--info", scratch / "one.h5").stdout


def test_nodes_are_merged_before_parts_are_kept_apart(scratch):
    """Two of three bars become one."""
    third = ((H, -0.9 * H, 0.3 * H), (2 * H, 1.8 * H, (LENGTH - 0.5) * H), (1, 3, 3))
    said = make(scratch, "both", [*bars(1), third], "--merge", "1e-9", "--apart").stdout
    assert "parts 1 and 2 touch: 60 and 18 faces" in said and "parts 2 and 3" not in said


def test_merged_parts_are_glued_by_a_law_between_them(run, figure, scratch):
    """`between: any` finds the faces where nodes were merged: pulled, the bars part there and nowhere else."""
    text = deck(bars(1)).replace("\n*NSET", f"\n*ELSET, ELSET=lower, GENERATE\n1, {6 * LENGTH}\n*ELSET, ELSET=upper, GENERATE\n{6 * LENGTH + 1}, {12 * LENGTH}\n*NSET", 1)
    (scratch / "glued.inp").write_text(text)
    assert launch("mesh", scratch / "glued.inp", "-o", scratch / "glued-bars.h5", "--merge", "1e-9").returncode == 0
    pull = ", ".join(f"{{set: z{side}, component: z, velocity: {v}}}" for side, v in (("low", -5), ("high", 5)))
    (scratch / "glued-bars.yaml").write_text(
        f"mesh: {{file: glued-bars.h5}}\n{material()}interface: {{law: linear, strength: 1e12, energy: 1e6, sets: [{{between: any, strength: 1e5, energy: 1e-3}}]}}\n"
        f"{HELD.rstrip(']' + chr(10))}, {pull}]\ntime: {{end: {1.2 * LENGTH * H / SPEED}}}\noutput: {{interval: {LENGTH * H / SPEED}, fields: []}}\n")
    summary = run(scratch / "glued-bars.yaml", ranks=2).summary
    figure("area that breaks where merged parts are glued", summary["broken_area_m2"], theory=4 * H * H, bound=rounding(1e-14, 1e-6), unit="m2", relative=True, why=ROUNDING)
    assert summary["fragments"] == 2


# ---- Cracks of no width ----


@pytest.fixture(scope="module")
def notched(scratch):
    """A block of 4 x 1 x 4 cells, split amid its height where x < 0: there the lower and the upper half have nodes of their own."""
    size = (4 * H, H, 2 * H)
    text = deck([((-2 * H, 0, -2 * H), size, (4, 1, 2)), ((-2 * H, 0, 0), size, (4, 1, 2))])
    nodes, rest = text.split("*ELEMENT, TYPE=C3D4\n")
    elements, sets = rest.split("*NSET", 1)
    place = {int(line.split(",")[0]): tuple(map(float, line.split(",")[1:])) for line in nodes.splitlines()[1:]}
    lower = {x: n for n, x in place.items() if n <= len(place) // 2}
    stands_for = {n: lower[x] if x in lower and x[0] > -1e-9 * H else n for n, x in place.items()}
    lines = [[int(word) for word in line.split(",")] for line in elements.splitlines()]
    elements = "".join(", ".join(map(str, [e, *(stands_for[n] for n in nodes)])) + "\n" for e, *nodes in lines)
    (scratch / "notched.inp").write_text(f"{nodes}*ELEMENT, TYPE=C3D4\n{elements}*NSET{sets}")
    said = {}
    for name, *options in (("refused",), ("crack", "--crack", "flaw"), ("glued", "--merge", "1e-9")):
        said[name] = launch("mesh", scratch / "notched.inp", "-o", scratch / f"{name}.h5", *options)
    assert said["refused"].returncode == 2 and "by --crack NAME" in said["refused"].stderr
    assert re.search(r"crack 'flaw': 4 faces, 2e-08 m2 around \(-0.0001, 5e-05, \S+\) m, open from the start", said["crack"].stdout), said["crack"].stderr
    info = launch("mesh", "--info", scratch / "crack.h5").stdout
    assert "surface set    flaw: 0 faces, and 4 between elements\n" in info and "crack          flaw: open from the start\n" in info
    return scratch


def pressed(folder, name, traction, more=""):
    path = folder / f"{name}-{traction:g}-{len(more)}.yaml"
    path.write_text(f"defaults: 1\nmesh: {{file: {name}.h5}}\ninterface: {{law: linear, strength: 1e9, energy: 1e3{more}}}\nstart: static\n{material()}"
                    f"loads: [{{set: zhigh, traction: {{z: {traction}}}}}]\n"
                    "boundary: [{set: zlow, component: z, displacement: 0}, {set: ylow, component: y, displacement: 0}, {set: xhigh, component: x, displacement: 0}]\n"
                    f"time: {{end: {H / SPEED}}}\noutput: {{interval: {H / SPEED}, fields: [stress], probes: [{{name: over, at: [{-1.9 * H}, {H / 2}, {0.1 * H}]}}]}}\n")
    return path


@pytest.mark.skipif(SINGLE, reason="bounds of a static start in double precision")
def test_a_crack_opens_and_presses_shut(run, figure, notched):
    """Its twin is the block whose nodes were merged, which stretches and shrinks by the stress over Young's modulus."""
    stress = 1e6
    there = {(name, sign): run(pressed(notched, name, sign * stress)).history["over_uz"][0] for name in ("crack", "glued") for sign in (-1, 1)}
    whole = 2.1 * H * stress / YOUNG
    figure("block without a crack, stretched", there["glued", 1] / whole, theory=1, bound=1.1e-9)
    soft = H / 2 * stress / YOUNG  # what contact gives way: its stiffness is beta_s E/h, 2 E/H
    figure("block with a crack of no width, pressed shut", there["crack", -1] / -(whole + soft), theory=1, bound=6e-3)
    assert there["crack", 1] > 3 * whole


@pytest.mark.skipif(SINGLE, reason="bounds of a static start in double precision")
def test_a_crack_is_the_same_on_any_layout_and_in_other_words(run, notched):
    """As the mesh brings it, and as the case names it; in words that take it back it is glued."""
    path = pressed(notched, "crack", 1e6)
    one = run(path)
    assert {run(path, ranks=n).summary["state_hash"] for n in (2, 3)} == {one.summary["state_hash"]}
    assert "set: \"flaw\"" in (one.dir / "case.yaml").read_text()
    named = run(pressed(notched, "crack", 1e6, ", sets: [{set: flaw, open: true}]"))
    assert named.summary["state_hash"] == one.summary["state_hash"]
    held = run(pressed(notched, "crack", 1e6, ", sets: [{set: flaw, strength: 1e9}]"))
    assert held.history["over_uz"][0] == pytest.approx(2.1 * H * 1e6 / YOUNG, rel=1e-5)
    beside = run(pressed(notched, "crack", 1e6, ', sets: [{where: "abs(z) < 1e-9", strength: 2e9}]'))  # does not close it
    assert beside.history["over_uz"][0] == pytest.approx(one.history["over_uz"][0], rel=1e-6)
    process = launch("check", path, "--set", "interface={law: none}")
    assert process.returncode == 2 and "its crack, set 'flaw', is open from the start, which needs a law" in process.stderr


def test_no_crack_where_none_is(scratch):
    assert "--crack flaw: no two faces lie on each other" in make(scratch, "sound", bars(1)[:1], "--crack", "flaw", expect=2).stderr
