"""Abaqus and CalculiX decks, written at random from a known mesh in all ways that the manuals allow: nothing is lost."""

import itertools
import json
import os
import random

import h5py
import numpy as np
import pytest
from conftest import launch

DECKS = int(os.environ.get("RHEGMA_DECKS", 200))

# 8 cubes of 6 tetrahedra: node 1 + i + 3 j + 9 k at (i, j, k), element 1 + t + 6 (i + 2 j + 4 k).
NODES = {1 + i + 3 * j + 9 * k: (i, j, k) for k, j, i in itertools.product(range(3), repeat=3)}
STRIDE = (1, 3, 9)
CELL = [(1, 1 + STRIDE[a], 1 + STRIDE[a] + STRIDE[b], 14) for a, b in itertools.permutations(range(3), 2)]
SHIFTS = [i + 3 * j + 9 * k for k, j, i in itertools.product(range(2), repeat=3)]
ELEMENTS = {1 + t + 6 * c: tuple(n + s for n in CELL[t]) for c, s in enumerate(SHIFTS) for t in range(6)}
FACES = [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]  # S1 to S4
VOLUMES = {"low": range(1, 25), "up": range(25, 49), "odd": range(1, 49, 2), "all": range(1, 49), "one part": [7, 8, 31]}
PLANES = {"bottom": (2, 0), "top": (2, 2), "side": (0, 0)}  # surfaces by elements and faces


def corners(element, face):
    return [ELEMENTS[element][i] for i in FACES[face]]


def on_plane(nodes, axis, value):
    return all(NODES[n][axis] == value for n in nodes)


def is_outer(nodes):
    return any(on_plane(nodes, axis, value) for axis in range(3) for value in (0, 2))


SIDES = [(e, f) for e in ELEMENTS for f in range(4) if is_outer(corners(e, f))]
SURFACES = {name: [(e, f) for e, f in SIDES if on_plane(corners(e, f), *plane)] for name, plane in PLANES.items()}
NODE_SETS = {"left": [n for n, x in NODES.items() if x[1] == 0], "corner": [n for n, x in NODES.items() if max(x) <= 1]}


class Deck:
    """Writes the mesh; `copies` instances of it, each 5 m above the one before."""

    def __init__(self, folder, seed):
        self.r = random.Random(seed)
        self.folder = folder
        self.files = 0
        self.copies = self.r.choice([0, 0, 1, 2])  # 0: without parts
        self.end = self.r.choice(["\n", "\n", "\r\n"])
        self.path = folder / f"deck{seed}.inp"

    def chance(self, probability=0.3):
        return self.r.random() < probability

    def keyword(self, text):
        """In any case, with blanks, over several lines; `text` has its words between commas."""
        words = [w.strip() for w in text.split(",")]
        case = self.r.choice([str, str.upper, str.title])
        for k, word in enumerate(words):
            name, equals, value = word.partition("=")
            value = case(value) if name == "type" else value
            words[k] = case(name) + (self.r.choice(["=", " = ", "=\t"]) if equals else "") + value
        words = [w + self.r.choice(["", "", " "]) for w in words]
        line = ""
        for k, word in enumerate(words):
            line += ("" if k == 0 else ",\n" + self.r.choice(["", " ", "** between\n"]) if self.chance(0.2) else ", ") + word
        return self.r.choice(["", "", " ", "\t"]) + self.r.choice(["*", "*", "* "]) + line + "\n"

    def number(self, x):
        x = float(x)
        if x == 0 and self.chance(0.2):
            return ""
        form = self.r.choice(["{:g}", "{:.3f}", "{:.17e}", "{:+.2e}"]).format(x)
        return form.replace("e", self.r.choice("eEdD")) if float(form) == x else repr(x)

    def row(self, words):
        words = [str(w) for w in words]
        while words and words[-1] == "" and self.chance():
            words.pop()
        glue = self.r.choice([", ", ",", " ,\t"])
        return self.r.choice(["", "", "  "]) + glue.join(words) + self.r.choice(["", "", ","]) + "\n"

    def rows(self, words, each=8):
        words = list(words)
        return "".join(self.row(words[i:i + each]) for i in range(0, len(words), each))

    def noise(self):
        return self.r.choice(["", "", "** a remark\n", "**\n", "\n", "*MATERIAL, NAME=m\n*ELASTIC\n1., 0.3\n", "*Density\n7.8D-9,\n"])

    def elsewhere(self, text):
        """In a file of its own."""
        self.files += 1
        name = f"{self.path.stem}-{self.files}.inc"
        (self.folder / name).write_bytes(text.replace("\n", self.end).encode("latin-1"))
        return name

    def block(self, keyword, data):
        if data and self.chance(0.15):
            return self.keyword(f"{keyword}, input={self.elsewhere(data)}") if self.chance(0.5) else (
                self.keyword(keyword) + f"*include, input={self.elsewhere(data)}\n")
        whole = self.keyword(keyword) + data
        return f"*INCLUDE, INPUT={self.elsewhere(whole)}\n" if self.chance(0.1) else whole

    # ---- nodes ----

    def nodes(self):
        kind = self.r.choice(["plain", "plain", "shifted", "turned", "cylinder", "sphere", "ngen", "nfill"])
        if kind == "ngen":
            ends = [n for n, x in NODES.items() if x[0] != 1]
            return self.block("node", self.place(ends)) + self.block("ngen", "".join(
                self.row([a, a + 2] if self.chance() else [a, a + 2, 1]) for a in range(1, 27, 3)))
        if kind == "nfill":
            low, high = ([n for n, x in NODES.items() if x[2] == z] for z in (0, 2))
            text = self.block("node, nset=_low" if self.chance() else "node", self.place(low)) + self.block("node", self.place(high))
            text += self.block("nset, nset=_low, internal", self.rows(low)) + self.block("nset, nset=_high, internal, generate", "19, 27\n")
            return text + self.block("nfill", self.row(["_low", "_high", 2, 9]))
        numbers = list(NODES)
        self.r.shuffle(numbers)
        cut = self.r.randrange(1, 26)
        return "".join(self.block(self.system(kind), self.place(part, kind)) if kind not in ("shifted", "turned") else
                       self.moved(kind) + self.block("node", self.place(part, kind)) + self.block("system", "")
                       for part in (numbers[:cut], numbers[cut:]))

    def system(self, kind):
        return "node" + {"cylinder": ", system=C", "sphere": ", system=S"}.get(kind, self.r.choice(["", "", ", system=R"]))

    def moved(self, kind):
        if kind == "shifted":
            return self.block("system", self.row([3, -4, 5]))
        return self.block("system", self.row([3, -4, 5, 3, -4, 7]) + self.row([3, 9, 5]))  # x, y, z become z, y, -x

    def place(self, numbers, kind="plain"):
        lines = []
        for n in numbers:
            x = np.array(NODES[n], float)
            if kind == "shifted":
                x -= (3, -4, 5)
            elif kind == "turned":
                x = (x - (3, -4, 5)) @ np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]).T
            elif kind == "cylinder":
                x = np.array([np.hypot(x[0], x[1]), np.degrees(np.arctan2(x[1], x[0])), x[2]])
            elif kind == "sphere":
                flat = np.hypot(x[0], x[1])
                x = np.array([np.hypot(flat, x[2]), np.degrees(np.arctan2(x[1], x[0])), np.degrees(np.arctan2(x[2], flat))])
            lines.append(self.row([n, *map(self.number, x)]))
        return "".join(lines)

    # ---- elements ----

    def elements(self):
        kind = self.r.choice(["plain", "plain", "elgen", "elcopy"])
        types = ["C3D4", "c3d4h", "DC3D4", "AC3D4", "C3D4T"]
        if kind == "elgen":
            text = self.block(f"element, type={self.r.choice(types)}", "".join(self.tet(e) for e in range(1, 7)))
            return text + self.block("elgen", "".join(self.row([e, 2, 1, 6, 2, 3, 12, 2, 9, 24]) for e in range(1, 7)))
        if kind == "elcopy":
            text = self.block(f"element, type={self.r.choice(types)}, elset=low", "".join(self.tet(e) for e in range(1, 25)))
            return text + self.keyword("elcopy, old set=low, element shift=24, shift nodes=9, new set=up")
        numbers = list(ELEMENTS)
        self.r.shuffle(numbers)
        cut = self.r.randrange(1, 48)
        return "".join(self.block(f"element, type={self.r.choice(types)}" + self.r.choice(["", ", elset=all"]),
                                  "".join(self.tet(e) for e in part)) for part in (numbers[:cut], numbers[cut:]))

    def tet(self, e):
        words = [e, *ELEMENTS[e]]
        cut = self.r.randrange(1, 5) if self.chance(0.1) else 5
        first = ", ".join(map(str, words[:cut])) + (",\n" if cut < 5 else "")
        return first + self.row(words[cut:]) if cut < 5 else self.row(words)

    # ---- sets ----

    def sets(self):
        text = []
        for name, members in VOLUMES.items():
            label, members = f'"{name}"' if " " in name else name, list(members)
            if len(members) > 3 and self.chance(0.5):
                text.append(self.block(f"elset, elset={label}, generate", self.row([members[0], members[-1], members[1] - members[0]])))
            elif name == "all" and self.chance(0.7):
                text.append(self.block("elset, elset=all", self.row(["low", "up"])))
            else:
                self.r.shuffle(members)
                text.append(self.block(f"elset, elset={label}", self.rows(members)))
        for name, nodes in NODE_SETS.items():
            text.append(self.block(f"nset, nset={name}", self.rows(nodes)) if self.chance(0.7) else
                        self.block(f"surface, type=node, name={name}", "".join(self.row([n]) for n in nodes)))
        for name, sides in SURFACES.items():
            text.append(self.surface(name, sides))
        text.append(self.block("surface, name=skin", self.row(["all", ""])))
        self.r.shuffle(text)
        return self.noise().join(text)

    def surface(self, name, sides):
        by_face = {f: [e for e, g in sides if g == f] for f in range(4)}
        text, data = "", ""
        for f, members in by_face.items():
            if members and self.chance(0.5):
                text += self.block(f"elset, elset=_{name}_S{f + 1}, internal", self.rows(members))
                data += self.row([f"_{name}_S{f + 1}", f"S{f + 1}"])
            else:
                data += "".join(self.row([e, f"s{f + 1}"]) for e in members)
        head = self.block(f"surface, type=element, name={name}", data)
        return text + head if self.chance(0.5) else head + text

    # ---- the whole ----

    def write(self):
        body = [self.nodes(), self.elements()]
        if "ngen" not in body[1].lower() and "elcopy" not in body[1].lower() and self.chance():
            body.reverse()
        text = self.noise().join([*body, self.sets()])
        if self.copies > 0:
            text = self.keyword("part, name=body") + text + self.keyword("end part") + self.keyword("assembly, name=a")
            for c in range(self.copies):
                text += self.keyword(f"instance, name=body-{c}, part=body") + (self.row([0, 0, 5 * c]) if c > 0 else "")
                text += (self.row([1, 1, 0, 1, 1, 1, 360]) if c > 0 and self.chance() else "") + self.keyword("end instance")
            text += "*NODE\n1, 7., 7., 7.\n" + self.keyword("end assembly")
        text = "*HEADING\n a deck, 1, 2, 3\n** gr\xf6\xdfe\n" + text + "*STEP\n*STATIC\n*BOUNDARY\nleft, 1\n*END STEP\nand more\n"
        self.path.write_bytes(text.replace("\n", self.end).encode("latin-1"))
        return self.path


def expected(copies):
    """Sets of volumes and surfaces by name, elements and faces by their corners in m."""
    volumes, surfaces = {}, {}
    for c in range(max(copies, 1)):
        prefix = f"body-{c}." if copies > 1 else ""
        place = {n: (x, y, z + 5 * c) for n, (x, y, z) in NODES.items()}
        tet = {e: frozenset(place[n] for n in nodes) for e, nodes in ELEMENTS.items()}
        for name, members in {**VOLUMES, "": ELEMENTS}.items():
            volumes.setdefault(prefix + name if name else "", set()).update(tet[e] for e in members)
        sides = {(e, f): (tet[e], frozenset(place[n] for n in corners(e, f))) for e, f in SIDES}
        for name, members in {**SURFACES, "skin": SIDES}.items():
            surfaces[prefix + name] = {sides[s] for s in members}
        for name, nodes in NODE_SETS.items():
            surfaces[prefix + name] = {sides[s] for s in SIDES if set(corners(*s)) <= set(nodes)}
    return volumes, surfaces


def found(path, rounding=1e-14):
    """The same of a mesh file."""
    with h5py.File(path) as file:
        x = np.zeros((file.attrs["vertices"], 3))
        x[file["vertex"][:]] = file["x"][:]
        assert abs(x - x.round()).max() < rounding  # sines and cosines of what is not a quarter
        tets = [frozenset(map(tuple, x[c].round())) for c in file["corner"][:]]
        place = [[tuple(p) for p in x[c].round()] for c in file["corner"][:]]
        volumes, surfaces = {"": set(tets)}, {}
        for kind, sets, group in (("volume", volumes, file["region"][:][:, None]), ("surface", surfaces, file["set"][:])):
            names = [n.decode() for n in file[f"{kind}_sets"][:]] if f"{kind}_sets" in file else []
            combined = {}
            for c, s in file[f"{kind}_combinations"][:] if f"{kind}_combinations" in file else []:
                combined.setdefault(len(names) + c, []).append(names[s])
            for name in names:
                sets[name] = set()
            for e, f in np.argwhere(group >= 0):
                for name in combined.get(group[e, f]) or [names[group[e, f]]]:
                    face = frozenset(p for i, p in enumerate(place[e]) if i != f)
                    sets[name].add(tets[e] if kind == "volume" else (tets[e], face))
    return volumes, surfaces


@pytest.mark.parametrize("first", range(0, DECKS, 10))
def test_decks_at_random(tmp_path, first):
    for seed in range(first, first + 10):
        deck = Deck(tmp_path, seed)
        process = launch("mesh", deck.write(), "-o", tmp_path / "deck.h5")
        assert process.returncode == 0, (seed, process.stderr, deck.path.read_text("latin-1")[:3000])
        for told, right in zip(found(tmp_path / "deck.h5"), expected(deck.copies)):
            assert told.keys() == right.keys(), seed
            for name in right:
                assert told[name] == right[name], (seed, name)


# ---- Runs on sets that overlap ----


@pytest.fixture(scope="module")
def meshes(scratch):
    """One body; in the second file the surfaces overlap each other, the skin and a plane inside, and so do the volumes."""
    head = "*NODE\n" + "".join(f"{n}, {x}, {y}, {z}\n" for n, (x, y, z) in NODES.items()) + "*ELEMENT, TYPE=C3D4, ELSET=all\n" + (
        "".join(f"{e}, {', '.join(map(str, nodes))}\n" for e, nodes in ELEMENTS.items()))
    sides = {name: f"*SURFACE, NAME={name}\n" + "".join(f"{e}, S{f + 1}\n" for e, f in SURFACES[name]) for name in SURFACES}
    more = "*ELSET, ELSET=up, GENERATE\n25, 48\n*SURFACE, NAME=skin\nall,\n*SURFACE, NAME=ends\n" + "".join(
        f"{e}, S{f + 1}\n" for name in ("top", "bottom") for e, f in SURFACES[name])
    middle = "".join(f"{e}, S{f + 1}\n" for e in VOLUMES["low"] for f in range(4) if on_plane(corners(e, f), 2, 1))
    more += f"*SURFACE, NAME=middle\n{middle}*SURFACE, NAME=mixed\n{middle}" + "".join(f"{e}, S{f + 1}\n" for e, f in SURFACES["top"])
    files = []
    for name, text in (("apart", head + "".join(sides.values())), ("over", head + more + "".join(sides.values()))):
        (scratch / f"{name}.inp").write_text(text)
        process = launch("mesh", scratch / f"{name}.inp", "-o", scratch / f"{name}.h5", "--scale", "1e-3")
        assert process.returncode == 0, process.stderr
        files.append(scratch / f"{name}.h5")
    return files


PULL = [{"set": "top", "component": "z", "velocity": 1}, {"set": "bottom", "component": "z", "velocity": -1},
        {"set": "side", "component": "x", "velocity": 0}]


def case(mesh, name, **keys):
    text = {"mesh": {"file": str(mesh)}, "material": {"model": "linear-elastic", "young": 70e9, "poisson": 0.2, "density": 2500},
            "interface": {"law": "none"}, "boundary": PULL, "time": {"end": 2e-7}, **keys}
    path = mesh.with_name(f"{mesh.stem}-{name}.yaml")
    path.write_text(json.dumps(text))
    return path


PLATE = {"name": "plate", "shape": "plane", "motion": "prescribed", "at": [0, 0, 2e-3], "normal": [0, 0, -1],
         "velocity": {"z": -10}, "faces": ["top"]}


@pytest.mark.parametrize("name, keys", [("held", {}), ("touched", {"boundary": PULL[1:], "bodies": [PLATE]})])
def test_sets_that_overlap_act_like_others(run, meshes, name, keys):
    """Sides held, and a body that touches one of them: the same bits, whatever other sets their faces are in."""
    apart, over = (run(case(mesh, name, **keys), ranks=2) for mesh in meshes)
    assert (apart.dir / "energy.csv").read_bytes() == (over.dir / "energy.csv").read_bytes()
    assert float((apart.dir / "energy.csv").read_text().splitlines()[-1].split(",")[2]) > 0  # it moves


def test_a_surface_inside(run, meshes):
    """Named, it is what an expression selects; a boundary takes the faces of its set that are on the surface."""
    law = {"law": "linear", "strength": 1e9, "energy": 10}
    where, named = ({"interface": {**law, "sets": [{**plane, "open": True}]}, "boundary": [{"set": top, "component": "z", "velocity": 1}, *PULL[1:]]}
                    for plane, top in (({"where": "abs(z - 1e-3) < 1e-9"}, "top"), ({"set": "middle"}, "mixed")))
    apart, over = run(case(meshes[0], "where", **where), ranks=2), run(case(meshes[1], "named", **named), ranks=2)
    assert (apart.dir / "energy.csv").read_bytes() == (over.dir / "energy.csv").read_bytes()
    whole = run(case(meshes[0], "whole", **where | {"interface": law}), ranks=2)
    assert apart.energy["kinetic"][-1] != whole.energy["kinetic"][-1]
    said = launch("mesh", "--info", meshes[1]).stdout
    assert "middle: 0 faces, and 8 between elements\n" in said and "mixed: 8 faces, and 8 between elements\n" in said
    said = launch("check", case(meshes[1], "held inside", boundary=[{"set": "middle", "component": "z", "velocity": 1}]))
    assert said.returncode == 2 and said.stderr.endswith("boundary[0]: no face of the surface is in it, set: middle\n")
    said = launch("check", case(meshes[1], "unknown", interface={**law, "sets": [{"set": "midle", "open": True}]}))
    assert said.returncode == 2 and "interface.sets[0].set: midle: " in said.stderr and said.stderr.endswith("did you mean 'middle'?\n")


def test_conditions_that_contradict(meshes):
    said = launch("check", case(meshes[1], "twice", boundary=[*PULL, {"set": "ends", "component": "z", "velocity": 0}]))
    assert said.returncode == 2 and said.stderr.endswith(
        "boundary[0] and boundary[3] both prescribe component z of 8 faces, which are in sets 'top' and 'ends'\n")
    said = launch("check", case(meshes[1], "once", boundary=[*PULL, {"set": "skin", "component": "y", "velocity": 0}]))
    assert said.returncode == 0, said.stderr
