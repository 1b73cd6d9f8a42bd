"""Codes for material properties: roughness, occlusion and colour channels."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np

from .....encodings.codecs.curve_codec import CurveCodec
from .....encodings.kinds import CURVE
from .....encodings.storages.rounding import store_texel
from .....encodings.storages.storage import rounds_to
from .code_kind import COUNT, CodeKind, Numbers
from .own import by_device, defines, is_in


def _values(codec: CurveCodec) -> tuple[np.ndarray, np.ndarray]:
    """Return quantities from 0 to the range, (COUNT, 1), half of them evenly spaced and half in equal numbers per
    octave, with both ends included; and rows that hold the range, (COUNT, 3)."""
    even, small = np.linspace(0, 1, COUNT // 2), np.geomspace(2.0**-20, 1, COUNT // 2)
    x = np.concatenate([even, small])[:, None] * codec.range
    return x.astype(np.float32), np.broadcast_to(np.array([codec.range, 0, 0], np.float32), (COUNT, 3))


def _store(codec: CurveCodec, codes: np.ndarray) -> np.ndarray:
    return np.asarray(store_texel(jnp.asarray(codes[:, 0]), codec.storage, 0, rounds_to(codec.rounding)))[:, None]


def _named(codec: CurveCodec) -> str:
    is_usual = codec.range == codec.encoding.usual_range
    return codec.encoding.name if is_usual else f"{codec.encoding.name}:{codec.range:g}"


KIND = CodeKind(
    kind=CURVE,
    plural="quantities",
    given=lambda _: ("n.x",),
    settings={},
    result=lambda _: 1,
    defines=lambda codec: defines(codec.encoding, "_curve", "float"),
    numbers=lambda codec: Numbers(codec.storage, (rounds_to(codec.rounding),), False, 1),
    values=_values,
    stored=lambda codec, n, _: codec.stored(n[:, 0]),
    decoded=lambda codec, code, _: codec.encoding.decode(code, codec.range),
    by_device=by_device(1, 1, _store),
    has_twin=is_in(CURVE),
    is_ours=is_in(CURVE),
    errors=lambda given, back: np.abs(back[:, 0].astype(np.float64) - given[:, 0]),
    unit="",
    named=_named,
    held=lambda codec: f"from 0 to {codec.range:g}",
    units=lambda given: np.broadcast_to(given.max(), (len(given), 1)),
    bound=lambda codec: {"range": codec.range},
)
