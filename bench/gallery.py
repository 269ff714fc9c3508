"""The validation gallery: what a case of it is, and how it is run, judged and reported. bench/validate is its command line.

A folder of bench/examples with a validation.py is a case of the gallery. That module has

    TITLE     a line of words
    SEED      key of the case, or variable of the geometry ("geometry:seed"), that --seeds sets
    runs(full)                a dictionary: name of a run -> Setup, of the reduced or the full version
    quantities(setups, runs)  a list of Quantity, from {name: Setup} and {name: rhegma.Run}
    draw(setups, runs)        a figure

What is expected follows from `Setup.case`, the case as it stands in its folder: what --set changes in the runs it does not
know, so that a wrong value shows as one.
"""

import dataclasses
import functools
import hashlib
import html
import importlib.util
import json
import math
import pathlib
import statistics

import launch
import numpy as np
import rhegma

EXAMPLES = launch.ROOT / "bench/examples"
LEDGER = 0.01  # what the ledger may be off, of what was dissipated


@dataclasses.dataclass(frozen=True)
class Quantity:
    """A number of a run that theory or an experiment foretells. It holds between low and high, both included."""

    quantity: str
    value: float
    expected: float
    low: float
    high: float

    @property
    def ok(self):
        return self.low <= self.value <= self.high

    def record(self):
        value = self.value if math.isfinite(self.value) else None  # JSON knows no nan
        return {**dataclasses.asdict(self), "value": value, "ok": self.ok}


def within(quantity, value, expected, part, above=None):
    """One that may be off by a part of what is expected, above by another one."""
    above = part if above is None else above
    bounds = expected * (1 - part), expected * (1 + above)
    return Quantity(quantity, float(value), float(expected), float(min(bounds)), float(max(bounds)))


def ledger(run, name="energy error over dissipated", bound=LEDGER):
    """The row that each case with fracture has. None dissipated: the error over the largest energy."""
    error = run.summary["energy_error_dissipated"]
    return Quantity(name, float(run.summary["energy_error_rel"] if error is None else error), 0.0, -bound, bound)


def areas(crack):
    """Of the faces of a crack surface, as rhegma.crack gives it."""
    a, b, c = np.moveaxis(crack["points"], 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def first_fracture(run):
    """When the first face broke, in s; nan where none did."""
    begin = run.summary["first_fracture_time_s"]
    return math.nan if begin is None else begin


def spent(run, crack, chosen=slice(None)):
    """What was dissipated over area times damage, which is G_c with a linear law; of these faces, where others were open before."""
    weighted = math.fsum((areas(crack) * crack["damage"])[chosen])  # in any order of the faces
    return run.summary["dissipated_J"] / weighted if weighted > 0 else math.nan


@functools.cache
def rayleigh_speed(material):
    """Root of 4 a b = (1 + b^2)^2, a^2 = 1 - (v/c_d)^2, b^2 = 1 - (v/c_s)^2, by halving."""
    cd, cs = material.dilatational_speed, material.shear_speed
    low, high = 0.5 * cs, cs

    def rayleigh(v):
        a, b = math.sqrt(1 - (v / cd) ** 2), math.sqrt(1 - (v / cs) ** 2)
        return 4 * a * b - (1 + b * b) ** 2

    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if rayleigh(middle) > 0 else (low, middle)
    return low


def moving_crack_share(material, v):
    """G of a crack in mode I that runs at v, over that of one at rest under the same load: g = A k^2 (Freund 1990, 5.3 and 6.4),
    which is 1 - v/c_R only nearly. A = v^2 a_d/((1 - nu) c_s^2 D), D = 4 a_d a_s - (1 + a_s^2)^2, a^2 = 1 - (v/c)^2;
    k = (1 - v/c_R)/sqrt(1 - v/c_d) times what the factors of Rayleigh's function give, an integral over slownesses."""
    if v == 0:
        return 1.0
    cd, cs = material.dilatational_speed, material.shear_speed
    ad, as_ = math.sqrt(1 - (v / cd) ** 2), math.sqrt(1 - (v / cs) ** 2)
    universal = v**2 * ad / ((1 - material.poisson) * cs**2 * (4 * ad * as_ - (1 + as_**2) ** 2))
    fast, slow = 1 / cd, 1 / cs
    angle = (np.arange(400) + 0.5) * math.pi / 400
    s = (fast + slow) / 2 - (slow - fast) / 2 * np.cos(angle)
    phase = np.arctan(4 * s**2 * np.sqrt((s**2 - fast**2) * (slow**2 - s**2)) / (slow**2 - 2 * s**2) ** 2)
    integral = np.sum(phase / (1 / v - s) * np.sin(angle)) * (slow - fast) / 2 * math.pi / 400
    factor = (1 - v / rayleigh_speed(material)) / math.sqrt(1 - v / cd) * math.exp(integral / math.pi)
    return universal * factor**2


@functools.cache
def shares_of_speeds(material):
    speeds = rayleigh_speed(material) * np.linspace(0, 0.999, 1000)
    return speeds, np.array([moving_crack_share(material, v) for v in speeds])


def moving_crack_speed(material, share):
    """The speed at which G is that share of what it is at rest."""
    speeds, shares = shares_of_speeds(material)
    return np.interp(-np.asarray(share), -shares, speeds)


@dataclasses.dataclass(frozen=True)
class Setup:
    """A run of a case: values of its geometry (none: as drawn) and of its keys on top of those of the file."""

    file: pathlib.Path
    sets: dict = dataclasses.field(default_factory=dict)
    geometry: pathlib.Path | None = None
    values: dict = dataclasses.field(default_factory=dict)
    scale: float = 1e-3
    improve: bool = True

    @property
    def case(self):
        return rhegma.read_case(self.file, [f"{key}={json.dumps(value)}" for key, value in self.sets.items()])

    def seeded(self, key, seed):
        part, _, name = key.rpartition(":")
        if part == "geometry":
            return dataclasses.replace(self, values={**self.values, name: seed})
        return dataclasses.replace(self, sets={**self.sets, key: seed})


# ---- cases ----


def names():
    return sorted(path.parent.name for path in EXAMPLES.glob("*/validation.py"))


def load(name):
    """The module of a case."""
    if name not in names():
        raise launch.BadInput(f"{name}: no such case; there are {', '.join(names())}")
    spec = importlib.util.spec_from_file_location("validation_" + name.replace("-", "_"), EXAMPLES / name / "validation.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


# ---- runs ----


@dataclasses.dataclass(frozen=True)
class Layout:
    """Where and how runs are made."""

    out: pathlib.Path
    ranks: int = 1
    threads: int = 1
    overrides: tuple = ()

    @property
    def folder(self):
        return self.out / f"{self.ranks}x{self.threads}"


def make_mesh(setup, path):
    """Meshes the geometry unless that was done with the same text before."""
    head = "".join(f"{name} = {value!r};\n" for name, value in setup.values.items())
    text, source = head + launch.read_text(setup.geometry), path.with_suffix(".geo")
    if path.exists() and source.exists() and source.read_text() == text:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.unlink(missing_ok=True)
    source.write_text(text)
    launch.call([launch.program(), "mesh", source, "-o", path, "--scale", setup.scale, *(["--improve"] if setup.improve else [])],
                OMP_NUM_THREADS="1")


def fingerprints(setup):
    """Of what a run comes from: the case, the geometry, the program."""
    files = [path for path in (setup.file, setup.geometry, launch.program()) if path is not None and path.is_file()]
    return [hashlib.sha256(path.read_bytes()).hexdigest() for path in files]


def run(setup, out, layout):
    """Runs to the end, goes on with what was interrupted, or takes what is there: rhegma.Run and its seconds."""
    sets = {"checkpoint.wall_time": 120, **setup.sets}
    if setup.geometry is not None:
        mesh = out.parent / f"{out.name}.h5"
        make_mesh(setup, mesh)
        sets["mesh.file"] = str(mesh)
    own = {text.partition("=")[0] for text in layout.overrides}  # the program takes a key once
    sets = {key: value for key, value in sets.items() if key not in own}
    return rhegma.run_once(setup.file, out, sets, layout.overrides, resume=True, also=fingerprints(setup), accept=(0, 1),
                           launcher=launch.ranks_launcher(layout.ranks), OMP_NUM_THREADS=str(layout.threads))


def completed(name, done):
    """A row more for a run that did not come to its end."""
    summary = done.summary
    if summary["status"] == "completed":
        return []
    end = float(done.case["time"]["end"])
    return [Quantity(f"{name}: time reached (s), {summary['status']}", float(summary["time_end"]), end, end, end)]


@dataclasses.dataclass
class Result:
    name: str
    title: str
    quantities: list
    seconds: float
    picture: pathlib.Path | None = None
    scatter: list = dataclasses.field(default_factory=list)  # of each seed its quantities

    @property
    def ok(self):
        return all(one.ok for one in self.quantities)


def judge(module, setups, folder, layout):
    """The runs of one seed: quantities, runs, seconds."""
    done, seconds = {}, 0.0
    for name, setup in setups.items():
        done[name], took = run(setup, folder / name, layout)
        seconds += took
    cut_short = [row for name, one in done.items() for row in completed(name, one)]
    return cut_short or module.quantities(setups, done), done, seconds


def scattered(rows):
    """Quantities of several seeds in one list: the mean of each, which is judged, and [mean, deviation, least, most]."""
    merged, scatter = [], []
    for same in zip(*rows):
        values = [one.value for one in same]
        mean = statistics.fmean(values)
        merged.append(dataclasses.replace(same[0], value=mean))
        scatter.append((same[0].quantity, mean, statistics.stdev(values) if len(values) > 1 else 0.0, min(values), max(values)))
    return merged, scatter


def validate(name, layout, full=False, seeds=None):
    """A case from its meshes to its quantities and picture. With seeds: the mean over them is judged."""
    module, folder = load(name), layout.folder / ("full" if full else "reduced") / name
    rows, seconds, first = [], 0.0, None
    for seed in range(1, (seeds or 1) + 1):
        setups = module.runs(full)
        if seeds is not None:
            setups = {run_name: setup.seeded(module.SEED, seed) for run_name, setup in setups.items()}
        found, done, took = judge(module, setups, folder / f"seed-{seed}" if seeds is not None else folder, layout)
        rows.append(found)
        seconds += took
        first = first or (setups, done)
    quantities, scatter = scattered(rows) if seeds is not None else (rows[0], [])
    return Result(name, module.TITLE, quantities, seconds, picture_of(module, name, *first, layout), scatter)


def picture_of(module, name, setups, done, layout):
    from drawing import save  # what only asks for a list needs no matplotlib

    path = layout.folder / f"{name}.png"
    if all(one.summary["status"] == "completed" for one in done.values()):
        save(module.draw(setups, done), path)
        return path
    return None


# ---- what is told ----


def number(value):
    return f"{value:.4g}" if math.isfinite(value) else str(value)


def table(result):
    """In Markdown."""
    rows = [f"| {result.name} | value | expected | holds from | to | verdict |", "| --- | --- | --- | --- | --- | --- |"]
    rows += [f"| {one.quantity} | {number(one.value)} | {number(one.expected)} | {number(one.low)} | {number(one.high)} | "
             f"{'holds' if one.ok else 'FAILS'} |" for one in result.quantities]
    if result.scatter:
        rows += ["", "| over seeds | mean | standard deviation | least | most |", "| --- | --- | --- | --- | --- |"]
        rows += [f"| {' | '.join([quantity, *map(number, values)])} |" for quantity, *values in result.scatter]
    return "\n".join(rows)


STYLE = """body { font: 15px/1.45 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; color: #22272e }
table { border-collapse: collapse; margin: 1em 0 } td, th { border-bottom: 1px solid #d0d7de; padding: .25em .8em; text-align: right }
td:first-child, th:first-child { text-align: left } .fails { color: #c8392b; font-weight: bold } img { max-width: 100% }"""


def html_table(head, rows):
    def cells(row, kind):
        return "".join(f"<{kind}>{html.escape(str(cell))}</{kind}>" for cell in row)

    lines = [f'<tr{" class=fails" if row[-1] == "FAILS" else ""}>{cells(row, "td")}</tr>' for row in rows]
    return f"<table><tr>{cells(head, 'th')}</tr>\n" + "\n".join(lines) + "</table>"


def report(results, path, what):
    """One page with every table and picture."""
    parts = []
    for one in results:
        rows = [(q.quantity, *map(number, (q.value, q.expected, q.low, q.high)), "holds" if q.ok else "FAILS")
                for q in one.quantities]
        parts.append(f"<h2>{html.escape(one.name)}: {html.escape(one.title)}</h2>" +
                     html_table(("quantity", "value", "expected", "from", "to", "verdict"), rows))
        if one.scatter:
            parts.append(html_table(("over seeds", "mean", "deviation", "least", "most"),
                                    [(row[0], *map(number, row[1:])) for row in one.scatter]))
        if one.picture is not None:
            parts.append(f'<p><img src="{one.picture.name}" alt="{html.escape(one.name)}"></p>')
        parts.append(f"<p>{one.seconds:.0f} s in the solver.</p>")
    failed = sum(not one.ok for one in results)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Validation</title><style>{STYLE}</style>'
                    f"</head><body><h1>Against theory and experiments</h1><p>{html.escape(what)}: {len(results)} cases, in {failed} "
                    f"something fails.</p>{''.join(parts)}</body></html>\n")
