"""Measurement of the maps table: the error of block-compressed normal maps."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache, partial
from types import MappingProxyType
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.blocks.bits import SIDE
from ....encodings.storages.storage import STORAGES
from ....encodings.vec import Vec3
from ....gbuffer.gl.compressed import device_texels
from ....gbuffer.gl.device import FormatError, NoDeviceError, device
from ...measures.metrics.meter import Decoded, Meter
from ...measures.metrics.totals import Statistics, psnr_db
from ...shaders.code.twin import NoTwinError
from ...subjects.normals.normal_sets import CHUNK, CHUNK_WIDTH, NormalSet
from ..quality.measure import Row, identity, planes_of
from .encoders import Texels
from .formats import BlockFormat, Swizzle
from .table import TABLE

# Why a row may have no figures.
UNMEASURABLE = (NoDeviceError, FormatError, NoTwinError)
# What stands for 1 in the texels that an encoder is given, and what a tangent-space map holds where it is flat.
ONE = 255
FLAT = (0.0, 0.0, 1.0)
MEGATEXEL = 2**20


@dataclass(frozen=True)
class MapCase:
    """A row of the maps table to measure; `decoder` is a key of `table.DECODERS`."""

    encoding: Encoding
    block: BlockFormat
    swizzle: Swizzle
    normal_set: NormalSet
    decoder: str

    @property
    def name(self) -> str:
        return f"{self.encoding.name} {self.block.name} {self.swizzle.name} {self.normal_set.name} {self.decoder}"

    @property
    def codec(self) -> Codec:
        """The encoding in `rgba8`, because encoders take 8 bits per channel."""
        return Codec(self.encoding, STORAGES["rgba8"])


@dataclass(frozen=True)
class Band:
    """A band of an image's rows, padded to whole blocks.

    Attributes:
        n, view: float32 of shape (height, width, 3).
        real: height and width without the padding.
        covered: mask of the real texels that have a surface, bool of shape `real`.
    """

    n: np.ndarray
    view: np.ndarray
    real: tuple[int, int]
    covered: np.ndarray


@dataclass
class Clock:
    """Totals over the bands of an image: encoding seconds, texels and squared errors of the codes' numbers."""

    seconds: float = 0.0
    texels: int = 0
    squared: float = 0.0
    numbers: int = 0


def bands(normals: NormalSet) -> Iterator[Band]:
    """Yield the bands of an image, in whole blocks, with at most CHUNK texels unless one row of blocks has more."""
    assert normals.shape
    height, width = normals.shape
    n, view, covered = planes_of(normals)
    n, view = (np.stack([np.asarray(p) for p in planes], axis=-1).reshape(height, width, 3) for planes in (n, view))
    covered = np.asarray(covered).reshape(height, width)
    n = np.where(covered[..., None], n, np.array(FLAT, np.float32))
    rows = max(SIDE, CHUNK // -(-width // SIDE * SIDE) // SIDE * SIDE)
    for top in range(0, height, rows):
        part = slice(top, top + rows)
        real = covered[part].shape
        pad = [(0, -real[0] % SIDE), (0, -real[1] % SIDE), (0, 0)]
        padded = [np.pad(a[part], pad, mode="edge") for a in (n, view)]
        yield Band(padded[0], padded[1], real, covered[part])


@cache
def _encoder(codec: Codec) -> Callable[[Vec3, Vec3], Any]:
    return jax.jit(codec.stored)


@cache
def _decoder(encoding: Encoding) -> Callable[[Any, Vec3], Vec3]:
    return jax.jit(encoding.decode)


@cache
def _meter() -> Meter:
    return Meter(jax.jit(lambda block: block.decoded))


def _vectors(pixels: np.ndarray) -> list[jax.Array]:
    """Return pixels as planes, padded to a multiple of CHUNK numbers so that programs are compiled once."""
    flat = pixels.reshape(-1, pixels.shape[-1])
    whole = np.pad(flat, ((0, -len(flat) % CHUNK), (0, 0)), mode="edge")
    return [jnp.asarray(np.ascontiguousarray(plane).reshape(-1, CHUNK_WIDTH)) for plane in whole.T]


def _pixels(planes: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Return planes as pixels, of shape (height, width, planes): the inverse of `_vectors`."""
    return np.stack([np.asarray(p).ravel()[: math.prod(shape)].reshape(shape) for p in planes], axis=-1)


def code_texels(codec: Codec, band: Band) -> np.ndarray:
    """Return each normal's code in 8 bits, uint8 of shape (height, width, components): 255 (c / 2 + 1/2), rounded."""
    code = _encoder(codec)(*(Vec3(*_vectors(a)) for a in (band.n, band.view)))
    numbers = _pixels(code, band.n.shape[:2])
    return np.rint((numbers * 0.5 + 0.5) * ONE).astype(np.uint8)


def decoded_normals(encoding: Encoding, numbers: np.ndarray, view: np.ndarray) -> np.ndarray:
    """Return the normals of codes that are stored as numbers in [0, 1]: float32 of shape (height, width, 3)."""
    code = _vectors(numbers.astype(np.float32) * 2 - 1)
    kind = type(jax.eval_shape(encoding.encode, *[Vec3(*[code[0]] * 3)] * 2))
    return _pixels(_decoder(encoding)(kind(*code), Vec3(*_vectors(view))), numbers.shape[:2])


def _texels_by_model(case: MapCase, blocks: bytes, size: tuple[int, int]) -> np.ndarray:
    return case.block.by_specification(blocks, size)


def _texels_by_device(case: MapCase, blocks: bytes, size: tuple[int, int]) -> np.ndarray:
    if not case.block.is_compressed:
        return case.block.by_specification(blocks, size)
    return device_texels(device(), blocks, size, case.block.internal_format)


DECODERS: Mapping[str, Callable[[MapCase, bytes, tuple[int, int]], np.ndarray]] = MappingProxyType(
    {"model": _texels_by_model, "device": _texels_by_device}
)


def through(case: MapCase, band: Band, clock: Clock) -> np.ndarray:
    """Return a band's normals after encoding, compression and decoding, float32 of shape (*band.real, 3), and add the
    times and errors to the clock."""
    given = code_texels(case.codec, band)
    height, width = given.shape[:2]
    texels = Texels(case.swizzle.texels(given).tobytes(), (width, height), case.swizzle.read)
    start = time.perf_counter()
    blocks = case.block.encoder.encoded(texels)
    clock.seconds += time.perf_counter() - start
    clock.texels += height * width
    numbers = case.swizzle.numbers(DECODERS[case.decoder](case, blocks, (width, height)))
    real = tuple(slice(side) for side in band.real)
    apart = numbers[real].astype(np.float64) - given[real] / ONE
    clock.squared += float(np.sum(apart**2))
    clock.numbers += apart.size
    return decoded_normals(case.encoding, numbers, band.view)[real]


def measure(case: MapCase) -> list[Row]:
    """Return a list of one row; if it cannot be measured here, it has the reason in `skipped` and no figures."""
    row, clock, whole = _case_columns(case), Clock(), case.normal_set

    def loads() -> Iterator[Callable[[], Decoded]]:
        for band in bands(whole):
            decoded, real = through(case, band, clock), tuple(slice(side) for side in band.real)
            n, back = (Vec3(*_vectors(pixels)) for pixels in (band.n[real], decoded))
            covered = np.zeros(n.z.size, bool)
            covered[: band.covered.size] = band.covered.ravel()
            yield partial(identity, Decoded(n, back, jnp.asarray(covered.reshape(n.z.shape))))

    try:
        return [row | _figures(_meter().measure(loads(), whole.count), clock) | _decoder_columns(case)]
    except UNMEASURABLE as error:
        return [row | {"skipped": str(error)}]


def _case_columns(case: MapCase) -> Row:
    return TABLE.empty() | {
        "encoding": case.encoding.name,
        "block": case.block.name,
        "swizzle": case.swizzle.name,
        "normals": case.normal_set.name,
        "decoder": case.decoder,
        "bits_per_texel": case.block.bits(case.encoding.components),
        "background": case.normal_set.background,
        "code_space": case.normal_set.code_space,
    }


def _figures(s: Statistics, clock: Clock) -> Row:
    angles = {f"angle_{name}_deg": getattr(s, f"angle_{name}_deg") for name in ("mean", "rms", "p99", "max")}
    return angles | {
        "psnr_db": psnr_db(s.mse),
        "code_psnr_db": psnr_db(clock.squared / clock.numbers),
        "invalid": s.invalid,
        "encode_ms_per_megatexel": 1e3 * clock.seconds * MEGATEXEL / clock.texels,
        "count": s.count,
        "exact": s.mse == 0,
    }


def _decoder_columns(case: MapCase) -> Row:
    by_device = case.decoder == "device" and case.block.is_compressed
    # What there is no decoder of here is decoded by the package that encodes it.
    by_package = case.block.encoder.release if case.block.decode is None else ""
    name = device().renderer if by_device else by_package or "NumPy, exact"
    figures: Row = {"encoder": case.block.encoder.name, "device": name}
    # What is not compressed takes no time and loses nothing of its 8 bits.
    return figures if case.block.is_compressed else figures | {"encode_ms_per_megatexel": None, "code_psnr_db": None}
