"""A codec in float64, which stands for the exact map in the searches for worst cases and odd codes.

All functions work in blocks of one size, so that each is compiled only once for an encoding: from codes to normals,
from normals to codes, and from normals to the errors of their round trips. Scales of fixed-point formats are
arguments.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, reduce

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.rounding import Scale, fixed, shared
from ....encodings.storages.storage import Storage
from ....encodings.vec import Vec2, Vec3, dot, maximum, select
from .climb import WAYS

# Normals in a block; and in a block of an encoder that searches, which takes longer for each normal.
BLOCK, SHORT = 2**15, 2**12
SLAB = (2**7 - 1, 2**8 - 1)  # rows and columns of corners in a block
TOLERANCE = 1e-6  # within which a decoded code is encoded as itself
NEAR_AXIS = 0.9  # a component above which the other two are computed from it


def ahead(like) -> Vec3:
    """Return eye rays straight ahead, (0, 0, -1), as planes of the shape of `like`."""
    return Vec3(jnp.zeros_like(like), jnp.zeros_like(like), jnp.full_like(like, -1.0))


def _unit_or_z(v: Vec3) -> Vec3:
    """Return vectors scaled to length 1; +z for a vector that is zero or not finite."""
    length2 = dot(v, v)
    is_direction = (length2 > 0.0) & jnp.isfinite(length2)
    return select(is_direction, v * (1.0 / jnp.sqrt(select(is_direction, length2, 1.0))), Vec3(0.0, 0.0, 1.0))


def unit(n: Vec3) -> Vec3:
    """Return unit vectors, corrected near the axes: the two short components get the length that the long component
    leaves.

    Encoders compute 1 + n.z, which is exact there. Normalising a vector rounds n.z separately, which can change
    1 + n.z by as much as its own value, so that the encoder would be given a vector of a different length.
    """
    long = maximum(maximum(abs(n.x), abs(n.y)), abs(n.z))
    short = Vec3(*(select(abs(c) == long, 0.0, c) for c in n))
    # |short|^2 = (1 - |long|) (1 + |long|)
    short2 = dot(short, short)
    scale = jnp.sqrt(maximum((1.0 - long) * (1.0 + long), 0.0) / select(short2 > 0.0, short2, 1.0))
    return Vec3(*(select((long > NEAR_AXIS) & (abs(c) < long), c * scale, c) for c in n))


_unit = jax.jit(unit)


class _Programs:
    """The compiled functions of an encoding, for all fixed-point formats of one kind: the scales are arguments."""

    def __init__(self, encoding: Encoding, like: Storage, rounding: str, is_half: bool):
        self._encoding, self._like, self._rounding, self._is_half = encoding, like, rounding, is_half
        self.size = encoding.components + encoding.sign_bits
        self.free = [i for i in range(self.size) if not encoding.levels_of(i)]
        self._code = Vec2 if self.size == 2 else Vec3
        self.normals = jax.jit(self._normals)
        self.chords = jax.jit(self._chords)
        self.codes = jax.jit(lambda n, *scales: jnp.stack(self._codec(scales).stored(Vec3(*n), ahead(n[0]))))
        self.stored = jax.jit(lambda code, *scales: jnp.stack(self._codec(scales).store(self._code(*code))))
        self.corners = jax.jit(self._corner_chords)

    def _codec(self, scales: tuple[Scale, ...]) -> Codec:
        return Codec(self._encoding, fixed(self._like, scales), self._rounding)

    def _normals(self, code, *_: Scale):
        return jnp.stack(_unit_or_z(self._encoding.decode(*self._code_and_rays(code))))

    def _code_and_rays(self, code) -> tuple[Vec2 | Vec3, Vec3]:
        """Return a decoder's arguments: a code as a vector, and the eye rays for which it is decoded."""
        return self._code(*code), ahead(code[0])

    def _chords(self, n, *scales: Scale):
        n = unit(Vec3(*n))
        decoded = self._decoded(self._codec(scales), n)
        length2 = dot(decoded, decoded)
        is_direction = (length2 > 0.0) & jnp.isfinite(length2)
        miss = n - decoded * (1.0 / jnp.sqrt(select(is_direction, length2, 1.0)))
        chords = select(is_direction, dot(miss, miss), 4.0)
        return select(n.z >= 0.0, chords, -1.0) if self._is_half else chords

    def _decoded(self, codec: Codec, n: Vec3) -> Vec3:
        """Return normals after a round trip; with precise rounding, decoded from the nearest surrounding code."""
        if not self._encoding.is_precise:
            return codec.round_trip(n, ahead(n.z))
        # The codes around are decoded as one array: the program is a quarter as long and compiles sooner.
        code = self._encoding.encode(n, ahead(n.z))
        around = codec.around(type(code)(*(jnp.broadcast_to(c, n.z.shape) for c in code)))
        stored = codec.store(self._code(*(jnp.stack(each) for each in zip(*around, strict=True))))
        decoded = self._encoding.decode(*self._code_and_rays(stored))
        miss = decoded - Vec3(*(c[None] for c in n))
        nearest = jnp.argmin(dot(miss, miss), axis=0, keepdims=True)
        return Vec3(*(jnp.take_along_axis(c, nearest, axis=0)[0] for c in decoded))

    def _corner_chords(self, edges, numbers, others):
        u, v = self.free

        def at(across, along) -> list:
            code = [jnp.broadcast_to(c, (len(across), len(along))) for c in others]
            code[u], code[v] = (jnp.broadcast_to(c, code[0].shape) for c in (across[:, None], along[None, :]))
            return code

        corner, centre = at(*edges), at(*numbers)
        both = Vec3(*self._normals([jnp.stack(pair) for pair in zip(corner, centre, strict=True)]))
        n, decoded = (Vec3(*(c[i] for c in both)) for i in (0, 1))
        inside = (n.z >= 0.0) if self._is_half else jnp.ones_like(n.z, bool)
        is_precise = self._encoding.is_precise
        # Precise rounding takes the nearest code, whichever the corner's normal is encoded to.
        back = corner if is_precise else self._encoding.encode(n, ahead(n.z))
        for mine, its in zip(corner, back, strict=True):
            inside &= abs(mine - its) < TOLERANCE
        rows, columns = SLAB
        # Corners and codes were decoded as one array, so there is one row and one column of corners too many.
        n = Vec3(*(c[:rows, :columns] for c in n))
        around = (Vec3(*(c[i : i + rows, j : j + columns] for c in decoded)) for i in (0, 1) for j in (0, 1))
        chords = reduce(jnp.minimum if is_precise else jnp.maximum, (dot(n - d, n - d) for d in around))
        return jnp.where(inside[:rows, :columns], chords, -1.0)


_compiled = cache(_Programs)


class ExactCodec:
    """A codec in float64 on the whole sphere, or only on z >= 0.

    Normals are NumPy arrays of shape (3, count), and codes are arrays of shape (components and sign bits, count),
    both float64. Any count is allowed; arrays are processed in blocks of `block`.
    """

    def __init__(self, codec: Codec, is_half: bool):
        like, self._scales = shared(codec.storage, codec.encoding.components, np.float64)
        self._programs = _compiled(codec.encoding, like, codec.rounding, is_half)
        self.codec, self.is_half, self.size = codec, is_half, self._programs.size
        # Precise rounding decodes four codes for each normal.
        whole = BLOCK // 4 if codec.encoding.is_precise else BLOCK
        self.block = SHORT if codec.encoding.searches else whole

    @property
    def free(self) -> list[int]:
        """The indices of the components that are neither signs nor numbers with few values."""
        return self._programs.free

    def corners(self, edges: Sequence[np.ndarray], numbers: Sequence[np.ndarray], others: np.ndarray) -> np.ndarray:
        """Return squared chords from the corners of a plane's cells to the farthest of the four surrounding codes,
        because each of these has normals near the corner; with precise rounding, to the nearest of the four, which
        encodes all normals near the corner.

        Args:
            edges: the ends of cells, in each of the two free components; at most as many as SLAB states.
            numbers: the numbers of these components around the edges: one more in each component.
            others: the whole code, from which the components that are not free are taken.

        Returns:
            shape (edges of the first component, edges of the second); -1 if the corner's normal has a different code,
            or is outside the domain.
        """
        rows, columns = (len(side) for side in edges)
        # One shape, so that one compiled program serves every storage.
        edges = [_lengthened(side, size + 1) for side, size in zip(edges, SLAB, strict=True)]
        numbers = [_lengthened(side, size + 1) for side, size in zip(numbers, SLAB, strict=True)]
        with jax.enable_x64(True):
            return np.asarray(self._programs.corners(edges, numbers, others))[:rows, :columns]

    def normals(self, code: np.ndarray) -> np.ndarray:
        """Return the unit directions that codes, stored or not, decode to, (3, count); +z for no direction."""
        return self._in_blocks(self._programs.normals, code)

    def stored(self, code: np.ndarray) -> np.ndarray:
        """Return codes after a round trip of their numbers through the storage, of the same shape."""
        return self._in_blocks(self._programs.stored, code)

    def codes(self, n: np.ndarray) -> np.ndarray:
        """Return the codes of unit normals, shape (components, count), as they are read back from the storage."""
        return self._in_blocks(self._programs.codes, n)

    def chords(self, n: np.ndarray) -> np.ndarray:
        """Return the squared distances between unit normals and their decoded directions, both of length 1: 4 if the
        decoded vector has no direction, -1 for normals outside the domain."""
        return self._in_blocks(self._programs.chords, n)

    def _in_blocks(self, function, planes: np.ndarray) -> np.ndarray:
        count = planes.shape[1]
        short = -count % self.block
        padded = np.pad(planes, ((0, 0), (0, short)), mode="edge") if short else planes
        # Odd codes are looked for in float32, as a shader makes them.
        scales = jax.tree.map(planes.dtype.type, self._scales)
        with jax.enable_x64(True):
            starts = range(0, count, self.block)
            parts = [function(padded[:, start : start + self.block], *scales) for start in starts]
            return np.concatenate([np.asarray(part) for part in parts], axis=-1)[..., :count]

    def around(self, n: np.ndarray, sizes: np.ndarray, step: int) -> np.ndarray:
        """Return WAYS unit normals around each normal, shape (3, WAYS, count): in all directions, at four distances
        that are fractions of `sizes`. The directions are rotated at each step."""
        x, y, z = n
        # Two axes across n (J. Frisvad 2012, T. Duff et al. 2017).
        sign = np.where(z < 0.0, -1.0, 1.0)
        a = -1.0 / (sign + z)
        b = x * y * a
        u, v = np.stack([1.0 + sign * x * x * a, sign * b, -sign * x]), np.stack([b, sign + y * y * a, -y])
        way, turn = np.arange(WAYS)[:, None], 2.0 * np.pi * (0.6180339887 * step + 0.7548776662 * np.arange(len(sizes)))
        reach, angle = sizes * 0.4 ** (way % 4), 2.0 * np.pi / WAYS * way
        # cos(a + b), sin(a + b) from those of each way and of each lane, which are fewer.
        along = reach * (np.cos(angle) * np.cos(turn) - np.sin(angle) * np.sin(turn))
        aside = reach * (np.sin(angle) * np.cos(turn) + np.cos(angle) * np.sin(turn))
        around = n[:, None] + along * u[:, None] + aside * v[:, None]
        if self.is_half:
            np.maximum(around[2], 0.0, out=around[2])
        return around / np.linalg.norm(around, axis=0)

    def unit(self, n: np.ndarray) -> tuple[float, float, float]:
        """Return one normal, shape (3,), corrected to unit length as in `chords`."""
        with jax.enable_x64(True):
            x, y, z = (float(c) for c in _unit(Vec3(*n)))
        return x, y, z

    def angle_deg(self, n: np.ndarray) -> float:
        """Return the angle between one normal, shape (3,), and its decoded direction, in degrees."""
        return degrees(float(self.chords(n[:, None])[0]))


def _lengthened(numbers: np.ndarray, count: int) -> np.ndarray:
    """Return `count` numbers: the given numbers, then the last one repeated."""
    return np.pad(numbers, (0, count - len(numbers)), mode="edge")


def degrees(chord2: float) -> float:
    """Return the angle, in degrees, that a chord of the unit sphere subtends, from the chord's squared length."""
    return float(np.degrees(2 * np.arcsin(np.sqrt(max(chord2, 0.0)) / 2)))
