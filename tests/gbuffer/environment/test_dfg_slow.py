"""The sum over directions that checks the split-sum table, compared with known figures for separable Smith."""

import numpy as np
import pytest
from test_dfg import N_V, summed

# scale + bias with separable Smith, from the same sheet, which holds them against Mitsuba's `roughconductor`.
SEPARABLE = {
    0.5: [0.9158, 0.8970, 0.8551, 0.8315],
    0.7: [0.6978, 0.6883, 0.6923, 0.7433],
    1.0: [0.3069, 0.3409, 0.4091, 0.5114],
}


def separable(n_l, n_v, a):
    of_light, other = (2 * c / (c + np.sqrt(a**2 + (1 - a**2) * c**2)) for c in (n_l, n_v))
    return of_light * other / (4 * n_l * n_v)


@pytest.mark.parametrize("roughness", SEPARABLE)
def test_sum_with_separable_smith_matches_the_known_figures(roughness):
    """The sum can therefore serve as a reference."""
    sums = [sum(summed(n_v, roughness, separable)) for n_v in N_V]
    assert np.abs(np.subtract(sums, SEPARABLE[roughness])).max() < 3e-4, sums
