"""Square root: steps are narrow near 0, as with a gamma of 2."""

from pathlib import Path

from ..codecs.curve_codec import CurveEncoding
from ..vec import maximum, sqrt


def encode(x, range):
    """Map a quantity (float32 or float64, any shape) to sqrt(x / range); negative x and NaN count as 0."""
    # e = sqrt(x / range)
    return sqrt(maximum(x, 0.0) / range)


def decode(e, range):
    """Return the quantity that a number represents, e^2 range, of the same shape."""
    # x = e^2 range
    return e * e * range


ENCODING = CurveEncoding(
    name="square_root",
    title="the square root of the fraction of the range",
    encode=encode,
    decode=decode,
    storages=("r8", "rgba8", "rgb10a2"),
    citation="Embark Studios, kajiya, pack_unpack.hlsl: colours; S. Lagarde and C. de Rousiers, Moving "
    "Frostbite to PBR, 2014: reflectance over a range of 0.16; NVIDIA, NRD.hlsli: roughness",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="a division and a root; two products",
)
