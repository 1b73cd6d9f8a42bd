"""Codes of normals."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

import numpy as np

from .....encodings.catalogue import ENCODINGS
from .....encodings.codecs.codec import Codec
from .....encodings.codecs.encoding import AXES, Encoding
from .....encodings.kinds import NORMAL
from .....encodings.vec import Vec3
from .....gbuffer.codecs.codec_passes import CodecPasses, encoding_defines
from .....gbuffer.gl.device import device
from ....ground.angles import angles_deg
from ....ground.directions import directions
from ..twin import has_twin
from .code_kind import COUNT, CodeKind, Numbers

SIDE = 2**8
HOLDS: Mapping[str, str] = MappingProxyType(
    {
        "sphere": "unit vectors of the whole sphere",
        "hemisphere": "unit vectors with z >= 0",
        "view": "unit vectors that face the viewer; `view` is the view-space position, with the viewer at the origin",
    }
)


@cache
def normals(domain: str) -> tuple[np.ndarray, np.ndarray]:
    """Return 2^16 unit normals in a domain, and views: axes and neighbours, diagonals, then random directions."""
    generator = np.random.default_rng(0)
    random = generator.normal(size=(COUNT, 3))
    n = np.concatenate([directions(), random / np.linalg.norm(random, axis=1, keepdims=True)])[:COUNT]
    view = generator.uniform((-1.0, -1.0, -3.0), (1.0, 1.0, -0.5), (COUNT, 3))
    if domain == "hemisphere":
        n[:, 2] = np.abs(n[:, 2])
    if domain == "view":
        n[np.sum(n * view, axis=1) > 0] *= -1.0
    return n.astype(np.float32), view.astype(np.float32)


def is_catalogues(encoding: Encoding) -> bool:
    """Whether an encoding is the catalogue's or a variant of it, by name and file: users may choose any name."""
    known = ENCODINGS.get(encoding.name.partition(":")[0])
    return known is not None and known.glsl == encoding.glsl


def _numbers(codec: Codec) -> Numbers:
    encoding = codec.encoding
    roundings = tuple(map(codec.rounding_of, range(encoding.components)))
    size = encoding.components + encoding.sign_bits
    return Numbers(codec.storage, roundings, codec.storage.is_biased, size, encoding.sign_bits, encoding.is_precise)


def _by_device(codec: Codec, n: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return stored codes and decoded normals of an encoding that exists only in GLSL, by OpenGL."""
    pixels = (np.pad(array, ((0, 0), (0, 1))).reshape(SIDE, -1, 4) for array in (n, view))
    with CodecPasses(device(), codec) as passes:
        trip = passes.round_trip(*pixels)
    size = codec.encoding.components + codec.encoding.sign_bits
    return trip.codes.reshape(len(n), 4)[:, :size].copy(), trip.normals.reshape(len(n), 3)


def _vectors(rows: Any) -> Vec3:
    return Vec3(rows[:, 0], rows[:, 1], rows[:, 2])


def _held(codec: Codec) -> str:
    encoding = codec.encoding
    if encoding.own is None:
        return HOLDS[encoding.domain]
    # The component that the turn makes a table's z.
    half = AXES[encoding.axis][1][-1]
    return f"unit vectors with {half} {'>=' if encoding.sign > 0 else '<='} 0"


KIND = CodeKind(
    kind=NORMAL,
    plural="normals",
    given=lambda _: ("n.xyz",),
    settings=MappingProxyType({"view": "view.xyz"}),
    result=lambda _: 3,
    defines=lambda codec: encoding_defines(codec.encoding),
    numbers=_numbers,
    values=lambda codec: normals(codec.encoding.domain),
    stored=lambda codec, n, view: codec.stored(_vectors(n), _vectors(view)),
    decoded=lambda codec, code, view: codec.encoding.decode(code, _vectors(view)),
    by_device=_by_device,
    has_twin=lambda codec: has_twin(codec.encoding),
    is_ours=lambda codec: is_catalogues(codec.encoding),
    errors=angles_deg,
    unit="degrees",
    held=_held,
    searches=lambda codec: codec.encoding.searches or codec.encoding.is_precise,
)
