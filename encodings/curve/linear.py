"""Linear: x / range, with steps of equal size."""

from pathlib import Path

from ..codecs.curve_codec import CurveEncoding


def encode(x, range):
    """Map a quantity (float32 or float64, any shape, not negative) to x / range, in [0, 1] up to the range."""
    # e = x / range
    return x / range


def decode(e, range):
    """Return the quantity that a number represents, e range, of the same shape."""
    # x = e range
    return e * range


ENCODING = CurveEncoding(
    name="linear",
    title="the fraction of the range",
    encode=encode,
    decode=decode,
    storages=("r8", "r16", "r16f", "rgba16_snorm"),
    citation="Epic Games, Unreal Engine 4.27, DeferredShadingCommon.ush: roughness, metalness, and specular "
    "over a range of 0.08",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(1, 1),
    ulps_reason="a division; a product",
)
