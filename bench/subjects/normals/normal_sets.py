"""Sets of normals to measure, made or read in chunks so that any count fits in memory."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from types import MappingProxyType
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.encoding import Encoding
from ....encodings.elementary import sincos_pi
from ....encodings.vec import Vec3, dot, from_array, sqrt
from ...ground.native.elementwise import NotElementwiseError
from ...ground.native.library import NoCompilerError
from ...ground.options.counts import DEFAULT_COUNT
from .fill import Fill

# The space of vertices and points, which no camera sees.
OBJECT = "object"
LACKS_RAYS = "it needs the view ray, which normals in object space do not have"
CHUNK_WIDTH = 512
CHUNK = CHUNK_WIDTH * CHUNK_WIDTH
# Larger sets are measured and kept in parts of so many normals, by several workers where there are some.
PART = 2**30

# R2 sequence (M. Roberts 2018): steps of 1/p and 1/p^2 with p the plastic number, p^3 = p + 1, in units of 2^-32; odd,
# so that neither coordinate repeats before 2^32.
PLASTIC = 1.3247179572447460
STEPS = tuple(round(2**32 / PLASTIC**k) | 1 for k in (1, 2))
# After 2^32 normals the sequence would come again. Each further turn is shifted by the next 32 bits of the steps.
TURN = 2**32
SHIFTS = tuple(int(2**64 / PLASTIC**k) % TURN for k in (1, 2))


class Chunk(NamedTuple):
    """CHUNK unit normals and their view-space positions, as planes, and which of the normals count."""

    n: Vec3
    view: Vec3
    covered: Any


@dataclass(frozen=True)
class NormalSet:
    """A set of normals.

    Attributes:
        name: the catalogue's key.
        title: the name that people see.
        area: the solid angle in steradians that the set covers uniformly; None if the set is not uniform.
        count: number of normals, including the background.
        shape: (height, width) of a set that is an image; otherwise None.
        seed: the seed that the set was made with.
        chunk: a function from a start index to a Chunk.
        background: number of normals that are not on a surface and do not count; None if that does not apply.
        not_finite: number of a file's normals that were NaN or infinite, which do not count either.
        code_space: for a file, the space that its normals are in: "view", "world" or "object".
        own_error_deg: for a file with rounded normals, the mean angle of the rounding error.
        of: for a part of a set, the indices of its chunks; None for all.
    """

    name: str
    title: str
    area: float | None
    count: int
    shape: tuple[int, int] | None
    seed: int
    chunk: Callable[[int], Chunk]
    background: int | None = None
    not_finite: int | None = None
    code_space: str | None = None
    own_error_deg: float | None = None
    of: range | None = None

    @property
    def has_rays(self) -> bool:
        """Whether the normals have view rays; normals in object space do not."""
        return self.code_space != OBJECT

    def serves(self, encoding: Encoding) -> bool:
        """Whether an encoding can be measured on the set: it needs no view rays, or the normals have them."""
        return self.has_rays or encoding.domain != "view"

    @property
    def starts(self) -> range:
        """The start indices of its chunks."""
        whole = range(0, self.count, CHUNK)
        return whole[self.of.start : self.of.stop] if self.of else whole

    @cached_property
    def parts(self) -> Sequence[NormalSet]:
        """The set in parts of at most PART normals, each with the total `count`; empty if one part is enough."""
        if self.of or self.count <= PART:
            return ()
        chunks = PART // CHUNK
        return [replace(self, of=range(start, start + chunks)) for start in range(0, len(self.starts), chunks)]

    def facing(self) -> NormalSet:
        """Return the set in which only normals that face the viewer count."""

        def chunk(start: int) -> Chunk:
            whole = self.chunk(start)
            return whole._replace(covered=np.asarray(whole.covered) & (np.asarray(dot(whole.n, whole.view)) <= 0))

        return replace(self, name=f"{self.name}, facing the viewer", chunk=chunk)

    def loads(self) -> Iterator[Callable[[], Chunk]]:
        """Return an iterator over functions that return the chunks, in order."""
        return (partial(self.chunk, start) for start in self.starts)


def _straight_ahead(like) -> Vec3:
    return Vec3(jnp.zeros_like(like), jnp.zeros_like(like), jnp.full_like(like, -1.0))


def _unit_interval(index, step: int, offset):
    """Return (offset + index * step + 0.5) / 2^32, with the first sum modulo 2^32; exact in float64, never 0 or 1."""
    fixed = index * jnp.uint32(step) + offset
    return (fixed.astype(jnp.float64) + 0.5) * 2.0**-32


def _direction(lane, start, offset_u, offset_v, *, whole: bool) -> Vec3:
    """Return directions distributed uniformly by area: z is uniform in [-1, 1] or [0, 1], and so is the angle around
    the z axis (Archimedes).

    Computed in float64 and rounded once, so that x, y and z have independent rounding errors, like any normal.
    Encodings that subtract z from 1 are sensitive to these errors.
    """
    u, v = (_unit_interval(start + lane, step, by) for step, by in zip(STEPS, (offset_u, offset_v), strict=True))
    # 1 - z^2 as a product, which does not cancel near the poles.
    z, r = (1.0 - 2.0 * u, 2.0 * sqrt(u * (1.0 - u))) if whole else (u, sqrt((1.0 - u) * (1.0 + u)))
    # An angle in half turns, in [-1, 1].
    sine, cosine = sincos_pi(2.0 * (v - jnp.round(v)))
    return Vec3(*(c.astype(jnp.float32) for c in (cosine * r, sine * r, z)))


@partial(jax.jit, static_argnames="whole")
def _uniform_chunk(start, count, *offsets, whole: bool) -> Chunk:
    lane = jnp.arange(CHUNK, dtype=jnp.uint32)
    n = _direction(lane, start, *offsets, whole=whole)
    return Chunk(n, _straight_ahead(n.z), lane < count)


@cache
def _fill(whole: bool) -> Fill | None:
    """Return a function that makes directions faster than XLA's code does; None if it cannot be compiled."""
    try:
        return Fill(partial(_direction, whole=whole), [np.dtype(np.uint32)] * 3)
    except (NoCompilerError, NotElementwiseError):
        return None


@cache
def _ahead() -> Vec3:
    """Return view positions straight ahead, for all normals in a chunk."""
    return Vec3(*map(np.asarray, _straight_ahead(jnp.zeros(CHUNK, jnp.float32))))


def _make_uniform(name: str, title: str, whole: bool, count: int, seed: int) -> NormalSet:
    offsets = np.random.default_rng(seed).integers(0, 2**32, 2, dtype=np.uint32)

    def chunk(start: int) -> Chunk:
        turn, first = divmod(start, TURN)
        shifted = ((int(o) + turn * by) % TURN for o, by in zip(offsets, SHIFTS, strict=True))
        if fill := _fill(whole):
            return Chunk(fill(CHUNK, first, *shifted), _ahead(), np.arange(CHUNK) < count - start)
        with jax.enable_x64(True):
            return _uniform_chunk(
                np.uint32(first), np.uint32(min(count - start, CHUNK)), *map(np.uint32, shifted), whole=whole
            )

    return NormalSet(name, title, (4 if whole else 2) * math.pi, count, None, seed, chunk)


def sphere(count: int = DEFAULT_COUNT, seed: int = 0) -> NormalSet:
    """Return `count` directions spread evenly over the sphere: a low-discrepancy sequence shifted by the seed."""
    return _make_uniform("sphere", "uniform sphere", True, count, seed)


def hemisphere(count: int = DEFAULT_COUNT, seed: int = 0) -> NormalSet:
    """Return `count` directions spread evenly over z >= 0: a low-discrepancy sequence shifted by the seed."""
    return _make_uniform("hemisphere", "uniform hemisphere, z >= 0", False, count, seed)


def from_arrays(name: str, title: str, n, view, covered, shape=None, not_finite: int | None = None) -> NormalSet:
    """Return a set of given normals.

    Args:
        n, view: float32 arrays of shape (..., 3).
        covered: which normals count, bool of shape (...).
        not_finite: number of normals that do not count because they are NaN or infinite in their file; None if it is
            unknown.
    """
    count = covered.size
    background = count - int(np.count_nonzero(covered)) - (not_finite or 0)
    chunks = _chunks(*(np.asarray(a).reshape(count, -1) for a in (n, view, covered)))
    return NormalSet(
        name,
        title,
        None,
        count,
        shape,
        0,
        lambda start: chunks[start // CHUNK],
        background if shape or background else None,
        not_finite,
    )


def _chunks(n: np.ndarray, view: np.ndarray, covered: np.ndarray) -> list[Chunk]:
    """Split normals into whole chunks; the padding in the last chunk does not count."""
    count, missing = len(n), -len(n) % CHUNK
    n, view = (np.pad(np.asarray(a, np.float32), ((0, missing), (0, 0)), mode="edge") for a in (n, view))
    planes = Chunk(
        Vec3(*map(np.array, from_array(n))), Vec3(*np.ascontiguousarray(view.T)), np.pad(covered[:, 0], (0, missing))
    )
    return [jax.tree.map(lambda a, first=start: a[first : first + CHUNK], planes) for start in range(0, count, CHUNK)]


def axes(count: int = 0, seed: int = 0) -> NormalSet:
    """Return the six axis directions, with both signed zeros and offsets of one to three units in the last place of 1
    around each direction; `count` and `seed` have no effect."""
    ulp = float(np.spacing(np.float32(1)))
    near = [0.0, -0.0, *(s * k * ulp for k in (1, 2, 3) for s in (1, -1))]
    sides = itertools.product(range(3), (1.0, -1.0), near, near)
    n = np.array([np.insert([a, b], axis, side) for axis, side, a, b in sides], np.float32)
    view = np.broadcast_to(np.array([0, 0, -1], np.float32), n.shape)
    return from_arrays("axes", "axis-aligned, with neighbours a few ulps away", n, view, np.ones(len(n), bool))


def playground(count: int = 0, seed: int = 0) -> NormalSet:
    """Return the article's scene as its camera sees it, at 640 x 480; `count` and `seed` have no effect."""
    return _playground_set()


@cache
def _playground_set() -> NormalSet:
    from ....gbuffer.scenes.built_in.playground import TITLE
    from ....gbuffer.scenes.built_in.playground import playground as rendered

    seen = rendered()
    return from_arrays("playground", TITLE, seen.normals, seen.positions, seen.covered, seen.covered.shape)


NORMAL_SETS: Mapping[str, Callable[[int, int], NormalSet]] = MappingProxyType(
    {"sphere": sphere, "hemisphere": hemisphere, "axes": axes, "playground": playground}
)
