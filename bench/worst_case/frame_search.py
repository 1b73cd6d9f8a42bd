"""The largest rotation that a tangent frame codec can make, in float64, and the tangent frame that it turns so far.

Tangent frames are unit quaternions with a hand. The worst of many that are spread evenly are climbed from, in ever
smaller steps; a last climb starts from the best alone, with steps of every size. What is found is a rotation that some
tangent frame really suffers, so it is never above the supremum; `moved_deg` says by how much the last round of climbing
still raised it.

A rotation by theta moves the three axes by 8 sin^2(theta / 2) in all, the sum of their squared distances.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial

import jax
import jax.numpy as jnp
import numpy as np

from ...encodings.codecs.frame_codec import FrameCodec
from ...encodings.rotation import Frame, frame_of, frame_of_quaternion
from ...encodings.vec import Vec4, cross, dot, normalize
from ..machine.cores import on_all_cores
from .cells import column_peaks
from .exact_codec import BLOCK, WAYS, degrees

LANES, STEPS, ROUNDS = BLOCK // WAYS, 80, 12
SPREAD, KEPT = 2**20, 2**8
# Of steps, in the error: the first of each round, and how they grow and shrink.
FIRST_SIZES, GROW, SHRINK, LEAST = (0.5, 0.05), 1.5, 0.55, 1e-10
SETTLED = 1e-8
# What a rotation by 180 degrees moves the axes; what comes back as no tangent frame counts as that.
FARTHEST = 8.0
# Steps of an additive sequence in three dimensions, x^-1, x^-2 and x^-3 with x^4 = x + 1 (M. Roberts 2018); and in two.
THREE, TWO = (0.8191725133961645, 0.6710436067037893, 0.5497004779019703), (0.7548776662466927, 0.5698402909980532)


@dataclass(frozen=True)
class WorstFrame:
    """A codec's largest rotation.

    Attributes:
        angle_deg: the supremum as it was found.
        quaternion: x, y, z, w of the tangent frame that is turned so far.
        hand: its handedness, 1 or -1.
        moved_deg: how much the last round of climbing still raised it.
    """

    angle_deg: float
    quaternion: tuple[float, float, float, float]
    hand: float
    moved_deg: float


@dataclass(frozen=True)
class _Frames:
    """Squared moves, shape (count,), of quaternions, (4, count), with hands, (count,)."""

    moves: np.ndarray
    quaternions: np.ndarray
    hands: np.ndarray

    def best(self, count: int) -> _Frames:
        """Those that are moved the most, at most `count`."""
        return self[np.argsort(-self.moves, kind="stable")[:count]]

    def filled(self) -> _Frames:
        """LANES of them, each as often as it takes."""
        return self[np.arange(LANES) % len(self.moves)]

    def __getitem__(self, which: np.ndarray) -> _Frames:
        return _Frames(self.moves[which], self.quaternions[:, which], self.hands[which])


@cache
def worst_frame(codec: FrameCodec) -> WorstFrame:
    """The largest rotation over all tangent frames of either hand."""
    moves = jax.jit(partial(_moves, codec))
    climb = jax.jit(partial(_climbed, codec))
    with jax.enable_x64(True):
        best = _worst_of(moves)
        for size in FIRST_SIZES:
            best = _climb(climb, best.filled(), np.full(LANES, size)).best(KEPT)
        angle, moved = _degrees(best.moves[0]), math.inf
        for _ in range(ROUNDS):
            best = _climb(climb, best.best(1).filled(), np.geomspace(1e-9, 1.0, LANES)).best(1)
            moved, angle = _degrees(best.moves[0]) - angle, _degrees(best.moves[0])
            if moved <= SETTLED * angle:
                break
    x, y, z, w = (float(c) for c in best.quaternions[:, 0])
    return WorstFrame(angle, (x, y, z, w), float(best.hands[0]), moved)


def _moves(codec: FrameCodec, quaternions, hands):
    """How far the axes of tangent frames are moved in all, squared; FARTHEST where what comes back is no frame."""
    given = frame_of_quaternion(Vec4(*quaternions), hands)
    found = _at_right_angles(codec.round_trip(frame_of(*given)))
    pairs = zip((*given[:2], cross(*given[:2])), (*found[:2], cross(*found[:2])), strict=True)
    moved = sum(dot(a - b, a - b) for a, b in pairs)
    return jnp.where(jnp.isfinite(moved), jnp.minimum(moved, FARTHEST), FARTHEST)


def _at_right_angles(frame: Frame) -> Frame:
    """A frame's axes at length 1, the tangent across the normal."""
    n = normalize(frame.normal)
    return Frame(n, normalize(frame.tangent - n * dot(n, frame.tangent)), frame.hand)


def _worst_of(moves: Callable) -> _Frames:
    """The worst of tangent frames that are spread evenly by Haar's measure (K. Shoemake 1992), of either hand."""

    def block(start: int) -> _Frames:
        index = np.arange(start, start + BLOCK) + 0.5
        u, a, b = (np.modf(index * step)[0] * turn for step, turn in zip(THREE, (1, 2 * np.pi, 2 * np.pi), strict=True))
        low, high = np.sqrt(1 - u), np.sqrt(u)
        q = np.stack([low * np.sin(a), low * np.cos(a), high * np.sin(b), high * np.cos(b)])
        hands = np.where(np.arange(BLOCK) % 2, 1.0, -1.0)
        with jax.enable_x64(True):
            found, at = column_peaks(np.asarray(moves(q, hands)), KEPT)
        return _Frames(found, q[:, at], hands[at])

    parts = list(on_all_cores(block, range(0, SPREAD, BLOCK)))
    joined = (np.concatenate([getattr(p, name) for p in parts], axis=-1) for name in ("moves", "quaternions", "hands"))
    return _Frames(*joined).best(LANES)


def _climb(climbed: Callable, starts: _Frames, first: np.ndarray) -> _Frames:
    """LANES tangent frames, each moved to the worst of WAYS around it; steps shrink where none is worse."""
    moves, quaternions = starts.moves, starts.quaternions
    sizes = first * _radians(moves)
    for step in range(STEPS):
        moves, quaternions, sizes = climbed(moves, quaternions, starts.hands, sizes, float(step))
        if (np.asarray(sizes) < LEAST * _radians(np.asarray(moves))).all():
            break
    return _Frames(np.asarray(moves), np.asarray(quaternions), starts.hands)


def _climbed(codec: FrameCodec, moves, quaternions, hands, sizes, step):
    """One step of a climb."""
    around = _around(quaternions, sizes, step)
    tried = _moves(codec, around.reshape(4, -1), jnp.tile(hands, WAYS)).reshape(WAYS, LANES)
    way, lane = tried.argmax(axis=0), jnp.arange(LANES)
    is_worse = tried[way, lane] > moves
    return (
        jnp.where(is_worse, tried[way, lane], moves),
        jnp.where(is_worse, around[:, way, lane], quaternions),
        sizes * jnp.where(is_worse, GROW, SHRINK),
    )


def _around(quaternions, sizes, step):
    """WAYS quaternions around each, turned about axes all around, by four angles; shape (4, WAYS, LANES)."""
    way, lane = jnp.arange(WAYS, dtype=sizes.dtype)[:, None], jnp.arange(LANES, dtype=sizes.dtype)[None, :]
    index = way + WAYS * step + 0.5 * lane
    height, turn = (2.0 * jnp.modf(index * part)[0] - 1.0 for part in TWO)
    across, half = jnp.sqrt(1.0 - height * height), 0.5 * sizes[None, :] * 0.4 ** (way % 4)
    a, b, c = half * across * jnp.cos(np.pi * turn), half * across * jnp.sin(np.pi * turn), half * height
    x, y, z, w = quaternions[:, None]
    # q (a, b, c, 1): turned about its own axes.
    vector = [x + w * a + y * c - z * b, y + w * b + z * a - x * c, z + w * c + x * b - y * a]
    turned = jnp.stack([*vector, w - x * a - y * b - z * c])
    return turned / jnp.sqrt((turned * turned).sum(axis=0, keepdims=True))


def _radians(moves):
    return 2.0 * np.arcsin(np.sqrt(np.clip(moves / FARTHEST, 0.0, 1.0)))


def _degrees(moves: float) -> float:
    # The chord of the same angle has 4 sin^2(theta / 2).
    return degrees(moves / 2)
