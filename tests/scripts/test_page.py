"""The page of `bench/plot DIR --html FILE`: what is in it, against the run's own tables, and what a browser makes of it."""

import base64
import json
import re
import shutil
import subprocess

import numpy as np
import pytest
import rhegma
import synthetic_run as synthetic
from conftest import TIMEOUT
from pictures import script

plot = script("bench/plot")
page = plot.page
BROWSER = next(filter(None, map(shutil.which, ("chromium-headless-shell", "chromium", "google-chrome"))), None)
VIEW = plot.View("stress", "zz", 2)
POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.0]])
CELLS = [[0, 1, 2, 3], [1, 2, 3, 4]]  # two tets that share a face
CRACK = POINTS[[1, 2, 3]]


def unpacked(value):
    return np.frombuffer(base64.b64decode(value["f32"]), "<f4")


def frame(time, faces, damage, since):
    return {"time": time, "crack/points": np.tile(CRACK, (faces, 1)), "crack/damage": np.full((faces, 1), damage),
            "crack/time_of_failure": np.full((faces, 1), since)}


@pytest.fixture
def made(tmp_path):
    """make(**changes): a run of two tets with 1 broken face at the first moment and 3 at the second."""
    def make(**changes):
        nodes = np.concatenate([np.concatenate([POINTS[cell], np.zeros((6, 3))]) for cell in CELLS])
        fields = nodes, np.arange(20).reshape(2, 10), [frame(1e-3, 1, 0.25, 0.5e-3), frame(4e-3, 3, 1.0, 2e-3)]
        time = np.linspace(0, 4e-3, 5)
        whole = {"fields": fields, "history": {"time": time, "p-1_szz": 1e6 * time, "p-1_vx": 3 * time},
                 "fragments": {"time": [1e-3] * 2 + [4e-3] * 5, "id": [0, 1, *range(5)], "mass": [1.0, 1, 5, 1, 2, 0.5, 1.5]}}
        return rhegma.Run(synthetic.write_run(tmp_path / "run", **{**whole, **changes}))
    return make


def test_contents_are_those_of_the_run(made):
    run = made()
    data = page.contents(run, VIEW, plot.PARTS)
    for name, values in data["energy"].items():
        assert unpacked(values) == pytest.approx(run.energy[name], rel=1e-6)
    assert list(data["parts"]) == list(plot.PARTS) and data["first"] == 4.2e-3
    history = data["history"]
    assert (history["probes"], history["kinds"], history["shown"]) == (["p-1"], ["szz", "vx"], "szz")
    assert unpacked(history["table"]["p-1_vx"]) == pytest.approx(run.history["p-1_vx"], rel=1e-6)
    fragments = {name: unpacked(values).tolist() for name, values in data["fragments"].items()}
    assert fragments["count"] == [2, 5] and fragments["share"] == pytest.approx([0.05, 0.1, 0.15, 0.2, 0.5])
    assert unpacked(data["fragments"]["time"]) == pytest.approx([1e-3, 4e-3])
    first, last = data["cracks"]
    assert (first["time"], last["time"], data["every"]) == (1e-3, 4e-3, 1)
    assert unpacked(first["points"]).tolist() == CRACK.ravel().tolist() and len(unpacked(last["points"])) == 27
    assert unpacked(first["damage"]).tolist() == [0.25] and unpacked(last["since"]) == pytest.approx([2e-3] * 3)
    assert data["box"] == [[0, 0, 0], [1, 1, 1]]


def test_outline_is_the_surface_of_the_body(made):
    surface = {frozenset(map(tuple, triangle)) for triangle in page.outline(made())}
    assert len(surface) == 6 and frozenset(map(tuple, CRACK)) not in surface


def test_parts_that_are_nothing_and_few_fragments_are_left_out(made):
    table = synthetic.energy(friction=np.zeros(4))
    data = page.contents(made(energy_table=table, fragments={"time": [1.0] * 4, "id": range(4), "mass": [1.0] * 4}), VIEW, plot.PARTS)
    assert "friction" not in data["parts"] and "friction" not in data["energy"] and data["fragments"]["share"] is None


def test_large_tables_and_cracks_are_thinned(made, monkeypatch):
    monkeypatch.setattr(page, "MOST_ROWS", 2)
    monkeypatch.setattr(page, "MOST_FACES", 3)
    monkeypatch.setattr(page, "MOST_OUTLINE", 5)
    run = made()
    data = page.contents(run, VIEW, plot.PARTS)
    assert unpacked(data["history"]["table"]["time"]) == pytest.approx([1e-3, 4e-3])  # the last row among them
    assert [crack["time"] for crack in data["cracks"]] == [4e-3] and data["every"] == 2 and data["outline"] is None
    assert "One of 2 output moments" in page.page(run, VIEW, plot.PARTS)
    monkeypatch.setattr(page, "MOST_FACES", 4)
    assert len(page.cracks(run)[0]) == 2


@pytest.mark.parametrize("summary, said", [
    ({}, []), ({"energy_error_rel": 0.011}, ["energy error is 1.1 %"]), ({"energy_error_rel": 0.01}, []),
    ({"energy_error_rel": None}, ["not finite"]), ({"status": "energy"}, ["not come to its end: energy"]),
    ({"overlap_time_s": 2e-3, "overlap_fragments": [3, 8]}, ["Fragments 3 and 8 overlap at 2 ms"])])
def test_warnings(made, summary, said):
    run = made(summary=summary)
    found = page.warnings(run)
    assert len(found) == len(said) and all(words in text for words, text in zip(said, found))
    assert all(f'<p class="warning">{text}</p>' in page.page(run, VIEW, plot.PARTS) for text in found)


def test_autopsy_is_a_warning(made):
    run = made()
    (run.dir / "autopsy.json").write_text('{"cause": "<J> below 0"}')
    assert page.warnings(run) == ["Autopsy: cause <J> below 0"]
    assert "&lt;J&gt; below 0" in page.page(run, VIEW, plot.PARTS)


def test_facts_have_units(made):
    facts = dict(page.facts({**made().summary, "time_end": 4e-3, "state_hash": "ab"}))
    assert facts["simulated time"] == "4 ms" and facts["elements"] == "12,345" and facts["hash of the state"] == "ab"
    assert facts["broken area (where the law acts or has acted)"] == "2.5 m²" and facts["dissipated by cracks"] == "0.75 mJ"
    assert facts["energy error, of the largest energy"] == "0.123 %" and "interfaces" not in facts


@pytest.mark.parametrize("fields, words", [("fields: []", "The case asks for no fields."), (None, "did not write its crack surface")])
def test_page_of_a_run_without_cracks(made, fields, words):
    if fields:
        run = made(case=synthetic.SPALL.replace("fields: [crack]", fields), fields=None)
    else:
        run = made(fields=(POINTS, np.arange(10).reshape(1, 10) % 5, [{"time": 1e-3}]))
    text = page.page(run, VIEW, plot.PARTS)
    assert words in text and 'id="crack"' not in text


@pytest.mark.parametrize("time, value", [(None, 1), (2.4e-3, 0), (2.6e-3, 1)])
def test_slider_begins_at_the_moment_asked_for(made, time, value):
    text = page.page(made(), plot.View("stress", "zz", 2, time), plot.PARTS)
    assert f'type="range" min="0" max="1" value="{value}"' in text


def test_plot_writes_the_page(made, tmp_path, monkeypatch, capsys):
    run = made()
    monkeypatch.setattr("sys.argv", ["plot", str(run.dir), "--html", str(tmp_path / "new/a.html"), "--component", "xx"])
    plot.main()
    text = (tmp_path / "new/a.html").read_text()
    assert capsys.readouterr().out == f"{tmp_path / 'new/a.html'}\n" and '"shown": "sxx"' in text
    assert not list(run.dir.glob("*.png"))
    own = text.replace(page.javascript(), "")
    assert len(own) < 40_000 and not re.search(r"(src|href)=|https?:", own)  # nothing to load from elsewhere


# ---- in a browser ----

TELL = """<script>
const told = {drawn: document.body.dataset.drawn}, crack = () => by("crack").data[0];
const look = () => ({faces: crack().i.length, corner: [crack().x[3], crack().y[4], crack().z[5]], intensity: Array.from(crack().intensity),
  limits: [crack().cmin, crack().cmax], when: by("when").textContent});
const turn = (id, value) => { by(id).value = value; by(id).dispatchEvent(new Event("input")); };
const eye = () => by("crack")._fullLayout.scene._scene.getCamera().eye;
told.last = look(); turn("frame", 0); told.first = look(); turn("colour", "since"); told.since = look();
told.energy = by("energy").data.map(one => one.name); told.error = Array.from(by("energy").data.at(-1).y);
told.outline = by("crack").data[1].i.length;
turn("kind", "vx"); told.probe = [by("history").data[0].name, Array.from(by("history").data[0].y), by("history").layout.yaxis.title.text];
told.fragments = by("fragments").data.map(one => Array.from(one.y));
const before = eye(), canvas = by("crack").querySelector("canvas"), box = canvas.getBoundingClientRect();
const mouse = (type, x) => canvas.dispatchEvent(new MouseEvent(type, {bubbles: true, buttons: type === "mouseup" ? 0 : 1, button: 0,
  clientX: box.left + x, clientY: box.top + 200, view: window}));
setTimeout(() => { mouse("mousedown", 300); mouse("mousemove", 320); }, 500);
setTimeout(() => { mouse("mousemove", 420); }, 700);
setTimeout(() => { mouse("mouseup", 420); }, 900);
setTimeout(() => {
  told.turned = Math.hypot(eye().x - before.x, eye().y - before.y);
  told.loaded = performance.getEntriesByType("resource").map(one => one.name);
  const out = document.createElement("pre"); out.id = "told"; out.textContent = JSON.stringify(told); document.body.append(out);
}, 1500);
</script></body>"""


def browse(path, *options):
    return subprocess.run([BROWSER, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                           "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={path.parent / 'profile'}",
                           "--window-size=1200,1500", "--virtual-time-budget=8000", *options, path.as_uri()], capture_output=True,
                          text=True, timeout=TIMEOUT, check=True).stdout


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here (Debian: chromium-headless-shell)")
def test_page_in_a_browser(made, tmp_path):
    """Every chart is drawn; slider, colours and components change what it shows; the mouse turns the crack; nothing is loaded."""
    run, file = made(), tmp_path / "a.html"
    text = page.page(run, VIEW, plot.PARTS)
    file.write_text(text.replace("</body>", TELL))
    told = json.loads(re.search(r'<pre id="told">(.*?)</pre>', browse(file, "--dump-dom")).group(1).replace("&amp;", "&"))
    assert told["drawn"] == "yes" and told["loaded"] == []
    assert (told["last"]["faces"], told["last"]["when"], told["last"]["limits"]) == (3, "4.000 ms, 3 broken faces", [0, 1])
    assert (told["first"]["faces"], told["first"]["when"], told["first"]["intensity"]) == (1, "1.000 ms, 1 broken faces", [0.25])
    assert told["last"]["corner"] == [1, 1, 1]  # the second triangle: first corner's x, second's y, third's z
    assert told["since"]["intensity"] == pytest.approx([0.5e-3]) and told["since"]["limits"] == pytest.approx([2e-3, 2e-3])
    assert told["outline"] == 6
    assert told["energy"] == [*plot.PARTS, "external work", "total: sum less external work", "relative error"]
    assert told["error"] == pytest.approx(run.energy["error_rel"], rel=1e-6)
    assert told["probe"] == ["p-1", pytest.approx(run.history["p-1_vx"], rel=1e-6), "vx (m/s)"]
    assert told["fragments"] == [[2, 5], [5, 4, 3, 2, 1]]
    assert told["turned"] > 0.1


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here (Debian: chromium-headless-shell)")
def test_crack_is_seen_in_a_browser(made, tmp_path):
    """Failed faces are dark red, and are seen."""
    file, picture = tmp_path / "a.html", tmp_path / "a.png"
    file.write_text(page.page(made(), VIEW, plot.PARTS))
    browse(file, f"--screenshot={picture}")
    seen = plot.plt.imread(picture)[..., :3]
    red = (seen[..., 0] > 0.3) & (seen[..., 0] < 0.65) & (seen[..., 1] < 0.15) & (seen[..., 2] < 0.25)  # no line is so dark
    assert red.sum() > 5_000
