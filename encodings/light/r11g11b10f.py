"""Light as it is, in a float format."""

from pathlib import Path

from ..light_encoding import LightEncoding
from ..storage import R11G11B10F
from ..vec import Vec4


def encode(light: Vec4) -> Vec4:
    """The light itself."""
    return light


def decode(e: Vec4) -> Vec4:
    """The texel itself; the fourth number is 0."""
    return Vec4(e.x, e.y, e.z, e.x * 0.0)


ENCODING = LightEncoding(
    name="r11g11b10f",
    title="R11F G11F B10F, no fourth channel",
    encode=encode,
    decode=decode,
    storage=R11G11B10F,
    blend="add",
    has_alpha=False,
    limit=64512.0,
    citation="the format itself",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(0, 0),
    ulps_reason="nothing is computed",
)
