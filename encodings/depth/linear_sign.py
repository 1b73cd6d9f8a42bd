"""Linear depth with the sign of the normal's z, so that X and Y are enough for the normal."""

from pathlib import Path

from ..codecs.depth_codec import DepthEncoding
from ..vec import with_sign_of


def encode(depth, near, far):
    """Map signed depth to a fraction of `far` with the depth's sign bit, even for zero."""
    # l = sign |d| / far
    return with_sign_of(abs(depth) / far, depth)


def decode(number, near, far):
    """Return the signed depth, given as a fraction of `far`, with the fraction's sign bit."""
    # d = sign |l| far
    return with_sign_of(abs(number) * far, number)


ENCODING = DepthEncoding(
    name="linear_sign",
    title="linear, with the sign of the normal's z",
    encode=encode,
    decode=decode,
    signed=True,
    own_units=True,
    storages=("packed16", "packed24", "r16f", "r32f"),
    citation="ozlael, sign of the normal's Z in the sign of the G-buffer's depth, 2010",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(1, 1),
    ulps_reason="one division, which a GPU makes of a reciprocal; one product",
)
