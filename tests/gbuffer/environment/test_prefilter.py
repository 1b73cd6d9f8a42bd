"""Levels of roughness, compared with independent sums for the integral of radiance, D and n.l."""

import numpy as np
import pytest

from normalbench.gbuffer.environment.environment import Environment
from normalbench.gbuffer.environment.lobe_sums import seen_through_lobe
from normalbench.gbuffer.environment.prefilter import COARSE, FINE, STEP, key_of, prefiltered

HEIGHT = 32


ROUGHNESSES = sorted({*FINE, *COARSE} - {0})


def picture(height=HEIGHT, seed=5):
    """Return an environment with the contrasts of an outdoor image, and a lamp in one texel."""
    radiance = np.exp(1.5 * np.random.default_rng(seed).normal(size=(height, 2 * height, 3)))
    radiance[height // 3, height] = 1e4
    return radiance.astype(np.float32)


@pytest.fixture(scope="module")
def levels():
    return prefiltered(Environment("picture", picture()))


def lobe(cosine, alpha):
    """Return the lobe as in the materials' fact sheet, with (n.h)^2 = (1 + r.l) / 2."""
    n_h_squared = (1 + cosine) / 2
    return alpha**2 / (np.pi * (n_h_squared * (alpha**2 - 1) + 1) ** 2) * np.maximum(cosine, 0)


def direction(t, p):
    return np.stack(np.broadcast_arrays(np.sin(p) * np.sin(t), np.cos(t), -np.cos(p) * np.sin(t)), -1)


def weights_of_pieces(height, r, alpha, side, rows=slice(None), columns=slice(None)):
    """Return the weights of all texels, or some, summed over side x side pieces of equal angles."""
    t = ((np.arange(height)[rows, None] + (np.arange(side) + 0.5) / side) * np.pi / height).reshape(-1, 1)
    p = ((np.arange(2 * height)[columns, None] + (np.arange(side) + 0.5) / side) * np.pi / height).ravel() - np.pi
    weight = lobe(direction(t, p) @ r, alpha) * np.sin(t) / side**2
    return weight.reshape(len(t) // side, side, -1, side).sum((1, 3))


def weighted(radiance, weight):
    return (radiance * weight[..., None]).sum((0, 1)) / weight.sum()


def integral(radiance, r, alpha):
    """Return the integral over texels by pieces, extrapolated to infinitely small pieces. Texels near the middle of a
    narrow lobe have 500 x 500 pieces."""
    height = len(radiance)
    coarse, fine = (weights_of_pieces(height, r, alpha, side) for side in (12, 24))
    weight = (4 * fine - coarse) / 3
    near = middles(height) @ r > np.cos(2.5 * np.pi / height)
    for row, column in zip(*np.nonzero(near & (alpha < 0.01)), strict=True):
        texel = slice(row, row + 1), slice(column, column + 1)
        weight[texel] = weights_of_pieces(height, r, alpha, 500, *texel)
    return weighted(radiance, weight)


def middles(height):
    t = (np.arange(height)[:, None] + 0.5) * np.pi / height
    return direction(t, (np.arange(2 * height) + 0.5) * np.pi / height - np.pi)


def centre(level, row, column):
    return direction((row + 0.5) * np.pi / len(level), (column + 0.5) * np.pi / len(level) - np.pi)


# Of a picture of this height the lobe is narrower than three texels, to either side, below this.
NARROW = 0.38


@pytest.mark.parametrize("roughness", [roughness for roughness in ROUGHNESSES if roughness < NARROW])
def test_a_narrow_lobe_is_integrated_over_each_texel(levels, roughness):
    """At roughness 0.025 the lobe is a hundredth of a texel wide."""
    level, rng = levels.fine[FINE.index(roughness)], np.random.default_rng(int(1e4 * roughness))
    for row, column in zip(rng.integers(3, HEIGHT - 3, 3), rng.integers(0, 2 * HEIGHT, 3), strict=True):
        expected = integral(picture(), centre(level, row, column), roughness**2)
        error = np.abs(level[row, column] / expected - 1).max()
        assert error < 1e-4, f"{error} at row {row}, column {column}: {level[row, column]} for {expected}"


@pytest.mark.parametrize("roughness", [roughness for roughness in ROUGHNESSES if roughness >= NARROW])
def test_a_wide_lobe_is_summed_to_float32_precision(levels, roughness):
    """The sum uses values at texel centres; only the rounding of float32 remains."""
    for kept, roughnesses in ((levels.fine, FINE), (levels.coarse, COARSE)):
        for level in kept[[index for index, of_level in enumerate(roughnesses) if of_level == roughness]]:
            for row, column in ((0, 3), (len(level) // 2, len(level)), (len(level) - 1, 1)):
                r = centre(level, row, column)
                expected = weighted(picture(), weights_of_pieces(HEIGHT, r, roughness**2, 1))
                assert np.abs(level[row, column] / expected - 1).max() < 1e-6


@pytest.mark.parametrize("roughness", [0.4, 0.5])
def test_coarse_levels_of_a_small_image_are_integrated_over_its_texels(roughness):
    radiance, alpha = picture(16), roughness**2
    level = seen_through_lobe(radiance, alpha, STEP)
    for row, column in ((0, 3), (1, 2), (3, 7)):
        expected = integral(radiance, centre(level, row, column), alpha)
        assert np.abs(level[row, column] / expected - 1).max() < 2e-4


@pytest.mark.parametrize("height", [8, 12, 64])
def test_a_constant_environment_stays_constant(height):
    levels = prefiltered(Environment("one", np.full((height, 2 * height, 3), 1, np.float32)))
    assert levels.fine.shape == (len(FINE), height, 2 * height, 3)
    assert levels.coarse.shape == (len(COARSE), height // STEP, 2 * height // STEP, 3)
    assert levels.fine.dtype == levels.coarse.dtype == np.float32
    for level in (levels.fine, levels.coarse, levels.irradiance):
        assert np.abs(level - 1).max() < 1e-6


def test_a_mirror_reflects_the_radiance_unchanged(levels):
    assert levels.fine_roughness[0] == 0
    assert np.array_equal(levels.fine[0], picture())


def test_the_fine_and_coarse_grids_agree(levels):
    """A direction of the coarse level is the corner of four fine texels, and their mean is close to its value."""
    assert levels.fine_roughness[-1] == levels.coarse_roughness[0]
    fine = seen_through_lobe(picture(64), FINE[-1] ** 2)
    corners = (fine[1::4, 1::4] + fine[2::4, 1::4] + fine[1::4, 2::4] + fine[2::4, 2::4]) / 4
    error = np.abs(seen_through_lobe(picture(64), FINE[-1] ** 2, STEP) / corners - 1)[2:-2]
    assert np.median(error) < 2e-3


def test_irradiance_is_the_cosine_weighted_integral_over_pi(levels):
    radiance, irradiance = picture(), levels.irradiance
    t = (np.arange(HEIGHT)[:, None] + 0.5) * np.pi / HEIGHT
    area = np.sin(t) * (np.pi / HEIGHT) ** 2
    for row, column in ((0, 0), (3, 7), (5, 15), (7, 2)):
        cosine = np.maximum(middles(HEIGHT) @ centre(irradiance, row, column), 0)
        expected = (radiance * (cosine * area)[..., None]).sum((0, 1)) / np.pi
        # Middles of texels integrate the cosine itself to 1e-3.
        assert np.abs(irradiance[row, column] / expected - 1).max() < 2e-3


def test_a_single_bright_texel_gives_the_shape_of_the_lobe():
    """At a distance the result is the lobe times the texel's area, also if the image is turned or mirrored."""
    height, roughness = 64, 0.3
    radiance = np.zeros((height, 2 * height, 3), np.float32)
    radiance[20, 30] = 1
    seen = seen_through_lobe(radiance, roughness**2)
    source = centre(radiance, 20, 30)
    t = (20.5) * np.pi / height
    for row, column in ((24, 40), (20, 33), (50, 100), (1, 90)):
        cosine = centre(radiance, row, column) @ source
        whole = 2 * np.pi * np.trapezoid(lobe(np.linspace(0, 1, 200001), roughness**2), np.linspace(0, 1, 200001))
        expected = lobe(cosine, roughness**2) * np.sin(t) * (np.pi / height) ** 2 / whole
        assert seen[row, column] == pytest.approx(np.full(3, expected), rel=5e-3, abs=1e-15)
    assert seen[23, 25] == pytest.approx(seen[23, 35], rel=1e-9)
    upside_down = seen_through_lobe(radiance[::-1], roughness**2)
    assert upside_down[::-1] == pytest.approx(seen, rel=1e-7, abs=1e-12)


def test_stored_levels_are_not_computed_again():
    environment, store = Environment("kept", picture(8)), {}

    def keep(key, make):
        if key not in store:
            store[key] = make()
        return store[key]

    first = prefiltered(environment, keep)
    (kept,) = store.values()
    store[key_of(environment.radiance)] = {"fine": kept["fine"] + 1, "coarse": kept["coarse"]}
    assert np.array_equal(prefiltered(environment, keep).fine[1:], first.fine[1:] + 1)
    prefiltered(Environment("kept", picture(8, seed=6)), keep)
    assert len(store) == 2, "another picture by the same name is another one"


@pytest.mark.parametrize("shape", [(10, 20, 3), (8, 15, 3)])
def test_image_of_the_wrong_shape_is_rejected(shape):
    with pytest.raises(ValueError, match="width must be twice the height, and the height a multiple of 4"):
        prefiltered(Environment("odd", np.ones(shape, np.float32)))
