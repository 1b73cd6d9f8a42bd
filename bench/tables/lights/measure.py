"""The rows of `lights`: each experiment on each light buffer, by the model and by the OpenGL device."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.light_codec import LightCodec
from ....encodings.vec import Vec4
from ....gbuffer.gl.device import Device, FormatError
from ....gbuffer.gl.shader import ShaderError
from ...ground.output.errors import MissingError, UsageError
from ...shaders.code.twin import NoTwinError
from ..table import Row
from .sums import Adder, banding, chromaticity, equal_lights, gradient, has_light_twin, random_lights
from .table import TABLE

# Why the GL device may not be able to give a row.
UNMEASURABLE = (ShaderError, FormatError)


@dataclass(frozen=True)
class Sums:
    """The inputs of the experiments: sums of light, numbers of lights, falloff peaks, and a seed."""

    sums: tuple[float, ...]
    counts: tuple[int, ...]
    peaks: tuple[float, ...]
    seed: int

    def equal(self, adder: Adder) -> Iterator[Row]:
        """Return the rows of equal lights that are blended one by one."""
        return equal_lights(adder, self.sums, self.counts)

    def random(self, adder: Adder) -> Iterator[Row]:
        """Return the rows of coloured lights with falloff, in three orders; they add up to the smallest sum."""
        return random_lights(adder, min(self.sums), self.counts, self.seed)

    def banding(self, adder: Adder) -> Iterator[Row]:
        """Return the rows of banding in a lamp's falloff, one set for each peak."""
        return banding(adder, self.peaks)

    def chromaticity(self, adder: Adder) -> Iterator[Row]:
        """Return the rows of a highlight's rebuilt colour; empty if the encoding has no channel for the highlight."""
        return chromaticity(adder) if adder.encoding.has_alpha else iter(())


EXPERIMENTS: dict[str, Callable[[Sums, Adder], Iterator[Row]]] = {
    "equal": Sums.equal,
    "random": Sums.random,
    "banding": Sums.banding,
    "chromaticity": Sums.chromaticity,
}
# What rows are sorted by, so that light buffers stand beside each other under the same conditions.
CONDITIONS = (
    "sum",
    "lights",
    "order",
    "peak",
    "colour",
)


def check_light_twin(encoding: LightCodec) -> None:
    """Trace a light encoding's Python version. Raises UsageError, one line that names the file, if tracing fails; an
    encoding that exists only in shaders passes."""
    light = Vec4(*[jax.ShapeDtypeStruct((1,), jnp.float32)] * 4)
    try:
        decoded = jax.eval_shape(lambda light: encoding.decode(encoding.encode(light)), light)
        if len(decoded) != 4:
            raise TypeError(f"decode returns {len(decoded)} components; return 4")
    except NoTwinError:
        return
    except Exception as error:  # whatever a user's own file raises
        place = encoding.glsl.with_suffix(".py")
        raise UsageError(f"{place}: {type(error).__name__}: {error}") from error


def _filled_row(experiment: str, encoding: LightCodec, device: Device | None, **more: Any) -> Row:
    described = {"experiment": experiment, "light_buffer": encoding.name}
    return TABLE.empty() | described | {"device": device.renderer if device else None} | more


def sum_rows(names: list[str], encoding: LightCodec, sums: Sums, device: Device | None) -> Iterator[Row]:
    """Yield the rows of the named EXPERIMENTS; if the device cannot measure them, rows with figures of the model
    alone and the reason in `skipped`."""
    try:
        with Adder(encoding, device) as adder:
            rounding = adder.rounding
            named_rows = [(name, row) for name in names for row in EXPERIMENTS[name](sums, adder)]
    except UNMEASURABLE as error:
        for row in sum_rows(names, encoding, sums, None):
            yield row | {"skipped": str(error)}
        return
    how = {"rounds": rounding.name, "agree_percent": 100 * rounding.share} if rounding else {}
    for name, row in named_rows:
        yield _filled_row(name, encoding, device, seed=sums.seed, **how, **row)


def sorted_rows(rows: list[Row]) -> list[Row]:
    """Return the rows by experiment and then by CONDITIONS, whose values keep the order in which they first occur."""
    places = {
        column: {value: i for i, value in enumerate(dict.fromkeys(row[column] for row in rows))}
        for column in CONDITIONS
    }
    order = list(EXPERIMENTS)
    return sorted(rows, key=lambda row: (order.index(row["experiment"]), *(places[c][row[c]] for c in CONDITIONS)))


def banded(encoding: LightCodec, peak: float, device: Device | None) -> np.ndarray:
    """Return a lamp's falloff as a light buffer stores it, (width, 3): by the model, or by the device if there is no
    model.

    Raises:
        MissingError: there is neither a model nor a device.
    """
    with Adder(encoding, device if not has_light_twin(encoding) else None) as adder:
        light = gradient(peak)[None]
        stored = adder.model(light) or adder.device(light)
    if not stored:
        raise MissingError(f"{encoding.name}: exists only as shader code, and there is no OpenGL device")
    return stored.light[:, :3]
