"""Logarithm: steps of equal size below range / k, and steps proportional to the motion above it.

With k = 2^11 - 1 and a range of one screen, the two regions meet at 1 / 2047 of the screen, one pixel of an image
2047 pixels wide: motions below a pixel have a constant absolute precision, and larger motions a constant relative
precision. 2^11 makes the divisor log2(1 + k) a whole number, 11.
"""

from pathlib import Path

from ..codecs.motion_codec import MotionEncoding
from ..elementary import CONSTANTS, exp2_of, log2_of
from ..vec import Vec2, maximum, minimum, sign_not_zero

OCTAVES = 11.0
K = 2.0**OCTAVES - 1.0
# 2^127 is the largest power of two that float32 has.
MOST = 127.0


def encode(motion: Vec2, range) -> Vec2:
    """Map motion to [-1, 1] up to the range, and to larger numbers beyond it; NaN is treated as no motion."""
    # c = sign(v) log2(1 + k |v| / range) / log2(1 + k)
    x = Vec2(*(maximum(1.0 + share * K, 1.0) for share in abs(motion) / range))
    return sign_not_zero(motion) * Vec2(log2_of(x.x), log2_of(x.y)) / OCTAVES


def decode(e: Vec2, range) -> Vec2:
    """Return the motion that two numbers represent: the inverse of `encode`, limited to keep large numbers finite."""
    # v = sign(c) (2^(|c| log2(1 + k)) - 1) range / k
    x = Vec2(*(minimum(share * OCTAVES, MOST) for share in abs(e)))
    return sign_not_zero(e) * (Vec2(exp2_of(x.x), exp2_of(x.y)) - 1.0) * (range / K)


ENCODING = MotionEncoding(
    name="log",
    title="the logarithm of 1 plus 2047 times the fraction of the range",
    encode=encode,
    decode=decode,
    storages=("rg16", "rg16_centred", "rg16_snorm", "rgb10a2_centred", "rg8", "rg8_centred", "rg8_snorm"),
    citation="the mu-law of ITU-T G.711 (1972) with mu = 2047 instead of 255",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(3, 6),
    ulps_reason="a logarithm of up to 11 within two of its own units, over 11; a power of two within two of its own "
    "units, a difference and two products",
    constants={"MOTION_LOG_OCTAVES": OCTAVES, "MOTION_LOG_K": K, **CONSTANTS, "MOTION_LOG_MOST": MOST},
)
