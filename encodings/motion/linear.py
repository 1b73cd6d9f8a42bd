"""Linear: motion as a fraction of the range. Float formats hold the motion itself."""

from pathlib import Path

from ..codecs.motion_codec import MotionEncoding
from ..vec import Vec2


def encode(motion: Vec2, range) -> Vec2:
    """Map motion to a fraction of the range, in [-1, 1] up to the range and larger beyond it."""
    # c = v / range
    return motion / range


def decode(e: Vec2, range) -> Vec2:
    """Return the motion that two numbers represent: e range."""
    # v = c range
    return e * range


ENCODING = MotionEncoding(
    name="linear",
    title="the fraction of the range; in floats the motion itself",
    encode=encode,
    decode=decode,
    storages=(
        *("rg16f", "rg16", "rg16_centred", "rg16_snorm", "rgb10a2", "rgb10a2_centred"),
        *("rg8", "rg8_centred", "rg8_snorm"),
    ),
    citation="Unity, HDRP, BuiltinData.hlsl: 16:16 float, unchanged; Epic Games, Unreal Engine 4.18, Common.ush: UNORM "
    "16:16 with no motion at 32767 / 65535",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(1, 1),
    ulps_reason="one division; one product",
    own_units=True,
)
