"""The command line: what a user can get wrong, what the program then says, and what it leaves behind."""

import json
import os
import re
import shutil
import signal
import subprocess
import time

import pytest
import rhegma
import yaml
from conftest import CASES, ENVIRONMENT, PROGRAM, ROOT, TIMEOUT, example, launch, overrides

SPALL = example("spall.yaml")
FRAGMENTS = CASES / "fragments.yaml"
SHORT = {"time.steps": 40}
KEYS = """case elements interfaces dofs ranks threads steps time_end dt_first dt_last limiting_element wall_s
    us_per_tet_step energy_error_rel dissipated_J first_fracture_time_s broken_area_m2 halo_doubles_per_face
    bytes_per_tet state_hash revision""".split()


@pytest.fixture
def attempt(tmp_path):
    """A run of a case into tmp_path/out that is expected to fail; also what it said."""

    def go(case, sets=None, expect=2, **layout):
        out = tmp_path / "out"
        process = launch("run", case, "-q", "-o", out, *overrides(sets or {}), cwd=tmp_path, **layout)
        assert process.returncode == expect, process.stderr
        return out, process.stderr

    return go


# ---- Arguments ----


@pytest.mark.parametrize("arguments, message", [
    ([], "nothing to do"),
    (["frob", "a.yaml"], "unknown command: frob"),
    (["run"], "no case file given"),
    (["run", "a.yaml", "--frob"], "unknown option: --frob"),
    (["run", "a.yaml", "b.yaml"], "b.yaml"),
    (["run", "a.yaml", "--set"], "missing value after: --set"),
    (["run", "a.yaml", "-o"], "missing value after: -o"),
])
def test_wrong_arguments(tmp_path, arguments, message):
    process = launch(*arguments, cwd=tmp_path)
    assert process.returncode == 2
    assert message in process.stderr.splitlines()[0]
    assert "usage: rhegma" in process.stderr
    assert process.stdout == "" and list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", ["run", "check"])
def test_missing_case_file(tmp_path, command):
    process = launch(command, "nowhere.yaml", cwd=tmp_path)
    assert process.returncode == 2
    assert process.stderr == "nowhere.yaml: cannot be read: No such file or directory\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("ranks", [1, 2])
def test_case_from_a_pipe(run, tmp_path, ranks):
    """It can be read once, however many the ranks."""
    pipe = tmp_path / "fragments"
    os.mkfifo(pipe)
    with subprocess.Popen(["timeout", "60", "cp", FRAGMENTS, pipe]):
        process = launch("run", pipe, "-q", "-o", tmp_path / "out", *overrides(SHORT), ranks=ranks)
    assert process.returncode == 0, process.stderr
    assert summary_of(tmp_path / "out")["state_hash"] == run(FRAGMENTS, sets=SHORT).summary["state_hash"]


def test_file_too_large_for_a_case(tmp_path):
    large = tmp_path / "mesh.vtk"
    large.touch()
    os.truncate(large, 65 << 20)
    process = launch("run", large)
    assert process.returncode == 2 and process.stderr == f"{large}: cannot be read: File too large\n"


def test_version_is_that_of_the_summary(run):
    process = launch("--version")
    assert process.returncode == 0 and process.stderr == ""
    summary = run(FRAGMENTS, sets=SHORT).summary
    version = re.search(r"version: '(\S+)'", (ROOT / "meson.build").read_text())[1]
    assert process.stdout == f"rhegma {version} ({summary['revision']}), {summary['precision']} precision\n"


@pytest.mark.parametrize("words", [["--overwrite"], ["--restart", "out"], ["--walltime", "1:00:00"]])
def test_check_takes_no_options_of_run(words):
    process = launch("check", FRAGMENTS, *words)
    assert process.returncode == 2 and process.stdout == ""
    assert process.stderr.startswith("rhegma: --restart, --overwrite and --walltime are for run\nusage: rhegma check ")


def test_a_finished_run_is_not_replaced_in_silence(tmp_path):
    words = ["run", FRAGMENTS, "-q", "-o", tmp_path / "out", "--set", "time.steps=2"]
    said = [launch(*words, *more) for more in ([], [], ["--overwrite"])]
    assert [process.returncode for process in said] == [0, 0, 0]
    assert said[0].stderr == said[2].stderr == ""
    assert said[1].stderr == (f"rhegma: warning: {tmp_path / 'out'}: this run takes the place of one that had ended; "
                              "pictures there are still of that one\n")


HELP = {"": "run check export keys materials mesh verify --version --help",
        "run": "--set -o -q --quiet --restart --overwrite --walltime USR1 TERM mpirun OMP_NUM_THREADS RHEGMA_ISA",
        "check": "--set mpirun OMP_NUM_THREADS RHEGMA_ISA",
        "verify": "theory mpirun",
        "export": "-o --time --crack .vtu .vtp .stl",
        "keys": "PREFIX --markdown --schema yaml-language-server expressions",
        "materials": "NAME material.preset",
        "mesh": "-o --scale --unit --merge --apart --crack --extrude --split --size --curvature --improve --tile --info --case --partition --set"}


@pytest.mark.parametrize("arguments", [["--help"], ["-h"], ["run", "--help"], ["check", "a.yaml", "-h"], ["verify", "--help"],
                                       ["keys", "--help"], ["materials", "--help"], ["export", "--help"], ["mesh", "-h"]])
def test_help_names_every_option(arguments):
    """Of a command its own, in lines that fit a terminal of 110 columns."""
    process = launch(*arguments)
    command = "" if arguments[0].startswith("-") else arguments[0]
    assert process.returncode == 0 and process.stderr == ""
    assert process.stdout.startswith(f"usage: rhegma {command or 'run'}")
    for word in HELP[command].split():
        assert word in process.stdout
    for other in {"--walltime", "--improve", "--schema"} - set(HELP[command].split()):
        assert other not in process.stdout
    assert max(map(len, process.stdout.splitlines())) <= 110


# ---- Streams ----


def start(*arguments, **streams):
    return subprocess.Popen([str(PROGRAM), *map(str, arguments)], env={**os.environ, **ENVIRONMENT}, **streams)


def test_run_outlives_the_reader_of_its_output(run, tmp_path):
    process = start("run", FRAGMENTS, "-o", tmp_path / "out", *overrides(SHORT), stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE)
    process.stdout.close()
    said = process.stderr.read().decode()
    process.stderr.close()
    assert process.wait(TIMEOUT) == 0
    assert said == "rhegma: warning: standard output cannot be written: some of what was said is lost\n"
    assert summary_of(tmp_path / "out")["state_hash"] == run(FRAGMENTS, sets=SHORT).summary["state_hash"]


def test_closed_streams_are_not_taken_for_others(tmp_path):
    """Neither outputs nor MPI's sockets get their numbers, and with them the words of the run."""
    process = start("run", FRAGMENTS, "-o", tmp_path / "out", *overrides({"time.end": 1e-3}),
                    preexec_fn=lambda: os.closerange(0, 3))
    begin = time.monotonic()
    while not (tmp_path / "out" / "energy.csv").exists():
        assert process.poll() is None and time.monotonic() - begin < TIMEOUT
        time.sleep(0.01)
    found = [os.readlink(f"/proc/{process.pid}/fd/{number}") for number in range(3)]
    process.kill()
    process.wait()
    assert found == 3 * ["/dev/null"]


@pytest.mark.parametrize("words", [["check", FRAGMENTS], ["--version"]])
def test_an_answer_that_is_lost_is_a_failure(words):
    with open("/dev/full", "w") as full:
        assert start(*words, stdout=full, stderr=subprocess.DEVNULL).wait(TIMEOUT) == 1


def test_an_interrupt_ends_what_has_nothing_to_save():
    process = start("verify", stdout=subprocess.PIPE)
    process.stdout.readline()
    process.send_signal(signal.SIGINT)
    assert process.wait(TIMEOUT) == -signal.SIGINT
    process.stdout.close()


# ---- Bad cases ----

BAD = """\
mesh:
  cells: [2, 2]
  size: [1e-3, 1e-3, -1e-3]
material:
  model: neo-hookean
  yung: 260e9
  poisson: 0.5
  density: 3690
interface:
  law: none
  strength: 400e6
initial:
  velocity: {z: 1 +}
time:
  end: 1e-6
"""
PROBLEMS = [(2, "mesh.cells"), (3, "mesh.size[2]"), (5, "material.young"), (6, "material.yung"),
            (7, "material.poisson"), (11, "interface.strength"), (13, "initial.velocity.z")]


@pytest.mark.parametrize("command, ranks", [("run", 1), ("check", 1), ("run", 2)])
def test_every_problem_of_a_case_has_one_line(tmp_path, command, ranks):
    case = tmp_path / "bad.yaml"
    case.write_text(BAD)
    process = launch(command, case, "-o", tmp_path / "out", cwd=tmp_path, ranks=ranks)
    assert process.returncode == 2
    lines = [line for line in process.stderr.splitlines() if "bad.yaml" in line]
    places = [re.match(re.escape(str(case)) + r":(\d+):(\d+): ([\w.\[\]]+): ", line) for line in lines]
    assert all(places), lines
    assert [(int(place[1]), place[3]) for place in places] == PROBLEMS
    assert "did you mean 'material.young'?" in process.stderr
    assert sorted(tmp_path.iterdir()) == [case]


def test_problem_of_an_override_names_it(attempt):
    out, said = attempt(SPALL, {"time.safety": 2, "mesh.sells": 3})
    assert len(said.splitlines()) == 2
    assert said.count("--set") == 2 and "time.safety" in said and "mesh.sells" in said
    assert not out.exists()


def test_more_ranks_than_elements(attempt):
    out, said = attempt(FRAGMENTS, {"mesh.cells": [1, 1, 1], "mesh.jitter": 0}, ranks=7)
    assert "7 ranks are too many for a mesh of 6 elements" in said
    assert not out.exists()


# ---- check ----


def test_check_says_what_a_run_would_do(tmp_path):
    process = launch("check", SPALL, cwd=tmp_path, threads=2)
    assert process.returncode == 0 and process.stderr == ""
    said = {line[:14].strip(): line[14:].strip() for line in process.stdout.splitlines()}
    assert said["elements"] == "12960 (388800 degrees of freedom), 24408 interfaces"
    assert said["body"] == "0.0004 x 0.0004 x 0.004 m"
    assert said["material"] == "neo-hookean" and "plastic waves" not in said
    assert said["wave speeds"] == "dilatational 8906.0 m/s, shear 5395.9 m/s"
    assert re.match(r"[\d.e-]+ s = [\d.]+ of the critical [\d.e-]+ s, set by element \d+", said["time step"])
    assert re.match(r"\d+ to 4.4e-07 s", said["steps"])
    assert re.match(r"\d+ bytes per element, .* GB in all", said["memory"])
    assert "1 ranks x 2 threads" in said["time loop"]
    assert re.match(r"5.11e-05 m, 0.44 times the longest edge", said["cohesive zone"])
    assert "the cohesive zone is not resolved" in process.stdout
    assert list(tmp_path.iterdir()) == []


def test_check_does_not_warn_of_a_resolved_cohesive_zone(tmp_path):
    process = launch("check", SPALL, *overrides({"interface.energy": 340}), cwd=tmp_path)
    assert process.returncode == 0
    assert "4.4 times the longest edge" in process.stdout and "warning" not in process.stdout


def test_check_says_nothing_of_a_cohesive_zone_without_interfaces():
    process = launch("check", FRAGMENTS, *overrides({"interface.form": "continuous", "interface.faces": 0}))
    assert process.returncode == 0 and ", 0 interfaces" in process.stdout
    assert "cohesive zone" not in process.stdout


@pytest.mark.parametrize("sets, speed", [({"material.young": 260}, "0.282"), ({"material.density": 3.69}, "2.82e+05"),
                                         ({"material.young": 5e6}, None)])
def test_check_asks_for_the_units_of_impossible_waves(sets, speed):
    process = launch("check", FRAGMENTS, *overrides(sets))
    assert process.returncode == 0
    warned = re.findall(r"warning: no solid carries waves at (\S+) m/s", process.stdout)
    assert warned == ([] if speed is None else [speed])


@pytest.mark.parametrize("sets, bound", [({}, None), ({"time.safety": 0.92}, "0.91"), ({"interface.onset": 0.15}, "0.5"),
                                         ({"interface.beta": 2}, None), ({"interface.activation": "continuous"}, None)])
def test_check_warns_of_an_onset_too_stiff_for_the_step(sets, bound):
    process = launch("check", example("endurance.yaml"), *overrides(sets))
    assert process.returncode == 0
    assert ("no step of time.safety above" in process.stdout) == (bound is not None)
    assert bound is None or f"no step of time.safety above {bound} follows" in process.stdout


def test_run_takes_the_steps_that_check_announced(run):
    announced = launch("check", FRAGMENTS, *overrides({"time.end": 1e-7})).stdout
    summary = run(FRAGMENTS, sets={"time.end": 1e-7}).summary
    assert int(re.search(r"steps +(\d+)", announced)[1]) == summary["steps"]
    assert f"set by element {summary['limiting_element']} " in announced


# ---- Runs ----


def test_summary_has_every_key(run):
    summary = run(FRAGMENTS, ranks=2, sets=SHORT).summary
    assert set(KEYS) <= set(summary)
    assert summary["case"] == "fragments" and summary["status"] == "completed"
    assert (summary["ranks"], summary["threads"], summary["steps"]) == (2, 1, 40)
    assert summary["elements"] == 6 * 2 * 2 * 16 and summary["dofs"] == 30 * summary["elements"]
    assert summary["halo_doubles_per_face"] <= 33
    assert 0 < summary["dt_last"] <= summary["dt_first"] < 1e-8
    assert summary["time_end"] == pytest.approx(40 * summary["dt_first"], rel=1e-9)
    assert re.fullmatch("[0-9a-f]{16}", summary["state_hash"])


def test_unbroken_run_has_no_first_fracture_time(run):
    summary = run(FRAGMENTS, sets={"time.steps": 2}).summary
    assert summary["first_fracture_time_s"] is None and summary["broken_area_m2"] == 0


def test_quiet_run_says_nothing(run):
    short = run(FRAGMENTS, sets=SHORT)
    assert short.stdout == "" and short.stderr == ""


def test_run_shows_its_progress_and_result(tmp_path):
    process = launch("run", FRAGMENTS, "-o", tmp_path / "out", *overrides({**SHORT, "output.interval": 10}))
    assert process.returncode == 0
    head, *rows = re.findall(r"^ +(?:step|\d+) .* (?:left|s)$", process.stdout, re.MULTILINE)
    assert head.split()[0] == "step" and [int(row.split()[0]) for row in rows] == [0, 10, 20, 30, 40]
    assert max(map(len, [head, *rows])) < 80
    assert str(tmp_path / "out") in process.stdout.splitlines()[-1]


def test_output_goes_to_the_named_place(tmp_path):
    for words in (["-o", "a/b"], overrides({"output.dir": "c"})):
        assert launch("run", FRAGMENTS, "-q", *overrides(SHORT), *words, cwd=tmp_path).returncode == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a", "c"]
    left = {"case.yaml", "energy.csv", "fragments.csv", "fields", "fields.h5", "fields.xdmf", "summary.json"}
    assert {path.name for path in (tmp_path / "a/b").iterdir()} == left == {p.name for p in (tmp_path / "c").iterdir()}


def test_default_output_is_named_after_the_case(tmp_path):
    assert launch("run", FRAGMENTS, "-q", *overrides(SHORT), cwd=tmp_path).returncode == 0
    assert (tmp_path / "results" / "fragments" / "summary.json").exists()


@pytest.mark.parametrize("ranks", [1, 2])
def test_case_of_the_user_is_not_overwritten(tmp_path, ranks):
    """By the echo of the same name; that of an earlier run is, also where the run comes from it."""
    shutil.copy(FRAGMENTS, tmp_path / "case.yaml")
    process = launch("run", "case.yaml", "-q", "-o", ".", *overrides(SHORT), cwd=tmp_path, ranks=ranks)
    assert process.returncode == 2 and process.stderr.count("rhegma: ") == 1
    assert "./case.yaml: no run wrote it" in process.stderr
    assert (tmp_path / "case.yaml").read_text() == FRAGMENTS.read_text() and len(list(tmp_path.iterdir())) == 1
    for case in ("case.yaml", "out/case.yaml"):
        assert launch("run", case, "-q", "-o", "out", *overrides(SHORT), cwd=tmp_path, ranks=ranks).returncode == 0


def test_echo_of_a_case_gives_the_same_run(run, tmp_path):
    sets = {"time.end": 1e-7, "mesh.seed": 5, "interface.form": "incomplete", "output.interval": 7,
            "output.energy_limit": 0.5,
            "boundary": [{"set": "z+", "component": "x", "velocity": "t < 5e-8 ? 1e3*y : 0"}]}
    first = run(FRAGMENTS, sets=sets)
    again = run(first.dir / "case.yaml")
    assert first.summary["broken_area_m2"] > 0
    assert again.summary["state_hash"] == first.summary["state_hash"]
    assert (again.dir / "energy.csv").read_bytes() == (first.dir / "energy.csv").read_bytes()
    one, two = (yaml.safe_load((r.dir / "case.yaml").read_text()) for r in (first, again))
    del one["output"]["dir"], two["output"]["dir"]
    assert one == two


# ---- Runs that fail ----


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("place", ["file", "file/below"])
def test_unwritable_output(tmp_path, place, ranks):
    (tmp_path / "file").write_text("keep me")  # not even root can write below a file
    process = launch("run", FRAGMENTS, "-q", *overrides(SHORT), "-o", place, cwd=tmp_path, ranks=ranks)
    assert process.returncode == 1
    assert re.search(rf"^rhegma: .*{place}.*: cannot be (created|written): Not a directory$", process.stderr, re.M)
    assert (tmp_path / "file").read_text() == "keep me"


def summary_of(out):
    return rhegma.summary(out)


@pytest.mark.parametrize("ranks", [1, 2])
def test_energy_limit_stops_the_run(attempt, ranks):
    out, said = attempt(FRAGMENTS, {"output.energy_limit": 1e-9, "output.interval": 10}, expect=1, ranks=ranks)
    stop = r"^rhegma: stopped: (.*passed the limit 1e-09.* at step (\d+), time ([\d.e-]+) s; .*element \d+.*)$"
    message = re.search(stop, said, re.M)
    assert message
    summary = summary_of(out)
    assert summary["status"] == message[1]
    assert summary["steps"] == int(message[2]) and summary["time_end"] == pytest.approx(float(message[3]), rel=1e-5)
    assert summary["energy_error_rel"] > 1e-9


NOT_FINITE = r"^rhegma: stopped: (.*not finite \(%s.*\) at step (\d+), time .*: element \d+ at \(.*, (.*)\) m; .*)$"


def stops_as_not_finite(attempt, sets, ranks, why="or an element is inside out"):
    """Step, and height of the element, that the run names."""
    out, said = attempt(FRAGMENTS, {"output.interval": 10, **sets}, expect=1, ranks=ranks)
    message = re.search(NOT_FINITE % why, said, re.M)
    assert message, said
    assert summary_of(out)["status"] == message[1]
    assert json.loads((out / "autopsy.json").read_text())["reason"] in message[1]
    return int(message[2]), float(message[3])


@pytest.mark.parametrize("ranks", [1, 2])
def test_inverted_elements_stop_the_run(attempt, ranks):
    sets = {"initial": {"displacement": {"z": "z > 1.45e-3 ? -2*z : 0"}}}
    step, z = stops_as_not_finite(attempt, sets, ranks)
    assert step == 0 and z > 1.3e-3  # the last layers of cubes


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("interval", [1, 1000])
def test_blow_up_between_two_outputs_is_found(attempt, interval, ranks):
    """An end pulled faster than its elements can follow: inside out after a few steps."""
    sets = {"boundary": [{"set": "z+", "component": "z", "velocity": "t < 1e-8 ? 0 : -1e6"}],
            "output.interval": interval, "output.energy_limit": 1e300}
    step, z = stops_as_not_finite(attempt, sets, ranks)
    assert step > 1 and z > 1.3e-3


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("kind, value", [("velocity", "sqrt(1e-8 - t)"), ("displacement", "1e-9*log(1e-8 - t)")])
def test_expression_that_ceases_to_be_finite_stops_the_run(attempt, kind, value, ranks):
    sets = {"boundary": [{"set": "z+", "component": "z", kind: value}], "output.energy_limit": 1e300}
    step, _ = stops_as_not_finite(attempt, sets, ranks, re.escape(f"boundary[0].{kind}: {value} is not finite at "))
    assert step > 1


@pytest.mark.parametrize("ranks", [1, 2])
def test_body_whose_velocity_ceases_to_be_finite_stops_the_run(attempt, ranks):
    """Though it touches nothing, so that the solid does not feel it."""
    wall = {"name": "wall", "shape": "plane", "motion": "prescribed", "at": [0, 0, -1], "normal": [0, 0, 1],
            "velocity": {"x": "sqrt(1e-8 - t)"}}
    step, _ = stops_as_not_finite(attempt, {"bodies": [wall], "output.energy_limit": 1e300}, ranks,
                                  re.escape("bodies: velocity.x of wall: sqrt(1e-8 - t) is not finite at t = 1"))
    assert step > 1


NOWHERE_FINITE = {
    "initial.displacement.x: sqrt(z)*1e-9": {"initial": {"displacement": {"x": "sqrt(z)*1e-9"}}},
    "initial.velocity.y: 1/(x - x)": {"initial": {"velocity": {"y": "1/(x - x)"}}},
    "boundary[0].velocity: 1/t": {"boundary": [{"set": "z+", "component": "z", "velocity": "1/t"}]},
    "interface.sets[1].where: log(z)": {"interface.sets": [{"where": 0, "energy": 1}, {"where": "log(z)", "energy": 1}]},
    "interface.faces: z/0": {"interface.form": "continuous", "interface.faces": "z/0"},
    "output.region: z/0": {"output.region": "z/0", "output.fields": ["displacement"]},
    "bodies: velocity.z of wall: 1/t": {"bodies": [{"name": "wall", "shape": "plane", "motion": "prescribed", "at": [0, 0, -1],
                                                    "normal": [0, 0, 1], "velocity": {"z": "1/t"}}]},
}


@pytest.mark.parametrize("what", NOWHERE_FINITE)
def test_expression_that_is_not_finite_is_told_once(tmp_path, what):
    """By one of the ranks, in words that do not depend on their number."""
    said = []
    for ranks in (1, 3):
        sets = {"time.steps": 2, "output.fields": [], **NOWHERE_FINITE[what]}
        process = launch("run", FRAGMENTS, "-q", "-o", tmp_path / "out", *overrides(sets), ranks=ranks)
        assert process.returncode == 2
        said.append([line for line in process.stderr.splitlines() if line.startswith("rhegma: ")])
    assert said[0] == said[1] and len(said[0]) == 1
    assert f"{what} is not finite at " in said[0][0]


@pytest.mark.parametrize("ranks, io", [(1, "romio321"), (2, "romio321"), (1, "ompio")])
def test_paths_with_colons(run, tmp_path, ranks, io):
    """MPI-IO would take what stands before a colon for a kind of file system."""
    out = tmp_path / "2026-11-22T12:30:00"
    sets = {**SHORT, "checkpoint.steps": 30}
    process = launch("run", FRAGMENTS, "-q", "-o", out.name, *overrides(sets), ranks=ranks, cwd=tmp_path, OMPI_MCA_io=io)
    assert process.returncode == 0, process.stderr
    process = launch("run", "--restart", out, "-q", *overrides({"time.steps": 50}), ranks=ranks, OMPI_MCA_io=io)
    assert process.returncode == 0, process.stderr
    assert summary_of(out)["state_hash"] == run(FRAGMENTS, sets={"time.steps": 50}).summary["state_hash"]
    assert [path.name for path in tmp_path.iterdir()] == [out.name]


@pytest.mark.parametrize("ranks", [1, 2])
def test_long_paths(tmp_path, ranks):
    """What the system takes is taken, what it does not is refused once."""
    sets = {**SHORT, "checkpoint.steps": 20}
    fits, beyond = ["/".join(["d" * 250] * n) for n in (10, 17)]
    out = tmp_path / fits
    assert launch("run", FRAGMENTS, "-q", "-o", out, *overrides(sets), ranks=ranks).returncode == 0
    assert launch("run", "--restart", out, "-q", *overrides({"time.steps": 60}), ranks=ranks).returncode == 0
    assert rhegma.summary(out)["steps"] == 60
    process = launch("run", FRAGMENTS, "-q", "-o", beyond, *overrides(sets), ranks=ranks, cwd=tmp_path)
    assert process.returncode == 2 and process.stderr.count("rhegma: ") == 1
    assert f"{beyond}/energy.csv: the path is too long" in process.stderr
