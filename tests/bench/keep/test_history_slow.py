"""`normalbench history`: the commit, the row and the figure of each change, without the noise in times."""

import numpy as np
import pytest
from histories import NOISE

from normalbench.bench.keep.time_steps import time_steps


@pytest.mark.parametrize(("count", "series"), [(30, 120), (300, 20)])
def test_noisy_times_have_no_step(count, series):
    """The noise of consecutive runs is correlated, as on shared machines."""
    rng, steps = np.random.default_rng(4), 0
    for _ in range(series):
        off = rng.normal(0, 1, count)
        for index in range(1, count):
            off[index] = 0.5 * off[index - 1] + np.sqrt(0.75) * off[index]
        steps += bool(time_steps(list(10 * np.exp(NOISE * off)), 10 * count))
    assert steps == 0
