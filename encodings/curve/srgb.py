"""The sRGB curve, computed by the shader: for formats without the curve, or for numbers packed into integers."""

from pathlib import Path

from ..codecs.curve_codec import CurveEncoding
from ..storages.rounding import SRGB_KNEE, SRGB_OFFSET, SRGB_POWER, SRGB_SLOPE
from ..vec import maximum, select


def encode(x, range):
    """Map a quantity (float32 or float64, any shape) up to the range to [0, 1]; negative x and NaN count as 0."""
    # e = slope s for s = x / range up to the knee, else (1 + offset) s^(1 / power) - offset
    s = maximum(x, 0.0) / range
    curved = (1.0 + SRGB_OFFSET) * maximum(s, SRGB_KNEE) ** (1.0 / SRGB_POWER) - SRGB_OFFSET
    return select(s <= SRGB_KNEE, s * SRGB_SLOPE, curved)


def decode(e, range):
    """Return the quantity that a number represents: the inverse of the sRGB curve, times the range."""
    # x = e / slope range up to the knee, else ((e + offset) / (1 + offset))^power range
    line = e * (1.0 / SRGB_SLOPE)
    curved = ((e + SRGB_OFFSET) / (1.0 + SRGB_OFFSET)) ** SRGB_POWER
    return select(line <= SRGB_KNEE, line, curved) * range


ENCODING = CurveEncoding(
    name="srgb",
    title="the sRGB curve, computed in the shader",
    encode=encode,
    decode=decode,
    storages=("r8", "rgba8"),
    citation="IEC 61966-2-1, 1999",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 8),
    ulps_reason="a power, by a logarithm and a power of two",
    constants={
        "SRGB_KNEE": SRGB_KNEE,
        "SRGB_SLOPE": SRGB_SLOPE,
        "SRGB_OFFSET": SRGB_OFFSET,
        "SRGB_POWER": SRGB_POWER,
    },
)
