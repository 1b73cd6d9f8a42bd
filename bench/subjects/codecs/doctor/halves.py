"""The reason why a half of the sphere does not round-trip: by design, or because one of the functions loses it.

Each function is examined separately. The encoder knows the half if its directions have codes of their own, that is,
if the directions that these codes decode to have different codes. The decoder reaches the half if codes in the
square, used or not, decode to most of it. Neither is true of an encoding designed for the other half, such as xy,
which uses the disc, or hemi-octahedral, which uses the square.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from ....ground.directions import unit
from .between import SAME_DEG, axes_of
from .domains import Domain
from .probe import Probe, Trip

# Codes that are nearer than this in every number are the same; 8 bits have 256 of them.
SAME_CODE = 4e-3
# Of the directions of a half that have codes of their own, and of a half that is reached: which is most of it.
MOST_OF_IT = 0.5
# Of a half that is lost whole, but for what lies on its rim.
NEARLY_ALL = 0.95
# Rings of equal area of a half, and sectors of each.
RINGS, SECTORS = 16, 48
# Points across a square of codes, and across a cube.
ACROSS = {2: 128, 3: 32}
# How much of the square a code must use: a disc is 0.785 of it, the diamond of a map without its fold 0.5.
LEAST_USED = 0.6
# Cells across the square, which about 16 directions fall into each, and the share of them that lies on a rim at most.
CELLS, RIM_OF_CELLS = 16, 0.15


def square(size: int) -> np.ndarray:
    """Return codes on a regular grid over the full range of a storage, ends included, of shape (count, size)."""
    axis = np.linspace(-1, 1, ACROSS.get(size, 3))
    return np.array(list(itertools.product(axis, repeat=size)), np.float32)


class Sides:
    """How each function treats the directions that a hemisphere loses.

    Attributes:
        gone: the directions in the opposite half that do not round-trip.
        share: their share of the opposite half, in words; empty if nearly all are lost.
        encoder_knows: whether most of the lost directions have codes of their own.
        decoder_reaches: whether codes in the square decode to most of the lost directions.
    """

    def __init__(self, trip: Trip, probe: Probe, half: Domain):
        lost = half.lost(trip)
        self.gone = lost.of(lost.angles() > SAME_DEG)
        count, among = len(self.gone.n), len(lost.n)
        self.share = f"{count} of {among} " if count < NEARLY_ALL * among else ""
        codes, back = np.clip(self.gone.codes, -1, 1), probe.encode(unit(self.gone.decoded))
        own = (np.abs(codes - np.clip(back, -1, 1)) > SAME_CODE).any(axis=1)
        self.encoder_knows = bool(own.sum() > MOST_OF_IT * count)
        reached = _cells(unit(probe.decode(square(probe.size))), half)
        self.decoder_reaches = bool(np.isin(_cells(self.gone.n, half), reached).sum() > MOST_OF_IT * count)


def _cells(n: np.ndarray, half: Domain) -> np.ndarray:
    """Return the index of the cell of the sphere that contains each direction, for the half that is lost; negative
    for other directions and for directions that are not finite."""
    height = -half.side * n[:, half.axis]
    x, y = (n[:, (half.axis + step) % 3] for step in (1, 2))
    sector = np.floor((np.arctan2(y, x) / (2 * np.pi) + 0.5) * SECTORS).clip(max=SECTORS - 1)
    cells = np.floor(height * RINGS).clip(max=RINGS - 1) * SECTORS + sector
    return np.where(np.isfinite(cells), cells, -1)


def lost(sides: Sides, half: Domain) -> str:
    """Return in words which function loses the half that a hemisphere lacks; empty unless exactly one does."""
    axes = axes_of(sides.gone)
    which = f"{sides.share}directions with {half.lost_text}{f', which come back with {axes}' if axes else ''}"
    if sides.encoder_knows and not sides.decoder_reaches:
        return f"decode loses {which}: encode gives them codes of their own, but no code decodes to most of these"
    if sides.decoder_reaches and not sides.encoder_knows:
        reason = "it gives them the codes of other directions, although unused codes decode to them"
        return f"encode loses {which}: {reason}"
    return ""


def unread(probe: Probe, codes: np.ndarray) -> Iterator[str]:
    """Yield a line for each component that encode writes and decode does not read."""
    before = probe.decode(np.clip(codes, -1, 1))
    for number in range(probe.size):
        if np.ptp(np.clip(codes[:, number], -1, 1)) < SAME_CODE:
            continue
        changed = np.clip(codes, -1, 1).copy()
        changed[:, number] = np.random.default_rng(number).permutation(changed[:, number])
        if np.array_equal(probe.decode(changed), before):
            yield f"decode does not read component {number + 1} of the code, although encode writes it"


def unused(trip: Trip, probe: Probe) -> Iterator[str]:
    """Yield a line with the share of the square that codes use, if it is small; nothing for packed codes or codes
    that do not have two components."""
    cells = np.unique(np.floor((np.clip(trip.codes, -1, 1) * 0.5 + 0.5) * CELLS).clip(max=CELLS - 1), axis=0)
    # Cells at the rim count whole. Where most are used nothing is wasted, and encode is not asked for more.
    if probe.size != 2 or probe.is_packed or len(cells) / CELLS**2 > LEAST_USED + RIM_OF_CELLS:
        return
    codes = square(2)
    own = np.abs(codes - probe.encode(unit(probe.decode(codes)))).max(axis=1) < SAME_CODE
    if own.mean() < LEAST_USED:
        yield f"codes use {100 * own.mean():.0f}% of the square that the storage's bits cover"
