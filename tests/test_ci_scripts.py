"""A CI run reports how many commits ago the nightly tests passed, and fails above a limit."""

from manual import ROOT


def test_run_reports_the_nightly_age_first():
    lines = [line for line in (ROOT / ".ci/run").read_text().splitlines() if line and not line.startswith(("#", "cd"))]
    assert lines[:3] == ["set -euo pipefail", "export CI=true", ".ci/nightly-age"]
