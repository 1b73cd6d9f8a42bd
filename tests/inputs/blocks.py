"""Random blocks of compressed formats, and images of them."""

from __future__ import annotations

import numpy as np


def random_blocks(count: int, seed: int) -> np.ndarray:
    """Return uint8 of shape (count, 16); every bit is equally likely to be 0 or 1."""
    return np.random.default_rng(seed).integers(0, 256, (count, 16), np.uint8)


def bc7_blocks(count: int, seed: int) -> np.ndarray:
    """Return random blocks of BC7, equally many of each of the eight modes."""
    blocks, mode = random_blocks(count, seed), np.arange(count) % 8
    blocks[:, 0] = (blocks[:, 0].astype(int) >> (mode + 1) << (mode + 1) | 1 << mode) & 255
    return blocks


def by_block(image: np.ndarray) -> np.ndarray:
    """Return an image of one row of blocks, (4, 4 count, channels), as (count, 16, channels)."""
    count = image.shape[1] // 4
    return image.reshape(4, count, 4, -1).transpose(1, 0, 2, 3).reshape(count, 16, -1)


def from_bgra(data: bytes, count: int) -> np.ndarray:
    """Return texture2ddecoder's output for a row of blocks as RGBA, uint8 of shape (count, 16, 4)."""
    return by_block(np.frombuffer(data, np.uint8).reshape(4, 4 * count, 4))[..., [2, 1, 0, 3]]
