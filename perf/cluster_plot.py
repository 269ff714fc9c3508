"""Pictures of a record of perf/simulate: model as lines, simulated as open points, measured as full ones."""

from drawing import plt  # of bench/, whose folder perf/simulate adds to the path

# Thesis, Figure 5-18, on cores of 7.2 GF/s. Of its scan only the axis can be read; the curve starts at 16
# cores at about 1.8 s.
THESIS = {"tets": 223_394, "cores": 16, "seconds": 1.8, "most": 48}
STYLE = {"tree": ("C0", "100 Gb/s fat tree"), "ethernet": ("C1", "10 Gb/s Ethernet")}


def points_of(record, study, network):
    rows = [p for p in record["points"] if p["study"] == study and p["network"] == network]
    return sorted(rows, key=lambda p: p["cores"])


def modelled(p):
    return p["model"]["step_s"]


def draw_study(axis, rows, value, color, label):
    """value(point, seconds of a step)."""
    axis.plot([p["cores"] for p in rows], [value(p, modelled(p)) for p in rows], color=color, label=f"{label}, model")
    simulated = [p for p in rows if "simulated_s" in p]
    axis.plot([p["cores"] for p in simulated], [value(p, p["simulated_s"]) for p in simulated], "o", color=color, mfc="none",
              label=f"{label}, simulated")


def plot_thesis(axis, record):
    cores = [THESIS["cores"], THESIS["most"]]
    axis.plot(cores, [THESIS["seconds"] * THESIS["cores"] / n for n in cores], "k:", label="thesis, linear from there")
    axis.plot(cores[:1], [THESIS["seconds"]], "ks", label="thesis, Fig. 5-18, read off")
    for network, (color, label) in STYLE.items():
        draw_study(axis, points_of(record, "thesis mesh", network), lambda _, seconds: seconds, color, label)
    largest = max(c["tets"] for c in record["checks"])
    measured = [c for c in record["checks"] if c["tets"] == largest]
    axis.plot([c["ranks"] for c in measured], [c["measured_s"] for c in measured], "r^", label=f"measured, {largest:,} tets")
    tets = points_of(record, "thesis mesh", "tree")[0]["tets"]
    axis.set(xscale="log", yscale="log", xlabel="cores", ylabel="time per step (s)",
             title=f"{tets:,} tets (thesis: {THESIS['tets']:,})")


def share_of_sweeps(p, seconds):
    return p["ideal_s"] / seconds


def plot_strong(axis, record):
    for study, shade in (("strong, 1 million", 0), ("strong, 10 million", 2), ("strong, 10 million, 16 threads", 4)):
        for k, (network, (_, label)) in enumerate(STYLE.items()):
            draw_study(axis, points_of(record, study, network), share_of_sweeps, f"C{shade + k}", f"{study[8:]}, {label}")
    axis.axhline(0.8, color="k", ls=":")
    axis.set(xscale="log", xlabel="cores", ylabel="sweeps / time of the step", ylim=(0, 1.05), title="strong scaling")


def plot_weak(axis, record):
    for study, shade in (("weak", 0), ("weak, 16 threads", 4)):
        for k, (network, (_, label)) in enumerate(STYLE.items()):
            draw_study(axis, points_of(record, study, network), share_of_sweeps, f"C{shade + k}",
                       f"{study[6:] or '1 thread'}, {label}")
    axis.axhline(0.95, color="k", ls=":")
    axis.set(xscale="log", xlabel="cores", ylabel="sweeps / time of the step", ylim=(0, 1.05),
             title="weak scaling, 50,000 tets a core")


def draw(record):
    """{"thesis": figure, "clusters": figure}."""
    figures = {}
    for name, panels in (("thesis", [plot_thesis]), ("clusters", [plot_strong, plot_weak])):
        figures[name], axes = plt.subplots(1, len(panels), figsize=(5.6 * len(panels), 4.4), squeeze=False)
        for axis, panel in zip(axes[0], panels):
            panel(axis, record)
            axis.legend()
    return figures
