"""Logarithm of 1 plus the quantity: steps are even near 0 and grow with the quantity above 1."""

from pathlib import Path

from ..codecs.curve_codec import CurveEncoding
from ..vec import exp2, log2, maximum

RANGE = 31.0


def encode(x, range):
    """Map a quantity (float32 or float64, any shape) to log2(1 + x) / log2(1 + range); negative x and NaN count as
    0."""
    # e = log2(1 + x) / log2(1 + range)
    return log2(1.0 + maximum(x, 0.0)) / log2(1.0 + range)


def decode(e, range):
    """Return the quantity that a number represents, (1 + range)^e - 1, of the same shape."""
    # x = 2^(e log2(1 + range)) - 1
    return exp2(e * log2(1.0 + range)) - 1.0


ENCODING = CurveEncoding(
    name="log",
    title="the logarithm of 1 plus the value",
    encode=encode,
    decode=decode,
    storages=("r8", "rgba8"),
    citation="A. Kapoulkine, niagara: emission as log2(1 + r) / 5, a range of 31",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 16),
    ulps_reason="a logarithm and a power of two, and a division",
    usual_range=RANGE,
)
