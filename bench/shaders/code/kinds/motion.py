"""Codes of motion vectors."""

from __future__ import annotations

from functools import cache
from types import MappingProxyType
from typing import Any

import jax.numpy as jnp
import numpy as np

from .....encodings.codecs.motion_codec import NUMBERS, MotionCodec
from .....encodings.kinds import MOTION
from .....encodings.storages.rounding import store_number
from .....encodings.vec import Vec2
from .code_kind import COUNT, CodeKind, Numbers
from .own import by_device, defines, is_in

# Ranges that motions are kept by, in screens, and how far beyond a range they lead.
RANGES, BEYOND = (0.125, 0.25, 1.0), 1.125


@cache
def motions() -> tuple[np.ndarray, np.ndarray]:
    """Return motions of all lengths, (COUNT, 2), some of them beyond their range, including zeros of both signs and
    the ranges themselves; and rows that hold their ranges, (COUNT, 3)."""
    random = np.random.default_rng(0)
    largest = random.choice(RANGES, COUNT)
    length = np.where(np.arange(COUNT) % 2, 2.0 ** random.uniform(-14, 0, COUNT), random.uniform(0, 1, COUNT)) * BEYOND
    angle = random.uniform(0, 2 * np.pi, COUNT)
    motion = np.stack([np.cos(angle), np.sin(angle)], axis=1) * (length * largest)[:, None]
    hard = [(x * largest[0], y * largest[0]) for x in (0.0, -0.0, 1.0, -1.0, 0.5) for y in (0.0, -0.0, 1.0, -1.0)]
    motion[: len(hard)], largest[: len(hard)] = hard, largest[0]
    return motion.astype(np.float32), np.pad(largest[:, None], ((0, 0), (0, 2))).astype(np.float32)


def _store(codec: MotionCodec, codes: np.ndarray) -> np.ndarray:
    planes = [jnp.asarray(codes[:, i]) for i in range(NUMBERS)]
    stored = [store_number(plane, codec.storage, i, codec.rounding) for i, plane in enumerate(planes)]
    return np.stack([np.asarray(number) for number in stored], axis=1)


def _decoded(codec: MotionCodec, code: Vec2, view: Any) -> Vec2:
    return codec.encoding.decode(code, view[:, 0] if codec.needs_range else 1.0)


def _held(codec: MotionCodec) -> str:
    largest = "; `range` is the largest motion stored" if codec.needs_range else ""
    return f"in screens per frame: 1 is the image's width along x and its height along y{largest}"


KIND = CodeKind(
    kind=MOTION,
    plural="motions",
    given=lambda _: ("n.xy",),
    settings=MappingProxyType({"range": "view.x"}),
    result=lambda _: NUMBERS,
    defines=lambda codec: defines(codec.encoding, "_motion", "vec2"),
    numbers=lambda codec: Numbers(codec.storage, (codec.rounding,) * NUMBERS, codec.storage.is_biased, NUMBERS),
    values=lambda _: motions(),
    stored=lambda codec, n, view: codec.stored(Vec2(n[:, 0], n[:, 1]), view[:, 0]),
    decoded=_decoded,
    by_device=by_device(NUMBERS, NUMBERS, _store),
    has_twin=is_in(MOTION),
    is_ours=is_in(MOTION),
    errors=lambda given, back: np.linalg.norm(back.astype(np.float64) - given[:, :NUMBERS], axis=1),
    unit="screens",
    held=_held,
    bound=lambda codec: {} if codec.needs_range else {"range": 1.0},
)
