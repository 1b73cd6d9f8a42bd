"""Reflectivity: metallic as the reflectance of a white surface, from a dielectric's 0.04 to 1."""

from pathlib import Path

from ..codecs.curve_codec import CurveEncoding
from ..vec import maximum

DIELECTRIC = 0.04


def encode(x, range):
    """Map a quantity (float32 or float64, any shape, not negative) linearly to [0.04, 1] up to the range."""
    # e = d + (1 - d) x / range
    return DIELECTRIC + (1.0 - DIELECTRIC) * (x / range)


def decode(e, range):
    """Return the quantity that a number represents; 0 if the number is below a dielectric's reflectance."""
    # x = (e - d) / (1 - d) range
    return maximum((e - DIELECTRIC) / (1.0 - DIELECTRIC) * range, 0.0)


ENCODING = CurveEncoding(
    name="reflectivity",
    title="reflectance of a white surface of this metalness, 0.04 to 1",
    encode=encode,
    decode=decode,
    storages=("r8", "rgba8"),
    citation="Unity URP 14, UnityGBuffer.hlsl (373861b): metalness is recovered from it",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 8),
    ulps_reason="a product and a sum, which GLSL may join; a quotient",
    constants={"REFLECTIVITY_LEAST": DIELECTRIC},
    stores_colours=False,
)
