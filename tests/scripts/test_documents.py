"""Tables in the documents that commands print from the program or from stored records: each row stands there as printed."""

import subprocess
import sys

import pytest
from conftest import PROGRAM, ROOT, SINGLE

RECORDS = ROOT / "perf/results"
PRINTED = {
    "time of a step": ("README.md", "perf/table", RECORDS / "2026-11-22-epyc-2core-tiles.json"),
    "efficiency": ("README.md", "perf/table", RECORDS / "2026-11-22-epyc-2core-efficiency.json"),
    "scaling": ("README.md", "bench/scaling", "plot", RECORDS, "--out", "{out}/picture"),
    "simulated clusters": ("README.md", "perf/simulate", "table", RECORDS / "2026-11-22-simulated.json"),
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
    assert missing_rows("perf/model.md", said) == []
