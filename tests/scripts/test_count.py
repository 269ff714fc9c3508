"""The count of tests/run: whatever way a test dies, and whatever a step leaves behind, it is told from a test that passed.

The steps are those of tests/run: its own functions run a small Meson project and small files for pytest."""

import importlib.machinery
import importlib.util
import json
import os
import re
import shutil
import subprocess

import pytest
from conftest import ENVIRONMENT, ROOT, TIMEOUT

STEPS = re.findall(r"^(?:count|check|build_others|built|programs|runs)\(\) \{.*?^\}\n", (ROOT / "tests" / "run").read_text(), re.M | re.S)
LOADER = importlib.machinery.SourceFileLoader("count", str(ROOT / "tests" / "count"))
count = importlib.util.module_from_spec(importlib.util.spec_from_loader("count", LOADER))
LOADER.exec_module(count)


def shell(directory, script):
    """What tests/run does with this script as its steps, in a directory of its own."""
    if not (directory / "tests").exists():
        (directory / "tests").symlink_to(ROOT / "tests")
        (directory / "out").mkdir()
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
    return subprocess.run(["bash", "-uo", "pipefail", "-c", "root=$PWD; out=$root/out; workers=2\n" + "".join(STEPS) + script],
                          cwd=directory, env={**environment, **ENVIRONMENT}, capture_output=True, text=True, timeout=TIMEOUT)


def steps(directory):
    """Steps by name: {"passed": number, "failed": lines, "skipped": lines}."""
    lines = [json.loads(line) for line in (directory / "out" / "results").read_text().splitlines()]
    return {line.pop("step"): line for line in lines if "step" in line}


def assert_lines(lines, expected):
    """A line for each regular expression, in any order."""
    left = list(lines)
    for words in expected:
        found = [line for line in left if re.search(words, line)]
        assert found, f"nothing says {words!r} in {lines}"
        left.remove(found[0])
    assert left == []


# ---- Test programs ----

# Ends as its argument says.
PROGRAM = r"""
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void *volatile kept;
static const char *way = "";

static int is(const char *name) {
    return strcmp(way, name) == 0;
}

int main(int argc, char **argv) {
    way = argv[1];
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (is("silent")) return 0;
    if (is("fails")) return puts("it is wrong"), 1;
    if (is("cannot")) return puts("there is no such device"), 77;
    if (is("all skipped")) return puts("1..0 # SKIP no such device"), 0;
    if (is("plans nothing")) return puts("1..0"), 0;
    if (strstr(way, "without plan") == NULL) puts("1..3");
    puts("ok 1 - first");
    if (strstr(way, "aborts") != NULL) abort();
    if (is("is killed")) raise(SIGKILL);
    if (is("hangs")) pause();
    if (is("leaves early")) exit(0);
    if (is("bails out")) return puts("Bail out! no disk"), 1;
    if (is("skips")) puts("ok 2 - second # SKIP no device");
    else if (is("skips as cmocka does")) puts("# no debugger\nnot ok 2 # SKIP second");
    else if (is("fails second")) puts("not ok 2 - second");
    else puts("ok 2 - second");
    if (is("repeats")) puts("ok 2 - second");
    else if (!is("one less")) puts("ok 3 - third");
    if (is("one more")) puts("ok 4 - fourth");
    if (is("leaks")) kept = malloc(123), kept = NULL;
    if (is("uses after free")) kept = malloc(9), free(kept), *(char *)kept = 9;
    if (strstr(way, "overflows") != NULL) printf("# %d\n", 0x7ffffffe + argc);
    return is("exits with 1") || is("fails second");
}
"""

# On two ranks, by tests/unit/support/tap.h.
RANKS = r"""
#include <stdlib.h>
#include <string.h>
#include "support/tap.h"

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    report(1, "both", "first");
    if (rank == 1 && strcmp(argv[1], "half way") == 0) abort();
    report(rank == 0 || strcmp(argv[1], "disagree") != 0, "both", "second");
    int status = finish();
    if (rank == 1 && strcmp(argv[1], "at the end") == 0) abort();
    return status;
}
"""

# Program, its argument, how many passed, what is said of each failure and of each skip.
PROGRAMS = [
    ("tap", "good", 3, [], []),
    ("tap", "skips", 2, [], ["second: no device$"]),
    ("tap", "skips as cmocka does", 2, [], ["second: no debugger$"]),
    ("tap", "all skipped", 0, [], ["no such device$"]),
    ("tap", "fails second", 2, ["second: not ok$"], []),
    ("tap", "aborts", 1, ["killed by SIGABRT; 1 results of 3 planned$"], []),
    ("tap", "aborts without plan", 1, ["killed by SIGABRT; no plan, 1 results$"], []),
    ("tap", "is killed", 1, ["killed by SIGKILL; 1 results of 3 planned$"], []),
    ("tap", "hangs", 1, [r"timeout after 1\.\d s; 1 results of 3 planned$"], []),
    ("tap", "leaves early", 1, [": 1 results of 3 planned$"], []),
    ("tap", "bails out", 1, ["exit status 1; Bail out! no disk; 1 results of 3 planned$"], []),
    ("tap", "one less", 2, [": 2 results of 3 planned$"], []),
    ("tap", "one more", 4, [": 4 results of 3 planned$"], []),
    ("tap", "repeats", 3, [": result 2 in place of 3$"], []),
    ("tap", "without plan", 3, [": no plan, 3 results$"], []),
    ("tap", "plans nothing", 0, [": nothing planned$"], []),
    ("tap", "silent", 0, [": no plan, 0 results$"], []),
    ("tap", "exits with 1", 3, [": exit status 1$"], []),
    ("address", "good", 3, [], []),
    ("address", "uses after free", 3, ["exit status 1; .*ERROR: AddressSanitizer: heap-use-after-free"], []),
    ("address", "leaks", 3, ["exit status 1; .*ERROR: LeakSanitizer"], []),
    ("undefined", "good", 3, [], []),
    ("undefined", "overflows", 3, ["exit status 1; .*runtime error: signed integer overflow"], []),
    ("undefined", "overflows and goes on", 3, [": [^;]*runtime error: signed integer overflow"], []),
    ("plain", "good", 1, [], []),
    ("plain", "fails", 0, [": exit status 1$"], []),
    ("plain", "aborts", 0, [": killed by SIGABRT$"], []),
    ("plain", "hangs", 0, [r": timeout after 1\.\d s$"], []),
    ("plain", "cannot", 0, [], [": there is no such device$"]),
    ("ranks", "good", 2, [], []),
    ("ranks", "disagree", 1, ["both: second: not ok$"], []),
    ("ranks", "half way", 1, ["killed by SIGABRT; no plan, 1 results$"], []),
    ("ranks", "at the end", 2, ["killed by SIGABRT$"], []),
]

EXECUTABLES = {
    "tap": "'program.c'",
    "plain": "'program.c'",
    "address": "'program.c', c_args: '-fsanitize=address', link_args: '-fsanitize=address'",
    "undefined": "'program.c', c_args: '-fsanitize=undefined', link_args: '-fsanitize=undefined'",
    "ranks": "'ranks.c', include_directories: include_directories('tests/unit'), dependencies: dependency('mpi', language: 'c')",
}


def meson_file(pairs):
    lines = ["project('dying', 'c', default_options: 'c_std=gnu17')", "mpirun = find_program('mpirun')"]
    lines += [f"{name} = executable('{name}', {EXECUTABLES[name]})" for name in dict(pairs)]
    for name, way in pairs:
        ranks = f"mpirun, args: ['--bind-to', 'none', '-n', '2', ranks, '{way}']"
        command, protocol = ranks if name == "ranks" else f"{name}, args: '{way}'", "exitcode" if name == "plain" else "tap"
        halt = int(way != "overflows and goes on")
        lines.append(f"test('{name} {way}', {command}, protocol: '{protocol}', timeout: {1 if way == 'hangs' else 60}, "
                     f"env: ['ASAN_OPTIONS=detect_leaks=1', 'UBSAN_OPTIONS=halt_on_error={halt}'])")
    return "\n".join(lines) + "\n"


def build_programs(directory, pairs):
    directory.mkdir()
    (directory / "program.c").write_text(PROGRAM)
    (directory / "ranks.c").write_text(RANKS)
    (directory / "meson.build").write_text(meson_file(pairs))
    built = shell(directory, "PATH=/usr/bin:$PATH; meson setup build && ninja -C build")
    assert built.returncode == 0, built.stdout
    return directory


@pytest.fixture(scope="module")
def programs(tmp_path_factory):
    """A directory in which all have run."""
    directory = build_programs(tmp_path_factory.mktemp("count") / "programs", [row[:2] for row in PROGRAMS])
    shell(directory, "count start; programs build")
    return directory


@pytest.mark.parametrize("program, way, passed, failed, skipped", PROGRAMS, ids=[f"{row[0]} {row[1]}" for row in PROGRAMS])
def test_a_program(programs, program, way, passed, failed, skipped):
    name, step = f"{program} {way}", count.Step("alone")
    records = [json.loads(line) for line in (programs / "build" / "meson-logs" / "testlog.json").read_text().splitlines()]
    [record] = [record for record in records if record["name"] == name]
    count.judge_program(step, name, "exitcode" if program == "plain" else "tap", record)
    assert_lines(step.failed, failed)
    assert_lines(step.skipped, skipped)
    assert step.passed == passed
    assert all(line.startswith(name + ": ") for line in step.failed + step.skipped)


def test_all_programs(programs):
    step = steps(programs)["build"]
    assert step["passed"] == sum(row[2] for row in PROGRAMS)
    assert_lines(step["failed"], [words for row in PROGRAMS for words in row[3]])
    assert_lines(step["skipped"], [words for row in PROGRAMS for words in row[4]])
    end = shell(programs, "/usr/bin/python3 tests/count out/results total")
    lines = end.stdout.splitlines()
    assert end.returncode == 1
    assert lines[-1] == f"{step['passed']} passed, {len(step['failed'])} failed, {len(step['skipped'])} skipped"
    assert lines[:-1] == ([f"SKIPPED build: {line}" for line in step["skipped"]]
                          + [f"FAILED  build: {line}" for line in step["failed"]])


@pytest.fixture(scope="module")
def two(tmp_path_factory):
    directory = build_programs(tmp_path_factory.mktemp("count") / "two", [("tap", "good"), ("plain", "good")])
    assert shell(directory, "count start; programs build").returncode == 0
    return directory


def test_good_programs_pass(two):
    assert steps(two)["build"] == {"passed": 4, "failed": [], "skipped": []}
    end = shell(two, "/usr/bin/python3 tests/count out/results total")
    assert (end.returncode, end.stdout) == (0, "4 passed, 0 failed\n")


@pytest.mark.parametrize("change, status, passed, said", [
    (":", 0, 4, None),
    (":", 3, 4, "^meson test: exit status 3$"),
    ("sed -i '/plain good/d' build/meson-logs/testlog.json", 0, 3, "^plain good: ran 0 times$"),
    ("truncate -s -9 build/meson-logs/testlog.json", 0, 0, "^programs: JSONDecodeError"),
    ("rm build/meson-logs/testlog.json", 1, 0, "^programs: FileNotFoundError: .*testlog.json'; exit status 1$"),
    ("touch -d 2001-01-01 build/meson-logs/testlog.json", 0, 0, "^programs: .*testlog.json is older than the start"),
    ("rm build/meson-info/intro-tests.json", 0, 0, "^programs: FileNotFoundError: .*intro-tests.json"),
    ("echo '[]' >build/meson-info/intro-tests.json; : >build/meson-logs/testlog.json", 0, 0, "^meson test: no programs$"),
])
def test_what_meson_leaves(two, tmp_path, change, status, passed, said):
    for name in ("meson-info", "meson-logs"):
        shutil.copytree(two / "build" / name, tmp_path / "build" / name)
    shell(tmp_path, f"count start; touch build/*/*; {change}; count programs build {status} build")
    assert_lines(steps(tmp_path)["build"]["failed"], [said] if said else [])
    assert steps(tmp_path)["build"]["passed"] == passed


@pytest.mark.parametrize("lost, said", [
    ("build", "^programs: FileNotFoundError: .*; exit status 1$"),
    ("build/plain", "^programs: .*testlog.json is older than the start of the tests; exit status 1$"),
])
def test_what_was_not_built(two, lost, said):
    shell(two, f"mv {lost} away; count start; programs build; mv away {lost}")
    assert_lines(steps(two)["build"]["failed"], [said])
    assert steps(two)["build"]["passed"] == 0


# ---- Checks ----


def test_checks(tmp_path):
    shell(tmp_path, "count start; check good true; check bad eval 'echo why; false'; check dies bash -c 'kill -SEGV $$'; "
                    "check none no-such-command")
    assert {name: (step["passed"], step["failed"]) for name, step in steps(tmp_path).items()} == {
        "good": (1, []), "bad": (0, ["check: exit status 1"]), "dies": (0, ["check: killed by SIGSEGV"]),
        "none": (0, ["check: exit status 127"])}


def test_builds_behind_the_tests(tmp_path):
    """Each counts once it is waited for; the last of them ends all that were to come."""
    build = "build() { case $1 in bad) echo why; false ;; dies) kill -KILL $BASHPID ;; esac; }; "
    shell(tmp_path, build + "touch out/good.status; count start; build_others good bad dies after; "
                            "built good; built bad; built dies; built after")
    assert {name: (step["passed"], step["failed"]) for name, step in steps(tmp_path).items()} == {
        "good": (1, []), "bad": (0, ["check: exit status 1"]), "dies": (0, ["check: exit status 1"]),
        "after": (0, ["check: exit status 1"])}


@pytest.mark.parametrize("script", ["", "count start;", "count start; touch out/outcomes; "
                                                        "count runs one 0 out/outcomes; "])
def test_nothing_is_not_all(tmp_path, script):
    end = shell(tmp_path, script + "/usr/bin/python3 tests/count out/results total")
    assert end.returncode == 1
    assert "FAILED  nothing passed\n" in end.stdout
    assert re.fullmatch(r"0 passed, [12] failed", end.stdout.splitlines()[-1])


def test_a_count_that_cannot_be_written_ends_all(tmp_path):
    end = shell(tmp_path, "count start; rm -r out; check good true; echo went on")
    assert (end.returncode, end.stdout.splitlines()[-1]) == (1, "0 passed, 1 failed")


# ---- Tests in Python ----

SKIPS = """
import pytest
pytestmark = pytest.mark.filterwarnings("ignore")
def test_skips(): pytest.skip("no device")
@pytest.mark.skipif(True, reason="no mark")
def test_marked(): assert False
@pytest.mark.xfail(reason="known")
def test_known(): assert False
def test_passes(): pass
"""
FAILS = """
import pytest
@pytest.fixture
def broken():
    yield
    raise RuntimeError("torn down")
def test_fails(): assert 1 == 2, "they differ"
def test_error(broken): pass
def test_missing(nothing): pass
def test_passes(): pass
"""
CRASHES = "import os\ndef test_first(): pass\ndef test_crashes(): os.abort()\ndef test_after(): pass\n"
DIES_LATE = "import os\ndef pytest_sessionfinish(session):\n    if hasattr(session.config, 'workerinput'): os._exit(0)\n"
GOOD = "def test_one(): pass\ndef test_two(): pass\n"
HANGS = "import time\ndef test_one(): pass\ndef test_hangs(): time.sleep(600)\n"

# Files, how many passed, what is said of each failure and of each skip.
FILES = {
    "good": ({"test_a.py": GOOD, "test_b.py": GOOD}, 4, [], []),
    "skips": ({"test_a.py": SKIPS, "test_b.py": "import pytest\npytest.importorskip('no_such_module')\n"}, 1, [],
              ["a.py::test_skips: no device$", "a.py::test_marked: no mark$", "a.py::test_known: expected to fail: known$",
               "b.py: could not import 'no_such_module'"]),
    "fails": ({"test_a.py": FAILS, "test_b.py": "import no_such_module\n", "test_c.py": GOOD}, 3,
              ["a.py::test_fails: call: AssertionError: they differ$", "a.py::test_error: teardown: RuntimeError: torn down$",
               "a.py::test_missing: setup: .*fixture 'nothing' not found", "b.py: collection: .*no_such_module"], []),
    "crashes": ({"test_a.py": CRASHES}, 1,
                ["a.py::test_crashes: .*: worker 'gw.' crashed while running", "a.py::test_after: did not run$"], []),
    "dies late": ({"test_a.py": GOOD, "conftest.py": DIES_LATE}, 2, ["worker gw.: Not properly terminated$"] * 2, []),
    "cannot start": ({"test_a.py": GOOD, "conftest.py": "import no_such_module\n"}, 0, ["outcomes'?; exit status 4"], []),
    "nothing": ({"test_a.py": ""}, 0, ["pytest: no tests$"], []),
}


@pytest.mark.parametrize("name", FILES)
def test_files(tmp_path, name):
    texts, passed, failed, skipped = FILES[name]
    for file, text in texts.items():
        (tmp_path / "files").mkdir(exist_ok=True)
        (tmp_path / "files" / file).write_text(text)
    said = shell(tmp_path, "count start; runs build/rhegma files files").stdout
    step = steps(tmp_path)["files"]
    assert_lines(step["failed"], failed)
    assert_lines(step["skipped"], skipped)
    assert step["passed"] == passed, said


def test_a_file_that_hangs(tmp_path):
    (tmp_path / "test_a.py").write_text(HANGS)
    shell(tmp_path, "RUNS_LIMIT=5; count start; runs x files test_a.py")
    assert re.search("^pytest: .*timed out$", "\n".join(steps(tmp_path)["files"]["failed"]), re.M)


@pytest.mark.parametrize("events, status, failed", [
    (["collected", "setup", "call", "teardown", "end"], 0, []),
    (["collected", "setup", "call", "teardown", "end"], 1, ["pytest: exit status 1$"]),
    (["collected", "setup", "call", "teardown", "end"], -11, ["pytest: killed by SIGSEGV$"]),
    (["collected", "setup", "call", "teardown"], 0, ["pytest: did not end$"]),
    (["collected", "setup", "call", "end"], 0, ["one: did not end$"]),
    (["collected", "setup", "end"], 0, ["one: did not end$"]),
    (["collected", "end"], 0, ["one: did not run$"]),
])
def test_what_pytest_leaves(tmp_path, events, status, failed):
    known = {"collected": {"collected": ["one"]}, "end": {"end": 0}}
    lines = [known.get(event, {"test": "one", "phase": event, "outcome": "passed", "reason": ""}) for event in events]
    (tmp_path / "outcomes").write_text("".join(json.dumps(line) + "\n" for line in lines))
    step = count.Step("runs")
    count.judge_runs(step, status, tmp_path / "outcomes", 0)
    assert_lines(step.failed, failed)
    assert step.passed == ("teardown" in events)
