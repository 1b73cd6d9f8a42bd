"""Inverted: 1 - x / range. For perceptual roughness, this is the smoothness that engines store."""

from pathlib import Path

from ..codecs.curve_codec import CurveEncoding
from ..vec import maximum


def encode(x, range):
    """Map a quantity (float32 or float64, any shape) to 1 - x / range; negative x and NaN count as 0."""
    # e = 1 - x / range
    return 1.0 - maximum(x, 0.0) / range


def decode(e, range):
    """Return the quantity that a number represents, (1 - e) range, of the same shape."""
    # x = (1 - e) range
    return (1.0 - e) * range


ENCODING = CurveEncoding(
    name="inverted",
    title="1 minus the fraction of the range",
    encode=encode,
    decode=decode,
    storages=("r8", "rgba8_snorm", "rgb10a2"),
    citation="Unity Technologies, Universal Render Pipeline 14, UnityGBuffer.hlsl: smoothness",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(1, 1),
    ulps_reason="a division and a difference; a difference and a product",
    stores_colours=False,
)
