"""Logarithmic light: adding light means multiplying codes, so blending with DST_COLOR, ZERO accumulates light.

The code for no light is exactly 1. The last code before 0 represents log2(255) = 7.994, a whole 1.0 of light more
than the code before it; 0 is read as that last code.
"""

import math
from pathlib import Path

from ..codecs.light_encoding import LightEncoding
from ..vec import Vec4, exp2, light_or_none, log2, maximum

LEAST = 1.0 / 255.0


def encode(light: Vec4) -> Vec4:
    """Map light to 2^-L, in (0, 1]; negative light and NaN become 1."""
    # e = 2^-L
    return Vec4(*(exp2(-c) for c in light_or_none(light)))


def decode(e: Vec4) -> Vec4:
    """Return the light that a texel represents: -log2(e), with e raised to at least 1/255."""
    # L = -log2(e), e at least 1/255
    return Vec4(*(-log2(maximum(c, LEAST)) for c in e))


ENCODING = LightEncoding(
    name="log",
    title="RGBA8, exp2(-L), blended by multiplication",
    encode=encode,
    decode=decode,
    storages=("rgba8",),
    blend="multiply",
    has_alpha=True,
    limit=-math.log2(LEAST),
    citation="drillian, Light Prepass HDR; J. Ols, Prelighting & Log-Lights, 2009",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(3, 64),
    ulps_reason="exp2 and log2 within 3 units of 1; the dimmest code stands for 1/177 of light, so of that it is more",
    constants={"LOG_LEAST": LEAST},
)
