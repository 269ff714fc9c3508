"""The Brazilian test (README.md)."""

import math
import pathlib

import gallery
import numpy as np

HERE = pathlib.Path(__file__).parent
TITLE = "the load that splits a disc between two planes"
SEED = "geometry:seed"
DIAMETER = 20e-3  # m, of brazilian-disc.geo


def runs(full):
    values = {"h": 0.4, "t": 0.4} if full else {"h": 0.8, "t": 0.8}
    return {"disc": gallery.Setup(HERE / "brazilian-disc.yaml", {}, HERE / "brazilian-disc.geo", values)}


def tension(setup, run):
    """Times, and 2P/(pi D t) at them, P the mean of the forces of both planes: the tension in the middle of an elastic disc at rest."""
    history = run.history
    force = (np.abs(history["top_fy"]) + np.abs(history["foot_fy"])) / 2
    return history["time"], 2 * force / (math.pi * DIAMETER * 1e-3 * setup.values["t"])


def quantities(setups, done):
    setup, run = setups["disc"], done["disc"]
    strength = setup.case["interface"]["strength"]
    time, stress = tension(setup, run)
    begin, crack = gallery.first_fracture(run), run.crack()
    since, place = crack["time_of_failure"], crack["points"].mean(axis=1)
    early = np.lexsort((place[:, 1], place[:, 0], since))[:20]
    failed = crack["damage"] > 1 - 1e-6
    edge = 1e-3 * setup.values["h"]
    return [
        gallery.within("2P/(pi D t) at first fracture (Pa)", np.interp(begin, time, stress), strength, 0.06, 0.04),
        gallery.within("2P/(pi D t) at the peak (Pa)", stress.max(), strength, 0.02, 0.09),
        gallery.Quantity("first faces to break, from the diameter between the planes (m)",
                         float(np.abs(place[early, 0]).mean()) if len(early) else np.nan, 0.0, 0.0, 1.5 * edge),
        gallery.Quantity("length of what failed along that diameter (m)",
                         float(np.ptp(place[failed & (np.abs(place[:, 0]) < 2 * edge), 1])) if failed.any() else 0.0, 14e-3, 11e-3, 14e-3),
        gallery.ledger(run),
    ]


def draw(setups, done):
    from drawing import BLUE, FAINT, INK, RED, plt

    setup, run = setups["disc"], done["disc"]
    time, stress = tension(setup, run)
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.6))
    left.plot(1e6 * time, 1e-6 * stress, color=BLUE, label="2P/(π D t)")
    left.axhline(1e-6 * setup.case["interface"]["strength"], color=INK, linestyle="--", label="strength")
    left.axvline(1e6 * gallery.first_fracture(run), color=RED, linestyle="-.", linewidth=1, label="first fracture")
    left.set(xlabel="time (µs)", ylabel="tension in the middle (MPa)", title="load")
    left.legend(loc="upper left")
    crack = run.crack()
    middle, failed = 1e3 * crack["points"].mean(axis=1), crack["damage"] > 1 - 1e-6
    turn = np.linspace(0, 2 * math.pi, 200)
    right.plot(10 * np.cos(turn), 10 * np.sin(turn), color=INK, linewidth=1)
    right.plot(*middle[~failed].T[:2], ".", color=FAINT, markersize=2, label="broken")
    right.plot(*middle[failed].T[:2], ".", color=RED, markersize=4, label="failed")
    right.set(xlabel="x (mm)", ylabel="y (mm)", aspect="equal", title=f"at {1e6 * time[-1]:.0f} µs")
    right.legend(loc="upper left", bbox_to_anchor=(1, 1))
    return figure
