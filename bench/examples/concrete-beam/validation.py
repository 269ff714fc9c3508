"""Where a notched beam of concrete breaks that is hit in its middle (README.md)."""

import math
import pathlib

import gallery
import numpy as np
import rhegma

HERE = pathlib.Path(__file__).parent
TITLE = "from its notch or in its middle: where a beam of concrete breaks"
SEED = "geometry:seed"
HALF_SPAN, NOTCH = 101.5e-3, 19e-3  # m
GAMMAS = {"near": 0.5, "far": 0.875}  # how far the notch is from the middle, in half spans
ENDS = {"near": 1000e-6, "far": 1700e-6}  # s: the middle, which has no notch, takes longer to break
LOW = 38e-3  # m, half of the height: above, all cracks make for the hammer


def runs(full):
    sizes = {"h": 1.5, "coarse": 6.0, "t": 1.5} if full else {"h": 2.5, "coarse": 8.0, "t": 2.5}
    return {name: gallery.Setup(HERE / "concrete-beam.yaml", {"time.end": ENDS[name]}, HERE / "concrete-beam.geo", {**sizes, "gamma": gamma})
            for name, gamma in GAMMAS.items()}


def failed(run):
    """Places (m) and areas of the failed faces."""
    crack = run.crack()
    chosen = crack["damage"] > 1 - 1e-6
    return crack["points"].mean(axis=1)[chosen, :2], gallery.areas(crack)[chosen]


def nearer_the_middle(run, gamma):
    """Share of the failed area in the lower half that is nearer to the middle of the beam than to its notch."""
    place, area = failed(run)
    area = area * (place[:, 1] < LOW)
    return float(area[place[:, 0] > -gamma * HALF_SPAN / 2].sum() / area.sum()) if area.sum() > 0 else math.nan


def angle(run, gamma):
    """Of the crack from the notch in the lower half against the vertical, towards the middle: of the line from the tip that fits best."""
    place, area = failed(run)
    across, up = (place - [-gamma * HALF_SPAN, NOTCH]).T
    chosen = (up > 0) & (up < LOW - NOTCH)
    weight = area * chosen
    return math.degrees(math.atan2((weight * across * up).sum(), (weight * up * up).sum())) if chosen.any() else math.nan


def quantities(setups, done):
    near, far = done["near"], done["far"]
    energy = setups["near"].case["interface"]["energy"]
    return [
        gallery.Quantity("notch at 0.5: share of the crack in the middle", nearer_the_middle(near, GAMMAS["near"]), 0.0, 0.0, 0.1),
        gallery.Quantity("notch at 0.5: angle to the vertical (degrees)", angle(near, GAMMAS["near"]), 30.0, 20.0, 42.0),
        gallery.Quantity("notch at 0.875: share of the crack in the middle", nearer_the_middle(far, GAMMAS["far"]), 1.0, 0.9, 1.0),
        gallery.within("notch at 0.5: dissipated over area times damage (J/m2)", gallery.spent(near, near.crack()), energy, 0.01),
        gallery.ledger(near, "notch at 0.5: energy error over dissipated"),
        gallery.ledger(far, "notch at 0.875: energy error over dissipated"),
    ]


def draw(setups, done):
    from drawing import FAINT, INK, RED, plt

    figure, axes = plt.subplots(len(done), 1, figsize=(9, 6.4))
    for plot, (name, run) in zip(axes, done.items()):
        crack, notch = run.crack(), -1e3 * GAMMAS[name] * HALF_SPAN
        middle, broken = 1e3 * crack["points"].mean(axis=1), crack["damage"] > 1 - 1e-6
        plot.plot(*middle[~broken].T[:2], ".", color=FAINT, markersize=2, label="broken")
        plot.plot(*middle[broken].T[:2], ".", color=RED, markersize=3, label="failed")
        plot.plot([notch, notch], [0, 1e3 * NOTCH], color=INK)
        plot.plot([-114.5, 114.5, 114.5, -114.5, -114.5], [0, 0, 76, 76, 0], color=INK, linewidth=0.8)
        plot.plot([-101.5, 101.5], [-3, -3], "^", color=INK)
        plot.plot([0], [79], "v", color=INK)
        plot.set(xlim=(-120, 120), ylim=(-8, 84), aspect="equal", xlabel="x (mm)", ylabel="y (mm)",
                 title=f"notch at {GAMMAS[name]} of half the span")
        plot.legend(loc="upper right")
    figure.tight_layout()
    return figure
