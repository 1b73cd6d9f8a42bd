"""Orientations of an encoding's axes in a scene, and standard errors of means over them."""

import numpy as np
import pytest

from normalbench.bench.measures.images.orientations import POLES, jackknife, rotations, yaws


def test_a_pole_lies_along_the_axis_that_names_it():
    for axis, matrix in POLES.items():
        assert (np.eye(3)["xyz".index(axis)] == matrix.T @ [0, 0, 1]).all() and np.linalg.det(matrix) == 1, axis


def test_a_yaw_keeps_what_is_up_and_goes_on_by_the_golden_angle():
    turns = yaws(0, 64, 5)
    assert np.allclose(turns @ [0, 1, 0], [0, 1, 0]) and np.allclose(turns @ np.swapaxes(turns, 1, 2), np.eye(3))
    assert np.allclose(np.linalg.det(turns), 1)
    angles = np.degrees(np.arctan2(turns[:, 0, 2], turns[:, 0, 0]))
    assert np.allclose(np.diff(angles) % 360, 137.508, atol=1e-3)
    # A fourfold encoding sees every angle once: of 16 even steps it would see four.
    assert np.diff(np.sort(angles[:16] % 90)).min() > 2


@pytest.mark.parametrize("series", [yaws, rotations])
def test_more_of_a_series_leave_the_first_as_they_are(series):
    assert np.allclose(np.concatenate([series(0, 4, 3), series(4, 12, 3)]), series(0, 16, 3), atol=1e-12)
    assert not np.allclose(series(0, 4, 3), series(0, 4, 4))


def test_random_rotations_take_a_direction_everywhere():
    """The mean of uniform directions is 0, and that of their squares a third; three standard errors of 4096."""
    turns = rotations(0, 4096, 0)
    assert np.allclose(turns @ np.swapaxes(turns, 1, 2), np.eye(3), atol=1e-12)
    directions = turns @ [0.6, 0.0, 0.8]
    assert np.abs(directions.mean(axis=0)).max() < 3 * (1 / 3 / 4096) ** 0.5
    assert np.abs((directions**2).mean(axis=0) - 1 / 3).max() < 3 * (4 / 45 / 4096) ** 0.5


def test_the_jackknife_of_a_mean_is_its_standard_error():
    values = np.random.default_rng(1).gamma(2.0, size=16)
    found = jackknife(lambda kept: float(values[kept].mean()), range(16))
    assert found == pytest.approx(values.std(ddof=1) / 4, rel=1e-12)
