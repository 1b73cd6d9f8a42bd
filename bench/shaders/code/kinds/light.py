"""Codes of light."""

from __future__ import annotations

from functools import cache
from typing import Any

import jax.numpy as jnp
import numpy as np

from .....encodings.catalogue import LIGHT_ENCODINGS
from .....encodings.codecs.light_codec import LightCodec
from .....encodings.kinds import LIGHT
from .....encodings.vec import Vec4
from .code_kind import COUNT, CodeKind, Numbers
from .own import by_device, defines

# The brightest light that codes without a limit of their own are tried with.
BRIGHTEST = 1024.0


@cache
def _lights(largest: float) -> tuple[np.ndarray, np.ndarray]:
    """Return colours with a fourth number, (COUNT, 4), up to `largest`, as often dim as bright, with black and white
    first; and zeros, (COUNT, 3)."""
    random = np.random.default_rng(0)
    light = largest * 2.0 ** random.uniform(-12, 0, (COUNT, 1)) * random.uniform(0, 1, (COUNT, 4))
    light[0], light[1] = 0.0, largest
    return light.astype(np.float32), np.zeros((COUNT, 3), np.float32)


def _planes(rows: Any, size: int) -> Vec4:
    return Vec4(*(rows[:, i] if i < size else rows[:, 0] * 0.0 for i in range(4)))


def _size(codec: LightCodec) -> int:
    return 4 if codec.has_alpha else 3


def _store(codec: LightCodec, codes: np.ndarray) -> np.ndarray:
    stored = codec.store(_planes(jnp.asarray(np.pad(codes, ((0, 0), (0, 4 - codes.shape[1])))), 4))
    return np.stack([np.asarray(plane) for plane in stored], axis=1)


def _by_device(codec: LightCodec, n: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    given = n if codec.has_alpha else n * np.array([1, 1, 1, 0], np.float32)
    return by_device(4, _size(codec), _store)(codec, given, view)


def _decoded(codec: LightCodec, code: Vec4, _: Any) -> tuple[Any, ...]:
    return tuple(codec.decode(code))[: _size(codec)]


def _defines(codec: LightCodec) -> dict[str, object]:
    macros = defines(codec.encoding, "", "vec4")
    if codec.has_alpha:
        return macros
    colours = {f"COLOUR_{name}": macros[name] for name in ("ENCODE", "DECODE")}
    return macros | colours | {"ENCODE": "colour_encode", "DECODE": "colour_decode"}


def _limit(codec: LightCodec) -> float:
    return min(codec.limit, BRIGHTEST)


def _brightest(given: np.ndarray) -> np.ndarray:
    """Return the brightest channel of each light, (count, 1), but at least the value that is the unit for dark
    lights."""
    return np.maximum(given.max(axis=1, keepdims=True), 2.0**-8)


def _errors(given: np.ndarray, back: np.ndarray) -> np.ndarray:
    off = np.abs(back.astype(np.float64) - given[:, : back.shape[1]]) / _brightest(given)
    return off.max(axis=1)


def _is_ours(codec: LightCodec) -> bool:
    """Whether a codec's encoding is the catalogue's, judged by its file: its name depends on the range."""
    return codec.encoding.glsl in {encoding.glsl for encoding in LIGHT_ENCODINGS.values()}


KIND = CodeKind(
    kind=LIGHT,
    plural="lights",
    given=lambda codec: ("n.xyzw" if codec.has_alpha else "n.xyz",),
    settings={},
    result=_size,
    defines=_defines,
    numbers=lambda codec: Numbers(codec.storage, ("nearest",) * codec.storage.channels, False, 4),
    values=lambda codec: _lights(_limit(codec)),
    stored=lambda codec, n, _: codec.stored(_planes(n, _size(codec))),
    decoded=_decoded,
    by_device=_by_device,
    has_twin=_is_ours,
    is_ours=_is_ours,
    errors=_errors,
    unit="of the brightest channel",
    held=lambda codec: f"linear, not negative, up to {codec.limit:g}",
    units=_brightest,
)
