"""Runs the built program for the system tests. A finished run is kept for the session: asking for it again is free.

The program is the one that environment variable RHEGMA names, else build/rhegma of this tree. RHEGMA_TIMEOUT: seconds that
a run may take."""

import functools
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import figures
import pytest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "bench"))
import rhegma  # noqa: E402  (of bench/)
from launch import example, ranks_launcher  # noqa: E402
from launch import options as overrides  # noqa: E402

PROGRAM = pathlib.Path(os.environ.get("RHEGMA", ROOT / "build" / "rhegma")).resolve()
CASES = ROOT / "tests" / "cases"
FRONT = {"output.crack_tips": [{"name": "left", "direction": [-1, 0, 0], "where": "abs(z) < 1e-4 && abs(nz) > 0.5"}],
         "output.crack_fronts": [{"name": "front", "at": [0, 0, 0], "direction": [-2, 0, 0], "normal": [0, 0, 1], "radius": {"inner": 5e-5, "outer": 1.6e-4}, "length": 3e-4,
                                  "tip": "left", "values": ["J"]}]}
EVERYWHERE = {  # changes of fragments.yaml that must not change the bits, on any layout and through a restart
    "friction": {"interface.friction": 0.5, "interface.contact": "potential", "interface.activation": "conserving",
                 "interface.law": "benzeggagh-kenane", "interface.shear": "fading", "interface.strength": "4e8*(1.05 + 0.05*nx)", "interface.sets": [
        {"where": "x > 0", "beta": "y > 0 ? 0 : 1.5 + 0.2*ny", "energy": "30 + 5e4*x", "friction": 0.2, "weibull": {"modulus": 20, "area": 1e-9}},
        {"where": "z*z < 1e-8", "law": "none"}], **FRONT},
    "continuous": {**FRONT, "interface.form": "continuous", "interface.faces": "nz*nz > 0.5"},
    "loads": {"materials": [{"name": "crystal", "where": "x > 0", "model": "anisotropic", "density": 3690, "young": [300e9, 250e9, 200e9], "poisson": [0.2, 0.3, 0.25],
                             "shear": [90e9, 110e9, 130e9], "orientation": {"angles": [20, 40, 60]}}],
              "interface.sets": [{"where": "abs(z) < 5e-5 && abs(nz) > 0.8 && x > 0", "open": True},
                                 {"where": "abs(z - 5.3e-4) < 5e-5 && abs(nz) > 0.8", "open": True, "at": 6e-8}],
              "tables": {"pulse": {"points": [[0, 0], [5e-8, 1], [2e-7, 0.2]], "smooth": True}},
              "output.crack_tips": [{"name": "left", "direction": [-1, 0, 0], "where": "abs(z) < 1e-4 && abs(nz) > 0.5", "distance": 5e-5}, {"name": "up", "direction": [0, 0, 2]}],
              "output.sensors": [{"name": "end", "set": "z+", "values": ["uz", "vz", "szz"], "measures": ["mean", "min", "max", "integral"]},
                                 {"name": "core", "where": "abs(z) < 5e-4", "values": ["von_mises", "vx"], "measures": ["mean", "max"]}],
              "loads": [{"name": "pull", "set": "z+", "traction": {"x": "2e7*pulse(t)*(1 + 1e3*y)", "z": "3e8*pulse(t)"}},
                        {"where": "abs(nx) > 0.5", "pressure": "2e8*pulse(2*t)*(1 + 1e2*z)", "from": 2e-8, "until": 1.5e-7},
                        {"name": "gas", "cracks": True, "where": "abs(nz) > 0.3", "pressure": "2e7*(1 + 1e3*x)*(1 + t/1e-7)"},
                        {"set": "y-", "force": {"y": 3}}, {"name": "bed", "set": "y+", "foundation": "1e14*(1 + 1e3*x)"}, {"name": "fall", "acceleration": {"y": -4e7, "z": "1e11*x*t/1e-7"}},
                        {"name": "spin", "where": "z > 0", "centrifugal": {"speed": "2e5*(1 + t/1e-7)", "axis": [1, 2, 0], "at": [0, 1e-4, 0]}}],
              "boundary": [{"name": "hold", "set": "z-", "angle": "2e4*t", "axis": [0, 1, 3], "translation": {"z": "3e6*t*t"}}, {"set": "x+", "absorbing": True},
                           {"set": "z+", "absorbing": True}, {"where": "abs(nx) > 0.5 && z > 0", "dashpot": 4e6}, {"name": "roll", "where": "nx < -0.5 && z > 0", "normal": "1e7*t*z", "until": 1.6e-7},
                           {"set": "y+", "direction": [1, 0, 2], "velocity": 3, "from": 1.4e-7},
                           {"name": "catch", "set": "y+", "component": "x", "displacement": "5*t", "from": 3e-8, "until": 1.3e-7}]},
    "contact": {"defaults": 1, "contact": {"model": "general", "friction": 0.2, "static_friction": 0.3, "damping": 3e-4}, "initial.stress": {"xx": "3e7*(1 + 1e3*z)", "yz": 1e7}, "initial.velocity": {"x": "z > 0 ? 1500 : -400", "y": 0, "z": "-8e4*z"},
                "interface.sets": [{"where": "abs(z) < 5e-5 && abs(nz) > 0.8", "open": True}],
                "bodies": [{"name": "ball", "shape": "sphere", "motion": "free", "radius": 1e-4, "at": [3.1e-4, 0, -1.3e-4], "mass": 2e-7, "velocity": {"z": 400}}],
                "materials": [{"name": "upper", "where": "z > 0", "model": "neo-hookean", "young": 240e9, "poisson": 0.2, "density": 3690}],
                "output.contacts": [{"name": "meeting", "between": ["upper", "material"]}, {"name": "west", "where": "nx < -0.5"}]},
    "loads, continuous": {"interface.form": "continuous", "interface.faces": "nz*nz > 0.5",
                          "initial.sets": [{"where": "z > 2e-4", "rotation": {"speed": 1e3, "axis": [1, 0, 2]}, "velocity": {"z": "30*sin(3e3*z)"}}],
                          "initial.stress": {"zz": "2e7*(1 + 1e3*x)", "xy": 5e6},
                          "boundary": [{"set": "x+", "absorbing": True}, {"set": "z-", "dashpot": 2e7}, {"where": "nx < -0.5", "normal": 0},
                                       {"set": "y+", "direction": [1, 0, 2], "velocity": "1e7*t", "from": 3e-8}],
                          "loads": [{"name": "pull", "set": "z+", "traction": {"z": "3e8 + 1e12*x"}}]},
}
TIMEOUT = int(os.environ.get("RHEGMA_TIMEOUT", 300))  # seconds: a run that hangs is a failure
ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "OMPI_MCA_pml": "ob1",  # as in tests/run
    "OMP_WAIT_POLICY": "passive",
}
SINGLE = "single precision" in subprocess.run([PROGRAM, "--version"], env={**os.environ, **ENVIRONMENT},
                                               capture_output=True, text=True, timeout=TIMEOUT).stdout


if not SINGLE:
    EVERYWHERE["continuous"]["materials"] = [{"name": "rubber", "where": "x > 0 && z > 0", "model": "mooney-rivlin", "density": 3690, "bulk": 150e9, "c10": 40e9, "c01": 14e9},
                                            {"name": "ogden", "where": "x < 0 && z > 0", "model": "ogden", "density": 3690, "bulk": 150e9, "mu_1": 60e9, "alpha_1": 1.3, "mu_2": -60e9, "alpha_2": -2}]


def rounding(double, single):
    """The bound of what only rounding disturbs, for the precision of the program. Single: about three times what was
    measured."""
    return single if SINGLE else double


def launch(*arguments, ranks=1, threads=1, cwd=None, **environment):
    """The program with these arguments, to its end: a CompletedProcess with text."""
    env = {**os.environ, **ENVIRONMENT, "OMP_NUM_THREADS": str(threads), **environment}
    return subprocess.run([*map(str, ranks_launcher(ranks)), str(PROGRAM), *map(str, arguments)], env=env, cwd=cwd, capture_output=True,
                          text=True, timeout=TIMEOUT)


class Run(rhegma.Run):
    """A run that has ended, with its streams."""

    def __init__(self, directory, process):
        super().__init__(directory)
        self.stdout, self.stderr = process.stdout, process.stderr


@pytest.fixture(scope="session")
def scratch(request):
    """A directory that is removed at the end, unless a test failed."""
    directory = pathlib.Path(tempfile.mkdtemp(prefix="rhegma-tests-"))
    yield directory
    if request.session.testsfailed == 0:
        shutil.rmtree(directory)


@pytest.fixture(scope="session")
def run(scratch):
    """run(case, ranks=1, threads=1, sets={"a.b": value}, expect=0, **environment): a finished Run."""
    finished = {}

    def go(case, ranks=1, threads=1, sets=None, expect=0, **environment):
        arguments = ["run", case, "-q", *overrides(sets)]
        key = (ranks, threads, *arguments, *sorted(environment.items()))
        if key not in finished:
            directory = scratch / f"{len(finished):03d}-{pathlib.Path(case).stem}"
            process = launch(*arguments, "-o", directory, ranks=ranks, threads=threads, **environment)
            assert process.returncode == expect, process.stderr
            finished[key] = Run(directory, process)
        return finished[key]

    return go


@pytest.fixture(scope="session")
def spall(run):
    return run(example("spall.yaml"), threads=2)


@pytest.fixture(scope="session")
def spall_run(spall):
    return spall.dir


@pytest.fixture
def figure(request):
    """figure(quantity, found, bound=..., theory=0, unit="", relative=False, why=""): see figures.py."""
    return functools.partial(figures.state, request.node.nodeid, SINGLE)


def pytest_addoption(parser):
    parser.addoption("--figures", action="store_true", help="only the tests that state figures (figures.py)")


def pytest_collection_modifyitems(config, items):
    if config.getoption("figures"):
        dropped = [item for item in items if "figure" not in item.fixturenames]
        config.hook.pytest_deselected(items=dropped)
        items[:] = [item for item in items if "figure" in item.fixturenames]
