"""Errors of decoded normals, accumulated in a stream.

The angle between a and b is atan2(|a x b|, a . b). Float32 is enough if the cross product is written as
a x (b - a): the difference of two close floats is exact, so the angle keeps six digits however small it is. The arc
cosine of a float32 dot product cannot tell angles below 0.02 degrees from zero. Sums are float64. Percentiles come
from a histogram whose bins are 2^-10 of an octave wide, so they are accurate to 0.1%.
"""

from __future__ import annotations

import itertools
import operator
from collections.abc import Callable, Iterable, Sequence
from functools import reduce
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.elementary import atan2_pi
from ....encodings.vec import Vec3, cross, dot, minimum, select
from ...ground.angles import angles_deg
from ...ground.machine.cores import on_all_cores
from .histogram import bin_of, bins_of, tally
from .totals import ChunkTotal, ErrorTotal, Figures, Statistics, Worst, statistics

if TYPE_CHECKING:
    from jaxtyping import Array, ArrayLike, Bool, Float, Int, Num, Shaped, UInt

# Lanes that are summed apart, and the rows added to them at a time. XLA copies a computation into each of its uses, up
# to 15, and computes it anew for each. With 16 rows each number is computed once.
SUM_LANES, ROWS = 1024, 16
# A row's article error is at most 3 x 255^2 = 2^17.6: the sum of up to 86 rows leaves the bits from here to others.
INVALID_BIT = 24
# An angle in float32 below this share of another one is the smaller of the two in float64 as well.
SAME_ANGLE = 0.999

# What gives a chunk of normals.
Load = Callable[[], Any]


def idle() -> None:
    """Do nothing: the default function to call for each chunk."""


def angle_between(a: Vec3, b: Vec3) -> Float[Array, "*shape"]:
    """Return the angle, in degrees, between `a`, of length 1, and `b`, of any length; 180 where `b` is zero."""
    crossed = cross(a, b - a)
    across = jnp.sqrt(dot(crossed, crossed))
    return jnp.where(dot(b, b) > 0.0, 180.0 * atan2_pi(across, dot(a, b)), 180.0)


def readable(n: Vec3, decoded: Vec3) -> tuple[Vec3, Bool[Array, "*shape"]]:
    """Return the decoded normals, with -n in place of those that are not finite, and a mask of the finite normals."""
    finite = jnp.isfinite(dot(decoded, decoded))
    return select(finite, decoded, -n), finite


def errors(
    n: Vec3, decoded: Vec3, covered: Bool[ArrayLike, "*shape"]
) -> tuple[Float[Array, "*shape"], Float[Array, "*shape"], Float[Array, "*shape"], Bool[Array, "*shape"]]:
    """Return for each normal the squared error, the squared error as in the article (a whole number) and the angle in
    degrees, all float32, and whether the decoded normal is not finite, so that it counts as -n. Everything is 0 if
    the normal is not `covered`."""
    decoded, finite = readable(n, decoded)
    difference = select(covered, n - decoded, n * 0.0)
    # The article's difference image was |n - n'| in eight bits per channel.
    eighths = Vec3(*(jnp.round(minimum(abs(c), 1.0) * 255.0) for c in difference))
    angle = jnp.where(covered, angle_between(n, decoded), 0.0)
    return dot(difference, difference), dot(eighths, eighths), angle, ~finite & covered


def _packed(
    squared: Float[Array, "*shape"],
    article: Float[Array, "*shape"],
    angle: Float[Array, "*shape"],
    invalid: Bool[Array, "*shape"],
) -> tuple[Float[Array, "*shape"], Int[Array, "*shape"], Float[Array, "*shape"]]:
    """Return (squared, article, angle) as in `errors`, with `article` as int32 that has the invalid flag as bit
    INVALID_BIT."""
    return squared, jnp.asarray(article, jnp.int32) + (jnp.asarray(invalid, jnp.int32) << INVALID_BIT), angle


class Decoded(NamedTuple):
    """CHUNK normals, their decoded normals, and a mask of the normals that count."""

    n: Vec3
    decoded: Vec3
    covered: Bool[Array, "*shape"]


def _chunk_in_rows(chunk):
    return jax.tree.map(lambda a: a.reshape(-1, ROWS, SUM_LANES), chunk)


def _as_it_is(row):
    return row


def _added(start: Num[Array, " lanes"], rows: Num[Array, "rows lanes"], of=_as_it_is) -> Num[Array, " lanes"]:
    """Return `start` plus `of` each row, added row by row, so that the result does not depend on the size of a block.

    A row is computed and converted only when it is added. Otherwise XLA would first write whole blocks in float64.
    """
    return reduce(operator.add, (of(rows[row]).astype(start.dtype) for row in range(ROWS)), start)


def _traced_scan(chunk: Decoded) -> tuple[Float[Array, " figures"], Int[Array, " bins"], UInt[Array, " count"]]:
    """Return one chunk's figures, float64 in the order of `Figures`; the counts of normals by bin; and each normal's
    bin."""

    def step(carry: Figures, block: Decoded):
        # The barrier makes XLA compute each number once, in one loop, before it is reduced several ways.
        squared, article, angle = jax.lax.optimization_barrier(_packed(*errors(*block)))
        article = _added(jnp.zeros(SUM_LANES, jnp.int32), article).astype(jnp.int64)
        added = Figures(
            squared=_added(carry.squared, squared),
            article_squared=carry.article_squared + article % 2**INVALID_BIT,
            angle=_added(carry.angle, angle),
            angle_squared=_added(carry.angle_squared, angle, lambda row: row * row),
            invalid=carry.invalid + (article >> INVALID_BIT),
            largest=reduce(jnp.maximum, (angle[row] for row in range(ROWS)), carry.largest),
        )
        return added, bins_of(angle, block.covered)

    zero, whole = jnp.zeros(SUM_LANES, jnp.float64), jnp.zeros(SUM_LANES, jnp.int64)
    start = Figures(zero, whole, zero, zero, whole, zero.astype(jnp.float32))
    totals, bins = jax.lax.scan(step, start, _chunk_in_rows(chunk))
    figures = [*(total.sum().astype(jnp.float64) for total in totals[:-1]), totals.largest.max().astype(jnp.float64)]
    return jnp.stack(figures), tally(bins), bins.ravel()


_scan = jax.jit(_traced_scan)


def _worst(bins: UInt[np.ndarray, " count"], largest: float, n: Vec3, decoded: Vec3) -> Worst | None:
    """Return the normal with the largest angle in a chunk, from the bin of `largest`; None if no normal counts."""
    indices = np.flatnonzero(bins == bin_of(largest))
    if not indices.size:
        return None
    normals, decoded_normals = ([np.asarray(plane).ravel()[indices] for plane in planes] for planes in (n, decoded))
    # What comes back as it was has an angle of 0: the first of these stands for all.
    moved = np.any([a != b for a, b in zip(normals, decoded_normals, strict=True)], axis=0)
    some = np.concatenate([[0], np.flatnonzero(moved)])
    return worst_of(*(np.stack([plane[some] for plane in planes], axis=1) for planes in (normals, decoded_normals)))


def worst_of(normals: Float[np.ndarray, "count 3"], decoded: Float[np.ndarray, "count 3"]) -> Worst | None:
    """Return the normal that is farthest from its decoded normal, or the first such normal; None for empty arrays.
    Both arrays are float32."""
    if not len(normals):
        return None
    angles = _angles(normals, decoded)
    first = int(np.argmax(angles))
    return Worst(normals[first], decoded[first], float(angles[first]))


def is_smaller(largest: float, met_deg: float) -> bool:
    """Whether a chunk's largest angle, in float32, is surely below `met_deg`, an angle of another chunk."""
    return largest < SAME_ANGLE * met_deg


def _angles(n: Float[np.ndarray, "count 3"], decoded: Float[np.ndarray, "count 3"]) -> Float[np.ndarray, " count"]:
    """Return the angles between rows, in degrees, as `angle_between` does, in float64; 180 if a decoded normal is
    zero or not finite."""
    with np.errstate(invalid="ignore", over="ignore"):
        angles = angles_deg(n, decoded)
    return np.where(np.isfinite(decoded).all(axis=1) & (decoded != 0).any(axis=1), angles, 180.0)


def _on_device(plane: Shaped[Array | np.ndarray, "*shape"]) -> Shaped[Array, "*shape"]:
    """Return a plane as a JAX array. The check is ten times as fast as converting a JAX array again."""
    return plane if isinstance(plane, jax.Array) else jnp.asarray(plane)


class Measures(Protocol):
    """An object that measures chunks of normals."""

    def decoded(self, block: Any) -> Vec3:
        """Return the decoded normals of a block."""
        ...

    def one(self, load: Load, met_deg: float = 0.0, device: Any = None) -> ChunkTotal:
        """Return one chunk's figures, its histogram and its worst normal.

        Args:
            load: returns the chunk.
            met_deg: an angle found in another chunk. The worst normal is None if its angle is smaller.
            device: the JAX device that computes the results; None for any device.
        """
        ...


class Once:
    """A load that is run only once, on the first call; all calls return its result."""

    def __init__(self, load: Load):
        self._load, self._lock = load, Lock()

    def __call__(self) -> Any:
        with self._lock:
            if self._load:
                self._value, self._load = self._load(), None
        return self._value


class Meter:
    """A meter for the errors of a decoder on sets of normals; compiled once and used for every chunk.

    There are two programs: one for the decoder, and one for the statistics, which all decoders share and which takes
    longer to compile.

    Args:
        decode: a jitted function from a block to decoded normals. A block is a pytree of planes with the unit normals
            `n`, the mask `covered` of the normals that count, and everything else that the decoder needs.
        given: other arguments of `decode`, the same for every block.
    """

    def __init__(self, decode: Callable[..., Vec3], given: Sequence[Any] = ()):
        self._decode, self._given = decode, given

    def decoded(self, block: Any) -> Vec3:
        """Return the decoded normals of a block."""
        return self._decode(block, *self._given)

    def one(self, load: Load, met_deg: float = 0.0, device: Any = None) -> ChunkTotal:
        """Return one chunk's figures, histogram and worst normal, as `Measures.one` does."""
        with jax.enable_x64(True), jax.default_device(device):
            chunk = jax.tree.map(_on_device, load())
            decoded = self.decoded(chunk)
            outputs = jax.device_get(_scan(Decoded(chunk.n, decoded, chunk.covered)))
        figures, histogram, bins = Figures(*outputs[0].tolist()), *outputs[1:]
        if is_smaller(figures.largest, met_deg):
            return figures, histogram, None
        return figures, histogram, _worst(bins, figures.largest, chunk.n, decoded)

    def total(self, loads: Iterable[Load], tick: Callable[[], None] = idle) -> ErrorTotal:
        """Return the total over the chunks of a set, which are distributed over the cores.

        Args:
            loads: a function for each chunk, which returns the chunk. The iterable is run in the calling thread, to
                which an OpenGL context is bound; the functions are run in worker threads.
            tick: called when a chunk is done.
        """
        return measure_together([self], loads, lambda _: tick())[0]

    def measure(self, loads: Iterable[Load], pixels: int, tick: Callable[[], None] = idle) -> Statistics:
        """Return the statistics of `pixels` normals, background included; see `total` for the other arguments."""
        return statistics(pixels, self.total(loads, tick))


def measure_together(
    meters: Sequence[Measures],
    loads: Iterable[Load],
    tick: Callable[[int], None],
) -> list[ErrorTotal]:
    """Return the total over one set for each meter; each chunk is loaded once. `tick` is called with a meter's index
    for each chunk that the meter has measured.

    Chunks are distributed over all JAX devices. See `Meter.total` for `loads`.
    """
    totals = [ErrorTotal() for _ in meters]
    whose = itertools.cycle(range(len(meters)))
    dealt = zip(map(Once, loads), itertools.cycle(jax.local_devices()), strict=False)
    work = ((*each, *chunk) for chunk in dealt for each in zip(meters, totals, strict=True))

    def measured(item: tuple[Measures, ErrorTotal, Load, Any]) -> ChunkTotal:
        meter, total, load, device = item
        return meter.one(load, total.met_deg, device)

    for part in on_all_cores(measured, work):
        index = next(whose)
        totals[index].add(part)
        tick(index)
    return totals
