"""Cube root: steps grow with the square of the root and, near zero motion, are finer than for the square root."""

from pathlib import Path

from ..codecs.motion_codec import MotionEncoding
from ..elementary import CONSTANTS, exp2_of, log2_of
from ..vec import TINY, Vec2, maximum, select, sign_not_zero


def root(share):
    """Return the cube root of a non-negative number; NaN and numbers below the smallest normal float32 give 0."""
    # s^(1/3) = 2^(log2(s) / 3)
    return select(share >= TINY, exp2_of(log2_of(maximum(share, TINY)) * (1.0 / 3.0)), 0.0)


def encode(motion: Vec2, range) -> Vec2:
    """Map motion to the signed cube root of motion / range, in [-1, 1] up to the range and larger beyond it."""
    # c = sign(v) (|v| / range)^(1/3)
    share = abs(motion) / range
    return sign_not_zero(motion) * Vec2(root(share.x), root(share.y))


def decode(e: Vec2, range) -> Vec2:
    """Return the motion that two numbers represent: e^3 range."""
    # v = c^3 range
    return e * e * e * range


ENCODING = MotionEncoding(
    name="cube_root",
    title="the cube root of the fraction of the range",
    encode=encode,
    decode=decode,
    storages=("rg8", "rg8_centred", "rg16", "rg16_centred"),
    citation="Babylon.js 5, geometry.fragment.fx: sign times cube root, times 1/2 plus 1/2",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(8, 3),
    ulps_reason="a division, a logarithm and a power of two; three products",
    constants=CONSTANTS,
)
