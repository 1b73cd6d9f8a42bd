"""Encodings with another axis or sign: the same encoding about other axes, in both languages."""

from itertools import product

import numpy as np
import pytest
from slowly import a_tenth
from test_turned import TURNS, directions

from normalbench.bench.ground.angles import angles_deg
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.variants import variant
from normalbench.encodings.vec import from_array
from normalbench.gbuffer.codecs.codec_passes import exact_values

EACH = [*product(["octahedral", "spheremap", "spherical", "cube", "best_fit", "tetrahedral"], TURNS)]


@pytest.mark.parametrize("name, values", a_tenth(EACH), ids=str)
def test_both_languages_turn_encodings_alike(gl, name, values):
    """The share of equal codes is at most 1% below that of the unturned encoding, and the 98th percentile of the
    decoded angles is at most twice as large, or 0.001 degrees."""
    figures = []
    for encoding in (ENCODINGS[name], variant(ENCODINGS[name], values)):
        n = directions(1024)
        four = np.concatenate([n, np.zeros((len(n), 1), np.float32)], axis=1)
        by_jax = np.stack(encoding.encode(from_array(n), from_array(n)), axis=1)
        codes = np.zeros((len(n), 4), np.float32)
        codes[:, : by_jax.shape[1]] = by_jax
        by_gl, decoded = exact_values(gl, encoding, four, four, codes)
        same = np.abs(by_gl[:, : by_jax.shape[1]] - by_jax).max(axis=1) < 1e-5
        figures.append((same.mean(), np.quantile(angles_deg(n, decoded[:, :3].astype(np.float64)), 0.98)))
    (plain, plain_angle), (turned, turned_angle) = figures
    assert turned >= plain - 0.01, f"{turned:.3%} of codes agree, {plain:.3%} where it is not turned"
    assert turned_angle <= max(2 * plain_angle, 1e-3), f"{turned_angle:.3g} degrees off without storage"
