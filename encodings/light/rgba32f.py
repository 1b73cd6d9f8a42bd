"""Light as it is, in a float format."""

from pathlib import Path

from ..light_encoding import LightEncoding
from ..storage import STORAGES
from ..vec import Vec4


def encode(light: Vec4) -> Vec4:
    """The light itself."""
    return light


def decode(e: Vec4) -> Vec4:
    """The texel itself."""
    return e


ENCODING = LightEncoding(
    name="rgba32f",
    title="RGBA32F: the reference",
    encode=encode,
    decode=decode,
    storage=STORAGES["rgba32f"],
    blend="add",
    has_alpha=True,
    limit=3.4028234663852886e38,
    citation="the format itself",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(0, 0),
    ulps_reason="nothing is computed",
)
