"""BC7 (BPTC): Khronos Data Format Specification, chapter on BPTC. All eight modes, exact in whole numbers."""

from __future__ import annotations

import numpy as np

from .bits import TEXELS, bits_of, field, fields
from .bptc_tables import ANCHORS, MODES, PARTITIONS, WEIGHTS, Mode

ONE = 255
ALPHA = 3


def decode_bc7(blocks: np.ndarray) -> np.ndarray:
    """The texels of BC7 blocks.

    Args:
        blocks: uint8 of shape (count, 16).

    Returns:
        uint8 of shape (count, 16, 4), row by row; 0 where the mode is the reserved one.
    """
    texels = np.zeros((len(blocks), TEXELS, 4), np.uint8)
    for number, mode in enumerate(MODES):
        # A mode is as many zeros as its number, and a one.
        is_of_mode = blocks[:, 0] & (2 ** (number + 1) - 1) == 1 << number
        if is_of_mode.any():
            texels[is_of_mode] = _decoded(bits_of(blocks[is_of_mode]), number, mode)
    return texels


def _decoded(bits: np.ndarray, number: int, mode: Mode) -> np.ndarray:
    """Texels of blocks of one mode. The fields lie one after the other, those that a mode lacks with no bits."""
    at = number + 1
    partition = field(bits, at, mode.partition)
    rotation = field(bits, at := at + mode.partition, mode.rotation)
    selection = field(bits, at := at + mode.rotation, mode.selection)
    at += mode.selection
    ends = _endpoints(bits, at, mode)
    at += mode.subsets * (2 * (3 * mode.colour + mode.alpha + mode.endpoint_p) + mode.shared_p)
    subset = PARTITIONS[mode.subsets][partition]
    anchors = ANCHORS[mode.subsets][partition]
    first = _weights(bits, at, mode.first, anchors)
    second = _weights(bits, at + TEXELS * mode.first - mode.subsets, mode.second, anchors) if mode.second else first
    of_alpha = selection[:, None] == 0
    shares = np.stack([*[np.where(of_alpha, first, second)] * 3, np.where(of_alpha, second, first)], axis=2)
    pair = np.take_along_axis(ends, subset[:, :, None, None], axis=1)
    # ((64 - weight) E0 + weight E1 + 32) >> 6
    texels = ((64 - shares) * pair[:, :, 0] + shares * pair[:, :, 1] + 32) >> 6
    return _rotated(texels, rotation)


def _endpoints(bits: np.ndarray, at: int, mode: Mode) -> np.ndarray:
    """The ends of each subset in 8 bits, (count, subsets, 2, 4)."""
    count, pairs = len(bits), 2 * mode.subsets
    colours = fields(bits, at, mode.colour, 3 * pairs).reshape(count, 3, pairs)
    at += 3 * pairs * mode.colour
    alphas = fields(bits, at, mode.alpha, pairs)
    at += pairs * mode.alpha
    lowest = fields(bits, at, 1, mode.subsets * (2 * mode.endpoint_p + mode.shared_p))
    if mode.shared_p:
        lowest = np.repeat(lowest, 2, axis=1)
    colour = [_widened(colours[:, channel], mode.colour, lowest) for channel in range(3)]
    alpha = _widened(alphas, mode.alpha, lowest) if mode.alpha else np.full((count, pairs), ONE)
    return np.stack([*colour, alpha], axis=2).reshape(count, mode.subsets, 2, 4)


def _widened(values: np.ndarray, width: int, lowest: np.ndarray) -> np.ndarray:
    """Numbers with their lowest bits, if any, in 8 bits: the highest bits are repeated below."""
    if lowest.shape[1]:
        values, width = values << 1 | lowest, width + 1
    values = values << 8 - width
    return values | values >> width


def _weights(bits: np.ndarray, at: int, width: int, anchors: np.ndarray) -> np.ndarray:
    """What each texel's index weighs the second end by, in 64ths; the index of a subset's anchor has a bit less."""
    texels = np.arange(TEXELS)
    is_anchor = (anchors[:, :, None] == texels).any(axis=1)
    starts = at + width * texels - np.cumsum(is_anchor, axis=1) + is_anchor
    index = np.zeros(starts.shape, np.int32)
    for place in range(width):
        # An anchor's highest bit is 0; what lies there is the next texel's.
        bit = np.take_along_axis(bits, np.minimum(starts + place, bits.shape[1] - 1), axis=1)
        index |= np.where(is_anchor & (place == width - 1), 0, bit).astype(np.int32) << place
    return WEIGHTS[width][index]


def _rotated(texels: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Alpha swapped with the channel that the rotation names, 1 to 3; with none for 0."""
    order = np.tile(np.arange(4), (len(texels), 1))
    rows = np.flatnonzero(rotation)
    order[rows, rotation[rows] - 1], order[rows, ALPHA] = ALPHA, rotation[rows] - 1
    return np.take_along_axis(texels, order[:, None, :], axis=2)
