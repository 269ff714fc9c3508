"""collision.yaml: a bar is torn in two and its halves are pushed together again."""

import numpy as np
import pytest
from conftest import CASES, rounding
from figures import ROUNDING

EDGE = 0.1e-3  # m, of a cube
TORN, CLOSED = 0.4e-6, 0.7e-6  # s: the crack gapes at the first and is shut from the second on


@pytest.fixture(scope="module")
def collision(run):
    return run(CASES / "collision.yaml", threads=2)


def openings(collision, begin, end=np.inf):
    return [frame["crack/opening"] for frame in collision.frames() if begin <= frame["time"] <= end]


def test_bar_is_torn_before_it_closes(collision, figure):
    (torn,) = openings(collision, TORN - 0.5e-8, TORN + 0.5e-8)
    assert torn.max() > 0.02 * EDGE
    at = np.argmin(np.abs(collision.energy["time"] - TORN))
    figure("halves that are torn apart: area of the crack", 1e6 * collision.energy["failed_area"][at], theory=0.16,
           bound=rounding(4e-15, 2e-7), unit="mm2", relative=True, why=ROUNDING)


def test_closed_crack_stays_pressed(collision, figure):
    late = openings(collision, CLOSED)
    assert len(late) > 20
    figure("halves pressed together: largest opening, in edges", max(opening.max() for opening in late) / EDGE, bound=2e-3)


def test_halves_hardly_interpenetrate(collision, figure):
    lowest = min(opening.min() for opening in openings(collision, 0) if len(opening))
    assert lowest < 0
    figure("halves pressed together: penetration, in edges", -lowest / EDGE, bound=5e-3)


def test_contact_takes_up_energy_and_gives_it_back(collision, figure):
    energy = collision.energy
    late = energy["time"] > CLOSED
    assert energy["contact"].max() > 1e-6
    figure("halves pressed together: least energy of contact later, of the most",
           energy["contact"][late].min() / energy["contact"].max(), bound=3e-5)


def test_energy_balance_through_tearing_and_collision(collision, figure):
    assert collision.summary["status"] == "completed"
    figure("halves torn apart and pressed together: energy error", collision.summary["energy_error_rel"], bound=0.0018)


def test_collision_alone_changes_the_energy_by_little(collision, figure):
    energy = collision.energy
    late = energy["time"] > 0.5e-6
    figure("halves pressed together: change of the energy from 0.5 us on, relative",
           np.ptp(energy["total"][late]) / collision.summary["energy_largest_J"], bound=3e-4)
