"""The crack of the experiments of Kalthoff and Winkler (README.md)."""

import math
import pathlib

import gallery
import numpy as np
import rhegma

HERE = pathlib.Path(__file__).parent
TITLE = "a crack that turns by some 70 degrees from its notch"
SEED = "geometry:seed"
TIP = np.array([50e-3, 25e-3])  # of the notch, m
NEAR, FAR = 5e-3, 60e-3  # from the tip: the crack whose angle and speed are told


def runs(full):
    values = {"h": 1.0, "coarse": 3.0, "t": 1.0} if full else {}
    return {"plate": gallery.Setup(HERE / "kalthoff-winkler.yaml", {}, HERE / "kalthoff-winkler.geo", values)}


def failed(crack):
    """Places and areas of the failed faces above the notch, their distance from its tip."""
    middle = crack["points"].mean(axis=1)[:, :2]
    chosen = (crack["damage"] > 1 - 1e-6) & (middle[:, 1] > TIP[1])
    return middle[chosen], gallery.areas(crack)[chosen], np.hypot(*(middle[chosen] - TIP).T)


def angle(crack):
    """Of the crack against the notch: of the straight line from the tip that fits it best, in degrees."""
    place, area, distance = failed(crack)
    x, y = (place - TIP)[(distance > NEAR) & (distance < FAR)].T
    weight = area[(distance > NEAR) & (distance < FAR)]
    return math.degrees(math.atan2((weight * x * y).sum(), (weight * x * x).sum()) if len(x) else math.nan)


def front(run):
    """Time and distance from the notch of the farthest failed face."""
    times = rhegma.frame_times(run.dir)
    distances = [failed(crack)[2] for crack in (run.crack(k) for k in range(len(times)))]
    return times, np.array([distance.max() if len(distance) else 0.0 for distance in distances])


def speed(run):
    """Mean over the way from NEAR to FAR."""
    times, way = front(run)
    if way[-1] < FAR:
        return math.nan
    begin, end = (np.interp(at, way, times) for at in (NEAR, FAR))
    return (FAR - NEAR) / (end - begin)


def quantities(setups, done):
    case, run = setups["plate"].case, done["plate"]
    material, faces, crack = rhegma.one_material(case, TITLE), case["interface"], run.crack()
    rayleigh = gallery.rayleigh_speed(material)
    return [
        gallery.Quantity("angle (degrees)", angle(crack), 70.0, 60.0, 75.0),
        gallery.Quantity("speed over that of Rayleigh waves", speed(run) / rayleigh, 0.6, 0.4, 0.75),
        gallery.within("dissipated over area times damage (J/m2)", gallery.spent(run, crack), faces["energy"], 0.01),
        gallery.ledger(run),
    ]


def draw(setups, done):
    from drawing import BLUE, FAINT, INK, RED, plt

    run = done["plate"]
    crack = run.crack()
    middle, broken = 1e3 * crack["points"].mean(axis=1), crack["damage"] > 1 - 1e-6
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.6))
    left.plot(*middle[~broken].T[:2], ".", color=FAINT, markersize=2, label="broken")
    left.plot(*middle[broken].T[:2], ".", color=RED, markersize=3, label="failed")
    left.plot([0, 1e3 * TIP[0]], [1e3 * TIP[1]] * 2, color=INK)
    way = np.array([0, 70.0])
    for degrees, style in ((60, ":"), (70, "--"), (75, ":")):
        left.plot(50 + way * math.cos(math.radians(degrees)), 25 + way * math.sin(math.radians(degrees)), color=INK, linestyle=style,
                  linewidth=1, label=f"{degrees}°" if degrees == 70 else None)
    left.set(xlim=(0, 100), ylim=(0, 100), aspect="equal", xlabel="x (mm)", ylabel="y (mm)", title="upper half of the plate")
    left.legend(loc="upper left")
    times, distance = front(run)
    right.plot(1e6 * times, 1e3 * distance, color=BLUE, label="tip of the crack")
    rayleigh = gallery.rayleigh_speed(rhegma.one_material(setups["plate"].case, TITLE))
    begin = times[np.argmax(distance > NEAR)]
    right.plot(1e6 * times, 1e3 * np.maximum(times - begin, 0) * rayleigh, color=INK, linestyle="--", linewidth=1, label="Rayleigh waves")
    right.set(xlabel="time (µs)", ylabel="from the notch (mm)", ylim=(0, 80), title="how far")
    right.legend()
    return figure
