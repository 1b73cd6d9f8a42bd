"""Decoders of compressed blocks, compared with texture2ddecoder, the OpenGL device and values computed by hand."""

import numpy as np
import texture2ddecoder
from blocks import bc7_blocks, from_bgra
from test_blocks import BC7, COUNT, on_device

from normalbench.bench.tables.maps.formats import FORMATS


def test_bc7_matches_an_independent_decoder_and_the_device(gl):
    """All eight modes agree bit for bit: every decoded float is a multiple of 1/255."""
    blocks = bc7_blocks(COUNT, seed=1)
    decoded = FORMATS["bc7"].decode(blocks)
    expected = from_bgra(texture2ddecoder.decode_bc7(blocks.tobytes(), 4 * len(blocks), 4), len(blocks))
    wrong = np.flatnonzero((np.rint(decoded * 255) != expected).any(axis=(1, 2)))
    assert not len(wrong), f"{len(wrong)} blocks differ, the first of mode {wrong[0] % 8}: {blocks[wrong[0]]}"
    apart = np.abs(on_device(gl, blocks, BC7) - decoded) * 255
    assert apart.max() < 1e-3, f"{apart.max()} of 255, block {blocks[apart.max(axis=(1, 2)).argmax()]}"
