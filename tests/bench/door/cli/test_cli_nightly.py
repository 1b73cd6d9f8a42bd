"""The command line: its output, the files it writes, and its messages about bad input."""

import csv
import io
import json

import pytest
from test_cli_slow import USUAL_CODECS


@pytest.mark.usefixtures("gl")
def test_a_run_of_the_usual_codecs_leaves_a_results_folder(tmp_path, run):
    folder = tmp_path / "results"
    arguments = ["run", "--tables", "quality", "--count", "65536", "-o", str(folder)]
    status, out, err = run(*arguments)
    assert status == 0 and str(folder) in out, err
    rows = json.loads((folder / "quality.json").read_text())
    assert len(rows) == USUAL_CODECS * 2 * 2, "in rgba8, rg16f, rgb10a2, rg16 and 12:12"
    assert {row["normals"] for row in rows} == {"playground", "hemisphere"}
    assert all(row["skipped"] is None and row["count"] for row in rows)
    assert len(list(csv.DictReader(io.StringIO((folder / "quality.csv").read_text())))) == len(rows)
    facts = json.loads((folder / "run.json").read_text())
    assert facts["machine"]["jax"] and facts["machine"]["GL"] and facts["finished"] and facts["sources"]
    assert facts["command"] == arguments
    assert len(list((folder / "images").iterdir())) == USUAL_CODECS * 5 + 1, "and the set itself"
    assert len(list((folder / "sphere").iterdir())) == USUAL_CODECS
