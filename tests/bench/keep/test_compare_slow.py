"""`normalbench compare`: no differences for the same work, exact figures, and time changes only beyond noise."""

import itertools

import numpy as np
import pytest

from normalbench.bench.keep.comparison import mann_whitney


def test_the_rank_test_is_exact():
    """The test matches an enumeration of nine ranks; for nine against nine its lowest value is 2 / 48620."""
    sample, other = [1.0, 4.0, 2.5, 8.0], [3.0, 9.0, 7.0, 6.0, 5.0]
    u = sum(a > b for a in sample for b in other)
    dealt = [
        sum(a > b for a in chosen for b in set(range(9)) - set(chosen))
        for chosen in itertools.combinations(range(9), 4)
    ]
    exact = np.mean([abs(k - 10) >= abs(u - 10) for k in dealt])
    assert mann_whitney(sample, other) == pytest.approx(exact, abs=1e-12)
    assert mann_whitney(range(9), range(10, 19)) == pytest.approx(2 / 48620, rel=1e-9)
    assert mann_whitney([1, 1, 1], [1, 1, 1]) == 1
