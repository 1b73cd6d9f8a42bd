"""Codes of light."""

from __future__ import annotations

from functools import cache
from typing import Any

import jax.numpy as jnp
import numpy as np

from .....encodings.catalogue import LIGHT_ENCODINGS
from .....encodings.codecs.kind import LIGHT
from .....encodings.codecs.light_codec import LightCodec
from .....encodings.vec import CONSTANTS, Vec4
from .....gbuffer.codecs.harness import check_functions
from .code_kind import COUNT, CodeKind, Numbers
from .own import by_device, is_in

# The brightest light that codes without a limit of their own are tried with.
BRIGHTEST = 1024.0


@cache
def _lights(largest: float) -> tuple[np.ndarray, np.ndarray]:
    """Colours up to a largest one, dim ones as often as bright ones, with a fourth number; black and white first."""
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
    encoding = codec.encoding
    check_functions(encoding.glsl, encoding.signatures)
    own = {"ENCODE": f"{encoding.prefix}_encode", "DECODE": f"{encoding.prefix}_decode"}
    if not codec.has_alpha:
        own = {f"COLOUR_{name}": function for name, function in own.items()}
        own |= {"ENCODE": "colour_encode", "DECODE": "colour_decode"}
    return {"CODE": "vec4", **own, **CONSTANTS, **encoding.constants}


def _limit(codec: LightCodec) -> float:
    return min(codec.limit, BRIGHTEST)


def _errors(given: np.ndarray, back: np.ndarray) -> np.ndarray:
    brightest = np.maximum(given.astype(np.float64).max(axis=1), 2.0**-8)
    return np.abs(back.astype(np.float64) - given[:, : back.shape[1]]).max(axis=1) / brightest


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
    has_twin=is_in(LIGHT),
    # Over another range it has another name, and the same file.
    is_ours=lambda codec: codec.encoding.glsl in {one.glsl for one in LIGHT_ENCODINGS.values()},
    errors=_errors,
    unit="of the brightest channel",
    held=lambda codec: f"linear, not negative, up to {codec.limit:g}",
    units=lambda given: np.maximum(given.max(axis=1, keepdims=True), 2.0**-8),
)
