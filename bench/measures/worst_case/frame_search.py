"""The largest rotation that a tangent frame codec causes, in float64, and the tangent frame that it rotates most.

Tangent frames are unit quaternions with a handedness. Many are spread evenly, and climbs start from the worst of
them, in ever smaller steps; a last climb starts from the best result alone, with steps of every size. The result is a
rotation that some tangent frame really undergoes, so it is never above the supremum; `moved_deg` is the increase in
the last round of climbing.

If a rotation by theta moves the three axes, the sum of their squared distances is 8 sin^2(theta / 2).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial, reduce
from operator import add

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.frame_codec import FrameCodec
from ....encodings.rotation import Frame, frame_of, rotated_frame
from ....encodings.vec import Vec4, cross, dot, normalize
from ...ground.machine.cores import on_all_cores
from .cells import column_peaks
from .climb import KEPT, WAYS, Ground, Starts, highest
from .exact_codec import BLOCK, degrees

LANES, SPREAD = BLOCK // WAYS, 2**20
FIRST_SIZES = (0.5, 0.05)  # of the first step of each round, in the error
# What a rotation by 180 degrees moves the axes; what comes back as no tangent frame counts as that.
FARTHEST = 8.0
# Steps of an additive sequence in three dimensions, x^-1, x^-2 and x^-3 with x^4 = x + 1 (M. Roberts 2018); and in two.
THREE, TWO = (0.8191725133961645, 0.6710436067037893, 0.5497004779019703), (0.7548776662466927, 0.5698402909980532)


@dataclass(frozen=True)
class WorstFrame:
    """A codec's largest rotation.

    Attributes:
        angle_deg: the supremum, as found by the search.
        quaternion: x, y, z, w of the tangent frame with this rotation.
        hand: the frame's handedness, 1 or -1.
        moved_deg: the increase of the angle in the last round of climbing.
    """

    angle_deg: float
    quaternion: tuple[float, float, float, float]
    hand: float
    moved_deg: float


@cache
def worst_frame(codec: FrameCodec) -> WorstFrame:
    """Return the largest rotation by a round trip that a search over tangent frames finds, and the rotated frame."""
    program = jax.jit(partial(_moves, codec))

    def moves(frames: np.ndarray) -> np.ndarray:
        with jax.enable_x64(True):
            return np.asarray(program(frames[:4], frames[4]))

    best, moved = highest(
        Ground(moves, _frames_around, _radians, _degrees, LANES), _worst_of(moves), LANES, FIRST_SIZES
    )
    x, y, z, w, hand = (float(c) for c in best.places[:, 0])
    return WorstFrame(_degrees(best.chords[0]), (x, y, z, w), hand, moved)


def _moves(codec: FrameCodec, quaternions, hands):
    """Return for each tangent frame the sum of the squared distances by which a round trip moves its axes; FARTHEST
    if the result is not a frame."""
    given = rotated_frame(Vec4(*quaternions), hands)
    decoded = _at_right_angles(codec.round_trip(frame_of(*given)))
    pairs = zip((*given[:2], cross(*given[:2])), (*decoded[:2], cross(*decoded[:2])), strict=True)
    moved = sum(dot(a - b, a - b) for a, b in pairs)
    return jnp.where(jnp.isfinite(moved), jnp.minimum(moved, FARTHEST), FARTHEST)


def _at_right_angles(frame: Frame) -> Frame:
    """Return a frame with axes of length 1 and its tangent perpendicular to its normal."""
    n = normalize(frame.normal)
    return Frame(n, normalize(frame.tangent - n * dot(n, frame.tangent)), frame.hand)


def _worst_of(moves: Callable[[np.ndarray], np.ndarray]) -> Starts:
    """Return as starts the worst LANES of many tangent frames of both hands, spread evenly according to the Haar
    measure (K. Shoemake 1992): their quaternions and hands, shape (5, LANES)."""

    def block(start: int) -> Starts:
        index = np.arange(start, start + BLOCK) + 0.5
        u, a, b = (np.modf(index * step)[0] * turn for step, turn in zip(THREE, (1, 2 * np.pi, 2 * np.pi), strict=True))
        low, high = np.sqrt(1 - u), np.sqrt(u)
        hands = np.where(np.arange(BLOCK) % 2, 1.0, -1.0)
        frames = np.stack([low * np.sin(a), low * np.cos(a), high * np.sin(b), high * np.cos(b), hands])
        peaks, indices = column_peaks(moves(frames), KEPT)
        return Starts(peaks, frames[:, indices])

    return reduce(add, on_all_cores(block, range(0, SPREAD, BLOCK))).best(LANES)


def _frames_around(frames: np.ndarray, sizes: np.ndarray, step: int) -> np.ndarray:
    """Return WAYS tangent frames around each frame, rotated by four angles about axes in all directions: shape
    (5, WAYS, count)."""
    way, lane = np.arange(WAYS)[:, None], np.arange(len(sizes))[None, :]
    index = way + WAYS * step + 0.5 * lane
    height, turn = (2.0 * np.modf(index * part)[0] - 1.0 for part in TWO)
    across, half = np.sqrt(1.0 - height * height), 0.5 * sizes[None, :] * 0.4 ** (way % 4)
    a, b, c = half * across * np.cos(np.pi * turn), half * across * np.sin(np.pi * turn), half * height
    x, y, z, w, hand = frames[:, None]
    # q (a, b, c, 1): turned about its own axes.
    vector = [x + w * a + y * c - z * b, y + w * b + z * a - x * c, z + w * c + x * b - y * a]
    turned = np.stack([*vector, w - x * a - y * b - z * c])
    return np.concatenate([turned / np.linalg.norm(turned, axis=0), np.broadcast_to(hand, (1, *index.shape))])


def _radians(moves):
    return 2.0 * np.arcsin(np.sqrt(np.clip(moves / FARTHEST, 0.0, 1.0)))


def _degrees(moves: float) -> float:
    # The chord of the same angle has 4 sin^2(theta / 2).
    return degrees(moves / 2)
