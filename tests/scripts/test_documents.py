"""Documents: each row of a table that a command prints stands there as printed; links, files and identifiers exist."""

import os
import re
import subprocess
import sys

import pytest
import yaml
from conftest import ENVIRONMENT, PROGRAM, ROOT, SINGLE

RECORDS = ROOT / "perf/results"
PRINTED = {
    "time of a step": ("perf/README.md", "perf/table", RECORDS / "2026-11-30-epyc-2core-step.json"),
    "efficiency": ("perf/README.md", "perf/table", RECORDS / "2026-11-22-epyc-2core-efficiency.json"),
    "scaling": ("perf/README.md", "bench/scaling", "plot", RECORDS, "--out", "{out}/picture"),
    "simulated clusters": ("perf/README.md", "perf/simulate", "table", RECORDS / "2026-11-22-simulated.json"),
}


def missing_rows(document, said):
    rows = [line for line in said.splitlines() if line.startswith("|")]
    assert len(rows) > 3
    there = set((ROOT / document).read_text().splitlines())
    return [row for row in rows if row not in there]


@pytest.mark.parametrize("document, script, arguments", [(d, s, a) for d, s, *a in PRINTED.values()], ids=PRINTED)
def test_tables_of_records_are_those_that_scripts_print(document, script, arguments, tmp_path):
    command = [sys.executable, ROOT / script, *(str(word).format(out=tmp_path) for word in arguments)]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert missing_rows(document, said) == []


@pytest.mark.skipif(SINGLE or not (PROGRAM.parent / "rhegma-bench").exists(), reason="needs -Dbench=true, double precision")
def test_cost_model_of_the_document_is_that_of_the_program():
    said = subprocess.run([PROGRAM.parent / "rhegma-bench", "--cost"], capture_output=True, text=True, check=True).stdout
    assert missing_rows("perf/README.md", said) == []


DOCUMENTS = sorted(path.relative_to(ROOT) for path in ROOT.rglob("*.md")
                   if not any(part.startswith((".", "build", "results")) for part in path.relative_to(ROOT).parts[:-1]))


def dead_links(document):
    """Relative links and pictures of a document whose file or heading is not there."""
    found = []
    text = re.sub(r"```.*?```", "", document.read_text(), flags=re.S)
    for link in re.findall(r"\]\(([^)\s]+)\)", text) + re.findall(r'(?:src|href)="([^"]+)"', text):
        if re.match(r"\w+:", link):
            continue
        name, _, heading = link.partition("#")
        target = document.parent / name if name else document
        if not target.exists():
            found.append(link)
        elif heading and heading not in headings(target):
            found.append(link)
    return found


def headings(document):
    """Anchors of the headings, as GitHub makes them."""
    titles = re.findall(r"^#+ (.*)", document.read_text(), re.M)
    return {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles}


def prose(document):
    """What stands in backticks, but for whole blocks of code."""
    return re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", document.read_text(), flags=re.S))


EXAMPLE = re.compile("NAME|fung|trapezoid")  # of what a reader makes


def dead_paths(document):
    """Files of this project that a document names in backticks and that are not there: from the root, from its own folder or from
    src or kernels on; the mere name of a source, anywhere."""
    tops = "|".join(("bench", "kernels", "perf", "src", "tests"))
    named = [text for text in prose(document) if re.fullmatch(rf"(?:{tops})/[\w./-]+|[\w/-]+\.[ch]", text)]
    bases = ROOT, document.parent, ROOT / "src", ROOT / "kernels"
    sources = {path.name for top in ("src", "kernels", "tests") for path in (ROOT / top).rglob("*.[ch]")}
    return [name for name in named if not EXAMPLE.search(name) and name not in sources
            and not any((folder / name).exists() for folder in bases)]


def dead_names(document, sources):
    """Identifiers of the program, rg_ or RG_, that no source has."""
    named = [name for text in prose(document) for name in re.findall(r"\b(?:rg|RG)_\w+", text) if not EXAMPLE.search(name)]
    return [name for name in named if not re.search(rf"\b{name}\b", sources)]


@pytest.fixture(scope="module")
def sources():
    return "\n".join(path.read_text() for top in ("src", "kernels") for path in sorted((ROOT / top).rglob("*.[ch]")))


@pytest.mark.parametrize("document", DOCUMENTS, ids=str)
def test_files_and_identifiers_that_documents_name_exist(document, sources):
    assert dead_paths(ROOT / document) == []
    assert dead_names(ROOT / document, sources) == []


def test_dead_files_and_identifiers_are_told(tmp_path):
    text = "`src/run.c` `src/gone.c` `gone.h` `solver/step.c` `step.c` `rg_solver` `rg_gone(x)` `rg_NAME_x`\n```\n`src/no.c`\n```"
    (tmp_path / "t.md").write_text(text)
    assert dead_paths(tmp_path / "t.md") == ["src/gone.c", "gone.h"]
    assert dead_names(tmp_path / "t.md", "rg_solver rg_gone_too") == ["rg_gone"]


@pytest.mark.parametrize("document", DOCUMENTS, ids=str)
def test_links_and_pictures_are_there(document):
    assert dead_links(ROOT / document) == []


def test_dead_links_are_told(tmp_path):
    text = "# A, b!\n[a](a.md) [b](https://b) ![c](c.png)\n[d](#a-b) [e](#e) [f](../{0}/t.md#a-b) [g](t.md#g)\n" '<a href="h.md"><img src="t.md" width="2"></a>\n'
    (tmp_path / "t.md").write_text(text.format(tmp_path.name))
    assert dead_links(tmp_path / "t.md") == ["a.md", "c.png", "#e", "t.md#g", "h.md"]


def test_each_example_has_a_readme_that_the_gallery_names():
    folders = [folder for folder in (ROOT / "bench/examples").iterdir() if folder.is_dir()]
    gallery = (ROOT / "bench/README.md").read_text()
    assert [folder.name for folder in folders if f"](examples/{folder.name}/README.md)" not in gallery] == []
    studies = [path.name for path in (ROOT / "bench/studies").iterdir() if path.is_file()]
    assert [name for name in studies if f"(studies/{name})" not in gallery] == []
    for folder in folders:  # its files are named, each picture is shown
        text, files = (folder / "README.md").read_text(), [path.name for path in folder.iterdir() if path.suffix != ".h5"]
        unshown = [name for name in files if name.endswith(".png") and f"]({name})" not in text]
        assert unshown == [] and any(name in text for name in files if name.endswith((".yaml", ".geo"))), folder


def test_front_page_is_short_and_of_this_version():
    text = (ROOT / "README.md").read_text()
    assert len(text.splitlines()) <= 150
    assert re.search(r"version = \{(.*)\}", text)[1] == re.search(r"version: '(.*?)'", (ROOT / "meson.build").read_text())[1]


def ragged_rows(document):
    """Rows of tables that have other cells than the first: a | that is not meant to part them."""
    found, cells = [], None
    for line in document.read_text().splitlines():
        count = line.replace("\\|", "").count("|") if line.startswith("|") else None
        if count is not None and cells is not None and count != cells:
            found.append(line)
        cells = count if cells is None or count is None else cells
    return found


@pytest.mark.parametrize("document", DOCUMENTS, ids=str)
def test_rows_of_tables_have_as_many_cells(document):
    assert ragged_rows(ROOT / document) == []


def test_ragged_rows_are_told(tmp_path):
    text = "| a | b |\n| --- | --- |\n| 1 | 2 |\n| $`|x|`$ | 2 |\n| `a\\|b` | 2 |\n\n| a |\n| --- |\n| 1 |\n"
    (tmp_path / "t.md").write_text(text)
    assert ragged_rows(tmp_path / "t.md") == ["| $`|x|`$ | 2 |"]


def blocks(document, language):
    return re.findall(rf"^```{language}\n(.*?)^```", (ROOT / document).read_text(), re.M | re.S)


def parts_of_cases():
    """Blocks of YAML in documents: a whole case, or some keys of one."""
    return [(str(document), text) for document in DOCUMENTS for text in blocks(document, "yaml")]


@pytest.mark.skipif(SINGLE, reason="some materials need double precision")
@pytest.mark.parametrize("document, text", parts_of_cases(), ids=lambda value: value if value.endswith(".md") else "")
def test_cases_in_documents_are_accepted(document, text, tmp_path):
    """The front page's as it is; keys of others in that, on a box around the origin."""
    case = yaml.safe_load(blocks("README.md", "yaml")[0])
    if document != "README.md":
        case["mesh"]["origin"] = [-0.2e-3, -0.2e-3, -2e-3]
        case |= yaml.safe_load(text)
    case["materials"] = [{key: value for key, value in entry.items() if key != "set"} | {"where": entry.get("where", "x > 0")}
                         for entry in case.get("materials", [])]  # there is no mesh file
    (tmp_path / "case.yaml").write_text(yaml.safe_dump(case))
    command, environment = [PROGRAM, "check", tmp_path / "case.yaml"], ENVIRONMENT | os.environ
    said = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert said.returncode == 0, said.stderr
