"""Records and pictures of bench/scaling and of perf/: what is asked of the program, what is made of its clocks, what is
drawn, against records made by hand and the stored ones."""

import json
import math
import statistics
import subprocess
import sys
import types

import numpy as np
import pytest
import synthetic_run as synthetic
from conftest import ROOT
from pictures import assert_panels_apart, assert_readable, labels, legend, line, script, style, texts, title

import launch
from drawing import plt

RESULTS = ROOT / "perf/results"


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def start(module, monkeypatch, *words):
    monkeypatch.setattr("sys.argv", ["script", *map(str, words)])
    return module.main()


def saved(module, monkeypatch):
    figures = {}
    monkeypatch.setitem(module.__dict__, "save", lambda figure, path: figures.update({path: figure}))
    return figures


# ---- bench/scaling: records ----

scaling = script("bench/scaling")
PHASES = {name: [k + 1.0, k + 2.0, k + 3.0] for k, name in enumerate(("compute", "jump", "pack", "exchange", "wait", "reduce"))}


def summary(**values):
    return {"steps": 9, "wall_s": 300.0, "output_s": 100.0, "setup_s": 7.0, "phases_s": PHASES, "exchange_alone_s": 2.0,
            "elements": 600,
            "ranks": 2, "threads": 1, "imbalance": 1.1, "cut_faces": 12, "instruction_set": "x", "precision": "double",
            "revision": "r",
            "state_hash": "h", "neighbours": [1, 1, 1], "messages_per_step": [2, 2, 2], "bytes_per_step": [3, 3, 3],
            "bytes_per_message": [1.5] * 3, "inner_share": [0.5] * 3, **values}


def test_layouts():
    assert scaling.layout("4x12") == (4, 12)
    for text in ("4", "x2", "0x2", "2x0", "2x2x2", "-1x2"):
        with pytest.raises(launch.BadInput, match=f"layout {text}: RANKSxTHREADS is needed, for one 4x2"):
            scaling.layout(text)


def test_meshes_of_a_study():
    for tets in (6000, 50_000, 224_100):
        x, y, z = scaling.bar(tets)
        assert x == y and z == pytest.approx(10 * x, rel=0.2) and 6 * x * y * z == pytest.approx(tets, rel=0.02)
    assert scaling.bar(1) == [2, 2, 1] and scaling.bar(6000) == [5, 5, 40] and scaling.bar(48_000) == [9, 9, 99]
    args = types.SimpleNamespace(weak=None, mesh=None, cells="3,4,5")
    assert scaling.mesh_of(args, 4) == {"mesh.cells": [3, 4, 5]}
    args.mesh = "relative.h5"
    assert scaling.mesh_of(args, 4) == {"mesh": {"file": str(launch.pathlib.Path("relative.h5").resolve())}}
    args.weak = 1500
    assert scaling.mesh_of(args, 4) == {"mesh.cells": scaling.bar(6000)}


def test_sample_of_a_run():
    """Nine steps, and the forces of the last state besides: ten passes."""
    sample = scaling.sample(summary())
    assert sample == {"step_s": 20.0, "exchange_alone_s": 2.0, "output_s": 100.0, "setup_s": 7.0,
                      "phases_s": {name: [x / 10 for x in values] for name, values in PHASES.items()}}


@pytest.mark.parametrize("wait, alone, share",
                         [(0.5, 2.0, 0.75), (3.0, 2.0, 0), (-1.0, 2.0, 1), (0.5, 0.0, None), (0.5, -1.0, None)])
def test_hidden_share(wait, alone, share):
    assert scaling.hidden({"exchange_alone_s": alone, "phases_s": {"wait": [wait, 7, 9]}}) == share


def fake_runs(monkeypatch, summaries):
    calls, left = [], iter(summaries)

    def run(case, out, sets, overrides, **keywords):
        calls.append((case, sets, overrides, keywords))
        (out / "summary.json").write_text(json.dumps(next(left)))
        return types.SimpleNamespace(stdout="rank 0: 2 threads on processors 0-1 of host\nother\n")

    monkeypatch.setattr(launch, "run", run)
    return calls


def test_scaling_run(tmp_path, monkeypatch, capsys):
    calls = fake_runs(monkeypatch,
                      [summary(), summary(wall_s=200.0, exchange_alone_s=1.0), summary(wall_s=800.0, exchange_alone_s=0.0)] +
                      [summary(ranks=1, threads=2, exchange_alone_s=0.0)] * 3)
    start(scaling, monkeypatch, "run", "--out", tmp_path / "r", "--layouts", "2x1,1x2", "--cells", "3,4,5", "--steps", 9,
          "--set", "a=1",
          "--build", "/b", "--launcher", "go -n {ranks} -c {threads} 'a b'")
    assert len(calls) == 6
    case, sets, overrides, keywords = calls[3]
    assert case == ROOT / "bench/examples/spall/spall.yaml" and overrides == ["a=1"]
    assert sets == {"mesh.cells": [3, 4, 5], "time.steps": 9, "output.interval": 9}
    assert keywords == {"build": "/b", "quiet": False, "launcher": ["go", "-n", "1", "-c", "2", "a b"], "OMP_NUM_THREADS": "2",
                        "OMP_PLACES": "cores", "OMP_PROC_BIND": "close"}
    record = json.loads((tmp_path / "r/strong-600-2x1.json").read_text())
    assert [repeat["step_s"] for repeat in record["repeats"]] == [20, 10, 70]
    assert record["hidden_share"] == (0.75 + 0.5) / 2  # waits of 0.5 s a pass for exchanges of 2 and of 1 s
    assert record["affinity"] == ["rank 0: 2 threads on processors 0-1 of host"]
    for key, value in {"program": "bench/scaling", "kind": "strong", "case": "bench/examples/spall/spall.yaml", "steps": 9, "cores": 2,
                       "launcher": "go -n {ranks} -c {threads} 'a b'"}.items():
        assert record[key] == value
    made = summary()
    for key in ("elements", "ranks", "threads", "imbalance", "cut_faces", "instruction_set", "precision", "revision", "setup_s",
                "state_hash",
                "neighbours", "messages_per_step", "bytes_per_step", "bytes_per_message", "inner_share"):
        assert record[key] == made[key]
    other = json.loads((tmp_path / "r/strong-600-1x2.json").read_text())
    assert "hidden_share" not in other and other["cores"] == 2
    said = capsys.readouterr().out.splitlines()
    assert said[0] == ("2x1: 600 tets, step 20000.000 ms (10000.000 to 70000.000): compute 200.000, jump 300.000, "
                       "pack 400.000, exchange 500.000, wait 600.000, reduce 700.000, 62 % of the exchanges hidden")
    assert said[1].startswith("1x2: 600 tets, step 20000.000 ms (20000.000 to 20000.000)") and "hidden" not in said[1]


def test_scaling_runs_one_layout_of_a_job_array(tmp_path, monkeypatch):
    calls = fake_runs(monkeypatch, [summary()] * 3)
    start(scaling, monkeypatch, "run", "--out", tmp_path, "--layouts", "1x1,2x3", "--index", 1, "--repeats", 1, "--weak", 100)
    assert len(calls) == 1 and calls[0][1]["mesh.cells"] == scaling.bar(600)
    assert calls[0][3]["launcher"] == "mpirun -n 2 --map-by slot:PE=3 --bind-to core".split()
    assert (tmp_path / "weak-600-2x3.json").exists()
    for index in (2, -1):
        with pytest.raises(launch.BadInput, match=f"--index {index}: there are layouts 0 to 1"):
            start(scaling, monkeypatch, "run", "--out", tmp_path, "--layouts", "1x1,2x3", "--index", index)
    start(scaling, monkeypatch, "run", "--out", tmp_path, "--layouts", "1x1,2x3", "--index", 0, "--repeats", 1)
    assert calls[1][3]["OMP_NUM_THREADS"] == "1"


# ---- bench/scaling: pictures ----


def record(kind, ranks, threads, steps, elements=1000, **values):
    repeats = [{"step_s": step, "phases_s": {name: [0, step * share, 0] for name, share in
                                             zip(("compute", "jump", "pack", "exchange", "wait", "reduce"),
                                                 (0.4, 0.3, 0.05, 0.04, 0.03, 0.02))}}
               for step in steps]
    return {"kind": kind, "ranks": ranks, "threads": threads, "cores": ranks * threads, "elements": elements,
            "repeats": repeats, **values}


RECORDS = [record("strong", 2, 1, [0.6, 0.5, 0.9], hidden_share=0.756), record("strong", 1, 1, [1.2, 1.0, 0.9]),
           record("strong", 1, 4, [0.4]),
           record("strong", 2, 2, [0.3], hidden_share=0.5), record("weak", 1, 1, [1.0], 500),
           record("weak", 2, 1, [1.25], 1000)]


RECORDS[2]["repeats"][0]["phases_s"]["compute"][1] /= 2


def test_scaling_draws_times_and_efficiency():
    figure = scaling.draw(RECORDS)
    times, efficiency, _ = figure.axes
    one, two = "strong, 1 thread a rank", "strong, 2 threads a rank"
    assert labels(times) == [one, two, "strong, 4 threads a rank", "weak, 1 thread a rank", "ideal"] == legend(times)
    assert np.array(line(times, one)).T.tolist() == [[1, 1.0], [2, 0.6]]
    assert np.array(line(times, two)).T.tolist() == [[4, 0.3]]
    assert np.array(line(times, "weak, 1 thread a rank")).T.tolist() == [[1, 1.0], [2, 1.25]]
    cores, ideal = line(times, "ideal")
    assert cores.tolist() == [1, 2, 4, 4] and ideal == pytest.approx([1, 0.5, 0.25, 0.25])
    assert labels(efficiency) == labels(times)[:-1] == legend(efficiency)
    assert line(efficiency, one)[1] == pytest.approx([1, 1 / 1.2]) and line(efficiency, two)[1] == pytest.approx([1 / 1.2])
    assert line(efficiency, "strong, 4 threads a rank")[1] == pytest.approx([1 / 1.6])
    assert line(efficiency, "weak, 1 thread a rank")[1] == pytest.approx([1, 0.8])  # of 500 tets on one core: 2 ms a tet
    for axes, name, scale in ((times, "time per step (s)", "log"), (efficiency, "efficiency", "linear")):
        assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_xscale(), axes.get_yscale()) == ("cores", name, "log", scale)
        assert axes.get_xticks().tolist() == [1, 2, 4] and [t.get_text() for t in axes.get_xticklabels()] == ["1", "2", "4"]
        assert not len(axes.get_xticks(minor=True))
        assert all(style(axes, label)[1:] in (("-", "o"), (":", "None")) for label in labels(axes))
    assert efficiency.get_ylim() == (0, 1.1)
    assert texts(figure)[0] == "measured" and figure.get_size_inches() == pytest.approx((14, 4.2))
    assert_readable(figure)
    assert_panels_apart(figure)


def test_scaling_draws_where_the_time_goes():
    axes = scaling.draw(RECORDS).axes[2]
    assert [text.get_text() for text in axes.get_xticklabels()] == ["strong\n1x1", "strong\n2x1", "strong\n2x2", "strong\n1x4",
                                                                    "weak\n1x1", "weak\n2x1"]
    names = ("compute", "jump", "pack", "exchange", "wait", "reduce", "rest")
    heights = np.array([(0.4, 0.3, 0.05, 0.04, 0.03, 0.02, 0.16)] * 6)
    heights[3] = (0.2, 0.3, 0.05, 0.04, 0.03, 0.02, 0.36)  # of 1x4
    assert tuple(legend(axes)) == names and len(axes.containers) == 7
    for part, bars in enumerate(axes.containers):
        assert len(bars) == 6
        for k, bar in enumerate(bars):
            assert bar.get_x() + bar.get_width() / 2 == pytest.approx(k)
            assert (bar.get_y(), bar.get_height()) == pytest.approx((heights[k, :part].sum(), heights[k, part]))
    assert [(text.get_position()[0], text.get_text()) for text in axes.texts] == [(1, "76 %"), (2, "50 %")]
    assert all(text.get_position()[1] > 1 for text in axes.texts)
    assert axes.get_ylabel() == "share of the step (above: exchanges hidden)" and axes.get_ylim() == (0, 1.12)


def test_shares_that_overlap_leave_no_rest():
    busy = record("strong", 1, 1, [1.0])
    busy["repeats"][0]["phases_s"]["compute"][1] = 0.9
    assert scaling.shares(busy)["rest"] == 0 and scaling.shares(busy)["compute"] == 0.9


def test_scaling_draws_weak_records_alone():
    assert labels(scaling.draw(RECORDS[4:]).axes[0]) == ["weak, 1 thread a rank"]


def test_scaling_prints_its_records(capsys):
    scaling.print_table(RECORDS)
    assert capsys.readouterr().out.splitlines()[2:] == [
        "| strong, 1x1 | 1,000 | 1000.0 | 1.00 |  |", "| strong, 2x1 | 1,000 | 600.0 | 0.83 | 76 % |",
        "| strong, 1x4 | 1,000 | 400.0 | 0.62 |  |", "| strong, 2x2 | 1,000 | 300.0 | 0.83 | 50 % |",
        "| weak, 1x1 | 500 | 1000.0 | 1.00 |  |", "| weak, 2x1 | 1,000 | 1250.0 | 0.80 |  |"]


def test_scaling_plot_reads_records(tmp_path, monkeypatch):
    import drawing

    figures = {}
    monkeypatch.setattr(drawing, "save", lambda figure, path: figures.update({path: figure}))
    start(scaling, monkeypatch, "plot", RESULTS, "--out", tmp_path / "p")
    (figure,) = figures.values()
    assert list(figures) == [tmp_path / "p.png"]
    strong = json.loads((RESULTS / "2026-11-22-epyc-2core-strong-224100-1x1.json").read_text())
    assert line(figure.axes[0], "strong, 1 thread a rank")[1][0] == statistics.median(r["step_s"] for r in strong["repeats"])
    with pytest.raises(launch.BadInput, match=f"no records in {tmp_path}"):
        start(scaling, monkeypatch, "plot", tmp_path, "--out", tmp_path / "p")


# ---- perf/overlap ----

overlap = script("perf/overlap")


def test_overlap_asks_for_turns_of_delays(monkeypatch, tmp_path):
    calls = []

    def run(case, out, sets, **keywords):
        calls.append((case, sets, keywords))
        launch.pathlib.Path(out, "summary.json").write_text("{}")
        launch.pathlib.Path(out, "log").write_text("0 0.3\n1e-3 0.6\n")

    monkeypatch.setattr(launch, "run", run)
    args = types.SimpleNamespace(build=tmp_path, cells="1,2,3")
    told, turns = overlap.run(args, "tcp-unpolled", [0, 1e-3], 20)
    assert told == {} and np.array(turns) == pytest.approx(np.array([(0, 0.1), (1e-3, 0.2)]))
    ((case, sets, keywords),) = calls
    assert case == ROOT / "bench/examples/spall/spall.yaml"
    assert sets == {"mesh.cells": [1, 2, 3], "time.steps": 60, "output.interval": 1000000, "output.fields": []}
    assert keywords["build"] == tmp_path and keywords["launcher"] == ["mpirun", "-n", 2, "--bind-to", "core", "env",
                                                                       f"LD_PRELOAD={tmp_path / 'libmpi_delay.so'}"]
    assert keywords["RHEGMA_DELAY_US"] == "0.0,1000.0" and keywords["RHEGMA_DELAY_STARTS"] == "6"
    assert keywords["OMPI_MCA_btl"] == "self,tcp" and keywords["RHEGMA_NO_POLL"] == "1" and keywords["OMP_NUM_THREADS"] == "1"


def test_sweeps_inside():
    phases = {"compute": [0, 5, 9], "jump": [0, 3, 9], "wait": [0, 2, 9]}
    assert overlap.inside({"phases_s": phases, "inner_share": [0.1, 0.8, 0.9]}) == pytest.approx([0.4, 0.24])


@pytest.mark.parametrize("delay, step", [(0, 10), (2, 10), (3.5, 10.5), (6, 14)])
def test_expected_step(delay, step):
    assert overlap.expected(10, [3, 5], delay) == pytest.approx(step)


def test_overlap_measures(monkeypatch):
    """Turns before the measured ones belong to the set-up; the fastest of them all tells the sweeps."""
    asked = []
    told = {"phases_s": {"compute": [0, 5, 9], "jump": [0, 3, 9], "wait": [0, 2, 9]}, "inner_share": [0, 0.8, 1],
            "elements": 600,
            "exchange_alone_s": 0.02}

    def run(args, transport, delays, turns):
        asked.append((transport, delays, turns))
        if len(delays) == 1:
            return told, [(0, 0.1)] * 10 + [(0, 2.0)] * 30 + [(0, 1.0)] + [(0, 3.0)] * 18 + [(0, 0.1)]
        return told, [(delay, 0.001 * k) for k in range(turns // len(delays)) for delay in delays]

    monkeypatch.setitem(overlap.__dict__, "run", run)
    found = overlap.measure(types.SimpleNamespace(rounds=2), "memory")
    assert asked[0] == ("memory", [0], 60)
    delays = [0.4 * f for f in (0, 0.125, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 2)]
    assert asked[1] == ("memory", pytest.approx(delays), 27)
    assert found["delays_s"] == pytest.approx(delays) and found["samples_s"] == [[0.001, 0.002]] * 9
    assert found["sweeps_inside_s"] == pytest.approx([0.4, 0.24]) and (found["tets"], found["exchange_alone_s"]) == (600, 0.02)


OVERLAP = {"transport": "memory", "tets": 6000, "delays_s": [0, 1e-3, 4e-3],
           "samples_s": [[0.012, 0.010, 0.02], [0.011, 0.013, 0.012], [0.015] * 3],
           "sweeps_inside_s": [3e-3, 2e-3], "exchange_alone_s": 1.5e-4}


def test_overlap_picture():
    figure = overlap.draw([OVERLAP, {**OVERLAP, "transport": "tcp"}])
    for axes, transport in zip(figure.axes, ("memory", "tcp")):
        model = "t(0) + what exceeds the sweeps inside"
        assert labels(axes) == [model, "measured, fastest turn", "median turn", "first sweep inside", "second sweep inside"]
        for label, values in ((model, [10, 10, 10 + 1 + 2]), ("measured, fastest turn", [10, 11, 15]),
                              ("median turn", [12, 12, 15])):
            delay, step = line(axes, label)
            assert delay == pytest.approx([0, 1, 4]) and step == pytest.approx(values)
        assert line(axes, "first sweep inside")[0] == pytest.approx([3, 3])
        assert line(axes, "second sweep inside")[0] == pytest.approx([2, 2])
        assert len({style(axes, label) for label in labels(axes)}) == 5
        assert axes.get_xlabel() == "delay of each exchange (ms)" and axes.get_ylim()[0] == 0
        assert title(axes) == f"{transport}, 2 ranks, 6,000 tets"
    assert [axes.get_ylabel() for axes in figure.axes] == ["time per step (ms)", ""]
    assert legend(figure.axes[0]) == labels(figure.axes[0])
    assert figure.get_size_inches() == pytest.approx((1 + 2 * 4.2, 3.8))
    assert_readable(figure)
    assert_panels_apart(figure)


def test_overlap_tells_and_writes(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(overlap.__dict__, "measure", lambda args, transport: {**OVERLAP, "transport": transport})
    figures = saved(overlap, monkeypatch)
    start(overlap, monkeypatch, "--json", tmp_path / "r.json", "--plot", tmp_path / "p.png")
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "memory: exchanges with nothing to hide them 150 us a step; sweeps inside 3.00, 2.00 ms"
    assert said[4].startswith("tcp: ")
    assert said[3] == "  delay   4.000 ms   step  15.000 ms, expected  13.000 (median 15.000)"
    stored = json.loads((tmp_path / "r.json").read_text())
    assert [r["transport"] for r in stored["records"]] == ["memory", "tcp"] and stored["program"] == "perf/overlap"
    assert list(figures) == [tmp_path / "p.png"]
    start(overlap, monkeypatch, "--transport", "tcp-unpolled")
    assert capsys.readouterr().out.startswith("tcp-unpolled: ") and len(figures) == 1


# ---- perf/roofline ----

roofline = script("perf/roofline")
PEAKS = [{"threads": t, "set": isa, "gflops": 10.0 * t * f} for t in (1, 2) for isa, f in (("v3", 1), ("v4", 2.5))]
TRIADS = [{"threads": t, "level": level, "gbytes_with_write_allocate": 4.0 * t * f}
          for t in (1, 2) for level, f in (("cache", 5), ("memory", 1))]


def row(kernel, level, flops, rate, isa="v4", threads=2, tets=13_000.0):
    return {"kernel": kernel, "set": isa, "level": level, "tets": tets, "threads": threads, "flops_per_tet": flops,
            "actual_bytes_per_tet": 100.0,
            "gflops": rate}


ROOFLINE = {"peak": PEAKS, "triad": TRIADS, "machine": {"cpu": "a processor"}, "ranks": 1, "revision": "abc",
            "rows": [row("bulk", "cache", 200.0, 30.0), row("step", "memory", 50.0, 3.0, tets=224_100.0),
                     row("bulk", "memory", 200.0, 6.0),
                     row("copy", "cache", 0.0, 0.0), row("bulk", "cache", 200.0, 9.0, isa="v3"),
                     row("bulk", "cache", 300.0, 7.0, threads=1)]}


def test_roofline_chooses():
    isa, threads, peaks, triads, rows = roofline.choose(ROOFLINE, None, None)
    assert (isa, threads) == ("v4", 2) and [r["kernel"] for r in rows] == ["bulk", "step", "bulk"]
    assert [p["gflops"] for p in peaks] == [20, 50] and [t["gbytes_with_write_allocate"] for t in triads] == [40, 8]
    assert [r["gflops"] for r in roofline.choose(ROOFLINE, "v3", None)[4]] == [9]
    assert [r["gflops"] for r in roofline.choose(ROOFLINE, None, 1)[4]] == [7]
    with pytest.raises(launch.BadInput, match="nothing was measured with 3 threads"):
        roofline.choose(ROOFLINE, None, 3)
    with pytest.raises(launch.BadInput, match="no kernel of v3 was measured with 1 threads"):
        roofline.choose(ROOFLINE, "v3", 1)


def test_roofline_picture():
    (axes,) = roofline.draw(ROOFLINE).axes
    peaks = {one.get_ydata()[0]: one.get_linestyle() for one in axes.get_lines() if len(one.get_xdata()) == 2}
    assert peaks == {20: "--", 50: "-"}
    assert labels(axes) == ["triad, cache: 40 GB/s", "triad, memory: 8 GB/s"] == legend(axes)
    for label, rate in zip(labels(axes), (40, 8)):
        x, y = line(axes, label)
        assert y == pytest.approx(np.minimum(50, rate * x)) and x[0] < 0.5 and x[-1] == pytest.approx(8)
    points = {(float(one.get_xdata()[0]), float(one.get_ydata()[0])): one.get_markerfacecolor() for one in axes.get_lines()
              if one.get_marker() == "o"}
    assert points == {(2.0, 30.0): "none", (0.5, 3.0): "C3", (2.0, 6.0): "C3"}  # open from the cache
    numbered = {tuple(text.xy): text.get_text() for text in axes.texts if text.get_text().isdigit()}
    assert numbered == {(2.0, 30.0): "1", (0.5, 3.0): "2", (2.0, 6.0): "1"}
    words = [text.get_text() for text in axes.texts]
    assert "1  bulk\n2  step, 224100 tets" in words
    at = {text.get_text(): text.xy for text in axes.texts if "GF/s" in text.get_text()}
    assert at == {"v3: 20 GF/s": (pytest.approx(8), 20), "v4: 50 GF/s": (pytest.approx(8), 50)}
    assert (axes.get_xscale(), axes.get_yscale(), axes.get_xlabel(), axes.get_ylabel()) == (
        "log", "log", "intensity (flop per byte of traffic, cost model)", "Gflop/s (cost model / median time)")
    assert title(axes) == "a processor, 1 ranks x 2 threads, v4, abc"
    names = next(text for text in axes.texts if text.get_text().startswith("1  bulk"))
    axes.figure.canvas.draw()
    room = names.get_window_extent()
    assert axes.get_window_extent().x1 < room.x0 and room.x1 < axes.figure.bbox.width  # beside the panel


def test_roofline_of_a_stored_record(tmp_path, monkeypatch):
    figures = saved(roofline, monkeypatch)
    stored = RESULTS / "2026-11-22-epyc-2core.json"
    start(roofline, monkeypatch, stored, "-o", tmp_path / "r.png", "--set", "x86-64-v3", "--threads", 1)
    start(roofline, monkeypatch, stored)
    assert list(figures) == [tmp_path / "r.png", stored.with_suffix(".png")]
    assert "x 1 threads, x86-64-v3," in title(figures[tmp_path / "r.png"].axes[0])
    figure = figures[tmp_path / "r.png"]
    rows = [r for r in json.loads(stored.read_text())["rows"] if r["threads"] == 1 and r["set"] == "x86-64-v3"
            and r["flops_per_tet"] > 0]
    marks = [one for one in figure.axes[0].get_lines() if one.get_marker() == "o"]
    intensities = [float(one.get_xdata()[0]) for one in marks]
    assert intensities == pytest.approx([r["flops_per_tet"] / r["actual_bytes_per_tet"] for r in rows])
    assert_panels_apart(figure)


def test_roofline_of_something_else(tmp_path, monkeypatch):
    (tmp_path / "r.json").write_text("{}")
    with pytest.raises(launch.BadInput, match="r.json: not a record of rhegma-bench: no 'rows'"):
        start(roofline, monkeypatch, tmp_path / "r.json")


# ---- perf/compare ----

compare = script("perf/compare")


def bench_record(samples, **values):
    return {"rows": [{"kernel": f"k{k}", "set": "v4", "level": "cache", "tets": 100, "ranks": 1, "threads": 1,
                      "samples_us_per_tet": s}
                     for k, s in enumerate(samples)], "revision": "r", "date": "d", "compiler": "c", "flags": "f",
            "precision": "double",
            "quick": False, "machine": {"cpu": "m"}, **values}


def compared(tmp_path, capsys, old, new):
    for name, one in (("old", old), ("new", new)):
        (tmp_path / name).write_text(json.dumps(one))
    status = compare.main([str(tmp_path / "old"), str(tmp_path / "new")])
    return status, capsys.readouterr().out.splitlines()


def test_compare_ratio_and_spread():
    """Medians 2 and 3; quartiles half a unit off them: 0.25 and 1/6 of the medians."""
    assert compare.spread([1, 1.5, 2, 2.5, 3]) == pytest.approx(0.25) and compare.spread([7]) == 0
    ratio, width = compare.compare([1, 1.5, 2, 2.5, 3], [2, 2.5, 3, 3.5, 4])
    assert ratio == pytest.approx(1.5) and width == pytest.approx(1.5 * math.hypot(0.25, 1 / 6))


def test_compare(tmp_path, capsys):
    old = bench_record([[1.0, 1.0, 1.0], [1.0] * 3, [1.0], [1.0, 1.0, 1.0], [1.0, 1.0]])
    new = bench_record([[1.06] * 3, [1.04] * 3, [2.0], [1.0, 1.2, 1.4]], flags="g", machine={"cpu": "n"})
    status, said = compared(tmp_path, capsys, old, new)
    assert status == 1 and said[0] == "r (d) -> r (d)" and said[1:3] == ["differs: flags: f -> g", "differs: machine: m -> n"]
    rows = said[4:8]
    assert [row.endswith("SLOWER") for row in rows] == [True, False, False, True]
    assert rows[0].split()[:9] == ["k0", "v4", "cache", "100", "1", "1", "1.0000", "1.0600", "1.060"]
    assert said[8] == "4 rows compared, 2 slower, 1 only in the old record, 0 only in the new one"
    status, said = compared(tmp_path, capsys, old,
                            bench_record([[1.0] * 3, [0.9] * 3, [5.0], [1.0, 1.2, 2.0], [1.0] * 2, [1.0]]))
    assert status == 0 and said[-1] == "5 rows compared, 0 slower, 0 only in the old record, 1 only in the new one"


def test_compare_of_what_cannot_be(tmp_path, capsys):
    other = bench_record([[1.0]])
    other["rows"][0]["kernel"] = "other"
    assert compared(tmp_path, capsys, bench_record([[1.0]]), other)[0] == 2
    (tmp_path / "old").write_text("{}")
    with pytest.raises(SystemExit) as ended:
        compare.main([str(tmp_path / "old"), str(tmp_path / "new")])
    assert ended.value.code == 2 and "old: not a record of rhegma-bench" in capsys.readouterr().err
    assert compare.main([]) == 2 and compare.main(["-h"]) == 0


def test_compare_of_a_stored_record():
    path = RESULTS / "2026-11-22-epyc-2core.json"
    process = subprocess.run([sys.executable, ROOT / "perf/compare", path, path], capture_output=True, text=True)
    assert process.returncode == 0 and " 0 slower, 0 only in the old record, 0 only in the new one" in process.stdout


# ---- perf/simulate and its pictures ----

sys.path.insert(0, str(ROOT / "perf"))
simulate = script("perf/simulate")
SIMULATED = json.loads((RESULTS / "2026-11-22-simulated.json").read_text())


def test_measurement_of_the_sweeps(monkeypatch):
    """Eleven passes of 600 tets on two ranks."""
    asked = []

    def run(case, out, sets, **keywords):
        asked.append((case, sets, keywords))
        launch.pathlib.Path(out, "summary.json").write_text(json.dumps({**summary(cut_faces=30), "wall_s": 130.0,
                                                                        "output_s": 20.0}))

    monkeypatch.setattr(launch, "run", run)
    found = simulate.measure(types.SimpleNamespace(build="/b"), (5, 5, 4), 2)
    passes, tets = 151, 300
    assert found == {"tets": tets, "first": pytest.approx(2 / passes / tets), "second": pytest.approx(3 / passes / tets),
                     "pack_s": pytest.approx(4 / passes), "exchange_s": pytest.approx(5 / passes), "faces": 30,
                     "rest_s": pytest.approx((110 - 2 - 3 - 4 - 5 - 6 - 7) / passes), "step_s": pytest.approx(110 / passes)}
    ((case, sets, keywords),) = asked
    assert sets == {"mesh.cells": (5, 5, 4), "time.steps": 150, "output.interval": 1000000, "output.fields": []}
    assert keywords == {"build": "/b", "launcher": ["mpirun", "-n", 2, "--bind-to", "core"], "OMP_NUM_THREADS": "1"}
    for cells, steps in (((32, 32, 32), 12), ((13, 13, 130), 18)):
        simulate.measure(types.SimpleNamespace(build="/b"), cells, 1)
        assert asked[-1][1]["time.steps"] == steps


def test_calibration_keeps_the_fastest(tmp_path, monkeypatch, capsys):
    clock = iter(range(100))
    monkeypatch.setitem(simulate.__dict__, "measure", lambda args, cells, ranks: {
        "tets": math.prod(cells), "first": 1e-7, "second": 1e-7, "pack_s": 0, "exchange_s": 0, "faces": 0, "rest_s": 0,
        "step_s": 50 + (next(clock) * 7) % 13})
    path = tmp_path / "costs.json"
    start(simulate, monkeypatch, "calibrate", "--costs", path, "--quick", "--repeats", 3)
    costs = json.loads(path.read_text())
    for name in ("alone", "busy"):
        assert [row["cells"] for row in costs[name]] == [list(c) for c in simulate.QUICK[0]]
    assert [row["cells"] for row in costs["alone_checks"]] == [list(c) for c in simulate.QUICK[1]]
    values = [50 + (k * 7) % 13 for k in range(18)]
    assert [row["step_s"] for row in costs["alone"] + costs["alone_checks"]] == [min(values[k:9:3]) for k in range(3)]
    assert [row["step_s"] for row in costs["busy"] + costs["busy_checks"]] == [min(values[9 + k::3]) for k in range(3)]
    costs["alone"][0]["step_s"] = 1.0  # an earlier, faster one
    path.write_text(json.dumps(costs))
    start(simulate, monkeypatch, "calibrate", "--costs", path, "--quick", "--repeats", 1)
    assert json.loads(path.read_text())["alone"][0]["step_s"] == 1.0
    assert len(capsys.readouterr().out.splitlines()) == 12


def test_costs_between_the_sizes_measured():
    """Linear in the logarithm of the size; packing by the faces of both exchanges."""
    rows = [{"tets": 100.0, "first": 2.0, "second": 1.0, "rest_s": 0.1, "faces": 10, "pack_s": 4.0},
            {"tets": 10_000.0, "first": 4.0, "second": 5.0, "rest_s": 0.3, "faces": 30, "pack_s": 4.0}]
    costs = {"busy": rows[::-1], "alone": [{**r, "first": 7.0, "faces": 0} for r in rows]}
    found = simulate.costs_for(costs, "busy", 1000)
    assert (found.first, found.second, found.rest, found.pack) == pytest.approx((3, 3, 0.2, 8 / 80))
    assert simulate.costs_for(costs, "busy", 1).first == 2 and simulate.costs_for(costs, "alone", 1000).first == 7


def test_layouts_of_studies():
    assert simulate.tets((2, 3, 4)) == 144 and simulate.threads_of("weak, 16 threads") == 16
    assert simulate.threads_of("weak") == 1
    assert simulate.network_of("weak", "tree").ranks_per_node == 16
    assert simulate.network_of("weak, 16 threads", "tree").ranks_per_node == 1


def points(study, network):
    return sorted((p for p in SIMULATED["points"] if (p["study"], p["network"]) == (study, network)), key=lambda p: p["cores"])


def assert_study(axes, study, network, label, value):
    rows = points(study, network)
    cores, values = line(axes, f"{label}, model")
    assert cores.tolist() == [p["cores"] for p in rows]
    assert values == pytest.approx([value(p, p["model"]["step_s"]) for p in rows])
    rows = [p for p in rows if "simulated_s" in p]
    cores, values = line(axes, f"{label}, simulated")
    assert cores.tolist() == [p["cores"] for p in rows] and values == pytest.approx([value(p, p["simulated_s"]) for p in rows])
    assert style(axes, f"{label}, simulated")[1:] == ("None", "o") and style(axes, f"{label}, model")[1:] == ("-", "None")
    assert style(axes, f"{label}, simulated")[0] == style(axes, f"{label}, model")[0]
    return style(axes, f"{label}, model")[0]


NETWORKS = {"tree": "100 Gb/s fat tree", "ethernet": "10 Gb/s Ethernet"}


def test_pictures_of_simulated_clusters(tmp_path, monkeypatch):
    import drawing

    figures = {}
    monkeypatch.setattr(drawing, "save", lambda figure, path: figures.update({path: figure}))
    start(simulate, monkeypatch, "plot", RESULTS / "2026-11-22-simulated.json", "--out", tmp_path / "p")
    assert list(figures) == [tmp_path / "p-thesis.png", tmp_path / "p-clusters.png"]
    (thesis,) = figures[tmp_path / "p-thesis.png"].axes
    assert np.array(line(thesis, "thesis, linear from there")).T == pytest.approx(np.array([[16, 1.8], [48, 0.6]]))
    assert np.array(line(thesis, "thesis, Fig. 5-18, read off")).T.tolist() == [[16, 1.8]]
    measured = [c for c in SIMULATED["checks"] if c["tets"] == 202_500]
    assert np.array(line(thesis, "measured, 202,500 tets")).T.tolist() == [[c["ranks"], c["measured_s"]] for c in measured]
    colours = {assert_study(thesis, "thesis mesh", network, label, lambda p, s: s) for network, label in NETWORKS.items()}
    assert len(colours) == 2
    assert (thesis.get_xscale(), thesis.get_yscale()) == ("log", "log")
    assert (thesis.get_xlabel(), thesis.get_ylabel()) == ("cores", "time per step (s)")
    assert title(thesis) == "224,100 tets (thesis: 223,394)"
    strong, weak = figures[tmp_path / "p-clusters.png"].axes
    for axes, studies, least, heading in (
            (strong, {"strong, 1 million": "1 million", "strong, 10 million": "10 million",
                      "strong, 10 million, 16 threads": "10 million, 16 threads"},
             0.8, "strong scaling"),
            (weak, {"weak": "1 thread", "weak, 16 threads": "16 threads"}, 0.95, "weak scaling, 50,000 tets a core")):
        colours = [assert_study(axes, study, network, f"{name}, {label}", lambda p, s: p["ideal_s"] / s)
                   for study, name in studies.items() for network, label in NETWORKS.items()]
        assert len(set(colours)) == len(colours) and len(labels(axes)) == 2 * len(colours)
        (bound,) = [one for one in axes.get_lines() if one.get_label().startswith("_")]
        assert bound.get_ydata() == [least, least]
        assert (axes.get_xscale(), axes.get_xlabel(), axes.get_ylim()) == ("log", "cores", (0, 1.05))
        assert axes.get_ylabel() == "sweeps / time of the step"
        assert title(axes) == heading and legend(axes) == labels(axes)
    for figure, panels in zip(figures.values(), (1, 2)):
        assert figure.get_size_inches() == pytest.approx((5.6 * panels, 4.4))
        assert_readable(figure)
        assert_panels_apart(figure)


# ---- bench/studies/large, bench/studies/checkpoint, bench/studies/efficiency ----


def test_large_reckons_per_tet(tmp_path, monkeypatch):
    large, asked = script("bench/studies/large"), []

    def run(case, out, sets, **keywords):
        asked.append((case, out, sets, keywords))
        for rank, size in enumerate((3e5, 5e5)):
            (tmp_path / "memory" / str(rank)).write_text(str(int(size)))
        out.mkdir()
        (out / "summary.json").write_text(json.dumps({"elements": 400, "setup_s": 0.02, "us_per_tet_step": 0.7}))

    monkeypatch.setattr(launch, "run", run)
    (tmp_path / "memory").mkdir()
    (tmp_path / "memory/7").write_text("900000")  # of an earlier run
    assert large.measure(tmp_path / "small.h5", tmp_path, 25, 2) == {"tets": 400, "memory": 2000, "setup": pytest.approx(50),
                                                                     "step": 0.7}
    ((case, out, sets, keywords),) = asked
    assert out == tmp_path / "small" and case == ROOT / "bench/examples/spall/spall.yaml"
    assert sets == {"mesh": {"file": str(tmp_path / "small.h5")}, "time.steps": 25, "output.fields": [],
                    "output.interval": 1000000}
    assert keywords["launcher"][:3] == ["mpirun", "--bind-to", "core"]
    assert keywords["launcher"][-2:] == ["--rank", tmp_path / "memory"]
    little = {"tets": 400, "memory": 1900, "setup": 70, "step": 0.5}
    big = {"tets": 8000, "memory": 1500, "setup": 50, "step": 0.56}
    assert large.findings(little, big) == [("bytes per tet at peak, all ranks", 1500, 1800),
                                           ("set-up, s per million tets", 50, 60),
                                           ("time per tet and step, large over small", pytest.approx(1.12), 1.1)]
    lines = [text.split() for text in large.table(little, big, [0.5, 0.4, 0.6])]
    assert lines[1:] == [["400", "1,900", "70.0", "0.500"], ["8,000", "1,500", "50.0", "0.560"],
                         "small mesh: 3 runs from 0.400 to 0.600".split()]


def test_large_takes_the_median_of_the_small_mesh(tmp_path, monkeypatch, capsys):
    large, order = script("bench/studies/large"), []
    steps = {"small": iter([0.5, 0.7, 0.4, 0.3, 0.9, 0.6]), "large": iter([0.6])}

    def measure(mesh, out, count, ranks):
        order.append((mesh.stem, count, ranks))
        return {"tets": 100, "memory": 1000, "setup": 1, "step": next(steps[mesh.stem])}

    monkeypatch.setitem(large.__dict__, "measure", measure)
    made = []
    monkeypatch.setitem(large.__dict__, "make", lambda cells, path: (made.append((cells, path)), path.write_text("")))
    assert start(large, monkeypatch, "--out", tmp_path, "--ranks", 4) == 0
    assert order == [("small", 250, 4)] * 3 + [("large", 50, 4)] + [("small", 250, 4)] * 3
    assert made == [([15, 15, 164], tmp_path / "small.h5"), ([44, 44, 440], tmp_path / "large.h5")]
    assert not list(tmp_path.glob("*.h5")) and f"{0.6 / 0.55:10.4g}  at most 1.1    yes" in capsys.readouterr().out
    steps["small"], steps["large"] = iter([0.5] * 2), iter([0.5])
    order.clear(), made.clear()
    assert start(large, monkeypatch, "--out", tmp_path, "--quick") == 0
    assert order == [("small", 25, 2), ("large", 5, 2), ("small", 25, 2)]
    assert [cells for cells, _ in made] == [[4, 4, 40], [6, 6, 60]]
    steps["small"], steps["large"] = iter([0.5] * 6), iter([0.6])
    assert start(large, monkeypatch, "--out", tmp_path) == 1 and capsys.readouterr().out.count("NO") == 1


def test_large_makes_a_mesh_once(tmp_path, monkeypatch):
    large, asked = script("bench/studies/large"), []
    monkeypatch.setattr(launch, "call", lambda words: asked.append(words))
    large.make([1, 2, 3], tmp_path / "m.h5")
    assert asked == [[launch.program(), "mesh", ROOT / "bench/examples/spall/spall.yaml", "-o", tmp_path / "m.h5", "--set",
                      "mesh.cells=[1, 2, 3]"]]
    (tmp_path / "m.h5").write_text("")
    large.make([1, 2, 3], tmp_path / "m.h5")
    assert len(asked) == 1


def test_checkpoint_takes_medians_and_rates(tmp_path, monkeypatch, capsys):
    script_, times = script("bench/studies/checkpoint"), iter([(3e6, 0.3, 600), (3e6, 0.1, 600), (3e6, 0.2, 600)])
    others = iter([0.1, 0.4, 0.15])
    monkeypatch.setitem(script_.__dict__, "checkpoint", lambda options, out: next(times))
    monkeypatch.setitem(script_.__dict__, "dd", lambda out, size: next(others))
    start(script_, monkeypatch, "--rounds", 3, "--directory", tmp_path)
    said = capsys.readouterr().out.splitlines()
    assert said[1] == "checkpoint 0.100 s, dd 0.400 s"
    assert said[3] == ("600 elements, 3.0 MB, 1 x 2: checkpoint 0.200 s (15 MB/s), dd conv=fsync 0.150 s (20 MB/s), ratio 1.33")
    assert not list(tmp_path.iterdir())


def test_synthetic_tables_are_what_they_say():
    table = synthetic.energy()
    assert table["total"] == pytest.approx(sum(table[name] for name in synthetic.ENERGIES) - table["external_work"] - table["half_kick"])


def fake_study(monkeypatch, simulated):
    """Two ranks of 600 and 400 tets that share 20 faces, and a simulation that takes so long, or too long."""
    model = simulate.model
    pattern = model.Pattern(np.array([600, 400]), np.array([500, 300]), np.array([0, 1]), np.array([1, 0]), np.array([20, 20]))
    asked = []

    def simulation(args, program, name, path, ranks, costs, network, threads):
        asked.append((program, name, path, ranks, costs, network, threads))
        if simulated is None:
            raise subprocess.TimeoutExpired("smpirun", 600)
        return simulated

    monkeypatch.setitem(simulate.__dict__, "pattern", lambda args, cells, ranks: (cells, ranks))
    monkeypatch.setattr(model, "read_pattern", lambda path: pattern)
    monkeypatch.setitem(simulate.__dict__, "simulate", simulation)
    return asked, pattern


COSTS = {"busy": [{"tets": t, "first": 2e-7, "second": 1e-7, "rest_s": 1e-5, "faces": 20, "pack_s": 4e-6}
                  for t in (100.0, 1e5)],
         "alone": [{"tets": t, "first": 1e-7, "second": 1e-7, "rest_s": 1e-5, "faces": 0, "pack_s": 0} for t in (100.0, 1e5)]}


def test_point_of_a_study(monkeypatch, capsys):
    asked, pattern = fake_study(monkeypatch, 0.5)
    args = types.SimpleNamespace(most=2, timeout=600)
    row = simulate.point(args, "p", COSTS, "strong, 10 million, 16 threads", "tree", (10, 10, 10), 2)
    network = simulate.NETWORKS["tree"]
    network = simulate.dataclasses.replace(network, ranks_per_node=1)
    used = simulate.model.Costs(pytest.approx(2e-7), pytest.approx(1e-7), pytest.approx(1e-7), pytest.approx(1e-5))
    assert asked == [("p", "tree", ((10, 10, 10), 2), 2, used, network, 16)]
    assert (row["tets"], row["ranks"], row["threads"], row["cores"], row["simulated_s"]) == (6000, 2, 16, 32, 0.5)
    assert row["ideal_s"] == pytest.approx(6000 / 32 * 3e-7) and row["cells"] == [10, 10, 10]
    assert row["model"] == simulate.model.step(pattern, network, simulate.costs_for(COSTS, "busy", 6000 / 32), 16)
    assert simulate.point(args, "p", COSTS, "weak", "tree", (10, 10, 10), 3).get("simulated_s") is None  # more than --most
    assert simulate.point(args, "p", COSTS, "weak", "tree", (10, 10, 10), 3, 0.7)["simulated_s"] == 0.7 and len(asked) == 1
    fake_study(monkeypatch, None)
    assert "simulated_s" not in simulate.point(args, "p", COSTS, "weak", "tree", (10, 10, 10), 2)
    assert "the simulation took longer than 600 s" in capsys.readouterr().out


def test_simulation_is_held_against_measured_steps(monkeypatch, capsys):
    asked, _ = fake_study(monkeypatch, 0.9)
    checks = {f"{name}_checks": [{"cells": [10, 10, 10], "tets": 6000 / ranks, "step_s": 1.0}] for ranks,
              name in ((1, "alone"), (2, "busy"))}
    rows = simulate.check(types.SimpleNamespace(), "p", {**COSTS, **checks})
    assert [(row["ranks"], row["tets"], row["measured_s"], row["simulated_s"]) for row in rows] == [(1, 6000, 1.0, 0.9),
                                                                                                    (2, 6000, 1.0, 0.9)]
    assert [(call[3], call[4].first, call[6]) for call in asked] == [(1, pytest.approx(1e-7), 1), (2, pytest.approx(2e-7), 1)]
    assert "2 ranks, 6000 tets: measured 1000.000 ms, simulated 900.000 (-10.0 %), model" in capsys.readouterr().out


def test_simulated_networks_are_those_of_the_document():
    """Nodes of 16 ranks; 100 Gb/s in a fat tree, four hops of 0.5 us; 10 Gb/s at one switch, two of 10 us; less headers."""
    share = 0.97 / 1.05
    for name, bandwidth, latency, hop in (("tree", 100e9 / 8, 2e-6, "500ns"), ("ethernet", 10e9 / 8, 20e-6, "10us")):
        network = simulate.NETWORKS[name]
        assert network.ranks_per_node == 16 and network.bandwidth == pytest.approx(share * bandwidth)
        assert network.latency == pytest.approx(latency) and f'lat="{hop}"' in simulate.CLUSTER[name]
        assert f'bw="{bandwidth / 1e9:g}GBps"' in simulate.CLUSTER[name]
