"""Squared: steps are wide near 0 and narrow near the range. For perceptual roughness, this is the alpha of GGX."""

from pathlib import Path

from ..codecs.curve_codec import CurveEncoding
from ..vec import maximum, sqrt


def encode(x, range):
    """Map a quantity (float32 or float64, any shape) to (x / range)^2; negative x and NaN count as 0."""
    # e = (x / range)^2
    share = maximum(x, 0.0) / range
    return share * share


def decode(e, range):
    """Return the quantity that a number represents, sqrt(e) range, of the same shape."""
    # x = sqrt(e) range
    return sqrt(e) * range


ENCODING = CurveEncoding(
    name="squared",
    title="the square of the fraction of the range",
    encode=encode,
    decode=decode,
    storages=("r8", "rgba8"),
    citation="AMD, FidelityFX SDK, Cauldron, gbufferps.hlsl, 2025: alpha of a roughness; NVIDIA, NRD.hlsli",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(3, 2),
    ulps_reason="a division and a product; a root and a product",
    stores_colours=False,
)
