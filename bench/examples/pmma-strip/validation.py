"""A crack through a strip of PMMA that was strained before (README.md)."""

import pathlib

import gallery
import numpy as np
import rhegma

HERE = pathlib.Path(__file__).parent
TITLE = "speed of a crack through a strained strip, and the energy that it takes"
SEED = "geometry:seed"
NOTCH = 4e-3  # m, of pmma-strip.geo
FROM, TO = 8e-3, 16e-3  # m: where the speed is measured


def runs(full):
    values = {"h": 0.25, "coarse": 0.8, "t": 0.25} if full else {"h": 0.4, "coarse": 1.0, "t": 0.4}
    return {"strip": gallery.Setup(HERE / "pmma-strip.yaml", {}, HERE / "pmma-strip.geo", values)}


def failed(crack):
    """Places of the failed faces."""
    return crack["points"].mean(axis=1)[crack["damage"] > 1 - 1e-6]


def front(run):
    """Times, and how far along the strip the crack has come."""
    times = rhegma.frame_times(run.dir)
    tips = [failed(run.crack(k))[:, 0] for k in range(len(times))]
    return times, np.array([tip.max() if len(tip) else NOTCH for tip in tips])


def thin_rayleigh_speed(material):
    """In a thin plate, whose waves of pressure are slower: that of a solid of Poisson's ratio nu/(1 + nu)."""
    return gallery.rayleigh_speed(rhegma.Material("plate", material.model, material.density, material.shear,
                                                  material.poisson / (1 + material.poisson)))


def quantities(setups, done):
    setup, run = setups["strip"], done["strip"]
    material, energy = rhegma.one_material(setup.case, TITLE), setup.case["interface"]["energy"]
    times, way = front(run)
    begin, end = (np.interp(at, way, times) if way[-1] > TO else np.nan for at in (FROM, TO))
    crack = run.crack()
    work, place = run.summary["dissipated_J"], failed(crack)
    taken = work / (1e-3 * setup.values["t"] * (way[-1] - NOTCH)) if way[-1] > NOTCH else np.nan
    return [
        gallery.Quantity("speed from 8 to 16 mm over that of Rayleigh waves", (TO - FROM) / (end - begin) / thin_rayleigh_speed(material),
                         0.6, 0.5, 0.7),
        gallery.Quantity("dissipated over G_c times projected area", taken / energy, 1.25, 1.0, 1.5),
        gallery.Quantity("largest distance from the middle (m): one arm", float(np.abs(place[:, 1]).max(initial=0.0)), 0.0, 0.0, 1.5e-3),
        gallery.within("dissipated over area times damage (J/m2)", gallery.spent(run, crack), energy, 0.01),
        gallery.ledger(run),
    ]


def draw(setups, done):
    from drawing import BLUE, FAINT, INK, RED, plt

    run, material = done["strip"], rhegma.one_material(setups["strip"].case, TITLE)
    crack, (times, way) = run.crack(), front(run)
    middle, broken = 1e3 * crack["points"].mean(axis=1), crack["damage"] > 1 - 1e-6
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2), width_ratios=(3, 2))
    left.plot(*middle[~broken].T[:2], ".", color=FAINT, markersize=2, label="broken")
    left.plot(*middle[broken].T[:2], ".", color=RED, markersize=3, label="failed")
    left.plot([0, 1e3 * NOTCH], [0, 0], color=INK)
    left.set(xlim=(0, 32), ylim=(-8, 8), aspect="equal", xlabel="x (mm)", ylabel="y (mm)", title=f"crack at {1e6 * times[-1]:.0f} µs")
    left.legend(loc="upper right")
    right.plot(1e6 * times, 1e3 * way, color=BLUE, label="tip of the crack")
    begin = np.interp(FROM, way, times)
    right.plot(1e6 * times, 1e3 * (FROM + 0.6 * thin_rayleigh_speed(material) * (times - begin)), color=INK, linestyle="--", linewidth=1,
               label="0.6 of Rayleigh waves")
    right.set(xlabel="time (µs)", ylabel="x (mm)", ylim=(0, 32), title="how far")
    right.legend()
    return figure
