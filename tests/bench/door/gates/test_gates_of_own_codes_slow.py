"""Gates, tests and Python accept users' encodings of every kind, in the same form as commands."""

import csv
import io
import shutil

import pytest
from test_gates_of_own_codes import INPUTS

pytestmark = pytest.mark.usefixtures("gl", "slang")


GATES = """
[[gate]]
table = "vectors"
encoding = "velocity.hlsl"
storage = "rg16f"
error_mean_px = "at most 0.01"

[[gate]]
table = "depth"
depth = "depth.wgsl"
storage = "packed24"
distance = "10"
error_max = "at most 0.01"

[[gate]]
table = "frames"
encoding = "frame.slang"
storage = "rgb10a2"
count = 4096
rotation_mean_deg = "at most 0.2"

[[gate]]
table = "lights"
light_buffer = "light.frag"
sums = "1"
counts = "8"
gl_error = "at most 0.01"
"""


def test_a_gate_finds_the_files_next_to_it(run, tmp_path):
    """Rows are measured in GLSL, because no twin exists. The third of the four thresholds is too low."""
    (tmp_path / "gates.toml").write_text(GATES)
    for name in ("velocity.hlsl", "depth.wgsl", "frame.slang", "light.frag"):
        shutil.copy(INPUTS / name, tmp_path)
    status, out, err = run("check", str(tmp_path / "gates.toml"), "--format", "csv")
    assert status == 1 and "1 of 4 thresholds failed" in err
    holds = [row["holds"] for row in csv.DictReader(io.StringIO(out))]
    assert holds == ["pass", "pass", "FAIL", "pass"], out
