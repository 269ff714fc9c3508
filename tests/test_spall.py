"""The spall test of Seagraves (MIT 2010, chapter 5): waves of 200 MPa from both ends meet at 0.2246 us, add up to the
strength of 400 MPa and break the bar on its mid-plane, at a cost of 5.44 uJ."""

import numpy as np
import pytest
import yaml
from conftest import BENCH

SPALL = BENCH / "spall.yaml"
AREA = 0.4e-3 * 0.4e-3  # m^2, of the bar
MEETING = 0.2246e-6  # s
ARRIVAL = 0.1123e-6  # s, at the probe 1 mm from the middle


@pytest.fixture(params=["regular", "jittered"])
def bar(request, run, spall):
    """The case as it stands, on both meshes; the fields that are not looked at are left out of the second."""
    if request.param == "regular":
        return spall
    return run(BENCH / "spall-jittered.yaml", threads=2, sets={"output.fields": ["crack"]})


def test_breaks_when_the_waves_meet(bar):
    assert bar.summary["status"] == "completed"
    assert bar.summary["first_fracture_time_s"] == pytest.approx(MEETING, rel=0.03)


def test_incident_wave_is_200_mpa(bar):
    history = bar.history
    plateau = (history["time"] > 0.125e-6) & (history["time"] < 0.31e-6)
    assert history["p1mm_szz"][plateau].mean() == pytest.approx(200e6, rel=0.03)


def test_incident_wave_arrives_in_time(bar):
    history = bar.history
    first = np.argmax(history["p1mm_szz"] > 100e6)
    assert history["time"][first] == pytest.approx(ARRIVAL, rel=0.03)


def test_unloading_wave_follows_the_fracture(bar):
    history = bar.history
    late = history["time"] > 0.38e-6
    assert np.abs(history["p1mm_szz"][late]).max() < 100e6


def test_regular_mesh_breaks_on_the_mid_plane(spall):
    crack = spall.frames()[-1]
    triangles = crack["crack/points"].reshape(-1, 3, 3)[crack["crack/damage"].ravel() > 0.99]
    assert np.abs(triangles[:, :, 2]).max() < 1e-6
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    assert np.linalg.norm(cross, axis=1).sum() / 2 == pytest.approx(AREA, rel=1e-3)


def test_regular_mesh_dissipates_little_more_than_the_flat_plane(spall):
    assert 5.4e-6 < spall.summary["dissipated_J"] < 9e-6


def test_energy_balance_at_half_the_critical_step(run, spall):
    safety = yaml.safe_load((spall.dir / "case.yaml").read_text())["time"]["safety"]
    half = spall if safety == 0.5 else run(SPALL, threads=2, sets={"time.safety": 0.5, "output.fields": []})
    assert half.summary["energy_error_rel"] < 0.01


def test_energy_balance_at_the_default_step(bar):
    assert bar.summary["energy_error_rel"] < 0.02
