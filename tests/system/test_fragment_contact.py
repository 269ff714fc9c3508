"""Contact between faces that share no interface: parts of a mesh, and fragments that come back."""

import itertools

import numpy as np
import pytest
from conftest import CASES, launch, rounding

H, DENSITY, YOUNG = 1e-4, 8000, 200e9  # speed 5000 m/s for a Poisson's ratio of 0
SPEED = (YOUNG / DENSITY) ** 0.5


def deck(boxes):
    """An Abaqus deck of boxes (origin, size, cells), each cell six tetrahedra, with the sides of all as node sets."""
    nodes, elements = [], []
    for origin, size, cells in boxes:
        first, count = len(nodes) + 1, [n + 1 for n in cells]

        def number(i, j, k):
            return first + i + count[0] * (j + count[1] * k)

        for k, j, i in itertools.product(*(range(n) for n in reversed(count))):
            nodes.append([o + s * m / n for o, s, m, n in zip(origin, size, (i, j, k), cells)])
        for k, j, i in itertools.product(*(range(n) for n in reversed(cells))):
            for axes in itertools.permutations(range(3)):
                at, corners = [i, j, k], [number(i, j, k)]
                for axis in axes:
                    at[axis] += 1
                    corners.append(number(*at))
                elements.append(corners)
    text = ["*NODE", *(f"{n + 1}, {x!r}, {y!r}, {z!r}" for n, (x, y, z) in enumerate(nodes)), "*ELEMENT, TYPE=C3D4",
            *(", ".join(map(str, [e + 1, *corners])) for e, corners in enumerate(elements))]
    for axis, name in enumerate("xyz"):
        ends = [pick(x[axis] for x in nodes) for pick in (min, max)]
        for word, end in zip(("low", "high"), ends):
            text += [f"*NSET, NSET={name}{word}", *(str(n + 1) for n, x in enumerate(nodes) if abs(x[axis] - end) < 1e-9 * H)]
    return "\n".join(text) + "\n"


@pytest.fixture(scope="module")
def case(scratch):
    """case(name, boxes, text): a case file beside its mesh."""
    def make(name, boxes, text):
        folder = scratch / name
        folder.mkdir(exist_ok=True)
        (folder / "mesh.inp").write_text(deck(boxes))
        process = launch("mesh", folder / "mesh.inp", "-o", folder / "mesh.h5")
        assert process.returncode == 0, process.stderr
        (folder / f"{name}.yaml").write_text("defaults: 1\nmesh: {file: mesh.h5}\ninterface: {law: none}\ncontact: {model: general}\n" + text)
        return folder / f"{name}.yaml"
    return make


HELD = "boundary: [" + ", ".join(f"{{set: {axis}{end}, component: {axis}, velocity: 0}}" for axis in "xy" for end in ("low", "high")) + "]\n"


def material(poisson=0.0):
    return f"material: {{model: linear-elastic, young: {YOUNG}, poisson: {poisson}, density: {DENSITY}}}\n"


def bars(case, one, two, gap=1e-3):
    """Bars of so many cells, of one and of two elements across, the first one at 1 m/s towards the other."""
    boxes = [((-H, -H, -(one + gap) * H), (2 * H, 2 * H, one * H), (1, 1, one)), ((-H, -H, 0), (2 * H, 2 * H, two * H), (2, 1, two))]
    end = (2 * max(one, two) + 35) * H / SPEED
    return case(f"bars-{one}-{two}", boxes, material() + HELD + f'initial: {{velocity: {{z: "z < {-gap / 2 * H} ? 1 : 0"}}}}\n'
                f"time: {{end: {end}}}\noutput: {{interval: {end / 2}, fields: []}}\n")


@pytest.mark.parametrize("one, two, restitution, bound", [(60, 60, 1, 5e-3), (30, 60, 0.5, 0.015)])
def test_bars_part_as_waves_tell(run, figure, case, one, two, restitution, bound):
    """Wave solution: a bar gives all its momentum to one as long or longer. What stays with it is that of a front's tail, some
    elements long: it falls with the number of elements."""
    result = run(bars(case, one, two))
    last = result.fragments[-2:]
    velocity = last["momentum_z"] / last["mass"]
    figure("restitution of bars", (velocity[1] - velocity[0]) / 1.0, theory=restitution, bound=bound)
    assert result.summary["contacts"] > 4 and result.summary["overlaps"] == 0
    assert result.summary["contact_impulse_Ns"] == pytest.approx(last["momentum_z"][1], rel=1e-2)
    assert result.summary["energy_error_rel"] < 2e-4
    assert (last["touches"] >= [2, 4]).all() and (last["touches"] < 40).all()  # elements of the end faces, each once or twice
    assert sum(last["contact_impulse"]) == pytest.approx(2 * result.summary["contact_impulse_Ns"], rel=1e-12)


def test_cradle_of_bars(run, figure, case):
    """Three bars of 30 elements, one and two across in turn: the last one goes off with the momentum of the first. Of 60 as of
    30 elements each front leaves a tail (test_bars_part_as_waves_tell), so that a part of it stays behind."""
    length, gap = 30, 1e-3
    starts = [b * (length + gap) * H for b in range(3)]
    boxes = [((0, 0, z), (H, H, length * H), (1 + b % 2, 1 + b % 2, length)) for b, z in enumerate(starts)]
    end = (4 * length + 40) * H / SPEED + gap * H
    result = run(case("cradle", boxes, material() + HELD + f'initial: {{velocity: {{z: "z < {starts[1] - gap / 2 * H} ? 1 : 0"}}}}\n'
                      f"time: {{end: {end}}}\noutput: {{interval: {end / 2}, fields: []}}\n"))
    last = result.fragments[-3:]
    velocity = last["momentum_z"] / last["mass"]
    figure("velocity of the last bar of a cradle", velocity[2], theory=1, bound=1e-2, unit="m/s")
    assert max(abs(velocity[:2])) < 5e-3 and result.summary["overlaps"] == 0
    assert result.summary["energy_error_rel"] < 2e-4


@pytest.mark.parametrize("damping", [0, 0.3, 0.8])
def test_damped_blocks_part_as_theory_tells(run, figure, case, damping):
    """Two blocks, stiff beside their contact, strike at v = 1 m/s: whatever its potential, f (1 + c d') leaves them e v with
    c v (1 + e) = ln((1 + c v)/(1 - c e v)), and no momentum; what is missing is heat."""
    boxes = [((0, 0, -2.002 * H), (2 * H, 2 * H, 2 * H), (2, 2, 2)), ((0, 0, 0), (2 * H, 2 * H, 2 * H), (3, 3, 2))]
    path = case(f"blocks-{damping}", boxes, material(0.2) + f'initial: {{velocity: {{z: "z < {-0.001 * H} ? 0.5 : -0.5"}}}}\n'
                "time: {end: 1.8e-6}\noutput: {interval: 0.9e-6, fields: []}\n")
    result = run(path, sets={"contact.penalty": 0.01, "contact.damping": damping})
    low, high = 0, 1
    for _ in range(50 * (damping > 0)):
        e = (low + high) / 2
        low, high = (e, high) if np.log((1 + damping) / (1 - damping * e)) < damping * (1 + e) else (low, e)
    last = result.fragments[-2:]
    velocity = last["momentum_z"] / last["mass"]
    found = velocity[1] - velocity[0]
    figure("restitution of blocks with damped contact", found, theory=high, bound=1e-2)
    assert abs(sum(last["momentum_z"])) < rounding(1e-12, 1e-5) * last["mass"][0]
    lost = 0.5 * last["mass"].sum() / 4 * (1 - found**2)
    assert result.energy["friction"][-1] == pytest.approx(lost if damping > 0 else 0, rel=1e-3)
    figure("energy error of blocks with damped contact", result.summary["energy_error_rel"], bound=rounding(1.4e-5, 1e-4))


def test_a_run_that_fails_has_its_last_energies_once(run, case):
    """Where damping shortens the step by more than the case allows, the row of the state that follows is that of a run that goes
    on: forces are computed once more for it, but what they take is not taken twice."""
    boxes = [((0, 0, -2.002 * H), (2 * H, 2 * H, 2 * H), (2, 2, 2)), ((0, 0, 0), (2 * H, 2 * H, 2 * H), (3, 3, 2))]
    velocity = f'x: "z < {-0.001 * H} ? 0.2 : 0", z: "z < {-0.001 * H} ? 0.5 : -0.5"'
    path = case("fails", boxes, material(0.2) + f"initial: {{velocity: {{{velocity}}}}}\ntime: {{end: 0.6e-6}}\n"
                "output: {interval: 1, fields: [], fragments: none}\n")
    sets = {"contact.penalty": 0.01, "contact.damping": 0.8, "contact.friction": 0.2}
    whole = run(path, sets=sets)
    failed = run(path, sets={**sets, "time.collapse": 0.9, "output.interval": 1000}, expect=1)
    at = list(whole.energy["step"]).index(failed.energy["step"][-1])
    assert failed.energy["friction"][-1] > 0 and failed.energy["time"][-1] > 0.4e-6
    for part in ("time", "kinetic", "bulk", "contact", "friction"):
        assert failed.energy[part][-1] == whole.energy[part][at], part


def test_pressure_goes_through_faces_that_do_not_match(run, figure, case):
    """Two blocks in a die, of 2 and 3 cells across, under a pressure that rises slowly: the same stress in all elements."""
    pressure, end = 1e8, 160 * H / SPEED
    boxes = [((0, 0, 0), (2 * H, 2 * H, 2 * H), (2, 2, 2)), ((0, 0, 2.001 * H), (2 * H, 2 * H, 2 * H), (3, 3, 3))]
    path = case("die", boxes, material(0.25) + HELD.rstrip("]\n") + ", {set: zlow, component: z, velocity: 0}, {set: zhigh, absorbing: true}]\n"
                f'loads: [{{set: zhigh, pressure: "{pressure / 2}*(1 - cos(pi*t/{end}))"}}]\n'
                f"time: {{end: {end}}}\noutput: {{interval: {end}, fields: [stress, contact], fragments: none, "
                f'contacts: [{{name: upper, where: "z > {1.9 * H} && z < {2.1 * H} && nz < -0.9"}}, {{name: all, where: 1}}, {{name: side, set: xlow}}]}}\n')
    result = run(path)
    frame, history = result.frames()[-1], result.history
    figure("stress across faces that do not match", abs(frame["stress"][:, 5] / -pressure - 1).max(), bound=1e-2)
    pressed, traction = frame["contact_pressure"].ravel(), np.linalg.norm(frame["contact_traction"], axis=1)
    faces = pressed > 0.5 * pressure  # two elements on each square; others' sides are on the wall, where they may just touch
    assert faces.sum() == 2 * (2**2 + 3**2)
    figure("contact pressure of faces that do not match", abs(pressed[faces] / pressure - 1).max(), bound=1e-2)
    assert np.allclose(traction[faces], pressed[faces], rtol=1e-3)
    force = pressure * (2 * H) ** 2
    figure("force on a side that is pressed", history["upper_force_z"][-1], theory=force, bound=3e-3, unit="N", relative=True)
    assert history["upper_moment_x"][-1] == pytest.approx(force * H, rel=5e-3)  # y times the force
    assert max(abs(history[name]).max() for name in ("all_force_z", "side_force_x", "all_moment_y")) < rounding(1e-12, 1e-5) * force


def test_block_slides_to_rest(run, figure, case):
    """A block on a slab whose mesh does not match, which a weight holds that comes over some time: it loses mu g t of its speed,
    which is heat then. What is missing of that rings on in both."""
    mu, weight, rise, speed = 0.3, 1.6e8, 20 * H / SPEED, 120
    rest = speed / (mu * weight) + rise / 2
    boxes = [((-0.5 * H, -0.5 * H, 0), (5 * H, 2.5 * H, H), (5, 3, 1)), ((0, 0, 1.001 * H), (1.5 * H, 1.5 * H, H), (2, 2, 1))]
    path = case("slide", boxes, material(0.2) + "boundary: [" + ", ".join(f"{{set: zlow, component: {c}, velocity: 0}}" for c in "xyz") + "]\n"
                f'initial: {{velocity: {{x: "z > {H} ? {speed} : 0"}}}}\n'
                f'loads: [{{where: "z > {H}", acceleration: {{z: "-{weight}*(t < {rise} ? (1 - cos(pi*t/{rise}))/2 : 1)"}}}}]\n'
                f'time: {{end: {1.3 * rest}}}\noutput: {{interval: {rest / 20}, fields: [], sensors: [{{name: block, where: "z > {H}", values: [ux, vx]}}], contacts: [{{name: sled, between: [sled, material]}}]}}\n')
    result = run(path, sets={"contact.friction": 0.1, "materials": [{"name": "sled", "model": "linear-elastic", "where": f"z > {H}", "density": DENSITY, "young": YOUNG, "poisson": 0.2}],
                             "contact.pairs": [{"between": ["material", "sled"], "friction": mu}]})
    time, way = result.history["time"], result.history["block_ux_mean"]
    left = speed - mu * weight * rise / 2  # once all of the weight is there
    theory = speed * rise - mu * weight * rise**2 * (1 / 4 - 1 / np.pi**2) + left**2 / (2 * mu * weight)
    figure("way of a block that slides to rest", 1e6 * way[-1], theory=1e6 * theory, bound=1.4e-3, unit="um", relative=True)
    slides = (time > 2 * rise) & (time < 0.95 * rest)
    slowing, at_first = np.polyfit(time[slides], result.history["block_vx_mean"][slides], 1)
    figure("time after which it would rest", -1e6 * at_first / slowing, theory=1e6 * rest, bound=5e-3, unit="us", relative=True)
    braking = -result.history["sled_force_x"][slides].mean() / result.history["sled_force_z"][slides].mean()
    figure("friction over pressure, by the forces on a block that slides", braking, theory=mu, bound=1.5e-2, relative=True)
    assert np.ptp(way[time > 1.15 * rest]) < 2e-3 * theory
    figure("heat of a block that slides to rest", 1e6 * result.energy["friction"][-1],
           theory=1e6 * DENSITY * (1.5 * H) ** 2 * H * speed**2 / 2, bound=0.015, unit="uJ", relative=True)
    assert result.summary["energy_error_rel"] < 2e-4


def test_parts_that_lie_in_each_other_are_refused(case):
    boxes = [((0, 0, 0), (H, H, H), (1, 1, 1)), ((0.13 * H, 0.07 * H, 0.95 * H), (H, H, H), (2, 2, 2))]
    path = case("sunk", boxes, material() + "time: {end: 1e-8}\n")
    for ranks in (1, 2):
        process = launch("run", path, "-q", "-o", path.parent / "out", ranks=ranks)
        assert process.returncode == 2
        assert "lie in each other at (" in process.stderr and "elements " in process.stderr


@pytest.mark.parametrize("contacts, message", [
    ("{name: a, where: z > 7}", "output.contacts[0]: no face of the surface is in it, where: z > 7"),
    ("{name: a}", "output.contacts[0]: missing set, where or between; allowed: exactly one of set, where, between"),
    ("{name: a, where: 1, between: [m, n]}", "output.contacts[0]: more than one given; allowed: exactly one of set, where, between"),
    ("{name: a, where: 1}, {name: a, where: 1}", "output.contacts[1].name: a: the name of an earlier one in history.csv; allowed: letters, digits, _ and -; unique in history.csv"),
    ("{name: a, between: [m, o]}", "output.contacts[0].between: o: no such material; allowed: names of two materials, or one twice: material, m, n"),
    ("{name: a, between: [m, m]}", "output.contacts[0].between: what a material does to itself adds up to nothing; allowed: names of two materials"),
    ("{name: a, between: [m, material]}", "output.contacts[0].between[1]: material: no element is of this material")])
def test_contact_forces_that_are_refused(tmp_path, contacts, message):
    case = tmp_path / "force.yaml"
    other = "model: neo-hookean, young: 1, poisson: 0, density: 1"
    case.write_text(f"mesh: {{cells: [1, 1, 2], size: [1, 1, 2]}}\nmaterial: {{{other}}}\n"
                    f"materials: [{{name: m, where: z > 1, {other}}}, {{name: n, where: z < 1, {other}}}]\n"
                    f"interface: {{law: none}}\ncontact: {{model: general}}\ntime: {{end: 1}}\noutput: {{contacts: [{contacts}]}}\n")
    told = launch("run", case, "-o", tmp_path / "out")
    assert told.returncode == 2 and told.stderr.endswith(f"{message}\n"), told.stderr


@pytest.mark.parametrize("output, message", [
    ("fields: [contact]", "output.fields: contact: not written, because contact.model is interfaces"),
    ("contacts: [{name: a, where: 1}]", "output.contacts: [{name: a, where: 1}]: not used, because contact.model is interfaces")])
def test_what_contact_writes_wants_it(tmp_path, output, message):
    case = tmp_path / "none.yaml"
    case.write_text("mesh: {cells: [1, 1, 1], size: [1, 1, 1]}\nmaterial: {model: neo-hookean, young: 1, poisson: 0, density: 1}\n"
                    f"interface: {{law: none}}\ntime: {{end: 1}}\noutput: {{{output}}}\n")
    told = launch("check", case)
    assert told.returncode == 2 and message in told.stderr, told.stderr


TORN = {
    "defaults": 1, "contact.model": "general", "mesh.cells": [2, 2, 12], "mesh.size": [0.4e-3, 0.4e-3, 2.4e-3],
    "mesh.origin": [-0.2e-3, -0.2e-3, -1.2e-3], "initial.velocity": {"x": "3e3*y", "y": 0, "z": "40*sin(pi*z/2.4e-3)"},
    "bodies": [{"name": f"wall{side}", "shape": "plane", "motion": "prescribed", "at": [0, 0, side * 1.205e-3],
                "normal": [0, 0, -side]} for side in (-1, 1)],
    "time": {"end": 1.2e-6, "safety": 0.45}, "output.interval": 5e-8, "output.fields": [],
}


def test_fragments_that_fly_back_keep_their_energy(run, figure):
    """A bar that tears itself apart between rigid walls, which send its pieces back into each other."""
    result = run(CASES / "fragments.yaml", threads=2, sets=TORN)
    assert result.summary["overlaps"] == 0 and result.summary["fragments"] > 20 and result.summary["contacts"] > 20
    figure("energy error of fragments that fly back", result.summary["energy_error_rel"], bound=5e-3)


STRUCK = {
    "defaults": 1, "contact.model": "general", "mesh.cells": [2, 2, 4], "mesh.size": [0.4e-3, 0.4e-3, 0.8e-3],
    "mesh.origin": [-0.2e-3, -0.2e-3, -0.4e-3], "mesh.jitter": 0, "interface.strength": 1e12,
    "interface.sets": [{"where": "abs(z) < 5e-5 && abs(nz) > 0.8", "open": True}], "initial.velocity": {"x": 0, "y": 0, "z": "z > 0 ? 500 : 0"},
    "bodies": [{"name": "ball", "shape": "sphere", "radius": 1e-4, "at": [-0.32e-3, 0, 1.2e-4], "motion": "prescribed",
                "velocity": {"x": "t < 5e-7 ? 0 : t < 1e-6 ? 640 : 0", "z": "t < 1e-6 ? 0 : -40"}}],
    "time.end": 3e-6, "output.interval": 1e-6, "output.fields": [],
}


def test_ball_meets_faces_that_opened_as_it_meets_the_surface(run, figure):
    """Two halves part, a ball comes between them and strikes one; then that half alone, whose surface is what opened there."""
    alone = {**STRUCK, "mesh.cells": [2, 2, 2], "mesh.size": [0.4e-3, 0.4e-3, 0.4e-3], "interface.sets": []}
    opened, whole = (run(CASES / "fragments.yaml", sets=sets) for sets in (STRUCK, alone))

    def last(result):
        lower = result.fragments[result.fragments["centroid_z"] < 0]
        return lower["momentum_z"][-1] / lower["mass"][-1]
    assert last(whole) < -60  # an impact without vibrations left: twice the ball's
    figure("velocity of a half that a ball strikes where it opened", last(opened), theory=last(whole), bound=5e-5, unit="m/s", relative=True)
    assert opened.summary["overlaps"] == 0 and opened.summary["energy_error_rel"] < 4e-4
