"""A point of a material along a path, by the scalar twin of its kernel (kernels/reference), which the tests hold the kernels
against.

    steel = point.Solid(point.preset("steel-4340"))
    pulled = steel.uniaxial_stress(np.linspace(0, 0.2, 201)[1:], rate=1e3)
    plt.plot(pulled.strain[:, 2], pulled.stress[:, 2])

Needs a C compiler and the sources."""

import ctypes
import functools
import pathlib
import re
import subprocess
import tempfile

import launch
import numpy as np
import rhegma

HELD, ALIKE, EACH = range(3)  # point_free of point.h
INSIDE = "damage regime plastic_strain plastic_volume bulking_pressure temperature".split()  # RG_INTERNAL_ of kernels.h
KERNELS = launch.ROOT / "kernels"
SOURCES = [launch.ROOT / "bench/point.c", *sorted((KERNELS / "reference").glob("*.c")), KERNELS / "materials.c",
           KERNELS / "stressed.c", KERNELS / "cohesive/facts.c", KERNELS / "material/deshpande_evans.c"]


class Step(ctypes.Structure):
    _fields_ = [("stretch", ctypes.c_double * 3), ("pressure", ctypes.c_double), ("duration", ctypes.c_double)]


@functools.cache
def library():
    with tempfile.TemporaryDirectory() as directory:
        path = pathlib.Path(directory, "point.so")
        launch.call(["cc", "-std=c17", "-O1", "-shared", "-fPIC", f"-I{KERNELS}", *SOURCES, "-o", path, "-lm"])
        found = ctypes.CDLL(path)
    if number(found, "point_values") != 9 + len(INSIDE):
        raise launch.BadInput("point.py has other values inside a point than kernels.h")
    return found


def number(of, name):
    return ctypes.c_int.in_dll(of, name).value


def doubles(values):
    return (ctypes.c_double * len(values))(*values)


def preset(name):
    """The keys of a preset, as the program prints them."""
    said = launch.call([launch.program(), "materials", name]).stdout
    return rhegma.parse_yaml(re.search(r"the same as (\{.*\})$", said, re.M)[1])


class Path:
    """What a point goes through, a row a step. Along its three axes: `stretch`, and Cauchy `stress` (Pa); `energy` stored and
    set free so far by `flow` and `cracking` (J/m3); what is `inside` (INSIDE)."""

    def __init__(self, time, found):
        self.time, self.stress, self.stretch = time, found[:, :3], found[:, 3:6]
        self.energy, self.flow, self.cracking = found[:, 6:9].T
        self.inside = dict(zip(INSIDE, found[:, 9:].T))

    @property
    def strain(self):
        """Logarithmic."""
        return np.log(self.stretch)

    @property
    def volume(self):
        return self.stretch.prod(axis=1)

    @property
    def compression(self):
        """mu: by how much the density has grown, over that at first."""
        return 1 / self.volume - 1

    @property
    def pressure(self):
        return -self.stress.mean(axis=1)

    @property
    def mises(self):
        return np.sqrt(1.5 * ((self.stress + self.pressure[:, None])**2).sum(axis=1))

    @property
    def nominal(self):
        """Force along the axes per area at first (Pa)."""
        return self.stress * self.volume[:, None] / self.stretch


class Solid:
    """`keys`: a block `material` of a case. Of deshpande-evans the numbers are those of rg_deshpande_evans_alumina()."""

    def __init__(self, keys):
        self.keys, self.material, of = keys, rhegma.material_of(keys), library()
        self.model = of.point_model(keys["model"].encode())
        if self.model < 0:
            raise launch.BadInput(f"{keys['model']}: no such model")
        self.elastic = doubles([self.material.lame, self.material.shear, self.material.density])
        if keys["model"] == "anisotropic":
            constants = [float(c) for c in keys["stiffness"]]
        else:
            names = (ctypes.c_char_p * number(of, "point_parameters")).in_dll(of, "point_key")
            constants = [float(keys.get(name.decode(), 0)) for name in names]
        self.constants = doubles(constants)

    def __getitem__(self, key):
        return float(self.keys[key])

    @property
    def bulk(self):
        return self.material.lame + 2 / 3 * self.material.shear

    def stress(self, gradient):
        """P (Pa) of the virgin solid at a deformation gradient."""
        found = (ctypes.c_double * 9)()
        library().point_stress(self.model, self.elastic, self.constants, doubles(np.ravel(gradient)), found)
        return np.reshape(found, (3, 3))

    def walk(self, stretch, duration, pressure=0.0, free=HELD, axes=np.eye(3)):
        """Steps of `duration` (s) that end at `stretch` (n x 3), of which the first two do not count where they are free: there the
        `pressure` across is told. Both durations and pressures may change from step to step. `axes` are orthonormal rows."""
        steps = np.zeros((len(stretch), 5))
        steps[:, :3], steps[:, 3], steps[:, 4] = stretch, pressure, duration
        found = np.zeros((len(steps), 9 + len(INSIDE)))
        as_steps = (Step * len(steps)).from_buffer(np.ascontiguousarray(steps))
        done = library().point_walk(self.model, self.elastic, self.constants, doubles(np.ravel(axes)), free, len(steps), as_steps,
                                    found.ctypes.data_as(ctypes.c_void_p))
        if done < len(steps):
            raise launch.BadInput(f"{self.keys['model']}: step {done}: no stretch across gives a pressure of {steps[done, 3]:g} Pa")
        return Path(np.cumsum(steps[:, 4]), found)

    def _along(self, strain, rate, **more):
        strain = np.asarray(strain, float)
        return self.walk(np.exp(np.outer(strain, [0, 0, 1])), np.abs(np.diff(strain, prepend=0)) / rate, **more)

    def uniaxial_strain(self, strain, rate=1.0):
        """Logarithmic strains along the third axis, which must change from step to step, at a rate (1/s)."""
        return self._along(strain, rate)

    def uniaxial_stress(self, strain, rate=1.0, pressure=0.0, **more):
        """Likewise under a constant pressure across, from where that pressure from all sides would bring an elastic solid."""
        begin = -pressure / (3 * self.bulk)
        return self._along(begin + np.asarray(strain, float), rate, **{"pressure": pressure, "free": ALIKE, **more})

    def from_all_sides(self, compression, rate=1.0):
        """Pressed to mu, which must change from step to step."""
        strain = -np.log1p(np.asarray(compression, float)) / 3
        return self.walk(np.exp(np.outer(strain, [1, 1, 1])), np.abs(np.diff(strain, prepend=0)) / rate)

    def acoustic(self, normal, step=1e-6):
        """Acoustic tensor of the virgin solid (Pa), by differences of its stress."""
        columns = []
        for a in np.eye(3):
            move = step * np.outer(a, normal)
            columns.append((self.stress(np.eye(3) + move) - self.stress(np.eye(3) - move)) @ normal / (2 * step))
        return np.transpose(columns)

    def wave_speeds(self, normal):
        """From the slowest on (m/s)."""
        tensor = self.acoustic(normal)
        return np.sqrt(np.linalg.eigvalsh((tensor + tensor.T) / 2) / self.material.density)
