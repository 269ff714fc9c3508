"""How the pictures of studies and runs look, and the units in which they give their numbers."""

import math
import sys

from launch import NAME, BadInput

try:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt
except ImportError as missing:
    sys.exit(f"{NAME}: {missing} (Debian: python3-matplotlib)")

INK, GREY, FAINT = "#22272e", "#57606a", "#8b949e"
BLUE, RED, GREEN, YELLOW = "#1f6fb2", "#c8392b", "#2a9d62", "#e0a100"
plt.rcParams.update({
    "figure.constrained_layout.use": True,
    "figure.figsize": (8.5, 4.2),
    "font.size": 10,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.titlelocation": "left",
    "axes.titlesize": 10,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e6e8eb",
    "axes.axisbelow": True,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "lines.linewidth": 1.6,
    "savefig.dpi": 160,
    "savefig.facecolor": "white",
})


def prefixed(largest, unit, power=1, least=1.0):
    """Factor and name of the unit in which `largest` is handy, not below `least`: 2e-7, "s" gives 1e9, "ns"."""
    prefixes = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
    exponent = 0
    if largest > 0 and math.isfinite(largest):
        exponent = 3 * math.floor(math.log10(largest / least * (1 + 1e-9)) / (3 * power))
    exponent = min(max(exponent, -9), 9)
    return 10.0 ** (-exponent * power), prefixes[exponent] + unit + {1: "", 2: "²"}[power]


def with_unit(value, unit, power=1):
    factor, name = prefixed(abs(value), unit, power, least=0.1)
    return f"{value * factor:.4g} {name}"


def place(x):
    """A position with its unit."""
    factor, unit = prefixed(max(map(abs, x)), "m", least=0.1)
    return f"({', '.join(f'{c * factor:.4g}' for c in x)}) {unit}"


def add_title(figure, text):
    figure.suptitle(text, x=0.02, ha="left", fontsize=11)


def note(axes, text, at, offset=(3, 2), **keywords):
    """Small words at a place, moved from it by so many points."""
    return axes.annotate(text, at, offset, **{"textcoords": "offset points", "fontsize": 8, "color": GREY, **keywords})


def save(figure, path):
    """Writes the picture, makes its directory where that is missing, and tells its path."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path)
    except OSError as error:
        raise BadInput(f"{path}: cannot be written: {error.strerror}") from error
    plt.close(figure)
    print(path, flush=True)
