"""Parts that touch: joined by --merge, or kept apart by --apart and left to contact."""

import re

import numpy as np
import pytest
from conftest import launch
from test_fragment_contact import H, HELD, SPEED, deck, material
from test_restart import assert_same_results, checkpoints, copy, go_on

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
    figure("displacement that a pulse leaves beyond parts that touch", passed, theory=1 - late, bound=4e-4)
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
    steps = one.summary["steps"]
    assert one.summary["contacts"] > 0
    for ranks, threads in ((2, 1), (3, 1), (1, 2)):
        assert run(path, ranks=ranks, threads=threads, sets=sets).summary["state_hash"] == one.summary["state_hash"]
    stopped = copy(run(path, ranks=2, sets={**sets, "time.steps": steps - 8}), tmp_path / "out")
    checkpoints(stopped)[-1].unlink()
    again = go_on(stopped, "--set", "time.steps=100000", ranks=3)
    assert 0 < again.summary["restarted_from_step"] < steps - 8
    assert_same_results(again, one, frames=4)


def test_both_ways_are_offered(scratch):
    """Where nodes coincide, and where one part's lie on faces of the other."""
    for name, boxes, what in (("match", bars(1), "different vertices at the same place"), ("hang", bars(2), "different vertices"),
                              ("shift", [bars(1)[0], ((-0.7 * H, -0.6 * H, 0), (H, H, H), (1, 1, 1))], "a hanging node")):
        said = make(scratch, name, boxes, expect=2).stderr
        assert what in said and "rhegma mesh joins nodes that coincide by --merge D, or keeps parts apart by --apart" in said
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
