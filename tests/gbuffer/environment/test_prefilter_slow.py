"""Levels of roughness, compared with independent sums for the integral of radiance, D and n.l."""

import numpy as np
import pytest
from test_prefilter import HEIGHT, centre, integral, picture

from normalbench.gbuffer.environment.environment import Environment
from normalbench.gbuffer.environment.lobe_sums import seen_through_lobe
from normalbench.gbuffer.environment.prefilter import prefiltered


def by_shares(radiance, r, alpha, shares=3000, turns=600):
    """Return the cosine-weighted mean radiance over directions around r that have equal shares of D."""
    u = ((np.arange(shares) + 0.5) / shares)[:, None]
    sine_squared = alpha**2 * u / (1 - u * (1 - alpha**2))  # of half the angle between r and l
    cosine = 1 - 2 * sine_squared
    turn = (np.arange(turns) + 0.5) / turns * 2 * np.pi
    across = np.cross(r, (0.3, -0.5, 0.8))
    across = across / np.linalg.norm(across)
    ring = np.cos(turn)[:, None] * across + np.sin(turn)[:, None] * np.cross(r, across)
    light = cosine[..., None] * r + np.sqrt(1 - cosine**2)[..., None] * ring
    height, width = radiance.shape[:2]
    row = np.arccos(np.clip(light[..., 1], -1, 1)) / np.pi * height
    column = (np.arctan2(light[..., 0], -light[..., 2]) / (2 * np.pi) + 0.5) * width
    texels = radiance[np.minimum(row.astype(int), height - 1), column.astype(int) % width]
    weight = np.broadcast_to(np.maximum(cosine, 0), texels.shape[:2])[..., None]
    return (texels * weight).sum((0, 1)) / weight.sum()


@pytest.mark.parametrize("roughness", [0.05, 0.1, 0.2])
def test_levels_near_the_poles_match_sampled_directions(roughness):
    radiance = np.minimum(picture(), 10)
    level = seen_through_lobe(radiance, roughness**2)
    for row, column in ((0, 23), (1, 40), (HEIGHT - 1, 5)):
        expected = by_shares(radiance, centre(level, row, column), roughness**2)
        assert np.abs(level[row, column] / expected - 1).max() < 2e-3


def test_the_two_sums_agree_where_one_replaces_the_other():
    """Both sums agree to 1% on an image with contrasts of a hundred between areas of 4 x 4 texels."""
    radiance = np.minimum(picture(16), 30).repeat(4, axis=0).repeat(4, axis=1)
    for roughness in (0.27, 0.275):
        level = seen_through_lobe(radiance, roughness**2)
        expected = integral(radiance, centre(level, 20, 9), roughness**2)
        assert np.abs(level[20, 9] / expected - 1).max() < 1e-2


def test_irradiance_keeps_two_thirds_of_the_slope_of_a_gradient_along_y():
    """The integral of (1 + a l.y) max(n.l, 0) is pi (1 + 2/3 a n.y)."""
    height = 64
    y = np.cos((np.arange(height) + 0.5) * np.pi / height)
    radiance = np.broadcast_to((1 + 0.5 * y)[:, None, None], (height, 2 * height, 3)).astype(np.float32)
    irradiance = prefiltered(Environment("gradient", radiance)).irradiance
    n_y = np.cos((np.arange(len(irradiance)) + 0.5) * np.pi / len(irradiance))
    assert np.abs(irradiance - (1 + n_y / 3)[:, None, None]).max() < 2e-4
