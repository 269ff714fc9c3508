"""A ring that expands until it falls to pieces, of uniform strength and of one by Weibull (README.md)."""

import pathlib

import gallery
import numpy as np
import rhegma
import theory

HERE = pathlib.Path(__file__).parent
TITLE = "fragments of an expanding ring"
SEED = "geometry:seed"
LENGTH, SIDE, RATE, STRAIN = 50e-3, 0.25e-3, 1e4, 1e-3  # mean circumference, of the section, of ring.yaml
WEIBULL = {"interface.weibull.modulus": 10, "interface.weibull.area": 4e-9}  # area: of a face of the reduced mesh


def runs(full):
    values = {"h": 0.06} if full else {}
    uniform = gallery.Setup(HERE / "ring.yaml", {}, HERE / "ring.geo", values)
    return {"uniform": uniform, "weibull": gallery.Setup(uniform.file, WEIBULL, uniform.geometry, values)}


def zhou_molinari_ramesh(case, rate):
    """Pieces: s/s0 = 4.5/(1 + 4.5 r^(2/3)), s0 = E G/strength^2, r = rate E^2 G/(c strength^3) (Zhou, Molinari & Ramesh 2006)."""
    material, faces = rhegma.one_material(case, TITLE), case["interface"]
    size = material.young * faces["energy"] / faces["strength"] ** 2
    relative = rate * material.young**2 * faces["energy"] / (material.bar_speed * faces["strength"] ** 3)
    return LENGTH / size * (1 + 4.5 * relative ** (2 / 3)) / 4.5


def pieces(run, least):
    """At the end, without splinters lighter than this part of the mass."""
    table = run.fragments
    mass = table["mass"][table["time"] == table["time"].max()]
    return int((mass > least * mass.sum()).sum())


def quantities(setups, done):
    case = setups["uniform"].case
    material, faces = rhegma.one_material(case, TITLE), case["interface"]
    expected = zhou_molinari_ramesh(case, RATE)
    inner = 1 - np.pi * SIDE / LENGTH  # radius of the inner side, where the strain is largest
    begin = STRAIN + RATE * gallery.first_fracture(done["uniform"])
    rows = [gallery.within("strain at first fracture", begin, faces["strength"] / material.young * inner, 0.01)]
    for name, below, above in (("uniform", 0.35, 0.25), ("weibull", 0.4, 0.1)):
        run = done[name]
        rows += [gallery.within(f"{name}: pieces", pieces(run, 0.1 / expected), expected, below, above),
                 gallery.within(f"{name}: dissipated over area times damage (J/m2)", gallery.spent(run, run.crack()),
                                faces["energy"], 0.01),
                 gallery.ledger(run, f"{name}: energy error over dissipated")]
    return rows


def draw(setups, done):
    from drawing import BLUE, INK, RED, plt

    case = setups["uniform"].case
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.4))
    for name, colour in (("uniform", BLUE), ("weibull", RED)):
        table = done[name].fragments
        times, counts = np.unique(table["time"], return_counts=True)
        left.plot(1e6 * times, counts, color=colour, label=f"{name}, splinters and all")
        crack = done[name].crack()
        middle = crack["points"].mean(axis=1)[crack["damage"] > 1 - 1e-6]
        radius = 1e3 * np.hypot(*middle.T[:2]) + (0 if name == "uniform" else 0.8)
        angle = np.arctan2(middle[:, 1], middle[:, 0])
        right.plot(radius * np.cos(angle), radius * np.sin(angle), ".", color=colour, markersize=2)
    bar = theory.Stretched({**case, "mesh": {"size": [SIDE, SIDE, LENGTH]}})
    for count, style, name in ((zhou_molinari_ramesh(case, RATE), "--", "Zhou, Molinari & Ramesh"),
                               (LENGTH / bar.grady(RATE), ":", "Grady"),
                               (LENGTH / bar.glenn_chudnovsky(RATE), "-.", "Glenn & Chudnovsky")):
        left.axhline(count, color=INK, linestyle=style, linewidth=1, label=name)
    left.set(xlabel="time (µs)", ylabel="pieces", title="10$^4$/s, 50 mm around")
    left.legend(loc="lower right")
    right.set(xlabel="x (mm)", ylabel="y (mm)", title="failed faces: uniform, and Weibull 0.8 mm further out", aspect="equal")
    return figure
