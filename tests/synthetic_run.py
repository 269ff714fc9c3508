"""The output directory of a run, made of values that a test chooses."""

import json

import h5py
import numpy as np

ENERGIES = ("kinetic", "bodies", "bulk", "penalty", "cohesive", "contact", "foundation", "dissipated", "plastic", "damage",
            "viscous", "friction", "unresolved", "radiated")
SPALL = """
mesh: {cells: [1, 1, 10], size: [2, 3, 8], origin: [-1, -1, -4]}
material: {model: neo-hookean, young: 4e9, poisson: 0.25, density: 3000}
materials: []
interface: {law: linear, strength: 50e6, energy: 30, sets: []}
boundary:
  - {set: z+, component: z, velocity: 7}
  - {set: z-, component: z, velocity: -7}
  - {set: x-, component: x, velocity: 0}
  - {set: x+, component: x, velocity: 0}
  - {set: y-, component: y, velocity: 0}
  - {set: y+, component: y, velocity: 0}
output: {probes: [{name: p-1, at: [0, 0.5, 1]}], fields: [crack]}
"""
SUMMARY = {"case": "spall", "elements": 12345, "steps": 678, "wall_s": 12.3, "first_fracture_time_s": 4.2e-3,
           "broken_area_m2": 2.5, "failed_area_m2": 1.5, "dissipated_J": 7.5e-4, "energy_error_rel": 1.23e-3, "status": "completed", "fragments": 3}


def write_table(path, columns):
    rows = zip(*columns.values())
    path.write_text("\n".join([",".join(columns), *(",".join(repr(float(x)) for x in row) for row in rows)]) + "\n")


def energy(rows=4, **columns):
    """A ledger whose parts are all different; `external_work` and `total` add up."""
    table = {"step": 10.0 * np.arange(1, rows + 1), "time": 1e-3 * np.arange(1, rows + 1)}
    for k, name in enumerate(ENERGIES):
        table[name] = 1e-3 * (k + 1) * np.arange(1, rows + 1) ** 1.5
    table.update(columns)
    work = table.setdefault("external_work", 0.9 * sum(table[name] for name in ENERGIES))
    table["half_kick"] = 0.01 * table["kinetic"]
    table["total"] = sum(table[name] for name in ENERGIES) - work - table["half_kick"]
    table.setdefault("error_rel", np.linspace(1e-4, -2.5e-3, rows))
    return table


def structured(columns):
    """A table as bench/rhegma.py reads it."""
    table = np.empty(len(next(iter(columns.values()))), dtype=[(name, float) for name in columns])
    for name, column in columns.items():
        table[name] = column
    return table


def write_fields(directory, points, cells, frames):
    """`frames`: [{"time", field name, "crack/" + field name: array}]."""
    with h5py.File(directory / "fields.h5", "w") as file:
        file["mesh/points"], file["mesh/cells"] = points, cells
        file.create_group("frames")
        for k, values in enumerate(frames):
            group = file.create_group(f"frames/{k:06d}")
            for name, value in values.items():
                if name == "time":
                    group.attrs["time"] = value
                else:
                    group[name] = value


def box_points(low, high):
    low, high = np.array(low, float), np.array(high, float)
    return np.array([[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])


def write_run(directory, case=SPALL, summary=None, history=None, energy_table=None, fragments=None, fields=None):
    """A run with these files; `fields` as write_fields takes them, `history` and the others as {column: values}."""
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "case.yaml").write_text(case)
    (directory / "summary.json").write_text(json.dumps({**SUMMARY, **(summary or {})}))
    write_table(directory / "energy.csv", energy_table or energy())
    if history:
        write_table(directory / "history.csv", history)
    if fragments:
        write_table(directory / "fragments.csv", fragments)
    if fields:
        write_fields(directory, *fields)
    return directory
