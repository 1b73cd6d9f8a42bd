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
    name="rgba16f",
    title="RGBA16F",
    encode=encode,
    decode=decode,
    storage=STORAGES["rgba16f"],
    blend="add",
    has_alpha=True,
    limit=65504.0,
    citation="the format itself",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(0, 0),
    ulps_reason="nothing is computed",
)
