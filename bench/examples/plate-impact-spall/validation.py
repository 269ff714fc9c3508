"""Plate impact and spall in one dimension (README.md)."""

import pathlib

import gallery
import numpy as np
import rhegma

HERE = pathlib.Path(__file__).parent
TITLE = "plate impact: free surface, pull-back and spall plane"
SEED = "mesh.seed"
SPEED, FLYER, TARGET = 30.0, 1e-3, 3e-3  # m/s, m, of plate-impact-spall.yaml


def runs(full):
    """A little jitter of the nodes, so that the seed matters."""
    cells = [2, 2, 240] if full else [2, 2, 80]
    return {"plate": gallery.Setup(HERE / "plate-impact-spall.yaml", {"mesh.cells": cells, "mesh.jitter": 0.02})}


def quantities(setups, done):
    case, run = setups["plate"].case, done["plate"]
    material, faces = rhegma.one_material(case, TITLE), case["interface"]
    c, history, crack = material.dilatational_speed, run.history, run.crack()
    t, v = history["time"], history["back_vz"]
    first = t < (TARGET + FLYER) / c
    plateau = v[(t > (TARGET + 0.5 * FLYER) / c) & (t < (TARGET + 1.5 * FLYER) / c)].mean()
    arrival = np.interp(SPEED / 2, v[first], t[first])
    back = (t > (TARGET + 2 * FLYER) / c) & (t < (TARGET + 3.5 * FLYER) / c)
    z, area, damage = crack["points"][:, :, 2].mean(axis=1), gallery.areas(crack), crack["damage"]
    inside = z > FLYER + 5e-6
    spalled = inside & (damage > 1 - 1e-6)
    return [
        gallery.within("velocity of the back (m/s)", plateau, SPEED, 0.002),
        gallery.within("arrival at the back (s)", arrival, TARGET / c, 0.006),
        gallery.within("pull-back of the velocity (m/s)", plateau - v[back].min(), 2 * faces["strength"] / (material.density * c),
                       0.04, 0.02),
        gallery.within("place of the spall plane (m)", np.average(z[spalled], weights=area[spalled]) if spalled.any() else np.nan,
                       TARGET, 0.01),
        gallery.within("dissipated over area times damage (J/m2)", gallery.spent(run, crack, inside), faces["energy"], 0.01),
        gallery.ledger(run),
    ]


def draw(setups, done):
    from drawing import BLUE, FAINT, INK, note, plt

    case, history = setups["plate"].case, done["plate"].history
    material = rhegma.one_material(case, TITLE)
    c = material.dilatational_speed
    pull = 2 * case["interface"]["strength"] / (material.density * c)
    figure, axes = plt.subplots()
    axes.plot(1e6 * history["time"], history["back_vz"], color=BLUE, label="computed")
    axes.axhline(SPEED, color=INK, linestyle="--", label="speed of the flyer")
    axes.axhline(SPEED - pull, color=FAINT, linestyle="--", label="less 2 strength/(ρ c$_d$)")
    for time, words in ((TARGET / c, "wave arrives"), ((TARGET + 2 * FLYER) / c, "release arrives")):
        axes.axvline(1e6 * time, color=FAINT, linestyle=":")
        note(axes, words, (1e6 * time, 1), (3, -10), xycoords=("data", "axes fraction"))
    axes.set(xlabel="time (µs)", ylabel="velocity of the free back (m/s)", title="flyer of 1 mm on 3 mm, 30 m/s")
    axes.legend(loc="center left")
    return figure
