"""Storages for encoded depths, and their arithmetic: channels of a render target, or the depth buffer itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from ..vec import jnp, maximum, minimum, select, sign_bit
from .rounding import rounded, scale_of, store_half, store_unorm
from .storage import R16F, R32F, STORAGES, Storage

if TYPE_CHECKING:
    import numpy as np
    from jaxtyping import Array, Float, UInt


@dataclass(frozen=True)
class DepthStorage:
    """A storage for the number of a depth encoding.

    Attributes:
        name: the catalogue's key.
        title: human-readable name.
        format: format of the render target or of the depth attachment.
        home: "packed", an unsigned integer over the last of a target's 8-bit channels; "channel", the first channel
            of a target; "attachment", the depth buffer itself; or "bytes", 8-bit channels as filled by the author's
            shader.
        bits: number of bits for the number.
        code: a `DepthEncoding` whose two functions convert a number in [0, 1] to these bytes and back; None unless
            `home` is "bytes".
    """

    name: str
    title: str
    format: Storage
    home: str
    bits: int
    code: Any = None

    @property
    def scale(self) -> int:
        """The integer that represents 1; 1 for floats."""
        return 1 if self.format.kind == "float" else 2**self.bits - 1

    @property
    def is_signed(self) -> bool:
        """Whether the storage can hold a sign: depth buffers and encodings in bytes hold only 0 to 1."""
        return self.home not in ("attachment", "bytes")

    @property
    def is_open(self) -> bool:
        """Whether numbers beyond 1 keep their values, as in floats outside a depth buffer."""
        return self.format.kind == "float" and self.home == "channel"


def _native_storage(name: str, title: str, kind: str, bits: int, internal_format: int) -> DepthStorage:
    return DepthStorage(name, title, Storage(name, title, kind, (bits,), internal_format), "attachment", bits)


# A depth buffer of 32-bit integers is not among them: few devices have one, and a shader's depth is a float32, whose
# steps below 1 are 2^-24.
DEPTH_STORAGES: Mapping[str, DepthStorage] = MappingProxyType(
    {
        "packed16": DepthStorage("packed16", "8:8 in B and A of RGBA8", STORAGES["rgba8"], "packed", 16),
        "packed24": DepthStorage("packed24", "8:8:8 in G, B and A of RGBA8", STORAGES["rgba8"], "packed", 24),
        "r16f": DepthStorage("r16f", "R16F", R16F, "channel", 16),
        "r32f": DepthStorage("r32f", "R32F", R32F, "channel", 32),
        "depth16": _native_storage("depth16", "depth buffer, 16 bits", "unorm", 16, 0x81A5),
        "depth24": _native_storage("depth24", "depth buffer, 24 bits", "unorm", 24, 0x81A6),
        "depth32f": _native_storage("depth32f", "depth buffer, 32-bit float", "float", 32, 0x8CAC),
    }
)


def depth_storage_of(storage: Storage) -> DepthStorage | None:
    """Return the depth storage with the bits of a storage such as `unorm:20` or `float:5:10`; None if impossible."""
    alike = (depth_storage for depth_storage in DEPTH_STORAGES.values() if depth_storage.home == "channel")
    if storage.kind == "float" and storage.channels != 2:
        return next(
            (depth_storage for depth_storage in alike if depth_storage.format.float_form(0) == storage.float_form(0)),
            None,
        )
    if (storage.kind, storage.channels) != ("unorm", 1):
        return None
    (bits,) = storage.bits
    title = f"{bits} bits across the last channels of RGBA8"
    return DEPTH_STORAGES.get(f"packed{bits}") or DepthStorage(
        f"packed{bits}", title, STORAGES["rgba8"], "packed", bits
    )


def fixed(
    c: Float[Array | np.ndarray, "*shape"], scale: int, is_signed: bool, rounding: str = "nearest"
) -> UInt[Array, "*shape"]:
    """Return c in [0, 1] (float32, any shape) as an unsigned integer (uint32), rounded by one of ROUNDINGS. `scale`
    represents 1; NaN becomes 0.

    A signed c in [-1, 1] is stored as sign and magnitude: the upper half of the integers is for negative numbers
    and -0.
    """
    half = scale // 2
    magnitude = minimum(maximum(abs(c) if is_signed else c, 0.0), 1.0)
    integer = rounded(magnitude, scale_of(half if is_signed else scale), rounding).astype(jnp.uint32)
    return select(sign_bit(c), integer + jnp.uint32(half + 1), integer) if is_signed else integer


def from_fixed(integer: UInt[Array, "*shape"], scale: int, is_signed: bool) -> Float[Array, "*shape"]:
    """Return the number (float32) that an unsigned integer (uint32) represents: the inverse of `fixed`."""
    half = scale // 2
    if not is_signed:
        return _share(integer, scale)
    is_negative = integer > half
    magnitude = _share(select(is_negative, integer - jnp.uint32(half + 1), integer), half)
    return select(is_negative, -magnitude, magnitude)


def _share(integer: UInt[Array, "*shape"], scale: int) -> Float[Array, "*shape"]:
    """Return integer / scale for a scale of 2^n - 1, rounded once: i / (2^n - 1) = i 2^-n + i 2^-2n + ...

    For a division, a compiler may multiply by the rounded reciprocal, which is a whole step off if n is 24.
    """
    high = integer.astype(jnp.float32) * jnp.float32(1.0 / (scale + 1))
    return high + high * jnp.float32(1.0 / (scale + 1))


def store_bytes(integer: UInt[Array, "*shape"], bits: int) -> UInt[Array, "*shape"]:
    """Return an unsigned integer after storage in 8-bit UNORM channels, the highest byte first. No byte is rounded
    separately, so none can carry into another."""
    together = jnp.zeros_like(integer)
    for shift in range((bits - 1) // 8 * 8, -1, -8):
        byte = ((integer >> shift) & 0xFF).astype(jnp.float32)
        texel = store_unorm(byte / 255.0, scale_of(255))
        together = together | ((texel * 255.0 + 0.5).astype(jnp.uint32) << shift)
    return together


def store_depth(
    c: Float[Array | np.ndarray, "*shape"], storage: DepthStorage, is_signed: bool = False, rounding: str = "nearest"
) -> Float[Array | np.ndarray, "*shape"]:
    """Return the number for a depth (float32, any shape) as the storage returns it, rounded by one of ROUNDINGS; with
    a sign if `is_signed`. A depth buffer rounds to nearest."""
    if storage.home == "bytes":
        return storage.code.decode(storage.code.encode(c))
    if storage.home == "packed":
        integer = store_bytes(fixed(c, storage.scale, is_signed, rounding), storage.bits)
        return from_fixed(integer, storage.scale, is_signed)
    if storage.format.kind != "float":
        return store_unorm(c, scale_of(storage.scale))
    kept = c if storage.is_open else minimum(maximum(c, 0.0), 1.0)
    return store_half(kept, rounding) if storage.bits == 16 else kept
