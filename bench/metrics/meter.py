"""What is measured of a decoded normal, accumulated in a stream.

The angle between a and b is atan2(|a x b|, a . b). Written as a x (b - a) the cross product needs no more than float32:
the difference of two close floats is exact, so the angle keeps six digits however small it is, where the arc cosine of
a float32 dot product cannot tell angles below 0.02 degrees from zero. Sums are float64. Percentiles come from a
histogram whose bins are 2^-10 of an octave wide, so they hold to 0.1 %.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from threading import Lock
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from ...encodings.codecs.codec import Codec
from ...encodings.elementary import atan2_pi
from ...encodings.vec import Vec3, cross, dot, minimum, select
from ..machine.cores import on_all_cores
from .angles import angles_deg

BLOCK = 2**14
FAST_BLOCK = 2**15
LANES = 256
# Bins of the angle's histogram: the upper bits of a float32, ten of them mantissa, from 2^-40 degrees to 180 and above.
BIN_SHIFT = 13
FIRST_BIN = int(np.float32(2.0**-40).view(np.uint32)) >> BIN_SHIFT
BINS = (int(np.float32(256.0).view(np.uint32)) >> BIN_SHIFT) - FIRST_BIN
UNCOVERED = BINS
# A row keeps eight bins of an octave: three bits of mantissa.
BINS_TOGETHER = 2**7


def idle() -> None:
    """What is done at each chunk when nobody watches."""


class Sums(NamedTuple):
    """Sums over lanes: squared error, the article's squared error (in units of 1/255), angle and its square (degrees),
    and how many decodes were no number."""

    squared: Any
    article_squared: Any
    angle: Any
    angle_squared: Any
    invalid: Any


def angle_between(a: Vec3, b: Vec3):
    """The angle between a unit vector and one of any length, in degrees; 180 where the other is zero."""
    crossed = cross(a, b - a)
    across = jnp.sqrt(dot(crossed, crossed))
    return jnp.where(dot(b, b) > 0.0, 180.0 * atan2_pi(across, dot(a, b)), 180.0)


def readable(n: Vec3, decoded: Vec3) -> tuple[Vec3, Any]:
    """Decodes, the opposite direction where one is not a number; and which of them are numbers."""
    finite = jnp.isfinite(dot(decoded, decoded))
    return select(finite, decoded, -n), finite


def _errors(n: Vec3, decoded: Vec3, covered):
    """Per normal: squared error, the article's squared error, angle, and 1 where the decode is not a number.

    Such a decode counts as the opposite direction.
    """
    decoded, finite = readable(n, decoded)
    difference = select(covered, n - decoded, n * 0.0)
    # The article's difference image was |n - n'| in eight bits per channel.
    eighths = Vec3(*(jnp.round(minimum(abs(c), 1.0) * 255.0) for c in difference))
    angle = jnp.where(covered, angle_between(n, decoded), 0.0)
    invalid = jnp.where(finite | ~covered, 0.0, 1.0).astype(jnp.float32)
    return dot(difference, difference), dot(eighths, eighths), angle, invalid


def _histogram_key(angle, covered):
    key = (angle.view(jnp.uint32) >> BIN_SHIFT).astype(jnp.int32) - FIRST_BIN
    return jnp.where(covered, jnp.clip(key, 0, BINS - 1), UNCOVERED)


class Decoded(NamedTuple):
    """CHUNK normals, what they were decoded as, and which of them count."""

    n: Vec3
    decoded: Vec3
    covered: Any


def _blocks(chunk):
    return jax.tree.map(lambda a: a.reshape(-1, BLOCK // LANES, LANES), chunk)


def _traced_scan(chunk: Decoded):
    """Sums (float64 over lanes), the largest angle and each normal's histogram bin, for one chunk."""

    def step(carry, block: Decoded):
        sums, largest = carry
        squared, article_squared, angle, invalid = _errors(*block)
        key = _histogram_key(angle, block.covered)
        # The barrier makes XLA compute each number once, in one loop, before it is reduced several ways.
        squared, article_squared, angle, invalid, key = jax.lax.optimization_barrier(
            (squared, article_squared, angle, invalid, key)
        )
        parts = (squared, article_squared, angle, angle * angle, invalid)
        added = Sums(*(s + p.astype(jnp.float64).sum(0) for s, p in zip(sums, parts, strict=True)))
        return (added, jnp.maximum(largest, angle.max(0))), key

    zero = jnp.zeros(LANES, jnp.float64)
    start = (Sums(*[zero] * len(Sums._fields)), zero.astype(jnp.float32))
    (sums, largest), keys = jax.lax.scan(step, start, _blocks(chunk))
    return Sums(*(s.sum() for s in sums)), largest.max(), keys.ravel()


def compiled(function):
    """`function` jitted with the widest vectors XLA will use: 1.2 to 1.5 times as fast where there are 512 bits."""
    wide = jax.jit(function, compiler_options={"xla_cpu_prefer_vector_width": 512})
    usable = [wide]

    def call(*arguments):
        try:
            return usable[0](*arguments)
        except Exception:
            # The option is XLA's own affair and may go away, and another back end has never heard of it. Whatever else
            # was wrong is raised again by the plain function.
            if usable[0] is not wide:
                raise
            usable[0] = jax.jit(function)
            return usable[0](*arguments)

    return call


_scan = compiled(_traced_scan)
# Sums, the largest angle, how many normals lie in each bin of the histogram, and the normal with the largest angle.
Part = tuple[np.ndarray, float, np.ndarray, "Worst | None"]


def squared_errors(codec: Codec):
    """The fastest path: squared error alone, over normals in memory.

    Returns:
        a function of (n, view), planes of a multiple of FAST_BLOCK float32 normals, that gives the sum and the largest
        of |n - n'|^2, float64. One call is one core's work; run shards side by side.
    """

    def scan(n: Vec3, view: Vec3):
        def step(carry, block):
            total, largest = carry
            difference = block[0] - codec.round_trip(*block)
            squared = jax.lax.optimization_barrier(dot(difference, difference))
            return (total + squared.sum(0).astype(jnp.float64), jnp.maximum(largest, squared.max(0))), None

        blocks = jax.tree.map(lambda a: a.reshape(-1, FAST_BLOCK // LANES, LANES), (n, view))
        start = (jnp.zeros(LANES, jnp.float64), jnp.zeros(LANES, jnp.float32))
        (total, largest), _ = jax.lax.scan(step, start, blocks)
        return total.sum(), largest.max().astype(jnp.float64)

    call = compiled(scan)

    def run(n: Vec3, view: Vec3) -> tuple[float, float]:
        with jax.enable_x64(True):
            total, largest = call(n, view)
            return float(total), float(largest)

    return run


@dataclass(frozen=True)
class Statistics:
    """What a set of normals lost in a codec.

    Attributes:
        count: normals that count; background is left out.
        pixels: all of them, background included.
        invalid: decodes that were no number; each counts as the opposite direction.
        mse: mean squared error over the three components of covered normals, not renormalised.
        article_mse: the article's: |n - n'| rounded to 8 bits, over every pixel.
        angle_mean_deg, angle_rms_deg, angle_p99_deg, angle_max_deg: of the angle between input and decode.
        angle_counts: how many angles lie in each eighth of an octave that has any, by its lower edge in degrees; the
            first holds 0 as well.
        within: for each power of two of degrees, ascending, how many angles are below it.
        worst: the normal that came back farthest off.
    """

    count: int
    pixels: int
    invalid: int
    mse: float
    article_mse: float
    angle_mean_deg: float
    angle_rms_deg: float
    angle_p99_deg: float
    angle_max_deg: float
    angle_counts: tuple[tuple[float, int], ...]
    within: tuple[tuple[float, int], ...]
    worst: Worst | None


@dataclass(frozen=True)
class Worst:
    """The normal that came back farthest off, what it came back as, float32 of shape (3,), and by how many degrees."""

    normal: np.ndarray
    decoded: np.ndarray
    angle_deg: float

    def __str__(self) -> str:
        normal, decoded = (", ".join(str(c) for c in v) for v in (self.normal, self.decoded))
        return f"({normal}) comes back as ({decoded}), {self.angle_deg:.6g} degrees off"


def psnr_db(mse: float) -> float:
    """Peak signal to noise ratio for a peak of 1, infinite where there is no error."""
    return 10 * math.log10(1 / mse) if mse > 0 else math.inf


def _percentile(histogram: np.ndarray, largest: float, share: float) -> float:
    """The value below which `share` of the counts lie, interpolated within its bin."""
    cumulative = np.cumsum(histogram[:BINS])
    rank = share * cumulative[-1]
    index = int(np.searchsorted(cumulative, rank))
    edges = ((np.arange(index, index + 2) + FIRST_BIN) << BIN_SHIFT).astype(np.uint32).view(np.float32)
    within = (rank - (cumulative[index] - histogram[index])) / histogram[index]
    return min(float(edges[0] + within * (edges[1] - edges[0])), largest) if largest else 0.0


def _counts(histogram: np.ndarray) -> tuple[tuple[float, int], ...]:
    counts = histogram[:BINS].reshape(-1, BINS_TOGETHER).sum(axis=1)
    edges = ((np.arange(0, BINS, BINS_TOGETHER) + FIRST_BIN) << BIN_SHIFT).astype(np.uint32).view(np.float32)
    edges[0] = 0
    return tuple((float(edges[i]), int(counts[i])) for i in np.flatnonzero(counts))


def _within(histogram: np.ndarray) -> tuple[tuple[float, int], ...]:
    octave = 2 ** (23 - BIN_SHIFT)
    below = np.cumsum(histogram[:BINS])[octave - 1 :: octave]
    first = np.log2(np.uint32(FIRST_BIN << BIN_SHIFT).view(np.float32))
    return tuple((float(2.0 ** (first + k + 1)), int(count)) for k, count in enumerate(below))


def _worst(keys: np.ndarray, n: Vec3, decoded: Vec3) -> Worst | None:
    """The normal of a chunk with the largest angle, among those of the highest bin; None where none counts."""
    highest = int(np.max(keys, where=keys < BINS, initial=-1))
    if highest < 0:
        return None
    at = np.flatnonzero(keys == highest)
    normals, found = ([np.asarray(plane).ravel()[at] for plane in planes] for planes in (n, decoded))
    # What comes back as it was has an angle of 0: the first of these stands for all.
    moved = np.any([a != b for a, b in zip(normals, found, strict=True)], axis=0)
    some = np.concatenate([[0], np.flatnonzero(moved)])
    normals, found = (np.stack([plane[some] for plane in planes], axis=1) for planes in (normals, found))
    angles = _angles(normals, found)
    first = int(np.argmax(angles))
    return Worst(normals[first], found[first], float(angles[first]))


def _angles(n: np.ndarray, decoded: np.ndarray) -> np.ndarray:
    """As `angle_between`, in float64, of rows; 180 where a decode is not a number."""
    with np.errstate(invalid="ignore", over="ignore"):
        angles = angles_deg(n, decoded)
    return np.where(np.isfinite(decoded).all(axis=1) & (decoded != 0).any(axis=1), angles, 180.0)


class Total:
    """What chunks add up to."""

    def __init__(self):
        self.sums, self.largest, self.histogram = np.zeros(len(Sums._fields)), 0.0, np.zeros(BINS + 1, np.int64)
        self.worst: Worst | None = None

    def add(self, part: Part) -> None:
        """One chunk's sums, largest angle, histogram and worst normal."""
        sums, largest, counts, worst = part
        self.sums, self.largest, self.histogram = self.sums + sums, max(self.largest, largest), self.histogram + counts
        if worst and (self.worst is None or worst.angle_deg > self.worst.angle_deg):
            self.worst = worst


class Once:
    """A load that is done once, by whoever asks first, and kept for the others."""

    def __init__(self, load: Callable[[], Any]):
        self._load, self._lock = load, Lock()

    def __call__(self) -> Any:
        with self._lock:
            if self._load:
                self._value, self._load = self._load(), None
        return self._value


class Meter:
    """Measures what a decoder makes of normal sets; compiled once and used for every chunk.

    Two programs: the decoder's own, and the statistics', which is the same for all and takes longer to compile.

    Args:
        decode: a jitted function from a block to decoded normals. A block is a pytree of planes with the unit normals
            `n`, which of them count, `covered`, and whatever else the decoder needs.
        given: what it is called with besides, the same for every block.
    """

    def __init__(self, decode: Callable[..., Vec3], given: Sequence[Any] = ()):
        self._decode, self._given = decode, given

    def decoded(self, block: Any) -> Vec3:
        """What a block is decoded as."""
        return self._decode(block, *self._given)

    def one(self, load: Callable[[], Any]) -> Part:
        """One chunk's part of the statistics."""
        with jax.enable_x64(True):
            chunk = jax.tree.map(jnp.asarray, load())
            decoded = self.decoded(chunk)
            sums, largest, keys = _scan(Decoded(chunk.n, decoded, chunk.covered))
            keys = np.asarray(keys)
            histogram = np.bincount(keys, minlength=BINS + 1)
            return np.array([float(s) for s in sums]), float(largest), histogram, _worst(keys, chunk.n, decoded)

    def measure(self, loads: Iterable[Callable[[], Any]], pixels: int, tick: Callable[[], None] = idle) -> Statistics:
        """Statistics of a set, its chunks shared among the cores.

        Args:
            loads: for each chunk a function that gives it. The iterable is run in the calling thread, which a GL
                context is bound to; the functions in worker threads.
            pixels: how many normals the set has, background included.
            tick: called when a chunk is done.
        """
        return measure_together([self], loads, pixels, lambda _: tick())[0]


def measure_together(
    meters: Sequence[Meter],
    loads: Iterable[Callable[[], Any]],
    pixels: int,
    tick: Callable[[int], None],
) -> list[Statistics]:
    """What each meter measures of one set, each chunk of which is made once; `tick` is told whose chunk is done.

    The rest is as for `Meter.measure`.
    """
    totals = [Total() for _ in meters]
    whose = itertools.cycle(range(len(meters)))
    work = ((meter, once) for once in map(Once, loads) for meter in meters)
    for part in on_all_cores(lambda item: item[0].one(item[1]), work):
        index = next(whose)
        totals[index].add(part)
        tick(index)
    return [_statistics(pixels, total) for total in totals]


def _statistics(pixels: int, total: Total) -> Statistics:
    largest, histogram = total.largest, total.histogram
    count = int(histogram[:BINS].sum())
    squared, article_squared, angle, angle_squared, invalid = total.sums
    return Statistics(
        count=count,
        pixels=pixels,
        invalid=int(invalid),
        mse=squared / (3 * count),
        article_mse=article_squared / 255**2 / (3 * pixels),
        angle_mean_deg=angle / count,
        angle_rms_deg=math.sqrt(angle_squared / count),
        angle_p99_deg=_percentile(histogram, largest, 0.99),
        angle_max_deg=largest,
        angle_counts=_counts(histogram),
        within=_within(histogram),
        worst=total.worst,
    )
