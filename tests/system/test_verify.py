"""rhegma verify as a user starts it."""

import pytest
from conftest import launch


@pytest.mark.parametrize("ranks, threads", [(1, 2), (2, 1)])
def test_verify_holds_here(tmp_path, ranks, threads):
    process = launch("verify", ranks=ranks, threads=threads, cwd=tmp_path)
    assert process.returncode == 0, process.stdout + process.stderr
    lines = process.stdout.splitlines()
    assert f"{ranks} ranks x {threads} threads" in lines[0]
    assert lines[1].split() == ["check", "theory", "measured", "deviation", "limit", "ok"]
    assert len(lines) >= 16 and all(line.endswith(" yes") for line in lines[2:-1])
    assert lines[-1].startswith("all checks hold")
    said = process.stdout
    for what in ("pressure waves", "shear waves", "patch test", "turned", "energy", "spall: time", "G_c", "same bits"):
        assert what in said
    assert process.stderr == "" and list(tmp_path.iterdir()) == []


def test_verify_takes_nothing_else():
    process = launch("verify", "case.yaml")
    assert process.returncode == 2 and "verify takes nothing else" in process.stderr
