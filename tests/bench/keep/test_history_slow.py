"""`normalbench history`: the commit, the row and the figure of each step, and no noise of times."""

import numpy as np
import pytest
from histories import NOISE

from normalbench.bench.keep.time_steps import time_steps


@pytest.mark.parametrize(("count", "series"), [(30, 120), (300, 20)])
def test_times_that_waver_have_no_step(count, series):
    """Also where they waver for days, as those of machines that others use do."""
    rng, found = np.random.default_rng(4), 0
    for _ in range(series):
        off = rng.normal(0, 1, count)
        for at in range(1, count):
            off[at] = 0.5 * off[at - 1] + np.sqrt(0.75) * off[at]
        found += bool(time_steps(list(10 * np.exp(NOISE * off)), 10 * count))
    assert found == 0
