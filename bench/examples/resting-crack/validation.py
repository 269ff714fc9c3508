"""The stress intensity of a crack that is suddenly there, and how it starts to run (README.md)."""

import math
import pathlib

import gallery
import numpy as np
import rhegma

HERE = pathlib.Path(__file__).parent
TITLE = "the stress intensity of a crack at rest, and its start"
SEED = "geometry:seed"
TENSION = 3.831e6  # Pa, of resting-crack.yaml
NEAR, FAR = 0.1e-3, 0.6e-3  # m behind the tip: where the opening tells K


def runs(full):
    """`rest`: the crack never moves; `start`: it does."""
    values = {"h": 0.05, "t": 0.05} if full else {}
    setup = gallery.Setup(HERE / "resting-crack.yaml", geometry=HERE / "resting-crack.geo", values=values)
    faces = [{"where": "abs(y) > 1e-7 || x > 0", "law": "none"}, {"where": "abs(y) < 1e-7 && x < 0", "open": True}]
    rest = gallery.Setup(setup.file, {"interface.sets": faces}, setup.geometry, values)
    return {"rest": rest, "start": setup}


def intensity(material, t):
    """Freund 1990, section 2.5: of a pressure s0 that acts on the faces of a half-plane crack from t = 0 on."""
    nu = material.poisson
    return 2 * TENSION * np.sqrt(material.dilatational_speed * t * (1 - 2 * nu) / math.pi) / (1 - nu)


def measured(material, crack):
    """K from the opening 8 K/E' sqrt(r/2 pi) (1 + a r) behind the tip, E' = E/(1 - nu^2)."""
    r = -crack["points"][:, :, 0].mean(axis=1)
    near = (r > NEAR) & (r < FAR)
    apparent = crack["opening"][near] * material.young / (1 - material.poisson**2) / 8 * np.sqrt(2 * np.pi / r[near])
    return np.polyfit(r[near], apparent, 1)[1]


def way(case, t):
    """How far the crack has come: G of the moving crack is g(v) times that of the resting one (Freund 1990, 6.4)."""
    material, energy = rhegma.one_material(case, TITLE), float(case["interface"]["energy"])
    toughness2 = material.young * energy / (1 - material.poisson**2)
    start = toughness2 / intensity(material, 1.0) ** 2
    times = np.linspace(start, max(t, start), 201)
    return float(np.trapz(gallery.moving_crack_speed(material, start / times), times))


def quantities(setups, done):
    case, rest, start = setups["start"].case, done["rest"], done["start"]
    material, energy = rhegma.one_material(case, TITLE), float(case["interface"]["energy"])
    times = rhegma.frame_times(rest.dir)
    rows = []
    for t in (1e-6, 2e-6):
        number = int(np.argmin(np.abs(times - t)))
        found = measured(material, rest.crack(number))
        rows.append(gallery.within(f"K_I at {1e6 * t:g} us (Pa sqrt(m))", found, intensity(material, times[number]), 0.06, 0.02))
    crack = start.crack()
    new = crack["points"][:, :, 0].mean(axis=1) > 0
    work = start.summary["dissipated_J"]
    thickness = np.ptp(crack["points"][..., 2])
    rows.append(gallery.within("dissipated over area times damage (J/m2)", gallery.spent(start, crack, new), energy, 0.01))
    rows.append(gallery.within(f"way at {1e6 * times[-1]:.3g} us, dissipated over G_c (m)", work / energy / thickness,
                               way(case, times[-1]), 0.05, 0.25))
    return [*rows, gallery.ledger(start)]


def draw(setups, done):
    from drawing import BLUE, INK, RED, plt

    case = setups["start"].case
    material = rhegma.one_material(case, TITLE)
    times = rhegma.frame_times(done["rest"].dir)[1:]
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    fine = np.linspace(0, times[-1], 200)
    left.plot(1e6 * fine, 1e-6 * intensity(material, fine), color=INK, linestyle="--", label="Freund")
    left.plot(1e6 * times, [1e-6 * measured(material, done["rest"].crack(k + 1)) for k in range(len(times))], "o", color=BLUE,
              label="computed, from the opening")
    left.set(xlabel="time (µs)", ylabel="K$_I$ (MPa √m)", title="crack at rest")
    left.legend()
    energy, crack = done["start"].energy, done["start"].crack()
    thickness = np.ptp(crack["points"][..., 2])
    right.plot(1e6 * fine, [1e3 * way(case, t) for t in fine], color=INK, linestyle="--", label="Freund")
    right.plot(1e6 * energy["time"], 1e3 * energy["dissipated"] / float(case["interface"]["energy"]) / thickness, color=RED,
               label="computed, dissipated over G$_c$")
    right.set(xlabel="time (µs)", ylabel="way of the crack (mm)", title="crack that may run")
    right.legend()
    return figure
