"""Light over a range, in fixed point: RGBA8 scaled to [0, 2], as published by Ols.

`srgb` stores the same numbers in an sRGB target, which adds them in linear light. The hardware applies the curve: the
shader writes and reads linear numbers. The fourth channel has no curve.
"""

from dataclasses import replace
from functools import partial
from pathlib import Path

from ..codecs.light_encoding import LightEncoding
from ..vec import Vec4

RANGE = 2.0


def encode(light: Vec4, limit: float = RANGE) -> Vec4:
    """Map light to [0, 1]; the format clamps values above the range."""
    # e = L / range
    return light * (1.0 / limit)


def decode(e: Vec4, limit: float = RANGE) -> Vec4:
    """Return the light that a texel represents: e times the range."""
    # L = e range
    return e * limit


def _name_and_title(name: str, limit: float) -> tuple[str, str]:
    return name, f"sRGB RGBA8, scaled to [0, {limit:g}]"


def ranged(limit: float) -> LightEncoding:
    """Return the encoding over the range 0 to `limit`, in both languages, named `linear:<limit>`."""
    return replace(
        ENCODING,
        name=f"linear:{limit:g}",
        title=f"RGBA8, linear, scaled to [0, {limit:g}]",
        in_curve=_name_and_title(f"srgb:{limit:g}", limit),
        encode=partial(encode, limit=limit),
        decode=partial(decode, limit=limit),
        limit=limit,
        constants={"LINEAR_RANGE": limit},
    )


ENCODING = LightEncoding(
    name="linear",
    title="RGBA8, linear, scaled to [0, 2]",
    in_curve=_name_and_title("srgb", RANGE),
    encode=encode,
    decode=decode,
    storages=("rgba8", "srgb8_a8"),
    blend="add",
    has_alpha=True,
    limit=RANGE,
    citation="J. Ols, Linear sRGB Blending & Deferred Lighting, 2010",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 1),
    ulps_reason="a reciprocal and a product; exact for a range that is a power of two",
    constants={"LINEAR_RANGE": RANGE},
    ranged=ranged,
    any_bits="unorm",
)
