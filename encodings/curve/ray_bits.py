"""Eight rays that hit or miss: the fraction of rays that miss, as the number of low bits set in a byte.

A quantity takes one of nine values. With one bit for each ray, the byte would tell which rays hit; here the bits are
set in order.
"""

from pathlib import Path

from ..codecs.curve_codec import CurveEncoding
from ..vec import floor, log2, maximum, minimum

RAYS, BYTE = 8.0, 255.0


def encode(x, range):
    """Map a quantity (float32 or float64, any shape) to its byte of rays, over 255; negative x and NaN count as 0."""
    # e = (2^k - 1) / 255 of k rays, the nearest to 8 x / range
    k = floor(minimum(maximum(x, 0.0) / range, 1.0) * RAYS + 0.5)
    return (2.0**k - 1.0) * (1.0 / BYTE)


def decode(e, range):
    """Return the quantity that a byte over 255 represents: its number of rays over RAYS, times the range."""
    # x = log2(1 + 255 e) / 8 range
    k = floor(log2(1.0 + maximum(floor(e * BYTE + 0.5), 0.0)) + 0.5)
    return k * (1.0 / RAYS) * range


ENCODING = CurveEncoding(
    name="ray_bits",
    title="eight rays, one bit each",
    encode=encode,
    decode=decode,
    storages=("r8", "rgba8"),
    citation="Epic Games, Unreal Engine 5.8, DeferredShadingCommon.ush: occlusion of the diffuse sample as eight bits",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="a power of two and a quotient; a product",
    inverse_error=1.0 / 16.0,
    constants={"RAY_BITS_RAYS": RAYS, "RAY_BITS_BYTE": BYTE},
    stores_colours=False,
)
