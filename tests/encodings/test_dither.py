"""Noise added before rounding: a blue-noise tile, an amplitude of one step, and a mean that approaches the code."""

import jax.numpy as jnp
import numpy as np
import pytest

from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.blue_noise import SIZE, blue_noise
from normalbench.encodings.storages.dither import NUMBERS
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import Vec2

FIXED = [name for name, storage in STORAGES.items() if storage.kind != "float"]
CODEC = Codec(ENCODINGS["octahedral"], STORAGES["rg8"])


def low_share(tile: np.ndarray) -> float:
    """Return the energy at frequencies below 0.1 cycles per pixel, relative to white noise."""
    energy = abs(np.fft.fft2(tile - tile.mean())) ** 2 / tile.size / tile.var()
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(SIZE), np.fft.fftfreq(SIZE)))
    return float(energy[(frequency > 0) & (frequency < 0.1)].mean())


def test_the_tile_contains_every_number_once():
    ranks = np.sort(blue_noise().ravel()) * SIZE**2 - 0.5
    assert np.allclose(ranks, np.arange(SIZE**2), atol=1e-9)


def test_the_tile_has_little_energy_at_low_frequencies():
    """The same numbers in random order have about a thousand times as much energy there."""
    share = low_share(blue_noise())
    white = low_share(np.random.default_rng(0).permutation(blue_noise().ravel()).reshape(SIZE, SIZE))
    assert share < 1e-3, share
    assert 0.5 < white < 2, white


@pytest.mark.parametrize("name", FIXED)
def test_noise_spans_one_step(name):
    """A step is the distance between adjacent numbers of a channel."""
    codec = Codec(ENCODINGS["octahedral"], STORAGES[name])
    added = codec.dither(0).added.astype(np.float64)
    for number in range(2):
        step = float(np.diff(codec.numbers(number)).min())
        ends = added[..., number].min(), added[..., number].max()
        assert ends == pytest.approx((-step / 2, step / 2), rel=1 / SIZE**2 + 1e-6), f"{ends} of a step of {step}"
        assert abs(added[..., number].mean()) < 1e-6 * step
    assert not added[..., 2:].any()


def test_each_number_and_frame_has_its_own_noise():
    """No part of the tile is used twice, and the parts are not correlated."""
    parts = [Codec(ENCODINGS["xyz"], STORAGES["rgb10a2"]).dither(frame).added[..., :NUMBERS] for frame in range(8)]
    several = np.concatenate([part.reshape(-1, NUMBERS) for part in parts], axis=1).T
    alike = np.corrcoef(several) - np.eye(len(several))
    assert abs(alike).max() < 0.1, abs(alike).max()


def test_the_mean_over_frames_with_noise_approaches_the_code():
    """Without noise, and with still noise, more frames change nothing."""
    codes = np.random.default_rng(1).uniform(-0.95, 0.95, (2, SIZE, SIZE)).astype(np.float32)
    step = STORAGES["rg8"].step(0)

    def off(frames: range) -> float:
        """Return the root mean square error of the mean, in steps."""
        noise = (np.moveaxis(CODEC.dither(frame).added[..., :2], -1, 0) for frame in frames)
        stored = [np.array(CODEC.store(Vec2(*map(jnp.asarray, codes + tile)))) for tile in noise]
        return float(np.sqrt(np.mean((np.mean(stored, axis=0) - codes) ** 2)) / step)

    # A number that is rounded up for a share p of frames is off by sqrt(p (1 - p)): a step / sqrt(6) over all p.
    errors = {count: off(range(count)) for count in (1, 8, 64)}
    assert errors[1] == pytest.approx(6**-0.5, rel=0.03), errors
    assert errors[8] < 0.4 * errors[1] and errors[64] < 0.15 * errors[1], errors
    assert off(range(1)) == pytest.approx(errors[1])


@pytest.mark.parametrize(
    "encoding, storage, rounding, said",
    [
        ("spherical_fibonacci", "rg8", "nearest", "an index"),
        ("optimised_rings", "rg8", "nearest", "an index"),
        ("best_fit_searched", "rgba8", "nearest", "an index"),
        ("octahedral", "rg16f", "nearest", "float steps are uneven"),
        ("octahedral", "rg8", "truncate", "only with rounding to nearest"),
        ("octahedral_precise", "rg8", "nearest", "only with rounding to nearest"),
    ],
)
def test_codecs_that_cannot_be_dithered_give_a_reason(encoding, storage, rounding, said):
    reason = Codec(ENCODINGS[encoding], STORAGES[storage], rounding).undithered
    assert reason and said in reason and "\n" not in reason


def test_a_number_with_few_values_is_not_dithered():
    """The third number of a cube code is one of six faces."""
    codec = Codec(ENCODINGS["cube"], STORAGES["rgb8_10_10_3"])
    added = codec.dither(0).added
    assert codec.undithered is None and CODEC.undithered is None
    assert added[..., :2].any(axis=(0, 1)).all() and not added[..., 2].any()
