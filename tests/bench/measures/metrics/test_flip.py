"""FLIP, compared with its authors' program and with general facts about image differences."""

import numpy as np
import pytest

from normalbench.bench.measures.metrics.flip import Flip


def pictures():
    """Return pairs of a picture and a version with noise, few steps, a shift or other pixels; shape (96, 128, 3)."""
    rng = np.random.default_rng(0)
    y, x = np.mgrid[0:96, 0:128] / 96
    smooth = np.stack([0.5 + 0.4 * np.sin(9 * x + 3 * y), 0.5 + 0.4 * np.cos(7 * y), np.clip(x * y, 0, 1)], axis=-1)
    disc = (np.hypot(x - 0.5, y - 0.5) < 0.3)[..., None] * np.array([0.9, 0.2, 0.1])
    pairs = {
        "noise": (smooth, np.clip(smooth + rng.normal(0, 0.02, smooth.shape), 0, 1)),
        "steps": (smooth, np.round(31 * smooth) / 31),
        "a shift": (disc, np.roll(disc, 1, axis=0)),
        "everything": (rng.random((96, 128, 3)), rng.random((96, 128, 3))),
    }
    return {name: [image.astype(np.float32) for image in pair] for name, pair in pairs.items()}


@pytest.mark.parametrize("name, pair", pictures().items())
def test_flip_matches_its_authors_program(name, pair):
    """The program is flip-evaluator 1.7, at its default of 67 pixels per degree."""
    evaluator = pytest.importorskip("flip_evaluator")
    reference, image = pair
    expected = evaluator.evaluate(reference, image, "LDR", applyMagma=False)[0][..., 0]
    errors = Flip(reference).of(image)
    assert abs(errors - expected).max() < 1e-4, name
    assert np.percentile(errors, 99) == pytest.approx(np.percentile(expected, 99), abs=1e-5)


def test_equal_images_do_not_differ_and_black_and_white_differ_most():
    (image, _) = pictures()["noise"]
    assert abs(Flip(image).of(image)).max() < 1e-6
    black, white = np.zeros((8, 8, 3), np.float32), np.ones((8, 8, 3), np.float32)
    assert Flip(black).of(white) == pytest.approx(np.full((8, 8), 0.9674), abs=1e-4)


def test_flip_of_offset_greys_matches_the_columns_description():
    """A grey that is off by 2/255 has a FLIP near 0.05, and a grey that is off by 5/255 to 6/255 has one near 0.1."""
    grey = np.full((32, 32, 3), 0.5, np.float32)
    means = [float(Flip(grey).of(grey + np.float32(step / 255)).mean()) for step in (2, 5.5)]
    assert means == pytest.approx([0.05, 0.1], abs=0.012)
