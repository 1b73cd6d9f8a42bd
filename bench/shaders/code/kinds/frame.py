"""Codes of tangent frames."""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import Any

import jax.numpy as jnp
import numpy as np

from .....encodings.codecs.frame_codec import FrameCodec
from .....encodings.kinds import FRAME
from .....encodings.rotation import Frame
from .....encodings.vec import Vec3, Vec4
from .....gbuffer.codecs.frames.frame_passes import exact_frames
from .....gbuffer.gl.device import device
from ....ground.angles import angles_deg
from .code_kind import COUNT, CodeKind, Numbers
from .own import defines, is_in

# A normal, the hand, and a tangent: see `_values`.
FIELDS = ("normal", "tangent", "hand")
NORMAL, HAND, TANGENT = slice(0, 3), 3, slice(4, 7)


@cache
def _frames() -> tuple[np.ndarray, np.ndarray]:
    """Return normals with hands, (COUNT, 4), and tangents, (COUNT, 3): along axes and between them, then at random;
    every second frame is mirrored."""
    along = [np.array(v, float) for v in product((-1, 0, 1), repeat=3) if any(v)]
    hard = np.repeat([(n, t) for n, t in product(along, along) if not n @ t], 2, axis=0)
    random = np.random.default_rng(0).normal(size=(COUNT, 2, 3))
    n, t = np.concatenate([hard, random])[:COUNT].swapaxes(0, 1).copy()
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    t -= np.sum(n * t, axis=1, keepdims=True) * n
    t /= np.linalg.norm(t, axis=1, keepdims=True)
    hand = np.where(np.arange(COUNT) % 2, -1.0, 1.0)[:, None]
    return np.concatenate([n, hand], axis=1).astype(np.float32), t.astype(np.float32)


def _frame(n: Any, view: Any) -> Frame:
    return Frame(Vec3(n[:, 0], n[:, 1], n[:, 2]), Vec3(view[:, 0], view[:, 1], view[:, 2]), n[:, 3])


def _decoded(codec: FrameCodec, code: Vec4, _: Any) -> tuple[Any, ...]:
    frame = codec.encoding.decode(code, codec.least)
    return (*frame.normal, frame.hand + 0.0 * code.x, *frame.tangent)


def _numbers(codec: FrameCodec) -> Numbers:
    encoding = codec.encoding
    settle = f"{encoding.prefix}_settle" if encoding.settle else ""
    roundings = tuple(map(codec.rounding_of, range(encoding.components)))
    return Numbers(codec.storage, roundings, codec.storage.is_biased, 4, settle=settle)


def _by_device(codec: FrameCodec, n: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return codes that OpenGL computes and JAX stores, and the frames that OpenGL decodes from them."""

    def run(codes: np.ndarray) -> list[np.ndarray]:
        return exact_frames(device(), codec.encoding, codec.least, n, np.pad(view, ((0, 0), (0, 1))), codes)

    stored = codec.store(Vec4(*map(jnp.asarray, run(np.zeros_like(n))[0].T)))
    codes = np.stack([np.asarray(plane) for plane in stored], axis=1)
    _, normals, tangents = run(codes)
    return codes, np.concatenate([normals, tangents[:, :3]], axis=1)


def _errors(given: np.ndarray, back: np.ndarray) -> np.ndarray:
    """Return the larger of the angular errors of normals and tangents, in degrees; 180 for a wrong hand."""
    axes = (angles_deg(given[:, part], back[:, part]) for part in (NORMAL, TANGENT))
    return np.maximum(np.maximum(*axes), 180.0 * (given[:, HAND] * back[:, HAND] < 0))


KIND = CodeKind(
    kind=FRAME,
    plural="tangent frames",
    called="tangent",
    given=lambda _: ("n.xyz", "view.xyz", "n.w"),
    fields=FIELDS,
    settings={},
    result=lambda _: 7,
    defines=lambda codec: {"FRAMES": 1, **defines(codec.encoding, "", "vec4")},
    numbers=_numbers,
    values=lambda _: _frames(),
    stored=lambda codec, n, view: codec.stored(_frame(n, view)),
    decoded=_decoded,
    by_device=_by_device,
    has_twin=is_in(FRAME),
    is_ours=is_in(FRAME),
    errors=_errors,
    unit="degrees",
    held=lambda codec: (
        "unit normals and perpendicular tangents, and the hand, 1 or -1: the bitangent is hand * (normal x tangent)"
        + ("; the hand is not stored" if codec.encoding.hand_in is None else "")
    ),
    bound=lambda codec: {"least": codec.least},
)
