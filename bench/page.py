"""One self-contained page of a run: summary, warnings, energy, histories, fragments, and its crack surface to turn with the
mouse, with a slider over the output moments. Needs no network when it is opened: Plotly's JavaScript is in it."""

import base64
import html
import json

import numpy as np
import rhegma
from drawing import BLUE, RED, with_unit
from launch import BadInput, read_mapping

MOST_FACES = 300_000  # of all frames together; some 60 bytes each
MOST_OUTLINE = 60_000  # triangles of the body's surface
MOST_ROWS = 4_000  # of a history
MANY = 5  # fragments, from which on their masses are worth a distribution
BAD_ERROR = 0.01  # of the energy, from which on the page warns

FACTS = [  # key of summary.json, words, unit (None: as it is), power of the unit
    ("status", "status", None, 1), ("elements", "elements", None, 1), ("interfaces", "interfaces", None, 1),
    ("steps", "steps", None, 1), ("time_end", "simulated time", "s", 1), ("dt_critical", "critical step at the start", "s", 1),
    ("first_fracture_time_s", "first fracture", "s", 1), ("failed_area_m2", "failed area (carries nothing any more)", "m", 2),
    ("broken_area_m2", "broken area (where the law acts or has acted)", "m", 2), ("dissipated_J", "dissipated by cracks", "J", 1),
    ("energy_largest_J", "largest energy", "J", 1), ("fragments", "fragments", None, 1), ("wall_s", "time loop", "s", 1),
    ("ranks", "ranks", None, 1), ("threads", "threads of each", None, 1), ("state_hash", "hash of the state", None, 1),
    ("revision", "revision", None, 1)]


def javascript():
    try:
        from plotly.offline import get_plotlyjs
    except ImportError as missing:
        raise BadInput(f"--html: {missing} (Debian: python3-plotly)") from missing
    return get_plotlyjs()


# ---- what the page shows ----


def packed(array):
    """Numbers in single precision, as the page unpacks them."""
    return {"f32": base64.b64encode(np.ascontiguousarray(array, "<f4").tobytes()).decode()}


def facts(summary):
    """(words, value) of what a reader asks first."""
    found = []
    for key, words, unit, power in FACTS:
        value = summary.get(key)
        if value is not None:
            text = with_unit(value, unit, power) if unit else f"{value:,}" if isinstance(value, int) else str(value)
            found.append((words, text))
    error = summary.get("energy_error_rel")
    return found + ([] if error is None else [("energy error, of the largest energy", f"{100 * error:.3g} %")])


def warnings(run):
    """Why the run is not to be trusted, as far as it left word of it."""
    summary, found = run.summary, []
    if summary.get("status") != "completed":
        found.append(f"The run has not come to its end: {summary.get('status')}.")
    if (run.dir / "autopsy.json").is_file():
        autopsy = read_mapping(run.dir / "autopsy.json", json.loads)
        found.append("Autopsy: " + ", ".join(f"{key} {value}" for key, value in autopsy.items()))
    error = summary.get("energy_error_rel")
    if error is None or error > BAD_ERROR:
        found.append("The energy error is not finite." if error is None else
                     f"The energy error is {100 * error:.3g} % of the largest energy.")
    if "overlap_time_s" in summary:
        one, other = summary["overlap_fragments"]
        found.append(f"Fragments {one} and {other} overlap at {with_unit(summary['overlap_time_s'], 's')}. Contact between "
                     "separated fragments is not computed; what comes after is not to be trusted.")
    return found


def thinned(table):
    """At most so many rows, evenly, the last among them."""
    step = -(-len(table) // MOST_ROWS)
    return table[np.arange(len(table) - 1, -1, -step)[::-1]]


def columns(table, names):
    return {name: packed(table[name]) for name in names}


def outline(run):
    """Triangles [n][3][3] of the body's surface, as it was at the start."""
    points, cells = rhegma.mesh(run.dir)
    vertices, number = np.unique(points[cells[:, :4].ravel()], axis=0, return_inverse=True)
    corners = number.reshape(-1, 4)
    faces = np.concatenate([corners[:, chosen] for chosen in ([0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3])])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return vertices[faces[first[count == 1]]]


def cracks(run):
    """The crack surface of the moments shown: [{"time", "points" [9 n], "damage" [n], "since" [n]}], and each how manyeth
    moment they are: those that would make the page too large are left out evenly, but not the last."""
    every = [(time, run.crack(number)) for number, time in enumerate(rhegma.frame_times(run.dir))]
    if any(crack is None for _, crack in every):
        return [], 1
    total = sum(len(crack["points"]) for _, crack in every)
    step = max(1, -(-total // MOST_FACES))
    return [{"time": float(time), "points": packed(crack["points"].ravel()), "damage": packed(crack["damage"]),
             "since": packed(crack.get("time_of_failure", np.zeros(len(crack["damage"]))))}
            for time, crack in every[::-1][::step][::-1]], step


def contents(run, view, parts):
    """All that the page draws, as JSON. `view`: field, component and moment shown first; `parts`: {column of energy.csv: colour}."""
    case, summary, energy = run.case, run.summary, run.energy
    shown = [name for name in parts if energy[name].any()]
    data = {"parts": {name: parts[name] for name in shown}, "colours": {"computed": BLUE, "fracture": RED},
            "first": summary.get("first_fracture_time_s"),
            "energy": columns(thinned(energy), ["time", *shown, "external_work", "total", "error_rel"])}
    probes = [probe["name"] for probe in case["output"].get("probes") or []]
    if probes:
        history = run.history
        kinds = sorted(name[len(probes[0]) + 1:] for name in history.dtype.names if name.startswith(f"{probes[0]}_"))
        data["history"] = {"probes": probes, "kinds": kinds, "shown": view.column("")[1:], "table": columns(
            thinned(history), ["time", *(f"{probe}_{kind}" for probe in probes for kind in kinds)])}
    fragments = run.fragments
    if fragments is not None:
        times, counts = np.unique(fragments["time"], return_counts=True)
        mass = np.sort(fragments["mass"][fragments["time"] == times[-1]])
        data["fragments"] = {"time": packed(times), "count": packed(counts),
                             "share": packed(mass / mass.sum()) if len(mass) >= MANY else None}
    if case["output"].get("fields"):
        surface = outline(run)
        data["box"] = rhegma.box_of(rhegma.mesh(run.dir)[0]).tolist()
        data["outline"] = packed(surface.ravel()) if len(surface) <= MOST_OUTLINE else None
        data["cracks"], data["every"] = cracks(run)
    return data


# ---- the page ----

STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; color: #22272e; max-width: 1200px; margin: 0 auto; padding: 1em 1.5em 3em; }
h1 { font-size: 1.5em; margin: .3em 0; } h2 { font-size: 1.1em; margin: 2em 0 .4em; }
table { border-collapse: collapse; } td { padding: .15em 1.2em .15em 0; border-bottom: 1px solid #e6e8eb; }
.warning { background: #fdecea; border-left: 4px solid #c8392b; padding: .5em 1em; margin: .5em 0; }
.controls { display: flex; gap: 1em; align-items: center; } .controls input { flex: 1; }
#summary tbody { display: grid; grid-template-columns: 1fr 1fr; column-gap: 3em; }
#summary tr { display: flex; justify-content: space-between; border-bottom: 1px solid #e6e8eb; } #summary td { border: 0; }
#crack { height: 620px; } #energy { height: 520px; } pre { background: #f6f8fa; padding: 1em; overflow: auto; }
"""

SCRIPT = r"""
function unpack(value) {
  if (value === null || typeof value !== "object") return value;
  if (typeof value.f32 === "string") {
    const bytes = Uint8Array.from(atob(value.f32), c => c.charCodeAt(0));
    return new Float32Array(bytes.buffer);
  }
  for (const key in value) value[key] = unpack(value[key]);
  return value;
}
const data = unpack(JSON.parse(document.getElementById("data").textContent));
const config = {responsive: true, displaylogo: false};
const sheet = more => Object.assign({margin: {l: 70, r: 20, t: 30, b: 45}, hovermode: "closest", template: "none"}, more);
const by = id => document.getElementById(id);
const mark = data.first === null ? [] : [{type: "line", x0: data.first, x1: data.first, yref: "paper", y0: 0, y1: 1,
  line: {color: data.colours.fracture, width: 1, dash: "dashdot"}}];

function drawEnergy() {
  const e = data.energy, lines = [];
  for (const name in data.parts) lines.push({x: e.time, y: e[name], name, line: {color: data.parts[name]}});
  lines.push({x: e.time, y: e.external_work, name: "external work", line: {color: "#22272e", dash: "dash"}});
  lines.push({x: e.time, y: e.total, name: "total: sum less external work", line: {color: "#8b949e"}});
  lines.push({x: e.time, y: e.error_rel, name: "relative error", line: {color: "#22272e"}, yaxis: "y2", showlegend: false});
  Plotly.newPlot("energy", lines, sheet({shapes: mark, xaxis: {title: "time (s)", exponentformat: "SI", anchor: "y2"},
    yaxis: {title: "energy (J)", domain: [0.3, 1], exponentformat: "SI"},
    yaxis2: {title: "error", domain: [0, 0.2], tickformat: ".2%"}}), config);
}

function drawHistory() {
  const h = data.history, kind = by("kind").value;
  const unit = kind[0] === "s" ? "Pa" : kind[0] === "v" ? "m/s" : "m";
  const lines = h.probes.map(probe => ({x: h.table.time, y: h.table[probe + "_" + kind], name: probe}));
  Plotly.react("history", lines, sheet({shapes: mark, showlegend: true, xaxis: {title: "time (s)", exponentformat: "SI"},
    yaxis: {title: kind + " (" + unit + ")", exponentformat: "SI"}}), config);
}

function drawFragments() {
  const f = data.fragments, lines = [{x: f.time, y: f.count, line: {shape: "hv"}, showlegend: false}];
  const layout = {xaxis: {title: "time (s)", exponentformat: "SI"}, yaxis: {title: "fragments", rangemode: "tozero"}};
  if (f.share) {
    lines.push({x: f.share, y: Array.from(f.share, (_, k) => f.share.length - k), xaxis: "x2", yaxis: "y2",
      mode: "lines+markers", line: {shape: "vh"}, showlegend: false});
    layout.xaxis.domain = [0, 0.45];
    layout.xaxis2 = {title: "mass m / mass of the body", domain: [0.57, 1], type: "log"};
    layout.yaxis2 = {title: "fragments of mass m or more", anchor: "x2", type: "log"};
  }
  Plotly.newPlot("fragments", lines, sheet(layout), config);
}

function seconds(t) {
  const [factor, unit] = [[1, "s"], [1e3, "ms"], [1e6, "µs"], [1e9, "ns"]].find(([f]) => t * f >= 0.1) || [1e9, "ns"];
  return (t * factor).toPrecision(4) + " " + unit;
}

function triangles(points) {  // nine numbers each
  const n = points.length / 3, part = k => Float32Array.from({length: n}, (_, i) => points[3 * i + k]);
  const corner = k => Int32Array.from({length: n / 3}, (_, i) => 3 * i + k);
  return {x: part(0), y: part(1), z: part(2), i: corner(0), j: corner(1), k: corner(2)};
}

function drawCrack() {
  const frame = data.cracks[by("frame").value], since = by("colour").value === "since";
  const last = data.cracks[data.cracks.length - 1].since;
  const extreme = (choose, begin) => last.reduce((a, b) => choose(a, b), begin);
  const limits = since ? [extreme(Math.min, Infinity), extreme(Math.max, -Infinity)] : [0, 1];
  by("when").textContent = seconds(frame.time) + ", " + frame.damage.length + " broken faces";
  const traces = [Object.assign(triangles(frame.points), {type: "mesh3d", intensity: since ? frame.since : frame.damage,
    intensitymode: "cell", cmin: limits[0], cmax: limits[1], colorscale: since ? "Viridis" : "YlOrRd", reversescale: !since,
    flatshading: true, lighting: {ambient: 0.75, diffuse: 0.5, specular: 0.05}, hoverinfo: "skip", showscale: true,
    colorbar: {title: since ? "broke at (s)" : "damage (1: failed)", len: 0.6, exponentformat: "SI"}})];
  if (data.outline) traces.push(Object.assign(triangles(data.outline), {type: "mesh3d", color: "#9aa4ae", opacity: 0.12,
    flatshading: true, hoverinfo: "skip"}));
  const [low, high] = data.box, edges = {x: [], y: [], z: []};
  for (let a = 0; a < 8; a++) for (const bit of [1, 2, 4]) if (!(a & bit)) for (const end of [a, a | bit, null]) {
    ["x", "y", "z"].forEach((axis, k) => edges[axis].push(end === null ? null : (end >> k & 1 ? high : low)[k]));
  }
  traces.push(Object.assign(edges, {type: "scatter3d", mode: "lines", line: {color: "#57606a", width: 2}, hoverinfo: "skip",
    showlegend: false}));
  const axis = name => ({title: name + " (m)", exponentformat: "SI", showbackground: false});
  const size = high.map((x, k) => x - low[k]), most = Math.max(...size), far = Math.hypot(...size) / most;
  Plotly.react("crack", traces, {margin: {l: 0, r: 0, t: 0, b: 0}, uirevision: "kept",
    scene: {aspectmode: "manual", uirevision: "kept",
      aspectratio: {x: size[0] / most, y: size[1] / most, z: size[2] / most},
      camera: {eye: {x: 1.15 * far, y: 0.55 * far, z: 0.7 * far}}, xaxis: axis("x"), yaxis: axis("y"), zaxis: axis("z")}}, config);
}

drawEnergy();
if (data.history) { by("kind").oninput = drawHistory; drawHistory(); }
if (data.fragments) drawFragments();
if (data.cracks && data.cracks.length) {
  by("frame").oninput = by("colour").oninput = drawCrack;
  drawCrack();
}
document.body.dataset.drawn = "yes";
"""


def section(title, inside):
    return f"<h2>{title}</h2>\n{inside}\n"


def crack_section(data, time):
    if "cracks" not in data:
        return "<p>The case asks for no fields.</p>"
    if not data["cracks"]:
        return "<p>The run did not write its crack surface.</p>"
    last, times = len(data["cracks"]) - 1, np.array([crack["time"] for crack in data["cracks"]])
    first = last if time is None else int(np.argmin(np.abs(times - time)))
    return (f'<div class="controls"><label>colour <select id="colour"><option value="damage">damage</option>'
            f'<option value="since">time at which it broke</option></select></label>'
            f'<input id="frame" type="range" min="0" max="{last}" value="{first}" aria-label="output moment">'
            f'<span id="when"></span></div>\n<div id="crack"></div>' +
            (f"<p>One of {data['every']} output moments is shown: all would make the page too large.</p>"
             if data["every"] > 1 else ""))


def history_section(data):
    history = data["history"]
    chosen = "".join(f'<option{" selected" if kind == history["shown"] else ""}>{html.escape(kind)}</option>'
                     for kind in history["kinds"])
    return f'<label>component <select id="kind">{chosen}</select></label>\n<div id="history"></div>'


def page(run, view, parts):
    """The text of the page."""
    data, summary = contents(run, view, parts), run.summary
    name = html.escape(str(summary["case"]))
    told = "".join(f'<p class="warning">{html.escape(text)}</p>\n' for text in warnings(run))
    rows = "".join(f"<tr><td>{html.escape(words)}</td><td>{html.escape(text)}</td></tr>\n" for words, text in facts(summary))
    parts_of_page = [section("Summary", f'<table id="summary">{rows}</table>'), section("Crack surface", crack_section(data, view.time)),
                     section("Energy", '<div id="energy"></div>')]
    if "history" in data:
        parts_of_page.append(section("Probes", history_section(data)))
    if "fragments" in data:
        parts_of_page.append(section("Fragments", '<div id="fragments"></div>'))
    text = (run.dir / "case.yaml").read_text()
    parts_of_page.append(section("Case", f"<details><summary>all values used</summary><pre>{html.escape(text)}</pre></details>"))
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{name}</title>\n<style>{STYLE}</style>\n'
            f"<script>{javascript()}</script></head>\n<body>\n<h1>{name}</h1>\n{told}{''.join(parts_of_page)}"
            f'<script type="application/json" id="data">{json.dumps(data)}</script>\n<script>{SCRIPT}</script>\n</body></html>\n')


def write(path, run, view, parts):
    text = page(run, view, parts)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    except OSError as error:
        raise BadInput(f"{path}: cannot be written: {error.strerror}") from error
    print(path, flush=True)
