"""The sRGB curve without its linear segment near 0, and a polynomial decoder: cheaper, but not an exact inverse."""

from pathlib import Path

from ..codecs.curve_codec import CurveEncoding
from ..storages.rounding import SRGB_OFFSET, SRGB_POWER
from ..vec import maximum

# x = e (e (e a + b) + c), highest power first.
BACK = (0.305306011, 0.682171111, 0.012522878)


def encode(x, range):
    """Map a quantity (float32 or float64, any shape) up to the range to [0, 1]; negative x and NaN count as 0."""
    # e = (1 + offset) s^(1 / power) - offset for s = x / range, at least 0
    return maximum((1.0 + SRGB_OFFSET) * (maximum(x, 0.0) / range) ** (1.0 / SRGB_POWER) - SRGB_OFFSET, 0.0)


def decode(e, range):
    """Return the quantity that a number represents, by a cubic polynomial that only approximates the inverse."""
    # x = e (e (e a + b) + c) range
    a, b, c = BACK
    return e * (e * (e * a + b) + c) * range


ENCODING = CurveEncoding(
    name="fast_srgb",
    title="the sRGB curve without its linear segment, decoded by a polynomial",
    encode=encode,
    decode=decode,
    storages=("r8", "rgba8"),
    citation="Unity Technologies, Core Render Pipeline 14, Color.hlsl: FastLinearToSRGB and FastSRGBToLinear; the "
    "polynomial: I. Taylor, sRGB Approximations for HLSL, 2012",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 4),
    ulps_reason="a power, by a logarithm and a power of two; six operations",
    inverse_error=0.002,
    constants={
        "SRGB_OFFSET": SRGB_OFFSET,
        "SRGB_POWER": SRGB_POWER,
        "FAST_SRGB": BACK,
    },
)
