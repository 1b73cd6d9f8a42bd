"""Logarithmic light: codes multiply where light adds, so that blending by DST_COLOR, ZERO adds up light.

The code of no light is exactly 1. The last code before 0 is log2(255) = 7.994, a whole 1.0 of light after the code
before it; 0 is read as that code.
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
    """Return the light of a texel, -log2(e); e is treated as at least 1/255."""
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
