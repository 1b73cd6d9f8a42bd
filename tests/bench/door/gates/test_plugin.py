"""The pytest plugin, by pytest inside pytest: gates that hold and fail, no GL driver, xdist, baselines, misuse."""

import pytest

from normalbench.bench.door.gates import baseline


@pytest.mark.parametrize("figure", [47.5, 48.5])
def test_a_tolerance_is_to_either_side(figure):
    before, after = {"psnr_db": 48.0}, {"psnr_db": figure}
    assert list(baseline.changes(before, after, {"psnr_db": 0.5})) == []
    (said,) = baseline.changes(before, after, {"psnr_db": 0.25})
    assert said.startswith(f"psnr_db is {figure}, but 48.0") and "tolerance 0.25" in said
