"""Supports along lines that are no axes, rigid motions, and entries that take turns. Bits on any layout and restarts:
test_parallel.py, test_restart.py."""

import json

import numpy as np
import pytest
from conftest import CASES, launch, rounding
from figures import ROUNDING

LOADS = CASES / "loads.yaml"
CUBE = [(0, 1, 3, 7), (0, 1, 5, 7), (0, 2, 3, 7), (0, 2, 6, 7), (0, 4, 5, 7), (0, 4, 6, 7)]  # around 0-7
CELLS, CELL = (2, 1, 3), 1e-3
TURN = np.linalg.qr(np.array([[2.0, 1, 0.3], [-1, 2, 0.5], [0.2, -0.6, 1.5]]))[0]
TURN *= np.sign(np.linalg.det(TURN))


def block(folder, name, turn):
    """A block of cubes of 6 tetrahedra, turned."""
    count = [c + 1 for c in CELLS]
    number = lambda i, j, k: i + count[0] * (j + count[1] * k)
    nodes = [CELL * turn @ [i, j, k] for k in range(count[2]) for j in range(count[1]) for i in range(count[0])]
    text = ["*NODE", *[f"{n + 1}, {x[0]!r}, {x[1]!r}, {x[2]!r}" for n, x in enumerate(np.array(nodes).tolist())], "*ELEMENT, TYPE=C3D4"]
    cells = [[number(i + (v & 1), j + (v >> 1 & 1), k + (v >> 2 & 1)) for v in range(8)]
             for k in range(CELLS[2]) for j in range(CELLS[1]) for i in range(CELLS[0])]
    text += [", ".join(str(v + 1) for v in (6 * n + t, *[cell[c] for c in corners]))
             for n, cell in enumerate(cells) for t, corners in enumerate(CUBE)]
    (folder / f"{name}.inp").write_text("\n".join(text) + "\n")
    made = launch("mesh", folder / f"{name}.inp", "-o", folder / f"{name}.h5")
    assert made.returncode == 0, made.stderr
    return folder / f"{name}.h5"


@pytest.fixture(scope="module")
def blocks(scratch):
    folder = scratch / "turned-blocks"
    folder.mkdir()
    return {name: block(folder, name, turn) for name, turn in (("straight", np.eye(3)), ("turned", TURN))}


def side(normal):
    """An expression that selects the faces of this outward normal."""
    return "{}*nx + {}*ny + {}*nz > 0.9".format(*map(repr, np.asarray(normal, float).tolist()))


def along(line, value):
    """Components of a vector field along a line."""
    return {axis: f"{float(c)!r}*({value})" for axis, c in zip("xyz", line)}


def held_case(mesh, turn, supports, form):
    """Two rollers that meet at an edge, a side that is pulled and one that waits, oblique motion inside."""
    X, Y, Z = turn.T
    where = "({}*x + {}*y + {}*z)".format(*map(repr, Z.tolist()))
    law = {"law": "none", "form": form, **({"beta_s": 2} if form == "variational" else {})}
    case = {"mesh": {"file": str(mesh)}, "material": {"model": "neo-hookean", "young": 70e9, "poisson": 0.3, "density": 2700},
            "interface": law, "boundary": supports(X, Y, Z),
            "initial": {"velocity": along(X + 2 * Y - Z, f"3*sin({where}*2000)")},
            "time": {"end": 1, "safety": 0.9, "steps": 300}, "output": {"fields": [], "interval": 10}}
    path = mesh.with_name(f"{mesh.stem}-{supports.__name__}-{form}.yaml")
    path.write_text(json.dumps(case))
    return path


def components(X, Y, Z):
    pull = {"name": "pull", "where": side(Z), "velocity": "5*sin(t*3e6)"}
    return [{"name": "low", "where": side(-X), "component": "x", "velocity": 0},
            {"name": "wall", "where": side(-Y), "component": "y", "displacement": "-1e-7*sin(t*2e6)"},
            {**pull, "component": "z"}, {"name": "late", "where": side(-Z), "component": "z", "velocity": 0, "from": 4e-7, "until": 2e-6}]


def lines(X, Y, Z):
    plain = components(X, Y, Z)
    low, wall, pull, late = ({k: v for k, v in entry.items() if k != "component"} for entry in plain)
    low.pop("velocity"), late.pop("velocity")
    return [{**low, "normal": 0}, {**wall, "direction": (3 * Y).tolist()}, {**pull, "direction": Z.tolist()}, {**late, "normal": 0}]


@pytest.mark.parametrize("form", ["variational", "continuous"])
def test_inclined_rollers_are_the_same_problem(run, figure, blocks, form):
    straight = run(held_case(blocks["straight"], np.eye(3), components, form))
    case = held_case(blocks["turned"], TURN, lines, form)
    step = run(case, ranks=2, sets={"time.steps": 1}).summary["dt_first"]  # the critical one is found to 1e-4
    turned = run(case, ranks=2, sets={"time.safety": 0.9 * straight.summary["dt_first"] / step})
    for name in ("kinetic", "bulk", "external_work"):
        apart = np.abs(turned.energy[name] - straight.energy[name]).max() / np.abs(straight.energy[name]).max()
        figure(f"inclined rollers against the same problem turned, form {form}: {name}", apart, bound=rounding(2e-14, 2e-6), why=ROUNDING)
    for name in ("low", "wall", "pull", "late"):
        force, other = (np.stack([of.history[f"{name}_force_{axis}"] for axis in "xyz"], axis=1) for of in (straight, turned))
        assert np.abs(force).max() > 10
        figure(f"inclined rollers, form {form}: force of '{name}'", np.abs(other - force @ TURN.T).max() / np.abs(force).max(),
               bound=rounding(7e-14, 2e-5), why=ROUNDING)
        work = straight.history[f"{name}_work"]
        assert np.abs(turned.history[f"{name}_work"] - work).max() <= rounding(1e-13, 2e-5) * np.abs(straight.history["pull_work"]).max()


@pytest.mark.parametrize("form", ["variational", "continuous"])
def test_lines_at_an_angle(run, figure, form):
    """Of one side along x and along (1, 1, 0): together the same as along x and y."""
    law = {"law": "none", "form": form, **({"beta_s": 2} if form == "variational" else {})}
    sets = {"interface": law, "loads": [], "time.steps": 200, "output.interval": 10}
    first, second = "2*sin(3e6*t)", "1*sin(5e6*t)"
    axes = run(LOADS, sets={**sets, "boundary": [{"set": "z-", "component": "x", "velocity": first},
                                                 {"name": "y", "set": "z-", "component": "y", "velocity": second}]})
    lines = run(LOADS, sets={**sets, "boundary": [{"set": "z-", "component": "x", "velocity": first},
                                                  {"name": "y", "set": "z-", "direction": [5, 5, 0], "velocity": f"({first} + {second})/sqrt(2)"}]})
    assert axes.energy["bulk"].max() > 1e-9
    for name in ("kinetic", "bulk", "external_work"):
        apart = np.abs(lines.energy[name] - axes.energy[name]).max() / np.abs(axes.energy[name]).max()
        figure(f"lines at an angle against axes, form {form}: {name}", apart, bound=rounding(2e-13, 1e-6), why=ROUNDING)


def test_entries_that_take_turns(run, figure):
    """A side that is pulled, let go and taken again, beside another that shares its nodes."""
    sets = {"boundary": [{"name": "first", "set": "z-", "component": "x", "velocity": 3, "until": 5e-7},
                         {"name": "second", "set": "z-", "component": "x", "displacement": "1e-7*cos(1e6*t)", "from": 1e-6, "until": 1.6e-6},
                         {"name": "side", "where": "ny > 0.9", "component": "x", "velocity": 0, "from": 2e-7, "until": 1.3e-6}],
            "material.model": "linear-elastic", "time.steps": 800, "output.interval": 10, "time.safety": 0.5, "loads": []}
    history, energy = (done := run(LOADS, sets=sets)).history, done.energy
    time = history["time"]
    for name, begin, end in (("first", 0, 5e-7), ("second", 1e-6, 1.6e-6), ("side", 2e-7, 1.3e-6)):
        force, acts = history[f"{name}_force_x"], (time >= begin) & (time < end)
        assert (force[~acts] == 0).all() and (force[acts] != 0).all() and acts.any() and not acts.all()
    work = sum(history[f"{name}_work"] for name in ("first", "second", "side"))
    figure("entries that take turns: energy error over the work", abs(energy["total"][-1] - energy["total"][1]) / np.abs(work).max(),
           bound=rounding(2e-13, 2e-6), why=ROUNDING)
    assert energy["external_work"][-1] == pytest.approx(work[-1], rel=1e-6)


@pytest.mark.parametrize("form", ["variational", "continuous"])
def test_moments_turn_the_body(run, figure, form):
    """Of all loads and supports together, about the origin: the angular momentum changes by them alone. Prescribed velocities
    that are linear in time are those of the step to rounding."""
    law = {"law": "none", "form": form, **({"beta_s": 2, "penalty": "isotropic"} if form == "variational" else {})}
    sets = {"interface": law, "time.steps": 150, "output.interval": 1,
            "boundary": [{"name": "hold", "set": "y+", "component": "x", "velocity": "2e5*t"}, {"name": "roll", "where": "nx > 0.5", "direction": [0, 1, 2], "velocity": "3e5*t"}]}
    done = run(LOADS, sets=sets)
    energy, history = done.energy, done.history
    halves = 0.5 * np.diff(history["time"])
    names = ("pull", "press", "push", "fall", "hold", "roll")
    assert len(halves) == 150 and all(np.abs(history[f"{name}_moment_z"]).max() > 0 for name in names)
    for axis in "xyz":
        moment = sum(history[f"{name}_moment_{axis}"] for name in names)
        change = np.cumsum(halves * (moment[1:] + moment[:-1]))
        apart = np.abs(energy[f"angular_{axis}"][1:] - energy[f"angular_{axis}"][0] - change).max()
        figure(f"moments of loads and supports, form {form}: angular momentum about {axis}", apart / np.abs(change).max(), bound=rounding(2e-14, 7e-6), why=ROUNDING)


REFUSED = """mesh: {{cells: [1, 1, 1], size: [1, 1, 1]}}
material: {{model: neo-hookean, young: 1, poisson: 0, density: 1}}
interface: {{{law}}}
time: {{end: 1}}
boundary: [{boundary}]
"""


@pytest.mark.parametrize("boundary, law, message", [
    ("{where: z > 2, normal: 0}", "law: none", "boundary[0]: no face of the surface is in it, where: z > 2"),
    ("{set: z+, normal: 0}, {set: z+, component: z, velocity: 1}", "law: none",
     "boundary[0] and boundary[1] both prescribe the motion of 2 faces along one line, at the same time"),
    ("{where: 1, normal: 0}, {set: z-, angle: t, axis: [0, 0, 1]}", "law: none",
     "boundary[0] and boundary[1] both prescribe the motion of 2 faces along one line, at the same time"),
    ("{where: nx + nz > 0, normal: 0}", "law: none, form: continuous",
     "boundary[0].normal: the faces have an edge, and form continuous knows one normal at a node: give the sides as sets of their own"),
    ("{set: z+, normal: 1/t}", "law: none", "boundary[0].normal: 1/t is not finite at (0, 0, 1), t = 0 s")])
def test_supports_that_are_refused(tmp_path, boundary, law, message):
    case = tmp_path / "refused.yaml"
    case.write_text(REFUSED.format(boundary=boundary, law=law))
    told = launch("check", case)
    assert told.returncode == 2 and told.stderr.endswith(f"{message}\n"), told.stderr


def test_check_lists_what_supports_select(tmp_path):
    case = tmp_path / "told.yaml"
    case.write_text(REFUSED.format(law="law: none", boundary="{name: a, set: z+, normal: 0}, {where: nz < -0.5, component: x, velocity: t}, "
                                   "{set: y+, direction: [1, 0, 2], displacement: 0}, {set: y-, angle: t, axis: [0, 1, 0]}, {set: x-, absorbing: true}"))
    told = [line.split(None, 1)[1] for line in launch("check", case).stdout.splitlines() if line.startswith("boundary ")]
    assert told == [f"{what} on 1 m2, 2 faces" for what in ("a: normal", "velocity along x", "displacement along (1, 0, 2)", "angle", "absorbing")]


# ---- A body that turns ----

SPIN = """
defaults: 0
mesh: {cells: [1, 1, 8], size: [0.25e-3, 0.25e-3, 2e-3], origin: [-0.125e-3, -0.125e-3, 0]}
material: {model: neo-hookean, young: 200e9, poisson: 0, density: 8000}
interface: {law: none, beta_s: 2, penalty: isotropic}
initial: {rotation: {speed: 2e4, axis: [0, 3, 0], at: [0, 0, 1e-3]}, velocity: {z: 3}}
time: {end: 1, safety: 0.9, steps: 1000}
output: {fields: [], interval: 50, probes: [{name: end, at: [0.01e-3, 0.02e-3, 2e-3]}]}
"""


@pytest.fixture(scope="module")
def spin_case(scratch):
    path = scratch / "spin.yaml"
    path.write_text(SPIN)
    return path


def test_a_spinning_rod_keeps_its_angular_momentum(run, figure, spin_case):
    energy = run(spin_case).energy
    mass = 8000 * 0.25e-3**2 * 2e-3
    theory = mass * (0.25e-3**2 + (2e-3) ** 2) / 12 * 2e4
    figure("spinning rod: angular momentum at the start", energy["angular_y"][0], theory=theory, bound=rounding(1e-14, 1e-6), relative=True, why=ROUNDING)
    spin = np.stack([energy[f"angular_{axis}"] for axis in "xyz"], axis=1)
    figure("spinning rod: change of angular momentum over 1000 steps", np.abs(spin - spin[0]).max() / theory, bound=rounding(1e-14, 1.6e-5), why=ROUNDING)
    assert energy["momentum_z"][-1] == pytest.approx(3 * mass, rel=1e-6)


def test_a_rod_spins_about_a_hub(run, figure, spin_case):
    """Its end under w^2 z, applied at once: u = sum of the rod's modes. Coriolis' and the change of the load are of the
    order of w over the first frequency, 5e-3 here, squared."""
    speed, length, rate = np.sqrt(200e9 / 8000), 2e-3, 2e4
    sets = {"initial": {"rotation": {"speed": rate, "axis": [0, 1, 0]}}, "time.steps": 300,
            "boundary": [{"name": "hub", "set": "z-", "angle": f"{rate}*t", "axis": [0, 2, 0]}]}
    history = run(spin_case, sets=sets).history
    time, turned = history["time"], rate * history["time"]
    assert turned[-1] > 0.02
    stretch = np.sin(turned) * (0.01e-3 + history["end_ux"]) + np.cos(turned) * (length + history["end_uz"]) - length
    theory = sum(2 * rate**2 / (length * q**4 * speed**2) * (1 - np.cos(q * speed * time)) for q in (np.arange(60) + 0.5) * np.pi / length)
    figure("rod about a hub: displacement of its end, of the largest", np.abs(stretch - theory).max() / np.abs(theory).max(), bound=8e-4)


def test_parts_with_states_of_their_own(run, spin_case):
    """By place, by material and by default; the last set that has an element counts."""
    steel = {"name": "steel", "where": "z > 1.5e-3", "model": "neo-hookean", "young": 200e9, "poisson": 0, "density": 4000}
    sets = [{"where": "z < 1e-3", "velocity": {"y": "7 + 0*x"}}, {"material": "steel", "velocity": {"x": 5}, "displacement": {"y": 1e-9}},
            {"where": "z < 0.5e-3", "rotation": {"speed": 1e3, "axis": [0, 0, 1]}}]
    energy = run(spin_case, sets={"materials": [steel], "initial": {"velocity": {"z": 2}, "sets": sets}, "time.steps": 1}).energy
    part = 8000 * 0.25e-3**2 * 0.5e-3
    for name, theory in (("momentum_x", 5 * part / 2), ("momentum_y", 7 * part), ("momentum_z", 2 * part),
                         ("kinetic", part / 2 * (25 / 2 + 49 + 4 + 1e6 * 0.25e-3**2 / 6))):
        assert energy[name][0] == pytest.approx(theory, rel=rounding(1e-12, 1e-5)), name


@pytest.mark.parametrize("initial, message", [
    ("{rotation: {speed: 1}}", "initial.rotation.axis: missing: a body turns about it; allowed: 3 numbers"),
    ("{rotation: {axis: [0, 0, 1]}}", "initial.rotation.axis: not used without rotation.speed"),
    ("{sets: [{where: 1, rotation: {speed: 1, axis: [0, 0, 0]}}]}", "initial.sets[0].rotation.axis: [0, 0, 0]: has no direction"),
    ("{sets: [{velocity: {x: 1}}]}", "initial.sets[0]: missing set, material or where; allowed: exactly one of set, material, where"),
    ("{sets: [{set: a, where: 1}]}", "initial.sets[0]: more than one given; allowed: exactly one of set, material, where"),
    ("{sets: [{set: a}]}", "initial.sets[0].set: a: a mesh file has volume sets, the built-in box has none; say where"),
    ("{sets: [{material: tin}]}", "initial.sets[0].material: tin: no such material"),
    ("{sets: [{where: z > 2}]}", "initial.sets[0]: no element is in it, or later sets have them all"),
    ("{sets: [{where: 1, velocity: {x: 1/z}}]}", "initial.sets[0].velocity.x: 1/z is not finite at (0, 0, 0)")])
def test_starts_that_are_refused(tmp_path, initial, message):
    case = tmp_path / "refused.yaml"
    case.write_text(REFUSED.format(boundary="", law="law: none") + f"initial: {initial}\n")
    told = launch("check", case)
    assert told.returncode == 2 and told.stderr.endswith(f"{message}\n"), told.stderr
