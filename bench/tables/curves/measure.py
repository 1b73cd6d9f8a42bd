"""The curves table: the error of material quantities that were stored and decoded, by JAX and by GLSL."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from types import MappingProxyType

import jax
import numpy as np

from ....encodings.codecs.curve_codec import CurveCodec
from ....encodings.storages.dither import Dither
from ....encodings.storages.rounding import from_srgb, to_srgb
from ....gbuffer.codecs.curve.curve_passes import CurvePasses
from ....gbuffer.gl.device import device
from ..table import Row
from ..unmeasurable import UNMEASURABLE
from .table import TABLE

WIDTH = 256
# The share of the range from which on relative errors count, and the steps of colours that a viewer sees.
FROM, STEPS = 0.01, 255.0
# Quantities that are just told from 0 are looked for from this share of the range on.
LEAST = 1e-9

# float32 quantities of shape (count,), and what is added to their numbers, to what they come back as.
Trip = Callable[[np.ndarray, np.ndarray], np.ndarray]
How = dict[str, str]


@dataclass(frozen=True)
class CurveCase:
    """One row to measure."""

    codec: CurveCodec
    backend: str
    count: int
    seed: int

    @property
    def name(self) -> str:
        return f"{self.codec.name} {self.codec.rounding} {self.codec.range:g} {self.backend}"


@contextmanager
def _trip_by_jax(codec: CurveCodec) -> Iterator[tuple[Trip, How]]:
    compiled = jax.jit(codec.round_trip)
    how = {"device": jax.devices()[0].device_kind, "rounded_by": "emulation"}
    yield lambda x, noise: np.asarray(compiled(x, noise)), how


@contextmanager
def _trip_by_glsl(codec: CurveCodec) -> Iterator[tuple[Trip, How]]:
    gl = device()
    with CurvePasses(gl, codec) as passes:

        def trip(x: np.ndarray, noise: np.ndarray) -> np.ndarray:
            given = np.pad(np.stack([x, noise], axis=1), ((0, -len(x) % WIDTH), (0, 0)), mode="edge")
            return passes.round_trip(given.reshape(-1, WIDTH, 2)).ravel()[: len(x)]

        yield trip, {"device": gl.renderer, "rounded_by": passes.rounded_by}


Backend = Callable[[CurveCodec], AbstractContextManager[tuple[Trip, How]]]
BACKENDS: Mapping[str, Backend] = MappingProxyType({"jax": _trip_by_jax, "glsl": _trip_by_glsl})


def measure(case: CurveCase) -> Row:
    """Return the row of a case; if the device cannot measure it, with the reason in `skipped` and no figures."""
    codec = case.codec
    row = TABLE.empty() | {
        "encoding": codec.encoding.name,
        "storage": codec.storage.name,
        "rounding": codec.rounding,
        "backend": case.backend,
        "range": codec.range,
        "bits": codec.bits,
        "count": case.count,
        "seed": case.seed,
    }
    try:
        with BACKENDS[case.backend](codec) as (trip, how):
            return row | _figures(case, trip) | how
    except UNMEASURABLE as error:
        return row | {"skipped": str(error)}


def _figures(case: CurveCase, trip: Trip) -> Row:
    largest = case.codec.range
    # Not the even steps themselves, which may be the codes of a storage.
    linear = (np.arange(case.count) + np.random.default_rng(case.seed).random(case.count)) / case.count
    x = (linear * largest).astype(np.float32)
    back = _through(case, trip, x)
    apart = back.astype(np.float64) - x
    counted = x >= FROM * largest
    ends = _through(case, trip, np.array([0.0, largest], np.float32), is_still=True)
    return {
        "error_mean": float(abs(apart).mean()),
        "error_max": float(abs(apart).max()),
        "bias": float(apart.mean()),
        "relative_max": float(100 * (abs(apart[counted]) / x[counted]).max()),
        "least": _least(case, trip, ends[0]),
        "zero": float(ends[0]),
        "one": float(ends[1]) / largest,
        **(_display_columns(case, trip, linear) if case.codec.encoding.stores_colours else {}),
    }


def _display_columns(case: CurveCase, trip: Trip, shown: np.ndarray) -> Row:
    """Return `display_mean` and `display_max`: the errors of colours on the sRGB curve, in steps of 1/255.

    Args:
        shown: values on the sRGB curve, 0 to 1."""
    largest = case.codec.range
    x = np.asarray(from_srgb(shown.astype(np.float32))) * np.float32(largest)
    back = _through(case, trip, x.astype(np.float32)) / np.float32(largest)
    apart = STEPS * abs(np.asarray(to_srgb(np.clip(back, 0.0, 1.0)), np.float64) - shown)
    return {"display_mean": float(apart.mean()), "display_max": float(apart.max())}


def _through(case: CurveCase, trip: Trip, x: np.ndarray, is_still: bool = False) -> np.ndarray:
    """Return float32 quantities after a codec's round trip, dithered if the codec is, unless `is_still` is true."""
    noise = np.zeros_like(x)
    if case.codec.is_dithered and not is_still:
        tile = Dither((case.codec.step,), 0).added[..., 0].ravel()
        # A seed begins the tile elsewhere.
        noise = np.resize(np.roll(tile, case.seed), len(x)).astype(np.float32)
    return trip(x, noise)


def _least(case: CurveCase, trip: Trip, zero: np.float32) -> float | None:
    """Return the smallest quantity in the codec's range that does not decode to `zero`, the decoded 0, accurate to a
    thousandth; None if every quantity that was tried decodes to it."""
    low, high = LEAST * case.codec.range, case.codec.range
    for _ in range(2):
        tried = np.geomspace(low, high, WIDTH * 4).astype(np.float32)
        told = np.flatnonzero(_through(case, trip, tried, is_still=True) != zero)
        if not told.size:
            return None
        low, high = float(tried[max(told[0] - 1, 0)]), float(tried[told[0]])
    return high
