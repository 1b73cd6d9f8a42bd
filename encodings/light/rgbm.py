"""RGBM: colours in 8 bits, times a shared multiplier in the fourth channel.

The multiplier is first rounded up to its own 8 bits, so that no colour exceeds 1. Codes do not add.
"""

from dataclasses import replace
from functools import partial
from pathlib import Path

from ..codecs.light_encoding import LightEncoding
from ..vec import Vec4, ceil, light_or_none, maximum, minimum

RANGE = 6.0
STEPS = 255.0
# What arithmetic adds to a light that was read must not raise its multiplier, nor lose it half a step for nothing.
SLACK = 2.0**-10


def encode(light: Vec4, limit: float = RANGE) -> Vec4:
    """Map light to [0, 1]: the colour divided by M times the range, and M in w. Negative light and NaN are treated as
    0; the format clamps values above the range."""
    # m = ceil(255 max(L) / range - slack) / 255, at least 1/255 and at most 1
    rgb = light_or_none(light).xyz
    largest = maximum(maximum(rgb.x, rgb.y), rgb.z)
    m = minimum(maximum(ceil(largest * (STEPS / limit) - SLACK), 1.0), STEPS) * (1.0 / STEPS)
    # e = (L / (m range), m)
    c = rgb * (1.0 / (m * limit))
    return Vec4(c.x, c.y, c.z, m)


def decode(e: Vec4, limit: float = RANGE) -> Vec4:
    """Return a texel's light; the fourth number is 0."""
    # L = e.rgb m range
    c = e.xyz * (e.w * limit)
    return Vec4(c.x, c.y, c.z, c.x * 0.0)


def ranged(limit: float) -> LightEncoding:
    """Return the encoding over the range 0 to `limit`, in both languages, named `rgbm:<limit>`."""
    return replace(
        ENCODING,
        name=f"rgbm:{limit:g}",
        title=f"RGBM in RGBA8, up to {limit:g}",
        encode=partial(encode, limit=limit),
        decode=partial(decode, limit=limit),
        limit=limit,
        constants={"RGBM_RANGE": limit, "RGBM_STEPS": STEPS, "RGBM_SLACK": SLACK},
    )


ENCODING = LightEncoding(
    name="rgbm",
    title="RGBM in RGBA8, up to 6",
    encode=encode,
    decode=decode,
    storages=("rgba8",),
    blend="read",
    has_alpha=False,
    limit=RANGE,
    citation="B. Karis, RGBM color encoding, 2009; J. Ols, Prelighting & Log-Lights, 2009",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(3, 2),
    ulps_reason="a reciprocal and three products; a multiplier next to a tie may be the next",
    constants={"RGBM_RANGE": RANGE, "RGBM_STEPS": STEPS, "RGBM_SLACK": SLACK},
    ranged=ranged,
)
