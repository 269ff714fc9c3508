"""What `meson install` puts where, under a DESTDIR and a prefix, and that it works from there."""

import os
import re
import subprocess

import pytest
from conftest import ENVIRONMENT, PROGRAM, ROOT, SINGLE, TIMEOUT

FILES = """bin/rhegma bin/rhegma-plot bin/rhegma-convert share/rhegma/plot share/rhegma/convert share/rhegma/rhegma.py share/rhegma/case.schema.json share/rhegma/examples/spall/spall.yaml
    include/rhegma/user/material.c include/rhegma/user/material.h include/rhegma/element/bulk.h share/man/man1/rhegma.1 share/bash-completion/completions/rhegma""".split()


def command(*words, cwd=None, **more):
    process = subprocess.run(list(map(str, words)), env={**os.environ, **ENVIRONMENT, **more}, cwd=cwd, capture_output=True,
                             text=True, timeout=TIMEOUT)
    assert process.returncode == 0, process.stdout + process.stderr
    return process.stdout


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    root = tmp_path_factory.mktemp("root")
    command("/usr/bin/meson", "install", "-C", PROGRAM.parent, "--no-rebuild", "--destdir", root, PATH="/usr/bin:/bin")
    return next(path.parent.parent for path in root.rglob("rhegma") if path.parent.name == "bin")


def test_all_files_are_there(prefix):
    assert [name for name in FILES if not (prefix / name).is_file()] == []
    assert all(os.access(prefix / name, os.X_OK) for name in FILES if name.startswith("bin/"))
    static = [path for path in prefix.rglob("*") if path.suffix in (".a", ".o")]
    assert static == []


def test_an_installed_example_is_run_and_drawn(prefix, tmp_path):
    assert command(prefix / "bin/rhegma", "--version") == command(PROGRAM, "--version")
    case = prefix / "share/rhegma/examples/spall/spall.yaml"
    command(prefix / "bin/rhegma", "run", case, "-q", "--set", "mesh.cells=[2,2,20]", "--set", "time.steps=20", cwd=tmp_path)
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere/drawn").symlink_to(prefix / "bin/rhegma-plot")
    said = command("elsewhere/drawn", "results/spall", cwd=tmp_path)
    assert (tmp_path / "results/spall/energy.png").stat().st_size > 10000 and "energy.png" in said


def test_a_material_is_compiled_with_the_installed_headers(prefix, tmp_path):
    """And with those alone: what it was built from need not be there."""
    source = prefix / "share/rhegma/examples/user-material/softening.c"
    command(prefix / "bin/rhegma", "material", source, "-o", "softening.so", cwd=tmp_path, CC="cc -Werror -MMD")
    (needs,) = tmp_path.glob("*.d")
    assert f"{prefix}/bin/../include/rhegma/element/bulk.h" in needs.read_text() and str(ROOT) not in needs.read_text()
    case = prefix / "share/rhegma/examples/user-material/user-material.yaml"
    said = command(prefix / "bin/rhegma", "check", case, "--set", f"material.library={tmp_path}/softening.so")
    assert "library        softening of " in said


def test_the_schema_is_the_programs(prefix):
    assert (prefix / "share/rhegma/case.schema.json").read_text() == command(PROGRAM, "keys", "--schema")


@pytest.mark.skipif(SINGLE, reason="once is enough")
def test_the_page_and_the_completion_name_every_option(prefix):
    """Of those that the usage names."""
    usage = "".join(command(PROGRAM, word, "--help") for word in ("run", "check", "verify", "export", "keys", "material", "mesh"))
    options = set(re.findall(r"(?<![\w-])--?[a-z][\w-]*", usage)) - {"-n", "-language-server"}
    page = (prefix / "share/man/man1/rhegma.1").read_text().replace("\\-", "-")
    completion = (ROOT / "bench/install/rhegma.bash").read_text()
    assert {"--set", "--walltime", "--improve"} <= options
    assert [option for option in options if option not in page and option not in ("--help", "--version")] == []
    assert [option for option in options if option not in completion and option not in ("-q",)] == []


def complete(prefix, *words, **environment):
    script = (f". {prefix}/share/bash-completion/completions/rhegma; COMP_WORDS=({' '.join(words)}); COMP_CWORD={len(words) - 1}; "
              "_rhegma; printf '%s\\n' \"${COMPREPLY[@]}\"")
    return command("bash", "-c", script, **environment).split()


def test_completion(prefix):
    assert complete(prefix, "rhegma", "r") == ["run"]
    assert complete(prefix, "rhegma", "run", "--re") == ["--restart"]
    assert complete(prefix, "rhegma", "check", "--re") == []
    assert complete(prefix, "rhegma", "keys", "--s") == ["--schema"]
    path = f"{prefix}/bin:{os.environ['PATH']}"
    assert complete(prefix, "rhegma", "keys", "time.s", PATH=path) == ["time.safety", "time.steps"]
    assert complete(prefix, "rhegma", "run", "--set", "time.e", PATH=path) == ["time.end="]
