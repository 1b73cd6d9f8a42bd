"""Encodings of material values in a layout: curves over a range, or light packed into a whole texel."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...encodings.catalogue import CURVE_ENCODINGS, LIGHT_ENCODINGS, MOTION_ENCODINGS
from ...encodings.codecs.curve_codec import CurveEncoding
from ...encodings.codecs.light_encoding import LightEncoding
from ...encodings.codecs.motion_codec import MotionEncoding
from ...encodings.storages.storage import FORMATS

# Reflectance at normal incidence: a number next to a metallic, a colour without one.
F0, F0_COLOUR = "f0", "f0.rgb"
COLOURS = ("base_color", F0_COLOUR, "emissive")
SINGLE = ("roughness", "metallic", F0, "ao")
# What light is kept by in the four numbers of a format that mean nothing one by one.
WHOLE = {
    name: encoding
    for name, encoding in LIGHT_ENCODINGS.items()
    if encoding.blend == "read" and FORMATS.keys() >= {*encoding.storages}
}
LIGHT = "emissive"
MOTION = "motion"


def quantity_of(component: str) -> str:
    """Return the quantity to which a component of a layout belongs: `base_color` for `base_color.r`, `f0.rgb` for
    `f0.r`, `f0` for `f0`."""
    base, dot, _ = component.partition(".")
    return F0_COLOUR if dot and base == F0 else base


def channels_of(colour: str) -> tuple[str, ...]:
    """Return the three components of a colour in COLOURS: `f0.r`, `f0.g` and `f0.b` for `f0.rgb`."""
    return tuple(f"{colour.removesuffix('.rgb')}.{channel}" for channel in "rgb")


@dataclass(frozen=True)
class Kept:
    """The encoding of a quantity.

    Attributes:
        encoding: the encoding of each of its numbers, or of all of them together.
        range: the largest value on a curve; for motion, in screens per frame. 1 for light, whose encoding sets the
            range.
    """

    encoding: CurveEncoding | LightEncoding | MotionEncoding
    range: float = 1.0

    @property
    def is_whole(self) -> bool:
        """Whether the encoding stores light as one code of four numbers that fill a texel."""
        return isinstance(self.encoding, LightEncoding)


def kept_as(name: str, limit: str | None, quantity: str) -> Kept:
    """Return the encoding and range that `name`, or `name:limit`, selects for a quantity such as `roughness` or
    `emissive`. A `limit` of None is the usual range.

    Raises:
        ValueError: the name is unknown or is not for that quantity, or the range is invalid; one line.
    """
    if quantity == MOTION:
        return _kept_motion(name, limit)
    if quantity not in (*COLOURS, *SINGLE):
        raise ValueError(f"only {', '.join((*COLOURS, *SINGLE, MOTION))} can use a curve")
    if name in WHOLE:
        if quantity != LIGHT or limit is not None:
            raise ValueError(f"{name} stores light in a whole texel; write {name}({LIGHT})")
        return Kept(WHOLE[name])
    if name not in CURVE_ENCODINGS:
        raise ValueError(f"unknown curve {name!r}; known: {', '.join((*CURVE_ENCODINGS, *WHOLE))}")
    encoding = CURVE_ENCODINGS[name]
    return Kept(encoding, encoding.usual_range if limit is None else _range_of(limit))


def _kept_motion(name: str, limit: str | None) -> Kept:
    """Return the motion encoding of this name with the range `limit`, a number as text; None for 1. Raises
    ValueError."""
    if name not in MOTION_ENCODINGS:
        raise ValueError(f"unknown motion encoding {name!r}; known: {', '.join(MOTION_ENCODINGS)}")
    return Kept(MOTION_ENCODINGS[name], 1.0 if limit is None else _range_of(limit))


def _range_of(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    # Not a number is no range either.
    if not 1e-3 <= number <= 65504:
        raise ValueError(f"a range must be 0.001 to 65504, not {text}")
    return number
