"""Hue in 6 bits, saturation in 2 bits, and the square root of the largest channel in 8 bits: emission in two bytes.

Saturation has the steps 1/4, 1/2, 3/4 and 1. A colour with a saturation below 1/4 becomes white, stored as the last
hue with the lowest saturation; a colour with that code gets the first hue instead, which is also red. Codes do not
add.
"""

from pathlib import Path

from ..codecs.light_encoding import LightEncoding
from ..vec import TINY, Vec3, Vec4, floor, light_or_none, maximum, minimum, select, sqrt

LIMIT = 16.0
HUES, SATURATIONS = 63.0, 3.0


def encode(light: Vec4) -> Vec4:
    """Map light to hue, saturation and the square root of the largest channel in [0, 1], and 0 in w. Negative light
    and NaN are treated as 0; the format clamps values above 16."""
    c = light_or_none(light).xyz
    v = maximum(maximum(c.x, c.y), c.z)
    d = v - minimum(minimum(c.x, c.y), c.z)
    # 6 h = (g - b) / d, 2 + (b - r) / d or 4 + (r - g) / d, by which is the largest; s = d / v
    part = 1.0 / maximum(d, TINY)
    green = select(c.y >= c.z, (c.z - c.x) * part + 2.0, (c.x - c.y) * part + 4.0)
    red = (c.y - c.z) * part
    six = select(c.x >= maximum(c.y, c.z), select(red < 0.0, red + 6.0, red), green)
    h, s = six * (1.0 / 6.0), (d / maximum(v, TINY) * 4.0 - 1.0) * (1.0 / SATURATIONS)
    # white is h = 1 with the least saturation, and nothing else is
    is_taken = (floor(h * HUES + 0.5) >= HUES) & (floor(s * SATURATIONS + 0.5) <= 0.0)
    h = select(is_taken, 0.0, h)
    is_white = d * 4.0 < v
    return Vec4(select(is_white, 1.0, h), select(is_white, 0.0, maximum(s, 0.0)), sqrt(v * (1.0 / LIMIT)), v * 0.0)


def decode(e: Vec4) -> Vec4:
    """Return a texel's light; the fourth number is 0."""
    six, v = e.x * 6.0, e.z * e.z * LIMIT
    is_white = (e.x * HUES + 0.5 >= HUES) & (e.y * SATURATIONS < 0.5)
    s = select(is_white, 0.0, (e.y * SATURATIONS + 1.0) * 0.25)
    # r = |6 h - 3| - 1, g = 2 - |6 h - 2|, b = 2 - |6 h - 4|, each from 0 to 1; L = v (1 - s (1 - rgb))
    hue = Vec3(abs(six - 3.0) - 1.0, 2.0 - abs(six - 2.0), 2.0 - abs(six - 4.0))
    c = Vec3(*(v * (1.0 - s * (1.0 - minimum(maximum(channel, 0.0), 1.0))) for channel in hue))
    return Vec4(c.x, c.y, c.z, v * 0.0)


ENCODING = LightEncoding(
    name="hue_saturation",
    title="hue in 6 bits, saturation in 2 and a square root in 8, up to 16",
    encode=encode,
    decode=decode,
    storages=("rg8_6_2_8",),
    blend="read",
    has_alpha=False,
    limit=LIMIT,
    citation="GaijinEntertainment/DagorEngine (2a108f7), gbuffer_packing_inc_DNG.hlsl, emission_color_map.hlsl",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 4),
    ulps_reason="a reciprocal, products and sums of the hue up to 6; a root, and products",
    constants={"HUE_SATURATION_LIMIT": LIMIT, "HUE_SATURATION_HUES": HUES, "HUE_SATURATION_STEPS": SATURATIONS},
)
