"""`rhegma keys`: the reference that stands in src/case/README.md, and the JSON Schema by which editors check a case."""

import copy
import functools
import json
import re

import jsonschema
import pytest
import rhegma
from conftest import ROOT, launch

CASES = sorted(path for folder in ("bench", "tests/cases") for path in (ROOT / folder).rglob("*.yaml"))
SPALL = next(path for path in CASES if path.name == "spall.yaml")
CERAMIC = next(path for path in CASES if path.name == "ceramic-cube.yaml")
INTRINSIC = next(path for path in CASES if path.name == "intrinsic.yaml")


def said(*arguments):
    process = launch("keys", *arguments)
    assert process.returncode == 0 and process.stderr == ""
    return process.stdout


def unique(pairs):
    """A JSON object, in which no name stands twice."""
    assert len(dict(pairs)) == len(pairs), pairs
    return dict(pairs)


@functools.cache
def validator():
    schema = json.loads(said("--schema"), object_pairs_hook=unique)
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def wrong(case):
    """Where the schema finds a case wrong."""
    return {".".join(map(str, error.absolute_path)) for error in validator().iter_errors(case)}


# ---- the document ----


def test_the_document_is_what_the_program_prints():
    """Else renew it as it says itself."""
    preface, *printed = (ROOT / "src/case/README.md").read_text().partition("\n## `defaults`\n")
    assert preface.startswith("# Case files\n")
    assert "".join(printed)[1:].splitlines() == said("--markdown").splitlines()


def test_part_of_it():
    assert said("time.s") == "\n\n".join(block for block in said().split("\n\n") if block.startswith("time.s")) + "\n"
    assert said("time.s", "--markdown").count("\n| `time.") == 2


@pytest.mark.parametrize("arguments, complaint", [
    (["yung"], "rhegma: no key begins with yung; did you mean 'material.young'?\n"),
    (["qqqqqq"], "rhegma: no key begins with qqqqqq\n"),
    (["--frob"], "rhegma: keys: unknown option: --frob\nusage: rhegma keys"),
    (["mesh", "time"], "rhegma: keys: one prefix at a time; not understood: time\nusage: rhegma keys"),
    (["--schema", "mesh"], "rhegma: keys: --schema is that of the whole case; not understood with it: mesh\nusage"),
    (["--markdown", "--schema"], "rhegma: keys: --schema is that of the whole case; not understood with it: --markdown\n"),
])
def test_wrong_arguments(arguments, complaint):
    process = launch("keys", *arguments)
    assert process.returncode == 2 and process.stdout == "" and process.stderr.startswith(complaint)


# ---- the schema ----


def values(*names):
    """What the schema says of a key: by its names on the way down, lists by []."""
    node = validator().schema
    for name in names:
        node = node["items"] if name == "[]" else node["properties"][name]
    return node


def test_values_as_an_editor_sees_them():
    assert values("mesh", "cells") == {
        "description": "cubes of the box along x, y, z, each cut into 6 tetrahedra; required",
        "type": "array", "minItems": 3, "maxItems": 3, "items": {"type": "integer", "minimum": 1, "maximum": 100000}}
    poisson = values("material", "poisson")  # three of a solid with axes
    assert poisson.pop("description").startswith("Poisson's ratio; ")
    assert poisson == {"anyOf": [{"type": "number", "minimum": 0, "exclusiveMaximum": 0.5},
                                 {"type": "array", "minItems": 3, "maxItems": 3, "items": {"type": "number"}}]}
    assert values("time", "safety") == {
        "description": "time step as a fraction of the critical one; default: 0.875 of form variational with activation conserving or law none, else 0.5 (defaults 0: 0.5)", "type": "number", "exclusiveMinimum": 0,
        "maximum": 1}
    assert values("material", "density")["description"] == "reference density (kg/m3); required"
    assert values("initial", "velocity", "z") == {"description": "along z (m/s); default: 0", "type": ["number", "string"]}
    assert values("boundary", "[]", "velocity")["description"] == "prescribed velocity (m/s); this or another motion"
    assert values("boundary", "[]", "set")["anyOf"] == [{"enum": ["x-", "x+", "y-", "y+", "z-", "z+"]}, {"type": "string"}]
    assert values("bodies", "[]", "faces")["minItems"] == 1 and values("bodies", "[]", "faces")["type"] == "array"
    assert values("output", "times")["minItems"] == 1 and values("output", "fields")["uniqueItems"] is True
    assert values("output", "interval")["anyOf"] == [
        {"type": "integer", "minimum": 1}, {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1}]
    assert values("interface", "weibull", "keep") == {
        "description": "what stays that of `energy` on each face; default: energy", "enum": ["energy", "opening"],
        "enumDescriptions": ["the fracture energy: weak faces open further", "the critical opening: weak faces take less energy"]}
    assert values()["required"] == ["mesh", "material", "interface", "time"]
    assert values("interface")["required"] == ["law"] and values("bodies", "[]")["required"] == ["name", "shape", "motion", "at"]


def sections(node):
    yield node
    for inner in [*node.get("properties", {}).values(), *([node["items"]] if "items" in node else [])]:
        yield from sections(inner)


def test_no_section_takes_what_is_unknown():
    objects = [node for node in sections(validator().schema) if "properties" in node]
    assert len(objects) > 15 and all(node["additionalProperties"] is False for node in objects)


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_every_case_is_valid(path):
    assert wrong(rhegma.read_case(path)) == set()


def changed(path, changes):
    """The case with values put in at "a.b" or "a.0.b", or taken out (None)."""
    case = copy.deepcopy(rhegma.read_case(path))
    for name, value in changes.items():
        *sections, last = [int(part) if part.isdigit() else part for part in name.split(".")]
        inner = case
        for section in sections:
            inner = inner.setdefault(section, {}) if isinstance(inner, dict) else inner[section]
        if value is None:
            del inner[last]
        else:
            inner[last] = value
    return case


@pytest.mark.parametrize("path, changes, places", [
    # values
    (SPALL, {"material.yung": 1}, {"material"}),
    (SPALL, {"fracture": True}, {""}),
    (SPALL, {"material.young": 0}, {"material.young"}),
    (SPALL, {"material.young": "260 GPa"}, {"material.young"}),
    (SPALL, {"material.poisson": 0.5}, {"material.poisson"}),
    (SPALL, {"mesh.cells": [2, 2]}, {"mesh.cells"}),
    (SPALL, {"mesh.cells": [2, 2, 2, 2]}, {"mesh.cells"}),
    (SPALL, {"mesh.cells": [2, 2.5, 0]}, {"mesh.cells.1", "mesh.cells.2"}),
    (SPALL, {"mesh.jitter": 0.31}, {"mesh.jitter"}),
    (SPALL, {"interface.form": "weird"}, {"interface.form"}),
    (SPALL, {"initial.velocity.x": [1]}, {"initial.velocity.x"}),
    (SPALL, {"output.interval": 0}, {"output.interval"}),
    (SPALL, {"output.interval": 1.5}, {"output.interval"}),
    (SPALL, {"output.fields": ["stres"]}, {"output.fields.0"}),
    (SPALL, {"output.fields": ["crack", "crack"]}, {"output.fields"}),
    (SPALL, {"output.times": []}, {"output.times"}),
    (SPALL, {"output.probes.0.at": 3}, {"output.probes.0.at"}),
    (SPALL, {"output.dir": 12}, {"output.dir"}),
    (SPALL, {"boundary.0.set": 3}, {"boundary.0.set"}),
    # what is missing
    (SPALL, {"time.end": None}, {"time"}),
    (SPALL, {"time": None}, {""}),
    (SPALL, {"mesh": None}, {""}),
    (SPALL, {"mesh.size": None}, {"mesh"}),
    (SPALL, {"material.young": None}, {"material"}),
    (SPALL, {"material.density": None}, {"material"}),
    (SPALL, {"material": {"model": "j2", "density": 1}}, {"material"}),
    (SPALL, {"material": {"young": 1e9}}, {"material"}),
    (SPALL, {"interface.law": None}, {"interface"}),
    (SPALL, {"interface.strength": None}, {"interface"}),
    (SPALL, {"interface.energy": None}, {"interface"}),
    (SPALL, {"interface.weibull.modulus": 10}, {"interface.weibull"}),
    (SPALL, {"output.probes.0.name": None}, {"output.probes.0"}),
    (CERAMIC, {"material.shear": None}, {"material"}),
    (SPALL, {"boundary.0.velocity": None}, {"boundary.0"}),
    (SPALL, {"materials": [{"name": "s", "where": 1, "model": "j2", "young": 1, "poisson": 0, "density": 1}]}, {"materials.0"}),
    # what is not used
    (SPALL, {"mesh.file": "bar.h5"}, {"mesh.cells", "mesh.size", "mesh.origin"}),
    (SPALL, {"material.shear": 1}, {"material.shear"}),
    (CERAMIC, {"material.young": 1}, {"material.young"}),
    (CERAMIC, {"interface.strength": 1}, {"interface.strength"}),
    (SPALL, {"interface.law": "free"}, {"interface.energy"}),
    (SPALL, {"interface.bilinear.ascent": 0.1}, {"interface.bilinear"}),
    (INTRINSIC, {"interface.penalty": "elastic"}, {"interface.penalty"}),
    (SPALL, {"interface.activation": "continuous", "interface.onset": 0.2}, {"interface.onset"}),
    (INTRINSIC, {"interface.activation": "conserving", "interface.onset": 0.2}, {"interface.activation", "interface.onset"}),
    (SPALL, {"interface.faces": 1}, {"interface.faces"}),
    (SPALL, {"interface.weibull.seed": 1}, {"interface.weibull.seed"}),
    (SPALL, {"boundary.0.displacement": 1}, {"boundary.0"}),
    (SPALL, {"interface.sets": [{"strength": 1}]}, {"interface.sets.0"}),
], ids=lambda value: str(sorted(value)) if isinstance(value, set) else getattr(value, "stem", str(value)))  # workers agree on it
def test_mistakes_are_found(path, changes, places):
    assert wrong(changed(path, changes)) == places


@pytest.mark.parametrize("path, changes", [
    (SPALL, {"mesh": {"file": "bar.h5"}, "boundary.0.set": "top"}),
    (SPALL, {"initial.velocity.x": "sin(x)", "initial.velocity.y": 3}),
    (SPALL, {"output.interval": 7, "output.fields": [], "output.times": [1e-8]}),
    (SPALL, {"interface.activation": "conserving", "interface.onset": 0.2}),
    (SPALL, {"interface.form": "continuous", "interface.faces": "abs(z) < 1e-6"}),
    (SPALL, {"interface.law": "rate", "interface.rate.speed": 5}),
    (SPALL, {"interface.weibull": {"modulus": 10, "area": 1e-9, "keep": "opening"}}),
    (SPALL, {"interface.sets": [{"between": ["a", "b"], "where": "z"}, {"where": 1}]}),
    (SPALL, {"materials": [{"name": "s", "set": "a", "model": "j2", "young": 1, "poisson": 0, "density": 1, "yield_stress": 1}]}),
    (SPALL, {"material": {"preset": "concrete-hjc"}}),
    (SPALL, {"material": {"preset": "alumina-ad995", "model": "neo-hookean", "density": 3800}}),
    (SPALL, {"materials": [{"name": "s", "set": "a", "preset": "concrete-hjc"}]}),
])
def test_what_the_program_takes_is_valid(path, changes):
    assert wrong(changed(path, changes)) == set()


@pytest.mark.parametrize("table, good", [
    ([[0, 0], [1e-6, 1]], True), ("pulse.csv", True), ({"points": [[0, 0], [1, 1]], "smooth": True}, True), ({"file": "a.csv"}, True),
    ([[0, 0]], False), ([[0], [1]], False), ({"points": [[0, 0], [1, 1]], "smooth": 1}, False), ({"table": "a.csv"}, False), (3, False)])
def test_tables(table, good):
    assert validator().is_valid({**rhegma.read_case(CASES[0]), "tables": {"f": table}}) == good


# ---- the examples ----


def uses(node, path=""):
    """Keys that a case gives, as the reference writes them."""
    if isinstance(node, dict):
        for key, value in node.items():
            yield from uses(value, f"{path}.{key}" if path else key)
    elif isinstance(node, list) and any(isinstance(value, dict) for value in node):
        for value in node:
            yield from uses(value, f"{path}[]")
    yield path


def test_each_key_of_loads_and_supports_is_in_an_example():
    """Of vectors and tensors one component; not sets, which need a mesh file where no side of a box is meant."""
    groups = ("start", "relax", "tables", "loads", "boundary", "initial", "interface.sets[].open", "interface.sets[].at", "bodies[].tied", "output.probes", "output.sensors", "output.crack_tips", "output.crack_fronts")
    keys = [line.split("`")[1] for line in said("--markdown").splitlines() if line.startswith("| `")]
    def whole(key):
        return re.sub(r"\.([xyz]|[xyz]{2})$", "", key)
    wanted = {whole(key) for key in keys if key.startswith(groups) and not key.endswith("[].set")}
    used = {whole(key) for path in (ROOT / "bench/examples").rglob("*.yaml") for key in uses(rhegma.read_case(path))}
    assert len(wanted) > 60 and wanted - used == set()
