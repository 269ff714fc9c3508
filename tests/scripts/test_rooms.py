"""Includes run one way: from a room of src to itself and to those before it, from src to kernels, never back; and neither a
room nor a file needs itself by way of others."""

import graphlib
import pathlib
import re

import pytest
from conftest import ROOT

# From the bottom up; src/meson.build builds them in this order. "" is src itself, the doors.
SRC = ["base", "case", "mesh", "mesh/import", "mesh/improve", "partition", "domain", "contact", "solver", "diagnostics", "output",
       "restart", "verify", ""]
# Where the contract and the registries of laws and materials lie: all rooms of kernels and it know each other.
ROOT_OF_KERNELS = {pathlib.Path("kernels")}


def includes(root):
    """What each source or header of kernels and src includes of them, as paths."""
    found = {}
    for top in ("kernels", "src"):
        for path in sorted((root / top).rglob("*.[ch]")):
            for name in re.findall(r'^ *# *include "([^"]+)"', path.read_text(), re.M):
                target = next((base / name for base in (path.parent, root / "kernels", root / "src") if (base / name).is_file()), None)
                assert target is not None or name in ("revision.h", "version.h"), f"{path}: {name} is not there"
                if target is not None:
                    found.setdefault(path.relative_to(root), []).append(target.relative_to(root))
    return found


def room(path):
    return "/".join(path.parts[1:-1])


def cycle(needs):
    """What needs itself by way of others, told; none: nothing."""
    try:
        graphlib.TopologicalSorter(needs).prepare()
    except graphlib.CycleError as error:
        return ["cycle: " + " needs ".join(map(str, reversed(error.args[1])))]
    return []


def faults(root):
    """What runs against the order, a line each."""
    found, rooms, files = [], {}, {}
    for path, targets in includes(root).items():
        for target in targets:
            if path.parts[0] == "kernels":
                good = target.parts[0] == "kernels"
            else:
                good = target.parts[0] == "kernels" or SRC.index(room(target)) <= SRC.index(room(path))
            if not good:
                found.append(f"{path} includes {target}")
            files.setdefault(path, set()).add(target)
            if path.parent != target.parent and path.parts[0] == target.parts[0] == "kernels" and ROOT_OF_KERNELS.isdisjoint(
                    {path.parent, target.parent}):
                rooms.setdefault(path.parent, set()).add(target.parent)
    return found + cycle(files) + cycle(rooms)


def test_includes_run_one_way():
    assert faults(ROOT) == []


def test_rooms_are_built_in_their_order():
    built = re.findall(r"^subdir\('(\w+)'\)", (ROOT / "src/meson.build").read_text(), re.M)
    assert built == [name for name in SRC if name and "/" not in name]
    assert {path.parent for path in (ROOT / "src").rglob("*.[ch]")} == {ROOT / "src" / name for name in SRC}


@pytest.mark.parametrize("more, said", [
    ({"src/base/mem.h": "solver/tile.h"}, "src/base/mem.h includes src/solver/tile.h"),
    ({"src/mesh/mesh.h": "mesh/import/import.h"}, "src/mesh/mesh.h includes src/mesh/import/import.h"),
    ({"src/solver/tile.c": "run.h"}, "src/solver/tile.c includes src/run.h"),
    ({"kernels/tet10.h": "base/mem.h"}, "kernels/tet10.h includes src/base/mem.h"),
])
def test_an_include_against_the_order_is_told(tmp_path, more, said):
    assert said in faults(tree(tmp_path, more))


@pytest.mark.parametrize("more, members", [
    ({"kernels/cohesive/linear.h": "element/interface_face.h"}, {"kernels/cohesive", "kernels/element"}),
    ({"src/base/mem.h": "base/files.h", "src/base/files.h": "base/mem.h"}, {"src/base/mem.h", "src/base/files.h"}),
])
def test_a_cycle_is_told(tmp_path, more, members):
    assert members in [set(said.removeprefix("cycle: ").split(" needs ")) for said in faults(tree(tmp_path, more))]


def tree(root, more):
    """The sources with one more include in some of them."""
    for path in [p for top in ("kernels", "src") for p in (ROOT / top).rglob("*.[ch]")]:
        copy, name = root / path.relative_to(ROOT), str(path.relative_to(ROOT))
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text((f'#include "{more[name]}"\n' if name in more else "") + path.read_text())
    return root
