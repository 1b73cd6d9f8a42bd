"""Light stored unchanged, in a float format."""

import math
from pathlib import Path

from ..codecs.light_encoding import LightEncoding
from ..vec import Vec4


def encode(light: Vec4) -> Vec4:
    """Return the light unchanged."""
    return light


def decode(e: Vec4) -> Vec4:
    """Return the texel unchanged."""
    return e


ENCODING = LightEncoding(
    name="plain",
    title="light, unchanged",
    encode=encode,
    decode=decode,
    storages=("rgba32f", "rgba16f", "r11g11b10f"),
    blend="add",
    has_alpha=True,
    limit=math.inf,
    citation="the format itself",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(0, 0),
    ulps_reason="nothing is computed",
    is_plain=True,
    any_bits="float",
)
