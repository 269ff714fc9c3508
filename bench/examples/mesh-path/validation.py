"""How much longer a crack is than it has to be, by the mesh (README.md)."""

import pathlib

import gallery
import numpy as np

HERE = pathlib.Path(__file__).parent
TITLE = "what the mesh adds to the length of a crack"
SEED = "geometry:seed"
NOTCH, THICKNESS = 3e-3, 0.25e-3  # m, of mesh-path.geo
KINDS = {"structured": 0, "Frontal": 6, "Delaunay": 5}  # Mesh.Algorithm of Gmsh


def runs(full):
    """Meshes are left as Gmsh makes them: the crack of the start lies on their edges."""
    return {f"{name}, {size:g} mm": gallery.Setup(HERE / "mesh-path.yaml", {}, HERE / "mesh-path.geo", {"h": size, "kind": kind},
                                                  improve=False)
            for name, kind in KINDS.items() for size in ((0.7, 0.5, 0.35, 0.25) if full else (0.7, 0.5, 0.35))}


def failed(crack):
    """Faces that failed ahead of the crack of the start."""
    return (crack["damage"] > 1 - 1e-6) & (crack["points"][:, :, 0].mean(axis=1) > NOTCH)


def lengths(setup, run):
    """How far the crack has come along the strip, and over that the energy it took and the area of its faces."""
    crack = run.crack()
    new = failed(crack)
    reach = crack["points"][new][..., 0].max() - NOTCH if new.any() else np.nan
    straight = reach * THICKNESS
    return reach, run.summary["dissipated_J"] / setup.case["interface"]["energy"] / straight, gallery.areas(crack)[new].sum() / straight


def quantities(setups, done):
    rows = []
    for name, run in done.items():
        reach, taken, _ = lengths(setups[name], run)
        rows.append(gallery.Quantity(f"{name}: dissipated over G_c times projected area", taken, 1.0, 0.98, 1.25))
        rows.append(gallery.ledger(run, f"{name}: energy error over dissipated"))
    return rows


def draw(setups, done):
    from drawing import FAINT, RED, plt

    sizes = len(done) // len(KINDS)
    figure, panels = plt.subplots(len(KINDS), sizes, figsize=(11, 6), sharex=True, sharey=True)
    for axes, (name, run) in zip(panels.flat, done.items()):
        crack = run.crack()
        new, place = failed(crack), 1e3 * crack["points"].mean(axis=1)
        axes.plot(*place[(crack["damage"] < 1 - 1e-6)].T[:2], ".", color=FAINT, markersize=2)
        axes.plot(*place[new].T[:2], ".", color=RED, markersize=3)
        axes.set(xlim=(3, 12), ylim=(-1.5, 1.5), title=f"{name}: {lengths(setups[name], run)[1]:.3f}")
    figure.supxlabel("x (mm)")
    figure.supylabel("y (mm)")
    return figure
