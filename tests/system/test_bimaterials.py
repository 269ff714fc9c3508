"""More than one material: waves at their interfaces, equilibrium across them, who is of which, and the same bits whatever
the ranks, threads and mesh file."""

import re

import h5py
import numpy as np
import pytest
import rhegma
from conftest import CASES, SINGLE, example, launch, overrides, rounding
from figures import ROUNDING
from test_meshes import convert, file_case

BAR = example("bimaterial.yaml")
ALUMINA = {"model": "neo-hookean", "young": 260e9, "poisson": 0.21, "density": 3690}
STEEL = {"model": "neo-hookean", "young": 210e9, "poisson": 0.3, "density": 7800}
ZZ = 5  # of a stress field: xx xy xz yy yz zz
STRESS, LENGTH = 100e6, 2e-3  # of the wave (Pa); of either half of the bar (m)
RISE = 6e-8  # s, of the wave in shared nodes


def modulus(solid):
    """lambda + 2 mu."""
    nu = solid["poisson"]
    return solid["young"] * (1 - nu) / ((1 + nu) * (1 - 2 * nu))


def speed(solid):
    return np.sqrt(modulus(solid) / solid["density"])


def impedance(solid):
    return solid["density"] * speed(solid)


def transmitted(first, second):
    """Stress behind an interface over that of the wave that comes from `first`."""
    return 2 * impedance(second) / (impedance(first) + impedance(second))


def whole(first, second, **interface):
    """The bar of two solids, pulled at the end of the first one, that does not break."""
    wall = [{"set": f"{axis}{side}", "component": axis, "velocity": 0} for axis in "xy" for side in "-+"]
    arrival = LENGTH / speed(first)
    pull = STRESS / impedance(first)
    if interface.get("form") == "continuous":  # its lumped mass rings behind a sudden front
        pull = f"{pull}*(t < {RISE} ? (1 - cos(pi*t/{RISE}))/2 : 1)"
    return {"mesh.cells": [2, 2, 40], "material": first, "materials": [{"name": "second", "where": "z < 0", **second}],
            "interface": {"law": "none", **interface},
            "boundary": [*wall, {"set": "z+", "component": "z", "velocity": pull}],
            "time.end": min(2 * arrival, arrival + 2 * LENGTH / speed(second)), "output.fields": []}


WAYS = {  # solids, interface, bounds of the three stresses and of the energy error
    "alumina to steel": (ALUMINA, STEEL, {}, (9e-4, 0.007, 0.013, 6e-6)),
    "steel to alumina": (STEEL, ALUMINA, {}, (0.003, 0.0015, 8e-4, 1.2e-6)),
    "alumina to steel, incomplete": (ALUMINA, STEEL, {"form": "incomplete", "beta_s": 40}, (0.004, 9e-4, 0.002, 0.0012)),
    "alumina to steel, shared nodes": (ALUMINA, STEEL, {"form": "continuous"}, (0.0045, 5e-4, 0.007, 1.5e-5)),
    "alumina to steel, penalty isotropic": (ALUMINA, STEEL, {"penalty": "isotropic"}, (7e-4, 1.5e-4, 0.012, 1e-5)),
}


@pytest.mark.parametrize("way", WAYS)
def test_wave_is_reflected_and_transmitted_as_impedances_say(run, figure, way):
    """Plateaus half a millimetre on both sides of the interface, from 20 ns after the front to 5 ns before the next; with
    shared nodes, whose wave takes 60 ns to rise, from 75 ns, on a finer mesh."""
    first, second, interface, bounds = WAYS[way]
    lumped = interface.get("form") == "continuous"
    finer = {"mesh.cells": [4, 4, 54]} if lumped else {}
    bar = run(BAR, threads=2, sets={**whole(first, second, **interface), **finer})
    time, end = bar.history["time"], bar.history["time"][-1]
    arrival, away = LENGTH / speed(first), 0.5e-3
    begin_after = 75e-9 if lumped else 20e-9

    def plateau(probe, begin, stop):
        return bar.history[f"{probe}_szz"][(time > begin + begin_after) & (time < stop - 5e-9)].mean()

    through = transmitted(first, second) * STRESS
    incoming = plateau("alumina", arrival - away / speed(first), arrival + away / speed(first))
    behind = plateau("alumina", arrival + away / speed(first), end)
    beyond = plateau("steel", arrival + away / speed(second), end)
    stresses = {"incoming": (incoming, STRESS), "behind the reflected wave": (behind, through),
                "transmitted": (beyond, through)}
    for (name, (found, theory)), bound in zip(stresses.items(), bounds):
        figure(f"wave from {way}: stress {name}", 1e-6 * found, theory=1e-6 * theory, bound=bound, unit="MPa", relative=True)
    figure(f"wave from {way}: energy error", bar.summary["energy_error_rel"], bound=bounds[3])


@pytest.fixture(scope="module")
def delamination(run):
    return run(BAR, threads=2, sets={"output.interval": 2e-9, "output.fields": ["crack", "material"]})


def test_reflection_breaks_the_interface(delamination, figure):
    """What the case promises: time and energy of the delamination, and that nothing else breaks."""
    arrival, area = LENGTH / speed(ALUMINA), 0.3e-3**2
    through = transmitted(ALUMINA, STEEL) * STRESS
    assert STRESS < 110e6 < through
    summary, energy = delamination.summary, delamination.energy
    figure("interface of alumina and steel: first fracture", 1e6 * summary["first_fracture_time_s"],
           theory=1e6 * arrival, bound=0.03, unit="us", relative=True)
    figure("interface of alumina and steel: area that comes off", 1e6 * summary["failed_area_m2"], theory=1e6 * area,
           bound=rounding(4e-15, 1e-5), unit="mm2", relative=True, why=ROUNDING)
    figure("interface of alumina and steel: energy against G_c times the area", 1e6 * summary["dissipated_J"],
           theory=1e6 * 5 * area, bound=rounding(4e-15, 1e-5), unit="uJ", relative=True, why=ROUNDING)
    figure("interface of alumina and steel: energy error", summary["energy_error_rel"], bound=8e-5)
    assert np.abs(delamination.frames()[-1]["crack/points"][:, 2]).max() < 1e-6
    rate = (1 / impedance(ALUMINA) + 1 / impedance(STEEL)) * 110e6 / (2 * 5 / 110e6)
    separation = np.log(through / (through - 110e6)) / rate
    half = np.interp(0.5 * area, energy["failed_area"], energy["time"])
    figure("interface of alumina and steel: time at which half of it has come off", 1e6 * half,
           theory=1e6 * (arrival + separation), bound=0.006, unit="us", relative=True)


def test_reflection_from_the_softer_side_does_not(run):
    """The same wave from the steel leaves 82 MPa at the interface."""
    sets = whole(STEEL, ALUMINA)
    interface = {"law": "linear", "strength": 400e6, "energy": 34,
                 "sets": [{"between": ["second", "material"], "strength": 110e6, "energy": 5}]}
    assert run(BAR, threads=2, sets={**sets, "interface": interface}).summary["broken_area_m2"] == 0


def test_fragments_have_the_masses_of_their_materials(delamination, figure):
    rows = delamination.fragments
    last = rows[rows["time"] == rows["time"].max()]
    volume = 0.3e-3**2 * LENGTH
    theory = np.array([3690 * volume, 7800 * volume])
    figure("alumina and steel apart: masses of the fragments, relative", np.abs(np.sort(last["mass"]) / theory - 1).max(),
           bound=rounding(4e-15, 1e-5), why=ROUNDING)


def test_field_has_the_material_of_each_element(delamination):
    centre = delamination.points().reshape(-1, 10, 3)[:, :4].mean(axis=1)
    assert np.array_equal(delamination.frames()[0]["material"].ravel(), (centre[:, 2] < 0).astype(float))


def test_laminate_under_constant_stress_stays_at_rest(run, figure):
    """Continuous displacement and traction, but not strain: exact in both elements, also across the penalty."""
    soft = {"model": "linear-elastic", "young": 20e9, "poisson": 0.35, "density": 1200}
    stiff = {**ALUMINA, "model": "linear-elastic"}
    strain = [STRESS / modulus(stiff), STRESS / modulus(soft)]
    bar = run(BAR, threads=2, sets={
        **whole(stiff, soft), "mesh.cells": [2, 2, 20], "time.end": 1, "time.steps": 200, "output.interval": 200,
        "initial": {"displacement": {"z": f"z < 0 ? {strain[1]}*z : {strain[0]}*z"}}, "output.fields": ["stress"],
        "boundary": [{"set": s, "component": s[0], "velocity": 0} for s in ("x-", "x+", "y-", "y+", "z-", "z+")]})
    stress = bar.frames()[-1]["stress"]
    figure("laminate at rest: stress, relative", np.abs(stress[:, ZZ] / STRESS - 1).max(), bound=rounding(6e-14, 1e-3),
           why=ROUNDING)
    figure("laminate at rest: kinetic energy, of that stored", bar.energy["kinetic"][-1] / bar.energy["bulk"][-1],
           bound=rounding(1.2e-27, 1e-8), why=ROUNDING)


TORN = {"mesh.cells": [3, 3, 12], "mesh.jitter": 0.12, "time.end": 0.8e-6, "output.fields": [], "output.interval": 1e-7}


def test_one_material_named_twice_is_one_material(run):
    """The elements lie in another order in their tiles; each computes the same."""
    bar = run(example("torn-bar.yaml"), sets=TORN)
    twice = run(example("torn-bar.yaml"), threads=2,
                sets={**TORN, "materials": [{"name": "again", "where": "z > 2e-3 + x", **ALUMINA}]})
    assert bar.summary["broken_area_m2"] > 0
    assert twice.summary["state_hash"] == bar.summary["state_hash"]
    one, two = bar.energy, twice.energy
    assert all(one[name].tobytes() == two[name].tobytes() for name in one.dtype.names)
    assert set(two.dtype.names) - set(one.dtype.names) == {f"{part}_{name}" for part in ("kinetic", "bulk", "dissipated")
                                                          for name in ("material", "again")}
    for part, whole in (("kinetic", two["kinetic"]), ("bulk", two["bulk"]), ("dissipated", two["dissipated"])):
        halves = [two[f"{part}_{name}"] for name in ("material", "again")]
        assert np.allclose(sum(halves), whole, rtol=1e-13, atol=0) and all(half[-1] > 0.02 * whole[-1] for half in halves)


@pytest.fixture(scope="module")
def three(run):
    """three(ranks, threads, form): three materials; in single precision all are neo-Hookean."""
    text = (CASES / "three-materials.yaml").read_text()
    listed = [{"name": "metal", "where": "z + 0.3*x > 0.1e-3", **STEEL},
              {"name": "ceramic", "where": "x^2 + y^2 + (z - 0.1e-3)^2 < (0.25e-3)^2", **ALUMINA, "density": 3000}]
    assert all(entry["where"] in text for entry in listed)
    single = {"materials": listed, "output.fields": ["displacement", "material", "crack"]} if SINGLE else {}

    def go(ranks=1, threads=1, **sets):
        return run(CASES / "three-materials.yaml", ranks=ranks, threads=threads, sets={**single, **sets})
    return go


FORMS_THAT_BREAK = [{}, {"interface.form": "incomplete", "interface.beta_s": 40}, {"interface.form": "continuous", "interface.faces": "z > 0"},
                    {"interface.form": "intrinsic", "interface.law": "exponential"}]


@pytest.mark.parametrize("ranks, threads, sets", [
    (1, 2, {}), (2, 1, {}), (3, 1, {}), *[(2, 1, sets) for sets in FORMS_THAT_BREAK[1:]],
    (3, 1, {"viscosity.linear": 0.06, "viscosity.quadratic": 1.2})])
def test_same_bits_on_any_ranks_and_threads(three, figure, ranks, threads, sets):
    one, many = three(**sets), three(ranks, threads, **sets)
    assert one.summary["state_hash"] == many.summary["state_hash"]
    for name in ("energy.csv", "history.csv", "fragments.csv"):
        assert (one.dir / name).read_bytes() == (many.dir / name).read_bytes(), name
    assert one.summary["broken_area_m2"] > 0
    figure("three materials, any form: energy error", one.summary["energy_error_rel"], bound=0.01)


def test_same_bits_where_tiles_are_dealt_anew(three):
    one, repartitioned = three(), three(2, **{"mesh.rebalance": 0.5})
    assert repartitioned.summary["partitions"] > 1
    assert repartitioned.summary["state_hash"] == one.summary["state_hash"]


def test_all_histories_go_on(three):
    if SINGLE:
        pytest.skip("no material with a history in single precision")
    last = three().frames()[-1]
    of = last["material"].ravel()
    assert set(of) == {0, 1, 2}
    assert (last["plastic_strain"].ravel()[of == 0] == 0).all() and (last["damage"].ravel()[of < 2] == 0).all()
    assert last["plastic_strain"].ravel()[of == 1].max() > 1e-4 and last["damage"].ravel()[of == 2].min() > 0.01


def test_restart_on_other_ranks(three, tmp_path):
    """And the case must be the same: not one with another material."""
    sets = {"checkpoint.steps": 60}
    stop = three(2, **sets, **{"time.steps": 100})
    for found in sorted((stop.dir / "checkpoints").glob("step-*.h5"))[1:]:
        found.unlink()
    case = stop.dir / "case.yaml"
    text = case.read_text()
    assert text.count("density: 7800 ") == 1
    case.write_text(text.replace("density: 7800 ", "density: 7000 "))
    process = launch("run", "--restart", stop.dir, "-q")
    assert process.returncode == 2 and "materials[0].density: 7000; in the checkpoint: 7800" in process.stderr
    case.write_text(text)
    process = launch("run", "--restart", stop.dir, "-q", "--set", "time.steps=100000", ranks=3)
    assert process.returncode == 0, process.stderr
    assert rhegma.summary(stop.dir)["state_hash"] == three(**sets).summary["state_hash"]


@pytest.fixture(scope="module")
def sets_file(scratch):
    """The bar as Abaqus input, with its halves as element sets, and the case that reads what rhegma mesh makes of it."""
    folder = scratch / "halves"
    folder.mkdir()
    text = re.sub(r"^boundary:\n(  .*\n)+", "", BAR.read_text(), flags=re.M)
    source = folder / "bar.yaml"
    source.write_text(text.replace("[3, 3, 40]", "[2, 2, 12]") + "initial: {velocity: {z: \"-12*cos(pi*z/4e-3)\"}}\n")
    file, _ = convert(source, folder / "box.h5")
    position = dict(zip(file["vertex"][:].tolist(), file["x"][:].tolist()))
    corner = file["corner"][:]
    centre = np.array([[position[v] for v in row] for row in corner]).mean(axis=1)
    lines = ["*NODE", *[f"{v + 1}, {x[0]:.17g}, {x[1]:.17g}, {x[2]:.17g}" for v, x in sorted(position.items())]]
    for name, chosen in (("top", centre[:, 2] > 0), ("bottom", centre[:, 2] < 0)):
        lines += [f"*ELEMENT, TYPE=C3D4, ELSET={name}"]
        lines += [", ".join(str(k + 1) for k in (e, *corner[e])) for e in np.flatnonzero(chosen)]
        lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL=a", "1."]
    (folder / "bar.inp").write_text("\n".join(lines) + "\n")
    halves, _ = convert(folder / "bar.inp", folder / "halves.h5")
    assert sorted(n.decode() for n in halves["volume_sets"][:]) == ["bottom", "top"]
    return file_case(folder, folder / "halves.h5", source)


@pytest.mark.parametrize("ranks", [1, 3])
def test_volume_sets_of_a_file(run, sets_file, ranks):
    steel = {"name": "steel", **STEEL}
    sets = {"output.fields": ["material"], "output.interval": 1e-7, "time.end": 0.3e-6}
    by_set = run(sets_file, ranks=ranks, sets={**sets, "materials": [{"set": "bottom", **steel}]})
    by_place = run(sets_file, sets={**sets, "materials": [{"where": "z < 0", **steel}]})
    assert by_set.summary["state_hash"] == by_place.summary["state_hash"]
    assert by_set.summary["elements"] == 288 and by_set.frames()[0]["material"].sum() == 144


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("claim, message", [
    ({"set": "botom"}, "materials[0].set: botom: {file} has no such volume set; allowed: {sets}; did you mean 'bottom'?"),
    ({"where": "z > 1"}, "materials[0].where: z > 1: no element is in it"),
    ({"where": "1/(z > 0)"}, "materials[0].where: 1/(z > 0) is inf at (")])
def test_claims_that_are_refused(sets_file, tmp_path, ranks, claim, message):
    out = tmp_path / "out"
    process = launch("run", sets_file, "-q", "-o", out, *overrides({"materials": [{"name": "steel", **STEEL, **claim}]}),
                     ranks=ranks)
    with h5py.File(sets_file.parent / "halves.h5") as file:
        names = ", ".join(n.decode() for n in file["volume_sets"][:])
    assert process.returncode == 2 and not out.exists()
    assert message.format(file=sets_file.parent / "halves.h5", sets=names) in process.stderr


def test_material_that_lost_all_is_told(sets_file):
    steel = {"name": "steel", "where": "z < 0", **STEEL}
    process = launch("check", sets_file, *overrides({"interface.sets": [], "materials": [steel, {**steel, "name": "iron", "where": "z < 1"}]}))
    assert process.returncode == 0
    for name in ("materials: steel", "material alumina"):
        assert f"{name}: later materials claim all of its elements" in process.stderr


def test_and_only_once_where_tiles_are_dealt_anew(tmp_path):
    half = {"name": "iron", "where": "z < 0", **STEEL}
    sets = {"materials": [{**half, "name": "steel"}, half], "mesh.rebalance": 0.5, "time.steps": 210,
            "output.fields": [], "output.energy_limit": 1e9}
    process = launch("run", CASES / "fragments.yaml", "-q", "-o", tmp_path / "out", *overrides(sets), ranks=2)
    assert process.returncode == 0
    assert rhegma.summary(tmp_path / "out")["partitions"] > 1
    assert process.stderr.count("materials: steel: later materials claim all of its elements") == 1


def test_check_and_summary_tell_all_materials(delamination):
    said = launch("check", BAR).stdout
    for name in ("alumina", "steel"):
        assert f"material       {name}: 1080 elements, neo-hookean\n" in said
        assert {"name": name, "elements": 1080, "model": "neo-hookean"} in delamination.summary["materials"]


def test_body_meets_both_materials(run, figure):
    """A sphere hits the interface from the side: momentum of all, and a penalty and mass of each element's own."""
    bar = run(BAR, threads=2, sets={
        "mesh.cells": [3, 3, 8], "mesh.size": [0.3e-3, 0.3e-3, 0.8e-3], "mesh.origin": [0, 0, -0.4e-3], "boundary": [],
        "interface": {"law": "none", "penalty": "isotropic"}, "output.fields": [], "output.probes": [], "time.end": 0.4e-6,
        "bodies": [{"name": "ball", "shape": "sphere", "motion": "free", "at": [0.35e-3, 0.15e-3, 0], "radius": 0.05e-3,
                    "density": 8000, "velocity": {"x": -20}, "faces": ["x+"]}]})
    energy, ball = bar.energy, bar.summary["bodies"][0]
    start = 8000 * 4 / 3 * np.pi * 0.05e-3**3 * 20
    assert ball["velocity"][0] > 0 and abs(ball["velocity"][2]) > 0.01  # back, and to one side
    change = max(np.abs(energy[f"momentum_{axis}"] - value).max() for axis, value in zip("xyz", (-start, 0, 0)))
    figure("sphere on two materials: change of linear momentum", change / start, bound=rounding(4e-15, 1e-5), why=ROUNDING)
    figure("sphere on two materials: energy error", bar.summary["energy_error_rel"], bound=3e-3)
