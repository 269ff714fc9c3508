"""The speed of a crack that runs under growing K_I (README.md)."""

import importlib.util
import math
import pathlib

import gallery
import numpy as np
import rhegma

HERE = pathlib.Path(__file__).parent
TITLE = "the speed of a crack that runs"
SEED = "geometry:seed"
TENSION = 3.831e6  # Pa, of moving-crack.yaml
SPANS = ((4e-6, 6e-6), (6e-6, 10e-6))  # s


def runs(full):
    values = {"h": 0.075, "t": 0.15} if full else {}
    return {"run": gallery.Setup(HERE / "moving-crack.yaml", geometry=HERE / "moving-crack.geo", values=values)}


def start(case):
    """When K_I of the resting crack, 2 s0 sqrt(c_d t (1 - 2 nu)/pi)/(1 - nu), is K_Ic."""
    material, energy = rhegma.one_material(case, TITLE), float(case["interface"]["energy"])
    nu = material.poisson
    toughness = math.sqrt(material.young * energy / (1 - nu**2))
    return (toughness * (1 - nu) / (2 * TENSION)) ** 2 * math.pi / (material.dilatational_speed * (1 - 2 * nu))


def speed(case, t):
    """G of the moving crack, g(v) times that of the resting one, is G_c: g(v) = start/t."""
    material, begin = rhegma.one_material(case, TITLE), start(case)
    return np.where(t > begin, gallery.moving_crack_speed(material, np.minimum(1, begin / np.maximum(t, begin))), 0.0)


def boundary_integral():
    spec = importlib.util.spec_from_file_location("boundary_integral", HERE / "boundary_integral.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def other_way(case):
    """Times and way by boundary integral."""
    law = case["interface"]
    return boundary_integral().run(rhegma.one_material(case, TITLE), TENSION, float(law["strength"]), float(law["energy"]),
                                   float(case["time"]["end"]), 1e-4, 0.12)


def way(done):
    """Of the crack, in m: what was dissipated, over G_c and the thickness."""
    thickness = np.ptp(done.crack()["points"][..., 2])
    return done.energy["time"], done.energy["dissipated"] / float(done.case["interface"]["energy"]) / thickness


def mean_speed(times, ways, span):
    return float(np.diff(np.interp(span, times, ways))[0] / (span[1] - span[0]))


def quantities(setups, done):
    case, one = setups["run"].case, done["run"]
    crack = one.crack()
    rows = []
    for span in SPANS:
        expected = float(np.mean(speed(case, np.linspace(*span, 401))))
        rows.append(gallery.within(f"mean speed from {1e6 * span[0]:g} to {1e6 * span[1]:g} us (m/s)",
                                   mean_speed(*way(one), span), expected, 0.05))
    end = float(case["time"]["end"])
    rows.append(gallery.within(f"way at {1e6 * end:.3g} us, by boundary integral (m)", np.interp(end, *way(one)),
                               np.interp(end, *other_way(case)), 0.02))
    new = crack["points"][:, :, 0].mean(axis=1) > 0
    rows.append(gallery.within("dissipated over area times damage (J/m2)", gallery.spent(one, crack, new),
                               float(case["interface"]["energy"]), 0.01))
    return [*rows, gallery.ledger(one)]


def draw(setups, done):
    from drawing import BLUE, INK, RED, plt

    case = setups["run"].case
    material, begin = rhegma.one_material(case, TITLE), start(case)
    rayleigh = gallery.rayleigh_speed(material)
    end = float(case["time"]["end"])
    t = np.linspace(0, end, 400)
    figure, axes = plt.subplots(figsize=(7, 4.2))
    axes.plot(1e6 * t, speed(case, t) / rayleigh, color=INK, linestyle="--", label="Freund, g(v) exact")
    axes.plot(1e6 * t, np.where(t > begin, 1 - begin / np.maximum(t, begin), 0), color=INK, linestyle=":", label="g(v) = 1 - v/c$_R$")
    window = 0.5e-6
    for (times, ways), colour, label in ((other_way(case), BLUE, "boundary integral"), (way(done["run"]), RED, "computed")):
        middle = np.arange(window, end - window / 2, window / 2)
        axes.plot(1e6 * middle, [mean_speed(times, ways, (m - window / 2, m + window / 2)) / rayleigh for m in middle],
                  color=colour, label=label)
    axes.set(xlabel="time (µs)", ylabel="speed of the crack, over c$_R$", ylim=(0, 1))
    axes.legend(loc="lower right")
    return figure
