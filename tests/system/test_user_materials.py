"""Materials of the user's own: compiled by `rhegma material`, loaded by a case, checked, and the same as the program's own."""

import os
import shutil

import numpy as np
import pytest
from conftest import CASES, ROOT, SINGLE, example, launch, overrides
from test_parallel import FRAGMENTS, LAYOUTS, assert_same_bits
from test_restart import go_on

SOURCES = ROOT / "tests/inputs/user"
double_only = pytest.mark.skipif(SINGLE, reason="J2 plasticity needs double precision")
LAWS = ("linear", "plateau")
SOLID = {"density": 3690, "young": 260e9, "poisson": 0.21}
METAL = {**SOLID, "hardening": 20e9}


def compiled(source, library, *options, **environment):
    process = launch("material", source, "-o", library, *options, **environment)
    assert process.returncode == 0, process.stderr
    return process.stdout


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """library(name): the library of that file."""
    folder, made = tmp_path_factory.mktemp("libraries"), {}

    def make(name):
        if name not in made:
            made[name] = folder / f"{name}.so"
            source = example("user-material.yaml").with_name(f"{name}.c") if name in ("softening", "plateau") else SOURCES / f"{name}.c"
            assert name.replace("_", "-") in compiled(source, made[name], *(["--law"] if name in LAWS else []))
        return made[name]

    return make


def user(library, **parameters):
    return {"material": {"model": "user", "library": str(library), **parameters}}


@pytest.mark.parametrize("ranks, threads", [(1, 1), *LAYOUTS])
def test_a_copy_of_a_solid_gives_its_bits(run, library, ranks, threads):
    """Beside one of the program's own: tiles of blocks of both."""
    more = {**FRAGMENTS, "materials": [{"name": "other", "where": "x > 0", "model": "st-venant-kirchhoff", **SOLID}]}
    one = run(CASES / "fragments.yaml", sets={**more, "material": {"model": "neo-hookean", **SOLID}})
    other = run(CASES / "fragments.yaml", ranks=ranks, threads=threads, sets={**more, **user(library("neo_hookean"), **SOLID)})
    assert one.summary["failed_area_m2"] > 0
    assert_same_bits(one, other)


@double_only
@pytest.mark.parametrize("ranks, threads", [(1, 2), (2, 1)])
def test_history_goes_through_a_restart(run, library, tmp_path, ranks, threads):
    sets = {**FRAGMENTS, "checkpoint.steps": 40}
    one = run(CASES / "fragments.yaml", sets={**sets, "material": {"model": "j2", "yield_stress": 300e6, **METAL}})
    mine = {**sets, **user(library("j2"), **{"yield": 300e6}, **METAL)}
    before = run(CASES / "fragments.yaml", ranks=2, sets={**mine, "time.steps": 95})
    folder = shutil.copytree(before.dir, tmp_path / "out")
    for last in folder.glob("checkpoints/step-*95.h5"):
        last.unlink()
    again = go_on(folder, "--set", "time.steps=100000", ranks=ranks, threads=threads)
    assert again.summary["restarted_from_step"] == 80 and one.summary["plastic_J"] > 0
    assert_same_bits(one, again)


@double_only
@pytest.mark.parametrize("start", ["static", "relax"])
def test_a_history_starts_from_rest(run, library, tmp_path, start):
    """As that of the program's own metal: within its limit, and refused beyond it."""
    sets = {**FRAGMENTS, "mesh.cells": [2, 2, 4], "mesh.size": [0.4e-3, 0.4e-3, 0.8e-3], "output.probes": [{"name": "a", "at": [1e-5, 3e-5, -1e-3]}], "time.steps": 10, "start": start, "initial.velocity": {"x": 0, "y": 0, "z": 0}, "interface": {"law": "none"},
            "boundary": [{"set": "z-", "component": component, "displacement": 0} for component in "xyz"]}
    load = lambda pull: [{"set": "z+", "traction": {"x": 0.01 * pull, "z": pull}}]  # noqa: E731
    mine = {**sets, **user(library("j2"), **{"yield": 300e6}, **METAL)}
    one = run(CASES / "fragments.yaml", sets={**sets, "loads": load(1e8), "material": {"model": "j2", "yield_stress": 300e6, **METAL}})
    other = run(CASES / "fragments.yaml", ranks=2, sets={**mine, "loads": load(1e8)})
    assert one.energy["bulk"][0] > 0 and one.energy["plastic"][-1] == 0
    assert_same_bits(one, other)
    refused = launch("run", CASES / "fragments.yaml", "-q", *overrides({**mine, "loads": load(4e8)}), "-o", tmp_path / "out")
    assert refused.returncode == 2 and f"start: {start}: beyond the limit of what flows in element" in refused.stderr, refused.stderr


@double_only
def test_a_restart_wants_the_same_library(run, library, tmp_path):
    copy = shutil.copy(library("j2"), tmp_path / "mine.so")
    sets = {**FRAGMENTS, "time.steps": 4, "checkpoint.steps": 2, **user(copy, **{"yield": 300e6}, **METAL)}
    process = launch("run", CASES / "fragments.yaml", "-q", *overrides(sets), "-o", tmp_path / "out")
    assert process.returncode == 0, process.stderr
    with open(copy, "ab") as file:
        file.write(b"another")
    process = launch("run", "--restart", tmp_path / "out", "-q")
    assert process.returncode == 2 and process.stderr.count("mine.so") == 2, process.stderr
    assert "the case is not that of the checkpoint" in process.stderr and "material.library: " in process.stderr


def user_law(library, **parameters):
    return {"interface.law": "user", "interface.library": str(library), "interface.parameters": parameters, "interface.activation": "continuous",
            "interface.contact": "potential", "interface.friction": 0.3, "interface.beta_s": 2}


@pytest.mark.parametrize("ranks, threads", [(1, 1), *LAYOUTS])
def test_a_copy_of_a_law_gives_its_bits(run, library, ranks, threads):
    sets = {**FRAGMENTS, "time.end": 0.15e-6, "interface.sets": [{"where": "x > 0", "energy": 20, "strength": 3e8}]}
    mine = user_law(library("linear"))
    one = run(CASES / "fragments.yaml", sets={**sets, **{key: value for key, value in mine.items() if key[10:] not in ("law", "library", "parameters")}})
    other = run(CASES / "fragments.yaml", ranks=ranks, threads=threads, sets={**sets, **mine})
    assert one.summary["failed_area_m2"] > 0
    assert_same_bits(one, other)


def test_a_law_goes_through_a_restart(run, library, tmp_path):
    sets = {**FRAGMENTS, "time.end": 0.15e-6, "checkpoint.steps": 20, **user_law(library("plateau"), plateau=0.2)}
    one = run(CASES / "fragments.yaml", sets=sets)
    before = run(CASES / "fragments.yaml", ranks=2, sets={**sets, "time.steps": 70})
    assert 0 < before.summary["broken_area_m2"]
    folder = shutil.copytree(before.dir, tmp_path / "out")
    for last in folder.glob("checkpoints/step-*70.h5"):
        last.unlink()
    again = go_on(folder, "--set", "time.steps=100000")
    assert again.summary["restarted_from_step"] == 60
    assert_same_bits(one, again)


def test_laws_that_do_not_fit(library):
    said = check(user_law(library("plateau"), plateau=0.5)).stdout
    assert "law            plateau of " in said and "opening takes 1 of the energy, " in said
    assert "interface.plateau: 0.95: out of range" in refused(user_law(library("plateau"), plateau=0.95))
    assert "interface.platau: unknown parameter of plateau; did you mean 'plateau'?" in refused(user_law(library("plateau"), platau=0.5))
    assert "linear: what it dissipates and stores differs from the work of opening by 0.1 of the energy" in refused(user_law(library("linear"), wrong=1.1))
    assert "of a material, not of a law" in refused(user_law(library("neo_hookean")))
    assert "of a law, not of a material" in refused(user(library("linear"), **SOLID))
    assert "needs a law that starts rigid" in refused({**user_law(library("plateau")), "interface.activation": "conserving"})


def check(sets):
    return launch("check", CASES / "fragments.yaml", *overrides({**FRAGMENTS, **sets}))


def test_what_the_checks_found_is_told(library):
    said = check(user(library("softening"), threshold=1e5, scale=1e5, **SOLID)).stdout
    assert "library        softening of " in said and "checked        stress the derivative of the energy to " in said
    assert "which it sets free" in said


def refused(sets):
    process = check(sets)
    assert process.returncode == 2 and process.stdout == ""
    return process.stderr


def patched(library, path, at, value):
    """The library with another number in its head."""
    data = bytearray(library.read_bytes())
    head = data.index(b"rhegma-user\0\0\0\0\0material\0")
    data[head + at:head + at + 4] = np.int32(value).tobytes()
    path.write_bytes(data)
    return path


def test_libraries_that_do_not_fit(library, tmp_path):
    good = library("neo_hookean")
    assert "no.so: cannot be loaded: " in refused(user(tmp_path / "no.so", **SOLID))
    (tmp_path / "text.so").write_text("no library")
    assert "cannot be loaded: " in refused(user(tmp_path / "text.so", **SOLID))
    assert "made for ABI 77, layout " in refused(user(patched(good, tmp_path / "abi.so", 32, 77), **SOLID))
    said = refused(user(patched(good, tmp_path / "layout.so", 36, 5), **SOLID))
    assert ", layout 5, and this program has ABI " in said and "rhegma material" in said
    here, there = ("single", "double") if SINGLE else ("double", "single")
    said = refused(user(patched(good, tmp_path / "real.so", 44, 8 if SINGLE else 4), **SOLID))
    assert f"computes in {there} precision, and this program in {here}" in said


def test_a_library_for_other_vectors(tmp_path):
    narrow, wide = ("x86-64-v2", 16), ("x86-64-v3", 32)
    if "avx2" not in open("/proc/cpuinfo").read():
        pytest.skip("this machine has no others")
    said = compiled(SOURCES / "neo_hookean.c", tmp_path / "narrow.so", "--isa", narrow[0])
    assert said.startswith(f"{tmp_path}/narrow.so: for x86-64-v2, ")
    process = launch("check", CASES / "fragments.yaml", *overrides({**FRAGMENTS, **user(tmp_path / "narrow.so", **SOLID)}), RHEGMA_ISA=wide[0])
    assert process.returncode == 2
    assert "made for x86-64-v2, vectors of 16 bytes, and this run is on x86-64-v3, vectors of 32 bytes" in process.stderr


@pytest.mark.parametrize("change, complaint", [
    ({"yung": 1}, "material.yung: unknown parameter of neo-hookean; did you mean 'young'?"),
    ({"colour": 1}, "material.colour: unknown parameter of neo-hookean; allowed: young, poisson, wrong"),
    ({"young": None}, "material.young: missing; allowed: number > 0 (Pa)"),
    ({"young": -1}, "material.young: -1: out of range; allowed: number > 0 (Pa)"),
    ({"poisson": "soft"}, "not a number; allowed: number > 0 and < 0.5"),
    ({"wrong": 1.1}, "neo-hookean: the stress is not the derivative of the energy: they differ by 0."),
    ({"density": None}, "material.density: missing"),
    ({"library": None}, "material.library: missing"),
])
def test_parameters_are_read_strictly(library, change, complaint):
    block = {**user(library("neo_hookean"), **SOLID)["material"], **change}
    assert complaint in refused({"material": {key: value for key, value in block.items() if value is not None}})


def test_parameters_may_stand_below_a_key(library):
    block = {"model": "user", "library": str(library("neo_hookean")), "density": 3690, "parameters": {"young": 260e9}}
    assert check({"material": block}).returncode == 0
    assert "material.yung: unknown parameter" in refused({"material": {**block, "parameters": {"yung": 1}}})


def test_the_example(run, library):
    result = run(example("user-material.yaml"), sets={"material.library": str(library("softening")), "mesh.cells": [1, 1, 10]})
    assert result.summary["damage_J"] > 0 and result.summary["broken_area_m2"] > 0
    assert abs(result.summary["energy_error_rel"]) < 0.02


@pytest.mark.parametrize("arguments, complaint", [
    ([], "no file given"), (["a.c", "b.c"], "one file at a time; not understood: b.c"), (["a.c", "-o"], "missing value after: -o"),
    (["--frob"], "unknown option: --frob"), (["a.c", "--isa", "z80"], "no such instruction set: z80"), (["nowhere.c"], "nowhere.c: No such file")])
def test_wrong_arguments(arguments, complaint):
    process = launch("material", *arguments)
    assert process.returncode == 2 and process.stdout == "" and complaint in process.stderr


def test_what_the_compiler_says_is_shown(tmp_path):
    (tmp_path / "wrong.c").write_text('#include "user/material.h"\nnonsense;\n#define RG_HISTORY 0\n')
    process = launch("material", tmp_path / "wrong.c")
    assert process.returncode == 2 and "wrong.c:2:" in process.stderr and os.listdir(tmp_path) == ["wrong.c"]
    process = launch("material", SOURCES / "j2.c", "-o", tmp_path / "j2.so", CC="no-compiler")
    assert process.returncode == 2 and "no-compiler: No such file or directory; CC names the C compiler" in process.stderr
