"""Runs Rhegma and reads what a run left in its output directory, as numpy arrays; moduli and wave speeds of the materials
of its case. SI units. What pictures, studies and tests have in common.

    bar = rhegma.run(rhegma.example("spall.yaml"), "results/spall", {"time.end": 0.3e-6})
    bar = rhegma.Run("results/spall")              # or one that is there
    bar.summary["first_fracture_time_s"], bar.case["material"]["young"]
    bar.energy["time"], bar.history["p1mm_szz"], bar.fragments["mass"]
    bar.fields(-1)["stress"], bar.crack(-1)["damage"]
    rhegma.one_material(bar.case, "the study").dilatational_speed
"""

import contextlib
import dataclasses
import math
import pathlib
import re
import sys

import launch
from launch import NAME, BadInput, example, read_mapping, read_text  # noqa: F401  (example: for those who import this)

try:
    import h5py
    import numpy as np
    import yaml
except ImportError as missing:
    sys.exit(f"{NAME}: {missing} (Debian: python3-h5py python3-numpy python3-yaml)")

ELASTIC = ("neo-hookean", "linear-elastic", "st-venant-kirchhoff")


# ---- cases ----


class CaseLoader(yaml.SafeLoader):
    """With the numbers of YAML 1.2, of which 1e-8 is one."""


CaseLoader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$"),
                                 list("-+.0123456789"))


def parse_yaml(text):
    try:
        return yaml.load(text, CaseLoader)
    except yaml.YAMLError as error:
        raise ValueError(error) from error


def read_case(path, overrides=()):
    """A case file as nested dictionaries, with "a.b=value" put in as the program does."""
    data = read_mapping(path, parse_yaml)
    for text in overrides:
        key, _, value = text.partition("=")
        *sections, last = key.split(".")
        inner = data
        try:
            for section in sections:
                inner = inner.setdefault(section, {})
            inner[last] = parse_yaml(value)
        except (AttributeError, TypeError, ValueError) as error:
            raise BadInput(f"--set {text}: {error}") from error
    return data


summary = launch.summary


def case(directory):
    """The case of a run with all values that it used."""
    return read_case(directory / "case.yaml")


# ---- tables and fields ----


def read_table(path, needed=()):
    """The rows of a CSV file as a structured array; its columns by name."""
    lines = read_text(path).splitlines()
    names = [name.strip() for name in lines[0].split(",")] if lines else []
    missing = [name for name in needed if name not in names]
    if missing:
        raise BadInput(f"{path}: no column {missing[0]!r}")
    if len(lines) < 2:
        raise BadInput(f"{path}: has no rows")
    try:
        return np.loadtxt(lines[1:], delimiter=",", dtype=[(name, float) for name in names], ndmin=1)
    except ValueError as error:
        raise BadInput(f"{path}: {error}") from error


def energy(directory, needed=()):
    return read_table(directory / "energy.csv", ["time", "total", *needed])


def history(directory, needed=()):
    return read_table(directory / "history.csv", ["time", *needed])


def fragments(directory):
    """None where the run did not write the table."""
    path = directory / "fragments.csv"
    return read_table(path, ["time", "id", "mass"]) if path.is_file() else None


@contextlib.contextmanager
def _fields(directory):
    path = directory / "fields.h5"
    if not path.is_file():
        raise BadInput(f"{path}: no such file")
    try:
        with h5py.File(path, "r") as file:
            yield file
    except (OSError, KeyError, ValueError) as error:
        raise BadInput(f"{path}: {error}") from error


def _frame_names(file, directory):
    names = sorted(file["frames"])
    if not names:
        raise BadInput(f"{directory / 'fields.h5'}: has no frames")
    return names


def mesh(directory):
    """Reference positions [n][3] of the nodes and, of each element, the numbers [m][10] of its nodes."""
    with _fields(directory) as file:
        return file["mesh/points"][:], file["mesh/cells"][:]


def frame_times(directory):
    with _fields(directory) as file:
        return np.array([file["frames"][name].attrs["time"] for name in _frame_names(file, directory)])


def fields(directory, number=-1, names=None):
    """A moment of the field output, -1 the last one: {"time", field name, "crack/" + field name: array}, of all fields
    or of these, as far as the run wrote them."""
    values = {}

    def keep(name, node):
        if isinstance(node, h5py.Dataset) and (names is None or name.split("/")[0] in names):
            values[name] = node[:]

    with _fields(directory) as file:
        group = file["frames"][_frame_names(file, directory)[number]]
        values["time"] = group.attrs["time"]
        group.visititems(keep)
    return values


def whole_fields(directory, number, names):
    """The same of a run that must have written all of these fields."""
    values = fields(directory, number, names)
    written = {name.split("/")[0] for name in values}
    missing = [name for name in names if name not in written]
    if missing:
        raise BadInput(f"{directory / 'fields.h5'}: the run did not write {missing[0]} (output.fields)")
    return values


def crack_of(values):
    """The crack surface of a frame: {"points": corners [n][3][3], field name: [n]}; None where it was not written."""
    found = {name[6:]: array for name, array in values.items() if name.startswith("crack/")}
    if "points" not in found:
        return None
    return {name: array.reshape(-1, 3, 3) if name == "points" else array.ravel() for name, array in found.items()
            if name != "cells"}


def crack(directory, number=-1):
    """The crack surface of a moment of the field output, as crack_of."""
    return crack_of(fields(directory, number, ["crack"]))


def box_of(points):
    """The smallest and the largest coordinates [2][3]."""
    return np.array([points.min(axis=0), points.max(axis=0)])


# ---- runs ----


class Run:
    """What a run left. Each file is read when it is asked for."""

    def __init__(self, directory):
        self.dir = pathlib.Path(directory)

    @property
    def summary(self):
        return summary(self.dir)

    @property
    def case(self):
        return case(self.dir)

    @property
    def energy(self):
        return energy(self.dir)

    @property
    def history(self):
        return history(self.dir)

    @property
    def fragments(self):
        return fragments(self.dir)

    def points(self):
        """Reference positions of the nodes, in the order of the nodal fields."""
        return mesh(self.dir)[0]

    def fields(self, number=-1, names=None):
        return fields(self.dir, number, names)

    def frames(self):
        """The fields of every moment."""
        return [self.fields(k) for k in range(len(frame_times(self.dir)))]

    def crack(self, number=-1):
        return crack(self.dir, number)


def run(case_file, out, sets=None, overrides=(), **keywords):
    """Runs a case to its end, as launch.run."""
    launch.run(case_file, out, sets, overrides, **keywords)
    return Run(out)


def run_once(case_file, out, sets=None, overrides=(), **keywords):
    """The same, unless a run of these values is there already, as launch.run_once. Returns the run and the seconds that it
    took, also of an earlier time."""
    seconds = launch.run_once(case_file, out, sets, overrides, **keywords)
    return Run(out), seconds


# ---- materials ----


@dataclasses.dataclass(frozen=True)
class Material:
    """A solid as it is before anything in it flows or cracks."""

    name: str
    model: str
    density: float
    shear: float
    poisson: float

    @property
    def young(self):
        return 2 * self.shear * (1 + self.poisson)

    @property
    def lame(self):
        return 2 * self.shear * self.poisson / (1 - 2 * self.poisson)

    @property
    def uniaxial(self):
        """Modulus of uniaxial strain, lambda + 2 mu."""
        return self.lame + 2 * self.shear

    @property
    def dilatational_speed(self):
        return math.sqrt(self.uniaxial / self.density)

    @property
    def shear_speed(self):
        return math.sqrt(self.shear / self.density)

    @property
    def bar_speed(self):
        """Of long waves in a thin bar, whose sides are free."""
        return math.sqrt(self.young / self.density)


def voigt_means(keys):
    """Bulk and shear modulus that an anisotropic solid has in the mean over all orientations of its stiffness."""
    stiffness = np.zeros((6, 6))
    if "stiffness" in keys:
        stiffness[np.triu_indices(6)] = [float(c) for c in keys["stiffness"]]
    else:
        young, (nu23, nu13, nu12), shear = (np.array(keys[key], float) for key in ("young", "poisson", "shear"))
        compliance = np.diag(np.concatenate([1 / young, 1 / shear]))
        for (i, j), nu in {(0, 1): nu12, (0, 2): nu13, (1, 2): nu23}.items():
            compliance[i, j] = compliance[j, i] = -nu / young[i]
        stiffness = np.linalg.inv(compliance)
    along, between = stiffness.trace() - stiffness[3:, 3:].trace(), stiffness[0, 1] + stiffness[0, 2] + stiffness[1, 2]
    return (along + 2 * between) / 9, (along - between + 3 * stiffness[3:, 3:].trace()) / 15


def moduli_of(keys):
    """Shear modulus and Poisson's ratio of small strains; nan of a user's solid that is not described by young and poisson."""
    model = keys["model"]
    if model == "anisotropic":
        bulk, shear = voigt_means(keys)
    elif model == "mooney-rivlin":
        bulk, shear = float(keys["bulk"]), 2 * (float(keys["c10"]) + float(keys.get("c01", 0)))
    elif model == "ogden":
        terms = [float(keys.get(f"mu_{n}", 0)) * float(keys.get(f"alpha_{n}", 0)) for n in (1, 2, 3)]
        bulk, shear = float(keys["bulk"]), sum(terms) / 2
    else:
        given = {**keys, **keys.get("parameters", {})} if model == "user" else keys
        if model == "user" and not ("poisson" in given and ("shear" in given or "young" in given)):
            return math.nan, math.nan
        poisson = float(given["poisson"])
        return float(given["shear"]) if "shear" in given else float(given["young"]) / (2 * (1 + poisson)), poisson
    return shear, (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear)


def material_of(keys, name="material"):
    """The material that the keys of `material` or of an entry of `materials` describe."""
    try:
        shear, poisson = moduli_of(keys)
        return Material(keys.get("name", name), keys["model"], float(keys["density"]), shear, poisson)
    except (KeyError, TypeError, ValueError, np.linalg.LinAlgError) as error:
        raise BadInput(f"not the case of a run: material: {error} is missing or wrong") from error


def materials(case):
    return [material_of(keys) for keys in [case.get("material") or {}, *(case.get("materials") or [])]]


def one_material(case, purpose, models=None):
    """The material of the whole body, or BadInput: `purpose` knows no other bodies."""
    found = materials(case)
    if len(found) > 1:
        raise BadInput(f"{purpose} is for bodies of one material; this case has {', '.join(m.name for m in found)}")
    if models is not None and found[0].model not in models:
        raise BadInput(f"{purpose} is for {', '.join(models)}; this case has {found[0].model}")
    return found[0]
