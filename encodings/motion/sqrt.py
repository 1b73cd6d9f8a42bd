"""Square root: steps grow with the square root of the motion and are finest near zero motion."""

from pathlib import Path

from ..codecs.motion_codec import MotionEncoding
from ..vec import Vec2, select, sign_not_zero, sqrt


def encode(motion: Vec2, range) -> Vec2:
    """Map motion to [-1, 1] up to the range, and to larger numbers beyond it; NaN is treated as no motion."""
    # c = sign(v) sqrt(|v| / range)
    share = abs(motion) / range
    return sign_not_zero(motion) * Vec2(*(select(s > 0.0, sqrt(s), 0.0) for s in share))


def decode(e: Vec2, range) -> Vec2:
    """Return the motion that two numbers represent: e |e| range."""
    # v = c |c| range
    return e * abs(e) * range


ENCODING = MotionEncoding(
    name="sqrt",
    title="the square root of the fraction of the range",
    encode=encode,
    decode=decode,
    storages=("rg16", "rg16_centred", "rg16_snorm", "rgb10a2_centred", "rg8", "rg8_centred", "rg8_snorm"),
    citation="Epic Games, Unreal Engine 5.7, Common.ush: UNORM 16:16 with no motion at 32767 / 65535; L. Vutner after "
    "Crytek, CryENGINE 3: UNORM 8:8 with no motion at 127 / 255",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="a division and a root, which halves its error; two products",
)
