"""What theory says of a run, from the values of its case: closed forms that studies and pictures hold results against.
Each raises launch.BadInput for a case that it does not describe."""

import contextlib
import itertools
import math

import numpy as np
import rhegma
from drawing import with_unit
from launch import BadInput


def number_of(value, what):
    try:
        return float(value)
    except (TypeError, ValueError) as error:
        raise BadInput(f"{what} is for plain numbers, not {value!r}") from error


def box_of(case, what):
    """The box [2][3] of a case that is meshed by cubes."""
    mesh = case.get("mesh") or {}
    if "size" not in mesh:
        raise BadInput(f"{what} is for the built-in box; this case has a mesh file")
    low = np.array(mesh.get("origin", [0, 0, 0]), float)
    return np.array([low, low + np.array(mesh["size"], float)])


class Spall:
    """A bar of one elastic solid between z- and z+, whose ends are pulled at constant speeds and whose sides keep their
    planes: plane waves in uniaxial strain, until the bar breaks in the middle as they meet."""

    NAME = "1-D theory of the spall test"
    AXIS = 2

    def __init__(self, case, box=None):
        """`box` where the mesh is not the built-in one."""
        self.material = rhegma.one_material(case, self.NAME, rhegma.ELASTIC)
        self.box = box_of(case, self.NAME) if box is None else box
        self.speed = self.material.dilatational_speed
        self.bottom, self.top = self.box[:, 2]
        self.length = self.top - self.bottom
        pull = self.pull(case)
        impedance = self.material.density * self.speed
        self.low, self.high = -impedance * pull["z-"], impedance * pull["z+"]
        self.strength, self.energy = self.faces(case)
        self.breaks = self.low > 0 and self.high > 0 and self.low + self.high >= 0.999 * self.strength

    @classmethod
    def pull(cls, case):
        """The speeds of the ends. Nothing else may move."""
        pull, held = {}, set()
        for motion in case.get("boundary") or []:
            side, component = motion["set"], motion["component"]
            value = number_of(motion.get("velocity", motion.get("displacement")), f"{cls.NAME} ({side})")
            if component == "z" and side in ("z-", "z+") and "velocity" in motion:
                pull[side] = value
            elif value == 0 and component != "z":
                held.add((side, component))
            else:
                raise BadInput(f"{cls.NAME} has no motion of {side} along {component}")
        free = [f"{c}{sign}" for c in "xy" for sign in "-+" if (f"{c}{sign}", c) not in held]
        if len(pull) < 2 or free:
            raise BadInput(f"{cls.NAME} is for bars that are pulled at both ends (z-, z+) and cannot move at their sides")
        if any((case.get("initial") or {}).values()) or case.get("bodies"):
            raise BadInput(f"{cls.NAME} is for bars at rest, without rigid bodies")
        return pull

    @classmethod
    def faces(cls, case):
        """Strength and energy of the faces, which are all alike; infinite where none breaks."""
        interface = case.get("interface") or {}
        if interface.get("sets") or interface.get("weibull"):
            raise BadInput(f"{cls.NAME} is for faces of one strength")
        return tuple(number_of(interface.get(key, math.inf), cls.NAME) for key in ("strength", "energy"))

    def meeting(self):
        """When the waves meet in the middle."""
        return self.length / (2 * self.speed)

    def crossing(self):
        return self.length / self.speed

    def plane_energy(self):
        """What a flat crack across the bar takes."""
        return self.energy * np.prod(np.ptp(self.box, axis=0)[:2])

    def distances(self, z):
        """From a place to the nearer end and to where the waves meet."""
        to_end = min(z - self.bottom, self.top - z)
        return to_end, self.length / 2 - to_end

    def wave(self, t, to_end, to_other, reflection):
        """Unit wave from an end that moves at a given speed (reflects as it comes), with another boundary beyond."""
        stress, arrival, size = np.zeros_like(t), to_end, 1.0
        for there in itertools.cycle((True, False)):
            if arrival > self.speed * t[-1]:
                return stress
            stress += size * (self.speed * t >= arrival)
            arrival += 2 * (to_other if there else to_end)
            size *= reflection if there else 1.0

    def heading(self):
        ends = sorted({f"{stress / 1e6:.4g}" for stress in (self.high, self.low)})
        return (f"1-D theory: c$_d$ = {self.speed:.0f} m/s, incident {' and '.join(ends)} MPa, "
                f"meeting at {with_unit(self.meeting(), 's')}" + (", where the bar breaks" if self.breaks else ""))

    def stress(self, z, t):
        """Stress along the bar at z at ascending times."""
        above, below = self.top - z, z - self.bottom
        if self.breaks:  # at the mid-plane, when the waves meet: from then on two bars with a free end
            near = self.high if above < below else self.low
            return near * self.wave(t, *self.distances(z), -1.0)
        return self.high * self.wave(t, above, below, 1.0) + self.low * self.wave(t, below, above, 1.0)

    def events(self, z):
        """Times worth a mark at a place, with their names."""
        to_end, to_middle = self.distances(z)
        second = "unloading arrives" if self.breaks else "second wave arrives"
        return [
            (to_end / self.speed, "wave arrives"),
            (self.meeting(), "waves meet"),
            (self.meeting() + to_middle / self.speed, second),
        ]


def of(case):
    """A closed form of the normal stress along an axis of the case: its AXIS and heading, `stress` and `events` by the place
    along it. None where none is known."""
    for form in (Spall,):
        with contextlib.suppress(BadInput):
            return form(case)
    return None


def free_bar_half_period(case):
    """Of the first longitudinal mode of a free bar along z, with the inertia of its section (Rayleigh and Love):
    (L/c) sqrt(1 + (nu K pi/L)^2), K^2 = (a^2 + b^2)/12 for a rectangle of sides a and b."""
    what = "theory of the free bar"
    material, box = rhegma.one_material(case, what, rhegma.ELASTIC), box_of(case, what)
    if case.get("boundary") or case.get("bodies"):
        raise BadInput(f"{what} is for bars that nothing holds")
    a, b, length = np.ptp(box, axis=0)
    slender = material.poisson**2 * (a**2 + b**2) / 12 * (math.pi / length) ** 2
    return length / material.bar_speed * math.sqrt(1 + slender)


def half_period(energy, expected, width):
    """Half period of a mode within a relative width of the one expected, from the kinetic energy A + B cos 2wt + C sin 2wt
    by least squares; to a relative 5e-7 of the width."""
    time, kinetic = energy["time"], energy["kinetic"]

    def misfit(half):
        angle = 2 * math.pi * time / half
        basis = np.column_stack([np.ones_like(time), np.cos(angle), np.sin(angle)])
        rest = kinetic - basis @ np.linalg.lstsq(basis, kinetic, rcond=None)[0]
        return rest @ rest

    best = expected
    for part in (width, 1e-2 * width, 1e-4 * width):
        best = min(best * (1 + part * np.linspace(-1, 1, 401)), key=misfit)
    return best


def slowed(ratio):
    """Speed of waves through a row of cubes of side h and modulus E joined by springs, over that of the solid, for
    ratio = s h/E: root of E_eff/E = 1 - 1/(1 + ratio) (thesis 3.10)."""
    return np.sqrt(1 - 1 / (1 + np.asarray(ratio)))


class Stretched:
    """A bar along z of one elastic solid, stretched at a uniform rate until it falls to pieces."""

    NAME = "fragment sizes"

    def __init__(self, case):
        self.material = rhegma.one_material(case, self.NAME, rhegma.ELASTIC)
        self.length = np.ptp(box_of(case, self.NAME), axis=0)[2]
        interface = case.get("interface") or {}
        if not {"strength", "energy"} <= set(interface):
            raise BadInput(f"{self.NAME}: nothing can break, or at no cost (interface.strength, interface.energy)")
        self.strength, self.energy = (number_of(interface[key], self.NAME) for key in ("strength", "energy"))

    def grady(self, rate):
        """Size s of a fragment whose kinetic energy of stretching pays for a crack: rho rate^2 s^3/24 = G."""
        return (24 * self.energy / (self.material.density * rate**2)) ** (1 / 3)

    def glenn_chudnovsky(self, rate):
        """The same with the strain energy at the strength: rho rate^2 s^3/24 + strength^2 s/(2 E) = G."""
        inertia = self.material.density * rate**2 / 24
        roots = np.roots([inertia, 0, self.strength**2 / (2 * self.material.young), -self.energy])
        return float(roots[np.argmin(np.abs(roots.imag))].real)
