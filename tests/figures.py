"""Figures that a test states: a quantity in words, the value found, theory, and how far apart they may be.

    def test_wave(run, figure):
        figure("speed of a wave", found, theory=8906, bound=20, unit="m/s")
        figure("momentum", np.abs(momentum).max(), bound=3e-16, why=ROUNDING)

Without a theory it is 0: what is found is an error. With relative=True, bound is a share of the theory.

Where the environment variable RHEGMA_FIGURES names a file, each figure adds a line of JSON to it, from which tests/report
makes its table. The report, not the test, wants a bound within three times the deviation found, or a reason `why` it is
wider. The fixture `figure` is in conftest.py; figures.h is the same for tests in C."""

import json
import os

ROUNDING = "rounding differs between instruction sets"


def deviation(theory, found, relative):
    apart = abs(found - theory)
    return apart / abs(theory) if relative else apart


def state(test, single, quantity, found, *, bound, theory=0, unit="", relative=False, why=""):
    """Asserts that the figure is within its bound; test: the node id."""
    found, theory, bound = float(found), float(theory), float(bound)
    path = os.environ.get("RHEGMA_FIGURES")
    if path:
        line = json.dumps({"quantity": quantity, "theory": theory, "found": found, "bound": bound, "relative": relative,
                           "unit": unit, "why": why, "test": test, "ranks": 1, "single": single})
        file = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
        try:  # in one write, since others append to the same file
            os.write(file, (line + "\n").encode())
        finally:
            os.close(file)
    said = f"{quantity}: found {found:.6g} {unit}, theory {theory:.6g}, bound {bound:.2g}{' of it' if relative else ''}"
    print(said)
    assert deviation(theory, found, relative) <= bound, said
