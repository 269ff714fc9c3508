"""The planting of single faults: where each kind can be planted, what is left alone, and that a place is found again."""

import importlib.machinery
import importlib.util
import sys

import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "tests" / "mutation"))

from faults import KINDS, faults_of  # noqa: E402
from rooms import ROOMS, room_of, shares, touches  # noqa: E402


def changed(kind, line, path="a.c", before=""):
    """The line with each fault of a kind."""
    text = f"{before}\n{line}\n"
    return [fault.planted(text).split("\n")[1] for fault in faults_of(path, text)[kind]]


@pytest.mark.parametrize("kind, line, expected", [
    ("sign", "    a = b + c;", ["    a = b - c;"]),
    ("sign", "    a -= -b;", ["    a += -b;", "    a -= b;"]),
    ("factor", "    a = 0.5 * b;", ["    a = 1.0 * b;", "    a = 0.5 / b;"]),
    ("factor", "    a = 3 * b / c;", ["    a = 3 / b / c;", "    a = 3 * b * c;", "    a = 4 * b / c;"]),
    ("factor", "    a = b < 1e-6 * c;", ["    a = b < 1e-6 / c;"]),
    ("off by one", "    for (int i = 0; i < n; i++) {", ["    for (int i = 1; i < n; i++) {", "    for (int i = 0; i < n - 1; i++) {"]),
    ("off by one", "    a = b[i + 1];", ["    a = b[i];"]),
    ("exchanged index", "    a = b[i][j];", ["    a = b[j][i];", "    a = b[0][j];", "    a = b[i][0];"]),
    ("exchanged index", "    f(a, b);", ["    f(b, a);"]),
    ("exchanged index", "    a = strcmp(b, c) < 0;", ["    a = strcmp(c, b) < 0;"]),
    ("exchanged index", "    a = strcmp(b, c) == 0 && memcmp(d, e, n) != 0;", []),
    ("dropped term", "    a = b + c;", ["    a = b;", "    a = c;"]),
    ("dropped term", "    if (a && !b) {", ["    if (a && b) {", "    if (a) {"]),
    ("dropped line", "    a = b;", ["    ;"]),
    ("relaxed bound", "    a = fmin(b, c);", ["    a = fmax(b, c);"]),
    ("relaxed bound", "    if (a < 1e-9) {", ["    if (a < 1e-05) {", "    if (0 && (a < 1e-9)) {"]),
])
def test_kinds(kind, line, expected):
    assert changed(kind, line, before="{") == expected


def test_bounds_of_orders_change_nothing():
    for line in ("    return p->flags < q->flags ? -1 : 1;", "    return (p->row > q->row) - (p->row < q->row);"):
        assert changed("relaxed bound", line, before="int flags, row;") == []


def test_bounds_are_relaxed_between_whole_numbers_alone():
    assert changed("relaxed bound", "    a = i < n;", before="int i, n; double x;") == ["    a = i <= n;"]
    assert changed("relaxed bound", "    a = x < n;", before="int i, n; double x;") == []


def test_items_of_an_array_are_as_large():
    assert changed("exchanged index", "    memcpy(a[1], b, n * sizeof a[0]);") == ["    memcpy(a[0], b, n * sizeof a[0]);", "    memcpy(b, a[1], n * sizeof a[0]);"]


def test_whether_a_text_is_empty_is_asked_by_either_letter():
    assert changed("exchanged index", "    a = b[0] != '\\0';") == changed("exchanged index", "    if (b->c[0] == '\\0') {") == []
    assert changed("exchanged index", "    a = b[0] != 0 && c[1] != '\\0';") == ["    a = b[1] != 0 && c[1] != '\\0';", "    a = b[0] != 0 && c[0] != '\\0';"]


def test_whether_a_file_is_open_is_asked_in_either_way():
    text = "{\n    int n = 1;\n    int file = open(path, O_RDONLY);\n    a = file >= 0 && n >= 0;\n}\n"
    assert [f.line[f.begin - 2:f.begin] for f in faults_of("a.c", text)["relaxed bound"]] == ["n "]


@pytest.mark.parametrize("line", [
    "    /* a = b + 1; */", "    // a = b + 1;", '    f("a = b + 1");', "#define A (b + 1)", "    rg_free(a + 1);", "    int a;",
    "    double a[N + 1];", "    _Alignas(64) double a[2 * N];", "    static const char b[2 * N];", "    char c[N / 2][3] = {0};"])
def test_left_alone(line):
    faults = faults_of("a.c", f"{{\n{line}\n}}")
    assert not [f for kind in KINDS if kind not in ("dropped line", "exchanged index") for f in faults[kind]]


def test_what_a_block_has_to_spare_is_left_alone():
    line = "    a = RG_NEW(double, 3 * (size_t)f(n, 2 * m) + 1);"
    assert changed("off by one", line) == changed("sign", line) == [] and changed("factor", line) == [
        line.replace("3 *", "3 /"), line.replace("2 *", "2 /")]


def test_hints_are_left_alone():
    text = "RG_INLINE void prefetch_cracks(int n) {\n    if (n > 0) {\n        n = n + 1;\n    }\n}\n\nvoid f(int n) {\n    g(n + 1);\n"
    hints = "    prefetch_cracks(n + 1);\n    rg_h5_start_sync(f);\n}\n"
    faults = [fault for found in faults_of("a.c", text + hints).values() for fault in found]
    assert faults and {fault.line for fault in faults} == {"    g(n + 1);"}


def test_what_gives_back_goes_on_doing_so():
    text = "{\n    if (a != NULL) {\n        closedir(a);\n    }\n"
    assert not faults_of("a.c", text)["relaxed bound"]


def test_python_has_faults_outside_its_texts():
    text = 'def f(a):\n    """a + 1"""\n    return a + 1\n'
    faults = faults_of("bench/plot", text)
    assert [f.planted(text).split("\n")[2] for f in faults["sign"]] == ["    return a - 1"]


def test_texts_as_indices_stay_where_they_are():
    assert changed("exchanged index", 'a = b["c"][i]', path="bench/plot") == ['a = b["c"][0]']


def test_a_fault_is_found_again_in_a_file_that_has_moved():
    text = "{\n    a = b + c;\n    d = 1;\n    a = b + c;\n"
    second = faults_of("a.c", text)["sign"][1]
    assert second.planted("\n\n" + text) == "\n\n" + text[: text.rindex("+")] + "-" + text[text.rindex("+") + 1 :]
    assert second.planted("{\n    a = b + c;\n") is None


def test_every_room_has_files_and_tests():
    assert room_of("kernels/vec.h") == room_of("kernels/cohesive/linear.h") == "kernels" and room_of("src/mesh/import/inp_read.c") == "mesh/import"
    assert room_of("bench/plot") == "plot" and room_of("README.md") is None
    assert room_of("src/README.md") is room_of("kernels/cohesive/curves.png") is room_of("src/meson.build") is None
    for room, (_, tests) in ROOMS.items():
        for test in tests.split():
            file = test if test.endswith(".py") else f"test_{test}.c"
            assert any((ROOT / "tests").rglob(file)) or test.startswith("fuzz-"), test


def test_a_test_that_no_row_names_touches_all_of_src():
    assert touches("newcomer", "src/diagnostics/ledger.c") and not touches("newcomer", "kernels/vec.h")
    assert not touches("test_count.py", "src/diagnostics/ledger.c")
    assert touches("step_limiter", "src/solver/step_limiter.c") and not touches("step_limiter", "src/case/case.c")
    assert touches("test_plot.py", "bench/plot") and not touches("newcomer", "bench/plot")


class FakeBench:
    """A tree of one file, whose fault `a - c` one test notices; another one fails whatever the file holds."""

    def __init__(self, tree, words="", busy=False):
        self.tree, self.runs, self.words, self.busy = tree, [], words, busy

    def compiles(self):
        return True

    def tests_of(self, path):
        return ["broken", "sees"]

    def run(self, name, limit):
        self.runs.append(name)
        good = name == "sees" and not self.busy and "a + c" in (self.tree / "src/a.c").read_text()
        return good, 1.0, "" if good else self.words


def script():
    loader = importlib.machinery.SourceFileLoader("mutate", str(ROOT / "tests" / "mutate"))
    mutate = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutate", loader))
    loader.exec_module(mutate)
    return mutate


def planted(tmp_path, **of_bench):
    """What becomes of the fault in such a tree, tried twice; and the bench."""
    mutate = script()
    (tmp_path / "src").mkdir()
    (tmp_path / "src/a.c").write_text("{\n    b = a + c;\n}\n")
    campaign, bench = mutate.Campaign(tmp_path / "none", {}, {}), FakeBench(tmp_path, **of_bench)
    fault = faults_of("src/a.c", (tmp_path / "src/a.c").read_text())["sign"][0]
    results = [mutate.attempt(bench, campaign, "base", fault, 900) for _ in range(2)]
    assert "a + c" in (tmp_path / "src/a.c").read_text()
    return [(result["verdict"], result["by"]) for result in results], bench


def test_a_test_that_fails_without_a_fault_kills_none(tmp_path):
    results, bench = planted(tmp_path)
    assert results == 2 * [("killed", "sees")]
    assert bench.runs.count("broken") == 2 and bench.runs.count("sees") == 3


def test_a_test_that_takes_too_long_without_a_fault_kills_none(tmp_path):
    results, bench = planted(tmp_path, words="too long")
    assert results == 2 * [("killed", "sees")] and bench.runs.count("sees") == 5  # with the fault, and each time without it
    (tmp_path / "busy").mkdir()
    results, bench = planted(tmp_path / "busy", words="too long", busy=True)
    assert results == 2 * [("survived", "")]


def test_each_test_is_timed_once_and_one_that_fails_is_left_out(tmp_path, capsys):
    mutate, benches = script(), [FakeBench(tmp_path, words="no"), FakeBench(tmp_path, words="no")]
    (tmp_path / "src").mkdir()
    (tmp_path / "src/a.c").write_text("b = a + c;\n")
    for bench in benches:
        bench.programs, bench.files = {"known": "", "broken": ""}, {"sees": ""}
    (tmp_path / "times").write_text('{"known": 7}')
    campaign = mutate.Campaign(tmp_path / "none", {}, {})
    assert mutate.baseline(benches, campaign, tmp_path / "times") == {"broken"}
    assert campaign.times == {"known": 7, "sees": 1.0}
    assert sorted(benches[0].runs + benches[1].runs) == ["broken", "sees"]
    assert capsys.readouterr().out == "left out  broken: fails without a fault: no\n"


def test_shares_add_up():
    share = shares({"a": 1000, "b": 10, "c": 400}, 100)
    assert sum(share.values()) == 100 and share["b"] >= 8 and share["a"] > share["c"]
