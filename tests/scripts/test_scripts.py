"""Every script of bench/ and perf/ once, as a user starts it but on tiny meshes: none is broken unseen. What they make of
their results is held to account in test_plot.py, test_plot_impact.py, test_studies.py and test_perf.py; bench/scaling,
bench/studies/efficiency and perf/simulate run are started in test_scaling.py."""

import json
import os
import re
import shutil
import subprocess

import numpy as np
import pytest
import rhegma
from conftest import ENVIRONMENT, PROGRAM, ROOT, SINGLE, TIMEOUT, example, launch

BUILD = PROGRAM.parent
PNG = b"\x89PNG\r\n"
benches = pytest.mark.skipif(not (BUILD / "rhegma-pattern").exists(), reason="built without -Dbench=true")


def start(*words, expect=0, **environment):
    """Standard output and error of a script."""
    env = {**os.environ, **ENVIRONMENT, "OMP_NUM_THREADS": "1", "RHEGMA": str(PROGRAM), **environment}
    process = subprocess.run([str(word) for word in words], env=env, capture_output=True, text=True, timeout=TIMEOUT)
    assert process.returncode == expect, process.stderr or process.stdout
    return process.stdout, process.stderr


def script(name, *words, **options):
    return start(ROOT / name, *words, **options)


def assert_pictures(out, told, *names):
    """They are there, and the script ends by telling them."""
    for name in names:
        assert (out / name).read_bytes()[:6] == PNG
        assert str(out / name) in told.splitlines()


@pytest.mark.skipif(shutil.which("dpkg-query") is None or shutil.which("ninja") is None, reason="bench/setup is for Debian")
def test_demo(tmp_path):
    """In a tree that shares scripts and build with this one, for the demo's results lie in its tree."""
    (tmp_path / "bench").symlink_to(ROOT / "bench")
    (tmp_path / "build").symlink_to(BUILD)
    told, _ = start("bash", tmp_path / "bench/demo", "--set", "mesh.cells=[2, 2, 20]", "--set", "time.end=0.3e-6")
    out = tmp_path / "results/spall"
    lines = [text.strip() for text in told.splitlines()]
    assert lines[-1] == f"ParaView: {out}/fields.xdmf" and (out / "fields.xdmf").exists()
    assert lines[-2] == f"page to turn the crack with the mouse: {out}/run.html" and "Plotly" in (out / "run.html").read_text()
    pictures = lines[lines.index("pictures:") + 1:-2]
    assert [str(out / name) for name in ("history.png", "energy.png")] == pictures[:2] and str(out / "crack.png") in pictures
    assert all(open(path, "rb").read(6) == PNG for path in pictures)


@pytest.mark.skipif(SINGLE, reason="the ceramic needs double precision")
def test_impact_and_its_pictures(tmp_path):
    """bench/studies/impact calls bench/plot and bench/studies/plot-impact; what is there already is not run again."""
    words = ["structured", "--out", tmp_path, "--set", "mesh.cells=[8, 8, 4]", "--set", "time.end=0.4e-6", "--set",
             "output.times=[0.4e-6]"]
    told, _ = script("bench/studies/impact", *words)
    out = tmp_path / "structured"
    assert rhegma.summary(out)["ranks"] == 2
    assert_pictures(out, told, "history.png", "energy.png", "crack.png", "impact-0.40us.png", "views.png")
    assert "plane waves take 1.170 us" in told and "fully broken" in told
    change, speed = re.search(r"changes by (\S+) of itself at most; the ball flies on at (\S+) m/s", told).groups()
    assert float(change) < 1e-13 and 280 < float(speed) < 300
    when = (out / "summary.json").stat().st_mtime_ns
    script("bench/studies/impact", *words)
    assert (out / "summary.json").stat().st_mtime_ns == when


def test_free_bar(tmp_path):
    told, _ = script("bench/studies/free-bar", "--out", tmp_path, "--steps", 60, "--set", "mesh.cells=[1, 1, 6]")
    assert "variational: completed" in told and "theory 2.383493e-07 s" in told
    assert_pictures(tmp_path, told, "free-bar.png")


@pytest.mark.skipif(SINGLE, reason="the ceramic needs double precision")
def test_ceramic_curves(tmp_path):
    told, _ = script("bench/studies/ceramic-curves", "--out", tmp_path, "--rates", "1e6")
    assert [text.split()[0] for text in told.splitlines()[:2]] == ["compression", "tension"]
    strongest = float(told.split(" GPa")[0].split()[-1])
    assert -10 < strongest < -4  # the static strength is that of yield, 4 GPa, and rises with the rate
    assert_pictures(tmp_path, told, "ceramic-curves.png")


@pytest.mark.skipif(SINGLE, reason="once is enough")
def test_material_curves(tmp_path):
    told, _ = script("bench/studies/material-curves", "neo-hookean", "viscoelastic", "--set", "young=3e9", "--out", tmp_path)
    assert_pictures(tmp_path, told, "neo-hookean.png", "viscoelastic.png")
    _, said = script("bench/studies/material-curves", "concrete", expect=2)
    assert "concrete: no such solid; there are neo-hookean, " in said


@pytest.mark.parametrize("kind", ["inp", "vtu"])
def test_import(tmp_path, kind):
    told, _ = script("bench/studies/import", "--out", tmp_path, "--cells", 4, "--kind", kind)
    assert re.fullmatch(rf"{kind}: 384 tets: \d+\.\d\d us each, \d+\.\d\d of it in the system, \d+ bytes\n", told)
    assert list(tmp_path.iterdir()) == []


def test_intrinsic(tmp_path):
    told, _ = script("bench/studies/intrinsic", "--out", tmp_path, "--only", "spall", "--set", "mesh.cells=[1, 1, 10]", "--set",
                     "time.end=0.2e-6")
    assert told.count("(theory 0.1123), plateau ") == 3
    assert_pictures(tmp_path, told, "spall-history.png", "spall-snapshots.png")
    told, _ = script("bench/studies/intrinsic", "--out", tmp_path, "--only", "slopes", "speed", "--set", "mesh.cells=[1, 1, 4]",
                     "--set", "time.steps=60")
    assert told.count("by (3.10)") == 6 and told.count("formula (3.10)") == 5
    assert_pictures(tmp_path, told, "interface-stress.png", "wave-speed.png")


def test_mesh_study(tmp_path):
    """With a coarse mesh in place of the one that it would make."""
    made = launch("mesh", example("spall.yaml"), "-o", tmp_path / "uniform.h5", "--set", "mesh.cells=[2, 2, 20]")
    assert made.returncode == 0, made.stderr
    words = ["bench/studies/mesh-study", "--only", "uniform", "--out", tmp_path, "--end", "0.3e-6", "--safety", "0.5"]
    told, _ = script(*words, expect=1)  # too coarse for its limits
    assert "flat plane 5.44 uJ, waves meet at 0.2246 us" in told and told.count("  NO\n") >= 1
    assert_pictures(tmp_path, told, "energy.png", "cracks.png")
    told, complaint = script(*words, "--set",
                             "materials=[{name: b, where: 'z < 0', model: neo-hookean, young: 1e9, poisson: 0, density: 1e3}]",
                             expect=2)
    assert told == "" and complaint == ("mesh-study: 1-D theory of the spall test is for bodies of one material; "
                                        "this case has material, b\n")


def test_fragmentation(tmp_path):
    told, _ = script("bench/studies/fragmentation", "--out", tmp_path, "--rates", "1e5", "--seeds", 1, "--set", "mesh.cells=[1, 1, 20]")
    assert "Grady 0.605 mm, Glenn-Chudnovsky 0.496 mm" in told
    assert_pictures(tmp_path, told, "fragmentation.png")


def rows_of(told):
    """The cells of a table in Markdown, without its head."""
    return [[cell.strip() for cell in text.strip("|").split("|")] for text in told.splitlines()[2:]]


def test_endurance(tmp_path):
    told, _ = script("bench/studies/endurance", "--out", tmp_path, "--steps", 40, "--jobs", 2, "--set", "mesh.cells=[1, 1, 10]")
    rows = rows_of(told)
    assert len(rows) == 12 and rows[6][:2] == ["40 m/s", "0"]
    energy = rhegma.energy(tmp_path / "40-0-0")
    assert rows[6][2].endswith(f"{100 * np.abs(energy['error_rel']).max():.2g} %")
    assert rows[6][4].endswith(f"{1e6 * energy['broken_area'][-1]:.3f}") and energy["broken_area"][-1] > 0


@pytest.mark.skipif(not (BUILD / "rhegma-mesh").exists(), reason="built without Gmsh")
def test_meshes(tmp_path):
    told, _ = script("bench/studies/meshes", "part", "--out", tmp_path)
    (row,) = rows_of(told)
    assert 10_000 < int(row[2].replace(",", "")) < 25_000 and float(row[6]) > 1.5 and not list(tmp_path.iterdir())
    assert float(row[5]) / float(row[4]) == pytest.approx(float(row[6]), abs=0.01)


def test_mistakes_are_the_programs_own(tmp_path):
    _, complaint = script("bench/studies/fragmentation", "--out", tmp_path, "--rates", "1e5", "--seeds", 1, "--set", "mesh.jiter=1",
                          expect=2)
    assert complaint.startswith("fragmentation: ") and "mesh.jiter: unknown key; did you mean 'mesh.jitter'?" in complaint


def test_large(tmp_path):
    _, _ = script("bench/studies/large", "--out", tmp_path, "--quick", expect=1)  # so small a mesh takes too many bytes per tet
    assert rhegma.summary(tmp_path / "large")["elements"] == 12960


def test_large_tells_its_limits(tmp_path):
    told, _ = script("bench/studies/large", "--help")
    assert "--quick" in told


def test_checkpoint(tmp_path):
    told, _ = script("bench/studies/checkpoint", "--cells", "2,2,20", "--rounds", 1, "--ranks", 2, "--threads", 1, "--directory",
                     tmp_path)
    assert told.splitlines()[-1].startswith("480 elements, ") and not list(tmp_path.iterdir())


@benches
def test_scaling_as_a_job(tmp_path):
    """bench/scaling.slurm without Slurm: one layout of its list."""
    process = subprocess.run(["bash", ROOT / "bench/scaling.slurm", "--cells", "2,2,20", "--steps", "3", "--repeats", "1",
                              "--build", BUILD],
                             env={**os.environ, **ENVIRONMENT, "RHEGMA_ROOT": str(ROOT), "LAYOUTS": "1x1,1x2",
                                  "SLURM_ARRAY_TASK_ID": "1",
                                  "SLURM_ARRAY_JOB_ID": "7", "LAUNCHER": "mpirun --bind-to none -n {ranks}"},
                             capture_output=True, text=True, timeout=TIMEOUT, cwd=tmp_path)
    assert process.returncode == 0, process.stderr
    assert [path.name for path in (tmp_path / "scaling-7").iterdir()] == ["strong-480-1x2.json"]


@benches
def test_overlap(tmp_path):
    told, _ = script("perf/overlap", "--build", BUILD, "--cells", "2,2,20", "--rounds", 1, "--transport", "memory", "--json",
                     tmp_path / "r.json",
                     "--plot", tmp_path / "p.png")
    (record,) = json.loads((tmp_path / "r.json").read_text())["records"]
    assert record["tets"] == 480 and len(record["delays_s"]) == 9 and min(map(min, record["samples_s"])) > 0
    assert_pictures(tmp_path, told, "p.png")


@benches
def test_simulate_calibrates(tmp_path):
    told, _ = script("perf/simulate", "calibrate", "--build", BUILD, "--costs", tmp_path / "costs.json", "--quick", "--repeats",
                     1)
    costs = json.loads((tmp_path / "costs.json").read_text())
    assert [row["tets"] for row in costs["alone"]] == [1620, 3840] and [row["tets"] for row in costs["busy_checks"]] == [1080]
    assert all(row["first"] > 0 and row["second"] > 0 for row in costs["alone"] + costs["busy"]) and len(told.splitlines()) == 6


def test_pictures_of_records(tmp_path):
    results = ROOT / "perf/results"
    told, _ = script("perf/simulate", "plot", results / "2026-11-22-simulated.json", "--out", tmp_path / "s")
    assert_pictures(tmp_path, told, "s-thesis.png", "s-clusters.png")
    told, _ = script("perf/roofline", results / "2026-11-22-epyc-2core.json", "-o", tmp_path / "r.png")
    assert_pictures(tmp_path, told, "r.png")
    told, _ = script("bench/scaling", "plot", results, "--out", tmp_path / "c")
    assert_pictures(tmp_path, told, "c.png")
