"""The pytest plugin, tested inside pytest: gates that pass or fail, no OpenGL driver, xdist, baselines, misuse."""

import pytest

from normalbench.bench.door.gates import baseline


@pytest.mark.parametrize("figure", [47.5, 48.5])
def test_a_tolerance_applies_in_both_directions(figure):
    before, after = {"psnr_db": 48.0}, {"psnr_db": figure}
    assert list(baseline.changes(before, after, {"psnr_db": 0.5})) == []
    (change,) = baseline.changes(before, after, {"psnr_db": 0.25})
    assert change.startswith(f"psnr_db is {figure}, but 48.0") and "tolerance 0.25" in change
