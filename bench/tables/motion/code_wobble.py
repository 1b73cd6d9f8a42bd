"""The wobble of encoded normals alone, without a renderer or light.

e_t is the decoded normal minus the true normal at frame t, in the space in which the surface is fixed. The wobble is
W = RMS over points and frames of |e_{t+1} - e_t|. If the errors of two frames are independent, W is sqrt(2) times the
RMS of |e_t|.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce

import numpy as np

from ...subjects.normals.domains import in_domain
from ..table import Row
from . import turning
from .trips import Trip


@dataclass(frozen=True)
class Frame:
    """The results for all points in a frame.

    Attributes:
        error: decoded minus true normal on the surface, both of length 1, float64 of shape (count, 3).
        codes: stored codes, (count, numbers).
        counts: whether the normal is in the encoding's domain, bool of shape (count,).
    """

    error: np.ndarray
    codes: np.ndarray
    counts: np.ndarray


@dataclass
class WobbleTotal:
    """Totals over frames and pairs of frames; angles are small, so unit vectors differ by an angle in radians."""

    points: int = 0
    squares: float = 0.0
    invalid: int = 0
    pairs: int = 0
    changes: float = 0.0
    jumps: int = 0
    jump_sum: float = 0.0

    def add(self, frame: Frame) -> None:
        """Add the errors of a frame."""
        self.points += int(np.count_nonzero(frame.counts))
        self.squares += float(np.sum(frame.error[frame.counts] ** 2))

    def add_pair(self, frame: Frame, other: Frame) -> None:
        """Add the changes from one frame to the next."""
        both = frame.counts & other.counts
        change = _row_lengths(other.error - frame.error)[both]
        jumped = reduce(np.logical_or, (other.codes != frame.codes).T)[both]
        self.pairs += len(change)
        self.changes += float(np.sum(change**2))
        self.jumps += int(np.count_nonzero(jumped))
        self.jump_sum += float(np.sum(change[jumped]))

    def row(self) -> Row:
        """Return the figures as columns; only `invalid` if no normal was followed from one frame to the next."""
        if not self.pairs:
            return {"invalid": self.invalid}
        static = math.degrees(math.sqrt(self.squares / self.points))
        wobble = math.degrees(math.sqrt(self.changes / self.pairs))
        row: Row = {"static_rms_deg": static, "wobble_deg": wobble, "invalid": self.invalid, "exact": static == 0}
        row["ratio"] = wobble / (math.sqrt(2) * static) if static else None
        row["jumps_percent"] = 100.0 * self.jumps / self.pairs
        row["jump_deg"] = math.degrees(self.jump_sum / self.jumps) if self.jumps else 0.0
        return row


@dataclass(frozen=True)
class Motion:
    """A rotation of the camera or of an object.

    Attributes:
        space, moves: elements of turning.SPACES and turning.MOVES.
        axis: element of gbuffer's TURNS.
        turn: degrees per frame.
        frames: number of frames, 2 or more.
    """

    space: str
    moves: str
    axis: str
    turn: float
    frames: int

    @property
    def is_still(self) -> bool:
        """Whether every frame has the same codes: normals on a still surface, encoded in world space."""
        return (self.space, self.moves) == ("world", "camera")

    def matrices(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield the matrices that rotate normals and positions in each frame, (3, 3) each; only two pairs if every
        frame has the same codes."""
        turned = turning.rotations(self.axis, self.turn, 2 if self.is_still else self.frames)
        still = np.broadcast_to(np.eye(3), turned.shape)
        yield from zip(still if self.is_still else turned, turned if self.moves == "camera" else still, strict=True)

    def followed(self, count: int) -> int:
        """Return the number of normals to follow if `count` are requested: more if only two frames are needed."""
        return count * max(self.frames // 2, 1) if self.is_still else count


def code_wobble(trip: Trip, domain: str, motion: Motion, count: int, seed: int) -> Row:
    """Return the columns on a codec's normals that are followed during a rotation.

    Args:
        trip: round trip of the codec.
        domain: domain of the encoding; normals outside it do not count.
        motion: the rotation.
        count: requested number of normals.
        seed: seed for turning.points.
    """
    total, followed = WobbleTotal(), motion.followed(count)
    for points in turning.points(motion.space, followed, seed):
        before: Frame | None = None
        for of_normals, of_positions in motion.matrices():
            n = (points.normals @ of_normals.T).astype(np.float32)
            view = (points.positions @ of_positions.T).astype(np.float32)
            now = _frame(trip, domain, n, view, of_normals, total)
            total.add(now)
            if before:
                total.add_pair(before, now)
            before = now
    return total.row() | {"count": followed}


def _frame(trip: Trip, domain: str, n: np.ndarray, view: np.ndarray, matrix: np.ndarray, total: WobbleTotal) -> Frame:
    codes, decoded = trip(n, view)
    n, decoded = _unit_rows(n.astype(np.float64)), decoded.astype(np.float64)
    length = _row_lengths(decoded)
    valid = np.isfinite(length) & (length > 0)
    decoded = np.where(valid[:, None], decoded / np.where(valid, length, 1.0)[:, None], -n)
    counts = in_domain(n, view, domain)
    total.invalid += int(np.count_nonzero(~valid & counts))
    # In the space that the surface is fixed in: the difference is small, and turning it loses nothing.
    return Frame((decoded - n) @ matrix, codes, counts)


def _row_lengths(v: np.ndarray) -> np.ndarray:
    """Return the length of each row, computed by columns because NumPy sums rows of three numbers more slowly."""
    x, y, z = v.T
    return np.sqrt(x * x + y * y + z * z)


def _unit_rows(v: np.ndarray) -> np.ndarray:
    return v / _row_lengths(v)[:, None]
