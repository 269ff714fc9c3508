"""collision.yaml: a bar is torn in two and its halves are pushed together again."""

import numpy as np
import pytest
from conftest import CASES

EDGE = 0.1e-3  # m, of a cube
TORN, CLOSED = 0.4e-6, 0.7e-6  # s: the crack gapes at the first and is shut from the second on


@pytest.fixture(scope="module")
def collision(run):
    return run(CASES / "collision.yaml", threads=2)


def openings(collision, begin, end=np.inf):
    return [frame["crack/opening"] for frame in collision.frames() if begin <= frame["time"] <= end]


def test_bar_is_torn_before_it_closes(collision):
    (torn,) = openings(collision, TORN - 0.5e-8, TORN + 0.5e-8)
    assert torn.max() > 0.02 * EDGE
    at = np.argmin(np.abs(collision.energy["time"] - TORN))
    assert collision.energy["failed_area"][at] == pytest.approx(0.16e-6, rel=1e-6)


def test_closed_crack_stays_pressed(collision):
    late = openings(collision, CLOSED)
    assert len(late) > 20
    assert max(opening.max() for opening in late) < 1e-3 * EDGE


def test_halves_do_not_interpenetrate(collision):
    lowest = min(opening.min() for opening in openings(collision, 0) if len(opening))
    assert -0.01 * EDGE < lowest < 0


def test_contact_takes_up_energy_and_gives_it_back(collision):
    energy = collision.energy
    late = energy["time"] > CLOSED
    assert energy["contact"].max() > 1e-6
    assert energy["contact"][late].min() < 0.01 * energy["contact"].max()


def test_energy_balance_through_tearing_and_collision(collision):
    assert collision.summary["status"] == "completed"
    assert collision.summary["energy_error_rel"] < 0.01


def test_collision_alone_changes_the_energy_by_little(collision):
    energy = collision.energy
    late = energy["time"] > 0.5e-6
    change = np.ptp(energy["total"][late]) / collision.summary["energy_largest_J"]
    assert change < 0.01
