"""Depth codecs: a depth encoding, which maps view depth to one number and back in both languages, and its storage.
`normalbench depth` measures them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ..kinds import DEPTH, Kind
from ..shared.position import (
    Camera,
    CameraTerms,
    Projection,
    position_from_linear_depth,
    position_from_projection_terms,
    position_from_window_depth,
)
from ..storages.depth_storage import DepthStorage, store_depth
from ..storages.dither import Dither
from ..storages.storage import DITHERED, rounds_to
from ..vec import Vec2, Vec3, depth_or_far, jnp, maximum, with_sign_of
from .codec import codec_name, rounding_misfit

if TYPE_CHECKING:
    from jaxtyping import Array, ArrayLike, Float

# A unit in the last place of 1 in float32.
ULP = 2.0**-23
# What float32 arithmetic adds beside encoder and decoder, in units in the last place: one to the number where it is
# scaled to an integer and back; three to a position (two products and the rays' own rounding; or a division and two
# products). Where the inverse projection or its two terms stand for the decoder, they round the number's two factors as
# the decoder does.
SCALING_ULPS, POSITION_ULPS = 1, 3


@dataclass(frozen=True, eq=False)
class DepthEncoding:
    """A pair of maps between depths and numbers, in JAX and, in the file next to it, in GLSL.

    The depth is planar: -z of the view-space position, not the distance from the eye. The GLSL file defines
    `float <name>_encode_depth(float depth, float near, float far)` and likewise `<name>_decode_depth`, which takes a
    number; the suffix distinguishes these functions from those of light encodings, which are compiled with them. The
    inputs of an encoder have passed through `vec.depth_or_far`: none is NaN, infinite or beyond `far`. The encoder
    itself clamps depths nearer than its range.

    Attributes:
        name: the catalogue's key, the file's name and the prefix of the GLSL functions.
        title: human-readable name.
        encode: (depth, near, far) -> number in [0, 1]; in [-1, 1] with the depth's sign if `signed`. Exact on float64
            arrays.
        decode: (number, near, far) -> depth. Exact on float64 arrays.
        storages: usual storages, names of DEPTH_STORAGES.
        citation: source of the encoding.
        glsl: the GLSL twin.
        ulps: allowed errors of encode and decode, in either language, compared with the exact maps. For encode, a
            unit is 2^-23 of the number, plus the change in the number when the depth changes by 2^-23; for decode,
            the same with number and depth exchanged.
        ulps_reason: reason for these numbers.
        projection: how depth maps to clip space, if the number is a depth buffer's value; the inverse projection then
            gives the position.
        signed: whether the depth has the sign of the normal's z. Zero has a sign too.
        own_units: whether float formats hold the depth in the scene's own units, as with a far plane of 1, and so
            need no range.
        constants: numbers that both languages need, by GLSL name.
        functions: prefix of the GLSL functions in a user's file; empty if it is the name.
        bytes: number of 8-bit channels that the code fills; the encoder's input is then a number in [0, 1], however
            it represents the depth. 0 for a code of one number.
    """

    kind: ClassVar[Kind] = DEPTH
    name: str
    title: str
    encode: Callable[[Any, Any, Any], Any]
    decode: Callable[[Any, Any, Any], Any]
    storages: tuple[str, ...]
    citation: str
    glsl: Path
    ulps: tuple[int, int]
    ulps_reason: str
    projection: Projection | None = None
    signed: bool = False
    own_units: bool = False
    constants: Mapping[str, Any] = field(default_factory=dict)
    functions: str = ""
    bytes: int = 0

    @property
    def prefix(self) -> str:
        """The prefix of the names of the GLSL functions."""
        return self.functions or self.name

    @property
    def signatures(self) -> tuple[str, str]:
        """The GLSL signatures of the encoder and the decoder, without semicolons."""
        if self.bytes:
            return f"vec4 {self.prefix}_encode_bytes(float number)", f"float {self.prefix}_decode_bytes(vec4 texel)"
        return (
            f"float {self.prefix}_encode_depth(float depth, float near, float far)",
            f"float {self.prefix}_decode_depth(float number, float near, float far)",
        )


@dataclass(frozen=True)
class DepthCodec:
    """A depth encoding, the storage for its number, and the rounding: one of `storage.ROUNDINGS`, or DITHERED."""

    encoding: DepthEncoding
    storage: DepthStorage
    rounding: str = "nearest"

    @property
    def name(self) -> str:
        return codec_name(self.encoding.name, self.storage.name, self.rounding)

    @property
    def misfit(self) -> str | None:
        """The reason why the storage cannot hold the encoding's number with this rounding; None if it can."""
        if self.encoding.signed and not self.storage.is_signed:
            return f"{self.storage.title}: no room for a sign"
        if self.storage.home in ("attachment", "bytes") and self.rounding != "nearest":
            return f"{self.storage.title}: the device always rounds it to nearest"
        return rounding_misfit(self.storage.format, self.rounding)

    @property
    def is_dithered(self) -> bool:
        """Whether noise is added to the number before it is rounded to nearest."""
        return self.rounding == DITHERED

    @property
    def step(self) -> float:
        """The distance between neighbouring numbers in a fixed-point storage."""
        return 1.0 / (self.storage.scale // 2 if self.encoding.signed else self.storage.scale)

    @property
    def dither(self) -> Dither:
        """Noise of one step for the codec's number, the same in every frame."""
        return Dither((self.step,))

    @property
    def fits(self) -> bool:
        """Whether the storage can hold the encoding's number."""
        return self.misfit is None

    @property
    def bits(self) -> int:
        """The bits that it uses."""
        return self.storage.bits

    @property
    def codes(self) -> int:
        """The number of codes: all values that the number can have in [0, 1], or in [-1, 1] with a sign."""
        if self.storage.format.kind != "float":
            return 2**self.bits
        both = self.storage.format.count(0)
        return both if self.encoding.signed else (both + 1) // 2

    @property
    def is_window(self) -> bool:
        """Whether the number is a depth buffer's value."""
        return self.encoding.projection is not None

    def far(self, far: Float[ArrayLike, "*shape"]) -> Float[ArrayLike, "*shape"]:
        """Return the far plane to pass to the encoding: 1 if the storage holds the depth in the scene's units,
        otherwise `far` unchanged."""
        return jnp.ones_like(far) if self.encoding.own_units and self.storage.is_open else far

    def stored(
        self,
        depth: Float[Array | np.ndarray, "*shape"],
        near: Float[ArrayLike, "*#shape"],
        far: Float[ArrayLike, "*#shape"],
        noise: Float[Array | np.ndarray, "*shape"] | None = None,
    ) -> Float[Array | np.ndarray, "*shape"]:
        """Return the numbers for depths (float32, any shape) as the storage returns them.

        Args:
            depth: view depth, with the sign of the normal's z if the encoding keeps it.
            near, far: distances of the planes, float32, for all depths or per depth; 0 < near < far.
            noise: noise to add to the numbers before they are rounded, of the same shape as the depths, or None. The
                numbers keep their signs.
        """
        number = self.encoding.encode(depth_or_far(depth, far), near, self.far(far))
        if noise is not None:
            number = with_sign_of(maximum(abs(number) + noise, 0.0), number)
        return store_depth(number, self.storage, self.encoding.signed, rounds_to(self.rounding))

    def depths(
        self,
        number: Float[Array | np.ndarray, "*shape"],
        near: Float[ArrayLike, "*#shape"],
        far: Float[ArrayLike, "*#shape"],
    ) -> Float[Array | np.ndarray, "*shape"]:
        """Return the depths that stored numbers represent, with the signs that the encoding keeps."""
        return self.encoding.decode(number, near, self.far(far))

    def round_trip(
        self,
        depth: Float[Array | np.ndarray, "*shape"],
        near: Float[ArrayLike, "*#shape"],
        far: Float[ArrayLike, "*#shape"],
    ) -> Float[Array | np.ndarray, "*shape"]:
        """Return depths after encoding, storage and decoding; see `stored`."""
        return self.depths(self.stored(depth, near, far), near, far)

    def furthest(
        self, depth: Float[np.ndarray, "*shape"], camera: Camera, with_arithmetic: bool = True
    ) -> Float[np.ndarray, "*shape"]:
        """Return the largest possible error of each depth after a round trip through the storage.

        This is the error that rounding the number causes in the exact maps. If `with_arithmetic` is true, the error
        that float32 arithmetic adds to the number and to the depth, up to the position, is included.

        Args:
            depth: float64, positive.

        Returns:
            float64; infinite where the storage may return anything.
        """
        import jax

        scaling = 0 if self.storage.format.kind == "float" else SCALING_ULPS
        slack = (sum(self.encoding.ulps) + scaling) * ULP * with_arithmetic
        with jax.enable_x64(True):
            near, far = jnp.float64(camera.near), self.far(jnp.float64(camera.far))
            exact = jnp.asarray(depth, jnp.float64)
            number = self.encoding.encode(exact, near, far)
            by_depth = abs(self.encoding.encode(exact * (1 + slack), near, far) - number)
            off = jnp.asarray(self._rounded_by(np.asarray(number))) + slack * number + by_depth
            top = jnp.inf if self.storage.is_open and self.encoding.own_units else 1 + slack
            ends = (jnp.clip(number + side * off, 0.0, top) for side in (1.0, -1.0))
            moved = [self.encoding.decode(end, near, far) for end in ends]
            after = slack + POSITION_ULPS * ULP * with_arithmetic
            errors = [jnp.where(d >= 0, abs(d - exact) + after * jnp.maximum(d, exact), jnp.inf) for d in moved]
            return np.asarray(jnp.maximum(*errors))

    def _rounded_by(self, number: Float[np.ndarray, "*shape"]) -> Float[np.ndarray, "*shape"]:
        """Return the largest rounding error of each float64 number: half a step of the storage if it rounds to
        nearest, otherwise a whole step; infinite if a float format cannot hold the number."""
        share = 0.5 if self.rounding == "nearest" else 1.0
        if self.storage.format.kind != "float":
            return np.full_like(number, share * self.step)
        with np.errstate(over="ignore"):
            rounded = number.astype(np.float16 if self.storage.bits == 16 else np.float32)
            finite = np.isfinite(rounded)
            return np.where(finite, share * np.spacing(np.where(finite, rounded, 1)).astype(np.float64), np.inf)


def by_inverse_projection(
    _: DepthCodec, number: Float[Array | np.ndarray, "*shape"], place: Vec2, seen: CameraTerms
) -> Vec3:
    """Return view-space positions from stored window depths, by the inverse of the projection in `seen`, with which the
    depths must have been stored. `place` is the position on the screen, from -1 to 1."""
    return position_from_window_depth(place, number, seen.clip, seen.clip_to_view)


def by_projection_terms(
    _: DepthCodec, number: Float[Array | np.ndarray, "*shape"], place: Vec2, seen: CameraTerms
) -> Vec3:
    """Return view-space positions from stored window depths, by the two terms of the projection; the encoding must
    have a projection. `place` is the position on the screen, from -1 to 1."""
    return position_from_projection_terms(place, number, seen.clip, seen.terms, seen.rays)


def by_eye_ray(codec: DepthCodec, number: Float[Array | np.ndarray, "*shape"], place: Vec2, seen: CameraTerms) -> Vec3:
    """Return view-space positions from stored numbers: the decoded depth, without its sign, times the eye ray through
    `place`, a position on the screen from -1 to 1."""
    return position_from_linear_depth(place, abs(codec.depths(number, seen.near, seen.far)), seen.rays)


@dataclass(frozen=True)
class Rebuild:
    """A method of reconstructing a position from a stored number.

    Attributes:
        position: (codec, number, place, seen) -> view-space position.
        by_projection: whether the number must be a depth buffer's value, which only some encodings produce.
        way: the method's number in GLSL.
    """

    position: Callable[[DepthCodec, Any, Vec2, CameraTerms], Vec3]
    by_projection: bool
    way: int


REBUILDS: Mapping[str, Rebuild] = MappingProxyType(
    {
        "inverse_projection": Rebuild(by_inverse_projection, True, 0),
        "projection_terms": Rebuild(by_projection_terms, True, 1),
        "eye_ray": Rebuild(by_eye_ray, False, 2),
    }
)
