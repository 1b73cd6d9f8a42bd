"""Codes of depth."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

import jax.numpy as jnp
import numpy as np

from .....encodings.codecs.depth_codec import DepthCodec
from .....encodings.kinds import DEPTH
from .....encodings.storages.depth_storage import store_depth
from .code_kind import COUNT, CodeKind, Numbers
from .own import by_device, defines, is_in

NEAR, FAR = 0.125, 1024.0


def _values(codec: DepthCodec) -> tuple[np.ndarray, np.ndarray]:
    """Return depths from the near to the far plane, (COUNT, 1), half of them in equal numbers per octave and half
    evenly spaced, with both signs if the encoding is signed; and rows that hold the planes, (COUNT, 3)."""
    depth = np.concatenate([np.geomspace(NEAR, FAR, COUNT // 2), np.linspace(NEAR, FAR, COUNT // 2)])
    if codec.encoding.signed:
        depth *= np.where(np.arange(COUNT) % 2, -1.0, 1.0)
    return depth.astype(np.float32)[:, None], np.broadcast_to(np.array([NEAR, _far(codec), 0], np.float32), (COUNT, 3))


def _far(codec: DepthCodec) -> float:
    return _bound(codec).get("far", FAR)


def _bound(codec: DepthCodec) -> dict[str, float]:
    """Return {"far": 1.0} if floats store depths in the scene's own units, else {}."""
    return {"far": 1.0} if codec.encoding.own_units and codec.storage.is_open else {}


def _defines(codec: DepthCodec) -> dict[str, object]:
    """Return the macros of a codec's GLSL. Depths for the catalogue's encoders are limited to the far plane, if the
    codec has one; a user's encoder is called directly."""
    macros = defines(codec.encoding, "_depth", "float")
    if _bound(codec) or not is_in(DEPTH)(codec):
        return macros
    is_signed = int(codec.encoding.signed)
    return macros | {"DEPTH_ENCODE": macros["ENCODE"], "ENCODE": "depth_encode", "DEPTH_SIGNED": is_signed}


def _numbers(codec: DepthCodec) -> Numbers:
    storage = codec.storage
    if storage.home != "packed":
        return Numbers(storage.format, ("nearest",), False, 1)
    # Across the last channels of the target.
    kept = replace(storage.format, name=storage.name, title=storage.title, bits=(storage.bits,), part=8)
    form = "signed" if codec.encoding.signed else "unsigned"
    return Numbers(kept, ("nearest",), False, 1, skipped=sum(storage.format.bits) - storage.bits, share=form)


def _store(codec: DepthCodec, codes: np.ndarray) -> np.ndarray:
    return np.asarray(store_depth(jnp.asarray(codes[:, 0]), codec.storage, codec.encoding.signed))[:, None]


def _held(codec: DepthCodec) -> str:
    sign = "; its sign is that of the normal's z" if codec.encoding.signed else ""
    own = "in the scene's units" if _bound(codec) else "from `near` to `far`"
    return f"-z of the view-space position, {own}{sign}"


KIND = CodeKind(
    kind=DEPTH,
    plural="depths",
    given=lambda _: ("n.x",),
    settings=MappingProxyType({"near": "view.x", "far": "view.y"}),
    result=lambda _: 1,
    defines=_defines,
    numbers=_numbers,
    values=_values,
    stored=lambda codec, n, view: codec.stored(n[:, 0], view[:, 0], jnp.float32(FAR)),
    decoded=lambda codec, code, view: codec.depths(code, view[:, 0], jnp.float32(FAR)),
    by_device=by_device(1, 1, _store),
    has_twin=is_in(DEPTH),
    is_ours=is_in(DEPTH),
    errors=lambda given, back: np.abs(back[:, 0].astype(np.float64) - given[:, 0]) / np.abs(given[:, 0]),
    unit="of the depth",
    held=_held,
    units=np.abs,
    bound=_bound,
)
