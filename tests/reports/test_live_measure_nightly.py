"""Measuring in the page, by a browser's own renderer: codes against the run's, faults, interruptions, saved devices."""

import subprocess
import sys

from test_live_measure_slow import LEAST_SHARE, Measured


def test_every_encoding_gives_the_runs_codes_in_every_format(gl_browser, tmp_path):
    """At 8 and 10 bits at least 99.9 % of the codes are equal and none is further than a step; by SwiftShader, which
    rounds every sum and root as IEEE 754 says, all of them are."""
    command = (sys.executable, "-m", "normalbench", "run", "--tables", "quality", "--encoding", "all")
    sets = (
        "--storage",
        "rgba8,rgb10a2,rg8,rg16f,rgba16f",
        "--count",
        "4096",
        "--normals",
        "sphere",
        "-o",
        str(tmp_path / "run"),
    )
    done = subprocess.run([*command, *sets], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    opened = Measured(gl_browser, tmp_path / "run/report.html")
    opened.start()
    rows = opened.finish()
    opened.context.close()
    assert len(rows) >= 100
    for row in rows:
        is_fine = "f" in row["storage"]
        least = 0.99 if is_fine else LEAST_SHARE
        assert row["equal"] >= least * row["normals"] and not row["further"], (row["encoding"], row["difference"])
