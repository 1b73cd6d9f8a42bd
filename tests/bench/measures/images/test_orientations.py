"""Orientations of an encoding's axes in a scene, and standard errors of means over orientations."""

import numpy as np
import pytest

from normalbench.bench.measures.images.orientations import POLES, jackknife, rotations, yaws


def test_a_pole_points_along_its_axis():
    for axis, matrix in POLES.items():
        assert (np.eye(3)["xyz".index(axis)] == matrix.T @ [0, 0, 1]).all() and np.linalg.det(matrix) == 1, axis


def test_a_yaw_keeps_the_up_axis_and_yaws_are_evenly_spread():
    turns = yaws(0, 64, 5)
    assert np.allclose(turns @ [0, 1, 0], [0, 1, 0]) and np.allclose(turns @ np.swapaxes(turns, 1, 2), np.eye(3))
    assert np.allclose(np.linalg.det(turns), 1)
    angles = np.degrees(np.arctan2(turns[:, 0, 2], turns[:, 0, 0]))
    # Four yaws of a code with fourfold symmetry and mirrors, and sixteen, leave no gap of twice their even share.
    for count in (4, 16):
        octants = np.sort(angles[:count] % 45)
        assert max(*np.diff(octants), octants[0] + 45 - octants[-1]) < 2 * 45 / count
    # No grid of 4 to 16 bits along the octant is met in step: a mean phase of 64 yaws is 0 but for chance.
    for levels in (2.0 ** np.arange(4, 17) - 1) / 2:
        assert abs(np.exp(2j * np.pi * levels * angles / 45).mean()) < 0.35, levels


@pytest.mark.parametrize("series", [yaws, rotations])
def test_a_longer_series_keeps_its_first_items(series):
    assert np.allclose(np.concatenate([series(0, 4, 3), series(4, 12, 3)]), series(0, 16, 3), atol=1e-12)
    assert not np.allclose(series(0, 4, 3), series(0, 4, 4))


def test_random_rotations_distribute_a_direction_uniformly():
    """The mean of uniform directions is 0 and their mean square 1/3, within three standard errors of 4096 samples."""
    turns = rotations(0, 4096, 0)
    assert np.allclose(turns @ np.swapaxes(turns, 1, 2), np.eye(3), atol=1e-12)
    directions = turns @ [0.6, 0.0, 0.8]
    assert np.abs(directions.mean(axis=0)).max() < 3 * (1 / 3 / 4096) ** 0.5
    assert np.abs((directions**2).mean(axis=0) - 1 / 3).max() < 3 * (4 / 45 / 4096) ** 0.5


def test_the_jackknife_of_a_mean_is_its_standard_error():
    values = np.random.default_rng(1).gamma(2.0, size=16)
    error = jackknife(lambda kept: float(values[kept].mean()), range(16))
    assert error == pytest.approx(values.std(ddof=1) / 4, rel=1e-12)
