"""The same bits on any number of ranks and threads: state, ledger and history."""

import pathlib

import pytest
from conftest import CASES, EVERYWHERE, example, launch

LAYOUTS = [(1, 2), (2, 1), (2, 2), (3, 1)]  # ranks, threads; all compared with (1, 1)
PROBES = [{"name": "a", "at": [0.01e-3, 0.03e-3, 0.5e-3]}, {"name": "b", "at": [-0.05e-3, 0.02e-3, -1.1e-3], "strain": True}]
# 9 elements to a tile: two blocks of them in double precision.
FRAGMENTS = {"mesh.cells": [2, 2, 24], "time.end": 0.2e-6, "output.interval": 1e-8, "output.probes": PROBES, "output.energy_limit": 1e9}
VARIANTS = {
    "default": {},
    "incomplete": {"interface.form": "incomplete"},
    "lumped": {"mass": "lumped"},
    "scaled": {"mass": "scaled"},
    "defaults 0": {"defaults": 0},
    "thesis": {"defaults": 0, "interface.activation": "total", "interface.contact": "flux"},
    "conserving": {"interface.activation": "conserving", "interface.criterion": "mohr-coulomb", "interface.friction": 0.4,
                   "interface.rise": {"rate": 1e15, "exponent": 0.1, "most": 2}, "interface.sets": [{"where": "z > 0", "rise": 0.05}]},
    "isotropic": {"interface.penalty": "isotropic"},
    **EVERYWHERE,
    "prescribed": {"boundary": [{"set": "z+", "component": "z", "velocity": "1e8*t*(1 + 1e3*x)"},
                                {"set": "x-", "component": "x", "displacement": "1e6*t*y"}]},
}
SETS = ["x86-64-v2", "x86-64-v3", "x86-64-v4"]
KNOWN = " ".join((line for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("flags")))


def can_run(name):
    """As the program decides it."""
    needed = {"x86-64-v2": "sse4_2", "x86-64-v3": "avx2", "x86-64-v4": "avx512vl"}[name]
    return needed in KNOWN.split()


ISAS = [pytest.param(name, marks=pytest.mark.skipif(not can_run(name), reason="this machine does not have it"))
        for name in SETS]


def assert_same_bits(one, other):
    for key in ("state_hash", "unresolved_most_J", "unresolved_most_at"):
        assert one.summary.get(key) == other.summary.get(key), key
    for name in ("energy.csv", "history.csv", "fragments.csv"):
        assert (one.dir / name).read_bytes() == (other.dir / name).read_bytes(), name


@pytest.mark.parametrize("ranks, threads", LAYOUTS)
def test_spall_is_the_same_on_any_layout(run, ranks, threads):
    def spall(ranks, threads):
        sets = {"time.end": 0.25e-6, "output.fields": ["crack"]}
        return run(example("spall-jittered.yaml"), ranks=ranks, threads=threads, sets=sets)

    one, other = spall(1, 1), spall(ranks, threads)
    assert (other.summary["ranks"], other.summary["threads"]) == (ranks, threads)
    assert one.summary["broken_area_m2"] > 0.1e-6
    assert_same_bits(one, other)


@pytest.mark.parametrize("ranks, threads", LAYOUTS)
@pytest.mark.parametrize("variant", VARIANTS)
def test_fragments_are_the_same_on_any_layout(run, variant, ranks, threads):
    sets = {**FRAGMENTS, **VARIANTS[variant]}
    one = run(CASES / "fragments.yaml", sets=sets)
    other = run(CASES / "fragments.yaml", ranks=ranks, threads=threads, sets=sets)
    assert (other.summary["ranks"], other.summary["threads"]) == (ranks, threads)
    assert one.summary["failed_area_m2"] > 0
    assert variant != "prescribed" or one.summary["unresolved_most_J"] > 0
    assert_same_bits(one, other)


@pytest.mark.parametrize("ranks", [5, 8, 16])
def test_fragments_are_the_same_on_many_ranks(run, ranks):
    sets = {**FRAGMENTS, "time.end": 0.1e-6}
    one = run(CASES / "fragments.yaml", sets=sets)
    other = run(CASES / "fragments.yaml", ranks=ranks, sets=sets)
    assert one.summary["failed_area_m2"] > 0
    assert other.summary["ranks"] == ranks
    assert_same_bits(one, other)


def test_larger_tiles(run, tmp_path):
    """The same bits on any layout and from a mesh file; those of the usual tiles but for rounding."""
    sets = {"mesh.cells": [15, 15, 13], "mesh.tile": "512", "time.end": 2e-9, "output.interval": 1e-9,
            "output.probes": PROBES[:1]}
    usual = run(CASES / "fragments.yaml", sets={**sets, "mesh.tile": "256"})
    one = run(CASES / "fragments.yaml", sets=sets)
    for ranks, threads in [(1, 2), (2, 1)]:
        assert_same_bits(one, run(CASES / "fragments.yaml", ranks=ranks, threads=threads, sets=sets))
    mesh = tmp_path / "mesh.h5"
    words = [word for key in ("mesh.cells", "mesh.tile") for word in ("--set", f"{key}={sets[key]}")]
    assert launch("mesh", CASES / "fragments.yaml", "-o", mesh, *words).returncode == 0
    assert "17550 in 65 tiles" in launch("mesh", "--info", mesh).stdout
    from_file = run(CASES / "fragments.yaml", sets={**sets, "mesh": {"file": str(mesh)}}).summary
    assert from_file["state_hash"] == one.summary["state_hash"]
    assert one.summary["state_hash"] != usual.summary["state_hash"] and one.summary["failed_area_m2"] == 0
    assert one.energy["kinetic"][-1] == pytest.approx(usual.energy["kinetic"][-1], rel=1e-13)


# ---- Where the time goes ----


def test_phases_add_up_to_the_loop(run):
    summary = run(CASES / "fragments.yaml", ranks=3, sets=FRAGMENTS).summary
    for least, mean, most in [*summary["phases_s"].values(), summary["bytes_per_step"], summary["messages_per_step"]]:
        assert 0 <= least <= mean * (1 + 1e-5) and mean <= most * (1 + 1e-5)
    total = sum(mean for _, mean, _ in summary["phases_s"].values())
    loop = summary["wall_s"] - summary["output_s"]
    assert 0.5 * loop < total < 1.01 * summary["wall_s"]  # ranks wait for messages while another still writes


def test_halo_sends_one_message_to_each_neighbour_and_phase(run):
    summary = run(CASES / "fragments.yaml", ranks=3, sets=FRAGMENTS).summary
    assert summary["messages_per_step"] == pytest.approx([2 * n for n in summary["neighbours"]], rel=1e-5)
    assert summary["halo_doubles_per_face"] <= 33
    sent = 3 * summary["bytes_per_step"][1]  # by all; each cut face has two sides
    assert sent == pytest.approx(2 * summary["cut_faces"] * 8 * summary["halo_doubles_per_face"], rel=1e-5)


@pytest.mark.parametrize("variant", [name for name in VARIANTS if name != "default"])
def test_hash_tells_variants_apart(run, variant):
    one = run(CASES / "fragments.yaml", sets=FRAGMENTS)
    other = run(CASES / "fragments.yaml", sets={**FRAGMENTS, **VARIANTS[variant]})
    assert one.summary["state_hash"] != other.summary["state_hash"]


@pytest.mark.parametrize("key, value", [("mesh.seed", 2), ("material.density", 3690.000001)])
def test_hash_tells_small_changes_apart(run, key, value):
    one = run(CASES / "fragments.yaml", sets=FRAGMENTS)
    other = run(CASES / "fragments.yaml", sets={**FRAGMENTS, key: value})
    assert one.summary["state_hash"] != other.summary["state_hash"]


# ---- Instruction sets ----


@pytest.mark.parametrize("isa", ISAS)
def test_each_instruction_set_gives_the_same_bits_on_any_layout(run, isa):
    one = run(CASES / "fragments.yaml", sets=FRAGMENTS, RHEGMA_ISA=isa)
    other = run(CASES / "fragments.yaml", ranks=3, sets=FRAGMENTS, RHEGMA_ISA=isa)
    assert one.summary["instruction_set"] == other.summary["instruction_set"] == isa
    assert_same_bits(one, other)


@pytest.mark.parametrize("isa", ISAS)
def test_instruction_sets_agree_while_nothing_breaks(run, isa):
    sets = {**FRAGMENTS, "interface.strength": 400e9, "interface.energy": 34e6, "time.safety": 0.4}
    one = run(CASES / "fragments.yaml", sets=sets)
    other = run(CASES / "fragments.yaml", sets=sets, RHEGMA_ISA=isa)
    assert one.summary["broken_area_m2"] == other.summary["broken_area_m2"] == 0
    for name in ("kinetic", "bulk", "penalty", "total", "momentum_x", "momentum_z", "angular_y"):
        values = one.energy[name]
        assert other.energy[name] == pytest.approx(values, rel=1e-6, abs=1e-6 * abs(values).max()), name
    for name in ("a_ux", "b_uz", "a_vy", "b_vz", "a_szz", "b_sxy"):
        values = one.history[name]
        assert other.history[name] == pytest.approx(values, rel=1e-6, abs=1e-6 * abs(values).max()), name


@pytest.mark.parametrize("ranks", [1, 2])
def test_unknown_instruction_set_is_refused(scratch, ranks):
    out = scratch / f"unknown-isa-{ranks}"
    process = launch("run", CASES / "fragments.yaml", "-q", "-o", out, ranks=ranks, RHEGMA_ISA="x86-64-v9")
    assert process.returncode == 2
    assert "RHEGMA_ISA" in process.stderr
    assert not out.exists()
