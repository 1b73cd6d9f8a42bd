"""Slips in what users type: each is understood, or is a one-line error with exit status 2 that suggests a fix."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from test_slips import ONE, ROW, rows_of

from normalbench.bench.keep import capabilities


def test_a_repeated_option_without_conflict_is_accepted(run):
    assert rows_of(run, *ONE, "--count", "1000", "--codes", "--codes")[0]["count"] == 1000


def test_encodings_left_out_for_the_same_reason_share_one_line(run):
    status, _, err = run(*ROW, "--encoding", "octahedral,xyz,xyz_largest")
    assert status == 0 and err.count("\n") == 1, err
    assert err.startswith("normalbench: left out: xyz/rg8, xyz_largest/rg8: ")
    assert "3 components, but RG8 has 2 channels" in err


def test_doctor_reports_which_tables_can_be_measured(run, monkeypatch):
    monkeypatch.setattr(capabilities, "find_spec", lambda _: None)
    status, out, _ = run("doctor", "--format", "json")
    rows = {row["name"]: row["value"] for row in json.loads(out)}
    assert status == 0 and rows["quality, mix, depth, frames, vectors by JAX"] == "yes"
    missing = rows["glTF files compressed with Draco or meshoptimizer"]
    assert missing == "no: no DracoPy and no meshoptimizer; pip install normalbench[compressed]"


@pytest.mark.parametrize("typed, expected", [("xyz,oct", "xyz,octahedral"), ("optim", "optimised_rings")])
def test_a_shell_completes_names(typed, expected):
    words = f"normalbench quality --encoding {typed}"
    environment = os.environ | {"_NORMALBENCH_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": "3"}
    program = Path(sys.executable).with_name("normalbench")
    done = subprocess.run([program], env=environment, capture_output=True, text=True)
    assert expected in done.stdout.split(), done
